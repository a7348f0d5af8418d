"""For all tests, those of the pages too: points are kept in no file, each page begins in a fresh folder, and each test ends.

So no run depends on an earlier one, and no page sees what another one wrote.
"""

from __future__ import annotations

import faulthandler
import gc
import os
import signal
import sys
import tempfile
from collections.abc import Generator, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

os.environ["TURTLE_LESSON_PROGRESS"] = "off"
os.environ.pop("PYTHONDONTWRITEBYTECODE", None)  # or each kernel that a test starts would compile the whole lesson anew
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # numpy starts a thread for each core, in hundreds of processes
gc.disable()  # until all tests are collected, of which nothing is garbage: a fifth of the time that this takes
_folders: dict[Path, tempfile.TemporaryDirectory[str]] = {}

PATIENCE = float(os.environ.get("TURTLE_LESSON_PATIENCE", 600))
"""After how many seconds a test is taken to hang: no verdict on its speed, on however slow a machine."""

if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    # A job in the background (`nohup … &`) ignores Ctrl-C, and so would the kernels whose cells these tests interrupt.
    signal.signal(signal.SIGINT, signal.default_int_handler)

LONG = ("test_learners_folder.py", "browser", "test_answers.py", "test_teaching_grade.py", "test_real_colcon.py",
        "test_story.py", "test_pages_interrupt.py", "test_pages_restart.py", "test_installation.py", "notebooks")  # fmt: skip
"""Files and folders whose tests take longest: they come first, so that no worker is left with one of them at the end.

The first of them loads the window in which other tests of the folder `browser` go on.
"""

STEPS = ("browser", "test_story.py", "notebooks")
"""Files and folders whose tests share a window, a folder or a kernel: each goes on where the one before it has ended."""


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Put what takes longest first; within a file the order stays, for steps also with pytest-random-order."""
    for item in items:
        if any(name in item.path.parts for name in STEPS):
            item.add_marker(pytest.mark.random_order(disabled=True))
    items.sort(key=lambda item: next((at for at, name in enumerate(LONG) if name in item.path.parts), len(LONG)))


def pytest_collection_finish() -> None:
    """Have the garbage collector pass over what is there before the first test, and look less often than by default.

    Collections took some 7 % of the tests' time.
    """
    gc.collect()
    gc.freeze()
    gc.set_threshold(5_000, 20, 20)
    gc.enable()


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config: pytest.Config, log: Any) -> Any:
    """Give a worker whole files, and one of them all that run in a browser, for which it starts JupyterLab once."""
    from xdist.scheduler import LoadFileScheduling

    class Scheduling(LoadFileScheduling):
        def _split_scope(self, nodeid: str) -> str:
            file = super()._split_scope(nodeid)
            return "browser" if "/browser/" in file else file

    return Scheduling(config, log) if config.getvalue("dist") == "loadfile" else None


@contextmanager
def ended_after(seconds: float) -> Iterator[None]:
    """Show all stacks and fail what does not end; again each minute, should that be caught. Not on Windows."""

    def fail(*_: object) -> None:
        faulthandler.dump_traceback(sys.__stderr__)
        pytest.fail(f"this did not end in {seconds:g} seconds")

    if not hasattr(signal, "setitimer"):
        yield
        return
    signal.signal(signal.SIGALRM, fail)
    signal.setitimer(signal.ITIMER_REAL, seconds, 60)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)


@pytest.hookimpl(wrapper=True)
def pytest_runtest_protocol() -> Generator[None, bool, bool]:
    """Have no test hang. One that Python cannot interrupt is ended with its worker (faulthandler_timeout)."""
    with ended_after(PATIENCE):
        return (yield)


@pytest.hookimpl(tryfirst=True)
def pytest_runtest_setup(item: pytest.Item) -> None:
    """Name a fresh folder for the kernel of a page, before nbval starts it; kernels of other tests go where they are put."""
    if item.path.suffix != ".ipynb":
        os.environ.pop("TURTLE_LESSON_FOLDER", None)
    elif item.path not in _folders:
        _folders[item.path] = tempfile.TemporaryDirectory()
        os.environ["TURTLE_LESSON_FOLDER"] = _folders[item.path].name


@pytest.hookimpl(wrapper=True, trylast=True)
def pytest_sessionfinish(exitstatus: int) -> Generator[None, None, None]:
    """Remove the folders; after Ctrl-C go on to the list of what failed, also where something was not closed in order.

    Ctrl-C reaches kernels, browsers and their drivers as well, so fixtures may find nothing to close any more.
    """
    try:
        with ended_after(PATIENCE):
            yield
    except (Exception, pytest.fail.Exception) as error:
        if exitstatus != pytest.ExitCode.INTERRUPTED:
            raise
        print(f"\nInterrupted; not closed in order: {type(error).__name__}: {error}")
    finally:
        for folder in _folders.values():
            folder.cleanup()
