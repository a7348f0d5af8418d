"""Insight into a running lesson: what happened when, who called whom, what is wrong, and what to ask an assistant."""

from __future__ import annotations

from typing import TYPE_CHECKING

from .sourced import HERE

if TYPE_CHECKING:
    from .lab.graph import GraphPicture
    from .lab.picture import Picture
    from .lab.checks import CheckResult
    from .lab.recorder import Recorder
    from .lab.troubles import Case
    from .ros.trace import Trace
    from .ros.world import World

FINISHED = HERE / "robot_controller"


class Insight:
    """What a `Lesson` tells about its world from the world's trace and graph."""

    _world: World

    @property
    def _recording(self) -> Recorder:
        raise NotImplementedError

    def check(self, name: str) -> CheckResult:
        """Look at the running system: see `Desk.check`."""
        raise NotImplementedError

    def _install_finished(self) -> None:
        raise NotImplementedError

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
        from .lab.timeline import plot_timeline

        return plot_timeline(self._trace, self._recording.node, *rows, since=since, until=until)

    def plot_sequence(self, *services: str, since: float | None = None, until: float | None = None) -> GraphPicture:
        """Who called a service, when it was received and answered, and what had to wait meanwhile: as a sequence diagram.

        Args:
            services: such as "/navigate_to"; without any, all but those of parameters. The newest eight calls are shown.
            since, until: seconds of robot time at which a call was asked.
        """
        from .lab.sequence import plot_sequence

        return plot_sequence(self._trace, *services, since=since, until=until)

    def trouble(self, seed: int | None = None, *, name: str | None = None) -> Case:
        """Break the system on purpose, and return the case: what a user reports. All that runs, but the simulator, is ended.

        Mend the running system by commands or code; `case.check()`, or `lesson.check("trouble")`, says whether it is well.

        Args:
            seed: chooses the trouble; with a `name`, the fault behind that symptom. The same seed, the same case.
            name: one of `turtle_lesson.lab.troubles.TROUBLES`, such as "turtle stands still".
        """
        from .lab.troubles import open_case
        from .stage import WorldStage

        stage = WorldStage(self._world, self._install_finished, FINISHED)
        return open_case(stage, seed, name, lambda: self.check("trouble"))
