"""ROS arguments of a process: `--ros-args -r from:=to -p name:=value --params-file file --log-level level`.

Facts: https://docs.ros.org/en/humble/How-To-Guides/Node-arguments.html, rcl's arguments.c, and recordings.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

from turtle_lesson.ros.graph.names import Remap

from ._params_file import Entry, read_parameter_file
from ._yaml_values import YamlValueError, tree, value_of
from .exceptions import RCLError, UnknownROSArgsError
from .parameter import Parameter

FAILED = "failed to initialize rcl:"
LEVELS = ("DEBUG", "INFO", "WARN", "ERROR", "FATAL")
NAME = re.compile(r"[\w/~{}]+", re.ASCII)
SWITCH = re.compile(r"--(enable|disable)-(rosout|stdout|external-lib)-logs")
OBSOLETE = re.compile(r"(__ns|__node|__name|[\w/~{}:]*?[\w~}]):=[\w/~{}]+", re.ASCII)
SCHEMES = {"rostopic": False, "rosservice": True}


@dataclass
class Arguments:
    """What the ROS arguments say."""

    remaps: list[Remap] = field(default_factory=list)
    parameters: list[Entry] = field(default_factory=list)
    log_levels: dict[str, str] = field(default_factory=dict)
    """By logger; '' is the default."""
    switches: dict[str, bool] = field(default_factory=dict)
    """Whether logs go to `rosout`, `stdout` and `external-lib`, as far as that is said."""
    unknown: list[str] = field(default_factory=list)
    obsolete: list[str] = field(default_factory=list)
    """Remapping rules that are given as ROS 2 had it before `--ros-args`."""

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
    """Read the ROS arguments among a process's arguments; what is not between `--ros-args` and `--` is skipped.

    Raises RCLError for what cannot be read, UnknownROSArgsError for what means nothing.
    """
    found = Arguments()
    inside = False
    iterator = iter(words)
    for word in iterator:
        if word == "--ros-args":
            inside = True
        elif word == "--":
            inside = False
        elif inside:
            _take(word, iterator, found)
        elif OBSOLETE.fullmatch(word):
            found.remaps.append(_remap(word))
            found.obsolete.append(word)
    if found.unknown:
        error = UnknownROSArgsError(str(found.unknown))
        error.add_note("After --ros-args stand -r, -p, --params-file, --log-level and their like; -- ends them.")
        raise error
    return found


def obsolete_text(rule: str) -> str:
    """The warning about a rule that is given as ROS 2 had it before `--ros-args`."""
    return f"Found remap rule '{rule}'. This syntax is deprecated. Use '--ros-args --remap {rule}' instead."


def without_ros_arguments(words: list[str]) -> tuple[list[str], list[str]]:
    """The words that are not ROS's, and apart from them the obsolete rules, which are."""
    kept: list[str] = []
    obsolete: list[str] = []
    inside = False
    for word in words:
        if word == "--ros-args":
            inside = True
        elif word == "--" and inside:
            inside = False
        elif not inside:
            (obsolete if OBSOLETE.fullmatch(word) else kept).append(word)
    return kept, obsolete


def _take(word: str, following: Iterator[str], found: Arguments) -> None:
    if word in {"-r", "--remap"}:
        found.remaps.append(_remap(_next(word, following)))
    elif word in {"-p", "--param"}:
        found.parameters.append(_parameter(_next(word, following)))
    elif word == "--params-file":
        found.parameters.extend(_parameter_file(_next(word, following)))
    elif word == "--log-level":
        name, level = _log_level(_next(word, following))
        found.log_levels[name] = level
    elif word in {"-e", "--enclave", "--log-config-file", "--log-file-name"}:
        _next(word, following)
    elif (switch := SWITCH.fullmatch(word)) is not None:
        found.switches[switch[2]] = switch[1] == "enable"
    else:
        found.unknown.append(word)


def _next(word: str, following: Iterator[str]) -> str:
    for value in following:
        return value
    raise RCLError(f"{FAILED} Couldn't parse trailing {word} flag. It must be followed by a value")


def _remap(rule: str) -> Remap:
    match, separator, replacement = rule.partition(":=")
    node, colon, name = match.partition(":")
    if not colon or name.startswith("//"):
        node, name = "", match
    scheme, slashes, rest = name.partition("://")
    name, is_service = (rest, SCHEMES.get(scheme)) if slashes else (name, None)
    replacement = replacement.removeprefix(f"{scheme}://") if slashes else replacement
    good = all(NAME.fullmatch(part) for part in (name, replacement)) and (not slashes or scheme in SCHEMES)
    if not separator or not good or (colon and node and not NAME.fullmatch(node)):
        raise RCLError(f"{FAILED} Couldn't parse remap rule: '-r {rule}'. A rule looks like old_name:=new_name")
    if name == "__ns" and not replacement.startswith("/"):
        raise RCLError(
            f"{FAILED} Couldn't parse remap rule: '-r {rule}'. A namespace is given in full: __ns:=/{replacement}"
        )
    return Remap(name, replacement, node or None, is_service)


def _parameter(rule: str) -> Entry:
    name, separator, text = rule.partition(":=")
    node, colon, own = name.partition(":")
    if not separator or not name or not text or (colon and not own):
        raise RCLError(f"{FAILED} Couldn't parse parameter override rule: '-p {rule}'. A rule looks like name:=value")
    try:
        found = tree(text)
        value = text if found is None else value_of(found)
    except YamlValueError as error:
        raise RCLError(f"{FAILED} Couldn't parse parameter override rule: '-p {rule}'. Error: {error}") from None
    return (node, own, value) if colon else ("/**", name, value)


def _parameter_file(path: str) -> list[Entry]:
    try:
        return read_parameter_file(path)
    except YamlValueError as error:
        raise RCLError(f"{FAILED} Couldn't parse params file: '--params-file {path}'. Error: {error}") from None


def _log_level(rule: str) -> tuple[str, str]:
    name, _, level = rule.rpartition(":=")
    if level.upper() not in LEVELS:
        raise RCLError(
            f"{FAILED} Couldn't parse log level: '--log-level {rule}'. Error: Argument does not use a valid severity level; "
            f"levels are {', '.join(LEVELS)}"
        )
    return name, level


def pattern_matches(pattern: str, full_name: str) -> bool:
    """Whether a node pattern such as `/**`, `/*/navigator` or `/navigator` means the node of this full name."""
    expression = ""
    for part in pattern.strip("/").split("/"):
        expression += {"**": r"(/\w+)*", "*": r"/\w+"}.get(part, "/" + re.escape(part))
    return re.fullmatch(expression, full_name) is not None
