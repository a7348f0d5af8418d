"""Playing a bag: a node that publishes again what was recorded, at the recorded distances on the virtual clock.

Facts: rosbag2_transport's qos.cpp (adapt_offer_to_recorded_offers).
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import rclpy
from rclpy.node import Node
from rclpy.publisher import Publisher
from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy
from rclpy.validate_topic_name import validate_topic_name

from ..idl.names import did_you_mean
from ..idl.registry import registry
from ..rmw.transport import LATENCY, LATENCY_SPREAD
from ..sim.simulation import NANOSECONDS
from . import BagError
from .bag import Bag
from .scan import BagTopic
from .writer import profile_of, schema_text, type_hash

if TYPE_CHECKING:
    from rosbags.interfaces import Qos

NODE = "rosbag2_player"

Say = Callable[[str, str], None]


@dataclass(frozen=True)
class Playback:
    """How to play a bag.

    Attributes:
        rate: how many times as fast as recorded.
        start_offset: where in the bag to begin (s).
        topics: which to play; none named plays all.
        remaps: other names for some topics.
        loop: whether to begin again at the end.
    """

    rate: float = 1.0
    start_offset: float = 0.0
    topics: tuple[str, ...] = ()
    remaps: Mapping[str, str] = field(default_factory=dict)
    loop: bool = False


def play(bag: Bag, how: Playback, say: Say, seconds: float | None = None) -> bool:
    """Play a bag, for `seconds` of robot time at most. Called in a simulated process. Returns whether it came to its end.

    `say(severity, text)` is told what happens.
    """
    known = [topic.name for topic in bag.topics]
    for name in how.topics:
        if name not in known:
            raise BagError(f"the bag has no topic '{name[:247]}'. {did_you_mean(name[:247], known)}".rstrip())
    rclpy.init(args=[])
    try:
        node = rclpy.create_node(NODE, enable_rosout=False)
        publishers = _publishers(node, bag, how, say)
        simulation = node._ros_simulation
        until = None if seconds is None else simulation.now + round(seconds * NANOSECONDS)
        first = bag.start + round(how.start_offset * NANOSECONDS)
        published, unreadable = 0, Counter[str]()
        again = True
        while again:
            began = simulation.now
            for message in bag.messages():
                publisher = publishers.get((message.topic, message.type_name))
                if publisher is None or message.time < first:
                    continue
                due = began + round((message.time - first) / how.rate)
                if until is not None and due >= until:
                    simulation.sleep_until(until)
                    return False
                simulation.sleep_until(due)
                try:
                    publisher.publish(message.data)
                    published += 1
                except ValueError:
                    unreadable[message.topic] += 1
            simulation.sleep_until(simulation.now + LATENCY + LATENCY_SPREAD)  # what was sent last shall arrive, too
            again = how.loop and published > 0
        for topic, count in unreadable.items():
            say("WARN", f"{count} messages of '{topic}' are damaged and were left out")
        if not published and not unreadable:
            length = f"{bag.message_count} messages in {bag.duration / NANOSECONDS:g} s"
            say("WARN", f"nothing was played: the bag holds {length}, and none that was requested")
        return True
    finally:
        rclpy.try_shutdown()


def _publishers(node: Node, bag: Bag, how: Playback, say: Say) -> dict[tuple[str, str], Publisher]:
    """A publisher for each topic that is to be played, by the topic's name and type."""
    publishers = {}
    for topic in bag.topics:
        if how.topics and topic.name not in how.topics:
            continue
        try:
            name, profile = how.remaps.get(topic.name, topic.name), offer_of(topic.profiles)
            publishers[topic.name, topic.type_name] = node.create_publisher(_class_of(topic), name, profile)
        except Exception as error:
            say("WARN", f"Ignoring a topic '{topic.name}', reason: {error}")
    return publishers


def offer_of(profiles: Sequence[Qos]) -> QoSProfile:
    """What a player offers for a topic whose publishers offered `profiles`: the weakest that all of them kept to."""
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
    remaps = {}
    for rule in rules:
        old, sign, new = rule.partition(":=")
        if not (sign and old and new):
            raise BagError(f"'{rule[:80]}' is not a remapping: write it as /old_topic:=/new_topic")
        validate_topic_name(old)
        validate_topic_name(new)
        remaps[old if old.startswith("/") else f"/{old}"] = new
    return remaps
