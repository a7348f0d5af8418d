"""Playing a bag: a node that publishes again what was recorded, at the recorded distances on the virtual clock.

Facts: rosbag2_transport's qos.cpp (adapt_offer_to_recorded_offers).
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from math import inf
from typing import TYPE_CHECKING, Any

from ..idl.names import did_you_mean
from ..idl.registry import registry
from ..rmw.transport import LATENCY, LATENCY_SPREAD
from ..sim.simulation import NANOSECONDS
from . import BagError
from .writer import profile_of, schema_text, type_hash

if TYPE_CHECKING:
    from rclpy.qos import QoSProfile
    from rosbags.interfaces import Qos

    from .bag import Bag
    from .scan import BagTopic

NODE = "rosbag2_player"

Say = Callable[[str, str], None]


@dataclass(frozen=True)
class Playback:
    """How to play a bag.

    Attributes:
        rate: how many times as fast as recorded.
        start_offset, duration: where in the bag to begin, and how much of it to play (s; None for all).
        topics: which to play; none named plays all.
        remaps: other names for some topics.
        delay: how long to wait before each time (s of robot time).
        clock: how often a second of robot time to say on /clock what time it is in the bag, 0 for never.
    """

    rate: float = 1.0
    start_offset: float = 0.0
    topics: tuple[str, ...] = ()
    remaps: Mapping[str, str] = field(default_factory=dict)
    loop: bool = False
    delay: float = 0.0
    duration: float | None = None
    clock: float = 0.0


class Player:
    """Publishes what is in a bag. `say(severity, text)` is told what happens."""

    def __init__(self, node: Any, bag: Bag, how: Playback, say: Say) -> None:
        self._bag = bag
        self._how = how
        self._unreadable: Counter[str] = Counter()
        self.published = 0
        self._publishers: dict[tuple[str, str], Any] = {}
        for topic in bag.topics:
            if how.topics and topic.name not in how.topics:
                continue
            try:
                name, profile = how.remaps.get(topic.name, topic.name), offer_of(topic.profiles)
                publisher = node.create_publisher(_class_of(topic), name, profile)
                self._publishers[topic.name, topic.type_name] = publisher
            except Exception as error:
                say("WARN", f"Ignoring a topic '{topic.name}', reason: {error}")
        self._simulation = node._ros_simulation
        self._next: float = inf  # when to say next on /clock what time it is in the bag
        if how.clock:
            from rosgraph_msgs.msg import Clock

            self._clock = node.create_publisher(Clock, "/clock", 1)

    def play(self, until: int | None = None) -> bool:
        """Play the bag; False if the virtual time `until` (ns) came first."""
        simulation = self._simulation
        self._first = first = (self._bag.start or 0) + round(self._how.start_offset * NANOSECONDS)
        last = inf if self._how.duration is None else first + round(self._how.duration * NANOSECONDS)
        while True:
            self._sleep_until(simulation.now + round(self._how.delay * NANOSECONDS))
            self._began = simulation.now
            if self._how.clock:
                self._next = self._began
            for message in self._bag.messages():
                publisher = self._publishers.get((message.topic, message.type_name))
                if publisher is None or message.time < first:
                    continue
                if message.time > last:
                    break
                due = self._began + round((message.time - first) / self._how.rate)
                if until is not None and due >= until:
                    self._sleep_until(until)
                    return False
                self._sleep_until(due)
                try:
                    publisher.publish(message.data)
                    self.published += 1
                except ValueError:
                    self._unreadable[message.topic] += 1
            simulation.sleep_until(simulation.now + LATENCY + LATENCY_SPREAD)  # what was sent last shall arrive, too
            if not self._how.loop or not self.published:
                return True

    def _sleep_until(self, time: int) -> None:
        """Sleep until a virtual time (ns), and say meanwhile on /clock what time it is in the bag."""
        while self._next <= time:
            self._simulation.sleep_until(self._next)
            message = self._clock.msg_type()
            moment = self._first + round((self._next - self._began) * self._how.rate)
            message.clock.sec, message.clock.nanosec = divmod(moment, NANOSECONDS)
            self._clock.publish(message)
            self._next += round(NANOSECONDS / self._how.clock)
        self._simulation.sleep_until(time)

    def complaints(self) -> list[str]:
        """A sentence for each topic with messages that are spoiled, and one if there was nothing to play."""
        if not self.published and not self._unreadable:
            length = f"{self._bag.message_count} messages in {self._bag.duration / NANOSECONDS:g} s"
            return [f"nothing was played: the bag holds {length}, and none that was requested"]
        return [
            f"{count} messages of '{topic}' are damaged and were left out" for topic, count in self._unreadable.items()
        ]


def offer_of(profiles: Sequence[Qos]) -> QoSProfile:
    """What a player offers for a topic whose publishers offered `profiles`: the weakest that all of them kept to."""
    from rclpy.qos import DurabilityPolicy, HistoryPolicy, ReliabilityPolicy

    return profile_of(
        reliable=all(profile.reliability.value != ReliabilityPolicy.BEST_EFFORT for profile in profiles),
        latched=bool(profiles) and all(each.durability.value == DurabilityPolicy.TRANSIENT_LOCAL for each in profiles),
        keep_all=any(profile.history.value == HistoryPolicy.KEEP_ALL for profile in profiles),
        depth=max((profile.depth for profile in profiles), default=0) or 10,
    )


def _class_of(topic: BagTopic) -> Any:
    """The class of a recorded topic's messages. Raises BagError if there is none, or if it is another one today."""
    if topic.serialization != "cdr":
        raise BagError(f"its messages are not written as CDR but as {topic.serialization!r}")
    try:
        message_class = registry.get(topic.type_name)
    except LookupError as error:
        raise BagError(str(error.args[0])) from None
    today = schema_text(message_class)
    if topic.definition in ("", today):
        return message_class
    try:
        same = type_hash(message_class, today) == type_hash(message_class, topic.definition)
    except BagError:
        same = True  # in a form that is not understood here: reading the messages will tell
    if not same:
        raise BagError(
            f"the {topic.type_name} in the bag has other fields than the current one. Play it with the package that it was "
            "recorded with, or record it again"
        )
    return message_class


