"""What a page asks of its reader: exercises with checks and points, and predictions before something is run."""

from __future__ import annotations

import contextlib
import dataclasses
import io
import re
import sys
from collections.abc import Iterator, Sequence
from functools import cache
from typing import TYPE_CHECKING, Any

from ..ros.runtime.files import home

if TYPE_CHECKING:
    from ..lab.checks import CheckResult
    from ..lab.checks.probe import Target
    from ..lab.predictions import Asked, Outcome
    from ..lab.progress import Progress, ProgressFile
    from ..lab.recorder import Recorder


MOST_LINES = 20
"""Lines of what programs print while a check looks that are shown; a log alone can be hundreds."""


class Assessment:
    """Checks, points and predictions. A subclass says where to look: `_make_check_target()` and `_recording`."""

    def _make_check_target(self) -> Target:
        raise NotImplementedError

    @property
    def _recording(self) -> Recorder:
        raise NotImplementedError

    def check(self, name: str) -> CheckResult:
        """Look at the running system, and say what an exercise expects of it, what was seen, and what to do next.

        Robot time goes by meanwhile; the result says how much. What the nodes log is not shown, errors are. All
        expectations met earn the check's points, which `progress()` adds up. The more often a check has failed in a
        row, the more the advice says.

        Raises ValueError for a name that no check has.
        """
        from ..lab import checks

        wanted = checks.find(name)
        with _quiet():
            result = checks.run(wanted, self._make_check_target())
        failures = progress_file().note(result)
        so_far = self.progress().so_far(result.page)
        return dataclasses.replace(result, failures=failures, so_far=so_far)

    def progress(self) -> Progress:
        """The points of all pages so far. They are kept in a small file beside the notebooks."""
        from ..lab.checks import all_checks
        from ..lab.progress import Progress

        file = progress_file()
        return Progress(all_checks(), file.points(), file.remark)

    def predict(
        self,
        name: str,
        question: str,
        *,
        choices: Sequence[str] = (),
        unit: str | None = None,
        on_map: bool = False,
        goal: Any = None,
        guess: Any = None,
    ) -> Asked:
        """Ask for a guess, before something is run; `outcome(name, value)` then shows both side by side.

        Args:
            name: what `outcome` is given.
            question: what is asked, in a sentence.
            choices: one of these texts is to be chosen,
            unit: or a number of this unit given ("m", "messages"; "" for none),
            on_map: or a point (x, y) on the turtle's map, m. Just one of the three.
            goal: a goal that the map is to show, (x, y) in metres or (x, y, theta).
            guess: the guess, unless it is given on the widget that is shown.

        No guess is needed: the page runs without one as well. Asked again after the outcome, the question begins anew.
        """
        from ..lab import predictions
        from ..lab.path import read_goals

        kind = predictions.kind_of(choices, unit, on_map)
        turtle = self._recording.place() if on_map else None
        return predictions.ask(name, question, kind, guess, turtle=turtle, goal=next(iter(read_goals(goal)), None))

    def outcome(self, name: str, value: Any) -> Outcome:
        """What came of it: the reader's guess and the true value, side by side."""
        from ..lab import predictions

        return predictions.tell(name, value)


@cache
def progress_file() -> ProgressFile:
    """The one file of this kernel, beside its notebook."""
    from ..lab import progress

    return progress.progress_file(home())


# -- what programs print while a check looks --------------------------------------------------------------------------------

_ORDINARY = re.compile(r"^(\[[\w.-]+\] )?\[(INFO|DEBUG|WARN)\]")
"""The beginning of a line of a log that is no error."""


@contextlib.contextmanager
def _quiet() -> Iterator[None]:
    """Within this block, of what is printed only errors are shown, and the first few other lines."""
    caught = io.StringIO()
    try:
        with contextlib.redirect_stdout(caught), contextlib.redirect_stderr(caught):
            yield
    finally:
        lines = [line for line in caught.getvalue().splitlines() if line and not _ORDINARY.match(line)]
        for line in lines[:MOST_LINES]:
            print(line, file=sys.stdout)
        if len(lines) > MOST_LINES:
            print(f"… and {len(lines) - MOST_LINES} lines more")
