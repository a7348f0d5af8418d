"""Puts all this in place of the functions and classes of the standard library; `install` is called by the first world.

Modules that took a name out of the standard library before that, as `from threading import Lock` does, keep the real
one. Outside simulated processes and a learner's cells, all replacements behave as the real ones do.
"""

from __future__ import annotations

import _thread
import asyncio
import atexit
import importlib
import logging
import os
import queue
import signal
import sys
import threading
import time
from concurrent.futures import thread as pool
from functools import cache, partial
from types import ModuleType
from typing import Any

from greenlet import getcurrent

from ..sim.strand import Strand
from . import (
    asyncio_loops,
    clocks,
    environment,
    locks,
    ownership,
    polling,
    pools,
    signals,
    terminals,
    threads,
    unsupported,
)
from .ownership import facade, in_no_strand, notebook_here, process_here
from .patches import add_finder, is_replaced, replace, replace_function, replace_method
from .program import ProgramFinder, on_import

__all__ = [
    "install",
]


def install() -> None:
    """Replace them; a second call does nothing."""
    if is_replaced(threading, "Lock"):
        return
    _install_locks()
    _install_threads()
    _install_pools()
    _install_loops()
    _install_signals()
    _install_refusals()
    _install_modules()
    _install_streams()
    _install_times()
    replace(os.environ, "__class__", environment.ProcessEnviron)
    replace_function(atexit, "register", signals.register)
    replace_function(atexit, "unregister", signals.unregister)


def _install_times() -> None:
    for function in clocks.REPLACEMENTS:
        replace_function(time, function.__name__, function)
    replace(logging.Formatter, "converter", time.localtime)
    replace(clocks, "sleeps_in_robot_time", threads.sleep_of_a_cell)


def _install_locks() -> None:
    lock_kinds = (locks.RealLock, locks.VirtualLock)
    replace(threading, "Lock", facade(threading.Lock, locks.VirtualLock, lock_kinds))
    replace_function(threading, "RLock", _rlock)
    replace_method(threading.Event, "is_set", polling.is_set)
    replace_method(threading.Condition, "wait", locks.condition_wait(threading.Condition.wait))
    replace_function(threading, "_time", _peek)
    replace_function(queue, "time", _peek)
    queue_kinds = (pools.RealSimpleQueue, pools.VirtualSimpleQueue)
    replace(queue, "SimpleQueue", facade(pools.RealSimpleQueue, pools.VirtualSimpleQueue, queue_kinds))


def _rlock(real: Any, *arguments: Any, **keywords: Any) -> Any:
    return (real if process_here() is None else locks.VirtualRLock)(*arguments, **keywords)


def _peek(real: Any) -> float:
    """A clock for waiting with a time limit: unlike `time.monotonic`, looking at it takes no virtual time."""
    strand = getcurrent()
    if type(strand) is Strand:
        return strand.simulation.now / locks.NANOSECONDS
    notebook = notebook_here()
    if notebook is not None and locks.is_virtual(sys._getframe(1).f_locals.get("self")):
        return notebook.simulation.now / locks.NANOSECONDS
    return real()


def _install_threads() -> None:
    kind: Any = threading.Thread
    replace_method(kind, "start", threads.start)
    if not threads.HAS_HANDLES:
        replace_method(kind, "_wait_for_tstate_lock", threads.wait_for_end(kind._wait_for_tstate_lock))
    for function in threads.REPLACEMENTS:
        replace_function(threading, function.__name__, function)
    replace_function(_thread, "start_new_thread", threads.start_new_thread)
    replace(ownership.module, "current_thread", threading.current_thread)
    replace(ownership.module, "RLock", threading.RLock)
    local_kinds = (ownership.RealLocal, ownership.VirtualLocal)
    replace(threading, "local", facade(ownership.RealLocal, ownership.VirtualLocal, local_kinds))


def _install_pools() -> None:
    kind: Any = pool.ThreadPoolExecutor
    replace_method(kind, "__init__", pools.init)
    replace_function(kind, "_counter", pools.next_number)
    replace(pool, "_global_shutdown_lock", pools.NotInStrands())
    replace(pool, "_threads_queues", pools.Queues(pool._threads_queues))


def _install_loops() -> None:
    for function in asyncio_loops.REPLACEMENTS:
        name = function.__name__
        replace_function(asyncio.events, name, function)
        replace(asyncio, name, getattr(asyncio.events, name))


def _install_streams() -> None:
    """Jupyter's streams wait for a thread of their own where they are flushed: no robot time passes meanwhile."""
    streams: Any = sys.modules.get("ipykernel.iostream")
    if streams is not None:
        replace_method(streams.OutStream, "flush", in_no_strand(streams.OutStream.flush))


def _install_signals() -> None:
    for function in signals.REPLACEMENTS:
        replace_function(signal, function.__name__, function)
    replace_function(os, "kill", signals.kill)
    replace_function(os, "_exit", signals.exit_now)
    replace_function(os, "read", terminals.read)
    replace_function(_thread, "interrupt_main", signals.interrupt_main)


def _install_refusals() -> None:
    for name in ("fork", "forkpty"):
        replace_function(os, name, unsupported.processes(f"os.{name}()"))
    for name in ("setitimer", "sigwait", "sigwaitinfo", "sigtimedwait", "set_wakeup_fd", "pthread_kill"):
        replace_function(signal, name, unsupported.signals(f"signal.{name}()"))


def _install_modules() -> None:
    add_finder(ProgramFinder)
    for owner, name in environment.LOOKS_INTO_SYS_MODULES:
        replace_function(owner, name, environment.showing())
    dates_module = clocks.make_module()
    termios = terminals.make_termios()
    own = [termios, terminals.make_tty(termios), terminals.make_select(), terminals.make_fcntl()]
    if os.name == "nt":  # elsewhere programs find out by its absence that they are not on Windows
        own.append(terminals.make_msvcrt())
    for module in (dates_module, *own):
        on_import[module.__name__] = partial(_itself, module)
    for toolkit in unsupported.WINDOWS:
        on_import[toolkit] = partial(unsupported.windows, toolkit)
    on_import["tkinter"] = partial(unsupported.tk_windows, replace_method)
    on_import["curses"] = partial(_made, "curses_screen")
    on_import["pynput"] = partial(_made, "pynput_keyboard")
    on_import["multiprocessing"] = on_import["concurrent"] = _refuse_multiprocessing


def _itself(module: ModuleType) -> ModuleType:
    return module


@cache
def _made(name: str) -> ModuleType:
    """What a module beside this one makes for programs, once one of them asks for it: few do."""
    return importlib.import_module(f".{name}", __package__).make_module()


def _refuse_multiprocessing() -> None:
    """Refuse `multiprocessing` in simulated processes; it is imported for that."""
    kind: Any = importlib.import_module("multiprocessing.process").BaseProcess
    if not is_replaced(kind, "start"):
        replace_method(kind, "start", unsupported.start_process(kind.start))
