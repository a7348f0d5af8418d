"""`LaunchService`: carries descriptions out from a program of one's own, without `ros2 launch`."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from turtle_lesson.ros import hooks

from ._context import Event, LaunchContext
from ._entities import LaunchDescription
from .events import IncludeLaunchDescription

if TYPE_CHECKING:
    from turtle_lesson.ros.launching.service import LaunchByHand


class LaunchService:
    """Takes descriptions in, and runs until all that they started has ended.

    In a notebook cell `run()` is live, at the pace of the wall clock, until the cell is interrupted.

    Args:
        argv: words for the context.
        noninteractive: whether it has no terminal.
        debug: accepted; launch prints at its default verbosity here.
    """

    def __init__(self, *, argv: Iterable[str] | None = None, noninteractive: bool = False, debug: bool = False) -> None:
        self.__work: LaunchByHand = hooks.launch_service(list(argv or []), noninteractive)

    @property
    def context(self) -> LaunchContext:
        """What the launch knows."""
        return self.__work.context

    def emit_event(self, event: Event) -> None:
        """Let something count as having happened; before `run()` it waits."""
        self.__work.emit(event)

    def include_launch_description(self, launch_description: LaunchDescription) -> None:
        """Take a description in; before `run()` it waits."""
        self.emit_event(IncludeLaunchDescription(launch_description))

    def run(self, *, shutdown_when_idle: bool = True) -> int:
        """Carry all out until the launch has ended; 0, or 1 after an error in a description.

        Args:
            shutdown_when_idle: whether the launch ends when nothing runs any more and nothing is to come.
        """
        return self.__work.run(shutdown_when_idle)

    async def run_async(self, *, shutdown_when_idle: bool = True) -> int:
        """The same as a coroutine."""
        return await self.__work.run_async(shutdown_when_idle)

    def shutdown(self, force_sync: bool = False) -> None:
        """End the launch; nothing if it does not run."""
        self.__work.shut_down()
