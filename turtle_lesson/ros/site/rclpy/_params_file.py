"""Parameter files: `--params-file`. Which values a file holds for which nodes, by ROS's rules (rcl_yaml_param_parser)."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from functools import cache
from typing import Any, ClassVar

from turtle_lesson.ros.rmw.names import node_name_flaw

KEY = "ros__parameters"

Entry = tuple[str, str, Any]
"""Which nodes (a full name, or a pattern with `*` and `**`), the parameter's name, and its value."""


def read_parameter_file(path: str) -> list[Entry]:
    """The values in a file, in its order; names of nested parameters are joined by dots. Raises YamlValueError."""
    from turtle_lesson.ros.runtime.bounded_yaml import LONGEST

    try:
        with open(path, encoding="utf-8") as file:
            text = file.read(LONGEST + 1)
    except UnicodeDecodeError:
        raise YamlValueError("Error opening YAML file: it is not text in UTF-8") from None
    except (OSError, ValueError) as error:
        raise YamlValueError(f"Error opening YAML file: {getattr(error, 'strerror', None) or error}") from None
    return list(_nodes(tree(text), []))


def _nodes(found: Any, names: list[str]) -> Iterator[Entry]:
    """The entries below some names of namespaces and nodes."""
    if found is None:
        return
    if found.id == "sequence":
        kinds = "can only be values and not keys in params. Error" if names else "cannot be key"
        raise YamlValueError(f"Sequences {kinds} at line {line_of(found)}: a file maps names to values")
    if found.id != "mapping":
        raise YamlValueError(
            f"Cannot have a value before {KEY} at line {line_of(found)}: a file maps the names of nodes to `{KEY}:`, and "
            "that to parameters"
        )
    for key, value in found.value:
        name = _name(key)
        if name != KEY:
            yield from _nodes(value, [*names, name])
            continue
        if not names:
            raise YamlValueError(f"There are no node names before {KEY} at line {line_of(key)}")
        node = "/".join(names)
        for part in node.removeprefix("/").split("/"):
            flaw = None if part in ("*", "**") else node_name_flaw(part)
            if flaw is not None:
                raise YamlValueError(f"{flaw.reason} (it is '{node}', before line {line_of(key)})")
        yield from ((node, parameter, value) for parameter, value in _parameters(value, ""))


def _parameters(found: Any, prefix: str) -> Iterator[tuple[str, Any]]:
    """The parameters below a prefix."""
    if found.id != "mapping":
        raise YamlValueError(
            f"Cannot have a value before {KEY} at line {line_of(found)}: names of parameters are expected"
        )
    for key, value in found.value:
        name = prefix + _name(key)
        if value.id == "mapping":
            yield from _parameters(value, f"{name}.")
        else:
            yield (name, value_of(value))


def _name(key: Any) -> str:
    if key.id != "scalar":
        raise YamlValueError(f"Sequences cannot be key at line {line_of(key)}")
    if not key.value:
        raise YamlValueError(f"No key at line {line_of(key)}")
    return key.value


# What a word in YAML means as a parameter's value. ROS's rules (rcl_yaml_param_parser's parse.c), not those of YAML.
# So `0x10` and `010` are numbers, `y` is true, `1_000` and `12:30` are texts, and so are dates.

TRUE = frozenset(["Y", "y", "yes", "Yes", "YES", "true", "True", "TRUE", "on", "On", "ON"])
FALSE = frozenset(["N", "n", "no", "No", "NO", "false", "False", "FALSE", "off", "Off", "OFF"])

WHOLE = re.compile(r"[-+]?(0[xX][0-9a-fA-F]+|0[0-7]*|[1-9][0-9]*)")
DECIMAL = re.compile(r"[-+]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][-+]?[0-9]+)?")
HEXADECIMAL = re.compile(r"[-+]?0[xX]([0-9a-fA-F]+\.?[0-9a-fA-F]*|\.[0-9a-fA-F]+)([pP][-+]?[0-9]+)?")
SPECIAL = re.compile(r"[-+]?\.?(inf|Inf|INF)|\.?(nan|NaN|NAN)|[-+]?(infinity|Infinity|nan)")