def parse_remaps(rules: list[str]) -> dict[str, str]:
    """From `/old:=/new` to a mapping. Raises BagError, or InvalidTopicNameException for a name that ROS does not allow."""
    from rclpy.validate_topic_name import validate_topic_name

    remaps = {}
    for rule in rules:
        old, sign, new = rule.partition(":=")
        if not (sign and old and new):
            raise BagError(f"'{rule[:80]}' is not a remapping: write it as /old_topic:=/new_topic")
        validate_topic_name(old)
        validate_topic_name(new)
        remaps[old if old.startswith("/") else f"/{old}"] = new
    return remaps


def play(bag: Bag, how: Playback, say: Say, seconds: float | None = None) -> bool:
    """Play a bag, for `seconds` of robot time at most. Called in a simulated process. Returns whether it came to its end."""
    import rclpy

    known = [topic.name for topic in bag.topics]
    for name in how.topics:
        if name not in known:
            raise BagError(f"the bag has no topic '{name[:247]}'. {did_you_mean(name[:247], known)}".rstrip())
    rclpy.init(args=[])
    try:
        node = rclpy.create_node(NODE, enable_rosout=False)
        player = Player(node, bag, how, say)
        for name in how.remaps:
            if name not in known:
                say("WARN", f"the bag has no topic '{name}' to be remapped")
        simulation = node._ros_simulation
        until = None if seconds is None else simulation.now + round(seconds * NANOSECONDS)
        ended = player.play(until)
        for sentence in player.complaints():
            say("WARN", sentence)
        return ended
    finally:
        rclpy.try_shutdown()
