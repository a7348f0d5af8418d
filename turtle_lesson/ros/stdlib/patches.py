"""The one table of everything that this package puts in the place of the interpreter's own: `install`, `uninstall`.

A row names an attribute of a module, class or object, what makes ours from the original, and why. `uninstall` puts the
very originals back, and a later `install` puts ours in again. Outside simulated processes and a learner's cells all
replacements behave as the real ones do, so modules that took a name out of the standard library (`from threading import
Lock`) before, meanwhile or afterwards go on working.
"""

from __future__ import annotations

import atexit
import os
import queue
import random
import sys
import threading
import warnings
from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import thread as pool
from contextlib import nullcontext
from functools import cache, partial
from importlib.machinery import ModuleSpec, PathFinder
from pkgutil import resolve_name
from types import FunctionType, MethodType, ModuleType
from typing import Any, NamedTuple

from ..idl.registry import install_finder, uninstall_finder
from ..sim import interrupts, strand
from ..sim.strand import Strand, running_strand
from . import asyncio_loops, clocks, deadlock, locks, ownership, process_state, subprocesses, terminals, threads
from .ownership import facade, in_no_strand
from .program import ProgramFinder, on_import


class Patch(NamedTuple):
    """One replaced attribute; `owner` is named as `pkgutil.resolve_name` reads it, and `ours` gets the original."""

    owner: str
    name: str
    ours: Callable[[Any], Any]
    why: str


def named(function: Any, name: str, real: Any) -> Any:
    """A copy of a function, with the name and docstring of the one that it stands for."""
    copy: Any = FunctionType(function.__code__, function.__globals__, name, function.__defaults__, function.__closure__)
    copy.__kwdefaults__, copy.__qualname__ = function.__kwdefaults__, getattr(real, "__qualname__", name)
    copy.__module__, copy.__doc__ = getattr(real, "__module__", None), real.__doc__
    return copy


def _function(owner: str, function: Callable[..., Any], why: str, name: str = "") -> Patch:
    """A row for a function that gets the real one as its first argument.

    As a method of the real one it is as good an attribute of a class as that: it is not bound once more.
    """
    name = name or function.__name__
    return Patch(owner, name, lambda real: MethodType(named(function, name, real), real), why)


def _in_process(owner: str, function: Callable[..., Any], why: str, name: str = "", *, cells: bool = True) -> Patch:
    """A row for a function that takes the real one's place in a simulated process alone, and gets the strand that calls first.

    Without `cells` the real one is also called for a cell that waits.
    """

    def call(real: Any, *arguments: Any, **keywords: Any) -> Any:
        strand = running_strand()
        if strand is not None and (cells or not strand.process.is_notebook):
            return function(strand, *arguments, **keywords)
        return real(*arguments, **keywords)

    return _function(owner, call, why, name or function.__name__)


def _refused(owner: str, name: str) -> Patch:
    """A row for a function that a simulated process cannot have."""

    def refuse(strand: Strand, *arguments: Any, **keywords: Any) -> Any:
        raise subprocesses.not_here(f"{owner}.{name}()")

    return _in_process(owner, refuse, REFUSED, name)


def _method(owner: str, function: Callable[..., Any], why: str, name: str = "") -> Patch:
    """A row for a method of a class; the function gets the real method first, and then the object."""
    name = name or function.__name__

    def ours(real: Any) -> Any:
        return named(lambda self, *arguments, **keywords: function(real, self, *arguments, **keywords), name, real)

    return Patch(owner, name, ours, why)


def _now(owner: str, name: str) -> Callable[[Any], Any]:
    """What an attribute in a row above is by now: for a second name of the same thing."""
    return lambda real: getattr(resolve_name(owner), name)


TIME = "virtual time in a simulated process"
DATE = "the robot's date, in UTC, in a simulated process"
DRAW = "random numbers that are a process's own, by the world's seed"
PEEK = "waiting with a time limit reads a clock, which takes no virtual time"
THREAD = "a thread of a simulated process is a strand of it, in virtual time"
NAMES = "numbers in names count by process"
LOOPS = "an asyncio loop that waits in virtual time"
VARIABLES = "variables are a process's own"
SIGNAL = "handlers are those of the simulated process"
REFUSED = "what only a real operating system can do"
MODULES = "looks into sys.modules, where the running program's modules must be"
AT_EXIT = "is called when the simulated process ends"
CHILD = "ros2 commands and Python files run in the world"
WAITS = "waits in virtual time"

EARLY: tuple[Patch, ...] = (
    *(_function("time", each, TIME, name) for name, each in clocks.CLOCKS.items()),
    _function("time", threads.sleep, TIME),
    _function("random", process_state.random, DRAW),
    *(
        _in_process("random", process_state.drawing(name), DRAW, name)
        for name in random.__all__
        if name != "random" and type(getattr(getattr(random, name), "__self__", None)) is random.Random
    ),
)
"""Put in by `import turtle_lesson`, so that a program that begins with `from time import sleep` has ours."""

