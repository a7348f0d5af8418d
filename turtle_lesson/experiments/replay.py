"""A run of an experiment, opened in this notebook: it goes on step by step, and is the run that it was.

The function is called in a fresh world of the same seed, in a folder of its own, as a worker does it. It runs in steps
(`ros/sim/stepped_call.py`), between which widgets and pictures of `replay.lesson` show what goes on.

What a worker has and this process has not is the same order of texts in a set: a function that depends on it may end otherwise,
and the replay says so.
"""

from __future__ import annotations

import io
import os
import random
import sys
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager, redirect_stderr, redirect_stdout
from pathlib import Path
from typing import Any

import numpy as np

from ..lab.words import number, same, shortened
from ..ros.runtime import files
from ..ros.sim import errors
from ..ros.sim.errors import WorldClosed
from ..ros.sim.simulation import NANOSECONDS, NEVER
from ..ros.sim.stepped_call import SteppedCall
from ..ros.stdlib.ownership import Notebook
from ..session import views
from ..session.lesson import LONGEST_RUN, Lesson, check_seconds
from .one_run import OK, Ending, ExperimentError, Run, Setting, Tail, call_in, forget_folder, load, open_run, unpack

PROGRESS = "TURTLE_LESSON_PROGRESS"


class Replay:
    """A run that goes on when it is told to.

    Attributes:
        lesson: the run's `Lesson`: its dashboard, timeline and pictures show what goes on. `lesson.run`, `lesson.play` and a
            dashboard's buttons also let the run go on.
    """

    def __init__(
        self,
        setting: Setting,
        run: Run,
        as_row: Callable[[Ending], dict[str, Any]],
        expected: dict[str, Any] | None = None,
    ) -> None:
        self._run, self._as_row, self._expected = run, as_row, expected
        self._ending: Ending | None = None
        self._closed = False
        function = load(setting)
        self._folder = tempfile.TemporaryDirectory(prefix="turtle-lesson-", ignore_cleanup_errors=True)
        place = Path(self._folder.name)
        for name, packed in setting.folders.items():
            unpack(packed, place / name)
        self._surroundings = Surroundings(place)
        with self._surroundings.hold(), self._surroundings.printed():
            self.lesson: Lesson = open_run(setting, run)
        self._world = self.lesson._world
        self._call = SteppedCall(self._world.sim, lambda: self._call_function(function, run), self._surroundings.hold)
        self._world.at_close.append(self._close)

    def _call_function(self, function: Callable[..., Any], run: Run) -> None:
        with self._surroundings.printed():
            ending = call_in(self.lesson, function, run)
        if self._closed:
            return
        self._world.sim.end = NEVER  # the end was the run's; its world may go on beyond it
        ending.printed = "" if ending.outcome == OK else self._surroundings.tail.tail()
        forget_folder(ending, Path(self._folder.name))
        self._ending = ending

    def _close(self) -> None:
        self._closed = True
        self._call.close()
        self._folder.cleanup()

    def step(self, seconds: float = 1.0) -> None:
        """Let the run go on for some robot time, or to its end. The stop button pauses it; the next step goes on from there."""
        check_seconds("replay.step", seconds)
        self._go_on(self._world.now + round(seconds * NANOSECONDS))

    def run(self, until: float | None = None) -> None:
        """Let the run go on until a moment, in seconds of robot time since its start, or to its end."""
        if until is None:
            self._go_on(NEVER)
            return
        if isinstance(until, bool) or not isinstance(until, (int, float)) or not self.now <= until <= LONGEST_RUN:
            raise ValueError(
                f"until must be a moment of robot time in seconds, from {number(self.now, 3)} on, got {until!r}: "
                "a run never goes back; open it anew for that"
            )
        self._go_on(max(self._world.now, round(until * NANOSECONDS)))

    def _go_on(self, until: int) -> None:
        if self._closed:
            raise WorldClosed(
                f"{self._title} has ended here, because a later start() or replay closed its world: open it anew"
            )
        if self.done:
            print(f"{self._title} was over before this: {self._told()}")
            return
        try:
            self._call.go_on(until)
        finally:
            if self.done:
                print(f"{self._title} {self._told()}")

    @property
    def now(self) -> float:
        """Robot time: seconds since the run's start."""
        return self.lesson.now

    @property
    def done(self) -> bool:
        """Whether the run is over."""
        return self._ending is not None

    @property
    def row(self) -> dict[str, Any]:
        """The row of this run as a table has it. Raises ExperimentError while it is not over."""
        if self._ending is None:
            raise ExperimentError(f"{self._title} is not over yet: replay.run() lets it go on to its end")
        return self._as_row(self._ending)

    @property
    def _title(self) -> str:
        return f"Run {self._run.number}"

    def __repr__(self) -> str:
        return f"<Replay of {self._title} at {number(self.now, 3)} s of robot time>"

    def _told(self) -> str:
        """How the run ended, in a sentence, and how that compares with the table."""
        ending = self._ending
        assert ending is not None
        if ending.error.startswith("KeyboardInterrupt"):
            return "was interrupted in the middle of its own code, so it is no replay any more: open it anew."
        how = "" if ending.outcome == OK else f": {ending.error or ending.outcome}"
        at = f"ended at {number(ending.robot_time or 0.0, 3)} s"
        if self._expected is None:
            return f"{at} of robot time{how or ', without an error'}."
        row = self.row
        differing = [name for name, value in row.items() if not same(value, self._expected.get(name))]
        if not differing:
            return f"{at} of robot time, as in the table{how or ', without an error'}."
        name = differing[0]
        there, here = (shortened(repr(each), 60) for each in (self._expected.get(name), row[name]))
        return (
            f"{at} of robot time{how}. That is not as in the table: {name} was {there} there, and is {here} here. "
            "The function, or something that it uses, has changed since then."
        )


