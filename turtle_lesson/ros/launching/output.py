"""What reaches the screen: launch's own lines, and each process's output with its name before every line."""

from __future__ import annotations

import io
from collections.abc import Callable
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ..world import World


class Screen:
    """Prints into the cell that is running, whichever process prints."""

    def __init__(self, world: World) -> None:
        self._world = world

    def line(self, text: str) -> None:
        """Print one line."""
        print(text, file=self._world.sim.cell_stdout)

    def say(self, level: str, name: str, text: str) -> None:
        """Print a line of launch's own, such as `[INFO] [launch]: …`."""
        self.line(f"[{level}] [{name}]: {text}")


class LineWriter(io.TextIOBase):
    """A text stream that hands on whole lines; what has no end yet waits until `finish`."""

    def __init__(self, on_line: Callable[[str], None], on_text: Callable[[str], None] | None = None) -> None:
        super().__init__()
        self._on_line = on_line
        self._on_text = on_text
        self._rest = ""
        self._unheard = ""

    def writable(self) -> bool:
        """Always."""
        return True

    def isatty(self) -> bool:
        """Never: a launched process has no terminal."""
        return False

    @property
    def encoding(self) -> str:  # type: ignore[override]
        """UTF-8."""
        return "utf-8"

    def write(self, text: str) -> int:
        """Take text; whole lines are handed on at once."""
        if not isinstance(text, str):
            raise TypeError(f"write() argument must be str, not {type(text).__name__}")
        if self._on_text is not None and text:
            self._unheard += text
            if text.endswith("\n"):  # what one print() gives is heard as one piece
                self._tell()
        *lines, self._rest = (self._rest + text).split("\n")
        for line in lines:
            self._on_line(line.removesuffix("\r"))
        return len(text)

    def finish(self) -> None:
        """Hand on what has no line end."""
        self._tell()
        rest, self._rest = self._rest, ""
        if rest:
            self._on_line(rest)

    def _tell(self) -> None:
        unheard, self._unheard = self._unheard, ""
        if self._on_text is not None and unheard:
            self._on_text(unheard)
