"""A shell's line taken apart: words with their quotes, and the signs between commands.

The rules are those of POSIX's shells, without what this simulation leaves out: substitutions, braces and what is between
double quotes stay as they are typed, so that `"{x: 5.0}"` needs no care.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

_CONTINUED = re.compile(r"\\[ \t]*\n")
"""A backslash at a line's end. Blanks behind it, which nobody sees, do no harm here."""

_LAST = re.compile(r"\\[ \t]*\Z")
"""A backslash at the text's end."""

_HERE = re.compile(r"<<-?[ \t]*(['\"]?)(\w+)\1")

_BETWEEN = re.compile(r"(?:[ \t\r]|\\[ \t]*\n|#[^\n]*)*")
_OPERATOR = re.compile(r"&&|\|\||>>|2>&1|&>|2>|[;&|><\n]")
_UNQUOTED = re.compile(r"[^ \t\r\n;&|<>'\"\\]+(?=[ \t\r\n;&|<>]|\Z)")
"""A word without quotes."""

_WORD_END = " \t\r\n;&|<>"


class UnfinishedError(ValueError):
    """A quote or a `<<END` is never closed, or the line ends in a backslash."""


@dataclass(frozen=True)
class Word:
    """One word. `text` is without quotes; `pattern` has a backslash before each quoted sign that a glob would take."""

    text: str
    pattern: str


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


def tokens(text: str) -> list[Token]:
    """Take a script apart.

    Raises:
        UnfinishedError: if a quote is never closed.
    """
    return _scan(text)[0]


def command_end(text: str, at: int = 0) -> int:
    """The place behind the command that begins at a place of a text, and behind its line's end.

    It goes on in the next line while a quote or a `<<END` is open, and behind a backslash, `&&`, `||` or `|`; where such
    a thing is the last one, the command takes all that is left.

    Raises:
        UnfinishedError: if a quote or a `<<END` is never closed.
    """
    try:
        return len(text) - _scan(text, at, one_command=True)[1]
    except BackslashAtEndError:
        return len(text)


def _scan(text: str, at: int = 0, *, one_command: bool = False) -> tuple[list[Token], int]:
    """The tokens from a place on, all or those of one command, and how many characters come after them."""
    found: list[Token] = []
    token: Token
    before: Token | None = None  # the last token of this command that is no line's end
    while True:
        between = _BETWEEN.match(text, at)
        at = between.end() if between else at
        if at == len(text):
            break
        if here := _HERE.match(text, at):
            at = here.end()
            token, text = _here_text(here)
        elif sign := _OPERATOR.match(text, at):
            at = sign.end()
            token = Operator(sign[0])
        elif word := _UNQUOTED.match(text, at):
            at = word.end()
            token = Word(word[0], word[0])
        else:
            token, at = _word_with_quotes(text, at)
        found.append(token)
        if token != Operator("\n"):
            before = token
        elif one_command and before not in (Operator("&&"), Operator("||"), Operator("|")):
            break
    return found, len(text) - at


def _word_with_quotes(text: str, at: int) -> tuple[Word, int]:
    """A word, and the place behind it."""
    plain: list[str] = []
    pattern: list[str] = []
    while at < len(text) and text[at] not in _WORD_END:
        if text[at] in "'\"\\":
            piece, at = _after_backslash(text, at + 1) if text[at] == "\\" else _quoted(text, at)
            pattern.append("".join(f"\\{each}" for each in piece) or "\\")
        else:
            piece, at = text[at], at + 1
            pattern.append(piece)
        plain.append(piece)
    return Word("".join(plain), "".join(pattern)), at


def _quoted(text: str, begin: int) -> tuple[str, int]:
    """The text between two quotes, and the place behind them."""
    quote, at = text[begin], begin + 1
    piece: list[str] = []
    while at < len(text):
        char = text[at]
        at += 1
        if char == quote:
            return "".join(piece), at
        if char == "\\" and quote == '"' and text[at : at + 1] in {'"', "\\", "$", "`", "\n"}:
            char = text[at].replace("\n", "")
            at += 1
        piece.append(char)
    rest = text[begin : begin + 20]
    raise UnfinishedError(f"the quote {quote} before {rest!r} is never closed: write another {quote} where it ends")


def _after_backslash(text: str, at: int) -> tuple[str, int]:
    if continued := _CONTINUED.match(text, at - 1):
        return "", continued.end()
    if _LAST.match(text, at - 1):
        raise BackslashAtEndError("a backslash at the end of a line continues on the next line, and there is none")
    return text[at], at + 1


def _here_text(sign: re.Match[str]) -> tuple[HereText, str]:
    """The lines up to the closing word, and the whole text without them, so that what follows the sign is read next."""
    text = sign.string
    begin = text.find("\n", sign.end()) + 1
    tabs = "\t*" if sign[0].startswith("<<-") else ""
    closing = re.compile(rf"^{tabs}{sign[2]}[ \t\r]*$", re.MULTILINE).search(text, begin) if begin else None
    if closing is None:
        raise UnfinishedError(f"{sign[0]!r} is never closed: write {sign[2]} alone on a line where the text ends")
    inside = text[begin : closing.start()]
    return HereText(re.sub(r"(?m)^\t+", "", inside) if tabs else inside), text[: begin - 1] + text[closing.end() :]
