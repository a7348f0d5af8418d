"""What the verbs that listen to a topic share: finding its type, and saying why nothing comes."""

from __future__ import annotations

import sys
import time
from argparse import Namespace
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from .common import (
    CommandError,
    Interrupted,
    end_of_stretch,
    expanded,
    now,
    publishers,
    spin_for,
    stretch_of,
    suggest,
    topics,
)
from .types import message_class

if TYPE_CHECKING:
    from rclpy.node import Node
    from rclpy.qos import QoSProfile
    from rclpy.task import Future

LOOK_AGAIN = 0.1


def class_of_topic(node: Node, topic: str) -> Any:
    """The class of a topic's messages, or None if nobody uses the topic. Raises CommandError for two types."""
    types = topics(node, include_hidden=True).get(expanded(node, topic))
    if types is None:
        return None
    if len(types) > 1:
        listed = ", ".join(types)
        raise CommandError(f"Cannot echo topic '{topic}', as it contains more than one type: [{listed}]")
    return message_class(types[0])


def not_published(topic: str) -> str:
    """The real tools' warning, which goes to stdout."""
    return f"WARNING: topic [{topic}] does not appear to be published yet"


def wait_for_class(node: Node, topic: str, seconds: float | None) -> Any:
    """The class of a topic's messages; if nobody uses the topic, waits so long for somebody who does."""
    kind = class_of_topic(node, topic)
    if kind is not None:
        return kind
    print(not_published(topic))
    deadline = None if seconds is None else now() + seconds
    while kind is None:
        if deadline is not None and now() >= deadline:
            raise CommandError(*why_silent(node, topic, None, seconds))
        time.sleep(LOOK_AGAIN)
        kind = class_of_topic(node, topic)
    return kind


def why_silent(node: Node, topic: str, kind: Any, seconds: float | None) -> tuple[str, str]:
    """Why no message has come for so long (s), and a hint. `kind` is the class that was listened for."""
    name = expanded(node, topic)
    known = {each: types for each, types in topics(node, include_hidden=True).items() if publishers(node, each)}
    waited = f"No message came on {name} in {seconds:g} s of robot time"
    if name not in known:
        return f"{waited}: no node publishes it", suggest(name, known) or "`ros2 topic list` shows the topics."
    types = {info.topic_type for info in node.get_publishers_info_by_topic(name)}
    if kind is not None and kind._TYPE_NAME not in types:
        return f"{waited}: it is of type {', '.join(sorted(types))}, not {kind._TYPE_NAME}", ""
    if any(_heard(node, name)):
        return f"{waited}, although a node publishes it", "--for SECONDS waits longer."
    return f"{waited}: its publishers do not offer the quality of service that was requested", (
        f"`ros2 topic info -v {name}` shows what they offer."
    )


def _heard(node: Node, name: str) -> list[int]:
    return [each.get_publisher_count() for each in node.subscriptions if each.topic_name == name]


def listen(
    node: Node,
    topic: str,
    kind: Any,
    callback: Callable[[Any], object],
    profile: QoSProfile,
    args: Namespace,
    *,
    raw: bool = False,
    done: Future | None = None,
    lost: Callable[[Any], object] | None = None,
    period: float | None = None,
    report: Callable[[], object] | None = None,
) -> None:
    """Have `callback` called for every message until `done`, or until the stretch of robot time is over.

    Whenever messages turn out to be lost, `lost` is called; every `period` seconds `report` is. Raises Interrupted at
    the end of the stretch, and CommandError if nothing has come until then.
    """
    from rclpy.event_handler import SubscriptionEventCallbacks

    heard = False
    seconds = stretch_of(args)

    def hear(message: Any) -> None:
        nonlocal heard
        heard = True
        callback(message)

    events = SubscriptionEventCallbacks(message_lost=lost)
    node.create_subscription(kind, topic, hear, profile, raw=raw, event_callbacks=events)
    if period is not None and report is not None:
        node.create_timer(period, report)
    if spin_for(node, seconds, done):
        return
    if seconds is None:
        raise Interrupted
    if not heard:
        raise CommandError(*why_silent(node, topic, kind, seconds))
    sys.stdout.flush()
    raise end_of_stretch(seconds)
