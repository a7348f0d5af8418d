"""`ros2 topic echo`, `hz`, `bw` and `delay`: what is published on a topic, how often, how large, and how old."""

from __future__ import annotations

import sys
import time
from argparse import Namespace
from array import array
from collections import deque
from collections.abc import Callable, Collection
from itertools import pairwise
from math import inf, sqrt
from typing import Any

from rclpy.event_handler import QoSMessageLostInfo, SubscriptionEventCallbacks
from rclpy.node import Node
from rclpy.qos import QoSProfile, qos_profile_sensor_data
from rclpy.task import Future

from ..runtime.world import current_process
from ..sim.simulation import EPOCH
from ..sim.simulation import NANOSECONDS as SECOND
from .arguments import NODE, NODE_WITHOUT_DAEMON, Argument, arg, duration, flag, positive_int, unsigned_int
from .typed_values import class_of, matching_profile, qos_arguments
from .verb import (
    CommandError,
    Interrupted,
    direct_node,
    end_of_stretch,
    expanded,
    now,
    publishers,
    spin_for,
    stretch_of,
    suggest,
    topics,
    verb,
)

PRESET = "sensor_data"


@verb(
    "topic echo",
    *NODE,
    arg("topic_name", "Name of the topic, such as /turtle1/pose"),
    arg("message_type", "Type of its messages, such as turtlesim/msg/Pose", nargs="?"),
    *qos_arguments(PRESET, "as the publishers offer", "as the publishers offer"),
    flag("--csv", "Print each message as one line, with commas between values"),
    arg("--field", "Print only this field; a dot leads to a field of a field, as in header.stamp"),
    flag("--full-length -f", "Do not cut off long arrays and texts"),
    arg("--truncate-length -l", "How much of them is printed (default: 128)", type=unsigned_int, default=128),
    flag("--no-arr", "Print the type and length of arrays instead of them"),
    flag("--no-str", "Print the length of texts instead of them"),
    flag("--flow-style", "Print an array in one line, in brackets"),
    flag("--lost-messages", "Deprecated, and without effect"),
    flag("--no-lost-messages", "Do not report lost messages"),
    flag("--raw", "Print the bytes as they are sent"),
    arg("--filter", "Print a message m only where this is true in Python, as 'm.x > 5'", dest="filter_expr"),
    flag("--once", "End after the first message"),
    duration(),
)
def echo(args: Namespace) -> None:
    """Print the messages of a topic."""
    from rosidl_runtime_py.convert import message_to_csv, message_to_yaml

    if args.lost_messages:
        print("WARNING: '--lost-messages' is deprecated; lost messages are reported by default", file=sys.stderr)
    done = Future() if args.once else None
    path = [name for name in (args.field or "").split(".") if name]
    if args.field is not None and not path:
        raise CommandError(f"Invalid field value '{args.field}'")
    wanted = filter_of(args.filter_expr)
    length = None if args.full_length else args.truncate_length
    style = {"truncate_length": length, "no_arr": args.no_arr, "no_str": args.no_str}

    def print_message(message: Any) -> None:
        part = part_of(message, path)
        if not wanted(part):
            return
        is_message = hasattr(part, "get_fields_and_field_types")
        if args.csv:
            print(message_to_csv(part, **style) if is_message else part)
        elif not is_message:
            print(part, end="\n---\n")
        else:
            print(message_to_yaml(part, **style, flow_style=args.flow_style), end="---\n")
        if done is not None and not done.done():
            done.set_result(True)

    def print_lost(event: QoSMessageLostInfo) -> None:
        counts = f"total count change:{event.total_count_change}\n\ttotal count: {event.total_count}"
        print(f"A message was lost!!!\n\t{counts}", end="---\n")

    with direct_node(args) as node:
        profile = matching_profile(node, args.topic_name, args, PRESET)
        kind = class_of(args.message_type, "msg") if args.message_type else class_of_topic(node, args.topic_name)
        if kind is None:
            print(NOT_PUBLISHED.format(args.topic_name))
            hint = suggest(expanded(node, args.topic_name), topics(node, include_hidden=True))
            raise CommandError("Could not determine the type for the passed topic", hint)
        lost = None if args.no_lost_messages else print_lost
        listen(node, args.topic_name, kind, print_message, profile, args, raw=args.raw, done=done, lost=lost)


