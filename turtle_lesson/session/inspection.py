"""Inspects a running lesson: what happened when, which node called which, what is wrong, and what to ask an assistant."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING, Any

from ..ros.sim.simulation import NANOSECONDS
from .assessment import Assessment

if TYPE_CHECKING:
    from ..lab.graph import GraphPicture
    from ..lab.picture import Picture
    from ..lab.prompts import Prompt
    from ..lab.troubles import Case
    from ..ros.rmw.trace import Trace
    from ..ros.runtime.world import World


class Inspection(Assessment):
    """What a `Lesson` tells about its world from the world's trace and graph."""

    _world: World

    @property
    def _trace(self) -> Trace:
        assert self._world.trace is not None
        return self._world.trace

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
            name: one of `turtle_lesson.lab.troubles.TROUBLES`, such as "turtle stands still".
        """
        from ..lab.troubles import open_case
        from .lesson import FINISHED, _install
        from .trouble_environment import TroubleEnvironment

        environment = TroubleEnvironment(self._world, lambda: _install(self._world, FINISHED))
        return open_case(environment, seed, name, lambda: self.check("trouble"))

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
        from .lesson import FINISHED

        if "robot_controller" not in self._world.packages:
            return []
        source = self._world.packages.get("robot_controller").source
        return [source] if source is not None and source.resolve() != FINISHED else []

    def _errors(self) -> str:
        """The notebook's last error, and those that ended programs, as Python prints them."""
        from ..ros.sim.errors import format_error

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
