"""Where a widget stands: a hidden node in a running system, what it has heard, and the clock if it can be turned.

The widgets see nothing else of the system. In the simulation the station is the lab's node in the simulated world; on a
robot it is a node of the real rclpy (see robot_station.py).
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Protocol

from .loop import Loop

if TYPE_CHECKING:
    from ...ros.core.keyboard import Keyboard
    from ..obstacle_board import ObstacleBoard
    from ..recorder import Recorder


class Clock(Protocol):
    """A clock that a widget can turn."""

    @property
    def playing(self) -> bool:
        """Whether robot time goes on by itself."""
        ...

    @property
    def rate(self) -> float:
        """How many times as fast as life it goes on, or will when it is played; infinite for as fast as possible."""
        ...

    @rate.setter
    def rate(self, rate: float) -> None: ...

    @property
    def wall_seconds(self) -> float:
        """Seconds of real time for which it has played since `play`."""
        ...

    @property
    def speed(self) -> float:
        """How many times as fast as life it really goes; 0 while it stands still."""
        ...

    def play(self, rate: float) -> None:
        """Let robot time go on by itself."""
        ...

    def pause(self) -> None:
        """Let it stand still."""
        ...

    def step(self, seconds: float) -> None:
        """Let some seconds pass at once."""
        ...


class Station(Protocol):
    """What every widget needs of the system that it shows."""

    node: Any
    """An rclpy Node with a hidden name, spun by somebody else; its callbacks happen in the notebook's loop."""
    recorder: Recorder
    """What was heard so far."""
    board: ObstacleBoard
    """The obstacles of the world, and their publisher."""
    loop: Loop
    """The notebook's event loop."""
    clock: Clock | None
    """None where nobody can turn the clock, as on a real robot."""
    keyboard: Keyboard | None
    """What the programs of a simulated world read keys from; None on a real robot, whose programs have terminals."""
    at_close: list[Callable[[], object]]
    """Called when the system ends, while its node is still there: what outlives the system lets go of it."""

    @property
    def now(self) -> float:
        """Robot time: seconds since the recorder's origin."""
        ...

    @property
    def ended(self) -> bool:
        """Whether this system is gone, so that its widgets have nothing to show any more."""
        ...


class Link:
    """A widget's own link to its station. Once it is cut, nothing of the system is reached through it, or kept alive.

    A widget outlives its system: on the page, in Jupyter's `Out`, and in the list that ipywidgets keeps.
    """

    def __init__(self, station: Station | Any) -> None:
        self.loop: Loop = station.loop
        self._station: Station | Any = station

    @property
    def ended(self) -> bool:
        """Whether the link is cut, or the system is gone."""
        return self._station is None or self._station.ended

    def cut(self) -> None:
        """Let go of the station."""
        self._station = None

    def __getattr__(self, name: str) -> Any:
        if self._station is None:
            raise RuntimeError("this widget has ended, and its system with it: run the cell again that shows it")
        return getattr(self._station, name)
