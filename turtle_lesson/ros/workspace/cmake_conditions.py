"""Whether an `if(…)` of a CMakeLists.txt holds.

Facts: https://cmake.org/cmake/help/latest/command/if.html. Names, NOT, AND, OR, DEFINED, STREQUAL, EQUAL,
MATCHES and parentheses are understood; other tests count as false, as they mostly are for a package of Python
files.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence

from .cmake_syntax import CMakeError

_TRUE = {"1", "ON", "YES", "TRUE", "Y"}
_FALSE = {"", "0", "OFF", "NO", "FALSE", "N", "IGNORE", "NOTFOUND"}
_BINARY = {
    "STREQUAL", "EQUAL", "MATCHES", "IN_LIST", "LESS", "GREATER", "LESS_EQUAL", "GREATER_EQUAL", "STRLESS",
    "STRGREATER", "VERSION_LESS", "VERSION_GREATER", "VERSION_EQUAL", "VERSION_LESS_EQUAL",
    "VERSION_GREATER_EQUAL", "IS_NEWER_THAN",
}  # fmt: skip
_UNARY = {"DEFINED", "TARGET", "EXISTS", "COMMAND", "POLICY", "TEST", "IS_DIRECTORY", "IS_ABSOLUTE"}

Word = tuple[str, bool]


def is_true(words: Sequence[Word], variables: Mapping[str, str], line: int, file: str) -> bool:
    """Whether the condition holds; each word comes with whether it was quoted."""
    if not words:
        return False  # so does CMake
    reader = _Condition(list(words), variables)
    try:
        value = reader.either()
    except (re.error, RecursionError):  # no regular expression, or thousands of parentheses
        reader.broken = True
    if reader.words or reader.broken:
        text = " ".join(word for word, _ in words)
        given = " ".join(f'"{word}"' for word, _ in words)
        said = f"if given arguments:\n\n  {given}\n\nUnknown arguments specified"
        raise CMakeError(
            f"if({text}) is not a condition that CMake knows", line, file, words=said, place=f"{line} (if)"
        )
    return value


class _Condition:
    """Takes the words from the left, the operator that binds weakest first."""

    def __init__(self, words: list[Word], variables: Mapping[str, str]) -> None:
        self.words = words
        self.variables = variables
        self.broken = False

    def _accept(self, *expected: str) -> str | None:
        if self.words and not self.words[0][1] and self.words[0][0] in expected:
            return self.words.pop(0)[0]
        return None

    def either(self) -> bool:
        """a OR b"""
        value = self.both()
        while self._accept("OR"):
            value = self.both() or value
        return value

    def both(self) -> bool:
        """a AND b"""
        value = self.single()
        while self._accept("AND"):
            value = self.single() and value
        return value

    def single(self) -> bool:
        """NOT a, (a), a test, or one word"""
        if self._accept("NOT"):
            return not self.single()
        if self._accept("("):
            value = self.either()
            self.broken |= not self._accept(")")
            return value
        if not self.words:
            self.broken = True
            return False
        if test := self._accept(*_UNARY):
            operand = self.words.pop(0)[0] if self.words else ""
            return test == "DEFINED" and operand in self.variables
        return self._comparison()

    def _comparison(self) -> bool:
        left = self.words.pop(0)
        operator = self._accept(*_BINARY)
        if operator is None:
            return self._truth(left)
        if not self.words:
            self.broken = True
            return False
        return self._compare(self._value(left), operator, self._value(self.words.pop(0)))

    def _value(self, word: Word) -> str:
        text, quoted = word
        return text if quoted else self.variables.get(text, text)

    def _compare(self, left: str, operator: str, right: str) -> bool:
        if operator in {"STREQUAL", "EQUAL"}:
            return left == right
        if operator == "IN_LIST":
            return left in right.split(";")
        return operator == "MATCHES" and re.search(right, left) is not None

    def _truth(self, word: Word) -> bool:
        text, quoted = word
        if text.upper() in _TRUE:
            return True
        if quoted or text.upper() in _FALSE or text.upper().endswith("-NOTFOUND"):
            return False
        value = self.variables.get(text, "").upper()
        return value not in _FALSE and not value.endswith("-NOTFOUND")
