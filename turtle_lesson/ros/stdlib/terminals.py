"""A program's terminal: `sys.stdin` and `input()`, and the modules by which it reads keys, from `termios` to `msvcrt`.

A program reads whole lines. Once it turns its terminal's line mode off (termios, tty, curses) it reads keys: whatever is
pressed in the notebook, as soon as it is pressed. It waits in robot time.

The modules are those that a program's import statements get. For any other file they call the real ones. The flags are
Linux's, on every computer (`man 3 termios`; Python's documentation of termios, tty and msvcrt).
"""

from __future__ import annotations

import errno
import importlib
import os
import select as real_select
import signal
import sys
from collections.abc import Callable, Iterable
from io import TextIOBase
from types import ModuleType
from typing import TYPE_CHECKING, Any

from ..sim.keyboard import END, SENT, KeyReader
from ..sim.strand import running_strand

if TYPE_CHECKING:
    from ..sim.process import Process


class ProgramInput(TextIOBase):
    """The standard input of a program.

    Attributes:
        raw: whether it reads keys instead of lines.
        signals: whether Ctrl-C interrupts the program; else it is a key like any other.
        returns: whether the enter key gives "\\r" instead of "\\n".
        patience: how long it waits for a key, in s; None: until there is one.
        attributes: the terminal's settings, for termios; None: as they are at first.
        typed: characters that were typed and not read.
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
        self.typed = ""
        self._given = 0

    def ask(self, prompt: object = "", /) -> str:
        """What `input(prompt)` gives: the next line. Raises EOFError if there is none."""
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
        while "\n" not in self.typed and self._read_more():
            pass
        end = self.typed.find("\n") + 1 or len(self.typed)
        return self._take(end if size is None or size < 0 else min(end, size))

    def read(self, size: int | None = -1, /) -> str:
        """All that comes until the end of the input, or so many characters."""
        wanted = -1 if size is None else size
        while (wanted < 0 or len(self.typed) < wanted) and self._read_more():
            pass
        return self._take(len(self.typed) if wanted < 0 else wanted)

    def is_ready(self, seconds: float | None) -> bool:
        """Whether something can be read, now or within `seconds` of robot time; None: wait for it."""
        if self.typed or not self.isatty():
            return True
        simulation = self.process.simulation
        end = None if seconds is None else simulation.now + round(seconds * 1e9)
        while not (self.process.simulation.keyboard.lines and not self.raw):
            left = None if end is None else max(0.0, (end - simulation.now) / 1e9)
            if not self.keys.wait(left):
                return False
            self._take_keys()
            if self.typed and (self.raw or "\n" in self.typed):
                return True
        return True

    def read_there(self, size: int) -> str:
        """So many characters at most, of those that are there without waiting."""
        if self.isatty():
            self._take_keys()
            return self._take(min(size, len(self.typed)))
        return self.read(size)

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
            there = self.keys.wait(self.patience)
            self._take_keys()
            return there
        try:
            self.typed += self._next("") + "\n"
        except EOFError:
            return False
        return True

    def _take_keys(self) -> None:
        while self.keys.events:
            name, _ = self.keys.events.popleft()
            if not self._interrupts(name):
                self.typed += "\r" if self.returns and name == "enter" else SENT.get(name, name)

    def _interrupts(self, name: str) -> bool:
        """Whether a key is Ctrl-C, and the terminal interrupts the program with it."""
        if name != "ctrl+c" or not self.signals:
            return False
        self.process.send_signal(signal.SIGINT)
        return True

    def _take(self, count: int) -> str:
        taken, self.typed = self.typed[:count], self.typed[count:]
        return taken

    def flush_keys(self) -> None:
        """Forget what was pressed and not read."""
        self.typed = ""
        self.keys.events.clear()


# -- the modules -------------------------------------------------------------------------------------------------------

FLAGS = {
    "BRKINT": 0x2, "INPCK": 0x10, "ISTRIP": 0x20, "ICRNL": 0x100, "IXON": 0x400, "OPOST": 0x1, "ONLCR": 0x4, "CSIZE": 0x30,
    "CS8": 0x30, "CREAD": 0x80, "PARENB": 0x100, "ISIG": 0x1, "ICANON": 0x2, "ECHO": 0x8, "ECHOE": 0x10, "ECHOK": 0x20,
    "ECHONL": 0x40, "NOFLSH": 0x80, "IEXTEN": 0x8000, "VINTR": 0, "VQUIT": 1, "VERASE": 2, "VEOF": 4, "VTIME": 5, "VMIN": 6,
    "TCSANOW": 0, "TCSADRAIN": 1, "TCSAFLUSH": 2, "TCIFLUSH": 0, "TCOFLUSH": 1, "TCIOFLUSH": 2, "B9600": 13, "B38400": 15,
    "NCCS": 32, "TIOCGWINSZ": 0x5413, "FIONREAD": 0x541B,
}  # fmt: skip
PLACES = {"IFLAG": 0, "OFLAG": 1, "CFLAG": 2, "LFLAG": 3, "ISPEED": 4, "OSPEED": 5, "CC": 6}
"""The places of the settings in a terminal's list of them."""
IFLAG, OFLAG, _, LFLAG, _, _, CC = PLACES.values()


