"""What `ros2 run`, `ros2 launch` and a trailing `&` leave running: numbered jobs, as in a terminal."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from ..core import Process

if TYPE_CHECKING:
    from ..launching import LaunchHandle
    from ..world import World

SIGNALS = {"INT": 2, "TERM": 15, "KILL": 9}


class Jobs:
    """The jobs of one world, in the order of their start."""

    def __init__(self) -> None:
        self._jobs: list[Job] = []
        self._count = 0

    def add(self, job: Job) -> Job:
        """Number a new job."""
        self._count += 1
        job.number = self._count
        self._jobs.append(job)
        return job

    @property
    def running(self) -> list[Job]:
        """Those that have not ended."""
        self._jobs = [job for job in self._jobs if job.running]
        return list(self._jobs)

    def like(self, job: Job) -> list[Job]:
        """The other running jobs that were started with the same words."""
        return [each for each in self.running if each is not job and each.words == job.words]

    def get(self, number: int) -> Job | None:
        """The running job of this number."""
        return next((job for job in self.running if job.number == number), None)


@dataclass
class Job:
    """One command that goes on.

    Attributes:
        words: the command, as it was typed.
        what: the process that runs, or the handle of a launch.
        number: its number, as in `%1`.
    """

    words: str
    what: Process | LaunchHandle
    number: int = field(default=0)

    @property
    def running(self) -> bool:
        """Whether it has not ended."""
        return self.what.alive if isinstance(self.what, Process) else self.what.running

    def signal(self, name: str) -> None:
        """Send it INT (Ctrl-C), TERM or KILL."""
        if isinstance(self.what, Process):
            send(self.what, name)
        else:
            self.what.stop()


def send(process: Process, name: str) -> None:
    """Send a process INT (Ctrl-C), TERM or KILL."""
    if name == "INT":
        process.interrupt()
    else:
        process.locals["signal"] = name
        process.kill()


def jobs(world: World) -> Jobs:
    """The jobs of a world."""
    found: Jobs = world.notebook.locals.setdefault("jobs", Jobs())
    return found
