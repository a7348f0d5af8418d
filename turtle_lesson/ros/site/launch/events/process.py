"""Events about single processes."""

from __future__ import annotations

from typing import Any

from .._context import Event
from .._entities import Action

__all__ = ["ProcessExited", "ProcessIO", "ProcessStarted", "RunningProcessEvent"]


class RunningProcessEvent(Event):
    """Something about a process: its action, name (`navigator-1`), command, environment, number."""

    def __init__(
        self, *, action: Action, name: str, cmd: list[str], cwd: str | None, env: dict[str, str], pid: int
    ) -> None:
        self.action = action
        self.process_name = name
        self.cmd = cmd
        self.cwd = cwd
        self.env = env
        self.pid = pid


class ProcessStarted(RunningProcessEvent):
    """A process has been started."""


class ProcessExited(RunningProcessEvent):
    """A process has ended, with an exit code."""

    def __init__(self, *, returncode: int, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.returncode = returncode


class ProcessIO(RunningProcessEvent):
    """A process has printed something; `text` is bytes, as in the real one."""

    def __init__(self, *, text: bytes, fd: int, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.text = text
        self.from_stdout = fd == 1
        self.from_stderr = fd == 2
