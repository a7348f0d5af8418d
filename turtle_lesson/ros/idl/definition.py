"""Interface definitions: the text of `.msg`, `.srv` and `.action` files, read with ROS's rules.

What is accepted and refused, and in which words, follows `rosidl_adapter.parser` of ROS 2 Humble. Whether the types of fields
exist is not known here: that is the registry's part.
"""

from __future__ import annotations

import re
from dataclasses import replace
from itertools import zip_longest
from pathlib import Path

from . import names
from .model import Constant, Definition, Field, FieldType, InvalidDefinition, Plain, Value
from .names import FLOATS, STRINGS, bounds

Line = tuple[int, str]  # line number in the file, counted from 1, and the text

PARTS = {"msg": (), "srv": ("Request", "Response"), "action": ("Goal", "Result", "Feedback")}
"""The folders of a package, and the parts of the interfaces in them, between which there is a line `---`."""


def parse(folder: str, package: str, name: str, text: str, file: str | None = None) -> Definition:
    """Read a definition; `folder` is `msg`, `srv` or `action`. Raises InvalidDefinition where ROS refuses it."""
    lines = list(enumerate(text.replace("\t", " ").splitlines(), start=1))
    if folder == "msg":
        return _parse_message(folder, package, name, lines, text, file)
    parts: list[list[Line]] = [[]]
    for number, line in lines:
        if line == "---":
            parts.append([])
        else:
            parts[-1].append((number, line))
    if len(parts) != len(PARTS[folder]):
        if folder == "srv":
            unique, error = "unique " if len(parts) > 1 else "", "InvalidServiceSpecification"
            reason = f"Could not find {unique}separator '---' between request and response"
            hint = "A service is its request, one line of exactly three dashes, its response"
        else:
            reason, error = (
                "Number of '---' separators nonconformant with action definition",
                "InvalidActionSpecification",
            )
            hint = "An action is its goal, its result and its feedback, with a line of three dashes between"
        raise InvalidDefinition(reason, error, hint=hint).locate(interface=f"{package}/{folder}/{name}", file=file)
    messages = tuple(
        _parse_message(folder, package, f"{name}_{part}", own, "\n".join(line for _, line in own), file)
        for part, own in zip(PARTS[folder], parts, strict=True)
    )
    return Definition(package, folder, name, text, file, parts=messages)


def _parse_message(folder: str, package: str, name: str, lines: list[Line], text: str, file: str | None) -> Definition:
    members: dict[tuple[str, str], Field | Constant] = {}
    interface = f"{package}/{folder}/{name}"
    for number, raw in lines:
        line = raw.partition("#")[0].rstrip()
        if not line:
            continue
        try:
            member = _parse_line(package, name, line, number)
            what = "fields" if isinstance(member, Field) else "constants"
            if members.setdefault((what, member.name), member) is not member:
                raise InvalidDefinition(f"the {what} iterable contains duplicate names: {member.name}")
        except InvalidDefinition as error:
            raise error.locate(interface=interface, file=file, line=number, line_text=line.strip()) from None
    try:
        names.check("package", package)
        names.check("message", name)
    except InvalidDefinition as error:
        raise error.locate(interface=interface, file=file) from None
    fields = tuple(each for each in members.values() if isinstance(each, Field))
    constants = tuple(each for each in members.values() if isinstance(each, Constant))
    return Definition(package, folder, name, text, file, fields, constants)


