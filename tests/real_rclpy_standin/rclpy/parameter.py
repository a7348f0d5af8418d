"""A parameter's value as Python has it, and back: here all are numbers."""

from __future__ import annotations

from enum import Enum
from typing import Any

from rcl_interfaces.msg import ParameterValue


class Parameter:
    """A name, a type and a value."""

    class Type(Enum):
        """The types that are there, by their numbers in rcl_interfaces/msg/ParameterType."""

        NOT_SET = 0
        DOUBLE = 3

    def __init__(self, name: str, type_: Parameter.Type, value: Any) -> None:
        self.name, self.type_, self.value = name, type_, value

    def get_parameter_value(self) -> Any:
        return ParameterValue(type=self.type_.value, double_value=self.value)


def parameter_value_to_python(parameter_value: Any) -> float | None:
    if Parameter.Type(parameter_value.type) is Parameter.Type.NOT_SET:
        return None
    return float(parameter_value.double_value)


def get_parameter_value(string_value: str) -> Any:
    return Parameter("", Parameter.Type.DOUBLE, float(string_value)).get_parameter_value()
