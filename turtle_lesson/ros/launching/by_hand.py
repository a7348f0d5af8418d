"""What is behind `launch.LaunchService`: a launch that a program, or a notebook cell, waits for."""

from __future__ import annotations

import asyncio
import time
from collections import deque

from launch import Event, LaunchContext
from launch.actions import EmitEvent

from ..core import running_strand
from ..world import current_world
from .errors import LaunchError
from .service import LaunchService

LOOKS = 0.01
"""How often, in s of robot time, it looks whether the launch has ended."""


class LaunchByHand:
    """One launch in the world that the running code lives in."""

    def __init__(self, argv: list[str], noninteractive: bool) -> None:
        self._service = LaunchService(current_world(), {})
        self.context: LaunchContext = self._service.context
        self.context.argv = argv
        self.context.noninteractive = noninteractive
        self._early: deque[Event] = deque()
        self._began = False
        self._failed = False

    def emit(self, event: Event) -> None:
        """Emit an event; before the launch has begun, it waits."""
        if self._began:
            self.context.emit_event_sync(event)
        else:
            self._early.append(event)

    def run(self, shutdown_when_idle: bool) -> int:
        """Carry all out and wait for the end; the exit code."""
        if running_strand() is not None:
            return self._run(shutdown_when_idle)
        from rclpy._blocking import spin_live

        codes: list[int] = []
        spin_live(lambda: codes.append(self._run(shutdown_when_idle)))
        return codes[0] if codes else 0

    def _run(self, shutdown_when_idle: bool) -> int:
        self._begin()
        while self._goes_on(shutdown_when_idle):
            try:
                time.sleep(LOOKS)
            except KeyboardInterrupt:
                self._interrupted()
        return self._code()

    async def run_async(self, shutdown_when_idle: bool) -> int:
        """The same as a coroutine."""
        self._begin()
        while self._goes_on(shutdown_when_idle):
            await asyncio.sleep(LOOKS)
        return self._code()

    def _begin(self) -> None:
        self._began = True
        while self._early and not self._failed:
            try:
                self._service.begin(EmitEvent(event=self._early.popleft()))
            except LaunchError as error:
                self._failed = True
                for line in filter(None, (error.console, error.advice)):
                    self._service.screen.line(line)

    def _goes_on(self, shutdown_when_idle: bool) -> bool:
        service = self._service
        return service.running or not (shutdown_when_idle or self.context.is_shutdown)

    def _code(self) -> int:
        if not self.context.is_shutdown:
            self._service.shut_down("idle")
        self._began = False
        return 1 if self._failed or self._service.failed else 0

    def _interrupted(self) -> None:
        if not self.context.is_shutdown:
            self._service.screen.say("WARNING", "launch", "user interrupted with ctrl-c (SIGINT)")
            self._service.shut_down("ctrl-c (SIGINT)", due_to_sigint=True)

    def shut_down(self) -> None:
        """End it, if it runs."""
        if self._began and not self.context.is_shutdown:
            self._service.shut_down("LaunchService.shutdown() called")
