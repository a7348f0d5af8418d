"""Recording: a node that subscribes to topics as they appear, and puts every message into a bag.

Its subscriptions are made in the very moment in which a publisher appears (on a robot that takes some milliseconds), so
that a bag of a whole run misses nothing; and what is still under way at the end belongs into it, too.

Facts: rosbag2_transport's qos.cpp (adapt_request_to_offers).
"""

from __future__ import annotations

import re
import warnings
from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import rclpy
from rclpy.expand_topic_name import expand_topic_name
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions
from rclpy.task import Future
from rclpy.validate_full_topic_name import validate_full_topic_name
from rclpy.validate_topic_name import validate_topic_name

from ..idl.cdr import serialize
from ..idl.names import did_you_mean, is_hidden
from ..idl.registry import registry
from ..rmw.graph import Topic
from ..rmw.writer import Writer
from ..runtime.world import World
from ..sim.process import Process
from ..sim.simulation import EPOCH
from . import BagError, UnrecordableType
from .writer import BagWriter, profile_of

NODE = "rosbag2_recorder"
"""The node of `ros2 bag record`."""

HIDDEN_NODE = "_rosbag2_recorder"
"""The node of `lesson.record`, of which `ros2 node list` says nothing."""

Say = Callable[[str, str], None]


@dataclass(frozen=True)
class Selection:
    """Which topics to record: those named, or those that match, or (with neither) all but the hidden ones."""

    topics: tuple[str, ...] = ()
    regex: str = ""
    exclude: str = ""
    hidden: bool = False

    def __post_init__(self) -> None:
        for pattern in (self.regex, self.exclude):
            try:
                re.compile(pattern)
            except re.error as error:
                raise BagError(f"{pattern!r} is not a regular expression: {error}") from None

    def takes(self, name: str) -> bool:
        """Whether a topic of this full name is to be recorded."""
        if self.topics:
            return name in self.topics
        if is_hidden(name) and not self.hidden:
            return False
        if self.exclude and re.search(self.exclude, name):
            return False
        return re.search(self.regex, name) is not None


@dataclass(eq=False)
class _Heard:
    """A topic that is recorded: its type, its subscription (since when, ns since 1970), and the publishers it had."""

    name: str
    message_class: Any
    since: int
    writers: list[Writer]
    subscription: Any = None
    recordable: bool = True


class Recorder:
    """Fills `bag` with what `node` hears; `say(severity, text)` is told what happens."""

    def __init__(self, node: Node, bag: BagWriter, selection: Selection, say: Say) -> None:
        self._node = node
        self._bag = bag
        self._selection = selection
        self._say = say
        self._seen: set[str] = set()
        self._heard: list[_Heard] = []
        self._unregistered: list[_Heard] = []
        self._news: list[tuple[str, str]] = []
        self._looking = False
        self._all_found = False
        self._graph = node._ros_graph
        self._guard = node.create_guard_condition(self._tell)
        self._graph.on_change.append(self._look)
        self._look()
        self._note("INFO", "Recording...")

    def _look(self) -> None:
        """Subscribe to what has appeared. Called in the middle of somebody else's `create_publisher`."""
        if self._looking:
            return  # it is our own subscription that changes the graph
        self._looking = True
        for name, topic in self._graph.topics().items():
            if topic.writers and name not in self._seen and self._selection.takes(name):
                self._seen.add(name)
                self._subscribe(name, topic)
        self._looking = False

    def _subscribe(self, name: str, topic: Topic) -> None:
        if len(topic.types) > 1:
            only = "Only topics with one type are supported"
            return self._note("WARN", f"Topic '{name}' has more than one type associated. {only}")
        try:
            message_class = registry.get(topic.types[0])
        except LookupError as error:
            return self._note("WARN", f"Topic '{name}' cannot be recorded: {error.args[0]}")
        writers = [writer for writer, _ in topic.writers]
        heard = _Heard(name, message_class, EPOCH + self._node._ros_simulation.now, writers)

        def write(message: Any, info: Any) -> None:
            # When it arrived, were it not for the moment that everything takes: so in the usual network it is when it was sent.
            self._write(heard, message, info["received_timestamp"] - topic.latency)

        # A real recorder keeps ten messages and loses the rest of a burst; this one keeps all.
        reliable = all(writer.quality.reliable for writer in writers)
        latched = all(writer.quality.latched for writer in writers)
        profile = profile_of(reliable=reliable, latched=latched, keep_all=True)
        heard.subscription = self._node.create_subscription(message_class, name, write, profile)
        self._heard.append(heard)
        self._unregistered.append(heard)
        return self._note("INFO", f"Subscribed to topic '{name}'")

    def _write(self, heard: _Heard, message: Any, sent: int) -> None:
        """Put in a message, at the time at which it was sent; a latched one of before at which it was asked for."""
        self._register()
        if not heard.recordable:
            return
        try:
            data = serialize(message)
        except ValueError as error:
            self._note("WARN", f"A message of topic '{heard.name}' cannot be recorded: {error}")
        else:
            self._bag.write(heard.name, heard.message_class._TYPE_NAME, max(sent, heard.since), data)

    def _register(self) -> None:
        """Make the new topics known in the bag, before their first message, but not before their publishers are complete."""
        while self._unregistered:
            heard = self._unregistered.pop(0)
            try:
                self._bag.add_topic(heard.name, heard.message_class, [writer.profile for writer in heard.writers])
            except UnrecordableType as error:
                heard.recordable = False
                self._note("WARN", str(error))

    def _note(self, severity: str, text: str) -> None:
        """Say this soon, in our own process."""
        self._news.append((severity, text))
        self._guard.trigger()

    def _tell(self) -> None:
        self._register()
        while self._news:
            self._say(*self._news.pop(0))
        if not self._all_found and self._heard and {heard.name for heard in self._heard} == set(self._selection.topics):
            self._all_found = True
            self._say("INFO", "All requested topics are subscribed. Stopping discovery...")

    def silent(self) -> list[str]:
        """A sentence for each topic that was asked for by name and never appeared."""
        known = self._graph.topics()
        return [
            f"no node published on {name} while the bag was recorded, so the bag contains none of its messages. "
            f"{did_you_mean(name, known)}".rstrip()
            for name in self._selection.topics
            if name not in self._seen
        ]

    def close(self) -> None:
        """Take what has arrived and what is under way, and complete the bag."""
        self._graph.on_change.remove(self._look)
        for heard in self._heard:
            while heard.subscription._has_work():
                heard.subscription.callback(*heard.subscription._take())
            for sent, message in heard.subscription._reader.under_way():
                self._write(heard, message, EPOCH + sent)
        self._tell()
        self._bag.close()


