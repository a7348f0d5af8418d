"""What is typed at a world: the lines that programs ask for with `input()`, and the keys that they read one by one.

A line comes from what was typed ahead, or else from the running cell: in a notebook from the prompt below it, in a script
from Python's own `input`. Robot time stands still while somebody thinks about an answer. Keys are pressed in a widget or by
`lesson.press`; while a program waits for one, robot time goes on.
"""

from __future__ import annotations

import builtins
import sys
import time
from collections import deque
from types import BuiltinFunctionType
from typing import TYPE_CHECKING, Any

from .strand import Strand, running_strand

if TYPE_CHECKING:
    from .process import Process
    from .simulation import Simulation

_monotonic = time.monotonic  # the real one, whatever time.monotonic becomes

TYPING = 1_000_000_000
"""How long, in ns, the next line takes to type if the program has done something since its last one.

Without it, a loop that asks and publishes would never let time pass, and its robot would never move.
"""

MOMENT = 1_000_000
"""What happens within so many ns counts as the same instant: reading clocks takes time, too."""

PAUSE = 100_000_000
"""How often, in ns, a program that asks between two cells of a notebook looks whether a cell runs."""

POLL = 1_000_000
"""What a look for a key that was not pressed takes, in ns: a loop that only looks must come to an end, too."""

NO_KEYS = (
    "{name} waits for keys. Press them in lesson.teleop(), which passes them on when it has the focus, or by "
    "lesson.press('w', 'up')."
)

END = "EOF when reading a line"
"""Python's words for an input that has ended."""


class Keyboard:
    """The keyboard of a world, which its programs share.

    Attributes:
        lines: lines that were typed ahead, for the programs that ask next.
        has_keys: whether something is there that can press keys.
        live: whether time goes on by itself now, run by no cell, so that no cell can ask.
        seconds_asked: how long, in s of real time, programs have waited for answers of the cell.
    """

    def __init__(self, simulation: Simulation) -> None:
        self.lines: deque[str] = deque()
        self.has_keys = False
        self.live = False
        self.seconds_asked = 0.0
        self._simulation = simulation
        self._last: tuple[Process, int, int] | None = None
        self._readers: list[KeyReader] = []

    # -- keys --------------------------------------------------------------------------------------------------------------

    @property
    def reader(self) -> str:
        """The program that keys go to; "" if none reads keys."""
        hearing = self._hearing()
        return hearing[-1].process.name if hearing else ""

    def reads_keys(self, reader: KeyReader) -> None:
        """From now on a program reads keys. Of several programs with a terminal the one that began last gets them."""
        if reader not in self._readers:
            self._readers.append(reader)

    def press(self, key: str, down: bool = True) -> None:
        """Press a key, such as "w" or "up", or let go of it.

        Raises:
            ValueError: if there is no such key.
        """
        name = key_named(key)
        for reader in self._hearing():
            reader.hear(name, down)

    def _hearing(self) -> list[KeyReader]:
        """The readers that hear the next key: those that hear all, and the newest of those with a terminal."""
        self._readers = [reader for reader in self._readers if reader.process.alive and not reader.stopped]
        focus = [reader for reader in self._readers if reader.has_terminal][-1:]
        return [reader for reader in self._readers if not reader.has_terminal or reader in focus]

    # -- lines -------------------------------------------------------------------------------------------------------------

    def line(self, process: Process, prompt: str) -> str:
        """The next line that is typed for a program, without its line end.

        Raises:
            EOFError: if no line was typed ahead and the cell cannot be asked.
            KeyboardInterrupt: if the user stops the cell while it asks.
        """
        simulation = self._simulation
        if self._last is not None:
            asker, now, events = self._last
            if asker is process and simulation.now - now < MOMENT and simulation.events != events:
                simulation.sleep_until(simulation.now + TYPING)
        if not self.lines:
            self._wait_for_a_cell(process, prompt)
        if self.lines:
            line = self.lines.popleft()
            print(f"{prompt}{line}", file=process.stdout or sys.stdout)
        else:
            line = self._answer_of_the_cell(prompt)
        self._last = (process, simulation.now, simulation.events)
        return line

    def _wait_for_a_cell(self, process: Process, prompt: str) -> None:
        """In live mode and between two cells Jupyter shows no prompt: go on in the next cell that lets time pass."""
        if self.live or _is_between_cells():
            asks = f"{process.name} asks {prompt.strip()!r}: to answer, run a cell such as lesson.run(1)."
            print(asks, file=process.stdout or sys.stdout)
        while (self.live or _is_between_cells()) and not self.lines:
            self._simulation.sleep_until(self._simulation.now + PAUSE)

    def _answer_of_the_cell(self, prompt: str) -> str:
        """Ask the user, and have the whole world wait for the answer."""
        began, stream = _monotonic(), sys.stdout
        sys.stdout = self._simulation.cell_stdout  # a launched program's would keep the prompt until its line ends
        try:
            return builtins.input(prompt)
        except (OSError, RuntimeError):  # Jupyter's for a page that nobody looks at; Python's without any input
            raise EOFError(END) from None
        finally:
            sys.stdout = stream
            self.seconds_asked += _monotonic() - began


