"""A world: one simulation with one ROS graph, the packages that can be found in it, and its processes; and letting it run.

`start()` makes a fresh one; there is one current world at a time. Code in a simulated process sees the world that the
process lives in; a notebook cell sees the current one, and is itself the process called `notebook`.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from pathlib import Path
from random import Random
from typing import TYPE_CHECKING, Any

from .. import hooks
from ..distro import UNCHECKED_FIELDS, VARIABLE, chosen_release
from ..idl import checks
from ..rmw.graph import Graph
from ..rmw.trace import Trace
from ..sim.errors import SimulationError, is_library
from ..sim.process import Output, Process
from ..sim.run_blocking import drive
from ..sim.simulation import NANOSECONDS, Simulation
from ..sim.strand import running_strand
from ..stdlib import ownership, patches
from ..stdlib.clocks import real_monotonic, real_sleep
from ..stdlib.process_state import encoded
from ..stdlib.program import run_program

if TYPE_CHECKING:
    from ...session.live import Player
    from ..ament.index import PackageIndex

FIRST_PID = 1001


class World:
    """One simulated computer with ROS 2 on it.

    `seed` decides about every random number in it, `distro` which release it behaves as (see `distro.py`).
    """

    def __init__(self, seed: int = 0, distro: str | None = None) -> None:
        self.release = chosen_release(distro)
        checks.when_assigned = not self.release.has(UNCHECKED_FIELDS)
        patches.install()
        hooks.advise_about_errors()
        self.seed = seed
        self.sim = Simulation()
        self.graph = Graph(self.sim, seed)
        self.trace: Trace | None = None
        self.packages: PackageIndex = hooks.package_index()
        self.processes: list[Process] = []
        self.start_order: Random | None = None
        """What draws which program of a launch is started next; None: in the order in which they are written."""
        self.player: Player | None = None
        """What plays this world in live mode."""
        self.at_close: list[Callable[[], object]] = []
        """Called first when the world is closed: what outlives it lets go of it."""
        self._pid = FIRST_PID
        self._names: dict[str, int] = {}
        self.notebook = self._make_process("notebook", argv=["notebook"])
        self.notebook.is_notebook = True

    @property
    def now(self) -> int:
        """The virtual time since the world's start, in ns."""
        return self.sim.now

    def keep_trace(self) -> None:
        """From now on note what new nodes publish, call and run: `trace`."""
        self.trace = self.graph.trace = Trace(self.sim)

    def _make_process(self, name: str, **details: Any) -> Process:
        number = self._names[name] = self._names.get(name, 0) + 1
        process = Process(self.sim, name, pid=self._pid, seed=f"{self.seed}/{name}/{number}", world=self, **details)
        self._pid += 1
        return process

    def spawn(
        self,
        target: Path | Callable[[], object],
        *,
        name: str,
        argv: Sequence[str] = (),
        stdout: Output | None = None,
        stderr: Output | None = None,
        stdin: Any = None,
        on_exit: Callable[[Process], None] | None = None,
        environ: Mapping[str, str] | None = None,
        start_up: int = 0,
    ) -> Process:
        """Start a process at this instant: a Python file, run as `__main__`, or a callable.

        Does not wait for it. The file's errors are the process's: they are shown, and its exit code is 1. Without
        `environ` it has the environment variables of the caller that starts it; it reads `stdin`, a file or pipe, or else
        the keyboard. Its main program begins `start_up` ns later.
        """
        arguments = list(argv) or [str(target) if isinstance(target, Path) else name]
        process = self._make_process(name, argv=arguments, stdout=stdout, stderr=stderr, stdin=stdin, on_exit=on_exit)
        self.processes.append(process)
        process.environ = encoded(environ, VARIABLE, self.release.name)
        process.start(partial(run_program, target) if isinstance(target, Path) else target, start_up)
        return process

    def close(self) -> None:
        """End every process and the simulation; nothing of this world runs again."""
        while self.at_close:  # one that fails does not keep the world from being closed again
            self.at_close.pop(0)()
        for process in [*self.processes, self.notebook]:
            process.close()
        self.sim.close()


