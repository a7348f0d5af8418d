"""Parameters: a name with a value of one of ROS's types."""

from __future__ import annotations

import array
from enum import Enum
from typing import Any

PARAMETER_SEPARATOR_STRING = "."


class Parameter:
    """`Parameter(name, type_, value)`; the type is found from the value if it is left out."""

    class Type(Enum):
        """The types that a parameter can have (rcl_interfaces/msg/ParameterType)."""

        NOT_SET = 0
        BOOL = 1
        INTEGER = 2
        DOUBLE = 3
        STRING = 4
        BYTE_ARRAY = 5
        BOOL_ARRAY = 6
        INTEGER_ARRAY = 7
        DOUBLE_ARRAY = 8
        STRING_ARRAY = 9

        @classmethod
        def from_parameter_value(cls, parameter_value: Any) -> Parameter.Type:
            """The type of a Python value; TypeError if no parameter can have it."""
            if parameter_value is None:
                return cls.NOT_SET
            for kind, name in ((bool, "BOOL"), (int, "INTEGER"), (float, "DOUBLE"), (str, "STRING")):
                if isinstance(parameter_value, kind):
                    return cls[name]
            if isinstance(parameter_value, (list, tuple, array.array)):
                return cls._from_sequence(parameter_value)
            raise TypeError(f"The given value is not one of the allowed types '{parameter_value}'.")

        @classmethod
        def _from_sequence(cls, values: Any) -> Parameter.Type:
            kinds = ((bytes, "BYTE"), (bool, "BOOL"), (int, "INTEGER"), (float, "DOUBLE"), (str, "STRING"))
            for kind, name in kinds:
                if all(isinstance(value, kind) for value in values):
                    return cls[f"{name}_ARRAY"]
            raise TypeError(f"The given value is not a list of one of the allowed types '{values}'.")

        def check(self, parameter_value: Any) -> bool:
            """Whether a Python value has this type."""
            try:
                return Parameter.Type.from_parameter_value(parameter_value) == self or (
                    isinstance(parameter_value, (list, tuple)) and not parameter_value and self.name.endswith("_ARRAY")
                )
            except TypeError:
                return False

    @classmethod
    def from_parameter_msg(cls, param_msg: Any) -> Parameter:
        """From rcl_interfaces/msg/Parameter."""
        return cls(param_msg.name, cls.Type(param_msg.value.type), parameter_value_to_python(param_msg.value))

    def __init__(self, name: str, type_: Parameter.Type | None = None, value: Any = None) -> None:
        if type_ is None:
            type_ = Parameter.Type.from_parameter_value(value)
        if not isinstance(type_, Parameter.Type):
            raise TypeError("type must be an instance of Parameter.Type")
        if not type_.check(value):
            raise ValueError(f"Type '{type_}' and value '{value}' do not agree")
        self._type_ = type_
        self._name = name
        self._value = value

    @property
    def name(self) -> str:
        """The parameter's name."""
        return self._name

    @property
    def type_(self) -> Parameter.Type:
        """The parameter's type."""
        return self._type_

    @property
    def value(self) -> Any:
        """The value, as Python has it."""
        return self._value

    def __repr__(self) -> str:
        return f"<rclpy.parameter.Parameter {self._name}={self._value!r}>"

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Parameter):
            return NotImplemented
        return (self._name, self._type_, self._value) == (other._name, other._type_, other._value)

    __hash__ = None  # type: ignore[assignment]

    def get_parameter_value(self) -> Any:
        """As rcl_interfaces/msg/ParameterValue."""
        from rcl_interfaces.msg import ParameterValue

        message = ParameterValue(type=self._type_.value)
        if self._type_ != Parameter.Type.NOT_SET:
            field = f"{self._type_.name.lower()}_value"
            setattr(message, field, list(self._value) if field.endswith("array_value") else self._value)
        return message

    def to_parameter_msg(self) -> Any:
        """As rcl_interfaces/msg/Parameter."""
        from rcl_interfaces.msg import Parameter as Message

        return Message(name=self._name, value=self.get_parameter_value())


def parameter_value_to_python(parameter_value: Any) -> Any:
    """The Python value of an rcl_interfaces/msg/ParameterValue."""
    kind = Parameter.Type(parameter_value.type)
    if kind == Parameter.Type.NOT_SET:
        return None
    value = getattr(parameter_value, f"{kind.name.lower()}_value")
    return list(value) if kind.name.endswith("_ARRAY") else value


def get_parameter_value(string_value: str) -> Any:
    """An rcl_interfaces/msg/ParameterValue from text, read as YAML, as the command line does."""
    import yaml

    try:
        value = yaml.safe_load(string_value)
    except yaml.YAMLError:
        value = string_value
    try:
        return Parameter("", value=value).get_parameter_value()
    except TypeError:
        return Parameter("", value=string_value).get_parameter_value()
