"""One run of an experiment: a fresh world, the function called in it, and what came of it. Worker processes do nothing else."""

from __future__ import annotations

import contextlib
import faulthandler
import io
import linecache
import os
import pickle
import random
import shutil
import signal
import threading
import zlib
from collections.abc import Callable
from dataclasses import dataclass, field
from importlib import import_module
from multiprocessing import parent_process
from pathlib import Path
from traceback import format_exception_only
from typing import TYPE_CHECKING, Any
from uuid import uuid4

from ..ros.sim import errors
from ..ros.sim.simulation import NANOSECONDS
from ..ros.stdlib.ownership import Notebook
from ..session import views

if TYPE_CHECKING:
    from ..session.lesson import Lesson

OK, RAISED, ROBOT_TIME, CPU_TIME, DIED = "ok", "raised", "robot time", "CPU time", "worker died"
"""How a run can end."""

VERSION: str = import_module("turtle_lesson").__version__  # the package itself imports no room before it is used

STACK = "stack"
"""The file in a worker's folder to which it writes where it is, when it is asked by SIGUSR1."""

FIRST = ("run", "seed")
LAST = ("robot_time", "error", "traceback", "printed")
"""The columns at the beginning of a table, and at the end. Between them are what was swept, the outcome and what the function
returned."""

OWN = (*FIRST, "outcome", *LAST)

PLAIN = (bool, int, float, str, type(None))
"""The types of what a table holds."""

TAIL = 4000
"""How many characters of what a failed run has printed are kept."""


class ExperimentError(ValueError):
    """An experiment that cannot be carried out as it was asked for."""


@dataclass(frozen=True)
class Setting:
    """What all runs of an experiment share. Each worker gets it once."""

    function: bytes
    """The function, pickled by cloudpickle; unpickled anew for each run, so that no run sees what another one has changed."""
    package: str | None = "finished"
    """As for `start`; a folder is one of `folders`."""
    simulator: bool = True
    distro: str | None = None
    start_order: str = "as written"
    robot_time: float = 600.0
    cpu_time: float = 60.0
    folders: dict[str, bytes] = field(default_factory=dict)
    """Archives of the learner's folders, by where they belong in the folder of a run."""
    sources: dict[str, str] = field(default_factory=dict)
    """The texts of the notebook's cells and the learner's files, by file name, for tracebacks."""
    key: str = field(default_factory=lambda: uuid4().hex)
    """What tells this experiment from others."""


@dataclass(frozen=True)
class Run:
    """One run: the seed of its world, and what the function gets."""

    number: int
    seed: int
    parameters: dict[str, Any] = field(default_factory=dict)


@dataclass
class Ending:
    """What came of a run."""

    outcome: str
    values: dict[str, Any] = field(default_factory=dict)
    """What the function has returned."""
    robot_time: float | None = None
    """When it ended, in seconds of robot time."""
    error: str = ""
    """What went wrong, in one line."""
    traceback: str = ""
    printed: str = ""
    """The last that a failed run has printed."""


def open_run(setting: Setting, run: Run) -> Lesson:
    """The fresh world of a run, in which the function has not been called yet."""
    import numpy

    from ..session.lesson import start

    random.seed(run.seed)
    numpy.random.seed(run.seed % 2**32)
    lesson = start(run.seed, setting.package, setting.simulator, distro=setting.distro, start_order=setting.start_order)
    lesson._world.sim.end = round(setting.robot_time * NANOSECONDS)
    return lesson


def call_in(lesson: Lesson, function: Callable[..., Any], run: Run) -> Ending:
    """Call the function in its world; what came of it. No error is raised."""
    try:
        ending = _returned(function, function(lesson, **run.parameters))
    except errors.OutOfTime as error:
        ending = Ending(ROBOT_TIME, error=f"the run was not over when {error}", traceback=errors.format_error(error))
    except BaseException as error:
        said = f"{type(error).__name__}: {str(error).strip()}".partition("\n")[0].removesuffix(": ")
        ending = Ending(RAISED, error=said, traceback=errors.format_error(error))
    ending.robot_time = lesson.now
    return ending


def name_of(function: Any) -> str:
    """What messages call a function."""
    return getattr(function, "__name__", None) or "the function"


def plain(value: Any) -> Any:
    """A value as a table holds it: numbers of Python's own for numpy's, tuples for lists."""
    if isinstance(value, (list, tuple)):
        return tuple(map(plain, value))
    return value.item() if hasattr(value, "item") and getattr(value, "ndim", None) == 0 else value


