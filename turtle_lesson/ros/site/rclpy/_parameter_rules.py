"""The rules for parameters: how they are declared, which values a descriptor allows, and which are listed.

Reasons are given in rclpy's words (its node.py).
"""

from __future__ import annotations

import math
import warnings
from typing import Any

from .exceptions import InvalidParameterException
from .parameter import PARAMETER_SEPARATOR_STRING, Parameter

TOLERANCE = 1e-6
"""How far, relatively, a floating-point value may be off an end or a step of its range."""

ONLY_A_NAME = (
    "when declaring parameter named '{}', declaring a parameter only providing its name is deprecated. You have to "
    'either:\n\t- Pass a name and a default value different to "PARAMETER NOT SET" (and optionally a descriptor).\n'
    "\t- Pass a name and a parameter type.\n\t- Pass a name and a descriptor with `dynamic_typing=True"
)


def read_declaration(index: int, namespace: str, details: tuple[Any, ...]) -> tuple[str, Any, Any]:
    """Full name, default value and descriptor of a declaration: a tuple of name, and perhaps value and descriptor."""
    from rcl_interfaces.msg import ParameterDescriptor, ParameterValue

    if not 1 <= len(details) <= 3:
        raise TypeError(
            f"Invalid parameter tuple length at index {index} in parameters list: {details}; "
            "expecting length between 1 and 3"
        )
    name = _full_name(index, namespace, details[0])
    value = details[1] if len(details) > 1 else None
    descriptor = details[2] if len(details) > 2 else ParameterDescriptor()
    if not isinstance(descriptor, ParameterDescriptor):
        raise TypeError(f"Third element {descriptor} at index {index} in parameters list is not a ParameterDescriptor.")
    descriptor.name = name
    if len(details) == 1:
        warnings.warn(ONLY_A_NAME.format(name), UserWarning, stacklevel=4)
        descriptor.dynamic_typing = True
    if isinstance(value, Parameter.Type):
        _declare_type(name, value, descriptor)
        return name, None, descriptor
    if not descriptor.dynamic_typing:
        is_unset = isinstance(value, ParameterValue) and value.type == Parameter.Type.NOT_SET.value
        descriptor.type = Parameter.Type.from_parameter_value(None if is_unset else value).value
        if value is None or is_unset:
            raise ValueError("Cannot declare a statically typed parameter with default value of type PARAMETER_NOT_SET")
    return name, value, descriptor


def _full_name(index: int, namespace: str, name: object) -> str:
    if not isinstance(name, str):
        raise TypeError(f"First element {name} at index {index} in parameters list is not a str.")
    if not name:
        raise InvalidParameterException(name)
    return f"{namespace}{PARAMETER_SEPARATOR_STRING}{name}" if namespace else name


def _declare_type(name: str, kind: Parameter.Type, descriptor: Any) -> None:
    if kind == Parameter.Type.NOT_SET:
        raise ValueError(f"Cannot declare parameter {{{name}}} as statically typed of type NOT_SET")
    if descriptor.dynamic_typing:
        raise ValueError(
            f"When declaring parameter {{{name}}} passing a descriptor with `dynamic_typing=True` is not allowed when "
            "the parameter type is provided"
        )
    descriptor.type = kind.value


def why_refused(parameter: Parameter, descriptor: Any, is_declared: bool) -> str:
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
        return _integer_range_flaw(parameter, descriptor.integer_range[0])
    return ""


def _range_flaw(parameter: Parameter, limits: Any) -> str:
    """Why a floating-point value is out of its range or off its steps, or ''."""
    name, value, step = parameter.name, parameter.value, limits.step
    low, high = sorted((limits.from_value, limits.to_value))
    if any(math.isclose(value, end, rel_tol=TOLERANCE) for end in (low, high)):
        return ""
    if not low < value < high:
        return f"Parameter {name} out of range Min: {low}, Max: {high}, value: {value}"
    if step and not math.isclose(low + round((value - low) / step) * step, value, rel_tol=TOLERANCE):
        what = f"The parameter value for {name} is not close enough to a valid step."
        return f"{what} Min: {low}, max: {high}, value: {value}, step: {step}"
    return ""


def _integer_range_flaw(parameter: Parameter, limits: Any) -> str:
    """Why an integer is out of its range or off its steps, or ''."""
    name, value, step = parameter.name, parameter.value, limits.step
    low, high = sorted((limits.from_value, limits.to_value))
    if value in (low, high):
        return ""
    if not low < value < high:
        return f"Parameter {name} out of range. Min: {low}, Max: {high}, value: {value}"
    if step and (value - low) % step:
        what = f"The parameter value for {name} is not a valid step."
        return f"{what} Min: {low}, max: {high}, value: {value}, step: {step}"
    return ""


def check_prefixes(prefixes: object, depth: object) -> None:
    """Raise TypeError or ValueError for what `list_parameters` cannot go by."""
    if not isinstance(prefixes, list):
        raise TypeError(f"The prefixes argument must be a list, got {prefixes!r}")
    if not all(isinstance(prefix, str) for prefix in prefixes):
        raise TypeError("All prefixes must be instances of type str")
    if not isinstance(depth, int):
        raise TypeError(f"The depth must be instance of type int, got {depth!r}")
    if depth < 0:
        raise ValueError("The depth must be greater than or equal to zero")


def is_listed(name: str, prefixes: list[str], depth: int) -> bool:
    """Whether a parameter is one that a list of what is below some prefixes, to some depth, contains."""
    separator = PARAMETER_SEPARATOR_STRING
    if not prefixes:
        return depth == 0 or name.count(separator) < depth
    for prefix in prefixes:
        if name == prefix:
            return True
        if name.startswith(prefix + separator) and (depth == 0 or name[len(prefix) + 1 :].count(separator) < depth):
            return True
    return False
