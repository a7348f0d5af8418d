"""`curses` as programs see it: keys that are pressed in the notebook, and a screen whose changed lines are printed.

Names and behaviour: Python's documentation of curses (https://docs.python.org/3/library/curses.html).
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from types import ModuleType
from typing import Any

from ..sim.keyboard import SENT
from .program_input import ProgramInput
from .terminals import terminal_of

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

    # -- keys ----------------------------------------------------------------------------------------------------------

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
        if self._terminal.is_ready_text:
            return self._terminal.read_there(1)
        name = self._terminal.next_key(self._patience)
        if name is None:
            return None
        if name in _NAMED and self._keypad:
            return _NAMED[name]
        text = SENT.get(name, name)
        self._terminal.put_back(text[1:])
        return text[0]

    # -- text ----------------------------------------------------------------------------------------------------------

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

    def addnstr(self, *arguments: Any) -> None:
        """Write so many characters of a text at most: `addnstr([y, x,] text, n[, attribute])`."""
        at = 2 if isinstance(arguments[0], int) else 0
        self.addstr(*arguments[:at], arguments[at][: arguments[at + 1]])

    def addch(self, *arguments: Any) -> None:
        """Write one character: `addch([y, x,] character[, attribute])`."""
        at = 2 if len(arguments) > 2 else 0
        character = arguments[at]
        self.addstr(*arguments[:at], chr(character & 0x1FFFFF) if isinstance(character, int) else character)

    insstr = addstr

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

    def clrtobot(self) -> None:
        """Take all that follows away."""
        self.clrtoeol()
        for line in range(self._place[0] + 1, self._size[0]):
            self._text[line] = ""

    def refresh(self, *place: int) -> None:
        """Show the text: the lines that have changed are printed."""
        for before, now in zip(self._shown, self._text, strict=True):
            if now.strip() and now != before:
                print(now.rstrip(), file=self._terminal.process.stdout or sys.stdout)
        self._shown = list(self._text)

    noutrefresh = refresh

    def getmaxyx(self) -> tuple[int, int]:
        """Its lines and columns."""
        return self._size

    def getyx(self) -> tuple[int, int]:
        """Where it writes next."""
        return self._place

    def subwin(self, *places: int) -> Window:
        """A window of its own: `subwin([lines, columns,] y, x)`."""
        return Window(self._terminal, *places[:2]) if len(places) > 2 else Window(self._terminal)

    derwin = subwin

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


def initscr() -> Window:
    """Begin; the whole screen."""
    return Window(_begin())


def endwin() -> None:
    """The end: read lines again."""
    _begin().raw = False


def wrapper(function: Callable[..., Any], /, *arguments: Any, **options: Any) -> Any:
    """Call a function with the screen, and end curses after it."""
    screen = initscr()
    screen.keypad(True)
    try:
        return function(screen, *arguments, **options)
    finally:
        endwin()


def newwin(lines: int = LINES, columns: int = COLUMNS, *place: int) -> Window:
    """A window of its own."""
    return Window(_begin(), lines, columns)


def raw() -> None:
    """Read Ctrl-C as a key."""
    _begin().signals = False


def cbreak() -> None:
    """Have Ctrl-C interrupt the program."""
    _begin().signals = True


def flushinp() -> None:
    """Forget what was pressed and not read."""
    _begin().flush_keys()


def napms(ms: int) -> None:
    """Wait for so many ms of robot time."""
    time.sleep(ms / 1000)


def color_pair(number: int) -> int:
    """The attribute of a pair of colours."""
    return number << 8


def make_module() -> ModuleType:
    """`curses`, as far as simple programs use it."""
    module = ModuleType("curses", __doc__)
    own = (error, initscr, endwin, wrapper, newwin, raw, cbreak, flushinp, napms, color_pair)
    quiet = (
        "noecho echo nocbreak noraw curs_set start_color use_default_colors init_pair init_color beep flash nl nonl doupdate "
        "def_prog_mode reset_prog_mode reset_shell_mode set_escdelay mousemask intrflush meta typeahead savetty resetty"
    )
    module.__dict__.update(
        {function.__name__: function for function in own},
        **dict.fromkeys(quiet.split(), _nothing),
        **KEYS,
        **{f"A_{name}": 1 << number for number, name in enumerate(_LOOKS, 16)},
        **{f"COLOR_{name}": number for number, name in enumerate(_COLOURS)},
        **{"LINES": LINES, "COLS": COLUMNS, "COLORS": 8, "COLOR_PAIRS": 64, "ERR": -1, "OK": 0},
        has_colors=lambda: True,
        can_change_color=lambda: False,
        halfdelay=_nothing,
        isendwin=lambda: False,
        window=Window,
        __getattr__=_refuse,
        __path__=[],
    )
    for each in (error, Window):
        each.__module__ = "curses"
    return module


def _refuse(name: str) -> Any:
    if name.startswith("__"):
        raise AttributeError(name)
    raise AttributeError(f"the simulated curses has no {name!r}: it has keys and text", name=name)
