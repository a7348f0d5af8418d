"""Where a widget stands: a hidden node in a running system, what it has heard, the clock if it can be turned, and endpoints of
its own.

The widgets see nothing else of the system. In the simulation the backend is the lab's node in the simulated world; on a
robot it is a node of the real rclpy (see session/robot_backend.py).
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from time import thread_time
from typing import TYPE_CHECKING, Any

from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from rclpy.task import Future
from rclpy.topic_endpoint_info import TopicEndpointInfo
from rosidl_runtime_py import message_to_yaml

from ..graph import others
from ..words import enumerated, listed, number

if TYPE_CHECKING:
    from ...ros.sim.keyboard import Keyboard
    from ...session.live import Player
    from ..recorder import ObstacleBoard, Recorder
    from .live_widget import LiveWidget

FRAME = 1 / 30
"""Seconds from one frame of the widgets to the next, where they cost little."""

SHARE = 0.035
"""Of one core, what all frames together may take: what costs more, since many widgets are shown, or the computer is slow or
busy, is shown less often. The rest of 5 % goes to the threads that send the messages."""

LONGEST_FRAME = 0.1
"""The longest time from one frame to the next, s."""

NEWS = 0.05
"""How much a frame changes the average: some have much to do that the next ones have not."""


class Link:
    """What a widget sees of its system. Once it is cut, nothing of the system is reached through it, or kept alive.

    A widget outlives its system: on the page, in Jupyter's `Out`, and in the list that ipywidgets keeps.
    """

    node: Node
    """An rclpy Node with a hidden name, spun by its owner; its callbacks happen in the notebook's loop."""
    recorder: Recorder
    """What was heard so far."""
    board: ObstacleBoard
    """The obstacles of the world, and their publisher."""
    clock: Player | None
    """None where the clock cannot be turned, as on a real robot."""
    keyboard: Keyboard | None
    """What the programs of a simulated world read keys from; None on a real robot, whose programs have terminals."""
    now: float
    """Robot time: seconds since the recorder's origin."""

    def __init__(self, backend: Any) -> None:
        """`backend` has all these, too: a `SimBackend` or a `RobotBackend` (see session/)."""
        self.loop: Loop = backend.loop
        self._backend: Any = backend

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


# -- endpoints, made when they are first used ----------------------------------------------------------------------------

PATIENCE = 1.0
"""Robot time, s, for which a message waits until a publisher that was just made has found its listeners."""

DISCOVERY = 2.0
"""Seconds for which a question is held back on a real network, until a new client has found its server."""

LONGEST_WAIT = 60.0
"""Seconds of robot time after which a question counts as not answered."""

LONGEST = 128
"""How many elements or characters of a field are shown of an answer, as `ros2 topic echo` does it."""


class LazyPublisher:
    """Publishes messages of one class on one topic. Until the first message the graph shows nothing of it."""

    def __init__(self, backend: Link, topic: str, message_class: Any, type_name: str) -> None:
        self._backend = backend
        self.topic, self.message_class, self.type_name = topic, message_class, type_name
        self._publisher: Any = None
        self._waiting: list[tuple[float, Any]] = []

    def publish(self, message: Any) -> None:
        """Publish; on a real network the very first messages wait until the listeners were found."""
        if self._publisher is None:
            # reliable; and latched where a listener wants to be told of what was said before it came
            wanted = {end.qos_profile.durability for end in self._others(self.topic)}
            latched, volatile = DurabilityPolicy.TRANSIENT_LOCAL, DurabilityPolicy.VOLATILE
            quality = QoSProfile(depth=10, durability=latched if latched in wanted else volatile)
            self._publisher = self._backend.node.create_publisher(self.message_class, self.topic, quality)
        self._waiting.append((self._backend.now, message))
        self.flush()

    def flush(self) -> None:
        """Publish what waits, if the listeners are found by now."""
        while self._waiting and self._is_ready(self._waiting[0][0]):
            self._publisher.publish(self._waiting.pop(0)[1])

    def close(self) -> None:
        """Leave the topic."""
        self._waiting.clear()
        if self._publisher is not None:
            self._backend.node.destroy_publisher(self._publisher)
            self._publisher = None

    def why_unheard(self) -> str:
        """A sentence that says why no node gets what is published; "" if one does."""
        if self._is_heard_on(self.topic):
            return ""
        if there := self._others(self.topic):
            types = listed(sorted({end.topic_type for end in there}))
            return f"The nodes that listen on {self.topic} expect {types}, not {self.type_name}."
        topics = self._backend.node.get_topic_names_and_types()
        elsewhere = [name for name, types in topics if self.type_name in types and self._is_heard_on(name)]
        hint = f" There are listeners on {enumerated(elsewhere)}." if elsewhere else ""
        return f"No node listens on {self.topic}.{hint}"

    def _others(self, topic: str) -> list[TopicEndpointInfo]:
        return others(self._backend.node, self._backend.node.get_subscriptions_info_by_topic(topic))

    def _is_heard_on(self, topic: str) -> bool:
        return any(end.topic_type == self.type_name for end in self._others(topic))

    def _is_ready(self, since: float) -> bool:
        if not self._is_heard_on(self.topic) or self._backend.now - since >= PATIENCE:
            return True
        own = len(self._backend.node.get_subscriptions_info_by_topic(self.topic)) - len(self._others(self.topic))
        return self._publisher.get_subscription_count() > own  # the recorder's, which is found at once


