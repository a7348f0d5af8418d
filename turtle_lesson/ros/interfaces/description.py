"""What a type looks like, as data, and the hash by which two machines know that they mean the same (REP 2011, "RIHS01").

The names and numbers are those of rosidl_generator_type_description and of type_description_interfaces/msg/FieldType.
"""

from __future__ import annotations

import hashlib
import json
from typing import Any

from turtle_lesson.ros.interfaces.model import Field, FieldType, MessageDefinition

NESTED = 1
BASES = {
    "int8": 2,
    "uint8": 3,
    "char": 3,  # a .msg file's char is an uint8
    "int16": 4,
    "uint16": 5,
    "int32": 6,
    "uint32": 7,
    "int64": 8,
    "uint64": 9,
    "float32": 10,
    "float64": 11,
    "bool": 15,
    "byte": 16,
    "string": 17,
    "wstring": 18,
}
BOUNDED_STRING = 4
"""What a bounded string's number is greater by than that of one without a bound."""
ARRAYS = {"none": 0, "fixed": 48, "bounded": 96, "unbounded": 144}
NOTHING = Field(FieldType("uint8"), "structure_needs_at_least_one_member")
"""The field that messages without fields have in C, and so on the wire."""

Description = dict[str, Any]


def type_description(interface: Any) -> Description:
    """The description of a message, service or action class: its own, and those of all types in it, by name."""
    own, pending = _individual(interface)
    found: dict[str, Description] = {}
    while pending:
        part = pending.pop()
        if part._TYPE_NAME not in found:
            found[part._TYPE_NAME], more = _individual(part)
            pending += more
    return {"type_description": own, "referenced_type_descriptions": [found[name] for name in sorted(found)]}


def hash_of(interface: Any) -> bytes:
    """The 32 bytes by which a type is known."""
    description = type_description(interface)
    for part in (description["type_description"], *description["referenced_type_descriptions"]):
        for field in part["fields"]:
            del field["default_value"]
    text = json.dumps(description, separators=(", ", ": "))
    return hashlib.sha256(text.encode("utf-8")).digest()


def sources_of(interface: Any) -> list[tuple[str, str, str]]:
    """Name, encoding and text of the file of a type, and of those of all types in it; without text if it has no file."""
    found: dict[str, tuple[str, str, str]] = {}
    pending = [interface]
    while pending:
        part = pending.pop(0)
        name = part._TYPE_NAME
        if name not in found:
            found[name] = (name, *_source_of(part))
            pending += _individual(part)[1]
    return list(found.values())


def _source_of(interface: Any) -> tuple[str, str]:
    if "_" in interface._TYPE_NAME.rpartition("/")[2]:
        return "implicit", ""
    return interface._DEFINITION.folder, interface._DEFINITION.text


def _individual(interface: Any) -> tuple[Description, list[Any]]:
    """A type's own description, and the classes that it names."""
    members = _parts_of(interface)
    if members:
        fields = [_field(name, NESTED, nested=part._TYPE_NAME) for name, part in members]
        return {"type_name": interface._TYPE_NAME, "fields": fields}, [part for _, part in members]
    definition: MessageDefinition = interface._DEFINITION
    classes = {kind.name: kind.element_class for kind in interface._KINDS}
    fields = [_described(field, classes.get(field.name)) for field in definition.fields or (NOTHING,)]
    return {"type_name": interface._TYPE_NAME, "fields": fields}, [
        each for each in classes.values() if each is not None
    ]


def _parts_of(interface: Any) -> list[tuple[str, Any]]:
    """What a service or an action consists of; nothing for a message."""
    if hasattr(interface, "Impl"):
        impl = interface.Impl
        return [
            ("goal", interface.Goal),
            ("result", interface.Result),
            ("feedback", interface.Feedback),
            ("send_goal_service", impl.SendGoalService),
            ("get_result_service", impl.GetResultService),
            ("feedback_message", impl.FeedbackMessage),
        ]
    if hasattr(interface, "Request"):
        names = ("Request", "Response", "Event")
        return [(f"{name.lower()}_message", getattr(interface, name)) for name in names]
    return []


def _described(field: Field, element_class: Any) -> Description:
    type_ = field.type
    bound = type_.string_bound or 0
    number = NESTED if element_class is not None else BASES[type_.base] + (BOUNDED_STRING if bound else 0)
    nested = "" if element_class is None else element_class._TYPE_NAME
    described = _field(field.name, number + ARRAYS[type_.array], type_.size or 0, bound, nested)
    described["default_value"] = "" if field.default is None else str(field.default)
    return described


def _field(name: str, number: int, capacity: int = 0, string_capacity: int = 0, nested: str = "") -> Description:
    type_ = {"type_id": number, "capacity": capacity, "string_capacity": string_capacity, "nested_type_name": nested}
    return {"name": name, "type": type_, "default_value": ""}
