"""ROS arguments of a process: `--ros-args -r from:=to -p name:=value --params-file file --log-level level`.

Facts: https://docs.ros.org/en/humble/How-To-Guides/Node-arguments.html, rcl's arguments.c and lexer.c, its
rcl_yaml_param_parser, and recordings.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cache
from typing import Any, ClassVar

from turtle_lesson.ros.rmw.names import Remap, node_name_flaw

from .exceptions import RCLInvalidROSArgsError, UnknownROSArgsError
from .impl.logging_severity import LoggingSeverity
from .impl.rcutils_logger import RcutilsLogger
from .parameter import Parameter

Entry = tuple[str, str, Any]
"""Which nodes (a full name, or a pattern with `*` and `**`), the parameter's name, and its value."""

SHORT = {"--remap": "-r", "--param": "-p", "--enclave": "-e"}
FLAGS = {
    "-r": "remap rule",
    "-p": "parameter override rule",
    "-e": "enclave path",
    "--params-file": "params file",
    "--log-level": "log level",
    "--log-config-file": "log config file",
    "--log-file-name": "string prefix",
}
"""What must follow each flag. Nothing comes of enclaves, which are all /, and of log files, as none are written."""

SWITCH = re.compile(r"--(enable|disable)-(rosout|stdout|external-lib)-logs")

TOKEN = r"(?:_(?!_)|(?=[A-Za-z]))(?:[A-Za-z0-9]++_?+)*+"
NODE = rf"(?:(?P<node>(?!ros(?:service|topic)://){TOKEN}):(?!=))?"
NAME = rf"(?:~?/)?{TOKEN}(?:/{TOKEN})*"
PART = rf"(?:/|{TOKEN})+"
REMAPS = {
    "__node": re.compile(rf"{NODE}__(?:node|name):=(?P<new>{TOKEN})"),
    "__ns": re.compile(rf"{NODE}__ns:=(?P<new>(?:/(?:{TOKEN})?)+)"),
    "": re.compile(rf"{NODE}(?:ros(?P<only>service|topic)://)?(?P<name>{NAME}):=(?P<new>{NAME})"),
}
"""How rules are written that rename nodes, namespaces, and topics or services."""
PARAMETER = re.compile(rf"{NODE}(?P<name>{PART}(?:\.{PART})*):=(?P<value>.+)", re.DOTALL)


class YamlValueError(ValueError):
    """A YAML text is no parameter value; the text is ROS's, with the line of a node of YAML's tree, and advice."""

    def __init__(self, problem: str, node: Any = None, advice: str = "") -> None:
        where = "" if node is None else f" at line {node.start_mark.line + 1}"
        super().__init__(f"{problem}{where}{advice}")


@dataclass
class Arguments:
    """What the ROS arguments say."""

    remaps: list[Remap] = field(default_factory=list)
    parameters: list[Entry] = field(default_factory=list)
    log_levels: dict[str, LoggingSeverity] = field(default_factory=dict)
    """By logger; '' is the default."""
    switches: dict[str, bool] = field(default_factory=dict)
    """Whether logs go to `rosout`, `stdout` and `external-lib`, as far as that is said."""
    others: list[str] = field(default_factory=list)
    """The words that are not ROS's."""

    def parameters_of(self, full_name: str) -> list[Parameter]:
        """The values for the node of this full name.

        They are gathered by the nodes that they are given for, in the order in which those are first named; of several
        that mean this node the last one counts. So `-p` need not win over a file that names the node (rclpy's node.cpp).
        """
        by_nodes: dict[str, dict[str, Any]] = {}
        for nodes, name, value in self.parameters:
            by_nodes.setdefault(nodes, {})[name] = value
        found: dict[str, Any] = {}
        for nodes, values in by_nodes.items():
            if pattern_matches(nodes, full_name):
                found.update(values)
        return [Parameter(name, value=value) for name, value in found.items()]


