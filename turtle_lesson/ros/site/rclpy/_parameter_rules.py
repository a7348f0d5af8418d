"""The ranges that a parameter's descriptor can demand, in rclpy's words."""

from __future__ import annotations

import math
from typing import Any

from .parameter import Parameter


def range_flaw(parameter: Parameter, limits: Any) -> str:
    """Why a floating-point value is out of its range or off its steps, or ''."""
    value, low, high, step = parameter.value, limits.from_value, limits.to_value, limits.step
    if any(math.isclose(value, end) for end in (low, high)):
        return ""
    if not low < value < high:
        return f"Parameter {parameter.name} out of range Min: {low}, Max: {high}, value: {value}"
    if step and not math.isclose(round((value - low) / step), (value - low) / step):
        return f"The parameter value for {parameter.name} is not a valid step. Min: {low}, max: {high}, value: {value}, step: {step}"
    return ""


def integer_range_flaw(parameter: Parameter, limits: Any) -> str:
    """Why an integer is out of its range or off its steps, or ''."""
    value, low, high, step = parameter.value, limits.from_value, limits.to_value, limits.step
    if value in (low, high):
        return ""
    if not low < value < high:
        return f"Parameter {parameter.name} out of range. Min: {low}, Max: {high}, value: {value}"
    if step and (value - low) % step:
        return f"The parameter value for {parameter.name} is not a valid step. Min: {low}, max: {high}, value: {value}, step: {step}"
    return ""


def describe_type(parameter: Parameter) -> int:
    """The number of a parameter's type, for its descriptor."""
    return parameter.type_.value