def _parse_line(package: str, name: str, line: str, number: int) -> Field | Constant:
    type_text, _, rest = line.partition(" ")
    rest = rest.lstrip()
    if not rest:
        hint = "A field is its type and its name"
        raise InvalidDefinition(
            line, "InvalidFieldDefinition", hint=hint, printed=f"Error with: {package} {name} {line}"
        )
    if "=" in rest:
        member, _, value = rest.partition("=")
        if type_text not in names.PRIMITIVES:
            raise InvalidDefinition(f"the constant type '{type_text}' must be a primitive type", "TypeError")
        names.check("constant", member.rstrip())
        return Constant(type_text, member.rstrip(), _parse_plain(type_text, value.lstrip()), number)
    try:
        type_ = _parse_type(type_text, package)
        member, _, default = rest.partition(" ")
        names.check("field", member)
        default = default.lstrip()
        return Field(type_, member, _parse_default(type_, default) if default else None, number)
    except InvalidDefinition as error:
        error.printed = f"Error processing '{line}' of '{package}/{name}': '{error.reason}'"
        raise


# -- types --------------------------------------------------------------------------------------------------------


def _parse_type(text: str, package: str) -> FieldType:
    """Read the type of a field; a message without a package is one of the `package` given."""
    if not text:
        hint = "Begin the line with the type, without spaces"
        raise InvalidDefinition("string index out of range", "IndexError", hint=hint)
    if not text.endswith("]"):
        return _parse_base(text, package)
    if "[" not in text:
        raise InvalidDefinition(f"the type {text} ends with ']' but does not contain a '['", "TypeError")
    base, _, count = text[:-1].rpartition("[")
    size = _positive(count.removeprefix("<="))
    if count and size is None:
        # The two names stand the wrong way round in ROS's text as well.
        raise InvalidDefinition(
            f"the size of array type '<=' must be a valid integer value > 0 optionally prefixed with '{text}'"
            " if it is only an upper bound",
            "TypeError",
            hint=f"Write {base}[3], {base}[<=3] or {base}[]",
        )
    element = _parse_base(base, package)
    is_fixed = size is not None and not count.startswith("<=")
    return replace(element, is_array=True, is_fixed=is_fixed, size=size)


def _parse_base(text: str, package: str) -> FieldType:
    if text in names.PRIMITIVES:
        return FieldType(text)
    if text.startswith(("string<=", "wstring<=")):
        base, _, count = text.partition("<=")
        bound = _positive(count)
        if bound is None:
            raise InvalidDefinition(
                f"the upper bound of the string type '{text}' must be a valid integer value > 0",
                "TypeError",
                hint=f"Write {base}<=10",
            )
        return FieldType(base, string_bound=bound)
    parts = text.split("/")
    if len(parts) > 2:
        hint = f"Write '{parts[-3]}/{parts[-1]}'" if parts[1:-1] == ["msg"] else "Write 'package/Message'"
        raise InvalidDefinition(text, "InvalidResourceName", hint=hint)
    owner = parts[0] if len(parts) == 2 else package
    names.check("package", owner)
    names.check("message", parts[-1])
    return FieldType(parts[-1], owner)


def _positive(text: str) -> int | None:
    try:
        value = int(text)
    except ValueError:
        return None
    return value if value > 0 else None


# -- default values and constants ---------------------------------------------------------------------------------


def _parse_default(type_: FieldType, text: str) -> Value:
    """Read a field's default value, `[1, 2, 3]` for an array or sequence."""
    if not type_.is_primitive:
        raise InvalidDefinition(
            f"parsing string values into type '{type_}' is not supported",
            "NotImplementedError",
            hint="Only fields of primitive types can have a default value",
        )
    if not type_.is_array:
        return _parse_plain(type_.base, text, type_.string_bound)
    if not (text.startswith("[") and text.endswith("]")):
        raise _invalid(type_, text, "array value must start with '[' and end with ']'")
    inner = text[1:-1]
    elements = _split_strings(inner) if type_.base in STRINGS else inner.split(",") if inner else []
    if type_.is_fixed and len(elements) != type_.size:
        raise _invalid(type_, text, f"array must have exactly {type_.size} elements, not {len(elements)}")
    if len(elements) not in type_.lengths:
        raise _invalid(type_, text, f"array must have not more than {type_.size} elements, not {len(elements)}")
    values = []
    for index, element in enumerate(elements):
        try:
            values.append(_parse_plain(type_.base, element.strip(), type_.string_bound))
        except InvalidDefinition as error:
            raise _invalid(type_, text, f"element {index} with {error.reason}") from None
    return tuple(values)


