"""The grammar of CMakeLists.txt: text to commands, each with its arguments and its line.

Facts: https://cmake.org/cmake/help/latest/manual/cmake-language.7.html. Nothing is evaluated here.
"""

from __future__ import annotations

import re
from dataclasses import dataclass


class CMakeError(ValueError):
    """A CMakeLists.txt that CMake would refuse, or that needs more of CMake than is understood here."""

    def __init__(self, reason: str, line: int, file: str = "CMakeLists.txt") -> None:
        super().__init__(reason, line, file)
        self.reason = reason
        self.line = line
        self.file = file

    def __str__(self) -> str:
        return f"{self.file}, line {self.line}: {self.reason}"


@dataclass(frozen=True)
class Argument:
    """One argument as written. `quoted` ones stay one argument, `raw` ones ([[…]]) are never expanded."""

    text: str
    line: int
    quoted: bool = False
    raw: bool = False


@dataclass(frozen=True)
class Call:
    """One command as written: its name in lower case, its arguments, the line where it begins."""

    name: str
    args: tuple[Argument, ...]
    line: int


_SPACE = re.compile(r"\s+")
_COMMENT = re.compile(r"#(?!\[=*\[)[^\n]*")
_BRACKET = re.compile(r"\[(=*)\[\n?(.*?)\]\1\]", re.DOTALL)
_NAME = re.compile(r"[A-Za-z_]\w*")
_QUOTED = re.compile(r'"((?:[^"\\]|\\.)*)"', re.DOTALL)
_PLAIN = re.compile(r'(?:[^\s()#"\\]|\\.|(?<=[^\s()])"[^"]*")+')


class _Reader:
    """Walks over the text once; `position` is the next character to read."""

    def __init__(self, text: str, file: str) -> None:
        self.text = text
        self.file = file
        self.position = 0

    @property
    def line(self) -> int:
        return self.text.count("\n", 0, self.position) + 1

    def take(self, pattern: re.Pattern[str]) -> re.Match[str] | None:
        """What the pattern matches here, stepped over; None if it does not match."""
        if match := pattern.match(self.text, self.position):
            self.position = match.end()
        return match

    def skip_blanks(self) -> None:
        """Step over spaces, line ends and comments of both kinds."""
        while self.take(_SPACE) or self.take(_COMMENT) or self._bracket_comment():
            pass

    def _bracket_comment(self) -> bool:
        if not self.text.startswith("#[", self.position):
            return False
        line = self.line
        self.position += 1
        if not self.take(_BRACKET):
            raise CMakeError("this #[[ comment never ends; close it with ]]", line, self.file)
        return True

    def error(self, reason: str, line: int | None = None) -> CMakeError:
        return CMakeError(reason, line or self.line, self.file)


def read_calls(text: str, file: str = "CMakeLists.txt") -> list[Call]:
    """All commands of the text, in order.

    Raises:
        CMakeError: where the text is no CMake, with the line.
    """
    reader = _Reader(text, file)
    calls = []
    reader.skip_blanks()
    while reader.position < len(text):
        calls.append(_call(reader))
        reader.skip_blanks()
    return calls


def _call(reader: _Reader) -> Call:
    line = reader.line
    name = reader.take(_NAME)
    if not name:
        found = reader.text[reader.position : reader.position + 20].split("\n")[0]
        raise reader.error(f"expected a command such as find_package(…), found {found!r}")
    reader.take(_SPACE)
    if not reader.text.startswith("(", reader.position):
        raise reader.error(f"expected '(' after {name[0]!r}: a command looks like {name[0]}(argument)", line)
    reader.position += 1
    return Call(name[0].lower(), tuple(_arguments(reader, name[0], line)), line)


def _arguments(reader: _Reader, name: str, line: int) -> list[Argument]:
    arguments: list[Argument] = []
    depth = 1
    while True:
        reader.skip_blanks()
        here = reader.line
        if reader.position >= len(reader.text):
            raise reader.error(f"the '(' of {name} is never closed; put a ')' where its arguments end", line)
        character = reader.text[reader.position]
        if character in "()":
            reader.position += 1
            depth += 1 if character == "(" else -1
            if depth == 0:
                return arguments
            arguments.append(Argument(character, here))
        else:
            arguments.append(_argument(reader, here))


def _argument(reader: _Reader, line: int) -> Argument:
    if match := reader.take(_BRACKET):
        return Argument(match[2], line, quoted=True, raw=True)
    if match := reader.take(_QUOTED):
        return Argument(match[1].replace("\\\n", ""), line, quoted=True)
    if match := reader.take(_PLAIN):
        return Argument(match[0], line)
    raise reader.error('this quote is never closed; end the text with another "', line)
