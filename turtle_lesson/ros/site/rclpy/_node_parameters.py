"""The part of a node that keeps its parameters: declared with a type, described, checked, and told of changes."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

from . import exceptions
from ._arguments import pattern_matches
from ._parameter_rules import describe_type, integer_range_flaw, range_flaw
from .parameter import PARAMETER_SEPARATOR_STRING, Parameter

if TYPE_CHECKING:
    from .context import Context

DYNAMIC_HINT = (
    "when declaring parameter named '{}', declaring a parameter only providing its name is deprecated. You have to "
    "either:\n\t- Pass a name and a default value different to \"PARAMETER NOT SET\" (and optionally a descriptor).\n"
    "\t- Pass a name and a parameter type.\n\t- Pass a name and a descriptor with `dynamic_typing=True"
)


class NodeParameters:
    """Mixed into Node."""

    context: Context
    _allow_undeclared: bool

    def _setup_parameters(self, full_name: str, overrides: Sequence[Parameter], allow_undeclared: bool) -> None:
        self._parameters: dict[str, Parameter] = {}
        self._descriptors: dict[str, Any] = {}
        self._allow_undeclared = allow_undeclared
        self._on_set: list[Callable[[list[Parameter]], Any]] = []
        self._before_set: list[Callable[[list[Parameter]], Any]] = []
        self._after_set: list[Callable[[list[Parameter]], Any]] = []
        self._overrides: dict[str, Parameter] = {}
        for pattern, name, value in self.context.arguments.parameters:
            if pattern_matches(pattern, full_name):
                self._overrides[name] = Parameter(name, value=value)
        self._overrides.update({parameter.name: parameter for parameter in overrides})

    # -- declaring -------------------------------------------------------------------------------------------------

    def declare_parameter(
        self, name: str, value: Any = None, descriptor: Any = None, ignore_override: bool = False
    ) -> Parameter:
        """Declare a parameter with its default value (or its Parameter.Type), and return it with the value in force.

        Raises ParameterAlreadyDeclaredException, InvalidParameterException, InvalidParameterTypeException or
        InvalidParameterValueException.
        """
        details = (name,) if value is None and descriptor is None else (name, value)
        if descriptor is not None:
            details = (name, value, descriptor)
        return self.declare_parameters("", [details], ignore_override)[0]

    def declare_parameters(
        self, namespace: str, parameters: Sequence[tuple[Any, ...]], ignore_override: bool = False
    ) -> list[Parameter]:
        """Declare several: tuples of name, and optionally value and descriptor."""
        declared: list[tuple[Parameter, Any]] = []
        for index, details in enumerate(parameters):
            declared.append(self._declaration(index, namespace, details, ignore_override))
        taken = [parameter.name for parameter, _ in declared if parameter.name in self._parameters]
        if taken:
            raise exceptions.ParameterAlreadyDeclaredException(taken)
        for parameter, descriptor in declared:
            self._declare(parameter, descriptor)
        return [self._parameters[parameter.name] for parameter, _ in declared]

    def _declaration(
        self, index: int, namespace: str, details: tuple[Any, ...], ignore_override: bool
    ) -> tuple[Parameter, Any]:
        from rcl_interfaces.msg import ParameterDescriptor

        name = details[0]
        if not isinstance(name, str):
            raise TypeError(f"First element {name} at index {index} in parameters list is not a str.")
        if not name:
            raise exceptions.InvalidParameterException(name)
        full_name = f"{namespace}{PARAMETER_SEPARATOR_STRING}{name}" if namespace else name
        value = details[1] if len(details) > 1 else None
        given = details[2] if len(details) > 2 else None
        if value is None and (given is None or not given.dynamic_typing):
            warnings.warn(DYNAMIC_HINT.format(full_name), UserWarning, stacklevel=4)
        descriptor = ParameterDescriptor() if given is None else given
        descriptor.name = full_name
        if isinstance(value, Parameter.Type):
            if value == Parameter.Type.NOT_SET:
                raise ValueError(f"Cannot declare parameter {full_name} as statically typed of type NOT_SET")
            descriptor.type, value = value.value, None
        elif value is None and (given is None or not given.dynamic_typing):
            descriptor.dynamic_typing = True
        if not ignore_override and full_name in self._overrides:
            return self._checked_override(full_name, value, descriptor), descriptor
        return Parameter(full_name, value=value), descriptor

    def _checked_override(self, name: str, default: Any, descriptor: Any) -> Parameter:
        override = self._overrides[name]
        expected = Parameter.Type(descriptor.type) if descriptor.type else Parameter.Type.from_parameter_value(default)
        if descriptor.dynamic_typing or expected == Parameter.Type.NOT_SET or expected == override.type_:
            return override
        if not override.value and isinstance(override.value, list) and expected.check(override.value):
            return Parameter(name, expected, override.value)
        raise exceptions.InvalidParameterTypeException(override, expected.name)

    def _declare(self, parameter: Parameter, descriptor: Any) -> None:
        if not descriptor.dynamic_typing and not descriptor.type:
            descriptor.type = parameter.type_.value
        self._descriptors[parameter.name] = descriptor
        if parameter.type_ == Parameter.Type.NOT_SET:
            self._parameters[parameter.name] = parameter
            return
        reason = self._why_refused(parameter, declaring=True) or self._ask_callbacks([parameter])
        if reason:
            del self._descriptors[parameter.name]
            raise exceptions.InvalidParameterValueException(parameter.name, parameter.value, reason)
        self._parameters[parameter.name] = parameter
        self._tell_parameter_event("new", [parameter])

    def undeclare_parameter(self, name: str) -> None:
        """Forget a parameter. Raises ParameterNotDeclaredException or ParameterImmutableException."""
        self._check_declared(name)
        if self._descriptors[name].read_only:
            raise exceptions.ParameterImmutableException(name)
        self._tell_parameter_event("deleted", [self._parameters[name]])
        del self._parameters[name], self._descriptors[name]

    # -- reading ---------------------------------------------------------------------------------------------------

    def has_parameter(self, name: str) -> bool:
        """Whether a parameter is declared."""
        return name in self._parameters

    def get_parameter(self, name: str) -> Parameter:
        """A declared parameter. Raises ParameterNotDeclaredException or ParameterUninitializedException."""
        if name not in self._parameters and self._allow_undeclared:
            return Parameter(name)
        self._check_declared(name)
        parameter = self._parameters[name]
        if parameter.type_ == Parameter.Type.NOT_SET and not self._descriptors[name].dynamic_typing:
            raise exceptions.ParameterUninitializedException(name)
        return parameter

    def get_parameters(self, names: list[str]) -> list[Parameter]:
        """Several declared parameters."""
        if not all(isinstance(name, str) for name in names):
            raise TypeError("All names must be instances of type str")
        return [self.get_parameter(name) for name in names]

    def get_parameter_or(self, name: str, alternative_value: Parameter | None = None) -> Parameter:
        """A declared parameter, or the alternative if it is not declared or has no value."""
        parameter = self._parameters.get(name)
        if parameter is None or parameter.type_ == Parameter.Type.NOT_SET:
            return Parameter(name) if alternative_value is None else alternative_value
        return parameter

    def get_parameters_by_prefix(self, prefix: str) -> dict[str, Parameter]:
        """The parameters below a prefix, by the rest of their names."""
        start = prefix + PARAMETER_SEPARATOR_STRING if prefix else ""
        return {name[len(start) :]: each for name, each in self._parameters.items() if name.startswith(start)}

    def get_parameter_type(self, name: str) -> Parameter.Type:
        """The type of a declared parameter."""
        return self.get_parameter(name).type_

    def describe_parameter(self, name: str) -> Any:
        """The rcl_interfaces/msg/ParameterDescriptor of a declared parameter."""
        self._check_declared(name)
        return self._descriptors[name]

    def describe_parameters(self, names: list[str]) -> list[Any]:
        """The descriptors of several declared parameters."""
        return [self.describe_parameter(name) for name in names]

    def _check_declared(self, name: str) -> None:
        if name not in self._parameters:
            raise exceptions.ParameterNotDeclaredException(name)

    # -- setting ---------------------------------------------------------------------------------------------------

    def set_parameters(self, parameter_list: list[Parameter]) -> list[Any]:
        """Set parameters one by one; a list of rcl_interfaces/msg/SetParametersResult says how each went."""
        self._check_settable(parameter_list)
        return [self._set([parameter]) for parameter in parameter_list]

    def set_parameters_atomically(self, parameter_list: list[Parameter]) -> Any:
        """Set all parameters or none; an rcl_interfaces/msg/SetParametersResult says how it went."""
        self._check_settable(parameter_list)
        return self._set(parameter_list)

    def _check_settable(self, parameters: list[Parameter]) -> None:
        undeclared = [each.name for each in parameters if each.name not in self._parameters]
        if undeclared and not self._allow_undeclared:
            raise exceptions.ParameterNotDeclaredException(undeclared)

    def _set(self, parameters: list[Parameter]) -> Any:
        from rcl_interfaces.msg import ParameterDescriptor, SetParametersResult

        for callback in self._before_set:
            parameters = callback(parameters)
        for parameter in parameters:
            self._descriptors.setdefault(parameter.name, ParameterDescriptor(name=parameter.name, dynamic_typing=True))
        reasons = (self._why_refused(parameter) for parameter in parameters)
        reason = next(filter(None, reasons), "") or self._ask_callbacks(parameters)
        if reason:
            return SetParametersResult(successful=False, reason=reason)
        for parameter in parameters:
            self._parameters[parameter.name] = parameter
        for callback in self._after_set:
            callback(parameters)
        self._tell_parameter_event("changed", parameters)
        return SetParametersResult(successful=True)

    def _tell_parameter_event(self, kind: str, parameters: list[Parameter]) -> None:
        """Publish what was new, changed or deleted; Node does."""

    def _why_refused(self, parameter: Parameter, declaring: bool = False) -> str:
        """Why a value is not allowed, as the real one words it; '' if it is."""
        descriptor = self._descriptors[parameter.name]
        if descriptor.read_only and not declaring:
            return f"Trying to set a read-only parameter: {parameter.name}."
        expected = Parameter.Type(descriptor.type)
        if not descriptor.dynamic_typing and expected not in (parameter.type_, Parameter.Type.NOT_SET):
            return f"Wrong parameter type, expected '{expected}' got '{parameter.type_}'"
        if parameter.type_ == Parameter.Type.DOUBLE and descriptor.floating_point_range:
            return range_flaw(parameter, descriptor.floating_point_range[0])
        if parameter.type_ == Parameter.Type.INTEGER and descriptor.integer_range:
            return integer_range_flaw(parameter, descriptor.integer_range[0])
        return ""

    def _ask_callbacks(self, parameters: list[Parameter]) -> str:
        """The reason why one of the node's own callbacks refuses, or ''."""
        for callback in self._on_set:
            result = callback(parameters)
            if not hasattr(result, "successful"):
                raise AttributeError(
                    f"a parameter callback returned {result!r}, which has no attribute 'successful': end it with "
                    "`return SetParametersResult(successful=True)`"
                )
            if not result.successful:
                return result.reason or "refused by a callback of the node"
        return ""

    def set_descriptor(self, name: str, descriptor: Any, alternative_value: Any = None) -> Any:
        """Give a declared parameter another descriptor; returns the value in force."""
        self._check_declared(name)
        if self._descriptors[name].read_only:
            raise exceptions.ParameterImmutableException(name)
        descriptor.name = name
        if not descriptor.type:
            descriptor.type = describe_type(self._parameters[name])
        self._descriptors[name] = descriptor
        return self._parameters[name].get_parameter_value()

    # -- callbacks -------------------------------------------------------------------------------------------------

    def add_on_set_parameters_callback(self, callback: Callable[[list[Parameter]], Any]) -> None:
        """Have `callback(parameters)` decide about changes: it returns an rcl_interfaces/msg/SetParametersResult."""
        self._on_set.insert(0, callback)

    def remove_on_set_parameters_callback(self, callback: Callable[[list[Parameter]], Any]) -> None:
        """No longer ask a callback."""
        self._on_set.remove(callback)

    def add_pre_set_parameters_callback(self, callback: Callable[[list[Parameter]], Any]) -> None:
        """Have `callback(parameters)` return the list of parameters that is really set (Jazzy and newer)."""
        self._before_set.insert(0, callback)

    def add_post_set_parameters_callback(self, callback: Callable[[list[Parameter]], Any]) -> None:
        """Have `callback(parameters)` called after a change (Jazzy and newer)."""
        self._after_set.insert(0, callback)
