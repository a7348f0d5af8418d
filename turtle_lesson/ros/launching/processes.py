"""The processes of a launch: starting, signalling and ending them, and what launch says about it."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from launch import Event
from launch.events import ExecutionComplete, Shutdown
from launch.events.process import (
    ProcessExited,
    ProcessStarted,
    ProcessStderr,
    ProcessStdout,
    ShutdownProcess,
    SignalProcess,
)
from launch.utilities import perform_substitutions

from ..core import running_strand
from .running import RunningProcess

if TYPE_CHECKING:
    from launch.actions import ExecuteLocal

    from .service import LaunchService

START_UP = 300_000_000
"""How long, in ns, a Python program takes from its process's start to its first line. Those of a launch take turns."""

RESPAWN_PAUSE = 0.25
"""How long, in s, a program that is not Python stays away when it respawns without a delay, so that robot time passes."""


class Processes:
    """All processes of one launch, in the order of their start."""

    def __init__(self, service: LaunchService) -> None:
        self._service = service
        self._all: list[RunningProcess] = []
        self._ending: list[RunningProcess] | None = None
        self.up_at = 0
        """The robot time, in ns, at which the last of the programs that have been started is up."""

    def __iter__(self) -> Iterator[RunningProcess]:
        return iter(self._all)

    @property
    def alive(self) -> list[RunningProcess]:
        """Those that run."""
        return [process for process in self._all if process.alive]

    # -- starting -----------------------------------------------------------------------------------------

    def add(self, action: ExecuteLocal) -> None:
        """Start an action's process."""
        if self._service.context.is_shutdown:
            return
        if action.process_description.cwd:
            self._service.warn_once("here all programs work in the notebook's folder, whatever cwd= says")
        if action.prefix_left_out:
            self._service.warn_once(f"{action.prefix_left_out} is left out: programs run here without a prefix")
        process = RunningProcess(self, self._service.screen, action)
        self._all.append(process)
        self._start(process)

    def _start(self, process: RunningProcess) -> None:
        if not self._service.context.is_shutdown:
            process.start(self._service.world, self._start_up(process))
            self._emit(ProcessStarted(**process.details()))

    def _start_up(self, process: RunningProcess) -> int:
        """How long a process takes until its program begins (ns): Python programs come up one after the other."""
        if not process.is_python:
            return 0
        now = self._service.world.sim.now
        self.up_at = max(self.up_at, now) + START_UP
        return self.up_at - now

    # -- what processes tell ------------------------------------------------------------------------------

    def printed(self, process: RunningProcess, stream: str, text: str) -> None:
        """Pass a process's output to its event handlers (OnProcessIO)."""
        if self._service.context._event_handlers:
            kind = ProcessStdout if stream == "stdout" else ProcessStderr
            self._emit(kind(text=text.encode(), **process.details()))

    def ended(self, process: RunningProcess) -> None:
        """A process is dead: say how, inform the callers that wait for it, start it again if it respawns."""
        if self._ending is not None:
            self._ending.append(process)
            return
        process.last_words()
        if running_strand() is None:
            self._service.carry_on(lambda: self._after_end(process))
        else:  # still within the dying process: leave it first
            self._service.world.sim.call_later(0, self._service.carry_on, lambda: self._after_end(process))

    def _after_end(self, process: RunningProcess) -> None:
        self._emit(ProcessExited(returncode=process.exit_code or 0, **process.details()))
        self._emit(ExecutionComplete(action=process.action))
        if process.wants_respawn() and not self._service.context.is_shutdown:
            process.retries += 1
            pause = process.action.respawn_delay or (0.0 if process.is_python else RESPAWN_PAUSE)
            self._service.call_later(pause, lambda: self._start(process))

    def _emit(self, event: Event) -> None:
        if self._service.context.would_handle_event(event):
            self._service.context.emit_event_sync(event)

    # -- ending -------------------------------------------------------------------------------------------

    def react(self, event: Event) -> None:
        """What launch itself does about an event."""
        if isinstance(event, Shutdown):
            self._end(self.alive, said=not event.due_to_sigint)
        elif isinstance(event, ShutdownProcess):
            self._end([p for p in self.alive if event.process_matcher(p.action)], said=True)
        elif isinstance(event, SignalProcess):
            for process in [p for p in self.alive if event.process_matcher(p.action)]:
                self._announce(process, event.signal_name)
                process.signal(event.signal_name)

    def _announce(self, process: RunningProcess, signal_name: str) -> None:
        text = f"sending signal '{signal_name}' to process[{process.name}]"
        self._service.screen.say("INFO", process.name, text)

    def _end(self, processes: list[RunningProcess], *, said: bool) -> None:
        """Interrupt processes, and see to it that they end. Their last words come after all their output."""
        for process in reversed(processes) if said else ():
            self._announce(process, "SIGINT")
        self._ending = []
        for process in processes:
            process.signal("SIGINT")
        ended, self._ending = self._ending, None
        for process in ended:
            process.last_words()
            self._after_end(process)
        for process in processes:
            if process.alive:
                self._escalate_later(process)

    def _escalate_later(self, process: RunningProcess) -> None:
        patience = perform_substitutions(self._service.context, process.action.sigterm_timeout)

        def escalate() -> None:
            if process.alive:
                how = f"'{patience}' seconds after receiving 'SIGINT', escalating to 'SIGTERM'"
                text = f"process[{process.name}] failed to terminate {how}"
                self._service.screen.say("ERROR", process.name, text)
                self._announce(process, "SIGTERM")
                process.signal("SIGTERM")

        self._service.call_later(float(patience), escalate)
