"""What a `Lesson` asks of its reader and tells of its world: checks, predictions, what happened when, and what is wrong."""

from __future__ import annotations

import contextlib
import dataclasses
import io
import re
import sys
from collections.abc import Iterator, Sequence
from functools import cache
from typing import TYPE_CHECKING, Any

from ..learner.story import FINISHED
from ..ros.runtime.files import home
from ..ros.sim.errors import format_error
from ..ros.sim.simulation import NANOSECONDS
from .views import Views

if TYPE_CHECKING:
    from ..lab.checks.probe import Target
    from ..lab.checks.results import CheckResult
    from ..lab.graph import GraphPicture
    from ..lab.picture import Picture
    from ..lab.predictions import Outcome, Question
    from ..lab.progress import Progress, ProgressFile
    from ..lab.prompts import Prompt
    from ..lab.troubles.cases import Case
    from ..ros.rmw.trace import Trace
    from ..ros.runtime.world import World


MOST_LINES = 20
"""Lines of what programs print while a check looks that are shown; a log alone can be hundreds."""


class Inspection(Views):
    """Checks, points and predictions; troubles, timelines and prompts. A subclass says where to look."""

    _world: World

    def _make_check_target(self) -> Target:
        raise NotImplementedError

    @property
    def _trace(self) -> Trace:
        assert self._world.trace is not None
        return self._world.trace

    # -- exercises -----------------------------------------------------------------------------------------------------

    def check(self, name: str) -> CheckResult:
        """Look at the running system, and say what an exercise expects of it, what was seen, and what to do next.

        Robot time goes by meanwhile; the result says how much. What the nodes log is not shown, errors are. All
        expectations met earn the check's points, which `progress()` adds up. The more often a check has failed in a
        row, the more the advice says.

        Raises ValueError for a name that no check has.
        """
        from ..lab.checks.registry import find, run

        wanted = find(name)
        with _quiet():
            result = run(wanted, self._make_check_target())
        failures = progress_file().note(result)
        so_far = self.progress().so_far(result.page)
        return dataclasses.replace(result, failures=failures, so_far=so_far)

    def progress(self) -> Progress:
        """The points of all pages so far. They are kept in a small file beside the notebooks."""
        from ..lab.checks.registry import all_checks
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
    ) -> Question:
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

    # -- what happened, and what is wrong ------------------------------------------------------------------------------

    def plot_timeline(self, *rows: str, since: float | None = None, until: float | None = None) -> Picture:
        """What happened when: a row a topic (a mark a message) and a row a callback (a bar while it runs or sleeps).

        Args:
            rows: topics ("/robot/status"), nodes ("/navigator", all its callbacks) or single callbacks
                ("/navigator.on_pose"); without any, the callbacks of all nodes.
            since, until: seconds of robot time; from the start until now unless told.
        """
        from ..lab.timeline import plot_timeline

        return plot_timeline(self._trace, self._recording.node, *rows, since=since, until=until)

    def plot_sequence(self, *services: str, since: float | None = None, until: float | None = None) -> GraphPicture:
        """Which node called a service, when it was received and answered, and what had to wait meanwhile: a sequence diagram.

        Args:
            services: such as "/navigate_to"; without any, all but those of parameters. The newest eight calls are shown.
            since, until: seconds of robot time at which a call was asked.
        """
        from ..lab.sequence import plot_sequence

        return plot_sequence(self._trace, *services, since=since, until=until)

    def trouble(self, seed: int | None = None, *, name: str | None = None) -> Case:
        """Break the system on purpose, and return the case: what a user reports. All that runs, but the simulator, is ended.

        The system is the learner's own where it is sourced, as after `start(package="mine")`, else the finished one. Files
        are broken in a copy only, in the folder `trouble_ws`, which the next case or the next `start()` removes.
        Mend the running system by commands or code; `case.check()`, or `lesson.check("trouble")`, says whether it is well.

        Args:
            seed: chooses the trouble; with a `name`, the fault behind that symptom. The same seed, the same case.
            name: one of `turtle_lesson.lab.troubles.cases.TROUBLES`, such as "turtle stands still".
        """
        from ..lab.troubles.cases import open_case
        from .trouble_environment import TroubleEnvironment

        return open_case(TroubleEnvironment(self._world), seed, name, lambda: self.check("trouble"))

    def prompt_for(self, kind: str, *, code: Any = None, lines: int = 12) -> Prompt:
        """A text to copy into any chat with an assistant: specification, code, error, graph and log. Nothing is sent.

        Args:
            kind: "debugging" or "code review".
            code: what it is about: the path of a file or folder, a class, a function, a node, a text, or a list of these.
                Unless told, the learner's own package robot_controller, if there is one.
            lines: how many of the log's last lines.

        The error is the last one of this notebook, and of each program that ended with one.
        """
        from ..lab.graph import plot_graph
        from ..lab.prompts import code_of, compose

        texts = code_of(self._own_package() if code is None else code)
        graph = plot_graph(self._recording.node).text
        log = [_log_line(*line) for line in list(self._trace.log)[-lines:]] if lines > 0 else []
        return compose(kind, texts, self._errors(), graph, log, self._trace.now / NANOSECONDS)

    def _own_package(self) -> list[Any]:
        """The folder of the learner's robot_controller; nothing while there is only the finished one, or none."""
        if "robot_controller" not in self._world.packages:
            return []
        source = self._world.packages.get("robot_controller").source
        return [source] if source is not None and source.resolve() != FINISHED else []

    def _errors(self) -> str:
        """The notebook's last error, and those that ended programs, as Python prints them."""
        ended = [(each.name, each.error) for each in self._world.processes if each.error is not None]
        texts = [f"The program {name} ended with:\n{format_error(error)}" for name, error in ended]
        last = getattr(sys, "last_value", None)
        if isinstance(last, Exception) and all(last is not error for _, error in ended):
            texts.append(format_error(last))
        return "\n".join(texts)


def _log_line(time: int, level: int, name: str, text: str) -> str:
    """One line of the log as the terminal shows it, with seconds of robot time."""
    from ..lab.words import number

    word = {10: "DEBUG", 20: "INFO", 30: "WARN", 40: "ERROR", 50: "FATAL"}.get(level, str(level))
    return f"[{word}] [{number(time / NANOSECONDS, 3)}] [{name}]: {text}"


@cache
def progress_file() -> ProgressFile:
    """The one file of this kernel, beside its notebook."""
    from ..lab import progress

    return progress.progress_file(home())


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
