"""Letting the world run while a command does its work: as fast as possible, or in live mode at the pace of the clock."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

from ..sim.errors import DriveTimeout, SimulationError
from ..sim.process import Process
from ..sim.run_blocking import DRIVE_LIMIT, drive_within
from ..sim.simulation import NANOSECONDS
from ..sim.strand import running_strand
from ..stdlib.clocks import real_monotonic, real_sleep

if TYPE_CHECKING:
    from ..sim.strand import Strand
    from .world import World


LONGEST = 86_400
"""How long, in s, a command may wait at most: a day."""

LIVE_STEP = 0.02
"""How long, in s, a live world waits between two looks at the clock."""


class Pace(Protocol):
    """What plays a world in live mode (`turtle_lesson.session.live.Player`)."""

    rate: float

    @property
    def playing(self) -> bool:
        """Whether robot time goes on by itself."""


@dataclass
class _Live:
    player: Pace | None = None


def set_player(world: World, player: Pace) -> None:
    """Say who plays this world in live mode."""
    world.notebook.state(_Live).player = player


def live_rate(world: World) -> float | None:
    """How many times as fast as real time the world goes in live mode; None if it is not live, or unpaced."""
    if world.sim.stepped is not None and world.sim.stepped.runs_here:
        return None  # what steps it sees to the pace
    player = world.notebook.state(_Live).player
    return player.rate if player is not None and player.playing and math.isfinite(player.rate) else None


class Waiter:
    """Waits until a process has ended. Its `ended` is the process's `on_exit`."""

    def __init__(self, world: World, what: str) -> None:
        self._world = world
        self._what = what
        self._strand: Strand | None = None
        self._live = False

    def ended(self, process: Process) -> None:
        """The process is dead: the callers that wait for it continue."""
        if self._strand is not None:
            self._world.sim.wake(self._strand)
        elif self._live:
            self._world.sim.halt()

    def wait(self, process: Process) -> str:
        """Let the world run until the process has ended; it is interrupted if it can never end. Returns why, or nothing.

        Raises:
            KeyboardInterrupt: if the user stops it; the process has been interrupted then, too.
        """
        rate = live_rate(self._world)
        try:
            if rate is None:
                self._drive(process)
            else:
                self._live = True
                _play(self._world, rate, lambda: not process.alive)
        except SimulationError as error:
            process.interrupt()
            return str(error)
        except KeyboardInterrupt:
            process.interrupt()
            raise
        finally:
            self._strand, self._live = None, False
            if process.alive:
                process.kill()
        return ""

    def _drive(self, process: Process) -> None:
        """Run as fast as possible. A verb limits its own waits: one that goes on for longer was told so, for a day or two."""
        simulation = self._world.sim
        end = simulation.now + round(2 * LONGEST * NANOSECONDS)
        while process.exit_code is None:
            begun = simulation.now
            try:
                drive_within(DRIVE_LIMIT, simulation, self._world.notebook, self._park, process)
            except DriveTimeout:
                if begun > end:
                    raise
                simulation.run_until(begun + DRIVE_LIMIT)

    def _park(self, process: Process) -> None:
        self._strand = strand = running_strand()
        assert strand is not None
        strand.activity = self._what
        while process.exit_code is None:
            strand.simulation.park(strand)


def run_for(world: World, seconds: float) -> None:
    """Let robot time pass (s); in live mode at its pace."""
    end = world.now + round(seconds * NANOSECONDS)
    rate = live_rate(world)
    if rate is None:
        world.sim.run_until(end)
    else:
        _play(world, rate, lambda: world.now >= end, end)


def _play(world: World, rate: float, done: Callable[[], bool], end: int | None = None) -> None:
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
