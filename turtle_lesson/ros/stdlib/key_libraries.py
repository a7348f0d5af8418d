"""Libraries by which programs read keys, `curses` and `pynput.keyboard`, as such programs see them: in robot time.

The keys are those pressed in the notebook; of a curses screen the lines that change are printed. Names and behaviour:
https://docs.python.org/3/library/curses.html and https://pynput.readthedocs.io/en/latest/keyboard.html.
"""

from __future__ import annotations

import enum
import sys
import threading
import time
from collections.abc import Callable
from types import ModuleType
from typing import Any

from ..sim.keyboard import SENT, KeyReader
from ..sim.strand import running_strand
from .terminals import ProgramInput, terminal_of

# -- curses ------------------------------------------------------------------------------------------------------------

LINES, COLUMNS = 24, 80

KEYS = {
    "KEY_DOWN": 258, "KEY_UP": 259, "KEY_LEFT": 260, "KEY_RIGHT": 261, "KEY_HOME": 262, "KEY_BACKSPACE": 263, "KEY_DC": 330,
    "KEY_IC": 331, "KEY_NPAGE": 338, "KEY_PPAGE": 339, "KEY_ENTER": 343, "KEY_END": 360, "KEY_MOUSE": 409, "KEY_RESIZE": 410,
    "KEY_F0": 264, **{f"KEY_F{number}": 264 + number for number in range(1, 13)},
}  # fmt: skip
_NAMED = {
    "down": "KEY_DOWN", "up": "KEY_UP", "left": "KEY_LEFT", "right": "KEY_RIGHT", "home": "KEY_HOME", "end": "KEY_END",
    "backspace": "KEY_BACKSPACE", "delete": "KEY_DC", "insert": "KEY_IC", "page_down": "KEY_NPAGE", "page_up": "KEY_PPAGE",
    **{f"f{number}": f"KEY_F{number}" for number in range(1, 13)},
}  # fmt: skip
_LOOKS = ("NORMAL", "BOLD", "DIM", "REVERSE", "STANDOUT", "UNDERLINE", "BLINK", "ITALIC", "INVIS")
_COLOURS = ("BLACK", "RED", "GREEN", "YELLOW", "BLUE", "MAGENTA", "CYAN", "WHITE")


class error(Exception):
    """What curses cannot do."""


class Window:
    """A part of the screen, or all of it. How long it waits for a key is a matter of each window."""

    def __init__(self, terminal: ProgramInput, lines: int = LINES, columns: int = COLUMNS) -> None:
        self._terminal = terminal
        self._size = (lines or LINES, columns or COLUMNS)
        self._text = [""] * self._size[0]
        self._shown = list(self._text)
        self._place = (0, 0)
        self._patience: float | None = None
        self._keypad = False

    def nodelay(self, flag: bool) -> None:
        """Whether not to wait for a key."""
        self._patience = 0.0 if flag else None

    def timeout(self, delay: int) -> None:
        """Wait for a key for so many ms; a negative number: as long as it takes."""
        self._patience = delay / 1000 if delay >= 0 else None

    def keypad(self, flag: bool) -> None:
        """Whether arrow keys and their kin come as one number each."""
        self._keypad = bool(flag)

    def getch(self, *place: int) -> int:
        """The number of the next key, -1 if none is pressed in time."""
        key = self._next()
        return -1 if key is None else ord(key) if len(key) == 1 else KEYS[key]

    def getkey(self, *place: int) -> str:
        """The next key: a character, or a name such as "KEY_UP". `curses.error` if none is pressed in time."""
        key = self._next()
        if key is None:
            raise error("no input")
        return key

    def get_wch(self, *place: int) -> str | int:
        """The next key: a character, or the number of a key with a name. `curses.error` if none is pressed in time."""
        key = self.getkey()
        return KEYS.get(key, key)

    def getstr(self, *place: Any) -> bytes:
        """A line of characters, up to the enter key."""
        typed = ""
        while (key := self._next()) not in (None, "\n"):
            typed += key if key is not None and len(key) == 1 else ""
        return typed.encode()

    def _next(self) -> str | None:
        """The next key as `getkey` has it."""
        self.refresh()
        if self._terminal.typed:
            return self._terminal.read_there(1)
        name = self._terminal.next_key(self._patience)
        if name is None:
            return None
        if name in _NAMED and self._keypad:
            return _NAMED[name]
        text = SENT.get(name, name)
        self._terminal.typed = text[1:] + self._terminal.typed
        return text[0]

    def addstr(self, *arguments: Any) -> None:
        """Write a text: `addstr([y, x,] text[, attribute])`."""
        if len(arguments) > 2:
            self.move(arguments[0], arguments[1])
            arguments = arguments[2:]
        text = arguments[0]
        for number, line in enumerate((text.decode() if isinstance(text, bytes) else str(text)).split("\n")):
            if number:
                self.move(self._place[0] + 1, 0)
            self._write(line)

    def addch(self, *arguments: Any) -> None:
        """Write one character: `addch([y, x,] character[, attribute])`."""
        at = 2 if len(arguments) > 2 else 0
        character = arguments[at]
        self.addstr(*arguments[:at], chr(character & 0x1FFFFF) if isinstance(character, int) else character)

    def _write(self, text: str) -> None:
        line, column = self._place
        before = self._text[line]
        self._text[line] = before[:column].ljust(column) + text + before[column + len(text) :]
        self._place = (line, column + len(text))

    def move(self, y: int, x: int) -> None:
        """Go to a line and column."""
        if not (0 <= y < self._size[0] and 0 <= x < self._size[1]):
            raise error("wmove() returned ERR")
        self._place = (y, x)

    def clear(self) -> None:
        """Take all text away."""
        self._text = [""] * self._size[0]
        self._place = (0, 0)

    erase = clear

    def clrtoeol(self) -> None:
        """Take the rest of the line away."""
        line, column = self._place
        self._text[line] = self._text[line][:column]

    def refresh(self, *place: int) -> None:
        """Show the text: the lines that have changed are printed."""
        for before, now in zip(self._shown, self._text, strict=True):
            if now.strip() and now != before:
                print(now.rstrip(), file=self._terminal.process.stdout or sys.stdout)
        self._shown = list(self._text)

    def getmaxyx(self) -> tuple[int, int]:
        """Its lines and columns."""
        return self._size

    def getyx(self) -> tuple[int, int]:
        """Where it writes next."""
        return self._place

    def __getattr__(self, name: str) -> Any:
        if name in _NO_EFFECT:
            return _nothing
        raise AttributeError(f"the simulated curses window has no {name!r}: it has keys and text", name=name, obj=self)