_current: World | None = None


def _is_learners(filename: str) -> bool:
    """Whether a file is a learner's own: it lies beside the notebook, or is a module of a package that was sourced."""
    if is_library(filename) or _current is None:
        return False
    folders = [folder for package in _current.packages for folder in (*package.modules, package.prefix) if folder]
    return Path(filename).parent == Path.cwd() or any(Path(filename).is_relative_to(folder) for folder in folders)


ownership.Notebook.process = staticmethod(lambda: None if _current is None else _current.notebook)
ownership.Notebook.is_learners = staticmethod(_is_learners)


def current_process() -> Process:
    """The process that the running code belongs to; for a notebook cell the current world's `notebook`."""
    strand = running_strand()
    return strand.process if strand is not None else current_world().notebook


def current_world() -> World:
    """The world that the running code lives in. If there is none yet, an empty one is made."""
    global _current
    strand = running_strand()
    if strand is not None:
        world: World = strand.process.world
        return world
    if _current is None:
        _current = World()
    return _current


def open_world(seed: int = 0, distro: str | None = None) -> World:
    """Close the current world, if there is one, and make a fresh one the current one."""
    global _current
    if _current is not None:
        _current.close()
    _current = World(seed, distro)
    return _current


# -- letting it run while a command works: as fast as possible, or in live mode at the pace of the clock ---------------


PATIENCE = 2 * 86_400 * NANOSECONDS
"""How long, in ns, a command is waited for: a verb limits its own waits to a day at most."""

LIVE_STEP = 0.02
"""How long, in s, a live world waits between two looks at the clock."""


def live_rate(world: World) -> float | None:
    """How many times as fast as real time the world goes in live mode; None if it is not live, or unpaced."""
    if world.sim.stepped is not None and world.sim.stepped.runs_here:
        return None  # what steps it sees to the pace
    player = world.player
    return player.rate if player is not None and player.playing and math.isfinite(player.rate) else None


def wait_for_end(process: Process, what: str) -> str:
    """Let the world run until the process has ended; it is interrupted if it can never end. Returns why, or nothing.

    `what` is how the wait is called in that sentence. Raises KeyboardInterrupt if the user stops it; the process has been
    interrupted then, too.
    """

    def park() -> None:
        strand = running_strand()
        assert strand is not None
        strand.activity = what
        process.at_exit.append(partial(world.sim.wake, strand))
        world.sim.wait_for(strand, lambda: not process.alive)

    world: World = process.world
    rate = live_rate(world)
    try:
        if rate is None:
            drive(world.notebook, park, limit=PATIENCE)
        else:
            play(world, rate, lambda: not process.alive)
    except SimulationError as error:
        return str(error)
    finally:
        if process.alive:
            process.interrupt()
            process.kill()
    return ""


def run_for(world: World, seconds: float) -> None:
    """Let robot time pass (s); in live mode at its pace."""
    end = world.now + round(seconds * NANOSECONDS)
    rate = live_rate(world)
    if rate is None:
        world.sim.run_until(end)
    else:
        play(world, rate, lambda: world.now >= end, end)


def play(world: World, rate: float, done: Callable[[], bool], end: int | None = None) -> None:
    """Go on at `rate` times real time until it is done, and not beyond `end` (ns)."""
    began, origin = _real_time(world), world.now
    while not done():
        due = max(world.now, origin + round((_real_time(world) - began) * rate * NANOSECONDS))
        world.sim.run_until(due if end is None else min(end, due))
        if not done():
            real_sleep(LIVE_STEP)


def _real_time(world: World) -> float:
    """A real clock (s) that stands still while a program waits for an answer of the user."""
    return real_monotonic() - world.sim.keyboard.seconds_asked