def part_of(message: Any, path: list[str]) -> Any:
    """The field of a message that some names lead to. Raises CommandError with the real tool's sentence."""
    part = message
    for name in path:
        fields = list(getattr(part, "get_fields_and_field_types", dict)())
        if name not in fields:
            # As in Python's own errors, which name the module of `array.array`.
            kind = "array.array" if isinstance(part, array) else type(part).__name__
            error = f"'{kind}' object has no attribute '{name}'"
            raise CommandError(f"Invalid field '{'.'.join(path)}': {error}", suggest(name, fields))
        part = getattr(part, name)
    return part


def filter_of(expression: str | None) -> Callable[[Any], bool]:
    """Whether a message m passes a Python expression as typed; everything passes if there is none."""
    if expression is None:
        return lambda message: True
    try:
        code = compile(expression.strip(), "--filter", "eval")
    except (SyntaxError, ValueError, MemoryError, RecursionError) as error:
        reason = getattr(error, "msg", None) or error
        raise CommandError(f"Invalid filter expression '{expression[:200]}': {reason}") from None

    def passes(message: Any) -> bool:
        try:
            return bool(eval(code, {"m": message}))
        except (Exception, SystemExit) as error:
            text = f"The filter expression '{expression[:200]}' failed: {type(error).__name__}: {error}"
            raise CommandError(text) from None

    return passes


# -- listening to a topic: finding its type, and saying why nothing comes ----------------------------------------------

LOOK_AGAIN = 0.1
NOT_PUBLISHED = "WARNING: topic [{}] does not appear to be published yet"
"""The real tools' warning, which goes to stdout."""


def class_of_topic(node: Node, topic: str) -> Any:
    """The class of a topic's messages, or None if no node uses the topic. Raises CommandError for two types."""
    types = topics(node, include_hidden=True).get(expanded(node, topic))
    if types is None:
        return None
    if len(types) > 1:
        listed = ", ".join(types)
        raise CommandError(f"Cannot echo topic '{topic}', as it contains more than one type: [{listed}]")
    return class_of(types[0], "msg")


def why_silent(node: Node, topic: str, kind: Any, seconds: float) -> tuple[str, str]:
    """Why no message has come for so long (s), and a hint. `kind` is the class that was listened for."""
    name = expanded(node, topic)
    known = [each for each in topics(node, include_hidden=True) if publishers(node, each)]
    waited = f"No message came on {name} in {seconds:g} s of robot time"
    if name not in known:
        return f"{waited}: no node publishes it", suggest(name, known) or "`ros2 topic list` shows the topics."
    types = {info.topic_type for info in node.get_publishers_info_by_topic(name)}
    if kind is not None and kind._TYPE_NAME not in types:
        return f"{waited}: it is of type {', '.join(sorted(types))}, not {kind._TYPE_NAME}", ""
    if any(each.get_publisher_count() for each in node.subscriptions if each.topic_name == name):
        return f"{waited}, although a node publishes it", "--for SECONDS waits longer."
    hint = f"`ros2 topic info -v {name}` shows what they offer."
    return f"{waited}: its publishers do not offer the quality of service that was requested", hint


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
) -> None:
    """Have `callback` called for every message until `done`, or until the stretch of robot time is over.

    Whenever messages turn out to be lost, `lost` is called. Raises Interrupted at the end of the stretch, and CommandError
    if nothing has come until then.
    """
    heard = False
    seconds = stretch_of(args)

    def hear(message: Any) -> None:
        nonlocal heard
        heard = True
        callback(message)

    events = SubscriptionEventCallbacks(message_lost=lost)
    node.create_subscription(kind, topic, hear, profile, raw=raw, event_callbacks=events)
    if spin_for(node, seconds, done):
        return
    if seconds is None:
        raise Interrupted
    if not heard:
        raise CommandError(*why_silent(node, topic, kind, seconds))
    sys.stdout.flush()
    raise end_of_stretch(seconds)


# -- hz, bw and delay --------------------------------------------------------------------------------------------------
# What is counted when follows recordings of the real tools: `hz` reports at a message that comes a second or more
# after the last report, `bw` and `delay` report every second.


def _window(messages: int) -> Argument:
    return arg("--window -w", "Messages to average over (default: %(default)s)", type=positive_int, default=messages)


def _now() -> int:
    return current_process().simulation.now