def let_time_go_on(backend: Link) -> None:
    """Start robot time if it stands still and can be turned, so that what was just asked for is seen to happen."""
    if backend.clock is not None and not backend.clock.playing:
        with suppress(RuntimeError):  # a plain script has no event loop; there time is run by hand
            backend.clock.play(backend.clock.rate)


def in_a_moment(backend: Link, has_come: Callable[[], bool]) -> None:
    """Let at most 0.05 s of robot time pass if it stands still, so that an answer can come."""
    for _ in range(10):
        if backend.clock is None or backend.clock.playing or has_come():
            return
        backend.clock.step(0.005)


class LazyClient:
    """Calls one service, one request at a time. Until the first request the graph shows nothing of it."""

    def __init__(self, backend: Link, service_class: Any, name: str) -> None:
        self._backend, self._class, self._name = backend, service_class, name
        self._client: Any = None
        self._future: Future | None = None
        self._held: Any = None
        self._asked = 0.0
        self._answered: Callable[[str, str], object] = lambda words, answer: None

    @property
    def asking(self) -> bool:
        """Whether it waits for an answer."""
        return self._future is not None or self._held is not None

    def ask(self, request: Any, answered: Callable[[str, str], object]) -> None:
        """Ask; `answered` is told what became of it, in words, and the answer in YAML ("" where none came).

        That is at the latest after `LONGEST_WAIT`.
        """
        if self.asking:
            raise ValueError(f"{self._name} has not answered the last request yet: wait, or stop waiting.")
        self._answered = answered
        if self._client is None:
            self._client = self._backend.node.create_client(self._class, self._name)
        self._asked = self._backend.now
        self._held = request
        self.look()

    def look(self) -> None:
        """See whether the answer is overdue, or can never come."""
        now, request = self._backend.now, self._held
        if request is not None:
            # a real network, where a client finds no server in its first moments
            may_come = self._backend.clock is None and now - self._asked <= DISCOVERY
            if self._client.service_is_ready():
                self._held = None
                self._future = future = self._client.call_async(request)
                future.add_done_callback(self._done)
            elif not may_come:
                self._end(f"Not asked: {self.why_unheard()}")
        elif self._future is not None and now > self._asked + LONGEST_WAIT:
            self._end(f"No answer from {self._name} within {LONGEST_WAIT:g} s of robot time.")
        elif self._future is not None and not self._is_offered():
            self._end(f"No answer: the node that offered {self._name} is gone.")

    def give_up(self) -> None:
        """Wait no more."""
        future, self._future, self._held = self._future, None, None
        if future is not None and self._client is not None:
            self._client.remove_pending_request(future)

    def close(self) -> None:
        """Ask no more."""
        self.give_up()
        if self._client is not None:
            self._backend.node.destroy_client(self._client)
            self._client = None

    def why_unheard(self) -> str:
        """A sentence that says why no node would answer; "" if one would."""
        return "" if self._is_offered() else f"No node offers {self._name} now."

    def _is_offered(self) -> bool:
        """Looks at the graph alone where nothing was asked yet, so that looking leaves no client there."""
        if self._client is not None and self._held is None:
            return self._client.service_is_ready()
        return any(self._name == name for name, _ in self._backend.node.get_service_names_and_types())

    def _done(self, future: Future) -> None:
        if future is self._future:
            seconds = number(self._backend.now - self._asked)
            answer = message_to_yaml(future.result(), truncate_length=LONGEST).strip()
            self._end(f"{self._name} answered after {seconds} s of robot time.", answer)

    def _end(self, words: str, answer: str = "") -> None:
        self.give_up()
        self._answered(words, answer)
