"""A program's terminal: `sys.stdin` and `input()`, and the modules by which it reads keys, from `termios` to `msvcrt`.

A program reads whole lines. Once it turns its terminal's line mode off (termios, tty) it reads keys: whatever is
pressed in the notebook, as soon as it is pressed. It waits in robot time.

The modules are those that a program's import statements get. For any other file they call the real ones. The flags are
Linux's, on every computer (`man 3 termios`; Python's documentation of termios, tty and msvcrt).
"""

from __future__ import annotations

import builtins
import errno
import os
import select as real_select
import signal
import sys
from collections.abc import Callable, Iterable
from copy import deepcopy
from importlib.util import find_spec
from io import TextIOBase
from types import ModuleType
from typing import TYPE_CHECKING, Any

from ..sim.keyboard import END, SENT, KeyReader
from ..sim.simulation import NEVER
from ..sim.strand import running_strand

if TYPE_CHECKING:
    from ..sim.process import Process

Settings = list[Any]
"""A terminal's settings as termios has them: six numbers, and a list of characters."""

FLAGS = {
    "IGNBRK": 0x1, "BRKINT": 0x2, "IGNPAR": 0x4, "PARMRK": 0x8, "INPCK": 0x10, "ISTRIP": 0x20, "INLCR": 0x40, "IGNCR": 0x80,
    "ICRNL": 0x100, "IXON": 0x400, "IXANY": 0x800, "IXOFF": 0x1000, "OPOST": 0x1, "ONLCR": 0x4, "CSIZE": 0x30, "CS8": 0x30,
    "CREAD": 0x80, "PARENB": 0x100, "ISIG": 0x1, "ICANON": 0x2, "ECHO": 0x8, "ECHOE": 0x10, "ECHOK": 0x20, "ECHONL": 0x40,
    "NOFLSH": 0x80, "TOSTOP": 0x100, "IEXTEN": 0x8000, "VINTR": 0, "VQUIT": 1, "VERASE": 2, "VEOF": 4, "VTIME": 5, "VMIN": 6,
    "TCSANOW": 0, "TCSADRAIN": 1, "TCSAFLUSH": 2, "TCIFLUSH": 0, "TCOFLUSH": 1, "TCIOFLUSH": 2, "B9600": 13, "B38400": 15,
}  # fmt: skip
IFLAG, LFLAG, CC = 0, 3, 6
"""The places of input flags, local flags and characters in the settings."""


class ProgramInput(KeyReader, TextIOBase):
    """The standard input of a program: its terminal, unless the process has a file or pipe for it.

    Attributes:
        settings: the terminal's settings; `apply` changes them.
        raw: whether it reads keys instead of lines.
        signals: whether Ctrl-C interrupts the program; else it is a key like any other.
        returns: whether the enter key gives "\\r" instead of "\\n".
        patience: how long it waits for a key, in s; None: until there is one.
        typed: characters that were typed and not read.
    """

    has_terminal = True
    name = "<stdin>"
    encoding = "utf-8"

    def __init__(self, process: Process) -> None:
        super().__init__(process)
        # as Linux begins: ICRNL and IXON; OPOST and ONLCR; CS8 and CREAD; ISIG, ICANON, ECHO, ECHOE, ECHOK and IEXTEN
        characters = [b"\x03", b"\x1c", b"\x7f", b"\x00", b"\x04", b"\x00", b"\x01", *[b"\x00"] * 25]
        self.settings: Settings = [0x500, 0x5, 0xB0, 0x803B, 15, 15, characters]
        self.raw = False
        self.signals = True
        self.returns = False
        self.patience: float | None = None
        self.typed = ""

    def hear(self, name: str, down: bool) -> None:
        """A key was pressed: Ctrl-C interrupts, all others are characters. A terminal knows of no key that is let go of."""
        if down and name == "ctrl+c" and self.signals:
            self.process.send_signal(signal.SIGINT)
        elif down:
            self.typed += "\r" if self.returns and name == "enter" else SENT.get(name, name)
            self.notify()

    def ask(self, prompt: object = "", /) -> str:
        """What `input(prompt)` gives: the next line. Raises EOFError if there is none."""
        source = self.process.stdin
        if source is None:
            return self.process.simulation.keyboard.line(self.process, str(prompt))
        print(prompt, end="", file=self.process.stdout or sys.stdout, flush=True)
        line = source.readline()
        if not line:
            error = EOFError(END)
            error.add_note("The program asked for another line after it had read all of its input.")
            raise error
        return line.removesuffix("\n")

    def isatty(self) -> bool:
        """Whether it is a keyboard."""
        return self.process.stdin is None

    def fileno(self) -> int:
        """0, as everywhere."""
        return 0

    def readline(self, size: int | None = -1, /) -> str:  # type: ignore[override]
        """The next line with its line end; nothing at the end of the input."""
        while "\n" not in self.typed and self._read_more():
            pass
        end = self.typed.find("\n") + 1 or len(self.typed)
        return self.take(end if size is None or size < 0 else min(end, size))

    def read(self, size: int | None = -1, /) -> str:
        """All that comes until the end of the input, or so many characters."""
        wanted = NEVER if size is None or size < 0 else size
        while len(self.typed) < wanted and self._read_more():
            pass
        return self.take(wanted)

    def is_ready(self, seconds: float | None) -> bool:
        """Whether something can be read, now or within `seconds` of robot time; None: wait for it."""
        simulation = self.process.simulation
        end = None if seconds is None else simulation.now + round(seconds * 1e9)
        while self.isatty():
            if self.typed if self.raw else "\n" in self.typed or simulation.keyboard.lines:
                return True
            if not self.wait(None if end is None else max(0, end - simulation.now) / 1e9):
                return False
        return True

    def _read_more(self) -> bool:
        """Read one more line, or wait for a key; whether there is one."""
        if self.raw and self.isatty():
            return self.wait(self.patience)
        try:
            self.typed += self.ask() + "\n"
        except EOFError:
            return False
        return True

    def take(self, count: int) -> str:
        """So many characters at most, of those that were typed."""
        taken, self.typed = self.typed[:count], self.typed[count:]
        return taken

    def apply(self, settings: Settings) -> None:
        """Have these settings count from now on."""
        self.settings = deepcopy(settings)
        flags, characters = settings[LFLAG], settings[CC]
        self.raw = not flags & FLAGS["ICANON"]
        self.signals = bool(flags & FLAGS["ISIG"])
        self.returns = not settings[IFLAG] & FLAGS["ICRNL"]
        tenths, least = (ord(each) if isinstance(each, bytes) else each for each in characters[FLAGS["VTIME"] :][:2])
        self.patience = tenths / 10 if self.raw and not least else None
        if self.raw:
            self.process.simulation.keyboard.reads_keys(self)


