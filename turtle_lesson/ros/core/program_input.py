"""`sys.stdin` and `input()` as one program has them: a file or pipe that it was given, or else the world's keyboard."""

from __future__ import annotations

import sys
from io import TextIOBase
from typing import TYPE_CHECKING, Any

from .keyboard import END

if TYPE_CHECKING:
    from .process import Process


class ProgramInput(TextIOBase):
    """The standard input of a program."""

    name = "<stdin>"
    mode = "r"
    encoding = "utf-8"
    errors = "strict"

    def __init__(self, process: Process) -> None:
        self._process = process
        self._typed = ""
        self._given = 0

    def ask(self, prompt: object = "", /) -> str:
        """What `input(prompt)` gives: the next line.

        Raises:
            EOFError: if there is none.
        """
        return self._next(str(prompt))

    def _next(self, prompt: str) -> str:
        source = self._process.stdin
        if source is None:
            return self._process.simulation.keyboard.line(self._process, prompt)
        print(prompt, end="", file=self._process.stdout or sys.stdout, flush=True)
        line = source.readline()
        if not line:
            error = EOFError(END)
            lines = "1 line" if self._given == 1 else f"{self._given} lines"
            error.add_note(f"The program asked for another line after it had read all of its input ({lines}).")
            raise error
        self._given += 1
        return line.removesuffix("\n")

    def readable(self) -> bool:
        """Always."""
        return True

    def isatty(self) -> bool:
        """Whether it is a keyboard."""
        return self._process.stdin is None

    def fileno(self) -> int:
        """0, as everywhere."""
        return 0

    def readline(self, size: int | None = -1, /) -> str:  # type: ignore[override]
        """The next line with its line end; nothing at the end of the input."""
        while "\n" not in self._typed and self._read_line():
            pass
        end = self._typed.find("\n") + 1 or len(self._typed)
        return self._take(end if size is None or size < 0 else min(end, size))

    def read(self, size: int | None = -1, /) -> str:
        """All that comes until the end of the input, or so many characters."""
        wanted = -1 if size is None else size
        while (wanted < 0 or len(self._typed) < wanted) and self._read_line():
            pass
        return self._take(len(self._typed) if wanted < 0 else wanted)

    def _read_line(self) -> bool:
        """Read one more line; whether there is one."""
        try:
            self._typed += self._next("") + "\n"
        except EOFError:
            return False
        return True

    def _take(self, count: int) -> str:
        taken, self._typed = self._typed[:count], self._typed[count:]
        return taken

    def __next__(self) -> Any:
        if line := self.readline():
            return line
        raise StopIteration
