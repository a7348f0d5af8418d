"""Views of one system: pictures that stay, and widgets, each made when it is first asked for; and what a `Lesson` adds to them:
checks, predictions, what happened when, and what is wrong.

Asked for again, a widget is the same one in another place. So a cell that is run twice leaves nothing behind, and two views
of a widget are always in step.
"""

from __future__ import annotations

import contextlib
import dataclasses
import io
import re
import sys
from collections.abc import Callable, Iterator, Sequence
from functools import cache, cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

from ..learner.story import FINISHED
from ..ros.runtime.files import home
from ..ros.sim.errors import format_error
from ..ros.sim.simulation import EPOCH, NANOSECONDS

if TYPE_CHECKING:
    from ..lab.checks.results import CheckResult
    from ..lab.drawing import Picture
    from ..lab.graph import GraphPicture
    from ..lab.predictions import Outcome, Question
    from ..lab.progress import Progress, ProgressFile
    from ..lab.prompts import Prompt
    from ..lab.recorder import ObstacleBoard, Recorder
    from ..lab.troubles.cases import Case
    from ..lab.widgets.dashboard import Dashboard
    from ..lab.widgets.form import Form
    from ..lab.widgets.goal_pad import GoalPad
    from ..lab.widgets.live_plot import LivePlot
    from ..lab.widgets.parameters import ParametersPanel
    from ..lab.widgets.scene import Scene
    from ..lab.widgets.teleop import Teleop
    from ..ros.rmw.trace import Trace
    from ..ros.runtime.world import World
    from .live import SimBackend
    from .robot_backend import RobotBackend

Widget = TypeVar("Widget")


class Views:
    """The pictures and widgets of a running system, whose `_backend` a subclass names."""

    @cached_property
    def _backend(self) -> SimBackend | RobotBackend:
        """One for all widgets, since they share the frames of its loop."""
        raise NotImplementedError

    @property
    def _recording(self) -> Recorder:
        return self._backend.recorder

    def _widget(self, kind: Callable[..., Widget], *arguments: object) -> Widget:
        """The widget of this kind and these arguments; made now if there is none yet."""
        asked = kind, repr(arguments)  # which may be of any type: the widget says what is wrong with them
        widget = self._widgets.get(asked)
        if widget is None or widget.comm is None:  # not made yet, or closed
            from ..lab.widgets.backend import Link

            widget = self._widgets[asked] = kind(Link(self._backend), *arguments)
        return widget

    @cached_property
    def _widgets(self) -> dict[tuple[object, str], Any]:
        """Those that were made, by their kind and arguments; they end with the system."""
        self._backend.at_close.append(self._end_widgets)
        return {}

    def _end_widgets(self) -> None:
        for widget in self._widgets.values():
            widget.end()

    def goal_pad(self) -> GoalPad:
        """A map that is alive: click on it, and the turtle goes there; drag to say how it shall face."""
        from ..lab.widgets.goal_pad import GoalPad

        return self._widget(GoalPad)

    def dashboard(self) -> Dashboard:
        """Everything at once: map, clock, status, scan, rates, nodes, services and log."""
        from ..lab.widgets.dashboard import Dashboard

        return self._widget(Dashboard)

    def teleop(self, topic: str = "/turtle1/cmd_vel") -> Teleop:
        """Drive by hand, with keys or a stick: publishes geometry_msgs/msg/Twist on a topic."""
        from ..lab.widgets.teleop import Teleop

        return self._widget(Teleop, topic)

    def form(self, name: str) -> Form:
        """A form for the messages of a topic, or for the requests of a service: "/turtle1/cmd_vel", "/navigate_to"."""
        from ..lab.widgets.form import Form

        return self._widget(Form, name)

    def live_plot(self, *fields: str, seconds: float = 30.0) -> LivePlot:
        """Curves that go on: a topic and a field each, such as "/robot/status/battery" or "/turtle1/pose/x"."""
        from ..lab.widgets.live_plot import LivePlot

        return self._widget(LivePlot, fields, seconds)

    def parameters(self, node: str) -> ParametersPanel:
        """The parameters of a node, each with a slider or a field: "/navigator"."""
        from ..lab.widgets.parameters import ParametersPanel

        return self._widget(ParametersPanel, node)

    def scene(self) -> Scene:
        """The world in three dimensions."""
        from ..lab.widgets.scene import Scene

        return self._widget(Scene)

    def plot_path(self, *, goal: Any = None) -> Picture:
        """The way that the turtle went, on the map, from /turtle1/pose; `goal`: (x, y), (x, y, theta) or a list of these."""
        from ..lab.path import plot_path

        return plot_path(self._recording, goal=goal)

    def plot_status(self) -> Picture:
        """Position, heading, velocity and battery over time, from what /robot/status said."""
        from ..lab.status_and_scan import plot_status

        return plot_status(self._recording)

    def plot_scan(self) -> Picture:
        """The last scan that /obstacles brought, as the turtle sees it."""
        from ..lab.status_and_scan import plot_scan

        return plot_scan(self._recording)

    def plot_graph(self) -> GraphPicture:
        """Which nodes there are, and by which topics and services they are joined."""
        from ..lab.graph import plot_graph

        return plot_graph(self._recording.node)