# -- the modules -------------------------------------------------------------------------------------------------------


def terminal_of(file: object) -> ProgramInput | None:
    """The running program's terminal, if a file, or its number, is one; None for any other file."""
    strand = running_strand()
    if strand is None or strand.process.modules is None:
        return None
    terminal: ProgramInput = strand.process.modules.stdin
    return terminal if file in (0, 1, 2, terminal, strand.process.stdout, strand.process.stderr) else None


class error(Exception):
    """What a terminal cannot do."""

    __module__ = "termios"


def _terminal(file: object) -> ProgramInput:
    found = terminal_of(file)
    if found is None or not found.isatty():
        raise error(errno.ENOTTY, os.strerror(errno.ENOTTY))
    return found


def tcgetattr(fd: object, /) -> Settings:
    """A terminal's settings."""
    return deepcopy(_terminal(fd).settings)


def tcsetattr(fd: object, when: int, attributes: Settings, /) -> None:
    """Change a terminal's settings."""
    terminal = _terminal(fd)
    if when == FLAGS["TCSAFLUSH"]:
        terminal.typed = ""
    terminal.apply(attributes)


def tcflush(fd: object, queue: int, /) -> None:
    """Forget what was typed and not read."""
    if queue != FLAGS["TCOFLUSH"]:
        _terminal(fd).typed = ""


def select(
    rlist: Iterable[Any], wlist: Iterable[Any], xlist: Iterable[Any], timeout: float | None = None, /
) -> tuple[list[Any], list[Any], list[Any]]:
    """Which files can be read or written, now or within `timeout` s; beside a terminal no other file is looked at."""
    readers = list(rlist)
    for file in readers:
        if (terminal := terminal_of(file)) is not None:
            return [file] if terminal.is_ready(timeout) else [], [], []
    return real_select.select(readers, wlist, xlist, timeout)


def make_modules() -> list[ModuleType]:
    """`termios`, `tty`, `select`, and `fcntl`, or on Windows `msvcrt`: by its absence programs know that they are elsewhere."""
    termios = _module("termios", {**FLAGS, "error": error}, tcgetattr, tcsetattr, tcflush)
    there = [termios, make_tty(termios), _module("select", vars(real_select), select)]
    return [*there, make_msvcrt() if os.name == "nt" else make_fcntl()]


def make_msvcrt() -> ModuleType:
    """`msvcrt`, by which programs on Windows read keys, as characters or as bytes, and see whether one was pressed."""

    def terminal() -> ProgramInput:
        found = _terminal(0)
        found.raw, found.signals, found.returns = True, False, True
        return found

    characters = dict.fromkeys(("getwch", "getwche"), lambda: terminal().read(1))
    in_bytes = dict.fromkeys(("getch", "getche"), lambda: terminal().read(1).encode())
    return _module("msvcrt", {**characters, **in_bytes, "kbhit": lambda: terminal().is_ready(0.0)})


def make_tty(termios: ModuleType) -> ModuleType:
    """`tty`: Python's own, which is written in Python, on this `termios`."""
    tty, spec = ModuleType("tty"), find_spec("tty")
    assert spec is not None
    loader: Any = spec.loader
    tty.__dict__["__builtins__"] = {**vars(builtins), "__import__": lambda *_: termios}
    exec(loader.get_code("tty"), tty.__dict__)
    return tty


def make_fcntl() -> ModuleType:
    """`fcntl`, by which a program has its terminal not wait for keys (O_NONBLOCK)."""
    import fcntl as real

    def fcntl(fd: Any, cmd: int, arg: Any = 0, /) -> Any:
        """Ask or change what a file does."""
        terminal = terminal_of(fd)
        if terminal is None:
            return real.fcntl(fd, cmd, arg)
        if cmd == real.F_SETFL:
            terminal.patience = 0.0 if arg & os.O_NONBLOCK else None
        return 0

    return _module("fcntl", vars(real), fcntl)


def _module(name: str, names: dict[str, Any], *functions: Callable[..., Any]) -> ModuleType:
    module = ModuleType(name)
    module.__dict__.update({key: value for key, value in names.items() if not key.startswith("__")})
    module.__dict__.update({each.__name__: each for each in functions})
    return module


def read(real: Callable[[int, int], bytes], fd: int, n: int, /) -> bytes:
    """Read from a file descriptor. Returns a bytes object."""
    if fd != 0 or (terminal := terminal_of(0)) is None:
        return real(fd, n)
    return (terminal.read(1) + terminal.take(n - 1)).encode() if n else b""
