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
import sys
import threading
import traceback
import zipfile
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from multiprocessing import parent_process
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..ros.sim import errors
from ..ros.stdlib.ownership import Notebook

if TYPE_CHECKING:
    from ..session.lesson import Lesson

OK, RAISED, ROBOT_TIME, CPU_TIME, DIED = "ok", "raised", "robot time", "CPU time", "worker died"
"""How a run can end."""

TAIL = 4000
"""How many characters of what a failed run has printed are kept."""


class ExperimentError(ValueError):
    """An experiment that cannot be carried out as it was asked for."""


@dataclass(frozen=True)
class Setting:
    """What all runs of an experiment share. Each worker gets it once."""

    function: bytes
    """The function, pickled by cloudpickle; unpickled anew for each run, so that no run sees what another one has changed."""
    simulator: bool = True
    robot_time: float = 600.0
    cpu_time: float = 60.0
    folders: dict[str, bytes] = field(default_factory=dict)
    """Zip archives of the learner's folders, by where they belong in the folder of a run."""
    sources: dict[str, str] = field(default_factory=dict)
    """The text of notebook cells by file name, for tracebacks."""


@dataclass(frozen=True)
class Run:
    """One run: what its world is made of, and what the function gets."""

    number: int
    seed: int
    parameters: dict[str, Any] = field(default_factory=dict)
    package: str | None = "finished"
    distro: str | None = None
    start_order: str = "as written"


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
    from ..session.lesson import start

    random.seed(run.seed)
    if "numpy" in sys.modules:
        sys.modules["numpy"].random.seed(run.seed % 2**32)
    return start(run.seed, run.package, setting.simulator, distro=run.distro)


def call_in(lesson: Lesson, function: Callable[..., Any], run: Run) -> Ending:
    """Call the function in its world; what came of it. No error is raised."""
    try:
        ending = Ending(OK, plain_values(function, function(lesson, **run.parameters)))
    except BaseException as error:
        said = str(error).strip().partition("\n")[0]
        line = f"{type(error).__name__}: {said}" if said else type(error).__name__
        ending = Ending(RAISED, error=line, traceback=errors.format_error(error))
    ending.robot_time = round(lesson.now, 9)
    return ending


def plain_values(function: Callable[..., Any], returned: Any) -> dict[str, Any]:
    """What a function has returned, as values that a table can hold. Raises TypeError for anything else."""
    if returned is None:
        return {}
    name = getattr(function, "__name__", "the function")
    if not isinstance(returned, dict):
        raise TypeError(
            f'{name} must return a dict of what was measured, such as {{"seconds": 4.2}}, or nothing, got {returned!r:.80}'
        )
    values = {}
    for key, value in returned.items():
        if not isinstance(key, str):
            raise TypeError(f"{name} must name what it returns by texts, got {key!r:.80}")
        if hasattr(value, "item") and getattr(value, "ndim", None) == 0:
            value = value.item()  # a number of numpy's
        if not (value is None or isinstance(value, (bool, int, float, str))):
            raise TypeError(
                f"{name} must return numbers, texts, True, False or None, got {key!r}: {value!r:.80} "
                f"({type(value).__name__}), which has no place in a table"
            )
        values[key] = value
    return values


# -- in a worker process -------------------------------------------------------------------------------------------------


@dataclass
class _Worker:
    """What this process works on: an experiment, in a folder of its own."""

    setting: Setting
    folder: Path

    @property
    def run_folder(self) -> Path:
        """The current folder of every run: it has the same path each time, so that what was built stays valid."""
        return self.folder / "run"


_worker: _Worker | None = None


def begin(setting: Setting, folder: Path) -> None:
    """Make this process a worker: what each of its runs needs is unpacked once."""
    global _worker
    with contextlib.suppress(AttributeError, PermissionError):
        os.setpgid(0, 0)  # Ctrl-C in the terminal is for the process that waits for this one
    threading.Thread(target=_end_with_parent, daemon=True).start()
    if hasattr(faulthandler, "register"):
        faulthandler.register(signal.SIGUSR1, (folder / "stack").open("w"), all_threads=False)
    os.environ["TURTLE_LESSON_PROGRESS"] = "off"
    for name, text in setting.sources.items():
        linecache.cache[name] = (len(text), None, text.splitlines(keepends=True), name)
    for name, archive in setting.folders.items():
        with zipfile.ZipFile(io.BytesIO(archive)) as files:
            files.extractall(folder / "fresh" / name)
    (folder / "fresh").mkdir(exist_ok=True)
    Notebook.is_learners = staticmethod(errors.is_learners)
    _worker = _Worker(setting, folder)


def _end_with_parent() -> None:
    parent = parent_process()
    if parent is not None:
        parent.join()
        os._exit(1)


def carry_out(run: Run) -> Ending:
    """Carry a run out in this worker process, in a fresh folder. Raises ExperimentError if the function cannot be loaded."""
    assert _worker is not None, "begin() comes first"
    setting, here = _worker.setting, _worker.run_folder
    os.chdir(_worker.folder)
    shutil.rmtree(here, ignore_errors=True)
    shutil.copytree(_worker.folder / "fresh", here, symlinks=True)
    os.chdir(here)
    with _printed() as printed:
        lesson = open_run(setting, run)
        try:
            ending = call_in(lesson, load(setting), run)
        finally:
            lesson._world.close()
    if ending.outcome != OK:
        ending.printed = printed.tail()
    for text in (str(here), os.path.realpath(here)):  # or a row would tell which worker it came from
        ending.error = ending.error.replace(text, ".")
        ending.traceback = ending.traceback.replace(text, ".")
        ending.printed = ending.printed.replace(text, ".")
    return ending


def load(setting: Setting) -> Callable[..., Any]:
    """The experiment's function, unpickled anew."""
    try:
        return pickle.loads(setting.function)
    except BaseException as error:
        said = traceback.format_exception_only(error)[-1].strip()
        raise ExperimentError(f"the function cannot be loaded in a worker process: {said}") from None


class _Tail(io.TextIOBase):
    """A stream of which the end is kept."""

    def __init__(self) -> None:
        self._text = ""

    def write(self, text: str) -> int:
        self._text += text
        if len(self._text) > 4 * TAIL:
            self._text = self._text[-TAIL:]
        return len(text)

    def tail(self) -> str:
        return self._text[-TAIL:]


@contextlib.contextmanager
def _printed() -> Iterator[_Tail]:
    tail = _Tail()
    with contextlib.redirect_stdout(tail), contextlib.redirect_stderr(tail):
        yield tail