def _returned(function: Callable[..., Any], returned: Any) -> Ending:
    """The end of a run whose function has returned this: values that a table can hold, or a mistake without a traceback."""
    if returned is None:
        return Ending(OK)
    name = name_of(function)
    values = {key: plain(value) for key, value in returned.items()} if isinstance(returned, dict) else {}
    wrong = [key for key, value in values.items() if not (isinstance(key, str) and isinstance(value, PLAIN))]
    if wrong or not isinstance(returned, dict):
        got = f"{wrong[0]!r}: {returned[wrong[0]]!r}" if wrong else repr(returned)
        said = f"TypeError: {name} must return a dict of numbers, texts, True, False or None by their names, such as "
        return Ending(RAISED, error=f'{said}{{"seconds": 4.2}}, or nothing, got {got:.80}')
    if own := [key for key in values if key in OWN]:
        said = f"TypeError: {name} returned {own[0]!r}, a column that each table has already: give it another name"
        return Ending(RAISED, error=said)
    return Ending(OK, values)


# -- in a worker process -------------------------------------------------------------------------------------------------


def unpack(packed: bytes, folder: Path) -> None:
    """Write the files of an archive into a folder."""
    folder.mkdir(parents=True, exist_ok=True)
    for place, (mode, data) in pickle.loads(zlib.decompress(packed)).items():
        path = folder / place
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(data)
        path.chmod(mode)


_setting: Setting | None = None
"""What this process works on, in its current folder: `fresh` there holds what each run finds in its folder, and `run` is that
folder. Its path is the same for each run, so that a workspace which the first one has built stays built."""


def begin(setting: Setting, folder: Path) -> None:
    """Make this process a worker: what each of its runs needs is made once."""
    global _setting
    with contextlib.suppress(AttributeError, PermissionError):
        os.setpgid(0, 0)  # Ctrl-C in a terminal is for the process that waits for this one
    threading.Thread(target=_end_with_parent, args=(folder,), daemon=True).start()
    if hasattr(faulthandler, "register"):
        faulthandler.register(signal.SIGUSR1, (folder / STACK).open("w"), all_threads=False)
    for name, text in setting.sources.items():
        linecache.cache[name] = (len(text), None, text.splitlines(keepends=True), name)
    Notebook.is_learners = staticmethod(errors.is_learners)
    os.environ["TURTLE_LESSON_PROGRESS"] = "off"
    (folder / "fresh").mkdir()
    for name, packed in setting.folders.items():
        unpack(packed, folder / "fresh" / name)
    os.chdir(folder)
    _setting = setting


def is_worker() -> bool:
    """Whether this process is a worker."""
    return _setting is not None


def _end_with_parent(folder: Path) -> None:
    parent = parent_process()
    if parent is not None:
        parent.join()
        shutil.rmtree(folder, ignore_errors=True)
        os._exit(1)


def carry_out(run: Run) -> Ending:
    """Carry a run out in this worker process, in a fresh folder. Raises ExperimentError if the function cannot be loaded."""
    assert _setting is not None, "begin() comes first"
    place = Path.cwd()
    fresh, here = place / "fresh", place / "run"
    shutil.rmtree(here, ignore_errors=True)
    shutil.copytree(fresh, here)
    os.chdir(here)
    printed = Tail()
    with contextlib.redirect_stdout(printed), contextlib.redirect_stderr(printed):
        lesson = open_run(_setting, run)
        try:
            if (here / "workspace" / "install").is_dir() and not (fresh / "workspace" / "install").is_dir():
                shutil.rmtree(fresh / "workspace")  # further runs find the workspace built
                shutil.copytree(here / "workspace", fresh / "workspace", symlinks=True)
            ending = call_in(lesson, load(_setting), run)
        finally:
            lesson._world.close()
            views.progress_file.cache_clear()
            os.chdir(place)
    ending.printed = "" if ending.outcome == OK else printed.tail()
    forget_folder(ending, here)
    return ending


def forget_folder(ending: Ending, folder: Path) -> None:
    """Take out the folder of a run, by which a row would tell where it was carried out."""
    for text in {str(folder), os.path.realpath(folder)}:
        ending.error = ending.error.replace(text, ".")
        ending.traceback = ending.traceback.replace(text, ".")
        ending.printed = ending.printed.replace(text, ".")


def load(setting: Setting) -> Callable[..., Any]:
    """The experiment's function, unpickled anew."""
    try:
        return pickle.loads(setting.function)
    except Exception as error:
        said = "".join(format_exception_only(error)).strip()
        raise ExperimentError(f"the function cannot be loaded in a worker process: {said}") from None


class Tail(io.TextIOBase):
    """A stream of which the end is kept."""

    def __init__(self) -> None:
        self._text = ""

    def write(self, text: str) -> int:
        """Take a text."""
        self._text += text
        if len(self._text) > 4 * TAIL:
            self._text = self._text[-TAIL:]
        return len(text)

    def tail(self) -> str:
        """What was printed last."""
        return self._text[-TAIL:]
