"""How the rules among ROS arguments are written: `-r from:=to`, `-p name:=value`, `--log-level logger:=level`.

Facts: rcl's lexer.c and arguments.c (which names may stand where, and the words of the errors), and recordings of them.
"""

from __future__ import annotations

import re

from turtle_lesson.ros.graph.names import Remap

LEVELS = ("UNSET", "DEBUG", "INFO", "WARN", "ERROR", "FATAL")
NONE, EOF, TILDE_SLASH, SERVICE_URL, TOPIC_URL, COLON, NODE, NS, SEPARATOR, REFERENCE = range(10)
TOKEN, SLASH, ONE, MANY, DOT = range(18, 23)  # the numbers stand in errors
LEXEMES = [
    (SERVICE_URL, re.compile("rosservice://")),
    (TOPIC_URL, re.compile("rostopic://")),
    (NODE, re.compile("__(node|name)")),
    (NS, re.compile("__ns")),
    (TOKEN, re.compile(r"(_(?!_)|(?=[A-Za-z]))([A-Za-z0-9]+_?)*")),
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
        return self._look(self.at)[0]

    def _look(self, at: int) -> tuple[int, int]:
        for kind, pattern in LEXEMES:
            if (match := pattern.match(self.text, at)) is not None:
                return kind, match.end()
        return NONE, at + 1

    def begins(self, first: int, second: int) -> bool:
        """Whether the next two pieces are of these kinds."""
        kind, end = self._look(self.at)
        return kind == first and self._look(end)[0] == second

    def take(self) -> str:
        """The next piece, which is left behind."""
        start, self.at = self.at, self._look(self.at)[1]
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
        _match_side(reader)
        name = rule[start : reader.at]
    reader.expect(SEPARATOR)
    start = reader.at
    {NODE: _new_name, NS: _new_namespace}.get(kind, _replacement)(reader)
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
    if not reader.begins(TOKEN, COLON):
        return None
    name = reader.take()
    reader.take()
    return name


def _match_side(reader: Reader) -> None:
    reader.skip(TILDE_SLASH, SLASH)
    _token(reader)
    while reader.next() != SEPARATOR:
        reader.expect(SLASH)
        _token(reader)


def _token(reader: Reader) -> None:
    kind = reader.next()
    if kind in (ONE, MANY):
        raise RuleError(f"Wildcard '{reader.take()}' is not implemented")
    if kind != TOKEN:
        raise RuleError("Expecting token or wildcard")
    reader.take()


def _replacement(reader: Reader) -> None:
    reader.skip(TILDE_SLASH, SLASH)
    _new_token(reader)
    while reader.next() != EOF:
        reader.expect(SLASH)
        _new_token(reader)


def _new_token(reader: Reader) -> None:
    if reader.next() == REFERENCE:
        raise RuleError("Backreferences are not implemented")
    if reader.next() != TOKEN:
        raise RuleError(f"a name is expected at index {reader.at}")
    reader.take()


def _new_name(reader: Reader) -> None:
    reader.expect(TOKEN)
    reader.expect(EOF)


def _new_namespace(reader: Reader) -> None:
    reader.expect(SLASH)
    reader.skip(TOKEN)
    while reader.next() == SLASH:
        reader.take()
        reader.skip(TOKEN)
    reader.expect(EOF)


def _parameter_part(reader: Reader) -> None:
    if reader.next() not in (TOKEN, SLASH):
        _token(reader)
    while reader.next() in (TOKEN, SLASH):
        reader.take()
