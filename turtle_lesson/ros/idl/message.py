"""What all generated message classes share: how they show, compare and refuse, and their fields' types."""

from __future__ import annotations

from array import array
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any, ClassVar

from .checks import are_on, refusal
from .model import FieldType
from .names import did_you_mean

plain_text = str.__str__  # a plain str, even of an instance of a subclass


class Unset:
    """The default of a constructor's argument that stands for a fresh value: no value that a program could pass."""

    def __repr__(self) -> str:
        return "..."


def message_repr(message: Any) -> str:
    """`geometry_msgs.msg.Vector3(x=0.0, y=0.0, z=0.0)`."""
    kind = type(message)
    package = kind.__module__.rpartition(".")[0]
    name = f"{package}.{kind.__name__}" if package else kind.__name__
    values = ((slot, getattr(message, slot)) for slot in message.__slots__)
    shown = (f"{slot[1:]}={value.tolist() if isinstance(value, array) else value!r}" for slot, value in values)
    return f"{name}({', '.join(shown)})"


def numpy_array(values: Any, dtype: str) -> Any:
    """Numbers as an array of numpy, whose import takes as long as the rest of a start: the first message with one does it.

    Raises AssertionError, without words as ROS does, for numbers that are not in a row.
    """
    import numpy

    made = numpy.array(values, dtype)
    if made.ndim != 1:
        raise refusal("", f"The field takes numbers in a row, not an array of the shape {made.shape}")
    return made


def numpy_zeros(size: int, dtype: str) -> Any:
    """`numpy.zeros`, as above."""
    import numpy

    return numpy.zeros(size, dtype)


def same_array(one: Any, other: Any) -> bool:
    """Whether two numpy arrays hold the same numbers."""
    return bool(one.shape == other.shape and (one == other).all())


def refuse_arguments(message_class: type, unknown: Iterable[str]) -> None:
    """Refuse constructor arguments that are no fields, where values are checked.

    `check_fields`, with which newer releases switch the checks on for one message, is taken, and has no other effect.
    """
    names = sorted(set(unknown) - {"check_fields"})
    if not names or not are_on():
        return
    fields = [slot[1:] for slot in message_class.__slots__]  # type: ignore[attr-defined]
    hints = [hint for hint in (did_you_mean(name, fields) for name in names) if hint]
    note = " ".join([*hints, f"The fields are: {', '.join(fields) or 'none'}"])
    raise refusal(f"Invalid arguments passed to constructor: {', '.join(names)}", note)


# -- slot types ---------------------------------------------------------------------------------------------------
# What `SLOT_TYPES` of a message class holds: its fields' types as small objects.
# Names, attributes and what is a kind of what are those of `rosidl_parser.definition`, so that code written for it
# can look at ours (`rosidl_parser` itself, in `ros/site`, is these classes).

TYPE_NAMES = {"float32": "float", "float64": "double", "bool": "boolean", "byte": "octet", "char": "uint8"}


class AbstractType:
    """Any type of a field."""

    __slots__ = ()
    _shown: ClassVar[str]
    """How one is shown, with `{0}` for itself."""

    def __str__(self) -> str:
        return self._shown.format(self)


@dataclass(frozen=True, slots=True)
class BasicType(AbstractType):
    """A number, a boolean or a byte, by its IDL name: `double`, `int32`, `boolean`, `octet`, ..."""

    typename: str
    _shown = "{0.typename}"


@dataclass(frozen=True, slots=True)
class NamespacedType(AbstractType):
    """A message: `NamespacedType(['geometry_msgs', 'msg'], 'Vector3')`."""

    namespaces: list[str]
    name: str
    _shown = "{0.namespaces[0]}/{0.name}"

    def namespaced_name(self) -> tuple[str, ...]:
        """`('geometry_msgs', 'msg', 'Vector3')`."""
        return (*self.namespaces, self.name)


class AbstractGenericString(AbstractType):
    """Any string."""

    __slots__ = ()


@dataclass(frozen=True, slots=True)
class UnboundedString(AbstractGenericString):
    """A string of any length, of 8-bit characters (UTF-8)."""

    _shown = "string"


@dataclass(frozen=True, slots=True)
class BoundedString(AbstractGenericString):
    """A string of at most `maximum_size` characters."""

    maximum_size: int
    _shown = "string<{0.maximum_size}>"


@dataclass(frozen=True, slots=True)
class UnboundedWString(AbstractGenericString):
    """A string of any length, of 16-bit characters (UTF-16)."""

    _shown = "wstring"


@dataclass(frozen=True, slots=True)
class BoundedWString(AbstractGenericString):
    """A wide string of at most `maximum_size` characters."""

    maximum_size: int
    _shown = "wstring<{0.maximum_size}>"


@dataclass(frozen=True, slots=True)
class AbstractNestedType(AbstractType):
    """Several values of one type."""

    value_type: AbstractType


@dataclass(frozen=True, slots=True)
class Array(AbstractNestedType):
    """Exactly `size` values."""

    size: int
    _shown = "{0.value_type}[{0.size}]"


class AbstractSequence(AbstractNestedType):
    """A variable number of values."""

    __slots__ = ()


@dataclass(frozen=True, slots=True)
class UnboundedSequence(AbstractSequence):
    """Any number of values."""

    _shown = "sequence<{0.value_type}>"


@dataclass(frozen=True, slots=True)
class BoundedSequence(AbstractSequence):
    """At most `maximum_size` values."""

    maximum_size: int
    _shown = "sequence<{0.value_type}, {0.maximum_size}>"


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
