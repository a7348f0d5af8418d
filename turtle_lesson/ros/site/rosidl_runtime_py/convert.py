"""Messages as text and dictionaries: what `ros2 topic echo` prints.

The rules are those of rosidl_runtime_py/convert.py, pinned by recordings of a real one.
"""

from __future__ import annotations

import array
import sys
from collections import OrderedDict
from dataclasses import dataclass
from functools import cache
from typing import Any

from rosidl_parser.definition import Array, BoundedSequence, NamespacedType


@dataclass(frozen=True, slots=True)
class _Style:
    """How much is shown: texts and arrays up to a length, or without arrays or texts at all; and bytes as they are."""

    length: int | None
    no_arr: bool
    no_str: bool
    raw_bytes: bool = False


def message_to_yaml(
    msg: Any,
    *,
    truncate_length: int | None = None,
    no_arr: bool = False,
    no_str: bool = False,
    flow_style: bool = False,
) -> str:
    """A message as YAML, with a line end; in `flow_style` on one line.

    Texts and arrays are cut after `truncate_length` characters or elements; `no_arr` and `no_str` leave their length alone.
    """
    import yaml

    shown = message_to_ordereddict(msg, truncate_length=truncate_length, no_arr=no_arr, no_str=no_str)
    return yaml.dump(shown, Dumper=_dumper(), allow_unicode=True, width=sys.maxsize, default_flow_style=flow_style)


def message_to_csv(msg: Any, *, truncate_length: int | None = None, no_arr: bool = False, no_str: bool = False) -> str:
    """A message as values with commas between them, without a line end; the arguments are those of `message_to_yaml`."""
    return _csv(_fields(msg, _Style(truncate_length, no_arr, no_str, raw_bytes=True)))


def message_to_ordereddict(
    msg: Any, *, truncate_length: int | None = None, no_arr: bool = False, no_str: bool = False
) -> OrderedDict[str, Any]:
    """A message as plain values by the fields' names, in their order; the arguments are those of `message_to_yaml`."""
    return _fields(msg, _Style(truncate_length, no_arr, no_str))


def get_message_slot_types(msg: Any) -> OrderedDict[str, Any]:
    """The types of a message's fields, as objects of `rosidl_parser.definition`, by the fields' names."""
    return OrderedDict(zip(msg.get_fields_and_field_types(), msg.SLOT_TYPES, strict=True))


@cache
def _dumper() -> Any:
    import yaml

    class Dumper(yaml.SafeDumper):
        """Writes ordered dictionaries as plain mappings in their order, and everything in full."""

        def ignore_aliases(self, data: Any) -> bool:
            return True

    def represent(dumper: Any, fields: OrderedDict[str, Any]) -> Any:
        pairs = [(dumper.represent_data(name), dumper.represent_data(value)) for name, value in fields.items()]
        return yaml.MappingNode("tag:yaml.org,2002:map", pairs)

    Dumper.add_representer(OrderedDict, represent)
    return Dumper


def _fields(message: Any, style: _Style) -> OrderedDict[str, Any]:
    types = get_message_slot_types(message)
    return OrderedDict((name, _plain(getattr(message, name), type_, style)) for name, type_ in types.items())


def _plain(value: Any, type_: Any, style: _Style) -> Any:
    """The value of a field (or of an element: then `type_` is None) as plain Python."""
    if isinstance(value, bytes):
        if style.raw_bytes:
            short = style.length is None or len(value) <= style.length
            return value if short else value[: style.length] + b"..."
        return _cut("".join(map(chr, value)), style)
    if isinstance(value, str):
        return f"<string length: <{len(value)}>>" if style.no_str else _cut(value, style)
    if isinstance(value, (list, tuple, array.array)) or type(value).__name__ == "ndarray":
        if style.no_arr and type_ is not None:
            return _array_info(value, type_)
        shown = [_plain(each, None, style) for each in value[: style.length]]
        shown += ["..."] * (len(shown) < len(value))
        return tuple(shown) if isinstance(value, tuple) else shown
    if hasattr(value, "get_fields_and_field_types"):
        return _fields(value, style)
    if hasattr(value, "item"):
        return value.item()
    # A bool, int or float of Python, whatever subclass, such as an enum, was put into the field.
    return value if isinstance(value, bool) else int(value) if isinstance(value, int) else float(value)


def _csv(value: Any) -> str:
    """Plain values with commas between them."""
    if isinstance(value, OrderedDict):
        result = ""
        for each in value.values():
            result += "," * bool(result) + _csv(each)  # like the real one, without a comma behind an empty beginning
        return result
    return ",".join(map(_csv, value)) if isinstance(value, (list, tuple)) else str(value)


def _cut(value: str, style: _Style) -> str:
    if style.length is None or len(value) <= style.length:
        return str.__str__(value)
    return str.__str__(value[: style.length]) + "..."


def _array_info(value: Any, type_: Any) -> str:
    """What stands for an array that is not shown: its type and length."""
    kind = type_.value_type
    element = "/".join(kind.namespaced_name()) if isinstance(kind, NamespacedType) else str(kind).partition("<")[0]
    if isinstance(type_, Array):
        return f"<array type: {element}[{type_.size}]>"
    bound = f"[{type_.maximum_size}]" if isinstance(type_, BoundedSequence) else ""
    return f"<sequence type: {element}{bound}, length: {len(value)}>"
