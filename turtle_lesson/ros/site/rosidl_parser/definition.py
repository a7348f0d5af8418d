"""The types of fields, as `SLOT_TYPES` of a message class holds them (names as in rosidl_parser/definition.py)."""

# ruff: noqa: F401

from turtle_lesson.ros.idl.message import (
    AbstractGenericString,
    AbstractNestableType,
    AbstractNestedType,
    AbstractSequence,
    AbstractString,
    AbstractType,
    AbstractWString,
    Array,
    BasicType,
    BoundedSequence,
    BoundedString,
    BoundedWString,
    NamedType,
    NamespacedType,
    UnboundedSequence,
    UnboundedString,
    UnboundedWString,
)
