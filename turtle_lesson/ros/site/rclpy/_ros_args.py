"""ROS arguments of a process: `--ros-args -r from:=to -p name:=value --params-file file --log-level level`.

Facts: https://docs.ros.org/en/humble/How-To-Guides/Node-arguments.html, rcl's arguments.c, and recordings.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Any

from turtle_lesson.ros.rmw.names import Remap

from ._params_file import Entry, YamlValueError, read_parameter_file, tree, value_of
from .exceptions import RCLInvalidROSArgsError, UnknownROSArgsError
from .impl.rcutils_logger import RcutilsLogger
from .parameter import Parameter

SWITCH = re.compile(r"--(enable|disable)-(rosout|stdout|external-lib)-logs")
FLAGS = {
    **dict.fromkeys(("-r", "--remap"), "remap rule found"),
    **dict.fromkeys(("-p", "--param"), "parameter override rule found"),
    **dict.fromkeys(("--params-file", "--log-config-file"), "file path provided"),
    **dict.fromkeys(("-e", "--enclave"), "enclave path provided"),
    "--log-level": "log level provided",
    "--log-file-name": "string prefix provided",
}
"""What must follow each flag."""


class ArgumentError(ValueError):
    """ROS arguments cannot be read."""


@dataclass
class Arguments:
    """What the ROS arguments say."""

    remaps: list[Remap] = field(default_factory=list)
    parameters: list[Entry] = field(default_factory=list)
    log_levels: dict[str, str] = field(default_factory=dict)
    """By logger; '' is the default."""
    switches: dict[str, bool] = field(default_factory=dict)
    """Whether logs go to `rosout`, `stdout` and `external-lib`, as far as that is said."""
    log_config_file: str = ""
    unknown: list[str] = field(default_factory=list)
    obsolete: list[str] = field(default_factory=list)
    """Remapping rules that are given as ROS 2 had it before `--ros-args`."""
    others: list[str] = field(default_factory=list)
    """The words that are not ROS's."""

    def warn_of_obsolete(self) -> None:
        """Warn of rules that are given as ROS 2 had it before `--ros-args`."""
        for rule in self.obsolete:
            RcutilsLogger("rcl").warning(
                f"Found remap rule '{rule}'. This syntax is deprecated. Use '--ros-args --remap {rule}' instead."
            )

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

    Raises ArgumentError for what cannot be read, UnknownROSArgsError for what means nothing.
    """
    if not isinstance(words, list):
        raise TypeError(f"arguments must be a list of str, as sys.argv is, got {words!r}")
    found = Arguments()
    inside = False
    iterator = iter(words)
    for word in iterator:
        if not isinstance(word, str):
            raise TypeError(f"arguments must be a list of str, got {word!r} in it")
        if word == "--ros-args":
            inside = True
        elif word == "--" and inside:
            inside = False
        elif inside:
            _take(word, iterator, found)
        elif ":=" in word and is_remap(word):
            found.remaps.append(read_remap(word))
            found.obsolete.append(word)
        else:
            found.others.append(word)
    if found.unknown:
        error = UnknownROSArgsError(str(found.unknown))
        error.add_note("-r, -p, --params-file, --log-level and similar options follow --ros-args; -- ends them.")
        raise error
    return found


def own_arguments(words: list[str]) -> Arguments:
    """As `parse_arguments`, for what is read after `rclpy.init()`: raises RCLInvalidROSArgsError for ArgumentError."""
    try:
        found = parse_arguments(words)
    except ArgumentError as error:
        raise RCLInvalidROSArgsError(f"Failed to parse ROS arguments: {error}") from None
    found.warn_of_obsolete()
    return found


def _take(word: str, following: Iterator[str], found: Arguments) -> None:
    """Read one flag, with the value that follows it, into what was found so far."""
    if word in {"-r", "--remap"}:
        rule = _next(word, following)
        example = "old_name:=new_name" + (", a namespace like __ns:=/group" if "__ns" in rule else "")
        with _explained(f"remap rule: '-r {rule}'", f"; a rule looks like {example}"):
            found.remaps.append(read_remap(rule))
    elif word in {"-p", "--param"}:
        rule = _next(word, following)
        with _explained(f"parameter override rule: '-p {rule}'", "; a rule looks like name:=value"):
            node, name, text = read_parameter(rule)
            value = tree(text)
            found.parameters.append((node or "/**", name, None if value is None else value_of(value)))
    elif word == "--params-file":
        path = _next(word, following)
        with _explained(f"params file: '--params-file {path}'"):
            found.parameters.extend(read_parameter_file(path))
    elif word == "--log-level":
        rule = _next(word, following)
        with _explained(f"log level: '--log-level {rule}'"):
            name, level = read_log_level(rule)
            found.log_levels[name] = level
    elif word == "--log-config-file":
        found.log_config_file = _next(word, following)
    elif word in {"-e", "--enclave", "--log-file-name"}:
        _next(word, following)  # all enclaves are /, and no log files are written
    elif (switch := SWITCH.fullmatch(word)) is not None:
        found.switches[switch[2]] = switch[1] == "enable"
    else:
        found.unknown.append(word)


def _next(word: str, following: Iterator[str]) -> str:
    for value in following:
        return value
    flag = f"log level flag: '{word}'" if word == "--log-level" else f"{word} flag"
    raise ArgumentError(f"Couldn't parse trailing {flag}. No {FLAGS[word]}.")


@contextmanager
def _explained(what: str, example: str = "") -> Iterator[None]:
    """Raise ArgumentError for a value that cannot be read: which it is, why, and for a rule what one looks like."""
    try:
        yield
    except (RuleError, YamlValueError) as error:
        advice = example if isinstance(error, RuleError) else ""
        raise ArgumentError(f"Couldn't parse {what}. Error: {error}{advice}") from None


def pattern_matches(pattern: str, full_name: str) -> bool:
    """Whether a node pattern such as `/**`, `/*/navigator` or `/navigator` means the node of this full name."""
    expression = ""
    for part in pattern.strip("/").split("/"):
        expression += {"**": r"(/\w+)*", "*": r"/\w+"}.get(part, "/" + re.escape(part))
    return re.fullmatch(expression, full_name) is not None


# How the rules are written. Facts: rcl's lexer.c and arguments.c (which names may stand where, and the words of the errors),
# and recordings of them.

LEVELS = ("UNSET", "DEBUG", "INFO", "WARN", "ERROR", "FATAL")
NONE, EOF, TILDE_SLASH, SERVICE_URL, TOPIC_URL, COLON, NODE, NS, SEPARATOR, REFERENCE = range(10)
TOKEN, SLASH, ONE, MANY, DOT = range(18, 23)  # the numbers stand in errors
WORD = r"(?:_(?!_)|(?=[A-Za-z]))(?:[A-Za-z0-9]+_?)*"
NODE_PREFIX = re.compile(rf"(?!ros(?:service|topic)://)({WORD}):(?!=)")
LEXEMES = [
    (SERVICE_URL, re.compile("rosservice://")),
    (TOPIC_URL, re.compile("rostopic://")),
    (NODE, re.compile("__(node|name)")),
    (NS, re.compile("__ns")),
    (TOKEN, re.compile(WORD)),
    (TILDE_SLASH, re.compile("~/")),
    (SEPARATOR, re.compile(":=")),
    (COLON, re.compile(":")),
    (SLASH, re.compile("/")),
    (MANY, re.compile(r"\*\*")),
    (ONE, re.compile(r"\*")),
    (DOT, re.compile(r"\.")),
    (REFERENCE, re.compile(r"\\[1-9]")),
    (EOF, re.compile(r"\Z")),
]


class RuleError(ValueError):
    """A rule is not written as it should be."""


class Reader:
    """Reads a rule piece by piece."""

    def __init__(self, text: str) -> None:
        self.text = text
        self.at = 0

    def next(self) -> int:
        """The kind of the next piece."""
        return self._look()[0]

    def _look(self) -> tuple[int, int]:
        for kind, pattern in LEXEMES:
            if (match := pattern.match(self.text, self.at)) is not None:
                return kind, match.end()
        return NONE, self.at + 1

    def take(self) -> str:
        """The next piece, which is left behind."""
        start, self.at = self.at, self._look()[1]
        return self.text[start : self.at]

    def expect(self, wanted: int) -> str:
        """The next piece, which must be of a kind; RuleError if it is not."""
        kind = self.next()
        if kind == wanted:
            return self.take()
        if kind in (NONE, EOF):
            raise RuleError(f"Expected lexeme type ({wanted}) not found, search ended at index {self.at}")
        raise RuleError(f"Expected lexeme type {wanted}, got {kind} at index {self.at}")

    def skip(self, *kinds: int) -> None:
        """Leave the next piece behind if it is of one of these kinds."""
        if self.next() in kinds:
            self.take()


def read_remap(rule: str) -> Remap:
    """`[node:]from:=to`, `[node:]__node:=name` or `[node:]__ns:=/namespace`. RuleError for anything else."""
    reader = Reader(rule)
    node = _node_prefix(reader)
    kind = reader.next()
    start = reader.at
    if kind in (NODE, NS):
        reader.take()
        name, is_service = ("__ns" if kind == NS else "__node"), None
    else:
        is_service = {SERVICE_URL: True, TOPIC_URL: False}.get(kind)
        reader.skip(SERVICE_URL, TOPIC_URL)
        start = reader.at
        _name(reader, SEPARATOR)
        name = rule[start : reader.at]
    reader.expect(SEPARATOR)
    start = reader.at
    if kind == NODE:
        reader.expect(TOKEN)
        reader.expect(EOF)
    elif kind == NS:
        reader.expect(SLASH)
        reader.skip(TOKEN)
        while reader.next() == SLASH:
            reader.take()
            reader.skip(TOKEN)
        reader.expect(EOF)
    else:
        _name(reader, EOF, is_new=True)
    return Remap(name, rule[start:], node, is_service)


def read_parameter(rule: str) -> tuple[str | None, str, str]:
    """`[node:]name:=value`: the node, the parameter and the value's text. RuleError for anything else."""
    reader = Reader(rule)
    node = _node_prefix(reader)
    start = reader.at
    _parameter_part(reader)
    while reader.next() != SEPARATOR:
        reader.expect(DOT)
        _parameter_part(reader)
    name = rule[start : reader.at]
    reader.take()
    if reader.next() == EOF:
        raise RuleError("a value is missing")
    return node, name, rule[reader.at :]


