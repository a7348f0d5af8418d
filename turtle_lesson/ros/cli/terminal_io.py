"""What a command of the terminal works with: its world, its streams, its options, and its environment variables."""

from __future__ import annotations

import contextlib
import os
import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from itertools import takewhile
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from ..runtime.world import World


@dataclass
class Terminal:
    """What a command of the terminal works with."""

    world: World
    stdout: Any
    stderr: Any
    given: str | None = None

    def say(self, *lines: object) -> int:
        """Print lines; returns exit code 0."""
        for line in lines:
            print(line, file=self.stdout)
        return 0

    def fail(self, text: str, code: int = 1) -> int:
        """Print a line on stderr; returns the exit code."""
        print(text, file=self.stderr)
        return code


Builtin = Callable[[Terminal, list[str]], int]


def options(words: list[str]) -> tuple[set[str], list[str]]:
    """The letters after `-`, and the other words."""
    letters = {letter for word in words if re.fullmatch("-[A-Za-z0-9]+", word) for letter in word[1:]}
    return letters, [word for word in words if not re.fullmatch("-[A-Za-z0-9]+", word) and word != "--"]


# -- environment variables -------------------------------------------------------------------------------------------
# They are the notebook's own variables, which each process has a copy of when it begins.

_ASSIGNMENT = re.compile(r"([A-Za-z_]\w*)=(.*)", re.DOTALL)
_NAME = re.compile(r"[A-Za-z_]\w*")
_UNQUOTED = re.compile(r"(?<!\\)\$(?:(\w+)|\{(\w+)\})")


def export(terminal: Terminal, words: list[str]) -> int:
    """`export NAME=value…`: set variables for what is started from now on."""
    if not words:
        return printenv(terminal, words)
    for word in words:
        found = _ASSIGNMENT.fullmatch(word)
        if found is not None:
            os.environ[found[1]] = found[2]
        elif not _NAME.fullmatch(word):
            return terminal.fail(
                f"export: {word!r} is not the name of a variable: write export NAME=value, without spaces"
            )
    return 0


def unset(terminal: Terminal, words: list[str]) -> int:
    """`unset NAME…`: have variables no more."""
    for word in words:
        if not _NAME.fullmatch(word):
            return terminal.fail(f"unset: {word!r} is not the name of a variable")
        os.environ.pop(word, None)
    return 0


def printenv(terminal: Terminal, words: list[str]) -> int:
    """`printenv [NAME…]`: print variables; of one that is not set nothing but the exit code 1."""
    if not words:
        return terminal.say(*(f"{name}={value}" for name, value in sorted(os.environ.items())))
    there = [os.environ[name] for name in words if name in os.environ]
    terminal.say(*there)
    return 0 if len(there) == len(words) else 1


def before_a_command(words: Sequence[str]) -> dict[str, str]:
    """The `NAME=value` with which a command's words begin."""
    found = takewhile(bool, map(_ASSIGNMENT.fullmatch, words))
    return {each[1]: each[2] for each in found if each}


@contextlib.contextmanager
def set_for_now(variables: dict[str, str]) -> Iterator[None]:
    """Have variables set for what is started within."""
    before = {name: os.environ[name] for name in variables if name in os.environ}
    os.environ.update(variables)
    try:
        yield
    finally:
        for name in variables:
            os.environ.pop(name, None)
        os.environ.update(before)


def with_values(pattern: str) -> str:
    """A word in which `$NAME` and `${NAME}` outside of quotes are replaced; nothing stands for one that is not set."""
    return _UNQUOTED.sub(lambda found: os.environ.get(found[1] or found[2], ""), pattern)
