"""`LaunchService`: carries descriptions out from a program of one's own, without `ros2 launch`."""

from __future__ import annotations

import time
from collections.abc import Iterable

from turtle_lesson.ros import hooks
from turtle_lesson.ros.sim.strand import running_strand

from ._context import Event, LaunchContext
from ._entities import LaunchDescription
from .events import IncludeLaunchDescription

LOOKS = 0.01
"""How often, in s of robot time, it looks whether the launch has ended."""


class LaunchService:
    """Takes descriptions in, and runs until all that they started has ended.

    In a notebook cell `run()` is live, at the pace of the wall clock, until the cell is interrupted.
    """

    def __init__(self, *, argv: Iterable[str] | None = None, noninteractive: bool = False, debug: bool = False) -> None:
        self._launch = hooks.launch_service(hooks.current_world())
        self.context: LaunchContext = self._launch.context
        self.context.argv = list(argv or [])
        self.context.noninteractive = noninteractive
        self._runs = False

    def emit_event(self, event: Event) -> None:
        """Let something count as having happened; before `run()` it waits."""
        self.context._event_queue.append(event)
        if self._runs:
            self._launch.settle_soon()

    def include_launch_description(self, launch_description: LaunchDescription) -> None:
        """Take a description in; before `run()` it waits."""
        self.emit_event(IncludeLaunchDescription(launch_description))

    def run(self, *, shutdown_when_idle: bool = True) -> int:
        """Carry all out until nothing runs any more, or the launch was shut down; 0, or 1 after an error in a description."""
        if running_strand() is not None:
            return self._run(shutdown_when_idle)
        from rclpy._blocking import spin_live

        codes: list[int] = []
        spin_live(lambda: codes.append(self._run(shutdown_when_idle)))
        return codes[0] if codes else 0

    def _run(self, shutdown_when_idle: bool) -> int:
        self._runs = True
        self._launch.say("INFO", "launch", "Default logging verbosity is set to INFO")
        self._launch.carry_on(lambda: None)
        while self._launch.running or not (shutdown_when_idle or self.context.is_shutdown):
            try:
                time.sleep(LOOKS)
            except KeyboardInterrupt:
                if not self.context.is_shutdown:
                    self._launch.interrupt()
        if not self.context.is_shutdown:
            self._launch.shut_down("idle")
        self._runs = False
        return 1 if self._launch.failed else 0

    def shutdown(self) -> None:
        """End the launch; nothing if it does not run."""
        if self._runs and not self.context.is_shutdown:
            self._launch.shut_down("LaunchService.shutdown() called")
