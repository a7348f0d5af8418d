"""A probe observes a running system through a node, lets robot time pass, and cleans up after itself.

It listens, calls services, publishes and reads the graph as any node may. It remembers what it has seen (`once`), so that
several expectations can be about the same drive.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Hashable, Iterator, Mapping
from contextlib import AbstractContextManager, contextmanager, suppress
from dataclasses import dataclass
from functools import wraps
from types import TracebackType
from typing import Any, Protocol, TypeVar

from ...ros.sim.interrupts import work_done
from ..recorder import ObstacleBoard, with_time
from ..recording import NANOSECONDS, Recording
from ..words import listed, number
from .failures import ENDLESS, in_words, never_returned, unreturned
from .graph_view import GraphView, filled, interface
from .results import CannotLook, OutOfTime, Stopped

T = TypeVar("T")

PIECE = 0.1
"""Robot time, s, that passes between two looks at how much was computed."""

MOMENT = 0.02
"""Robot time, s, between two looks at whether something has come; after the first few looks it is a PIECE."""

WORK = 60.0
"""CPU time, s, after which a check stops a system that computes too much; a good one needs a few seconds."""

SLACK = 2.0
"""CPU time, s, in which the line of a callback that computes too much is found; after it the check ends without."""

MOST_HEARD = 500_000
"""Messages of one topic that are kept at most."""


class Target(Protocol):
    """The system that is observed."""

    node: Any
    """A node with a hidden name, spun while time passes."""
    board: ObstacleBoard
    """The obstacles in the world, and their publisher."""

    @property
    def recording(self) -> Recording:
        """What was heard of the turtle so far."""

    @property
    def now(self) -> float:
        """Robot time, s."""

    @property
    def ended(self) -> bool:
        """Whether this system is gone."""

    @property
    def errors(self) -> list[tuple[str, Exception]]:
        """The errors that callbacks of the notebook's cells have raised, or that ended a program; with its name, or ""."""

    @property
    def strands(self) -> list[Any]:
        """The lines of execution that wait somewhere."""

    def limit_work(self, seconds: float | None) -> None:
        """Have learner's code stopped after so much more CPU time (s); None: no more."""

    def runs(self, program: str) -> bool:
        """Whether a program of this name is running."""

    @property
    def commands(self) -> list[list[str]]:
        """The command lines of the programs that run, each as its words: what `ps` shows."""

    def published(self, topic: str, by: str) -> int:
        """How many messages a node's newest publisher of a topic has sent so far."""

    def call(self, function: Callable[..., Any], *arguments: Any) -> Any:
        """Call a function of the learner's as a cell would; raises what it raises."""

    def launched(
        self, package: str, file_name: str, namespace: str, renamed: Mapping[str, str], arguments: Mapping[str, object]
    ) -> AbstractContextManager[None]:
        """Within this block a launch file runs once more, its nodes in a namespace, with some names replaced."""

    def step(self, seconds: float) -> None:
        """Let robot time pass."""


@dataclass(frozen=True, slots=True)
class Heard:
    """A message, and when it was sent (robot time, s)."""

    at: float
    message: Any


@dataclass(frozen=True, slots=True)
class Answer:
    """What became of a request: the response (None if none came), and when it was asked and answered (s)."""

    response: Any
    asked: float
    answered: float

    @property
    def seconds(self) -> float:
        """Robot time from the request to the response."""
        return self.answered - self.asked


def remembered(look: Callable[[Probe], T]) -> Callable[[Probe], T]:
    """Decorator: a probe carries `look` out once, and remembers what it gave, or the CannotLook that it raised."""

    @wraps(look)
    def look_once(probe: Probe) -> T:
        return probe.once(look, lambda: look(probe))

    return look_once


