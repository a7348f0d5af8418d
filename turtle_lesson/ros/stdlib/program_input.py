"""`sys.stdin` and `input()` as one program has them: a file or pipe that it was given, or else the world's keyboard.

A program that turns its terminal's line mode off (termios, tty, curses) reads keys: whatever is pressed, as soon as it is
pressed. Until then, or with `input()`, it reads whole lines.
"""

from __future__ import annotations

import signal
import sys
from io import TextIOBase
from typing import TYPE_CHECKING, Any

from ..sim.keyboard import END, SENT, KeyReader

if TYPE_CHECKING:
    from ..sim.process import Process


class ProgramInput(TextIOBase):
    """The standard input of a program.

    Attributes:
        keys: the keys that were pressed for it.
        raw: whether it reads keys instead of lines.
        signals: whether Ctrl-C interrupts the program; else it is a key like any other.
        returns: whether the enter key gives "\\r" instead of "\\n".
        patience: how long it waits for a key, in s; None: until there is one.
        attributes: the terminal's settings, for termios; None: as they are at first.
    """

    name = "<stdin>"
    mode = "r"
    encoding = "utf-8"
    errors = "strict"

    def __init__(self, process: Process) -> None:
        self.process = process
        self.keys = KeyReader(process, has_terminal=True)
        self.raw = False
        self.signals = True
        self.returns = False
        self.patience: float | None = None
        self.attributes: list[Any] | None = None
        self._typed = ""
        self._given = 0

    def ask(self, prompt: object = "", /) -> str:
        """What `input(prompt)` gives: the next line.

        Raises:
            EOFError: if there is none.
        """
        return self._next(str(prompt))

    def _next(self, prompt: str) -> str:
        source = self.process.stdin
        if source is None:
            return self.process.simulation.keyboard.line(self.process, prompt)
        print(prompt, end="", file=self.process.stdout or sys.stdout, flush=True)
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
        return self.process.stdin is None

    def fileno(self) -> int:
        """0, as everywhere."""
        return 0

    def readline(self, size: int | None = -1, /) -> str:  # type: ignore[override]
        """The next line with its line end; nothing at the end of the input."""
        while "\n" not in self._typed and self._read_more():
            pass
        end = self._typed.find("\n") + 1 or len(self._typed)
        return self._take(end if size is None or size < 0 else min(end, size))

    def read(self, size: int | None = -1, /) -> str:
        """All that comes until the end of the input, or so many characters."""
        wanted = -1 if size is None else size
        while (wanted < 0 or len(self._typed) < wanted) and self._read_more():
            pass
        return self._take(len(self._typed) if wanted < 0 else wanted)

    def is_ready(self, seconds: float | None) -> bool:
        """Whether something can be read, now or within `seconds` of robot time; None: wait for it."""
        if self._typed or not self.isatty():
            return True
        simulation = self.process.simulation
        end = None if seconds is None else simulation.now + round(seconds * 1e9)
        while not (self.process.simulation.keyboard.lines and not self.raw):
            left = None if end is None else max(0.0, (end - simulation.now) / 1e9)
            if not self.keys.wait(left):
                return False
            self._take_keys()
            if self._typed and (self.raw or "\n" in self._typed):
                return True
        return True

    def read_there(self, size: int) -> str:
        """So many characters at most, of those that are there without waiting."""
        if self.isatty():
            self._take_keys()
            return self._take(min(size, len(self._typed)))
        return self.read(size)

    @property
    def is_ready_text(self) -> bool:
        """Whether characters are there that were typed and not read."""
        return bool(self._typed)

    def put_back(self, text: str) -> None:
        """Have characters be read next."""
        self._typed = text + self._typed

    def next_key(self, seconds: float | None) -> str | None:
        """The name of the next key, None if none is pressed within `seconds` of robot time (None: wait for it)."""
        while self.keys.wait(seconds):
            name, _ = self.keys.events.popleft()
            if not self._interrupts(name) and SENT.get(name, name):
                return name
        return None

    def _read_more(self) -> bool:
        """Read one more line, or a key; whether there is one."""
        if self.raw and self.isatty():
            if self.keys.wait(self.patience):
                self._take_keys()
                return True
            return False
        try:
            self._typed += self._next("") + "\n"
        except EOFError:
            return False
        return True

    def _take_keys(self) -> None:
        while self.keys.events:
            name, _ = self.keys.events.popleft()
            if not self._interrupts(name):
                self._typed += "\r" if self.returns and name == "enter" else SENT.get(name, name)

    def _interrupts(self, name: str) -> bool:
        """Whether a key is Ctrl-C, and the terminal interrupts the program with it."""
        if name != "ctrl+c" or not self.signals:
            return False
        self.process.send_signal(signal.SIGINT)
        return True

    def _take(self, count: int) -> str:
        taken, self._typed = self._typed[:count], self._typed[count:]
        return taken

    def flush_keys(self) -> None:
        """Forget what was pressed and not read."""
        self._typed = ""
        self.keys.events.clear()

    def __next__(self) -> Any:
        if line := self.readline():
            return line
        raise StopIteration
