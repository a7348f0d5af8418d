"""A script taken apart into pipelines of commands, and what their words stand for."""

from __future__ import annotations

import contextlib
import glob
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from .terminal_variables import with_values
from .words import HereText, Operator, Token, Word


class ShellSyntaxError(ValueError):
    """A line that cannot be taken apart into commands."""


@dataclass
class Command:
    """One simple command: its words, and where its input and output go."""

    words: list[Word] = field(default_factory=list)
    given: str | None = None
    stdin: Word | None = None
    stdout: tuple[str, Word] | None = None
    stderr: Word | None = None
    background: bool = False


def pipelines(found: Sequence[Token]) -> Iterator[tuple[str, list[Command]]]:
    """The pipelines of a script, each with the sign before it that decides whether it runs."""
    condition, pipeline = "", [Command()]
    for token in [*found, Operator("\n")]:
        command = pipeline[-1]
        if isinstance(token, Word):
            _take(command, token)
        elif isinstance(token, HereText):
            command.given = token.text
        elif token.text == "|":
            _check(command, "|")
            pipeline.append(Command())
        elif token.text in {">", ">>", "2>", "&>", "<"}:
            _expect_file(command, token.text)
        elif token.text == "2>&1":
            command.stderr = TO_STDOUT
        elif command.words or len(pipeline) > 1:
            _check(command, token.text)
            command.background = token.text == "&"
            yield condition, pipeline
            condition, pipeline = token.text if token.text in {"&&", "||"} else "", [Command()]
        elif token.text != "\n":
            raise ShellSyntaxError(f"there is no command before {token.text!r}")
    if condition or len(pipeline) > 1:
        raise ShellSyntaxError(f"there is no command after {condition or '|'!r}")


TO_STDOUT = Word("&1", "&1")
_WANTED = Word("\0wanted", "\0wanted")


def _expect_file(command: Command, sign: str) -> None:
    if sign == "<":
        command.stdin = _WANTED
    elif sign == "2>":
        command.stderr = _WANTED
    else:
        command.stdout = (sign, _WANTED)
        command.stderr = TO_STDOUT if sign == "&>" else command.stderr


def _take(command: Command, word: Word) -> None:
    """A word is the file that a `<` or `>` waits for, or one more word of the command."""
    if command.stdin == _WANTED:
        command.stdin = word
    elif command.stdout is not None and command.stdout[1] == _WANTED:
        command.stdout = (command.stdout[0], word)
    elif command.stderr == _WANTED:
        command.stderr = word
    else:
        command.words.append(word)


def _check(command: Command, sign: str) -> None:
    if not command.words:
        raise ShellSyntaxError(
            f"there is no command before {sign!r}" if sign != "\n" else "there is no command after '|'"
        )
    if command.stdin == _WANTED:
        raise ShellSyntaxError("'<' needs the name of a file")
    if _WANTED in (command.stderr, *(command.stdout or ())):
        raise ShellSyntaxError("'>' needs the name of a file")


# -- what a word stands for --------------------------------------------------------------------------------------------


def expand(word: Word, *, home: Path, exit_code: int) -> list[str]:
    """The words that a word stands for: `~`, `$?`, `$NAME` and patterns are replaced, all else stays as it is typed."""
    if word.text == word.pattern == "$?":
        return [str(exit_code)]
    if (text := with_values(word.pattern)) != word.pattern:
        return [unquoted] if (unquoted := re.sub(r"\\(.)", r"\1", text)) else []
    if word.plain and (word.text == "~" or word.text.startswith("~/")):
        return [str(home) + word.text[1:]]
    if len(word.pattern) < 1000 and re.search(r"(?<!\\)[*?]", word.pattern):
        pattern = re.sub(r"\\(.)", lambda match: glob.escape(match[1]), word.pattern.replace("[", "[[]"))
        with contextlib.suppress(OSError, ValueError, re.error):
            return sorted(glob.glob(pattern)) or [word.text]
    return [word.text]
