"""A probe observes a running system through a node, lets robot time pass, and cleans up after itself.

It listens, calls services, publishes and reads the graph as any node may. It remembers what it has seen (`remembered`), so that
several expectations can be about the same drive.
"""

from __future__ import annotations

import importlib
from collections import Counter
from collections.abc import Callable, Hashable, Iterator
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import dataclass
from functools import reduce, wraps
from typing import TYPE_CHECKING, Any, Concatenate, ParamSpec, TypeVar

from rcl_interfaces.msg import Log
from rclpy.client import Client
from rclpy.publisher import Publisher
from rclpy.qos import QoSProfile, ReliabilityPolicy
from rclpy.topic_endpoint_info import TopicEndpointInfo

from ...ros.idl.names import is_hidden, nearest
from ...ros.sim.interrupts import work_done
from ...turtlesim.obstacles import Box, Circle
from ..graph import node_names, of_node, others, owner, servers
from ..recording import NANOSECONDS
from ..words import listed, number
from .results import ENDLESS, CannotLook, Seen, Stopped, in_words, never_returned, unreturned

if TYPE_CHECKING:
    from ...session.check_target import CheckTarget

P = ParamSpec("P")
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

    @property
    def told(self) -> str:
        """What it says of its success, and when it came."""
        return f"success is {self.response.success} after {number(self.seconds)} s"


def interface(type_name: str) -> Any:
    """The class of a type such as "std_msgs/msg/String". Raises CannotLook where it cannot be imported."""
    package, kind, name = type_name.split("/")
    try:
        return getattr(importlib.import_module(f"{package}.{kind}"), name)
    except Exception as error:  # a package that was built badly can raise anything
        reason = " ".join(str(error).split())[:160]
        raise CannotLook(f"the type {type_name} cannot be imported here ({reason})") from None


def filled(message: Any, fields: dict[str, Any]) -> Any:
    """The message with its fields set; nested ones as `linear__x`."""
    for path, value in fields.items():
        *way, last = path.split("__")
        setattr(reduce(getattr, way, message), last, value)
    return message


def _insist_on(type_name: str, words: str, ends: list[tuple[str, str]]) -> None:
    types = sorted({kind for _, kind in ends})
    if type_name not in types:
        raise CannotLook(f"{words} as {listed(types)}, not as {type_name}")


def remembered(look: Callable[Concatenate[Probe, P], T]) -> Callable[Concatenate[Probe, P], T]:
    """Decorator: with the same arguments a probe does this once, and remembers what it gave, or the CannotLook it raised."""

    @wraps(look)
    def look_once(probe: Probe, *given: P.args, **options: P.kwargs) -> T:
        key = (look, *given, *options.items())
        if key not in probe.memory:
            try:
                probe.memory[key] = look(probe, *given, **options)
            except CannotLook as reason:
                probe.memory[key] = reason
        found = probe.memory[key]
        if isinstance(found, CannotLook):
            raise found
        return found

    return look_once


