"""The types of fields, as `SLOT_TYPES` of a message class holds them (names as in rosidl_parser/definition.py)."""

# ruff: noqa: F401

from turtle_lesson.ros.idl.message import (
    AbstractGenericString,
    AbstractNestedType,
    AbstractSequence,
    AbstractType,
    Array,
    BasicType,
    BoundedSequence,
    BoundedString,
    BoundedWString,
    NamespacedType,
    UnboundedSequence,
    UnboundedString,
    UnboundedWString,
)
