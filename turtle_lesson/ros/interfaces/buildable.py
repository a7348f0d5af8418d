"""What can be read in a definition and yet not be built.

ROS 2 turns each definition into an IDL file, and that into C, C++ and Python. A build stops where a name is a word of
one of these languages, or where a default value gets lost on the way (facts: rosidl_adapter/msg, rosidl_parser/parser.py,
rosidl_generator_py; for special numbers ros2/rosidl issue 351, for words of C++ issue 272).
"""

from __future__ import annotations

import codecs
import keyword
import re
import warnings
from math import isfinite

from turtle_lesson.ros.interfaces.checks import FLOAT_BOUNDS
from turtle_lesson.ros.interfaces.errors import InvalidMemberName, InvalidResourceName, InvalidType, InvalidValue
from turtle_lesson.ros.interfaces.model import Constant, Field, Plain, Value
from turtle_lesson.ros.interfaces.names import STRINGS

# Attributes of our own in the classes, which fields of these names would replace.
TAKEN = ("wire_copy", "fields_and_field_types")


def _words(text: str) -> frozenset[str]:
    return frozenset(text.split())


CPP_WORDS = _words(
    """
    alignas alignof and and_eq asm auto bitand bitor bool break case catch char char16_t char32_t class compl const
    const_cast constexpr continue decltype default delete do double dynamic_cast else enum explicit export extern false
    float for friend goto if inline int long mutable namespace new noexcept not not_eq nullptr operator or or_eq private
    protected public register reinterpret_cast restrict return short signed sizeof static static_assert static_cast
    struct switch template this thread_local throw true try typedef typeid typename union unsigned using virtual void
    volatile wchar_t while xor xor_eq
    """
)
"""The reserved words of C and of C++17."""

MAX_WEIGHT = 10_000_000
"""How many values and messages one message may consist of: more would fill the memory of a small computer."""


def check_field(field: Field) -> None:
    """Raise InvalidDefinition for a field that no build gets through."""
    if field.type.base in ("time", "duration"):
        better = f"builtin_interfaces/{field.type.base.capitalize()}"
        raise InvalidType(f"the type '{field.type.base}' belongs to ROS 1", hint=f"Write '{better} {field.name}'")
    if keyword.iskeyword(field.name):
        raise InvalidMemberName(
            f"Member name '{field.name}' is a reserved keyword in Python and is not supported at the moment."
            " Please use a different name"
        )
    if field.name in CPP_WORDS:
        reason = f"Member name '{field.name}' is a keyword of C++, in which ROS 2 also generates code"
        raise InvalidMemberName(reason, hint=f"Please use a different name, such as '{field.name}_value'")
    if field.name in TAKEN:
        raise InvalidMemberName(f"the field name '{field.name}' is taken", hint="Please use a different name")


def check_class_name(name: str) -> None:
    """Raise InvalidResourceName for a message that Python could not have a class of."""
    if keyword.iskeyword(name):
        raise InvalidResourceName(f"'{name}' is a keyword of Python, which cannot be the name of a class")


def check_weight(name: str, weight: int) -> None:
    """Raise InvalidType for a message of which each instance would consist of too many values."""
    if weight > MAX_WEIGHT:
        raise InvalidType(
            f"each message {name} would consist of {weight:,} values, which is more than fits into memory here",
            hint="A sequence such as float64[] is as long as what is in it",
        )


def built_default(field: Field) -> Value | None:
    """A field's default value as the built class has it; InvalidValue where a build would fail on it."""
    base = field.type.base
    if isinstance(field.default, tuple):
        return tuple(built_value(base, each, field.type.string_bound) for each in field.default)
    return None if field.default is None else built_value(base, field.default, field.type.string_bound)


def built_constant(constant: Constant) -> Plain:
    """A constant's value as the built class has it; InvalidValue where a build would fail on it."""
    return built_value(constant.type, constant.value)


def built_value(base: str, value: Plain, string_bound: int | None = None) -> Plain:
    """One value of a primitive type as the built class has it."""
    if base in FLOAT_BOUNDS and isinstance(value, float):
        return _number(base, value)
    return _text(value, string_bound) if base in STRINGS and isinstance(value, str) else value


def _number(base: str, value: float) -> float:
    if not isfinite(value):
        hint = "Set it in the program: float('nan'), float('inf')"
        raise InvalidValue(f"value '{value}' cannot be written in a form that a build accepts", hint=hint)
    if abs(value) > FLOAT_BOUNDS[base]:
        raise InvalidValue(f"value '{value}' is too large for {base}")
    return value


def _text(text: str, bound: int | None) -> str:
    """A text after its way through IDL, which decodes escapes such as `\\n` and `\\x41`."""
    if text.isascii() and "\\" not in text:
        return text
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of escapes that are none, such as \d: they stay as they are
            idl = text.encode().decode("unicode_escape").replace('"', r"\"").encode("latin-1").decode()
            seen = re.sub(r"\\x.{1,2}", lambda match: codecs.decode(match[0], "unicode_escape"), idl)
    except UnicodeError:
        raise _lost(text) from None
    if len(re.search(r"\\*$", idl)[0]) % 2:  # type: ignore[index]
        raise _lost(text)
    seen = re.sub(r'\\(["\\])', r"\1", seen)
    if bound is not None and len(seen) > bound:
        raise InvalidValue(f"value '{text}' is longer than {bound} characters once its escapes are read")
    return seen


def _lost(text: str) -> InvalidValue:
    hint = r"Write three more backslashes before each one that is to stay; write é itself, not \u00e9"
    return InvalidValue(f"value '{text}' has a backslash that no build accepts", hint=hint)
