"""The language of CMakeLists.txt: text to commands with their arguments and lines, conditions, and CMake's messages.

Facts: https://cmake.org/cmake/help/latest/manual/cmake-language.7.html and, for conditions, command/if.html there.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass


class CMakeError(ValueError):
    """A CMakeLists.txt that CMake would refuse, or that needs more of CMake than is understood here.

    Attributes:
        reason: what is wrong, and what to try.
        line: where the mistake is.
        words: what CMake itself says, where it says it otherwise.
        place: what stands behind the file's name in CMake's message: `12 (install)`, or the line alone.
    """

    def __init__(
        self, reason: str, line: int, file: str = "CMakeLists.txt", *, words: str = "", place: str | int = ""
    ) -> None:
        super().__init__(reason, line, file)
        self.reason = reason
        self.line = line
        self.file = file
        self.words = words
        self.place = str(place or line)

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
_BLANKS = re.compile(r"[ \t\r]+")
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
            rest = self.text[self.text.index("[", self.position + 1) + 1 :]
            words = f'Parse error. Expected a command name, got unterminated bracket with text "{_shown(rest)}".'
            reason = "this #[[ comment never ends; close it with ]]"
            raise CMakeError(reason, line, self.file, words=words, place=self.last_line)
        return True

    @property
    def last_line(self) -> int:
        return self.text.count("\n") + 1

    def got(self) -> tuple[str, int]:
        """What CMake calls the token that comes next, and the line at which it says so."""
        rest = self.text[self.position :]
        if rest[:1] == "\n":
            return f'newline with text "{_shown(rest[:1])}"', self.line + 1
        if rest[:1] in {"(", ")"}:
            return f'{"left" if rest[0] == "(" else "right"} paren with text "{rest[0]}"', self.line
        if match := _QUOTED.match(rest):
            return f'quoted argument with text "{match[1][:60]}"', self.line
        if match := _NAME.match(rest):
            return f'identifier with text "{match[0][:60]}"', self.line
        match = _PLAIN.match(rest)
        return f'unquoted argument with text "{(match[0] if match else rest)[:60]}"', self.line

    def error(self, reason: str, line: int, words: str, place: int) -> CMakeError:
        return CMakeError(reason, line, self.file, words=words, place=place)


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
    token, place = reader.got()
    name = reader.take(_NAME)
    if not name:
        found = reader.text[reader.position : reader.position + 20].split("\n")[0]
        words = f"Parse error. Expected a command name, got {token}."
        raise reader.error(f"expected a command such as find_package(…), found {found!r}", line, words, place)
    reader.take(_BLANKS)
    if not reader.text.startswith("(", reader.position):
        token, place = reader.got()
        words = f'Parse error. Expected "(", got {token}.'
        if reader.position >= len(reader.text):
            words = 'Unexpected end of file.\nParse error. Function missing opening "(".'
        raise reader.error(f"expected '(' after {name[0]!r}: a command looks like {name[0]}(…)", line, words, place)
    reader.position += 1
    return Call(name[0].lower(), tuple(_arguments(reader, name[0], line)), line)


def _arguments(reader: _Reader, name: str, line: int) -> list[Argument]:
    arguments: list[Argument] = []
    depth = 1
    while True:
        reader.skip_blanks()
        here = reader.line
        if reader.position >= len(reader.text):
            reason = f"the '(' of {name} is never closed; put a ')' where its arguments end"
            raise reader.error(reason, line, 'Parse error. Function missing ending ")". End of file reached.', line)
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
    rest = reader.text[reader.position + 1 :]
    words = f'Parse error. Function missing ending ")". Instead found unterminated string with text "{_shown(rest)}".'
    reason = 'this quote is never closed; end the text with another "'
    raise reader.error(reason, line, words, reader.last_line)


def _shown(rest: str) -> str:
    """Text as CMake shows it, every line a paragraph; a long one is cut."""
    cut = rest if len(rest) <= 400 else f"{rest[:400]}…"
    return cut.replace("\n", "\n\n")


BLOCKS = ("foreach", "while", "function", "macro")
"""The commands whose bodies are passed over."""

_ENDS = {f"end{name}": name for name in ("if", *BLOCKS)}


def check_blocks(calls: Sequence[Call], file: str) -> None:
    """Every `if` and every loop is closed, in the right order.

    Raises:
        CMakeError: where CMake says `Flow control statements are not properly nested`.
    """
    opened: list[Call] = []
    for call in calls:
        if call.name in _ENDS.values():
            opened.append(call)
        elif call.name in {*_ENDS, "else", "elseif"}:
            start = _ENDS.get(call.name, "if")
            if not opened or opened[-1].name != start:
                article = "an" if start == "if" else "a"
                raise _not_nested(call, f"{call.name}() without {article} {start}() before it", file)
            if call.name in _ENDS:
                opened.pop()
    if opened:
        call = opened[-1]
        raise _not_nested(call, f"this {call.name}() has no end{call.name}()", file)


def _not_nested(call: Call, reason: str, file: str) -> CMakeError:
    words = "Flow control statements are not properly nested."
    return CMakeError(reason, call.line, file, words=words, place=f"{call.line} ({call.name})")


_TRUE = {"1", "ON", "YES", "TRUE", "Y"}
_FALSE = {"", "0", "OFF", "NO", "FALSE", "N", "IGNORE", "NOTFOUND"}
_BINARY = {
    "STREQUAL", "EQUAL", "MATCHES", "IN_LIST", "LESS", "GREATER", "LESS_EQUAL", "GREATER_EQUAL", "STRLESS",
    "STRGREATER", "VERSION_LESS", "VERSION_GREATER", "VERSION_EQUAL", "VERSION_LESS_EQUAL",
    "VERSION_GREATER_EQUAL", "IS_NEWER_THAN",
}  # fmt: skip
_UNARY = {"DEFINED", "TARGET", "EXISTS", "COMMAND", "POLICY", "TEST", "IS_DIRECTORY", "IS_ABSOLUTE"}

Word = tuple[str, bool]


def condition_holds(words: Sequence[Word], variables: Mapping[str, str], line: int, file: str) -> bool:
    """Whether the condition of an `if(…)` holds; each word comes with whether it was quoted.

    Names, NOT, AND, OR, DEFINED, STREQUAL, EQUAL, IN_LIST, MATCHES and parentheses are understood; other tests count as
    false, as they mostly are for a package of Python files.
    """
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


_WIDTH = 75
_INDENT = "  "
SHARE = "/opt/ros/humble/share"
"""Where the real build's own files are; named in the call stacks of its messages."""


def cmake_message(text: str, where: str, stack: Sequence[str] = (), kind: str = "Error") -> str:
    """`CMake Error at <where>:` and the text; the paragraphs of the text are separated by empty lines.

    The wrapping is CMake's: lines of at most 77 columns, indented by two, two spaces after a full stop, and lines that
    begin with a space left as they are.
    """
    lines = [f"CMake {kind} at {where}:" if where else f"CMake {kind}:", *map(_paragraph, text.split("\n"))]
    if stack:
        lines += ["Call Stack (most recent call first):", *(f"{_INDENT}{call}" for call in stack)]
    return "\n".join(lines) + "\n\n"


def _paragraph(line: str) -> str:
    if not line:
        return ""
    if line.startswith(" "):
        return f"{_INDENT}{line}"
    return "\n".join(_INDENT + part for part in _wrapped(line))


def _wrapped(text: str) -> list[str]:
    lines: list[str] = []
    current = ""
    for word in text.split():
        new_sentence = current.endswith(".")
        if current and len(word) >= _WIDTH - len(current) - new_sentence:
            lines.append(current)
            current = word
        else:
            current += ("  " if new_sentence else " " if current else "") + word
    return [*lines, current]