class KeyReader:
    """What hears keys in a program: a listener, which hears all keys of the computer. A terminal is a kind of its own.

    Attributes:
        events: the names of keys, each with whether it was pressed or let go of, that nobody has read yet.
        stopped: whether it hears no more.
    """

    has_terminal = False

    def __init__(self, process: Process) -> None:
        self.process = process
        self.events: deque[tuple[str, bool]] = deque()
        self.stopped = False
        self._heard = 0
        self._waiting: list[Strand] = []
        self._said = False

    def hear(self, name: str, down: bool) -> None:
        """A key was pressed, or let go of."""
        self.events.extend((part, down) for part in (name.split("+") if "+" in name[1:] else [name]))
        self.notify()

    def notify(self) -> None:
        """Have those who wait look again."""
        self._heard += 1
        for strand in self._waiting:
            strand.simulation.wake(strand)

    def wait(self, seconds: float | None = None) -> bool:
        """Hold the running strand up until something is heard, at most `seconds` of robot time; whether it was."""
        simulation, heard = self.process.simulation, self._heard
        simulation.keyboard.reads_keys(self)
        if not self._said and not simulation.keyboard.has_keys:
            print(NO_KEYS.format(name=self.process.name), file=self.process.stderr or sys.stderr)
        self._said = True
        strand = running_strand()
        assert strand is not None
        deadline = None if seconds is None else simulation.now + max(POLL, round(seconds * 1e9))
        self._waiting.append(strand)
        try:
            return simulation.wait_for(strand, lambda: self._heard > heard, deadline)
        finally:
            self._waiting.remove(strand)


def _is_between_cells() -> bool:
    """Whether this is a notebook in which no cell is running: only to a cell does Jupyter give its own `input`."""
    ipython: Any = sys.modules.get("IPython")
    shell = None if ipython is None else ipython.get_ipython()
    return getattr(shell, "kernel", None) is not None and isinstance(builtins.input, BuiltinFunctionType)


# -- key names ----------------------------------------------------------------------------------------------------
# The names of keys, as pynput has them (https://pynput.readthedocs.io), and what a terminal sends for each.

SENT = {
    "space": " ", "enter": "\n", "tab": "\t", "esc": "\x1b", "backspace": "\x7f", "up": "\x1b[A", "down": "\x1b[B",
    "right": "\x1b[C", "left": "\x1b[D", "home": "\x1b[H", "end": "\x1b[F", "insert": "\x1b[2~", "delete": "\x1b[3~",
    "page_up": "\x1b[5~", "page_down": "\x1b[6~", "f1": "\x1bOP", "f2": "\x1bOQ", "f3": "\x1bOR", "f4": "\x1bOS",
    "f5": "\x1b[15~", "f6": "\x1b[17~", "f7": "\x1b[18~", "f8": "\x1b[19~", "f9": "\x1b[20~", "f10": "\x1b[21~",
    "f11": "\x1b[23~", "f12": "\x1b[24~", "ctrl+c": "\x03", "shift": "", "ctrl": "", "alt": "", "cmd": "", "caps_lock": "",
}  # fmt: skip
"""What a terminal sends for the keys that have a name (of xterm); for all others the character itself."""

_OF_CHARACTERS = {"\r": "enter", **{text: name for name, text in SENT.items() if len(text) == 1}}
_OF_BROWSERS = {
    "escape": "esc", "control": "ctrl", "pageup": "page_up", "pagedown": "page_down", "meta": "cmd", "capslock": "caps_lock",
}  # fmt: skip


def key_named(key: object) -> str:
    """The name of a key: of a character, of a name such as "up", or of a browser's such as "ArrowUp".

    Raises:
        ValueError: if there is no such key.
    """
    key = str(key)
    if len(key) == 1:
        return _OF_CHARACTERS.get(key, key)
    name = key.removeprefix("Arrow").lower()
    name = _OF_BROWSERS.get(name, name)
    if name not in SENT:
        raise ValueError(
            f'a key is one character or a name such as "up" or "enter", got {key!r}: several keys are several arguments'
        )
    return name