TABLE: tuple[Patch, ...] = (
    *EARLY,
    *(_in_process("time", each, DATE, name) for name, each in clocks.DATES.items()),
    Patch("logging:Formatter", "converter", _now("time", "localtime"), DATE),
    *(
        _in_process("numpy.random", process_state.drawing(name, process_state.numpy_source), DRAW, name)
        for name in process_state.NUMPY
    ),
    _function("numpy.random", process_state.default_rng, DRAW),
    Patch("threading", "Lock", lambda real: facade(real, locks.VirtualLock), WAITS),
    _function("threading", locks.rlock, WAITS, "RLock"),
    Patch("threading:Event", "is_set", lambda real: deadlock.is_set, "polling takes time, or would never end"),
    _function("threading", locks.waiter, WAITS, "_allocate_lock"),
    _function("threading", locks.peek, PEEK, "_time"),
    _function("queue", locks.peek, PEEK, "time"),
    Patch("queue", "SimpleQueue", lambda real: facade(real, locks.VirtualSimpleQueue), "Python's is made in C"),
    *(_method("threading:Thread", each, THREAD) for each in (threads.start, threads.join, threads.is_alive)),
    *(_in_process("threading", function, THREAD, name) for name, function in threads.IDENTITY.items()),
    *(_function("threading", each, THREAD) for each in (threads.main_thread, threads.enumerate, threads.active_count)),
    _function("threading", threads.newname, NAMES, "_newname"),
    Patch("_threading_local", "current_thread", _now("threading", "current_thread"), "local values go by strand"),
    Patch("_threading_local", "RLock", _now("threading", "RLock"), WAITS),
    Patch("threading", "local", lambda real: facade(real, ownership.VirtualLocal), "Python's goes by real threads"),
    _method(
        "concurrent.futures.thread:ThreadPoolExecutor", threads.init, "eight threads on every computer", "__init__"
    ),
    _method("concurrent.futures.thread:ThreadPoolExecutor", threads.adjust, "joins threads", "_adjust_thread_count"),
    Patch(
        "concurrent.futures.thread", "_global_shutdown_lock", lambda real: nullcontext(), "strands would wait with it"
    ),
    *(_in_process("asyncio.events", each, LOOPS) for each in asyncio_loops.REPLACEMENTS),
    *(Patch("asyncio", e.__name__, _now("asyncio.events", e.__name__), LOOPS) for e in asyncio_loops.REPLACEMENTS),
    _in_process("signal", process_state.signal, SIGNAL, cells=False),
    _in_process("signal", process_state.getsignal, SIGNAL, cells=False),
    _in_process("signal", process_state.raise_signal, SIGNAL, cells=False),
    _function("os", process_state.kill, SIGNAL),
    _in_process("os", lambda strand, code: strand.process.end_now(code), "ends one process", "_exit", cells=False),
    _function("os", terminals.read, "reads the program's own terminal"),
    *(_function("os", process_state.tell_system, VARIABLES, name) for name in ("putenv", "unsetenv")),
    *(_refused(owner, name) for owner, names in subprocesses.OF_THE_COMPUTER.items() for name in names.split()),
    *(
        _function(owner, process_state.with_modules, MODULES, name)
        for owner, name in process_state.LOOKS_INTO_SYS_MODULES
    ),
    _method("ipykernel.iostream:OutStream", in_no_strand, "waits for a real thread, in which no time passes", "flush"),
    Patch("os:environ", "__class__", lambda real: process_state.ProcessEnviron, VARIABLES),
    _function("atexit", process_state.register, AT_EXIT),
    _function("atexit", process_state.unregister, AT_EXIT),
    Patch("subprocess", "Popen", lambda real: subprocesses.WorldPopen, CHILD),
    _function("os", subprocesses.system, CHILD),
    _method("multiprocessing.process:BaseProcess", subprocesses.start, REFUSED),
    _method("tkinter:Tk", subprocesses.first_window, "a program here has no screen", "__init__"),
)

LATE = frozenset({"ipykernel.iostream", "multiprocessing.process", "numpy.random", "tkinter"})
"""Modules that a start does not import for their rows: these are put in when anybody imports the module."""


class LateFinder:
    """Has the rows of a `LATE` module put in as soon as it is imported."""

    @staticmethod
    def find_spec(name: str, path: Sequence[str] | None = None, target: ModuleType | None = None) -> ModuleSpec | None:
        """Where the module is, with a loader that puts the rows in; None for all other modules."""
        spec = PathFinder.find_spec(name, path, target) if name in LATE else None
        if spec is None or spec.loader is None:
            return None
        execute = spec.loader.exec_module

        def exec_module(module: ModuleType) -> None:
            execute(module)
            _put_in(patch for patch in TABLE if patch.owner.partition(":")[0] == name)

        spec.loader.exec_module = exec_module  # type: ignore[method-assign]
        return spec