class Probe(GraphView):
    """One look at a system, for at most `limit` seconds of robot time."""

    def __init__(self, target: Target, limit: float) -> None:
        self.target = target
        self.node = target.node
        self.began = target.now
        self._until = target.now + limit
        self._limit = limit
        self._work_begin = work_done()
        self._stopped = ""
        self._origin = target.node.get_clock().now().nanoseconds - round(target.now * NANOSECONDS)
        self._memory: dict[Hashable, Any] = {}
        self._clean_up: list[Callable[[], object]] = []
        self._errors_before = [error for _, error in target.errors]
        self.nodes_before: Counter[str] = Counter()
        self.log: list[tuple[int, str, str]] = []
        """Level, name of the logger and text of each line that was logged since the probe began."""

    def __enter__(self) -> Probe:
        self.target.limit_work(WORK)
        self._hear_the_log()
        self.nodes_before = self.nodes()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.target.limit_work(None)
        for each in reversed(self._clean_up):
            with suppress(Exception):  # what is gone already needs no cleaning
                each()

    def at_the_end(self, action: Callable[[], object]) -> None:
        """Have `action` called when the probe is over: to put back what it has changed."""
        self._clean_up.append(action)

    def once(self, key: Hashable, look: Callable[[], T]) -> T:
        """What `look()` gives, or the CannotLook that it raises: the first time it is done, from then on remembered."""
        if key not in self._memory:
            try:
                self._memory[key] = look()
            except CannotLook as reason:
                self._memory[key] = reason
        found = self._memory[key]
        if isinstance(found, CannotLook):
            raise found
        return found

    # -- time --------------------------------------------------------------------------------------------------------

    @property
    def now(self) -> float:
        """Robot time, s."""
        return self.target.now

    def wait(self, seconds: float) -> None:
        """Let robot time pass. Raises OutOfTime where the check has no more of it."""
        end = self.now + seconds
        while self.now < end - 1e-9:
            self._step(min(PIECE, end - self.now))

    def wait_for(self, condition: Callable[[], object], timeout: float) -> bool:
        """Let robot time pass until a condition holds, or the timeout (s) is over; whether it holds."""
        begin, end = self.now, self.now + timeout
        while not condition() and self.now < end - 1e-9:
            self._step(min(MOMENT if self.now - begin < PIECE else PIECE, end - self.now))
        return bool(condition())

    def _step(self, seconds: float) -> None:
        if self.now + seconds > self._until + 1e-9:
            raise OutOfTime(f"the {self._limit:g} s of robot time that this check may take are over")
        if not self._stopped and work_done() - self._work_begin > WORK + SLACK:
            self._stopped = (
                f"{number(self.now - self.began, 1)} s of robot time took {WORK:g} s of computing: is a timer's period "
                "tiny, or does a callback compute for long?"
            )
        self._raise_if_stopped()
        self.target.step(seconds)
        self._raise_if_stopped()

    def _raise_if_stopped(self) -> None:
        """Raise Stopped where the learner's code was stopped because it let no time pass; nothing is tried again."""
        if not self._stopped:
            endless = [error for error in self.errors() if isinstance(error, ENDLESS)]
            self._stopped = never_returned(endless[0]) if endless else ""
        if self._stopped:
            raise Stopped(self._stopped)

    def call(self, function: Callable[..., Any], *arguments: Any) -> Any:
        """Call a function of the learner's. Raises what it raises; Stopped if it computes without end."""
        self._raise_if_stopped()
        try:
            return self.target.call(function, *arguments)
        except ENDLESS as error:
            self._stopped = never_returned(error)
            raise Stopped(self._stopped) from None

    # -- listening ---------------------------------------------------------------------------------------------------

    def listen(self, topic: str, type_name: str) -> list[Heard]:
        """Begin to listen, if it was not done before; returns the list that fills itself.

        Raises CannotLook where no node publishes the topic as this type.
        """
        return self.once(("listen", topic, type_name), lambda: self._listen(topic, type_name))

    def hear(self, topic: str, type_name: str, seconds: float) -> list[Heard]:
        """What is sent on a topic within the next seconds of robot time."""
        heard = self.listen(topic, type_name)
        before = len(heard)
        self.wait(seconds)
        return heard[before:]

    def _listen(self, topic: str, type_name: str) -> list[Heard]:
        types = sorted({kind for _, kind in self.publishers(topic)})
        if not types:
            raise CannotLook(f"no node publishes {topic}{self.like(topic, self.topics())}")
        if type_name not in types:
            raise CannotLook(f"{topic} is published as {listed(types)}, not as {type_name}")
        message_class = interface(type_name)
        heard: list[Heard] = []

        def hear(message: Any, info: Any) -> None:
            if len(heard) < MOST_HEARD:
                heard.append(Heard((info["source_timestamp"] - self._origin) / NANOSECONDS, message))

        self.subscribe(message_class, topic, with_time(self.node, hear))
        return heard

    def subscribe(self, message_class: Any, topic: str, callback: Callable[..., None]) -> None:
        """Call `callback` with each message until the probe is over; best effort, which hears every publisher."""
        from rclpy.qos import QoSProfile, ReliabilityPolicy

        quality = QoSProfile(depth=1000, reliability=ReliabilityPolicy.BEST_EFFORT)
        subscription = self.node.create_subscription(message_class, topic, callback, quality)
        self._clean_up.append(lambda: self.node.destroy_subscription(subscription))

    def _hear_the_log(self) -> None:
        from rcl_interfaces.msg import Log

        def hear(line: Any) -> None:
            level = line.level[0] if isinstance(line.level, bytes) else int(line.level)
            self.log.append((level, line.name, line.msg))

        self.subscribe(Log, "/rosout", hear)

    def errors(self) -> list[Exception]:
        """What the learner's code has raised since the probe began: in a callback of a cell's node, or in a program."""
        return [error for _, error in self.target.errors if all(error is not old for old in self._errors_before)]

    def raise_error(self) -> None:
        """Raise the newest error of the learner's code since the probe began, if there is any."""
        if raised := self.errors():
            raise raised[-1]

    def fallen(self) -> list[str]:
        """The programs that an error had ended before the probe began, each with its error in words: the newest of a name."""
        ended = {name: error for name, error in self.target.errors if name and error in self._errors_before}
        return [f"{name} ended with {in_words(error)}" for name, error in ended.items() if not self.target.runs(name)]

    @property
    def stopped(self) -> str:
        """Why the learner's code was stopped; "" if it was not."""
        return self._stopped

    def unreturned(self) -> str:
        """The callbacks that are not done at this moment, with the line that each is in; "" if there is none."""
        return "; ".join(unreturned(self.target.strands))

    # -- acting ------------------------------------------------------------------------------------------------------

    def publish(self, topic: str, type_name: str, **fields: Any) -> None:
        """Publish one message; nested fields as `linear__x=1.0`."""
        publisher = self.once(("publisher", topic, type_name), lambda: self._publisher(topic, type_name))
        publisher.publish(filled(interface(type_name)(), fields, type_name))

    def _publisher(self, topic: str, type_name: str) -> Any:
        publisher = self.node.create_publisher(interface(type_name), topic, 10)
        self._clean_up.append(lambda: self.node.destroy_publisher(publisher))
        self.wait(0.05)  # so that the subscriptions have found it
        return publisher

    @contextmanager
    def obstacles(self, *added: Any) -> Iterator[None]:
        """Within this block these obstacles stand in the world, too; after it, what stood there before."""
        board = self.target.board
        before = board.obstacles
        board.put([*before, *added])
        try:
            yield
        finally:
            board.put(before)

    def ask(self, service: str, type_name: str, timeout: float, **fields: Any) -> Answer:
        """Call a service, and let robot time pass until it answers or the timeout (s) is over.

        Raises CannotLook where no node offers it as this type.
        """
        answer = self.ask_soon(service, type_name, **fields)
        self.wait_for(answer, timeout)
        return answer() or Answer(None, self.now, self.now)

    def ask_soon(self, service: str, type_name: str, **fields: Any) -> Callable[[], Answer | None]:
        """Call a service without waiting; returns a function that gives the answer once it has come."""
        client = self.once(("client", service, type_name), lambda: self._client(service, type_name))
        request = filled(interface(type_name).Request(), fields, type_name)
        asked, answered = self.now, []
        future = client.call_async(request)
        future.add_done_callback(lambda _: answered.append(self.now))

        def look() -> Answer | None:
            return Answer(future.result(), asked, answered[0]) if answered else None

        return look

    def _client(self, service: str, type_name: str) -> Any:
        types = sorted({kind for _, kind in self.servers(service)})
        if not types:
            raise CannotLook(f"no node offers the service {service}{self.like(service, self.services())}")
        if type_name not in types:
            raise CannotLook(f"{service} is offered as {listed(types)}, not as {type_name}")
        client = self.node.create_client(interface(type_name), service)
        self._clean_up.append(lambda: self.node.destroy_client(client))
        return client
