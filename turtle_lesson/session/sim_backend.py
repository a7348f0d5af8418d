"""The lab's backend in the simulated world: its hidden node, its recorder and the player of live mode as its clock."""

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
        self.clock: Clock | None = player
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
