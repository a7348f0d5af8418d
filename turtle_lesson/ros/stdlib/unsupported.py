"""What a simulated process cannot have: other processes of the real computer, which would run beside virtual time, and
windows, whose loops would hold that up.
"""

from __future__ import annotations

from collections.abc import Callable
from importlib.util import find_spec
from types import ModuleType
from typing import Any

from greenlet import getcurrent

from ..sim.strand import Strand

INSTEAD = "Threads can be used (threading, concurrent.futures.ThreadPoolExecutor), and further nodes by a launch file."
SIGNALS = "signal.signal, signal.alarm, signal.pause and signal.raise_signal are"

WINDOWS = ("PyQt5", "PyQt6", "PySide2", "PySide6", "customtkinter", "kivy", "pygame", "wx")
"""The modules of window toolkits. (tkinter is imported by mistake so often, by editors, that only its window is refused.)"""

NO_WINDOW = "{} opens windows, and a program here has no screen for them: lesson.dashboard() may show the same"


def windows(toolkit: str) -> ModuleType | None:
    """Refuse the import of a window toolkit by a program; one that is not installed is left to Python's own words.

    Raises:
        ImportError: if it is installed.
    """
    if find_spec(toolkit) is not None:
        raise ImportError(NO_WINDOW.format(toolkit), name=toolkit)
    return None


def first_window(real: Any) -> Any:
    """`tkinter.Tk.__init__`, which refuses a simulated process its first window."""

    def init(self: Any, *arguments: Any, **keywords: Any) -> None:
        if type(getcurrent()) is Strand:
            raise RuntimeError(NO_WINDOW.format("tkinter"))
        real(self, *arguments, **keywords)

    return init


def processes(what: str) -> Callable[..., Any]:
    """A function that does what the real one does, but refuses a simulated process another process."""
    return _refusing(
        f"{what} is not possible here: another process of the computer would know nothing about the simulation "
        f"and its time. {INSTEAD}"
    )


def signals(what: str) -> Callable[..., Any]:
    """The same for what only a real operating system can do with signals."""
    return _refusing(f"{what} is not available here; {SIGNALS}")


def _refusing(sentence: str) -> Callable[..., Any]:
    def refused(real: Any, *arguments: Any, **keywords: Any) -> Any:
        if type(getcurrent()) is Strand:
            raise NotImplementedError(sentence)
        return real(*arguments, **keywords)

    return refused


def start_process(real: Any) -> Any:
    """`multiprocessing.Process.start`, which is what all of multiprocessing comes down to."""
    refused = processes("multiprocessing")

    def start(self: Any) -> None:
        refused(real, self)

    return start
