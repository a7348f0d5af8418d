"""Messages as text: YAML and comma-separated values, as `ros2 topic echo` prints them.

The rules are those of rosidl_runtime_py (convert.py), as recorded from a real one.
"""

from __future__ import annotations

import array
import sys
from dataclasses import dataclass
from functools import cache
from typing import Any


@dataclass(frozen=True)
class Style:
    """How much of a message is shown: texts and arrays up to `truncate`, or without arrays or texts at all."""

    truncate: int | None = None
    no_arr: bool = False
    no_str: bool = False
    flow: bool = False


PLAIN = Style()


class _Fields(dict[str, Any]):
    """The fields of a message, which YAML shows in this order and always one a line."""


def message_to_yaml(message: Any, style: Style = PLAIN) -> str:
    """A message as YAML, with a line end."""
    import yaml

    return yaml.dump(
        _fields(message, style),
        Dumper=_dumper(),
        allow_unicode=True,
        width=sys.maxsize,
        default_flow_style=style.flow,
    )


@cache
def _dumper() -> Any:
    import yaml

    class Dumper(yaml.SafeDumper):
        def ignore_aliases(self, data: Any) -> bool:
            return True

    def represent(dumper: Any, fields: _Fields) -> Any:
        pairs = [(dumper.represent_data(name), dumper.represent_data(value)) for name, value in fields.items()]
        return yaml.MappingNode("tag:yaml.org,2002:map", pairs)

    Dumper.add_representer(_Fields, represent)
    return Dumper


def _fields(message: Any, style: Style) -> _Fields:
    types = zip(message.get_fields_and_field_types(), message.SLOT_TYPES, strict=True)
    return _Fields((name, _value(getattr(message, name), type_, style)) for name, type_ in types)


def _value(value: Any, type_: Any, style: Style) -> Any:
    if isinstance(value, bytes):
        return _cut("".join(map(chr, value)), style)
    if isinstance(value, str):
        return _text(value, style)
    if _is_array(value):
        if style.no_arr and type_ is not None:
            return array_info(value, type_)
        shown = [_value(each, None, style) for each in (value if style.truncate is None else value[: style.truncate])]
        return shown if len(shown) == len(value) else [*shown, "..."]
    if hasattr(value, "get_fields_and_field_types"):
        return _fields(value, style)
    return value.item() if hasattr(value, "item") else value


def message_to_csv(message: Any, style: Style = PLAIN) -> str:
    """A message as values with commas between them, without a line end."""
    result = ""
    for name, type_ in zip(message.get_fields_and_field_types(), message.SLOT_TYPES, strict=True):
        comma = "," if result else ""
        result += comma + _csv(getattr(message, name), type_, style)
    return result


def _csv(value: Any, type_: Any, style: Style) -> str:
    if isinstance(value, str):
        return _text(value, style)
    if isinstance(value, bytes):
        short = style.truncate is None or len(value) <= style.truncate
        return str(value if short else value[: style.truncate] + b"...")
    if _is_array(value):
        if style.no_arr and type_ is not None:
            return array_info(value, type_)
        shown = value if style.truncate is None else value[: style.truncate]
        texts = [_csv(each, None, style) for each in shown]
        return ",".join(texts if len(shown) == len(value) else [*texts, "..."])
    if hasattr(value, "get_fields_and_field_types"):
        return message_to_csv(value, style)
    return str(value)


def _is_array(value: Any) -> bool:
    return isinstance(value, (list, tuple, array.array)) or type(value).__name__ == "ndarray"


def _text(value: str, style: Style) -> str:
    return f"<string length: <{len(value)}>>" if style.no_str else _cut(value, style)


def _cut(value: str, style: Style) -> str:
    if style.truncate is None or len(value) <= style.truncate:
        return value
    return value[: style.truncate] + "..."


def array_info(value: Any, type_: Any) -> str:
    """What stands for an array that is not shown: its type and length."""
    from turtle_lesson.ros.interfaces import slot_types

    element = _element_name(type_.value_type)
    if isinstance(type_, slot_types.Array):
        return f"<array type: {element}[{type_.size}]>"
    if isinstance(type_, slot_types.BoundedSequence):
        return f"<sequence type: {element}[{type_.maximum_size}], length: {len(value)}>"
    return f"<sequence type: {element}, length: {len(value)}>"


def _element_name(type_: Any) -> str:
    from turtle_lesson.ros.interfaces import slot_types

    if isinstance(type_, slot_types.NamespacedType):
        return "/".join([*type_.namespaces, type_.name])
    if isinstance(type_, slot_types.AbstractGenericString):
        return "wstring" if "wstring" in str(type_) else "string"
    return str(type_)
