"""The part of a node that keeps its parameters: declared with a type, described, checked and published."""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable, Sequence
from typing import Any

from turtle_lesson.ros.sim.simulation import NANOSECONDS

from ._hints import did_you_mean
from ._node_entities import NodeEntities
from .exceptions import (
    InvalidParameterException,
    InvalidParameterTypeException,
    InvalidParameterValueException,
    ParameterAlreadyDeclaredException,
    ParameterImmutableException,
    ParameterNotDeclaredException,
    ParameterUninitializedException,
)
from .parameter import PARAMETER_SEPARATOR_STRING, Parameter, parameter_value_to_python
from .publisher import Publisher

TOLERANCE = 1e-6
"""How far, relatively, a floating-point value may be off an end or a step of its range."""


class NodeParameters(NodeEntities):
    """Mixed into Node."""

    _ros_event_publisher: Publisher

    def _ros_setup_parameters(self, overrides: Sequence[Parameter], allow_undeclared: bool) -> None:
        self._ros_parameters: dict[str, Parameter] = {}
        self._ros_descriptors: dict[str, Any] = {}
        self._ros_allow_undeclared = allow_undeclared
        self._ros_on_set: list[Callable[[list[Parameter]], Any]] = []
        self._ros_before_set: list[Callable[[list[Parameter]], Any]] = []
        self._ros_after_set: list[Callable[[list[Parameter]], Any]] = []
        self._ros_overrides = {parameter.name: parameter for parameter in overrides}

    def _ros_not_declared(self, name: str, names: str | list[str]) -> ParameterNotDeclaredException:
        error = ParameterNotDeclaredException(names)
        known = sorted(self._ros_parameters)
        error.add_note(
            f"Declare it first, with a default: declare_parameter({name!r}, …). Declared so far: "
            f"{', '.join(known) or 'none'}{did_you_mean(str(name), known)}"
        )
        return error

    def set_parameters(self, parameter_list: list[Parameter]) -> list[Any]:
        """Set parameters one by one; a list of rcl_interfaces/msg/SetParametersResult says how each went.

        Raises ParameterNotDeclaredException at the first undeclared one; those before it stay set.
        """
        return [self.set_parameters_atomically([parameter]) for parameter in parameter_list]

    def set_parameters_atomically(self, parameter_list: list[Parameter]) -> Any:
        """Set all parameters or none; an rcl_interfaces/msg/SetParametersResult says how it went."""
        from rcl_interfaces.msg import SetParametersResult

        if self._ros_before_set:
            parameter_list = [each for callback in self._ros_before_set for each in callback(parameter_list)]
            if not parameter_list:
                reason = "parameter list cannot be empty, this might be due to pre_set_parameters_callback "
                return SetParametersResult(reason=reason + "modifying the original parameters list.")
        for parameter in parameter_list:
            if not isinstance(parameter, Parameter):
                raise TypeError(f"a list of Parameter('name', value=…) of rclpy is expected, got {parameter!r} in it")
        undeclared = [each.name for each in parameter_list if each.name not in self._ros_parameters]
        if undeclared and not self._ros_allow_undeclared:
            raise self._ros_not_declared(undeclared[0], undeclared)
        reason = self._ros_set(parameter_list)
        return SetParametersResult(successful=not reason, reason=reason)

    def _ros_set(self, parameters: list[Parameter], descriptors: dict[str, Any] | None = None) -> str:
        """Check and store; new descriptors mean that the parameters are being declared. Returns why not, or ''."""
        for parameter in parameters:
            descriptor = (descriptors or self._ros_descriptors).get(parameter.name)
            if descriptor is not None and descriptor.read_only and descriptors is None:
                return f"Trying to set a read-only parameter: {parameter.name}."
            is_declared = parameter.name in self._ros_parameters
            if descriptor is not None and (reason := _why_refused(parameter, descriptor, is_declared)):
                return reason
        for callback in self._ros_on_set:
            result = callback(parameters)
            if not hasattr(result, "successful"):
                advice = "end it with `return SetParametersResult(successful=True)`"
                raise AttributeError(f"a parameter callback returned {result!r}: no attribute 'successful'; {advice}")
            if not result.successful:
                return result.reason or "refused by a callback of the node, which gave no reason"
        self._ros_store(parameters, descriptors)
        for callback in self._ros_after_set:
            callback(parameters)
        return ""

    def _ros_store(self, parameters: list[Parameter], descriptors: dict[str, Any] | None) -> None:
        """Keep the values, forget those that are set to nothing, and tell /parameter_events about it."""
        from rcl_interfaces.msg import ParameterDescriptor

        known = descriptors or self._ros_descriptors
        event = self._ros_event_publisher.msg_type(node=self._ros_entry.full_name)
        event.stamp.sec, event.stamp.nanosec = divmod(self._ros_clock._now(), NANOSECONDS)
        for parameter in parameters:
            name, message = parameter.name, parameter.to_parameter_msg()
            if parameter.type_ == Parameter.Type.NOT_SET and descriptors is None:
                event.deleted_parameters.append(message)
                self._ros_parameters.pop(name, None)
                self._ros_descriptors.pop(name, None)
                continue
            is_new = self.get_parameter_or(name).type_ == Parameter.Type.NOT_SET
            (event.new_parameters if is_new else event.changed_parameters).append(message)
            if name not in known:
                known[name] = ParameterDescriptor(name=name, type=parameter.type_.value, dynamic_typing=True)
            self._ros_descriptors[name] = known[name]
            self._ros_parameters[name] = parameter
        self._ros_event_publisher.publish(event)

    def set_descriptor(self, name: str, descriptor: Any, alternative_value: Any = None) -> Any:
        """Give a declared parameter another descriptor; returns the value in force.

        `alternative_value`, an rcl_interfaces/msg/ParameterValue, is taken if the present one does not suit it. Raises
        InvalidParameterValueException if neither does.
        """
        if not self._ros_is_declared(name):
            return Parameter(name).get_parameter_value()
        if self._ros_descriptors[name].read_only:
            raise ParameterImmutableException(name)
        choices = [self.get_parameter(name)]
        if alternative_value is not None:
            choices.append(Parameter(name, value=parameter_value_to_python(alternative_value)))
        descriptor.name = name
        reasons = [_why_refused(choice, descriptor, True) for choice in choices]
        if "" not in reasons:
            raise InvalidParameterValueException(name, choices[-1].value, reasons[-1])
        self._ros_parameters[name] = choices[reasons.index("")]
        self._ros_descriptors[name] = descriptor
        return self._ros_parameters[name].get_parameter_value()

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

    def declare_parameter(
        self, name: str, value: Any = None, descriptor: Any = None, ignore_override: bool = False
    ) -> Parameter:
        """Declare a parameter with its default value (or its Parameter.Type), and return it with the value in force.

        Raises ParameterAlreadyDeclaredException, InvalidParameterException, InvalidParameterTypeException or
        InvalidParameterValueException.
        """
        details: tuple[Any, ...] = (name,) if value is None and descriptor is None else (name, value)
        if descriptor is not None:
            details = (name, value, descriptor)
        return self.declare_parameters("", [details], ignore_override)[0]

    def declare_parameters(
        self, namespace: str, parameters: Sequence[tuple[Any, ...]], ignore_override: bool = False
    ) -> list[Parameter]:
        """Declare several: tuples of name, and optionally value and descriptor."""
        declared: list[tuple[Parameter, Any]] = []
        for details in parameters:
            name, value, descriptor = _read_declaration(namespace, details)
            overridden = not ignore_override and name in self._ros_overrides
            declared.append((self._ros_overrides[name] if overridden else Parameter(name, value=value), descriptor))
        taken = [parameter.name for parameter, _ in declared if parameter.name in self._ros_parameters]
        if taken:
            raise ParameterAlreadyDeclaredException(taken)
        for parameter, descriptor in declared:
            reason = self._ros_set([parameter], {parameter.name: descriptor})
            if reason.startswith("Wrong parameter type"):
                raise InvalidParameterTypeException(parameter, Parameter.Type(descriptor.type).name)
            if reason:
                raise InvalidParameterValueException(parameter.name, parameter.value, reason)
        return [self._ros_parameters[parameter.name] for parameter, _ in declared]

    def _ros_declare_overrides(self) -> None:
        """Declare what the parameter overrides name, as the real one does before it declares anything else.

        An empty list in a parameter file has no type, so Humble's node has the parameter, but no value for it.
        """
        from rcl_interfaces.msg import ParameterDescriptor

        for name, each in self._ros_overrides.items():
            self.declare_parameter(name, each.value, ParameterDescriptor(dynamic_typing=each.value is None), True)

    def undeclare_parameter(self, name: str) -> None:
        """Forget a parameter. Raises ParameterNotDeclaredException or ParameterImmutableException."""
        if name not in self._ros_parameters:
            raise self._ros_not_declared(name, name)
        if self._ros_descriptors[name].read_only:
            raise ParameterImmutableException(name)
        del self._ros_parameters[name], self._ros_descriptors[name]

    def has_parameter(self, name: str) -> bool:
        """Whether a parameter is declared."""
        return name in self._ros_parameters

    def get_parameter(self, name: str) -> Parameter:
        """A declared parameter. Raises ParameterNotDeclaredException or ParameterUninitializedException."""
        if not self._ros_is_declared(name):
            return Parameter(name)
        parameter = self._ros_parameters[name]
        if parameter.type_ == Parameter.Type.NOT_SET and not self._ros_descriptors[name].dynamic_typing:
            raise ParameterUninitializedException(name)
        return parameter

    def get_parameters(self, names: list[str]) -> list[Parameter]:
        """Several declared parameters."""
        return [self.get_parameter(name) for name in names]

    def get_parameter_or(self, name: str, alternative_value: Parameter | None = None) -> Parameter:
        """A declared parameter, or the alternative if it is not declared or has no value."""
        parameter = self._ros_parameters.get(name)
        if parameter is None or parameter.type_ == Parameter.Type.NOT_SET:
            return Parameter(name) if alternative_value is None else alternative_value
        return parameter

    def get_parameters_by_prefix(self, prefix: str) -> dict[str, Parameter]:
        """The parameters below a prefix, by the rest of their names."""
        start = prefix + PARAMETER_SEPARATOR_STRING if prefix else ""
        return {name[len(start) :]: each for name, each in self._ros_parameters.items() if name.startswith(start)}

    def get_parameter_type(self, name: str) -> Any:
        """The number of a declared parameter's type (rcl_interfaces/msg/ParameterType)."""
        return self._ros_parameters[name].type_.value if self._ros_is_declared(name) else Parameter.Type.NOT_SET

    def get_parameter_types(self, names: list[str]) -> list[Any]:
        """The numbers of several parameters' types."""
        return [self.get_parameter_type(name) for name in names]

    def describe_parameter(self, name: str) -> Any:
        """The rcl_interfaces/msg/ParameterDescriptor of a declared parameter."""
        from rcl_interfaces.msg import ParameterDescriptor

        return self._ros_descriptors[name] if self._ros_is_declared(name) else ParameterDescriptor()

    def describe_parameters(self, names: list[str]) -> list[Any]:
        """The descriptors of several declared parameters."""
        return [self.describe_parameter(name) for name in names]

    def list_parameters(self, prefixes: list[str], depth: int) -> Any:
        """An rcl_interfaces/msg/ListParametersResult of the names below some prefixes (none: of all).

        `depth` is how many parts a name may have below its prefix; 0 is any number.
        """
        from rcl_interfaces.msg import ListParametersResult

        if depth < 0:
            raise ValueError("The depth must be greater than or equal to zero")
        names = [name for name in self._ros_parameters if _is_listed(name, prefixes, depth)]
        parts = [name.rpartition(PARAMETER_SEPARATOR_STRING) for name in names]
        parents = dict.fromkeys(parent for parent, separator, _ in parts if separator)
        return ListParametersResult(names=names, prefixes=list(parents))

    def _ros_is_declared(self, name: str) -> bool:
        """Whether a parameter is declared. Raises ParameterNotDeclaredException if it is not, and has to be."""
        if name not in self._ros_parameters and not self._ros_allow_undeclared:
            raise self._ros_not_declared(name, name)
        return name in self._ros_parameters


