"""What a command of the terminal works with: its world, its streams, and the options among its words."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from ..world import World


@dataclass
class Terminal:
    """What a command of the terminal works with."""

    world: World
    stdout: Any
    stderr: Any
    given: str | None = None

    def say(self, text: str) -> int:
        """Print a line; returns exit code 0."""
        print(text, file=self.stdout)
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