_NO_EFFECT = frozenset((
    "attroff", "attron", "attrset", "bkgd", "bkgdset", "border", "box", "chgat", "clearok", "hline", "idlok", "immedok",
    "leaveok", "notimeout", "redrawwin", "scrollok", "setscrreg", "standend", "standout", "touchwin", "vline",
))  # fmt: skip
"""What only changes how a window looks."""


def _nothing(*arguments: Any, **options: Any) -> None:
    """Does nothing."""


def _begin() -> ProgramInput:
    """Turn line mode off in the terminal of the running program."""
    terminal = terminal_of(0)
    if terminal is None or not terminal.isatty():
        raise error("cannot open the terminal: curses needs a program whose input is no file or pipe")
    terminal.raw = True
    terminal.process.simulation.keyboard.reads_keys(terminal.keys)
    return terminal


def _changing(**attributes: bool) -> Callable[[], None]:
    """A function that changes how the terminal reads."""
    return lambda: vars(_begin()).update(attributes)


def initscr() -> Window:
    """Begin; the whole screen."""
    return Window(_begin())


_endwin = _changing(raw=False)


def wrapper(function: Callable[..., Any], /, *arguments: Any, **options: Any) -> Any:
    """Call a function with the screen, and end curses after it."""
    screen = initscr()
    screen.keypad(True)
    try:
        return function(screen, *arguments, **options)
    finally:
        _endwin()


def make_curses() -> ModuleType:
    """`curses`, as far as simple programs use it."""
    module = ModuleType("curses", "Keys and text of a simulated terminal.")
    quiet = (
        "noecho echo nocbreak noraw curs_set start_color use_default_colors init_pair init_color beep flash nl nonl "
        "def_prog_mode reset_prog_mode reset_shell_mode set_escdelay mousemask intrflush meta typeahead savetty resetty "
        "doupdate halfdelay"
    )
    module.__dict__.update(
        dict.fromkeys(quiet.split(), _nothing),
        **KEYS,
        **{f"A_{name}": 1 << number for number, name in enumerate(_LOOKS, 16)},
        **{f"COLOR_{name}": number for number, name in enumerate(_COLOURS)},
        **{"LINES": LINES, "COLS": COLUMNS, "COLORS": 8, "COLOR_PAIRS": 64, "ERR": -1, "OK": 0},
        error=error,
        window=Window,
        initscr=initscr,
        endwin=_endwin,
        wrapper=wrapper,
        newwin=lambda lines=LINES, columns=COLUMNS, *place: Window(_begin(), lines, columns),
        raw=_changing(signals=False),
        cbreak=_changing(signals=True),
        flushinp=lambda: _begin().flush_keys(),
        napms=lambda ms: time.sleep(ms / 1000),
        color_pair=lambda number: number << 8,
        has_colors=lambda: True,
        can_change_color=lambda: False,
        isendwin=lambda: False,
        __getattr__=_refusing(AttributeError, "the simulated curses has no {!r}: it has keys and text"),
        __path__=[],
    )
    for each in (error, Window):
        each.__module__ = "curses"
    return module