@verb(
    "topic hz",
    arg("topic_name", "Name of the topic, such as /turtle1/pose"),
    _window(10_000),
    arg("--filter", "Count a message m only where this expression is true", dest="filter_expr", metavar="EXPR"),
    flag("--wall-time", "Accepted; there is only one clock here", dest="use_wtime"),
    *NODE_WITHOUT_DAEMON,
    duration(),
)
def hz(args: Namespace) -> None:
    """How many messages a second arrive on a topic."""
    wanted = filter_of(args.filter_expr)
    times: deque[int] = deque(maxlen=args.window + 1)
    due = 0

    def count(message: Any) -> None:
        nonlocal due
        if not wanted(message):
            return
        times.append(_now())
        if len(times) > 1 and times[-1] >= due:
            if due:
                gaps = [after - before for before, after in pairwise(times)]
                _print_times(lambda mean: f"average rate: {1 / mean if mean else 0:.3f}", gaps)
            due = times[-1] + SECOND

    _measure(args, args.topic_name, count)


@verb("topic bw", arg("topic", "Name of the topic"), _window(100), *NODE_WITHOUT_DAEMON, duration())
def bw(args: Namespace) -> None:
    """How many bytes a second arrive on a topic."""
    heard: deque[tuple[int, int]] = deque(maxlen=args.window)  # when (ns), and how many bytes

    def report() -> None:
        if len(heard) < 2:
            return
        sizes = [size for _, size in heard]
        rate = sum(sizes) * SECOND / (_now() - heard[0][0])
        mean, least, most = (_bytes(size, rate) for size in (sum(sizes) / len(sizes), min(sizes), max(sizes)))
        print(f"{_bytes(rate, rate)}/s from {len(sizes)} messages")
        print(f"\tMessage size mean: {mean} min: {least} max: {most}")

    _measure(args, args.topic, lambda message: heard.append((_now(), len(message))), report, raw=True)


def _bytes(size: float, rate: float) -> str:
    """A number of bytes, in the unit that suits the rate."""
    if rate < 1e3:
        return f"{size:.0f} B"
    return f"{size / 1e3:.2f} KB" if rate < 1e6 else f"{size / 1e6:.2f} MB"


@verb("topic delay", arg("topic", "Topic of messages with a header"), _window(10_000), *NODE_WITHOUT_DAEMON, duration())
def delay(args: Namespace) -> None:
    """How old the messages of a topic are when they arrive, judged by the stamp in their header."""
    ages: deque[int] = deque(maxlen=args.window)
    heard = reported = 0

    def count(message: Any) -> None:
        nonlocal heard
        if not hasattr(message, "header"):
            raise CommandError("msg does not have header")
        stamp = message.header.stamp
        if heard:  # the first message only begins the count
            ages.append(EPOCH + _now() - (stamp.sec * SECOND + stamp.nanosec))
        heard += 1

    def report() -> None:
        nonlocal reported
        if ages and heard == reported:
            print("no new messages")
        elif ages:
            _print_times(lambda mean: f"average delay: {mean:.3f}", ages)
        reported = heard

    _measure(args, args.topic, count, report)


def _measure(
    args: Namespace,
    topic: str,
    count: Callable[[Any], object],
    report: Callable[[], object] | None = None,
    *,
    raw: bool = False,
) -> None:
    """Have `count` called for every message (or its `raw` bytes), and `report` every second."""
    seconds = stretch_of(args) or inf
    with direct_node(args) as node:
        begun = now()
        while (kind := class_of_topic(node, topic)) is None:  # no node uses the topic yet
            if now() == begun:
                print(NOT_PUBLISHED.format(topic))
            if now() >= begun + seconds:
                raise CommandError(*why_silent(node, topic, None, seconds))
            time.sleep(LOOK_AGAIN)
        if raw:
            print(f"Subscribed to [{topic}]")
        if report is not None:
            node.create_timer(1.0, report)
        listen(node, topic, kind, count, qos_profile_sensor_data, args, raw=raw)


def _print_times(title: Callable[[float], str], times: Collection[int]) -> None:
    """Print what the mean of the times (ns) amounts to, and their least, greatest and standard deviation."""
    mean = sum(times) / len(times)
    deviation = sqrt(sum((time - mean) ** 2 for time in times) / len(times))
    print(title(mean / SECOND))
    print(f"\tmin: {min(times) / SECOND:.3f}s max: {max(times) / SECOND:.3f}s", end=" ")
    print(f"std dev: {deviation / SECOND:.5f}s window: {len(times)}")
