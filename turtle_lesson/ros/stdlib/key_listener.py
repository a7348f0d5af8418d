"""`pynput.keyboard`, by which programs hear keys, as such programs see it: in robot time.

The keys are those pressed in the notebook. Names and behaviour: https://pynput.readthedocs.io/en/latest/keyboard.html.
"""

from __future__ import annotations

import enum
import threading
from collections.abc import Callable
from dataclasses import dataclass
from types import ModuleType

from ..sim.keyboard import SENT, KeyReader
from ..sim.strand import running_strand


@dataclass(frozen=True, repr=False)
class KeyCode:
    """A key that gives a character."""

    vk: int | None = None
    char: str | None = None
    is_dead: bool = False

    @classmethod
    def from_char(cls, char: str) -> KeyCode:
        """The key of a character."""
        return cls(char=char)

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

    def __enter__(self) -> Listener:
        self.start()
        return self

    def __exit__(self, *error: object) -> None:
        self.stop()


def make_pynput() -> ModuleType:
    """`pynput`, with `keyboard` in it."""
    pynput, keyboard = ModuleType("pynput"), ModuleType("pynput.keyboard")
    keyboard.__dict__.update(Key=Key, KeyCode=KeyCode, Listener=Listener, __getattr__=_lacking)
    pynput.__dict__.update(keyboard=keyboard, __path__=[], __getattr__=_lacking)
    return pynput


def _lacking(name: str) -> object:
    if name.startswith("__"):
        raise AttributeError(name)
    raise ImportError(f"{name} is not available here: of pynput a program has keyboard.Listener, Key and KeyCode")
