"""The part of a node that changes its parameters: checks them, asks and tells the program's own callbacks."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from . import exceptions
from ._mistakes import did_you_mean
from ._parameter_rules import why_refused
from .parameter import Parameter, parameter_value_to_python


class ParameterSetting:
    """Mixed into Node, beneath the part that declares and reads parameters."""

    def describe_parameter(self, name: str) -> Any:
        """The descriptor of a parameter."""
        raise NotImplementedError

    def get_parameter(self, name: str) -> Parameter:
        """A parameter."""
        raise NotImplementedError

    def get_parameter_or(self, name: str, alternative_value: Parameter | None = None) -> Parameter:
        """A parameter, or the alternative."""
        raise NotImplementedError

    def _ros_setup_parameters(self, overrides: Sequence[Parameter], allow_undeclared: bool) -> None:
        self._ros_parameters: dict[str, Parameter] = {}
        self._ros_descriptors: dict[str, Any] = {}
        self._ros_allow_undeclared = allow_undeclared
        self._ros_on_set: list[Callable[[list[Parameter]], Any]] = []
        self._ros_before_set: list[Callable[[list[Parameter]], Any]] = []
        self._ros_after_set: list[Callable[[list[Parameter]], Any]] = []
        self._ros_overrides = {parameter.name: parameter for parameter in overrides}

    def _ros_not_declared(self, name: str, names: str | list[str]) -> exceptions.ParameterNotDeclaredException:
        error = exceptions.ParameterNotDeclaredException(names)
        known = sorted(self._ros_parameters)
        error.add_note(
            f"Declare it first, with a default: declare_parameter({name!r}, …). Declared so far: "
            f"{', '.join(known) or 'none'}{did_you_mean(str(name), known)}"
        )
        return error

    # -- setting ---------------------------------------------------------------------------------------------------

    def set_parameters(self, parameter_list: list[Parameter]) -> list[Any]:
        """Set parameters one by one; a list of rcl_interfaces/msg/SetParametersResult says how each went.

        Raises ParameterNotDeclaredException at the first undeclared one; those before it stay set.
        """
        return [self.set_parameters_atomically([parameter]) for parameter in parameter_list]

    def set_parameters_atomically(self, parameter_list: list[Parameter]) -> Any:
        """Set all parameters or none; an rcl_interfaces/msg/SetParametersResult says how it went."""
        from rcl_interfaces.msg import SetParametersResult

        if self._ros_before_set:
            parameter_list = self._ros_changed_before(parameter_list)
            if not parameter_list:
                reason = "parameter list cannot be empty, this might be due to pre_set_parameters_callback "
                return SetParametersResult(reason=reason + "modifying the original parameters list.")
        self._ros_check_settable(parameter_list)
        reason = self._ros_set(parameter_list)
        return SetParametersResult(successful=not reason, reason=reason)

    def _ros_changed_before(self, parameters: list[Parameter]) -> list[Parameter]:
        """What the callbacks that are asked first make of the parameters."""
        found: list[Parameter] = []
        for callback in self._ros_before_set:
            changed = callback(parameters)
            try:
                found.extend(changed)
            except TypeError as error:
                error.add_note("A pre-set callback ends with `return parameters`, the list of parameters to set.")
                raise
        return found

    def _ros_check_settable(self, parameters: list[Parameter]) -> None:
        for parameter in parameters:
            if not isinstance(parameter, Parameter):
                raise TypeError(
                    f"a list of rclpy.parameter.Parameter is expected, got {parameter!r} in it: "
                    "try Parameter('speed', value=0.5)"
                )
        undeclared = [each.name for each in parameters if each.name not in self._ros_parameters]
        if undeclared and not self._ros_allow_undeclared:
            raise self._ros_not_declared(undeclared[0], undeclared)

    def _ros_set(self, parameters: list[Parameter], descriptors: dict[str, Any] | None = None) -> str:
        """Check and store; new descriptors mean that the parameters are being declared. Returns why not, or ''."""
        reason = self._ros_why_refused(parameters, descriptors) or self._ros_ask_callbacks(parameters)
        if not reason:
            self._ros_store(parameters, descriptors)
            for callback in self._ros_after_set:
                callback(parameters)
        return reason

    def _ros_store(self, parameters: list[Parameter], descriptors: dict[str, Any] | None) -> None:
        """Keep the values, forget those that are set to nothing, and tell /parameter_events about it."""
        news: dict[str, list[Any]] = {"new": [], "changed": [], "deleted": []}
        for parameter in parameters:
            name = parameter.name
            if parameter.type_ == Parameter.Type.NOT_SET and descriptors is None:
                news["deleted"].append(parameter.to_parameter_msg())
                self._ros_parameters.pop(name, None)
                self._ros_descriptors.pop(name, None)
                continue
            is_new = self.get_parameter_or(name).type_ == Parameter.Type.NOT_SET
            news["new" if is_new else "changed"].append(parameter.to_parameter_msg())
            self._ros_descriptors[name] = self._ros_descriptor_for(parameter, descriptors)
            self._ros_parameters[name] = parameter
        self._ros_tell_parameter_events(news)

    def _ros_descriptor_for(self, parameter: Parameter, descriptors: dict[str, Any] | None) -> Any:
        from rcl_interfaces.msg import ParameterDescriptor

        known = descriptors or self._ros_descriptors
        if parameter.name in known:
            return known[parameter.name]
        return ParameterDescriptor(name=parameter.name, type=parameter.type_.value, dynamic_typing=True)

    def _ros_tell_parameter_events(self, news: dict[str, list[Any]]) -> None:
        """Publish what was new, changed or deleted; Node does."""

    def _ros_why_refused(self, parameters: list[Parameter], descriptors: dict[str, Any] | None) -> str:
        """Why one of the values is not allowed, as the real one words it; '' if all are."""
        for parameter in parameters:
            descriptor = (descriptors or self._ros_descriptors).get(parameter.name)
            if descriptor is not None and descriptor.read_only and descriptors is None:
                return f"Trying to set a read-only parameter: {parameter.name}."
            is_known = parameter.name in self._ros_parameters
            reason = "" if descriptor is None else why_refused(parameter, descriptor, is_known)
            if reason:
                return reason
        return ""

    def _ros_ask_callbacks(self, parameters: list[Parameter]) -> str:
        """The reason why one of the node's own callbacks refuses, or ''."""
        for callback in self._ros_on_set:
            result = callback(parameters)
            if not hasattr(result, "successful"):
                raise AttributeError(
                    f"a parameter callback returned {result!r}, which has no attribute 'successful': end it with "
                    "`return SetParametersResult(successful=True)`"
                )
            if not result.successful:
                return result.reason or "refused by a callback of the node, which gave no reason"
        return ""

    def set_descriptor(self, name: str, descriptor: Any, alternative_value: Any = None) -> Any:
        """Give a declared parameter another descriptor; returns the value in force.

        `alternative_value`, an rcl_interfaces/msg/ParameterValue, is taken if the present one does not suit it. Raises
        InvalidParameterValueException if neither does.
        """
        if name not in self._ros_parameters and self._ros_allow_undeclared:
            return Parameter(name).get_parameter_value()
        if self.describe_parameter(name).read_only:
            raise exceptions.ParameterImmutableException(name)
        choices = [self.get_parameter(name)]
        if alternative_value is not None:
            choices.append(Parameter(name, value=parameter_value_to_python(alternative_value)))
        descriptor.name = name
        reasons = [why_refused(choice, descriptor, True) for choice in choices]
        if "" not in reasons:
            raise exceptions.InvalidParameterValueException(name, choices[-1].value, reasons[-1])
        self._ros_parameters[name] = choices[reasons.index("")]
        self._ros_descriptors[name] = descriptor
        return self._ros_parameters[name].get_parameter_value()

    # -- callbacks -------------------------------------------------------------------------------------------------

    def add_on_set_parameters_callback(self, callback: Callable[[list[Parameter]], Any]) -> None:
        """Have `callback(parameters)` decide about changes: it returns an rcl_interfaces/msg/SetParametersResult."""
        if not callable(callback):
            raise TypeError(f"Callback must be callable, got {callback!r}: hand over self.on_set, without brackets")
        self._ros_on_set.insert(0, callback)

    def remove_on_set_parameters_callback(self, callback: Callable[[list[Parameter]], Any]) -> None:
        """No longer ask a callback."""
        self._ros_on_set.remove(callback)

    def add_pre_set_parameters_callback(self, callback: Callable[[list[Parameter]], Any]) -> None:
        """Have `callback(parameters)` return the list of parameters that is really set (Jazzy and newer)."""
        self._ros_before_set.insert(0, callback)

    def add_post_set_parameters_callback(self, callback: Callable[[list[Parameter]], Any]) -> None:
        """Have `callback(parameters)` called after a change (Jazzy and newer)."""
        self._ros_after_set.insert(0, callback)

    def remove_pre_set_parameters_callback(self, callback: Callable[[list[Parameter]], Any]) -> None:
        """No longer ask a callback."""
        self._ros_before_set.remove(callback)

    def remove_post_set_parameters_callback(self, callback: Callable[[list[Parameter]], Any]) -> None:
        """No longer tell a callback."""
        self._ros_after_set.remove(callback)
