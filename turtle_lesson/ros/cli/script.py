"""A shell's script taken apart into words and commands, and the Python programs that are run by their name."""

from __future__ import annotations

import contextlib
import glob
import os
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from errno import EACCES, ENOENT
from pathlib import Path

from ..runtime.world import World
from ..sim.process import Output
from .jobs import lasting

# -- words and signs -------------------------------------------------------------------------------------------------
# The rules are those of POSIX's shells, without what this simulation leaves out: substitutions, braces and what is
# between double quotes stay as they are typed, so that `"{x: 5.0}"` needs no care.

_BETWEEN = re.compile(r"(?:[ \t\r]|\\[ \t]*\n|#[^\n]*)*")
_OPERATOR = re.compile(r"&&|\|\||>>|2>&1|&>|2>|[;&|><\n]")
_PIECE = re.compile(
    r"""(?P<plain>[^ \t\r\n;&|<>'"\\]+)|'(?P<single>[^']*)'|"(?P<double>(?:[^"\\]|\\.)*)"
    |(?P<continued>\\[ \t]*\n)|(?!\\[ \t]*\Z)\\(?P<escaped>.)""",
    re.DOTALL | re.VERBOSE,
)
"""A piece of a word: it ends where quotes begin or end. Blanks behind the backslash at a line's end, which cannot be seen,
do no harm here."""


class ShellSyntaxError(ValueError):
    """A line that cannot be taken apart into commands."""


class UnfinishedError(ShellSyntaxError):
    """A quote is never closed, or the line ends in a backslash."""


@dataclass(frozen=True)
class Word:
    """One word. `text` is without quotes; `pattern` has a backslash before each quoted sign that a glob would take."""

    text: str
    pattern: str


class BackslashAtEndError(UnfinishedError):
    """The last line ends in a backslash."""


Token = Word | str
"""A word, or a sign such as `&&`."""


def tokens(text: str) -> list[Token]:
    """Take a script apart. Raises UnfinishedError if a quote is never closed."""
    return [token for token, _ in _scan(text)]


def command_end(text: str, at: int = 0) -> int:
    """The place behind the command that begins at a place of a text, and behind its line's end.

    It goes on in the next line while a quote is open, and behind a backslash, `&&`, `||` or `|`; where such a thing is the
    last one, the command takes all that is left.

    Raises UnfinishedError if a quote is never closed.
    """
    before: Token | None = None
    with contextlib.suppress(BackslashAtEndError):
        for token, end in _scan(text, at):
            if token != "\n":
                before = token
            elif before not in ("&&", "||", "|"):
                return end
    return len(text)


def _scan(text: str, at: int = 0) -> Iterator[tuple[Token, int]]:
    """The tokens from a place on, each with the place behind it."""
    token: Token
    while True:
        between = _BETWEEN.match(text, at)
        at = between.end() if between else at
        if at == len(text):
            return
        if sign := _OPERATOR.match(text, at):
            at = sign.end()
            token = sign[0]
        else:
            token, at = _word(text, at)
        yield token, at


def _word(text: str, at: int) -> tuple[Word, int]:
    """A word, and the place behind it."""
    plain = pattern = ""
    while found := _PIECE.match(text, at):
        at = found.end()
        if found["plain"]:
            piece = quoted = found["plain"]
        else:
            piece = found["single"] or found["escaped"] or ""
            if found["double"]:
                piece = re.sub(r'\\(["\\$`\n])', lambda match: match[1].replace("\n", ""), found["double"])
            quoted = "".join(f"\\{each}" for each in piece) or "\\"
        plain, pattern = plain + piece, pattern + quoted
    if at < len(text) and text[at] == "\\":
        raise BackslashAtEndError("a backslash at the end of a line continues on the next line, and there is none")
    if at < len(text) and (quote := text[at]) in "'\"":
        rest = text[at : at + 20]
        raise UnfinishedError(f"the quote {quote} before {rest!r} is never closed: write another {quote} where it ends")
    return Word(plain, pattern), at


# -- pipelines -------------------------------------------------------------------------------------------------------


@dataclass
class Command:
    """One simple command: its words, and signs such as `>`, each with its file."""

    words: list[Word] = field(default_factory=list)
    redirections: list[tuple[str, Word]] = field(default_factory=list)
    background: bool = False


