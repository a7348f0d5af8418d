"""Default values and constants as written in a definition file, turned into Python values.

The rules and the words are those of `rosidl_adapter.parser`.
"""

from __future__ import annotations

import re

from .errors import InvalidDefinition, InvalidValue, UnsupportedDefault
from .model import FieldType, Plain, Value
from .names import FLOATS, STRINGS


def integer_bounds(base: str) -> tuple[int, int]:
    """Smallest and largest value of an integer type; byte and char count as uint8."""
    if base in ("byte", "char"):
        return 0, 255
    unsigned = base.startswith("u")
    bits = int(base[4 if unsigned else 3 :])
    return (0, 2**bits - 1) if unsigned else (-(2 ** (bits - 1)), 2 ** (bits - 1) - 1)


def parse_value(type_: FieldType, text: str) -> Value:
    """Read a field's default value; raise InvalidValue or UnsupportedDefault where ROS refuses it."""
    if not type_.is_primitive:
        raise UnsupportedDefault(
            f"parsing string values into type '{type_}' is not supported",
            hint="Only fields of primitive types can have a default value",
        )
    return parse_array(type_, text) if type_.is_array else parse_plain(type_.base, text, type_.string_bound)


def parse_array(type_: FieldType, text: str) -> tuple[Plain, ...]:
    """Read `[1, 2, 3]` for an array or sequence of primitives."""
    if not (text.startswith("[") and text.endswith("]")):
        raise _invalid(type_, text, "array value must start with '[' and end with ']'")
    inner = text[1:-1]
    elements = _split_strings(inner) if type_.base in STRINGS else inner.split(",") if inner else []
    _check_count(type_, text, len(elements))
    values = []
    for index, element in enumerate(elements):
        try:
            values.append(parse_plain(type_.base, element.strip(), type_.string_bound))
        except InvalidValue as error:
            raise _invalid(type_, text, f"element {index} with {error.reason}") from None
    return tuple(values)


def parse_plain(base: str, text: str, string_bound: int | None = None) -> Plain:
    """Read one value of a primitive type."""
    if base == "bool":
        return _parse_bool(text)
    if base in FLOATS:
        return _parse_float(base, text)
    if base in STRINGS:
        return _parse_string(base, text, string_bound)
    return _parse_integer(base, text)


def _check_count(type_: FieldType, text: str, count: int) -> None:
    if type_.is_fixed and count != type_.size:
        raise _invalid(type_, text, f"array must have exactly {type_.size} elements, not {count}")
    if type_.is_bounded and type_.size is not None and count > type_.size:
        raise _invalid(type_, text, f"array must have not more than {type_.size} elements, not {count}")


def _parse_bool(text: str) -> bool:
    if text.lower() not in ("true", "1", "false", "0"):
        raise _invalid("bool", text, "must be either 'true' / '1' or 'false' / '0'")
    return text.lower() in ("true", "1")


def _parse_float(base: str, text: str) -> float:
    try:
        return float(text)
    except ValueError:
        rule = "must be a floating point number using '.' as the separator"
        raise _invalid(base, text, rule) from None


def _parse_integer(base: str, text: str) -> int:
    low, high = integer_bounds(base) if base not in ("time", "duration") else (0, -1)
    value = _to_integer(text)
    if value is None or not low <= value <= high:
        raise _invalid(base, text, f"must be a valid integer value >= {low} and <= {high}")
    return value


def _to_integer(text: str) -> int | None:
    for number_base in (10, 0):  # 0 also reads 0x10 and 0b11
        try:
            return int(text, number_base)
        except ValueError:
            continue
    return None


def _parse_string(base: str, text: str, bound: int | None) -> str:
    for quote in ('"', "'"):
        if text.startswith(quote) and text.endswith(quote):
            text = text[1:-1]
            if re.search(rf"(?<!\\){quote}", text):
                raise _invalid(base, text, "string inner quotes not properly escaped")
            text = text.replace("\\" + quote, quote)
            break
    if bound is not None and len(text) > bound:
        rule = f"string must not exceed the maximum length of {bound} characters"
        raise _invalid(f"{base}<={bound}", text, rule)
    return text


_STRING_ELEMENT = re.compile(r"""\s*(?:"((?:\\"|[^"])*)"|'((?:\\'|[^'])*)'|([^,"'][^,]*))\s*(?:,|$)""")


def _split_strings(text: str) -> list[str]:
    """Split at commas that stand outside quotes, and take the quotes off."""
    elements: list[str] = []
    position = 0
    while position < len(text.rstrip()):
        match = _STRING_ELEMENT.match(text, position)
        if match is None:
            raise InvalidDefinition(f"string [{text[position:]}] incorrectly quoted\n{elements}")
        double, single, bare = match.groups()
        if double is not None:
            elements.append(double.replace('\\"', '"'))
        elif single is not None:
            elements.append(single.replace("\\'", "'"))
        else:
            elements.append(bare)
        position = match.end()
    return elements


def _invalid(type_: object, text: str, rule: str) -> InvalidValue:
    return InvalidValue(f"value '{text}' can not be converted to type '{type_}': {rule}")