def read_log_level(rule: str) -> tuple[str, str]:
    """`level` or `logger:=level`: the logger ('' for all) and the level. RuleError for anything else."""
    name, separator, level = rule.partition(":=")
    if separator and not name:
        raise RuleError("Argument has an invalid logger item that name is empty")
    if separator:
        reader = Reader(rule)
        reader.at = len(name) + len(separator)
        level = reader.expect(TOKEN)
        reader.expect(EOF)
    else:
        level, name = rule, ""
    if level.upper() not in LEVELS:
        known = ", ".join(LEVELS[1:])
        raise RuleError(f"Argument does not use a valid severity level; levels are {known}")
    return name, level


def is_remap(word: str) -> bool:
    """Whether a word is a rule for renaming."""
    try:
        read_remap(word)
    except RuleError:
        return False
    return True


def _node_prefix(reader: Reader) -> str | None:
    match = NODE_PREFIX.match(reader.text)
    if match is None:
        return None
    reader.at = match.end()
    return match[1]


def _name(reader: Reader, end: int, *, is_new: bool = False) -> None:
    """Read a name up to what ends it: that of something, or the new one that it gets."""
    reader.skip(TILDE_SLASH, SLASH)
    _token(reader, is_new=is_new)
    while reader.next() != end:
        reader.expect(SLASH)
        _token(reader, is_new=is_new)


def _token(reader: Reader, *, is_new: bool = False) -> None:
    kind = reader.next()
    if kind == REFERENCE and is_new:
        raise RuleError("Backreferences are not implemented")
    if kind in (ONE, MANY) and not is_new:
        raise RuleError(f"Wildcard '{reader.take()}' is not implemented")
    if kind != TOKEN:
        raise RuleError(f"a name is expected at index {reader.at}" if is_new else "Expecting token or wildcard")
    reader.take()


def _parameter_part(reader: Reader) -> None:
    if reader.next() not in (TOKEN, SLASH):
        _token(reader)
    while reader.next() in (TOKEN, SLASH):
        reader.take()