# What a declaration may say, and which values a descriptor allows. Reasons are given in rclpy's words (its node.py).


def _read_declaration(namespace: str, details: tuple[Any, ...]) -> tuple[str, Any, Any]:
    """Full name, default value and descriptor of a declaration: a tuple of name, and perhaps value and descriptor."""
    from rcl_interfaces.msg import ParameterDescriptor, ParameterValue

    if not 1 <= len(details) <= 3 or not isinstance(details[0], str):
        raise TypeError(f"a parameter is declared by a tuple of its name, value and descriptor, got {details!r}")
    name, value, descriptor = (*details, None, None)[:3]
    if not name:
        raise InvalidParameterException(name)
    name = f"{namespace}{PARAMETER_SEPARATOR_STRING}{name}" if namespace else name
    descriptor = ParameterDescriptor() if len(details) < 3 else descriptor
    if not isinstance(descriptor, ParameterDescriptor):
        raise TypeError(f"the descriptor of the parameter {name} must be a ParameterDescriptor, got {descriptor!r}")
    descriptor.name = name
    if len(details) == 1:
        advice = "give it a default value, a Parameter.Type, or a descriptor with dynamic_typing=True"
        warnings.warn(f"declaring the parameter '{name}' by its name only is deprecated: {advice}", stacklevel=4)
        descriptor.dynamic_typing = True
    if isinstance(value, Parameter.Type):
        if descriptor.dynamic_typing or value == Parameter.Type.NOT_SET:
            raise ValueError(f"Cannot declare parameter {{{name}}} with dynamic_typing=True and a type, or as NOT_SET")
        descriptor.type = value.value
        return name, None, descriptor
    if not descriptor.dynamic_typing:
        if value is None or (isinstance(value, ParameterValue) and not value.type):
            raise ValueError("Cannot declare a statically typed parameter with default value of type PARAMETER_NOT_SET")
        descriptor.type = Parameter.Type.from_parameter_value(value).value
    return name, value, descriptor