def settings(*names: str) -> int:
    """Several flags as one number."""
    return sum(FLAGS[name] for name in names)


RAW_IN = settings("BRKINT", "ICRNL", "INPCK", "ISTRIP", "IXON")


def terminal_of(file: Any) -> ProgramInput | None:
    """The running program's terminal, if a file, or its number, is one; None for any other file."""
    if isinstance(file, ProgramInput):
        return file
    strand = running_strand()
    modules = None if strand is None else strand.process.modules
    if strand is None or modules is None:
        return None
    if isinstance(file, int):
        return modules.stdin if 0 <= file <= 2 else None
    return modules.stdin if file in (strand.process.stdout, strand.process.stderr) else None


def make_modules() -> list[ModuleType]:
    """`termios`, `tty`, `select`, `fcntl`, and on Windows `msvcrt`, by whose absence programs know that they are elsewhere."""
    termios = make_termios()
    return [termios, make_tty(termios), make_select(), make_fcntl(), *([make_msvcrt()] if os.name == "nt" else ())]


def make_termios() -> ModuleType:
    """`termios`, with the flags that programs use."""

    error = type("error", (Exception,), {"__module__": "termios"})

    def terminal(file: Any) -> ProgramInput:
        found = terminal_of(file)
        if found is None or not found.isatty():
            raise error(errno.ENOTTY, os.strerror(errno.ENOTTY))
        return found

    def tcgetattr(fd: Any) -> list[Any]:
        """A terminal's settings."""
        return _copy(terminal(fd).attributes or _at_first())

    def tcsetattr(fd: Any, when: int, attributes: list[Any]) -> None:
        """Change a terminal's settings."""
        if not isinstance(attributes, list) or len(attributes) != 7:
            raise TypeError("tcsetattr, arg 3: must be 7 element list")
        found = terminal(fd)
        if when == FLAGS["TCSAFLUSH"]:
            found.flush_keys()
        _apply(found, attributes)

    def tcflush(fd: Any, queue: int) -> None:
        """Forget what was typed and not read."""
        if queue != FLAGS["TCOFLUSH"]:
            terminal(fd).flush_keys()

    def tcdrain(fd: Any) -> None:
        """Wait until all is written, which it is."""
        terminal(fd)

    return _module("termios", {**FLAGS, "error": error}, tcgetattr, tcsetattr, tcflush, tcdrain)


def _at_first() -> list[Any]:
    lines = settings("ISIG", "ICANON", "ECHO", "ECHOE", "ECHOK", "IEXTEN")
    signs: list[Any] = [b"\x00"] * FLAGS["NCCS"]
    signs[:3] = b"\x03", b"\x1c", b"\x7f"
    signs[FLAGS["VEOF"]], signs[FLAGS["VMIN"]] = b"\x04", b"\x01"
    return [settings("ICRNL", "IXON"), settings("OPOST", "ONLCR"), settings("CS8", "CREAD"), lines, 15, 15, signs]


def _copy(attributes: list[Any]) -> list[Any]:
    return [*attributes[:CC], list(attributes[CC])]


def _apply(terminal: ProgramInput, attributes: list[Any]) -> None:
    """Have a terminal's settings count."""
    terminal.attributes = _copy(attributes)
    flags, signs = attributes[LFLAG], attributes[CC]
    terminal.raw = not flags & FLAGS["ICANON"]
    terminal.signals = bool(flags & FLAGS["ISIG"])
    terminal.returns = not attributes[IFLAG] & FLAGS["ICRNL"]
    least = signs[FLAGS["VMIN"]]
    tenths = signs[FLAGS["VTIME"]]
    no_least = least in (0, b"\x00")
    terminal.patience = (tenths if isinstance(tenths, int) else tenths[0]) / 10 if terminal.raw and no_least else None
    if terminal.raw:
        terminal.process.simulation.keyboard.reads_keys(terminal.keys)


