"""What a program asks of its terminal to read keys: `termios`, `tty`, `select`, `fcntl`, `msvcrt` and `os.read`.

The modules are those that a program's import statements get. For `sys.stdin` they work on the program's own terminal, whose
keys are pressed in the notebook, and they wait in robot time; all else they leave to the real ones. The flags are Linux's,
on every computer (`man 3 termios`; Python's documentation of termios, tty and msvcrt).
"""

from __future__ import annotations

import errno
import importlib
import os
import select as real_select
from collections.abc import Callable, Iterable
from types import ModuleType
from typing import Any

from greenlet import getcurrent

from ..sim.strand import Strand
from .program_input import ProgramInput

FLAGS = {
    "BRKINT": 0x2, "INPCK": 0x10, "ISTRIP": 0x20, "ICRNL": 0x100, "IXON": 0x400, "OPOST": 0x1, "ONLCR": 0x4, "CSIZE": 0x30,
    "CS8": 0x30, "CREAD": 0x80, "PARENB": 0x100, "ISIG": 0x1, "ICANON": 0x2, "ECHO": 0x8, "ECHOE": 0x10, "ECHOK": 0x20,
    "ECHONL": 0x40, "NOFLSH": 0x80, "IEXTEN": 0x8000, "VINTR": 0, "VQUIT": 1, "VERASE": 2, "VEOF": 4, "VTIME": 5, "VMIN": 6,
    "TCSANOW": 0, "TCSADRAIN": 1, "TCSAFLUSH": 2, "TCIFLUSH": 0, "TCOFLUSH": 1, "TCIOFLUSH": 2, "B9600": 13, "B38400": 15,
    "NCCS": 32, "TIOCGWINSZ": 0x5413, "FIONREAD": 0x541B,
}  # fmt: skip
IFLAG, OFLAG, CFLAG, LFLAG, ISPEED, OSPEED, CC = range(7)
"""The places of the settings in a terminal's list of them."""


def settings(*names: str) -> int:
    """Several flags as one number."""
    return sum(FLAGS[name] for name in names)


RAW_IN = settings("BRKINT", "ICRNL", "INPCK", "ISTRIP", "IXON")


def terminal_of(file: Any) -> ProgramInput | None:
    """The running program's terminal, if a file, or its number, is one; None for any other file."""
    if isinstance(file, ProgramInput):
        return file
    strand = getcurrent()
    modules = strand.process.modules if type(strand) is Strand else None
    if modules is None:
        return None
    if isinstance(file, int):
        return modules.stdin if 0 <= file <= 2 else None
    return modules.stdin if file in (strand.process.stdout, strand.process.stderr) else None


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

    return _module("termios", FLAGS, error=error, **_named(tcgetattr, tcsetattr, tcflush, tcdrain))


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

    places = {
        "IFLAG": IFLAG,
        "OFLAG": OFLAG,
        "CFLAG": CFLAG,
        "LFLAG": LFLAG,
        "ISPEED": ISPEED,
        "OSPEED": OSPEED,
        "CC": CC,
    }
    return _module("tty", {**vars(termios), **places}, **_named(setraw, setcbreak))


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

    return _module("select", vars(real_select), select=select)


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

    return _module("fcntl", names, fcntl=fcntl)


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

    return _module("msvcrt", {}, **_named(kbhit, getch, getwch), getche=getch, getwche=getwch)


def read(real: Callable[[int, int], bytes], fd: int, n: int, /) -> bytes:
    """Read from a file descriptor. Returns a bytes object."""
    if fd != 0 or type(getcurrent()) is not Strand or (terminal := terminal_of(0)) is None:
        return real(fd, n)
    return (terminal.read(1) + terminal.read_there(n - 1)).encode() if n else b""


def _module(name: str, names: dict[str, Any], **functions: Any) -> ModuleType:
    module = ModuleType(name)
    own = {key: value for key, value in names.items() if not key.startswith("__")}
    module.__dict__.update({**own, **functions})
    for each in functions.values():
        each.__module__ = name
    return module


def _named(*functions: Callable[..., Any]) -> dict[str, Callable[..., Any]]:
    return {function.__name__: function for function in functions}
