"""`LaunchHandle`: what a cell holds of a launch that it has started."""

from __future__ import annotations

from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

from ..command.driving import run_for
from ..core import NANOSECONDS

if TYPE_CHECKING:
    from ..core import Process
    from .service import LaunchService


class LaunchHandle:
    """A running launch: its processes, and how to stop it."""

    def __init__(self, service: LaunchService, name: str) -> None:
        self._service: LaunchService | Any = service
        self.name = name
        service.world.at_close.append(self._let_go)

    def _let_go(self) -> None:
        """Keep the names, and nothing of the world that is closed: Jupyter's `Out` may keep this handle for long."""
        left = [SimpleNamespace(name=name, alive=False, process=None) for name in self.names]
        self._service = SimpleNamespace(processes=left, running=False)

    @property
    def processes(self) -> list[Process]:
        """Its processes in the order of their start, dead ones included."""
        return [entry.process for entry in self._service.processes if entry.process is not None]

    @property
    def names(self) -> list[str]:
        """What its processes are called in the output, such as `navigator-1`."""
        return [entry.name for entry in self._service.processes]

    @property
    def running(self) -> bool:
        """Whether a process of it runs, or something in it is still to come."""
        return self._service.running

    def wait_until_up(self) -> None:
        """Let robot time pass until the programs that have been started so far are up, one after the other."""
        world = self._service.world
        run_for(world, max(0, self._service.processes.up_at - world.now) / NANOSECONDS)
        world.sim.settle()

    def stop(self) -> None:
        """End it, as Ctrl-C in its terminal would. Does nothing if it has ended already."""
        if self.running:
            text = "user interrupted with ctrl-c (SIGINT)"
            self._service.screen.say("WARNING", "launch", text)
            self._service.shut_down("ctrl-c (SIGINT)", due_to_sigint=True)

    def __repr__(self) -> str:
        alive = [entry.name for entry in self._service.processes if entry.alive]
        state = f"running: {', '.join(alive)}" if alive else "running" if self.running else "ended"
        return f"<Launch of {self.name}, {state}>"
