"""Where a widget stands: a hidden node in a running system, what it has heard, and the clock if it can be turned.

The widgets see nothing else of the system. In the simulation the backend is the lab's node in the simulated world; on a
robot it is a node of the real rclpy (see session/robot_backend.py).
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from dataclasses import dataclass
from time import thread_time
from typing import TYPE_CHECKING, Any, Protocol

if TYPE_CHECKING:
    from rclpy.node import Node

    from ...ros.sim.keyboard import Keyboard
    from ..recorder import ObstacleBoard, Recorder
    from .live_widget import LiveWidget


FRAME = 1 / 30
"""Seconds from one frame of the widgets to the next, where they cost little."""

SHARE = 0.035
"""Of one core, what all frames together may take: what costs more, since many widgets are shown, or the computer is slow or
busy, is shown less often. The rest of 5 % goes to the threads that send the messages."""

LONGEST_FRAME = 0.1
"""But it is shown so often at least, s."""

NEWS = 0.05
"""How much a frame changes the average: some have much to do that the next ones have not."""


class Clock(Protocol):
    """A clock that a widget can turn."""

    @property
    def playing(self) -> bool:
        """Whether robot time goes on by itself."""

    @property
    def rate(self) -> float:
        """How many times as fast as life it goes on, or will when it is played; infinite for as fast as possible."""

    @rate.setter
    def rate(self, rate: float) -> None: ...

    @property
    def wall_seconds(self) -> float:
        """Seconds of real time for which it has played since `play`."""

    @property
    def speed(self) -> float:
        """How many times as fast as life it really goes; 0 while it stands still."""

    def play(self, rate: float) -> None:
        """Let robot time go on by itself."""

    def pause(self) -> None:
        """Let it stand still."""

    def step(self, seconds: float) -> None:
        """Let some seconds pass at once."""


class Backend(Protocol):
    """What every widget needs of the system that it shows."""

    node: Node
    """An rclpy Node with a hidden name, spun by its owner; its callbacks happen in the notebook's loop."""
    recorder: Recorder
    """What was heard so far."""
    board: ObstacleBoard
    """The obstacles of the world, and their publisher."""
    loop: Loop
    """The notebook's event loop."""
    clock: Clock | None
    """None where the clock cannot be turned, as on a real robot."""
    keyboard: Keyboard | None
    """What the programs of a simulated world read keys from; None on a real robot, whose programs have terminals."""
    at_close: list[Callable[[], object]]
    """Called when the system ends, while its node is still there: what outlives the system lets go of it."""

    @property
    def now(self) -> float:
        """Robot time: seconds since the recorder's origin."""

    @property
    def ended(self) -> bool:
        """Whether this system is gone, so that its widgets have nothing to show any more."""


class Link:
    """A widget's own link to its backend. Once it is cut, nothing of the system is reached through it, or kept alive.

    A widget outlives its system: on the page, in Jupyter's `Out`, and in the list that ipywidgets keeps.
    """

    def __init__(self, backend: Backend | Any) -> None:
        self.loop: Loop = backend.loop
        self._backend: Backend | Any = backend

    @property
    def ended(self) -> bool:
        """Whether the link is cut, or the system is gone."""
        return self._backend is None or self._backend.ended

    def cut(self) -> None:
        """Let go of the backend."""
        self._backend = None

    def __getattr__(self, name: str) -> Any:
        if self._backend is None:
            raise RuntimeError("this widget has ended, and its system with it: run the cell again that shows it")
        return getattr(self._backend, name)


Message = tuple["LiveWidget", dict[str, Any], list[bytes]]
"""A widget, what it has to say to its views, and the buffers that go with it."""


class Loop:
    """The event loop of the cell in which this is made; without one (a plain script) calls happen at once.

    A message from the browser may arrive in another thread with a loop of its own (ipykernel 7 with JupyterLab 4.6 does so
    now and then), and a greenlet cannot change its thread. So what views ask for is done in the loop in which cells run.
    """

    def __init__(self) -> None:
        try:
            self._loop: asyncio.AbstractEventLoop | None = asyncio.get_running_loop()
        except RuntimeError:
            self._loop = None
        self._actions: dict[object, _Action] = {}
        self._next: asyncio.TimerHandle | None = None
        self.outbox: list[Message] | None = None
        """What the widgets have to say in this frame; None between frames. It travels together, since each message that a
        kernel sends costs half a millisecond."""
        self._cost = 0.0  # of a frame, seconds of this thread's processor time, on average

    def soon(self, action: Callable[..., object], *arguments: Any) -> None:
        """Have the loop call `action`, whichever thread this is. Actions keep their order."""
        if self._loop is None:
            action(*arguments)
        else:
            self._loop.call_soon_threadsafe(action, *arguments)

    def every(self, seconds: float, action: Callable[[], object]) -> Callable[[], object]:
        """Call `action` at a frame every so many seconds, until what this returns is called.

        The actions of one frame follow each other at once, so that the kernel is woken once for all, and so are the threads
        that send its messages. Without a loop nothing is called.
        """
        key = object()
        self._actions[key] = _Action(seconds, action)
        if self._loop is not None and self._next is None:
            self._next = self._loop.call_later(FRAME, self._frame, self._loop)
        return lambda: self._actions.pop(key, None)

    def _frame(self, loop: asyncio.AbstractEventLoop) -> None:
        """Have the next frame called first: an action that raises, or is interrupted, ends this frame only."""
        assert self._next is not None
        now, began = loop.time(), thread_time()
        pause = min(max(FRAME, self._cost / SHARE), LONGEST_FRAME)
        self._next = loop.call_at(max(self._next.when() + pause, now), self._frame, loop) if self._actions else None
        outbox: list[Message] = []
        self.outbox = outbox
        try:
            for each in list(self._actions.values()):
                if now >= each.due:
                    each.due = now + each.seconds - FRAME / 2
                    each.action()
        finally:
            self.outbox = None
            if outbox:
                outbox[0][0].send_together(outbox)
        self._cost += (thread_time() - began - self._cost) * NEWS


@dataclass(slots=True)
class _Action:
    seconds: float
    action: Callable[[], object]
    due: float = 0.0