class Probe:
    """One look at a system, for at most `limit` seconds of robot time.

    It sees the graph as any node does; its own endpoints are left out.
    """

    def __init__(self, target: CheckTarget, limit: float) -> None:
        self.target = target
        self.node = target.node
        self.began = target.now
        self._until = target.now + limit
        self._limit = limit
        self._work_begin = work_done()
        self.stopped = ""
        """Why the learner's code was stopped; "" if it was not."""
        self._origin = target.node.get_clock().now().nanoseconds - round(target.now * NANOSECONDS)
        self.memory: dict[Hashable, Any] = {}
        self.clean_up = ExitStack()
        """Is closed when the probe is over: to take away what it has made, and put back what it has changed."""
        self._errors_before = [error for _, error in target.errors]
        self.nodes_before: Counter[str] = Counter()
        self.log: list[tuple[int, str, str]] = []
        """Level, name of the logger and text of each line that was logged since the probe began."""

    def __enter__(self) -> Probe:
        self.target.limit_work(WORK)

        def hear(line: Any) -> None:
            level = line.level[0] if isinstance(line.level, bytes) else int(line.level)
            self.log.append((level, line.name, line.msg))

        self._subscribe(Log, "/rosout", hear)
        self.nodes_before = self.nodes()
        return self

    def __exit__(self, *_: object) -> None:
        self.target.limit_work(None)
        with suppress(Exception):  # what is gone already needs no cleaning
            self.clean_up.close()

    # -- time --------------------------------------------------------------------------------------------------------

    @property
    def now(self) -> float:
        """Robot time, s."""
        return self.target.now

    def wait(self, seconds: float) -> None:
        """Let robot time pass. Raises CannotLook where the check has no more of it."""
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
            raise CannotLook(f"the {self._limit:g} s of robot time that this check may take are over")
        if not self.stopped and work_done() - self._work_begin > WORK + SLACK:
            self.stopped = (
                f"{number(self.now - self.began, 1)} s of robot time took {WORK:g} s of computing: is a timer's period "
                "tiny, or does a callback compute for long?"
            )
        self._raise_if_stopped()
        self.target.step(seconds)
        self._raise_if_stopped()

    def _raise_if_stopped(self) -> None:
        """Raise Stopped where the learner's code was stopped because it let no time pass; nothing is tried again."""
        if not self.stopped:
            endless = [error for error in self.errors() if isinstance(error, ENDLESS)]
            self.stopped = never_returned(endless[0]) if endless else ""
        if self.stopped:
            raise Stopped(self.stopped)

    def call(self, function: Callable[..., Any], *arguments: Any) -> Any:
        """Call a function of the learner's. Raises what it raises; Stopped if it computes without end."""
        self._raise_if_stopped()
        try:
            return self.target.call(function, *arguments)
        except ENDLESS as error:
            self.stopped = never_returned(error)
            raise Stopped(self.stopped) from None

    # -- the graph ---------------------------------------------------------------------------------------------------

    def nodes(self) -> Counter[str]:
        """How many visible nodes there are of each full name."""
        return Counter(name for name in node_names(self.node) if not is_hidden(name))

    def publishers(self, topic: str) -> list[tuple[str, str]]:
        """Full name of the node and type of each publisher that others have on a topic."""
        return self._others(self.node.get_publishers_info_by_topic(topic))

    def subscriptions(self, topic: str) -> list[tuple[str, str]]:
        """Full name of the node and type of each subscription that others have on a topic."""
        return self._others(self.node.get_subscriptions_info_by_topic(topic))

    def servers(self, service: str) -> list[tuple[str, str]]:
        """Full name of the node and type of each service of a name."""
        found = servers(self.node, service)
        return [(name, kind) for name, kinds in found if not is_hidden(name) for kind in kinds]

    def subscribed(self, name: str) -> list[str]:
        """The names of the topics that a node listens to."""
        found = of_node(self.node, "subscriber", name)
        return [topic for topic, _ in found if not is_hidden(topic)]

    def topics(self) -> list[str]:
        """The names of all topics that are published, hidden ones left out."""
        names = [name for name, _ in self.node.get_topic_names_and_types() if not is_hidden(name)]
        return [name for name in names if self.publishers(name)]

    def services(self) -> list[str]:
        """The names of all services."""
        return [name for name, _ in self.node.get_service_names_and_types() if not is_hidden(name)]

    def _others(self, ends: list[TopicEndpointInfo]) -> list[tuple[str, str]]:
        return sorted((owner(end), end.topic_type) for end in others(self.node, ends))

    def like(self, name: str, known: list[str]) -> str:
        """ ", but there is /robot/staus": a known name that is nearly the one that was looked for; "" if there is none."""
        found = nearest(name, [each for each in known if each != name], cutoff=0.75)
        return f", but there is {found}" if found else ""

    # -- listening ---------------------------------------------------------------------------------------------------

    @remembered
    def listen(self, topic: str, type_name: str) -> list[Heard]:
        """Begin to listen, if it was not done before; returns the list that fills itself.

        Raises CannotLook where no node publishes the topic as this type.
        """
        ends = self.publishers(topic)
        if not ends:
            raise CannotLook(f"no node publishes {topic}{self.like(topic, self.topics())}")
        _insist_on(type_name, f"{topic} is published", ends)
        heard: list[Heard] = []

        def hear(message: Any, info: Any) -> None:
            if len(heard) < MOST_HEARD:
                heard.append(Heard((info["source_timestamp"] - self._origin) / NANOSECONDS, message))

        self._subscribe(interface(type_name), topic, hear)
        return heard

    def hear(self, topic: str, type_name: str, seconds: float) -> list[Heard]:
        """What is sent on a topic within the next seconds of robot time."""
        heard = self.listen(topic, type_name)
        before = len(heard)
        self.wait(seconds)
        return heard[before:]

    def _subscribe(self, message_class: Any, topic: str, callback: Callable[..., None]) -> None:
        """Call `callback` with each message until the probe is over; best effort, which hears every publisher."""
        quality = QoSProfile(depth=1000, reliability=ReliabilityPolicy.BEST_EFFORT)
        subscription = self.node.create_subscription(message_class, topic, callback, quality)
        self.clean_up.callback(self.node.destroy_subscription, subscription)

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

    def unreturned(self) -> str:
        """The callbacks that are not done at this moment, with the line that each is in; "" if there is none."""
        return "; ".join(unreturned(self.target.strands))

    def no_answer(self, words: str) -> Seen:
        """What is said where a request was not answered: the learner's error comes first, or where its callback still is."""
        self.raise_error()
        if waiting := self.unreturned():
            return Seen(False, f"{words}; {waiting}", "What does the callback wait for?")
        return Seen(False, words, "Does the callback end with `return response`?")

    # -- acting ------------------------------------------------------------------------------------------------------

    def publish(self, topic: str, type_name: str, **fields: Any) -> None:
        """Publish one message; nested fields as `linear__x=1.0`."""
        self._publisher(topic, type_name).publish(filled(interface(type_name)(), fields))

    @remembered
    def _publisher(self, topic: str, type_name: str) -> Publisher:
        publisher = self.node.create_publisher(interface(type_name), topic, 10)
        self.clean_up.callback(self.node.destroy_publisher, publisher)
        self.wait(0.05)  # so that the subscriptions have found it
        return publisher

    @contextmanager
    def obstacles(self, *added: Circle | Box) -> Iterator[None]:
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
        client = self._client(service, type_name)
        request = filled(interface(type_name).Request(), fields)
        asked, answered = self.now, []
        future = client.call_async(request)
        future.add_done_callback(lambda _: answered.append(self.now))
        return lambda: Answer(future.result(), asked, answered[0]) if answered else None

    @remembered
    def _client(self, service: str, type_name: str) -> Client:
        ends = self.servers(service)
        if not ends:
            raise CannotLook(f"no node offers the service {service}{self.like(service, self.services())}")
        _insist_on(type_name, f"{service} is offered", ends)
        client = self.node.create_client(interface(type_name), service)
        self.clean_up.callback(self.node.destroy_client, client)
        return client