FINDERS = (ProgramFinder, LateFinder)
"""What a world puts before all other finders: one gives each program modules of its own, one has rows wait for their module.
The one that makes the modules of message packages is there from `import turtle_lesson` on."""

NEWEST = (3, 14)
"""The newest Python with which the names below were seen to do what is expected of them."""

TRIED = "turtle_lesson was tried on Python 3.11 to 3.14"

PRIVATE_NAMES: tuple[tuple[Any, str], ...] = (
    (threading, "_time _newname _RLock _allocate_lock"),
    (threading.Condition(), "_lock"),
    (threading.Event(), "_flag"),
    (threading.Thread(name="unused"), "_initialized _started _ident _native_id"),
    (queue, "time _PySimpleQueue"),
    (ownership.module, "local"),
    (pool, "_threads_queues _global_shutdown_lock"),
    (pool.ThreadPoolExecutor, "_adjust_thread_count"),
    (asyncio_loops.asyncio.BaseEventLoop, "_run_once"),
    (os.environ, "_data"),
)
"""What is used of the standard library without being documented: owner, and names.

`asyncio._enter_task` and its kin are not among them: their underscore notwithstanding, they are documented.
(https://docs.python.org/3/library/asyncio-extending.html)
"""


def _check_python() -> None:
    """Raise NotImplementedError if a private name is gone; warn of a Python that is newer than those that were tried."""
    gone = [
        f"{name} ({owner!r})" for owner, names in PRIVATE_NAMES for name in names.split() if not hasattr(owner, name)
    ]
    if gone:
        raise NotImplementedError(f"this Python has changed what simulated programs need: {', '.join(gone)}. {TRIED}")
    if sys.version_info[:2] > NEWEST:
        warnings.warn(TRIED, RuntimeWarning, stacklevel=3)


# -- putting in and taking out ---------------------------------------------------------------------------------------

_replaced: list[tuple[Any, str, Any]] = []
"""Owner, name and original of what is replaced now, the oldest first."""


def install_early() -> None:
    """Put in the rows of `EARLY`, unless they are in."""
    if not _replaced:
        install_finder()
        atexit.register(_at_exit)
        _put_in(EARLY)


def install() -> None:
    """Put in all rows that are not in.

    Raises NotImplementedError on a Python that lacks what simulated threads need.
    """
    install_early()
    if FINDERS[0] not in sys.meta_path:
        _check_python()
        _put_in_place_of_modules()
        sys.meta_path[:0] = FINDERS
        _put_in(TABLE[len(EARLY) :])


def uninstall() -> None:
    """Put back all originals; the next world installs ours again. `import turtle_lesson` adds to `sys.path`, which stays.

    Raises RuntimeError while a world is open.
    """
    notebook = ownership.Notebook.process()
    if notebook is not None and not notebook.simulation.closed:
        raise RuntimeError("a world is open, whose programs need what is to be taken out: close it first")
    _take_out()
    interrupts.watchdog.stop()
    atexit.unregister(_at_exit)


def _take_out() -> None:
    for owner, name, real in reversed(_replaced):
        setattr(owner, name, real)
    uninstall_finder()
    sys.meta_path[:] = [each for each in sys.meta_path if each not in FINDERS]
    _replaced.clear()
    on_import.clear()


def _put_in(rows: Iterable[Patch]) -> None:
    """Put in what this Python, on this system, has, and of late modules those that are imported."""
    for place, name, ours, _ in rows:
        module = place.partition(":")[0]
        if module in LATE and module not in sys.modules:
            continue
        owner = resolve_name(place)
        if hasattr(owner, name):
            real = getattr(owner, name)
            _replaced.append((owner, name, real))
            setattr(owner, name, ours(real))


def _at_exit() -> None:
    """Nothing may ask which greenlet runs while Python takes itself apart; then put all originals back."""
    strand.running_greenlet = lambda: None
    _take_out()


# -- modules that programs get instead of the real ones --------------------------------------------------------------


def _put_in_place_of_modules() -> None:
    """What import statements of simulated programs, and of nobody else, get or cause."""
    modules = {module.__name__: module for module in (clocks.make_module(), *terminals.make_modules())}
    on_import.update({name: partial(modules.get, name) for name in modules})
    on_import.update({name: partial(subprocesses.refuse_toolkit, name) for name in subprocesses.WINDOWS})
    on_import.update({name: partial(_key_library, f"make_{name}") for name in ("curses", "pynput")})


@cache
def _key_library(maker: str) -> ModuleType:
    """Made once a program asks for it: few do."""
    from . import key_libraries

    module: ModuleType = getattr(key_libraries, maker)()
    return module