def record(bag: BagWriter, selection: Selection, say: Say, seconds: float | None = None, node_name: str = NODE) -> None:
    """Record until interrupted, or for some seconds of robot time. Called in a simulated process.

    However this ends, the bag is completed. `say(severity, text)` is told what happens.
    """
    recorder = None
    try:
        rclpy.init(args=[], signal_handler_options=SignalHandlerOptions.NO)  # what is under way is recorded, too
        node = rclpy.create_node(node_name, start_parameter_services=node_name == NODE, enable_rosout=False)
        names = tuple(node.resolve_topic_name(name) for name in selection.topics)
        recorder = Recorder(node, bag, replace(selection, topics=names), say)
        rclpy.spin_until_future_complete(node, Future(), timeout_sec=seconds)
    except KeyboardInterrupt:
        pass
    finally:
        if recorder is not None:
            recorder.close()
        bag.close()
        rclpy.try_shutdown()
    for sentence in recorder.silent() if recorder is not None else ():
        say("WARN", sentence)


def checked_names(names: Iterable[str]) -> tuple[str, ...]:
    """Names of topics, as a program may give them. Raises InvalidTopicNameException or TypeError."""
    if isinstance(names, str):
        raise TypeError(f'topics is a list of names, got the text {names!r}: try topics=["{names}"]')
    checked = tuple(names)
    for name in checked:
        if not isinstance(name, str):
            raise TypeError(f"the name of a topic is a text such as '/turtle1/pose', got {name!r}")
        validate_topic_name(name)
        validate_full_topic_name(expand_topic_name(name, NODE, "/"))
    return checked


class Recording:
    """A bag that is being recorded while the page's cells run the world (`lesson.record(…)`).

    It goes on until `stop()` or the end of a `with` block. `topics`: names of those to record, None for all but the hidden
    ones. Raises BagError where there is a file or folder of that name.
    """

    def __init__(
        self, world: World, path: str | Path, topics: Iterable[str] | None = None, storage: str = "mcap"
    ) -> None:
        selection = Selection(() if topics is None else checked_names(topics))
        if topics is not None and not selection.topics:
            raise BagError("topics names no topic: leave it out to record all of them")
        self.path = Path(path).expanduser().absolute()
        self._shown = str(path)
        self._writer = writer = BagWriter(self.path, storage)
        self._process: Process | None = world.spawn(
            lambda: record(writer, selection, _keep_warnings_only, node_name=HIDDEN_NODE), name=NODE
        )
        world.at_close.append(self._let_go)
        world.sim.settle()

    def _let_go(self) -> None:
        """The world is closed: it ends the recording, which this handle then keeps nothing of."""
        self._process = None

    def __repr__(self) -> str:
        state = "done" if self.done else "going on"
        count = self._writer.count
        return f"<Recording {self._shown}: {count} message{'' if count == 1 else 's'}, {state}>"

    @property
    def done(self) -> bool:
        """Whether the bag is complete."""
        return self._writer.closed

    @property
    def message_count(self) -> int:
        """How many messages the bag holds by now."""
        return self._writer.count

    def stop(self) -> None:
        """End the recording and complete the bag. A second call does nothing."""
        if self._process is None or not self._process.alive:
            return
        self._process.interrupt()
        self._writer.close()

    def __enter__(self) -> Recording:
        return self

    def __exit__(self, *error: object) -> None:
        self.stop()


def _keep_warnings_only(severity: str, text: str) -> None:
    if severity != "INFO":
        warnings.warn(text, stacklevel=2)
