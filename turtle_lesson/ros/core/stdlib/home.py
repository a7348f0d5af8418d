"""Whose thread is it? What a simulated process or a learner's cell makes belongs to the simulation, all else is real.

Locks, threads and their kin belong to the simulation if they are made

- by code that runs in a simulated process, whatever code that is, except for what the module of a library makes while it
  is imported: it is there for everybody; and except for Jupyter's own modules, which wait for Jupyter's threads; or
- in the notebook, while a world is open and in the thread that the world lives in, directly by code of a cell (of the
  module `__main__`) or of a file of the learner's own. What the modules `threading`, `queue` and `concurrent.futures`, and
  the listener of tf2_ros, make on the way counts as made by their caller.

Code of a cell sleeps in robot time as long as a thread lives that cells have started: else that would never go on.

So Jupyter's own threads, those of tornado, matplotlib, asyncio, and whatever any other library starts, stay Python's own.
"""

from __future__ import annotations

import sys
from _thread import get_ident
from collections.abc import Callable
from contextvars import copy_context
from inspect import CO_OPTIMIZED
from types import FrameType
from typing import TYPE_CHECKING, Any

from ..interrupts import JUPYTER
from ..strand import Strand, getcurrent, greenlet
from ..tracebacks import is_library

if TYPE_CHECKING:
    from ..process import Process

_ON_THE_WAY = {
    "threading",
    "queue",
    "concurrent.futures.thread",
    "concurrent.futures._base",
    "_threading_local",
    "tf2_ros.transform_listener",
}
_OURS = (__name__.rpartition(".")[0], "turtle_lesson.ros.core.virtual_time")


def nobody() -> Process | None:
    """No notebook: no world is open."""
    return None


def no_file(filename: str) -> bool:
    """No file is known to be the learner's own."""
    return False


class Notebook:
    """What the world tells about the notebook that it lives in: its process, and which files are the learner's own."""

    process: Callable[[], Process | None] = staticmethod(nobody)
    is_learners: Callable[[str], bool] = staticmethod(no_file)


def process_here() -> Process | None:
    """The simulated process that a thing made here belongs to; None if it is to be Python's own."""
    strand = getcurrent()
    if type(strand) is Strand:
        return None if is_for_everybody(sys._getframe(1)) else strand.process
    notebook = notebook_here()
    return notebook if notebook is not None and is_called_by_learner() else None


def notebook_here() -> Process | None:
    """The notebook's process, if this is plain code in the thread that its world lives in, and it can be run."""
    process = Notebook.process()
    if process is None or process.simulation.closed or get_ident() != process.simulation.thread:
        return None
    return process


def is_for_everybody(frame: FrameType) -> bool:
    """Whether Jupyter makes something here, or the module of a library, or the body of a class in it."""
    made_by = maker(frame)
    if made_by is None:
        return False
    if made_by.f_globals.get("__name__", "").partition(".")[0] in JUPYTER:
        return True
    is_function = made_by.f_code.co_flags & CO_OPTIMIZED
    return not is_function and is_library(made_by.f_code.co_filename)


def is_called_by_learner() -> bool:
    """Whether it is code of a cell, or of a file of the learner's, that calls."""
    frame = maker(sys._getframe(1))
    if frame is None:
        return False
    main = sys.modules.get("__main__")
    return frame.f_globals is getattr(main, "__dict__", None) or Notebook.is_learners(frame.f_code.co_filename)


def maker(frame: FrameType | None) -> FrameType | None:
    """The innermost of these frames that is not in the rooms of threads of the standard library, or here."""
    while frame is not None:
        name = frame.f_globals.get("__name__", "")
        if name not in _ON_THE_WAY and not name.startswith(_OURS):
            return frame
        frame = frame.f_back
    return None


def in_no_strand(real: Callable[..., Any]) -> Callable[..., Any]:
    """A function that does as in plain code, also where a strand calls it: it waits for real threads, in real time."""

    def call(*arguments: Any, **keywords: Any) -> Any:
        if type(getcurrent()) is not Strand:
            return real(*arguments, **keywords)
        aside = greenlet(real)
        aside.gr_context = copy_context()
        return aside.switch(*arguments, **keywords)

    return call