def _refusing(kind: type[AttributeError | ImportError], sentence: str) -> Callable[[str], Any]:
    """The `__getattr__` of a module that has no more than this."""

    def refuse(name: str) -> Any:
        if name.startswith("__"):
            raise AttributeError(name)
        raise kind(sentence.format(name), name=name)

    return refuse


# -- pynput ------------------------------------------------------------------------------------------------------------


class KeyCode:
    """A key that gives a character."""

    def __init__(self, vk: int | None = None, char: str | None = None, is_dead: bool = False) -> None:
        self.vk, self.char, self.is_dead = vk, char, is_dead

    @classmethod
    def from_char(cls, char: str, **details: Any) -> KeyCode:
        """The key of a character."""
        return cls(char=char, **details)

    @classmethod
    def from_vk(cls, vk: int, **details: Any) -> KeyCode:
        """The key with a number."""
        return cls(vk=vk, **details)

    def __repr__(self) -> str:
        return repr(self.char) if self.char is not None else f"<{self.vk}>"

    def __eq__(self, other: object) -> bool:
        return isinstance(other, KeyCode) and (self.char, self.vk) == (other.char, other.vk)

    def __hash__(self) -> int:
        return hash((self.char, self.vk))


_SIDES = ("alt_l", "alt_r", "alt_gr", "cmd_l", "cmd_r", "ctrl_l", "ctrl_r", "shift_l", "shift_r")
_NAMES = [name for name in (*SENT, *_SIDES) if "+" not in name]
Key = enum.Enum("Key", {name: (name, SENT.get(name, "")) for name in _NAMES}, module="pynput.keyboard")  # type: ignore[misc]
"""The keys that have a name."""

Callback = Callable[[Any], object]


class Listener(threading.Thread):
    """A thread that calls functions as keys are pressed and let go of, until one of them returns False.

    They get a `KeyCode`, or a `Key` for those with a name. Options such as `suppress` have no effect here.
    """

    def __init__(
        self,
        on_press: Callback | None = None,
        on_release: Callback | None = None,
        **options: Any,
    ) -> None:
        super().__init__(daemon=True)
        self._callbacks = {True: on_press, False: on_release}
        self._reader: KeyReader | None = None
        self._stopped = False

    def run(self) -> None:
        """Listen until it is stopped."""
        strand = running_strand()
        if strand is None:
            raise RuntimeError("a Listener hears keys in a program (ros2 run, python3 FILE) only, not in a cell")
        self._reader = reader = KeyReader(strand.process, has_terminal=False)
        while not self._stopped and reader.wait():
            name, down = reader.events.popleft()
            callback = self._callbacks[down]
            key = Key[name] if name in SENT else KeyCode.from_char(name)
            if callback is not None and callback(key) is False:
                self.stop()

    def stop(self) -> None:
        """End it. It cannot be started once more."""
        self._stopped = True
        if self._reader is not None:
            self._reader.closed = True
            self._reader.tell()

    @property
    def running(self) -> bool:
        """Whether it listens."""
        return self.is_alive() and not self._stopped

    def wait(self) -> None:
        """Wait until it listens, which it does as soon as it is started."""

    def canonical(self, key: Any) -> Any:
        """A key as it is without shift and its kin."""
        return KeyCode.from_char(key.char.lower()) if isinstance(key, KeyCode) and key.char else key

    def __enter__(self) -> Listener:
        self.start()
        return self

    def __exit__(self, *error: object) -> None:
        self.stop()


def make_pynput() -> ModuleType:
    """`pynput`, with `keyboard` in it."""
    lacking = "{}.{{}} is not available here: of pynput a program has keyboard.Listener, Key and KeyCode"
    pynput, keyboard = (ModuleType(name) for name in ("pynput", "pynput.keyboard"))
    for module in (pynput, keyboard):
        module.__dict__["__getattr__"] = _refusing(ImportError, lacking.format(module.__name__))
    keyboard.__dict__.update(Key=Key, KeyCode=KeyCode, Listener=Listener)
    pynput.__dict__.update(keyboard=keyboard, __path__=[])
    for each in (KeyCode, Listener):
        each.__module__ = "pynput.keyboard"
    return pynput