def parse_arguments(words: list[str]) -> Arguments:
    """Read the ROS arguments among a process's arguments, which stand between `--ros-args` and `--`.

    Raises RCLInvalidROSArgsError for what cannot be read, UnknownROSArgsError for what means nothing. A warning is logged
    for each remapping rule that is given as ROS 2 had it before `--ros-args`.
    """
    if not isinstance(words, list) or not all(isinstance(word, str) for word in words):
        raise TypeError(f"arguments must be a list of str, as sys.argv is, got {words!r}")
    found = Arguments()
    unknown: list[str] = []
    inside = False
    iterator = iter(words)
    for word in iterator:
        if word == "--ros-args":
            inside = True
        elif word == "--" and inside:
            inside = False
        elif inside and (flag := SHORT.get(word, word)) in FLAGS:
            value = next(iterator, None)
            if value is None:
                raise RCLInvalidROSArgsError(f"Couldn't parse trailing {word} flag. No {FLAGS[flag]} found.")
            _take(flag, value, found)
        elif inside and (switch := SWITCH.fullmatch(word)) is not None:
            found.switches[switch[2]] = switch[1] == "enable"
        elif inside:
            unknown.append(word)
        elif (rule := read_remap(word)) is not None:
            found.remaps.append(rule)
            RcutilsLogger("rcl").warning(
                f"Found remap rule '{word}'. This syntax is deprecated. Use '--ros-args --remap {word}' instead."
            )
        else:
            found.others.append(word)
    if unknown:
        error = UnknownROSArgsError(str(unknown))
        error.add_note("-r, -p, --params-file, --log-level and similar options follow --ros-args; -- ends them.")
        raise error
    return found


def _take(flag: str, value: str, found: Arguments) -> None:
    """Add what a flag and its value say to what was found so far."""
    try:
        if flag == "-r":
            rule = read_remap(value)
            if rule is None:
                raise YamlValueError("a rule looks like old_name:=new_name, or __ns:=/group for a namespace")
            found.remaps.append(rule)
        elif flag == "-p":
            match = PARAMETER.fullmatch(value)
            if match is None:
                raise YamlValueError("a rule looks like name:=value")
            node = tree(match["value"])
            found.parameters.append((match["node"] or "/**", match["name"], None if node is None else value_of(node)))
        elif flag == "--params-file":
            found.parameters.extend(read_parameter_file(value))
        elif flag == "--log-level":
            logger, separator, level = value.rpartition(":=")
            if level.upper() not in LoggingSeverity.__members__ or (separator and not logger):
                raise YamlValueError("Argument does not use a valid severity level, such as DEBUG, INFO, WARN or ERROR")
            found.log_levels[logger] = LoggingSeverity[level.upper()]
    except YamlValueError as error:
        raise RCLInvalidROSArgsError(f"Couldn't parse {FLAGS[flag]}: '{flag} {value}'. Error: {error}") from None


def read_remap(rule: str) -> Remap | None:
    """`[node:]from:=to`, `[node:]__node:=name` or `[node:]__ns:=/namespace`; None for anything else."""
    for kind, pattern in REMAPS.items():
        if (match := pattern.fullmatch(rule)) is not None:
            words = match.groupdict()
            is_service = {"service": True, "topic": False}.get(words.get("only", ""))
            return Remap(kind or words["name"], words["new"], words["node"], is_service)
    return None


def pattern_matches(pattern: str, full_name: str) -> bool:
    """Whether a node pattern such as `/**`, `/*/navigator` or `/navigator` means the node of this full name."""
    expression = ""
    for part in pattern.strip("/").split("/"):
        expression += {"**": r"(/\w+)*", "*": r"/\w+"}.get(part, "/" + re.escape(part))
    return re.fullmatch(expression, full_name) is not None


# -- parameter files, and which value a text has ----------------------------------------------------------------------

KEY = "ros__parameters"

TRUE = frozenset(["Y", "y", "yes", "Yes", "YES", "true", "True", "TRUE", "on", "On", "ON"])
FALSE = frozenset(["N", "n", "no", "No", "NO", "false", "False", "FALSE", "off", "Off", "OFF"])
WHOLE = re.compile(r"[-+]?(0[xX][0-9a-fA-F]+|0[0-7]*|[1-9][0-9]*)")
DECIMAL = re.compile(r"[-+]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][-+]?[0-9]+)?")
SPECIAL = re.compile(r"[-+]?\.?(inf|Inf|INF)|\.?(nan|NaN|NAN)|[-+]?(infinity|Infinity|nan)")
TEXT = "tag:yaml.org,2002:str"
"""The tag of what is marked as text: `!!str 1`."""
NAMES: dict[type, str] = {bool: "bool", int: "integer", float: "double", str: "string"}


def read_parameter_file(path: str) -> list[Entry]:
    """The values in a file, in its order; names of nested parameters are joined by dots. Raises YamlValueError."""
    from turtle_lesson.ros.runtime.bounded_yaml import LONGEST

    try:
        with open(path, encoding="utf-8") as file:
            text = file.read(LONGEST + 1)
    except (OSError, ValueError) as error:
        raise YamlValueError(f"Error opening YAML file: {getattr(error, 'strerror', None) or error}") from None
    found = tree(text)
    return [] if found is None else list(_nodes(found, []))