def _set_progress(value: str | None) -> None:
    views.progress_file.cache_clear()
    if value is None:
        os.environ.pop(PROGRESS, None)
    else:
        os.environ[PROGRESS] = value


PARTS: tuple[tuple[Callable[[], Any], Callable[[Any], object]], ...] = (
    (files.here, os.chdir),
    (files.places, files.set_places),
    (random.getstate, random.setstate),
    (np.random.get_state, np.random.set_state),
    (lambda: Notebook.is_learners, lambda value: setattr(Notebook, "is_learners", staticmethod(value))),
    (lambda: os.environ.get(PROGRESS), _set_progress),
)
"""What a worker's process has one of: how it is told, and how it is set."""


def _state() -> list[Any]:
    return [get() for get, _ in PARTS]


def _put(state: list[Any]) -> None:
    for (_, put), value in zip(PARTS, state, strict=True):
        put(value)


class Surroundings:
    """What a worker's process has one of, for a function that runs in this one: folder, chance, and where it prints."""

    def __init__(self, folder: Path | None = None) -> None:
        """`folder` is the function's; None: the folder that is the current one already."""
        here, places = (folder, (None, False, None)) if folder else (files.here(), files.places())
        self._state = [here, places, random.getstate(), np.random.get_state(), errors.is_learners, "off"]
        self.tail = Tail()
        self._shown = (sys.stdout, sys.stderr)

    @contextmanager
    def hold(self) -> Iterator[None]:
        """Within this block they are the function's; after it, those of the notebook again."""
        before, self._shown = _state(), (sys.stdout, sys.stderr)
        _put(self._state)
        try:
            yield
        finally:
            self._state = _state()
            _put(before)

    @contextmanager
    def printed(self) -> Iterator[None]:
        """Within this block the end of what is printed is kept, and all of it shown in the notebook's own streams."""
        out, err = _Tee(lambda: self._shown[0], self.tail), _Tee(lambda: self._shown[1], self.tail)
        with redirect_stdout(out), redirect_stderr(err):
            yield


class _Tee(io.TextIOBase):
    """A stream that shows what is printed in another one, and keeps the end of it."""

    def __init__(self, shown: Callable[[], Any], tail: Tail) -> None:
        self._shown, self._tail = shown, tail

    def write(self, text: str) -> int:
        self._tail.write(text)
        self._shown().write(text)
        return len(text)

    def flush(self) -> None:
        if not getattr(self._shown(), "closed", False):  # as it may be when the garbage collector closes this one
            self._shown().flush()
