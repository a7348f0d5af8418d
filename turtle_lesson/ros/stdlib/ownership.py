"""Whose is it? What a simulated process or a learner's cell makes belongs to the simulation, all else is Python's own.

Locks, threads and their kin belong to the simulation if they are made

- by code that runs in a simulated process, whatever code that is, except for what the module of a library makes while it is
  imported, which is there for everybody, and except for Jupyter's own modules, which wait for Jupyter's threads; or
- in the notebook, while a world is open and in the thread that the world lives in, directly by code of a cell (of the module
  `__main__`) or of a file of the learner's own.

So Jupyter's own threads, those of tornado, matplotlib, asyncio, and whatever any other library starts, stay Python's own.
"""

from __future__ import annotations

import importlib
import sys
from _thread import get_ident
from collections.abc import Callable
from contextvars import copy_context
from inspect import CO_OPTIMIZED
from types import FrameType
from typing import TYPE_CHECKING, Any

from greenlet import greenlet

from ..sim.errors import is_library
from ..sim.interrupts import JUPYTER
from ..sim.strand import running_strand

if TYPE_CHECKING:
    from ..sim.process import Process

_ON_THE_WAY = {
    "threading",
    "queue",
    "concurrent.futures.thread",
    "concurrent.futures._base",
    "_threading_local",
    "tf2_ros.transform_listener",
}
"""Modules that make things for their callers, as all of this folder do."""
_OURS = f"{__package__}."


class Notebook:
    """What the world tells about the notebook that it lives in: its process, and which files are the learner's own."""

    process: Callable[[], Process | None] = staticmethod(lambda: None)
    is_learners: Callable[[str], bool] = staticmethod(lambda filename: False)


def process_here() -> Process | None:
    """The simulated process that a thing made here belongs to; None if it is to be Python's own."""
    strand = running_strand()
    if strand is not None:
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


def in_no_strand(real: Callable[..., Any], *arguments: Any, **keywords: Any) -> Any:
    """Do as in plain code, also where a strand calls: it waits for real threads, in real time."""
    if running_strand() is None:
        return real(*arguments, **keywords)
    aside = greenlet(real)
    aside.gr_context = copy_context()
    return aside.switch(*arguments, **keywords)


# -- classes of which there are two: Python's own, and one that waits in virtual time ----------------------------------


class _Facade(type):
    """The type of a class that stands before both.

    A call makes an object of one or the other, depending on whose it is to be. A subclass derives from that one. Objects of
    both are its instances, so that callers need not know the difference.
    """

    _real: Any
    _virtual: type
    _kinds: tuple[type, ...]

    def __call__(cls, *arguments: Any, **keywords: Any) -> Any:
        make = cls._real if process_here() is None else cls._virtual
        return make(*arguments, **keywords)

    def __instancecheck__(cls, instance: Any) -> bool:
        return isinstance(instance, cls._kinds)

    def __subclasscheck__(cls, subclass: Any) -> bool:
        return subclass is cls or issubclass(subclass, cls._kinds)

    def __new__(mcls, name: str, bases: tuple[type, ...], namespace: dict[str, Any], **keywords: Any) -> Any:
        """Make a facade, or a class that is derived from one: then the facade gives way to what is behind it."""
        if not any(isinstance(base, _Facade) for base in bases):
            return super().__new__(mcls, name, bases, namespace)
        virtual = process_here() is not None
        behind = "_virtual" if virtual else "_real"
        real_bases = tuple(getattr(base, behind) if isinstance(base, _Facade) else base for base in bases)
        return type(real_bases[0])(name, real_bases, namespace, **keywords)

    def __getattr__(cls, name: str) -> Any:
        return getattr(cls._real, name)


def facade(real: Any, virtual: type) -> Any:
    """The class that stands before `real`, a class or a function that makes objects of one, and `virtual`."""
    namespace = {
        "__module__": getattr(real, "__module__", None),
        "__qualname__": real.__qualname__,
        "__doc__": real.__doc__,
        "_real": staticmethod(real),
        "_virtual": virtual,
        "_kinds": (type(real()), virtual),
    }
    return _Facade(real.__name__, (), namespace)


module: Any = importlib.import_module("_threading_local")
VirtualLocal: Any = module.local
"""`threading.local` in a simulated process: Python keeps it for systems whose threads have none in C, and it goes by
`threading.current_thread`."""