def _nodes(found: Any, names: list[str]) -> Iterator[Entry]:
    """The entries below some names of namespaces and nodes."""
    for key, name, value in _pairs(found):
        if name != KEY:
            if value.value != "":  # a name with nothing below it
                yield from _nodes(value, [*names, name])
            continue
        if not names:
            raise YamlValueError(f"There are no node names before {KEY}", key)
        node = "/".join(names)
        for part in node.removeprefix("/").split("/"):
            flaw = None if part in ("*", "**") else node_name_flaw(part)
            if flaw is not None:
                raise YamlValueError(f"{flaw.reason} (it is '{node}')", key)
        yield from ((node, parameter, value) for parameter, value in _parameters(value, ""))


def _parameters(found: Any, prefix: str) -> Iterator[tuple[str, Any]]:
    """The parameters below a prefix."""
    for _, name, value in _pairs(found):
        if value.id == "mapping":
            yield from _parameters(value, f"{prefix}{name}.")
        else:
            yield (prefix + name, value_of(value))


def _pairs(found: Any) -> Iterator[tuple[Any, str, Any]]:
    """What a mapping maps, as keys with their texts and values. Raises YamlValueError for anything but a mapping of names."""
    if found.id != "mapping":
        advice = f": a file maps the names of nodes to `{KEY}:`, and that to the names of parameters"
        raise YamlValueError(f"Cannot have a value before {KEY}", found, advice)
    for key, value in found.value:
        if key.id != "scalar" or not key.value:
            raise YamlValueError("A list, a mapping or nothing cannot be a name", key)
        yield key, key.value, value


def scalar(text: str) -> Any:
    """The value of an unquoted word by ROS's rules (rcl_yaml_param_parser's parse.c), not those of YAML.

    So `0x10` and `010` are numbers, `y` is true, `1_000` and `12:30` are texts, and so are dates.
    """
    if text in TRUE or text in FALSE:
        return text in TRUE
    if WHOLE.fullmatch(text):
        digits = text.lstrip("+-")
        base = 16 if digits[:2] in ("0x", "0X") else 8 if digits.startswith("0") else 10
        number = int(digits, base) * (-1 if text.startswith("-") else 1)
        if -(2**63) <= number < 2**63:
            return number
    if SPECIAL.fullmatch(text):
        return float(text.replace(".", ""))
    value = float(text) if DECIMAL.fullmatch(text) else math.inf
    return text if math.isinf(value) else value


def value_of(node: Any) -> Any:
    """The value of a node of YAML's tree; of an empty list it is None, as in ROS. Raises YamlValueError."""
    items = node.value if node.id == "sequence" else [node]
    values = []
    for item in items:
        if item.id != "scalar":
            raise YamlValueError("Unknown YAML event", item, ": a value, or a list of plain values, is expected here")
        is_text = item.style in ("'", '"') or item.tag == TEXT
        if not item.value and not is_text:
            raise YamlValueError("No value", item, '; an empty text is written ""')
        values.append(item.value if is_text else scalar(item.value))
        if type(values[-1]) is not type(values[0]):
            problem = f"Sequence should be of same type. Value type '{NAMES[type(values[-1])]}' do not belong"
            raise YamlValueError(problem, item, "; write 1.0 for a whole number among others")
    return values[0] if node.id == "scalar" else values or None


@cache
def _loader() -> Any:
    """A reader of YAML that leaves it to us what an unmarked word means, and refuses aliases."""
    from turtle_lesson.ros.runtime.bounded_yaml import BoundedLoader

    class Loader(BoundedLoader):
        yaml_implicit_resolvers: ClassVar[dict[str, Any]] = {}
        DEFAULT_SCALAR_TAG = "unmarked"

        def _count_alias(self, event: Any) -> None:
            raise YamlValueError("Will not support aliasing", event, ": write the value once more")

    return Loader


def tree(text: str) -> Any:
    """The tree of a YAML text, None of an empty one. Raises YamlValueError for what is no YAML, or has aliases."""
    import yaml

    try:
        return _loader()(text).get_single_node()
    except YamlValueError:
        raise
    except (yaml.YAMLError, ValueError, RecursionError) as error:
        mark = getattr(error, "problem_mark", None)
        problem = getattr(error, "problem", None) or str(error).splitlines()[0]
        raise YamlValueError(f"Error parsing a event near line {mark.line + 1 if mark else 0}: {problem}") from None
