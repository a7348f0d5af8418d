"""`pynput.keyboard` as programs see it: a listener that hears the keys pressed in the notebook, in robot time.

Names and behaviour: pynput's documentation (https://pynput.readthedocs.io/en/latest/keyboard.html).
"""

from __future__ import annotations

import enum
import threading
from collections.abc import Callable
from types import ModuleType, TracebackType
from typing import Any

from ..sim.keyboard import SENT, KeyReader
from ..sim.strand import running_strand


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

    Args:
        on_press: called with each key that is pressed: a `KeyCode`, or a `Key` for those with a name.
        on_release: called with each key that is let go of.
        suppress: has no effect here.
    """

    def __init__(
        self,
        on_press: Callback | None = None,
        on_release: Callback | None = None,
        suppress: bool = False,
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

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.stop()


def make_module() -> ModuleType:
    """`pynput`, with `keyboard` in it."""
    keyboard = ModuleType("pynput.keyboard", __doc__)
    keyboard.__dict__.update(Key=Key, KeyCode=KeyCode, Listener=Listener, __getattr__=_refusing("pynput.keyboard"))
    pynput = ModuleType("pynput")
    pynput.__dict__.update(keyboard=keyboard, __path__=[], __getattr__=_refusing("pynput"))
    return pynput


def _refusing(module: str) -> Callable[[str], Any]:
    def refuse(name: str) -> Any:
        if name.startswith("__"):
            raise AttributeError(name)
        raise ImportError(
            f"{module}.{name} is not available here: of pynput a program has keyboard.Listener, Key and KeyCode",
            name=module,
        )

    return refuse


for _class in (KeyCode, Listener):
    _class.__module__ = "pynput.keyboard"
