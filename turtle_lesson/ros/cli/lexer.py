"""A shell's line taken apart: words with their quotes, and the signs between commands.

The rules are those of POSIX's shells, without what this simulation leaves out: substitutions, braces and what is between
double quotes stay as they are typed, so that `"{x: 5.0}"` needs no care.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass

_CONTINUED = re.compile(r"\\[ \t]*\n")
"""A backslash at a line's end. Blanks behind it, which nobody sees, do no harm here."""

_LAST = re.compile(r"\\[ \t]*\Z")
"""A backslash at the text's end."""

_HERE = re.compile(r"<<-?[ \t]*(['\"]?)(\w+)\1")

OPERATORS = ("&&", "||", ">>", "2>&1", "&>", "2>", ";", "&", "|", ">", "<", "\n")
SPACE = " \t\r"


class UnfinishedError(ValueError):
    """A quote or a `<<END` is never closed, or the line ends in a backslash."""


@dataclass(frozen=True)
class Word:
    """One word. `text` is without quotes; `pattern` has a backslash before each quoted sign that a glob would take."""

    text: str
    pattern: str

    @property
    def plain(self) -> bool:
        """Whether no sign of it is quoted."""
        return self.text == self.pattern


@dataclass(frozen=True)
class Operator:
    """A sign such as `&&`."""

    text: str


@dataclass(frozen=True)
class HereText:
    """The lines between `<<END` and END, which a command is given to read."""

    text: str


class BackslashAtEndError(UnfinishedError):
    """The last line ends in a backslash."""


Token = Word | Operator | HereText


def tokens(text: str) -> Iterator[Token]:
    """Take a script apart.

    Raises:
        UnfinishedError: if a quote is never closed.
    """
    scanner = _Scanner(text)
    while (token := scanner.next()) is not None:
        yield token


def command_end(text: str, at: int = 0) -> int:
    """The place behind the command that begins at a place of a text, and behind its line's end.

    It goes on in the next line while a quote or a `<<END` is open, and behind a backslash, `&&`, `||` or `|`; where such
    a thing is the last one, the command takes all that is left.

    Raises:
        UnfinishedError: if a quote or a `<<END` is never closed.
    """
    scanner, before = _Scanner(text, at), None
    try:
        while (token := scanner.next()) is not None:
            if token != Operator("\n"):
                before = token
            elif before not in (Operator("&&"), Operator("||"), Operator("|")):
                break
    except BackslashAtEndError:
        return len(text)
    return len(text) - len(scanner.text) + scanner.at


class _Scanner:
    def __init__(self, text: str, at: int = 0) -> None:
        self.text = text
        self.at = at

    def next(self) -> Token | None:
        self._skip_space()
        if self.at >= len(self.text):
            return None
        here = _HERE.match(self.text, self.at)
        if here is not None:
            return self._here_text(here)
        for sign in OPERATORS:
            if self.text.startswith(sign, self.at):
                self.at += len(sign)
                return Operator(sign)
        return self._word()

    def _skip_space(self) -> None:
        text = self.text
        while self.at < len(text):
            if text[self.at] in SPACE:
                self.at += 1
            elif (continued := _CONTINUED.match(text, self.at)) is not None:
                self.at = continued.end()
            elif text[self.at] == "#":
                end = text.find("\n", self.at)
                self.at = len(text) if end < 0 else end
            else:
                return

    def _word(self) -> Word:
        plain: list[str] = []
        pattern: list[str] = []
        while self.at < len(self.text):
            char = self.text[self.at]
            if char in SPACE or char in ";&|<>\n":
                break
            quoted = char in "'\"\\"
            piece = self._quoted(char) if quoted else char
            self.at += 0 if quoted else 1
            plain.append(piece)
            pattern.append("".join(f"\\{each}" for each in piece) or "\\" if quoted else piece)
        return Word("".join(plain), "".join(pattern))

    def _quoted(self, quote: str) -> str:
        """The text of a quoted piece, which `self.at` is moved behind."""
        if quote == "\\":
            return self._after_backslash()
        begin, self.at = self.at, self.at + 1
        piece: list[str] = []
        while self.at < len(self.text):
            char = self.text[self.at]
            self.at += 1
            if char == quote:
                return "".join(piece)
            if char == "\\" and quote == '"' and self.text[self.at : self.at + 1] in {'"', "\\", "$", "`", "\n"}:
                char = self.text[self.at].replace("\n", "")
                self.at += 1
            piece.append(char)
        rest = self.text[begin : begin + 20]
        raise UnfinishedError(f"the quote {quote} before {rest!r} is never closed: write another {quote} where it ends")

    def _here_text(self, sign: re.Match[str]) -> HereText:
        """Cut the lines up to the closing word out of the text, so that what follows the sign is read next."""
        self.at = sign.end()
        begin = self.text.find("\n", self.at) + 1
        tabs = "\t*" if sign[0].startswith("<<-") else ""
        closing = re.compile(rf"^{tabs}{sign[2]}[ \t\r]*$", re.MULTILINE).search(self.text, begin) if begin else None
        if closing is None:
            raise UnfinishedError(f"{sign[0]!r} is never closed: write {sign[2]} alone on a line where the text ends")
        inside = self.text[begin : closing.start()]
        self.text = self.text[: begin - 1] + self.text[closing.end() :]
        return HereText(re.sub(r"(?m)^\t+", "", inside) if tabs else inside)

    def _after_backslash(self) -> str:
        continued = _CONTINUED.match(self.text, self.at)
        if continued is not None:
            self.at = continued.end()
            return ""
        if _LAST.match(self.text, self.at):
            raise BackslashAtEndError("a backslash at the end of a line continues on the next line, and there is none")
        char = self.text[self.at + 1]
        self.at += 2
        return char