def pipelines(found: Sequence[Token]) -> Iterator[tuple[str, list[Command]]]:
    """The pipelines of a script, each with the sign before it that decides whether it runs."""
    condition, pipeline = "", [Command()]
    rest = iter([*found, "\n"])
    for token in rest:
        command = pipeline[-1]
        if isinstance(token, Word):
            command.words.append(token)
        elif token in {"<", ">", ">>", "2>", "&>", "2>&1"}:
            file = Word("&1", "&1") if token == "2>&1" else next(rest)
            if not isinstance(file, Word):
                raise ShellSyntaxError(f"{token!r} needs the name of a file")
            command.redirections.append((token, file))
        elif command.words and token == "|":
            pipeline.append(Command())
        elif command.words:
            command.background = token == "&"
            yield condition, pipeline
            condition, pipeline = token if token in {"&&", "||"} else "", [Command()]
        elif token != "\n":
            raise ShellSyntaxError(f"there is no command before {token!r}")
        elif len(pipeline) > 1:
            raise ShellSyntaxError("there is no command after '|'")
    if condition:
        raise ShellSyntaxError(f"there is no command after {condition!r}")


# -- what a word stands for --------------------------------------------------------------------------------------------

_VARIABLE = re.compile(r"(?<!\\)\$(?:(\w+)|\{(\w+)\})")
"""`$NAME` or `${NAME}` outside of quotes."""


def expand(word: Word, *, home: Path, exit_code: int) -> list[str]:
    """The words that a word stands for: `~`, `$?`, `$NAME` and patterns are replaced, all else stays as it is typed."""
    if word.text == word.pattern == "$?":
        return [str(exit_code)]
    text = _VARIABLE.sub(lambda found: os.environ.get(found[1] or found[2], ""), word.pattern)
    if text != word.pattern:
        return [unquoted] if (unquoted := re.sub(r"\\(.)", r"\1", text)) else []
    if word.text == word.pattern and (word.text == "~" or word.text.startswith("~/")):
        return [str(home) + word.text[1:]]
    if len(word.pattern) < 1000 and re.search(r"(?<!\\)[*?]", word.pattern):
        pattern = re.sub(r"\\(.)", lambda match: glob.escape(match[1]), word.pattern.replace("[", "[[]"))
        with contextlib.suppress(OSError, ValueError, re.error):
            return sorted(glob.glob(pattern)) or [word.text]
    return [word.text]


# -- Python programs -------------------------------------------------------------------------------------------------
# `python3 FILE.py …` and `./FILE.py …`: run a file as a program of this world, as `ros2 run` does with those of packages.

_PYTHON = re.compile(r"python(3(\.\d+)?)?")
_PATH = re.compile(r"[^()=]*/[^()=]*")


def script_of(words: Sequence[str]) -> list[str] | None:
    """The file and the arguments of a command that runs Python: `python3 FILE …`, or `./FILE …` if its first line says so.

    None for what the computer has to do. Raises OSError if there is no such file, or it may not be run, and ValueError if
    it is no program in Python.
    """
    by_name = not _PYTHON.fullmatch(words[0])
    argv = list(words if by_name else words[1:])
    if not argv or argv[0].startswith("-") or (by_name and not _PATH.fullmatch(argv[0])):
        return None
    if not os.path.isfile(argv[0]):
        raise FileNotFoundError(ENOENT, "No such file or directory", argv[0] if argv[0] != words[0] else None)
    if by_name and not os.access(argv[0], os.X_OK):
        raise PermissionError(EACCES, f"Permission denied. Make it executable: chmod +x {argv[0]}")
    if by_name:
        with Path(argv[0]).open(encoding="utf-8", errors="replace") as file:
            if not re.match(r"#!.*python[\d.]*(\s|$)", file.readline(200)):
                raise ValueError("only programs in Python run here: the first line of theirs is #!/usr/bin/env python3")
    return argv


def run_script(
    world: World, words: Sequence[str], argv: list[str], stdin: str | None, stdout: Output, stderr: Output
) -> int:
    """Start the file `argv[0]`, let it begin, and leave it running; the exit code of one that has ended at once.

    It reads `stdin` as its input, or the keyboard if there is none, and prints into the cell, or into files behind `>`.
    """
    from .group_run_launch import leave, reader_of

    path = Path(argv[0])
    out, error = lasting(stdout, world.sim), lasting(stderr, world.sim)
    process = world.spawn(path, name=path.stem, argv=argv, stdin=reader_of(stdin), stdout=out, stderr=error)
    return leave(process, " ".join(words), None)
