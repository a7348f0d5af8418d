"""Parameters: a name with a value of one of ROS's types."""

from __future__ import annotations

import array
from enum import Enum
from types import GenericAlias
from typing import Any

from ._hints import find_taken

PARAMETER_SEPARATOR_STRING = "."

AllowableParameterValue = (
    None | bool | int | float | str | list[bytes] | list[bool] | list[int] | list[float] | list[str] | array.array
)
"""What a parameter can hold."""

_PYTHON: dict[str, type] = {"BOOL": bool, "INTEGER": int, "DOUBLE": float, "STRING": str, "BYTE": bytes}


class Parameter:
    """`Parameter(name, type_, value)`; the type is found from the value if it is left out."""

    __class_getitem__: Any = classmethod(GenericAlias)  # newer releases: Parameter[float] in a hint

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
            for kind in cls:
                if kind.check(parameter_value):
                    return kind
            what = "a list of one" if isinstance(parameter_value, (list, tuple, array.array)) else "one"
            raise TypeError(f"The given value is not {what} of the allowed types '{parameter_value}'.")

        def check(self, parameter_value: Any) -> bool:
            """Whether a Python value can have this type. An empty list can be a list of any type."""
            if self is Parameter.Type.NOT_SET:
                return parameter_value is None
            if not self.name.endswith("_ARRAY"):
                return isinstance(parameter_value, _PYTHON[self.name])
            kind = _PYTHON[self.name.removesuffix("_ARRAY")]
            lists = (list, tuple, array.array) if kind in (int, float) else (list, tuple)
            if not isinstance(parameter_value, lists) or not all(isinstance(value, kind) for value in parameter_value):
                return False
            return kind is not bytes or all(len(value) == 1 for value in parameter_value)

    @classmethod
    def from_parameter_msg(cls, param_msg: Any) -> Parameter:
        """From rcl_interfaces/msg/Parameter. A list of numbers stays the message's `array.array`, as in rclpy."""
        kind = cls.Type(param_msg.value.type)
        return cls(param_msg.name, kind, _value_in(param_msg.value, kind))

    def __init__(self, name: str, type_: Parameter.Type | None = None, value: Any = None) -> None:
        if type_ is None:
            type_ = Parameter.Type.from_parameter_value(value)
        if not isinstance(type_, Parameter.Type):
            raise TypeError(f"type must be an instance of '{Parameter.Type!r}'")
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
    """The Python value of an rcl_interfaces/msg/ParameterValue. Raises ValueError for a type that there is not."""
    kind = Parameter.Type(parameter_value.type)
    value = _value_in(parameter_value, kind)
    return list(value) if kind.name.endswith("_ARRAY") else value


def _value_in(parameter_value: Any, kind: Parameter.Type) -> Any:
    """What stands in the message's field for this type."""
    return None if kind == Parameter.Type.NOT_SET else getattr(parameter_value, f"{kind.name.lower()}_value")


def get_parameter_value(string_value: str) -> Any:
    """An rcl_interfaces/msg/ParameterValue from text, read as YAML, as the command line does.

    What is neither a value nor a list of values of one type is taken for a text.
    """
    import yaml

    from turtle_lesson.ros.runtime.bounded_yaml import safe_load

    try:
        value = safe_load(string_value)
    except (yaml.YAMLError, ValueError):
        value = string_value
    for name in ("BOOL", "INTEGER", "DOUBLE", "BOOL_ARRAY", "INTEGER_ARRAY", "DOUBLE_ARRAY", "STRING_ARRAY"):
        kind = Parameter.Type[name]
        numbers = (value if isinstance(value, list) else [value]) if name.startswith("INTEGER") else []
        if kind.check(value) and all(-(2**63) <= number < 2**63 for number in numbers):
            return Parameter("", kind, value).get_parameter_value()
    text = value if isinstance(value, str) else string_value
    return Parameter("", Parameter.Type.STRING, text).get_parameter_value()


def parameter_dict_from_yaml_file(
    parameter_file: str, use_wildcard: bool = False, target_nodes: list[str] | None = None, namespace: str = ""
) -> dict[str, Any]:
    """The parameters in a YAML file, as rcl_interfaces/msg/Parameter, by their full names.

    Args:
        parameter_file: the file.
        use_wildcard: whether those for all nodes (`/**`) are taken, too; others go before them.
        target_nodes: of which nodes, as the file names them; None for all.
        namespace: what is put before each name.

    Raises:
        RuntimeError: if the file has nothing for a node, or is no parameter file.
        OSError: if it cannot be read.
    """
    from turtle_lesson.ros.runtime.bounded_yaml import LONGEST, safe_load

    with open(parameter_file, encoding="utf-8") as file:
        content = safe_load(file.read(LONGEST + 1))
    if not isinstance(content, dict):
        raise RuntimeError(
            f"YAML file is not a valid ROS parameter file: it should map nodes to ros__parameters: {content!r}"
        )
    keys = ["/**"] if use_wildcard and "/**" in content else []
    for node in target_nodes or []:
        if node not in content:
            raise RuntimeError(f"Param file does not contain parameters for {node},only for nodes: {list(content)} ")
    keys += target_nodes or [key for key in content if key != "/**"]
    if not keys:
        raise RuntimeError("Param file does not contain selected parameters")
    found: dict[str, Any] = {}
    for key in keys:
        if not isinstance(content[key], dict) or "ros__parameters" not in content[key]:
            raise RuntimeError(f"YAML file is not a valid ROS parameter file for node {key}")
        found.update(content[key]["ros__parameters"] or {})
    return _flat(namespace, found)


def _flat(prefix: str, values: dict[str, Any]) -> dict[str, Any]:
    from rcl_interfaces.msg import Parameter as Message

    found: dict[str, Any] = {}
    for key, value in values.items():
        name = f"{prefix}{key}"
        if isinstance(value, dict):
            found.update(_flat(name + PARAMETER_SEPARATOR_STRING, value))
        else:
            found[name] = Message(name=name, value=get_parameter_value(str(value)))
    return found


__getattr__ = find_taken(__name__)
