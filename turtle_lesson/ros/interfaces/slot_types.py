"""What `SLOT_TYPES` of a message class holds: its fields' types as small objects.

Names and attributes are those of `rosidl_parser.definition`, so that code written for it can look at ours.
"""

from __future__ import annotations

from dataclasses import dataclass

from turtle_lesson.ros.interfaces.model import FieldType

TYPE_NAMES = {"float32": "float", "float64": "double", "bool": "boolean", "byte": "octet", "char": "uint8"}


class AbstractType:
    """Any type of a field."""

    __slots__ = ()


@dataclass(frozen=True, slots=True)
class BasicType(AbstractType):
    """A number, a boolean or a byte, by its IDL name: `double`, `int32`, `boolean`, `octet`, ..."""

    typename: str

    def __str__(self) -> str:
        return self.typename


@dataclass(frozen=True, slots=True)
class NamespacedType(AbstractType):
    """A message: `NamespacedType(['geometry_msgs', 'msg'], 'Vector3')`."""

    namespaces: list[str]
    name: str

    def __str__(self) -> str:
        return f"{self.namespaces[0]}/{self.name}"


class AbstractGenericString(AbstractType):
    """Any string."""

    __slots__ = ()


@dataclass(frozen=True, slots=True)
class UnboundedString(AbstractGenericString):
    """A string of any length."""

    def __str__(self) -> str:
        return "string"


@dataclass(frozen=True, slots=True)
class BoundedString(AbstractGenericString):
    """A string of at most `maximum_size` characters."""

    maximum_size: int

    def __str__(self) -> str:
        return f"string<{self.maximum_size}>"


@dataclass(frozen=True, slots=True)
class UnboundedWString(AbstractGenericString):
    """A wide string of any length."""

    def __str__(self) -> str:
        return "wstring"


@dataclass(frozen=True, slots=True)
class BoundedWString(AbstractGenericString):
    """A wide string of at most `maximum_size` characters."""

    maximum_size: int

    def __str__(self) -> str:
        return f"wstring<{self.maximum_size}>"


@dataclass(frozen=True, slots=True)
class AbstractNestedType(AbstractType):
    """Several values of one type."""

    value_type: AbstractType


@dataclass(frozen=True, slots=True)
class Array(AbstractNestedType):
    """Exactly `size` values."""

    size: int

    def __str__(self) -> str:
        return f"{self.value_type}[{self.size}]"


class AbstractSequence(AbstractNestedType):
    """A variable number of values."""

    __slots__ = ()


@dataclass(frozen=True, slots=True)
class UnboundedSequence(AbstractSequence):
    """Any number of values."""

    def __str__(self) -> str:
        return f"sequence<{self.value_type}>"


@dataclass(frozen=True, slots=True)
class BoundedSequence(AbstractSequence):
    """At most `maximum_size` values."""

    maximum_size: int

    def __str__(self) -> str:
        return f"sequence<{self.value_type}, {self.maximum_size}>"


def slot_type(type_: FieldType) -> AbstractType:
    """The slot type of a field; its text is what `get_fields_and_field_types` says."""
    element = _element(type_)
    if type_.size is None:
        return UnboundedSequence(element) if type_.is_array else element
    return Array(element, type_.size) if type_.is_fixed else BoundedSequence(element, type_.size)


def _element(type_: FieldType) -> AbstractType:
    if type_.package is not None:
        return NamespacedType([type_.package, type_.folder], type_.base)
    bound = type_.string_bound
    if type_.base == "string":
        return UnboundedString() if bound is None else BoundedString(bound)
    if type_.base == "wstring":
        return UnboundedWString() if bound is None else BoundedWString(bound)
    return BasicType(TYPE_NAMES.get(type_.base, type_.base))