MOST_LINES = 20
"""Lines of what programs print while a check looks that are shown; a log alone can be hundreds."""


class Inspection(Views):
    """Checks, points and predictions; troubles, timelines and prompts. A subclass says where to look."""

    _world: World

    @cached_property
    def _board(self) -> ObstacleBoard:
        from ..lab.recorder import ObstacleBoard

        # not by the node's clock: in a simulated world a look at that takes time
        return ObstacleBoard(self._recording, lambda: EPOCH + self._world.now)

    @property
    def _trace(self) -> Trace:
        assert self._world.trace is not None
        return self._world.trace

    def check(self, name: str) -> CheckResult:
        """Look at the running system, and say what an exercise expects of it, what was seen, and what to do next.

        Robot time goes by meanwhile; the result says how much. What the nodes log is not shown, errors are. All
        expectations met earn the check's points, which `progress()` adds up. The more often a check has failed in a
        row, the more the advice says.

        Raises ValueError for a name that no check has.
        """
        from ..lab.checks.registry import find, run
        from .check_target import CheckTarget

        wanted = find(name)
        with _quiet():
            result = run(wanted, CheckTarget(self._world, self._recording, self._board))
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

    def prompt_for(self, kind: str, *, code: Path | Sequence[str | Path] | None = None, lines: int = 12) -> Prompt:
        """A text to copy into any chat with an assistant: specification, code, error, graph and log. Nothing is sent.

        Args:
            kind: "debugging" or "code review".
            code: what it is about: the path of a file or folder, a text, or a list of these.
                Unless told, the learner's own package robot_controller, if there is one.
            lines: how many of the log's last lines.

        The error is the last one of this notebook, and of each program that ended with one.
        """
        from ..lab.graph import plot_graph
        from ..lab.prompts import code_of, compose
        from ..lab.words import number

        if code is None:
            # the learner's own robot_controller, and nothing while there is only the finished one, or none
            packages = self._world.packages
            source = packages.get("robot_controller").source if "robot_controller" in packages else None
            code = [] if source is None or source.resolve() == FINISHED else source
        texts = code_of(code)
        graph = plot_graph(self._recording.node).text
        levels = {10: "DEBUG", 20: "INFO", 30: "WARN", 40: "ERROR", 50: "FATAL"}
        log = [
            f"[{levels.get(level, level)}] [{number(time / NANOSECONDS, 3)}] [{name}]: {text}"
            for time, level, name, text in (list(self._trace.log)[-lines:] if lines > 0 else [])
        ]
        return compose(kind, texts, self._errors(), graph, log, self._trace.now / NANOSECONDS)

    def _errors(self) -> str:
        """The notebook's last error, and those that ended programs, as Python prints them."""
        ended = [(each.name, each.error) for each in self._world.processes if each.error is not None]
        texts = [f"The program {name} ended with:\n{format_error(error)}" for name, error in ended]
        last = getattr(sys, "last_value", None)
        if isinstance(last, Exception) and all(last is not error for _, error in ended):
            texts.append(format_error(last))
        return "\n".join(texts)


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