def _parse_plain(base: str, text: str, string_bound: int | None = None) -> Plain:
    """Read one value of a primitive type."""
    if base == "bool":
        if text.lower() not in ("true", "1", "false", "0"):
            raise _invalid("bool", text, "must be either 'true' / '1' or 'false' / '0'")
        return text.lower() in ("true", "1")
    if base in STRINGS:
        return _parse_string(base, text, string_bound)
    if base in FLOATS:
        try:
            return float(text)
        except ValueError:
            rule = "must be a floating point number using '.' as the separator"
            raise _invalid(base, text, rule) from None
    low, high = bounds(base) if base not in ("time", "duration") else (0, -1)
    for number_base in (10, 0):  # 0 also reads 0x10 and 0b11
        try:
            value = int(text, number_base)
        except ValueError:
            continue
        if low <= value <= high:
            return value
        break
    raise _invalid(base, text, f"must be a valid integer value >= {low} and <= {high}")


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


_STRING_ELEMENT = re.compile(r"""(\s*(?:"((?:\\"|[^"])*)"|'((?:\\'|[^'])*)'|([^,"'][^,]*))\s*(?:,|$))""")


def _split_strings(text: str) -> list[str]:
    """Split at commas that stand outside quotes, and take the quotes off."""
    found = _STRING_ELEMENT.findall(text.rstrip())
    if "".join(whole for whole, *_ in found) != text.rstrip():
        raise InvalidDefinition(f"string [{text}] incorrectly quoted")
    return [double.replace('\\"', '"') or single.replace("\\'", "'") or bare for _, double, single, bare in found]


def _invalid(type_: object, text: str, rule: str) -> InvalidDefinition:
    return InvalidDefinition(f"value '{text}' can not be converted to type '{type_}': {rule}", "InvalidValue")


# -- comments -----------------------------------------------------------------------------------------------------
# What the fields of the built-in interfaces mean: the comments that `ros2 interface show` prints.
# The definitions in `share/` hold next to no comments, so that they are read fast and fill no bags. A file
# `comments.txt` beside a package's definitions has what is to be said, in our own words: a section `[msg/Twist]` for
# an interface, in it lines `# …` about the whole and `field: meaning`, and `---` between the parts of a service or an
# action.

_MEMBER = re.compile(r"\S+\s+(\w+)[^#]*$")
"""A line of a definition that declares a member and has no comment of its own."""


def with_comments(directory: Path, interface: str, text: str) -> str:
    """The text of a definition, such as `msg/Twist`, with the comments that the package in a folder has for it, if any."""
    file = directory / "comments.txt"
    found = file.read_text(encoding="utf-8") if file.is_file() else ""
    section = f"\n{found}".partition(f"\n[{interface}]\n")[2].partition("\n[")[0].strip()
    parts, comments = (re.split(r"^---$\n?", each, flags=re.MULTILINE) for each in (text, section))
    lines: list[str] = []
    for number, (part, said) in enumerate(zip_longest(parts, comments, fillvalue="")):
        about = [line for line in said.splitlines() if line.startswith("#")]
        meanings = dict(line.split(": ", 1) for line in said.splitlines() if line and line not in about)
        members = [(line, _MEMBER.match(line)) for line in part.splitlines()]
        pairs = [(line, meanings.get(member[1]) if member else None) for line, member in members]
        width = max((len(line) for line, meaning in pairs if meaning), default=0)
        lines += ["---"] if number else []
        lines += [*about, *([""] if about and pairs else [])]
        lines += [f"{line:<{width}}  # {meaning}" if meaning else line for line, meaning in pairs]
    return "\n".join(lines)