TEXT = "tag:yaml.org,2002:str"
"""The tag of what is marked as text: `!!str 1`."""

INT64 = range(-(2**63), 2**63)

NAMES: dict[type, str] = {bool: "bool", int: "integer", float: "double", str: "string"}


class YamlValueError(ValueError):
    """A YAML text is no parameter value; the text is ROS's, with advice."""


def scalar(text: str) -> Any:
    """The value of an unquoted word."""
    if text in TRUE or text in FALSE:
        return text in TRUE
    digits = text.lstrip("+-")
    if WHOLE.fullmatch(text):
        base = 16 if digits[:2] in ("0x", "0X") else 8 if digits.startswith("0") else 10
        number = int(digits, base) * (-1 if text.startswith("-") else 1)
        if number in INT64:
            return number
    if SPECIAL.fullmatch(text):
        return float(text.replace(".", ""))
    try:
        value = float(text) if DECIMAL.fullmatch(text) else float.fromhex(text) if HEXADECIMAL.fullmatch(text) else None
    except OverflowError:
        return text
    underflows = value == 0 and re.search(r"[1-9]", re.split(r"[eEpP]", text)[0])
    return text if value is None or math.isinf(value) or underflows else value


def value_of(node: Any) -> Any:
    """The value of a node of YAML's tree; of an empty list it is None, as in ROS. Raises YamlValueError."""
    if node.id == "scalar":
        return _scalar_of(node)
    if node.id == "mapping":
        line = line_of(node)
        raise YamlValueError(f"Unknown YAML event at line {line}: a value, or a list of values, is expected here")
    for item in node.value:
        if item.id != "scalar":
            raise YamlValueError(
                f"Unknown YAML event at line {line_of(item)}: a parameter can be a list of plain values, not of lists or maps"
            )
    values = [_scalar_of(item) for item in node.value]
    for item, value in zip(node.value, values, strict=True):
        if type(value) is not type(values[0]):
            mixed = {type(value), type(values[0])} == {int, float}
            advice = "; write 1.0 for a whole number among others" if mixed else ""
            raise YamlValueError(
                f"Sequence should be of same type. Value type '{NAMES[type(value)]}' do not belong at line_num "
                f"{line_of(item)}{advice}"
            )
    return values or None


def _scalar_of(node: Any) -> Any:
    if node.style in ("'", '"') or node.tag == TEXT:
        return node.value
    if not node.value:
        raise YamlValueError(f'No value at line {line_of(node)}; an empty text is written ""')
    return scalar(node.value)


def line_of(node: Any) -> int:
    """The line of a node of YAML's tree, counted from 1."""
    return node.start_mark.line + 1


@cache
def _loader() -> Any:
    """A reader of YAML that leaves it to us what an unmarked word means, refuses aliases, and knows the line it has come to."""
    from turtle_lesson.ros.runtime.bounded_yaml import BoundedLoader

    class Loader(BoundedLoader):
        yaml_implicit_resolvers: ClassVar[dict[str, Any]] = {}
        DEFAULT_SCALAR_TAG = "unmarked"
        last_line = 0

        def get_event(self) -> Any:
            event = super().get_event()
            self.last_line = event.start_mark.line + 1
            return event

        def _count_alias(self, event: Any) -> None:
            line = event.start_mark.line + 1
            raise YamlValueError(f"Will not support aliasing at line {line}: write the value once more")

    return Loader


def tree(text: str) -> Any:
    """The tree of a YAML text, None of an empty one. Raises YamlValueError for what is no YAML, or has aliases."""
    import yaml

    line = 0
    try:
        loader = _loader()(text)
        try:
            return loader.get_single_node()
        finally:
            line = loader.last_line
    except (yaml.YAMLError, ValueError, RecursionError) as error:
        if isinstance(error, YamlValueError):
            raise
        problem = getattr(error, "problem", None) or str(error).splitlines()[0]
        raise YamlValueError(f"Error parsing a event near line {line}: {problem}") from None
