"""The lab's backend in the simulated world: its hidden node, and a clock that a page can turn."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ..lab.widgets.backend import Clock, Loop
from ..ros.sim.simulation import NANOSECONDS

if TYPE_CHECKING:
    from ..lab.obstacle_board import ObstacleBoard
    from ..lab.recorder import Recorder
    from ..ros.runtime.world import World
    from ..ros.sim.keyboard import Keyboard
    from .live import Player


class SimBackend:
    """A `Backend` (see lab/widgets/backend.py) in a world of this notebook."""

    def __init__(self, world: World, recorder: Recorder, player: Player, board: ObstacleBoard) -> None:
        self._world = world
        self.recorder = recorder
        self.board = board
        self.node: Any = recorder.node
        self.clock: Clock | None = RobotClock(world, player)
        self.keyboard: Keyboard | None = world.sim.keyboard
        self.loop = Loop()
        self.at_close = world.at_close

    @property
    def now(self) -> float:
        """Robot time: seconds since the world began."""
        return self._world.now / NANOSECONDS

    @property
    def ended(self) -> bool:
        """Whether a newer `start()` has taken this world's place."""
        return self._world.sim.closed


class RobotClock:
    """The clock of a world."""

    def __init__(self, world: World, player: Player) -> None:
        self._world, self._player = world, player

    @property
    def playing(self) -> bool:
        """Whether robot time goes on by itself."""
        return self._player.playing

    @property
    def rate(self) -> float:
        """How many times as fast as life it goes on, or will when it is played; infinite for as fast as possible."""
        return self._player.rate

    @rate.setter
    def rate(self, rate: float) -> None:
        self._player.rate = rate

    @property
    def wall_seconds(self) -> float:
        """Seconds of real time for which it has played since `play`."""
        return self._player.wall_seconds

    @property
    def speed(self) -> float:
        """How many times as fast as life it really goes."""
        return self._player.speed if self._player.playing else 0.0

    def play(self, rate: float) -> None:
        """Let robot time go on by itself, at `rate` times real time."""
        self._player.play(rate)

    def pause(self) -> None:
        """Let it stand still."""
        self._player.pause()

    def step(self, seconds: float) -> None:
        """Let some seconds pass at once."""
        self._world.sim.run_until(self._world.now + round(seconds * NANOSECONDS))
