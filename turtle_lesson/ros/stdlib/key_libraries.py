"""Libraries by which programs read keys, `curses` and `pynput.keyboard`, as such programs see them: in robot time.

The keys are those pressed in the notebook; of a curses screen the lines that change are printed. Names and behaviour:
https://docs.python.org/3/library/curses.html and https://pynput.readthedocs.io/en/latest/keyboard.html.
"""

from __future__ import annotations

import enum
import sys
import threading
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from types import ModuleType

from .. import hooks
from ..sim.keyboard import SENT, KeyReader
from .terminals import ProgramInput, terminal_of

# -- curses ------------------------------------------------------------------------------------------------------------

LINES = 24
"""The height of the screen."""

ARROWS = {"down": 258, "up": 259, "left": 260, "right": 261}
"""The numbers of the arrow keys."""


class error(Exception):
    """What curses cannot do."""

    __module__ = "curses"


class Window:
    """The screen of a program, and the keys that it reads."""

    def __init__(self, terminal: ProgramInput) -> None:
        self._terminal = terminal
        self._lines: dict[int, str] = {}
        self._shown: dict[int, str] = {}
        self._place = (0, 0)
        self._patience: float | None = None

    def keypad(self, flag: bool) -> None:
        """Does nothing: an arrow key always comes as one number, such as KEY_UP."""

    def nodelay(self, flag: bool) -> None:
        """Whether `getch` does not wait for a key."""
        self.timeout(0 if flag else -1)

    def timeout(self, delay: int) -> None:
        """How long `getch` waits for a key, in ms; a negative number: until there is one."""
        self._patience = delay / 1000 if delay >= 0 else None

    def getch(self) -> int:
        """The number of the next key; -1 if none is pressed in time."""
        self.refresh()
        if not self._terminal.is_ready(self._patience):
            return -1
        for name, number in ARROWS.items():
            if self._terminal.typed.startswith(SENT[name]):
                self._terminal.take(len(SENT[name]))
                return number
        return ord(self._terminal.read(1))

    def addstr(self, *arguments: int | str) -> None:
        """Write a text: `addstr([y, x,] text[, attribute])`. An attribute has no effect here."""
        *place, text = arguments if len(arguments) % 2 else arguments[:-1]
        if not isinstance(text, str):
            raise TypeError(f"expect bytes or str, got {type(text).__name__}")  # Python's words
        y, x = (int(each) for each in place or self._place)
        for number, line in enumerate(text.split("\n")):
            y, x = (y + 1, 0) if number else (y, x)
            if not 0 <= y < LINES or x < 0:
                raise error("addwstr() returned ERR")
            before = self._lines.get(y, "").ljust(x)
            self._lines[y] = before[:x] + line + before[x + len(line) :]
            self._place = (y, x + len(line))

    def clear(self) -> None:
        """Take all text away."""
        self._lines = {}
        self._place = (0, 0)

    erase = clear

    def refresh(self) -> None:
        """Show the text: the lines that have changed are printed."""
        for y, line in sorted(self._lines.items()):
            if line.strip() and line.rstrip() != self._shown.get(y, "").rstrip():
                print(line.rstrip(), file=self._terminal.process.stdout or sys.stdout)
        self._shown = dict(self._lines)

    def __getattr__(self, name: str) -> object:
        return _lacking_in_curses(f"window.{name}")


def _lacking(library: str, has: str, error: type[Exception], name: str) -> object:
    """Refuse what a library has, and not here."""
    if name.startswith("__"):
        raise AttributeError(name)
    raise error(f"{library}.{name} is not available here: of {library} a program has {has}")


_lacking_in_curses = partial(_lacking, "curses", "the keys and plain text of one screen", AttributeError)
_lacking_in_pynput = partial(_lacking, "pynput", "keyboard.Listener, Key and KeyCode", ImportError)


def initscr() -> Window:
    """The whole screen. From now on the program gets each key at once."""
    terminal = terminal_of(0)
    if terminal is None or not terminal.isatty():
        raise error("curses needs a terminal, and the input of this program is a file or a pipe")
    terminal.raw = True
    terminal.process.simulation.keyboard.reads_keys(terminal)
    return Window(terminal)


def endwin() -> None:
    """End curses: the terminal is again as it was set before."""
    if (terminal := terminal_of(0)) is not None:
        terminal.apply(terminal.settings)


def wrapper(function: Callable[..., object], /, *arguments: object, **options: object) -> object:
    """Call a function with the screen, and end curses after it."""
    screen = initscr()
    try:
        return function(screen, *arguments, **options)
    finally:
        endwin()


def make_curses() -> ModuleType:
    """`curses`, as far as simple programs use it. Keys are never echoed, and no cursor is shown."""
    curses = ModuleType("curses")
    curses.__dict__.update(
        {f"KEY_{name.upper()}": number for name, number in ARROWS.items()},
        **dict.fromkeys(("cbreak", "nocbreak", "echo", "noecho", "curs_set"), lambda *_: None),
        **{"error": error, "window": Window, "initscr": initscr, "endwin": endwin, "wrapper": wrapper},
        __getattr__=_lacking_in_curses,
    )
    return curses


# -- pynput ------------------------------------------------------------------------------------------------------------


@dataclass(frozen=True, repr=False)
class KeyCode:
    """A key that gives a character."""

    char: str | None = None

    @classmethod
    def from_char(cls, char: str) -> KeyCode:
        """The key of a character."""
        return cls(char)

    def __repr__(self) -> str:
        return repr(self.char)


_SIDES = ("alt_l", "alt_r", "alt_gr", "cmd_l", "cmd_r", "ctrl_l", "ctrl_r", "shift_l", "shift_r")
_NAMES = [name for name in (*SENT, *_SIDES) if "+" not in name]
Key = enum.Enum("Key", {name: (name, SENT.get(name, "")) for name in _NAMES}, module="pynput.keyboard")  # type: ignore[misc]
"""The keys that have a name."""

Callback = Callable[[KeyCode | Key], object]


class Listener(threading.Thread):
    """A thread that calls functions as keys are pressed and let go of, until one of them returns False.

    They get a `KeyCode`, or a `Key` for those with a name. Options such as `suppress` have no effect here.
    """

    def __init__(self, on_press: Callback | None = None, on_release: Callback | None = None, **options: object) -> None:
        super().__init__(daemon=True)
        self._callbacks = {True: on_press, False: on_release}
        self._reader = KeyReader(hooks.current_process())

    def run(self) -> None:
        """Listen until it is stopped."""
        reader = self._reader
        while not reader.stopped:
            if not reader.events:
                reader.wait()
                continue
            name, down = reader.events.popleft()
            callback = self._callbacks[down]
            key = Key[name] if name in SENT else KeyCode.from_char(name)
            if callback is not None and callback(key) is False:
                self.stop()

    def stop(self) -> None:
        """End it. It cannot be started once more."""
        self._reader.stopped = True
        self._reader.notify()

    @property
    def running(self) -> bool:
        """Whether it listens."""
        return self.is_alive() and not self._reader.stopped

    def __enter__(self) -> Listener:
        self.start()
        return self

    def __exit__(self, *error: object) -> None:
        self.stop()


def make_pynput() -> ModuleType:
    """`pynput`, with `keyboard` in it."""
    pynput, keyboard = ModuleType("pynput"), ModuleType("pynput.keyboard")
    keyboard.__dict__.update(Key=Key, KeyCode=KeyCode, Listener=Listener, __getattr__=_lacking_in_pynput)
    pynput.__dict__.update(keyboard=keyboard, __path__=[], __getattr__=_lacking_in_pynput)
    return pynput
