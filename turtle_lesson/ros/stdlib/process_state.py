"""What each simulated process has for itself: environment variables, modules, random numbers, signals, exit functions."""

from __future__ import annotations

import os
import signal as module
import sys
import zlib
from collections.abc import Callable, Mapping
from functools import partial
from operator import attrgetter
from typing import Any

from ..sim.errors import is_library
from ..sim.process import Process
from ..sim.simulation import be_careful
from ..sim.strand import Strand, running_strand
from .program import running_modules

_RealEnviron: Any = type(os.environ)


class ProcessEnviron(_RealEnviron):
    """The type of `os.environ`: which variables it holds depends on the process that reads it."""

    @property
    def _data(self) -> dict[Any, Any]:
        own = _own()
        return vars(self)["_data"] if own is None else own


def tell_system(real: Callable[..., None], *variable: Any) -> None:
    """`os.putenv` and `os.unsetenv`, by which `os.environ` changes the variables of the real process."""
    if _own() is None:
        real(*variable)


def encoded(variables: Mapping[str, str] | None, name: str, default: str) -> dict[Any, Any]:
    """These variables as a process keeps them, and one that has a default; without any, a copy of the caller's."""
    environ: Any = os.environ
    if variables is None:
        kept = dict(environ._data)  # as they are: to decode and encode each takes 70 calls
    else:
        kept = {environ.encodekey(each): environ.encodevalue(text) for each, text in variables.items()}
    kept.setdefault(environ.encodekey(name), environ.encodevalue(default))
    return kept


def _own() -> dict[Any, Any] | None:
    """The variables of the simulated process that runs, if one does."""
    strand = running_strand()
    return strand.process.environ if strand is not None else None


# -- modules -----------------------------------------------------------------------------------------------------------

LOOKS_INTO_SYS_MODULES = (
    ("importlib", "import_module"),
    ("importlib", "reload"),
    ("pickle", "dump"),
    ("pickle", "dumps"),
    ("typing", "get_type_hints"),
    ("dataclasses", "dataclass"),
    ("inspect", "getfile"),
)
"""Functions of the standard library that look into `sys.modules` for a module of the program that runs."""


def with_modules(real: Callable[..., Any], *arguments: Any, **keywords: Any) -> Any:
    """Have the program's modules be there, and then do what the real function does."""
    modules = running_modules()
    if modules is not None:
        modules.show()
    return real(*arguments, **keywords)


# -- random numbers ----------------------------------------------------------------------------------------------------
# They are drawn from a source of the process, seeded by the world's seed and the process's name. So one program's draws
# never shift another's, and a run can be repeated.

NUMPY = (
    *("choice", "normal", "permutation", "rand", "randint", "randn", "random", "random_sample", "seed", "shuffle"),
    *("standard_normal", "uniform"),
)
"""The functions of `numpy.random` that draw from one state of the whole program."""


def drawing(name: str, source: Callable[[Process], Any] = attrgetter("random")) -> Callable[..., Any]:
    """A function of the standard `random` module, or of a `source` of its own, that draws from the source of the process."""

    def draw(strand: Strand, *arguments: Any, **keywords: Any) -> Any:
        return getattr(source(strand.process), name)(*arguments, **keywords)

    return draw


def numpy_source(process: Process) -> Any:
    """The state from which numpy's old global functions draw."""
    from numpy.random import RandomState

    return process.state(RandomState, zlib.crc32(process.seed.encode()))


def random(real: Callable[[], float]) -> float:
    """`random.random`, which is by far the most used, and so is spelled out."""
    strand = running_strand()
    return strand.process.random.random() if strand is not None else real()


def default_rng(real: Callable[..., Any], seed: Any = None) -> Any:
    """`numpy.random.default_rng`: without a seed, it is seeded by the process's own random numbers."""
    strand = running_strand()
    if seed is None and strand is not None:
        seed = strand.process.random.getrandbits(64)
    return real(seed)


# -- signals -----------------------------------------------------------------------------------------------------------
# A handler is called where the main thread waits, at the instant at which the signal comes, and the waiting goes on
# after it. SIGINT comes from Ctrl-C and from launch, SIGTERM from launch; a process may send itself any signal. In a
# cell that waits all these are the real ones: its signals are the kernel's.


def signal(strand: Strand, signalnum: int, handler: Any) -> Any:
    """Set the handler of a signal; returns the one before."""
    process, number = strand.process, module.Signals(signalnum)
    if strand is not process.main_strand:
        raise ValueError("signal only works in main thread of the main interpreter")
    if not callable(handler) and handler not in (module.SIG_IGN, module.SIG_DFL):
        raise TypeError("signal handler must be signal.SIG_IGN, signal.SIG_DFL, or a callable object")
    be_careful(process.simulation)
    before = getsignal(strand, number)
    process.signal_handlers[number] = handler
    return before


def getsignal(strand: Strand, signalnum: int) -> Any:
    """The handler of a signal."""
    return strand.process.signal_handlers.get(module.Signals(signalnum), module.SIG_DFL)


def raise_signal(strand: Strand, signalnum: int, /) -> None:
    """Send this process a signal; 0 does nothing, as on a real computer."""
    if signalnum != 0:
        strand.process.send_signal(module.Signals(signalnum))


def kill(real: Any, pid: int, signal: int, /) -> None:
    """`os.kill`: a signal that a program sends to itself stays in the world; all others, and 0, go to the computer."""
    process = _own_process()
    if signal and process is not None and process.modules is not None and pid in (os.getpid(), process.pid):
        process.send_signal(signal)
    else:
        real(pid, signal)


# -- exits -------------------------------------------------------------------------------------------------------------
# What a program gives to `atexit` is called when its process ends. What a library registers while a program imports it
# is left to Python itself: the library is there for all processes.


def register(real: Any, func: Any, /, *args: Any, **kwargs: Any) -> Any:
    """Have a function called at the end."""
    process = _own_process()
    if process is None or is_library(sys._getframe(1).f_code.co_filename):
        return real(func, *args, **kwargs)
    if not callable(func):
        raise TypeError("the first argument must be callable")
    process.exit_functions.append(partial(func, *args, **kwargs))
    return func


def unregister(real: Any, func: Any, /) -> None:
    """No longer have it called."""
    process = _own_process()
    if process is None or is_library(sys._getframe(1).f_code.co_filename):
        real(func)
    else:
        process.exit_functions[:] = [each for each in process.exit_functions if each.func != func]


def _own_process() -> Process | None:
    """The running process, if it is no notebook."""
    strand = running_strand()
    return None if strand is None or strand.process.is_notebook else strand.process