def make_tty(termios: ModuleType) -> ModuleType:
    """`tty`: the two modes in which a terminal gives keys."""

    def change(fd: Any, when: int, lines: int, raw: bool) -> list[Any]:
        before = termios.tcgetattr(fd)
        mode = _copy(before)
        mode[LFLAG] &= ~lines
        if raw:
            mode[IFLAG] &= ~RAW_IN
            mode[OFLAG] &= ~FLAGS["OPOST"]
        mode[CC][FLAGS["VMIN"]], mode[CC][FLAGS["VTIME"]] = 1, 0
        termios.tcsetattr(fd, when, mode)
        return before

    def setraw(fd: Any, when: int = FLAGS["TCSAFLUSH"]) -> list[Any]:
        """Give every key, Ctrl-C too. Returns the settings before."""
        return change(fd, when, settings("ECHO", "ICANON", "IEXTEN", "ISIG"), True)

    def setcbreak(fd: Any, when: int = FLAGS["TCSAFLUSH"]) -> list[Any]:
        """Give every key but Ctrl-C, which interrupts. Returns the settings before."""
        return change(fd, when, settings("ECHO", "ICANON"), False)

    return _module("tty", {**vars(termios), **PLACES}, setraw, setcbreak)


def make_select() -> ModuleType:
    """`select`, whose `select` waits for keys in robot time."""

    def select(rlist: Iterable[Any], wlist: Iterable[Any], xlist: Iterable[Any], timeout: float | None = None) -> Any:
        """Which files can be read or written, now or within `timeout` s."""
        readers = list(rlist)
        own = [file for file in readers if terminal_of(file) is not None]
        terminal = terminal_of(own[0]) if own else None
        if terminal is None:
            return real_select.select(readers, wlist, xlist, timeout)
        rest = [file for file in readers if file not in own]
        found = real_select.select(rest, wlist, xlist, 0)
        if any(found):
            timeout = 0
        return (own if terminal.is_ready(timeout) else []) + found[0], found[1], found[2]

    return _module("select", vars(real_select), select)


def make_fcntl() -> ModuleType:
    """`fcntl`, by which a program has its terminal not wait for keys (O_NONBLOCK)."""
    flags = {"F_GETFL": 3, "F_SETFL": 4, "F_GETFD": 1, "F_SETFD": 2}
    try:
        real: Any = importlib.import_module("fcntl")
    except ImportError:  # Windows has none
        real = ModuleType("fcntl")
    not_waiting = getattr(os, "O_NONBLOCK", 0x800)
    names = {**flags, **vars(real)}

    def fcntl(fd: Any, cmd: int, arg: Any = 0) -> Any:
        """Ask or change what a file does."""
        terminal = terminal_of(fd)
        if terminal is None:
            return real.fcntl(fd, cmd, arg)
        if cmd == names["F_SETFL"]:
            terminal.patience = 0.0 if arg & not_waiting else None
            return 0
        return not_waiting if cmd == names["F_GETFL"] and terminal.patience == 0.0 else 0

    return _module("fcntl", names, fcntl)


def make_msvcrt() -> ModuleType:
    """`msvcrt`, by which programs read keys on Windows."""

    def keys() -> ProgramInput:
        terminal = terminal_of(0)
        assert terminal is not None
        terminal.raw, terminal.signals, terminal.returns = True, False, True
        return terminal

    def kbhit() -> bool:
        """Whether a key was pressed."""
        return keys().is_ready(0.0)

    def getwch() -> str:
        """The next key's character."""
        return keys().read(1)

    def getch() -> bytes:
        """The next key's character, as bytes."""
        return getwch().encode()

    return _module("msvcrt", {"getche": getch, "getwche": getwch}, kbhit, getch, getwch)


def _module(name: str, names: dict[str, Any], *functions: Callable[..., Any]) -> ModuleType:
    module = ModuleType(name)
    module.__dict__.update({key: value for key, value in names.items() if not key.startswith("__")})
    for each in functions:
        each.__module__ = name
        module.__dict__[each.__name__] = each
    return module


def read(real: Callable[[int, int], bytes], fd: int, n: int, /) -> bytes:
    """Read from a file descriptor. Returns a bytes object."""
    if fd != 0 or (terminal := terminal_of(0)) is None:
        return real(fd, n)
    return (terminal.read(1) + terminal.read_there(n - 1)).encode() if n else b""