def _why_refused(parameter: Parameter, descriptor: Any, is_declared: bool) -> str:
    """Why a descriptor does not allow a value, or ''. A dynamically typed descriptor takes over the value's type."""
    kind = parameter.type_
    if descriptor.dynamic_typing:
        descriptor.type = kind.value
    elif is_declared and kind == Parameter.Type.NOT_SET:
        return "Static parameter cannot be undeclared"
    elif kind not in (Parameter.Type.NOT_SET, Parameter.Type(descriptor.type)):
        return f"Wrong parameter type, expected '{Parameter.Type(descriptor.type)}' got '{kind}'"
    if kind == Parameter.Type.DOUBLE and descriptor.floating_point_range:
        return _range_flaw(parameter, descriptor.floating_point_range[0])
    if kind == Parameter.Type.INTEGER and descriptor.integer_range:
        return _range_flaw(parameter, descriptor.integer_range[0])
    return ""


def _range_flaw(parameter: Parameter, limits: Any) -> str:
    """Why a number is out of its range or off its steps, or ''. Floating-point values need only be close to them."""
    name, value, step = parameter.name, parameter.value, limits.step
    low, high = sorted((limits.from_value, limits.to_value))
    whole = parameter.type_ == Parameter.Type.INTEGER
    tolerance = 0 if whole else TOLERANCE
    if any(math.isclose(value, end, rel_tol=tolerance) for end in (low, high)):
        return ""
    if not low < value < high:
        return f"Parameter {name} out of range{'.' if whole else ''} Min: {low}, Max: {high}, value: {value}"
    if step:
        steps = (value - low) // step if whole else round((value - low) / step)
        if not math.isclose(low + steps * step, value, rel_tol=tolerance):
            what = "a valid step" if whole else "close enough to a valid step"
            return (
                f"The parameter value for {name} is not {what}. Min: {low}, max: {high}, value: {value}, step: {step}"
            )
    return ""


def _is_listed(name: str, prefixes: list[str], depth: int) -> bool:
    """Whether a parameter is one that a list of what is below some prefixes, to some depth, contains."""
    starts = [prefix + PARAMETER_SEPARATOR_STRING for prefix in prefixes] or [""]
    below = [name.removeprefix(start) for start in starts if name.startswith(start)]
    return name in prefixes or any(not depth or rest.count(PARAMETER_SEPARATOR_STRING) < depth for rest in below)
