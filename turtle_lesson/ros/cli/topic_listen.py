"""`ros2 topic echo`, `hz`, `bw` and `delay`: what is published on a topic, how often, how large, and how old."""

from __future__ import annotations

import sys
import time
from argparse import ArgumentParser, Namespace
from array import array
from collections import deque
from collections.abc import Callable
from math import sqrt
from typing import TYPE_CHECKING, Any

from ..runtime.world import current_process
from .typed_values import add_qos_arguments, is_chosen, matching_profile, message_class, profile_of
from .verb import (
    CommandError,
    Interrupted,
    add_duration,
    add_node_arguments,
    direct_node,
    end_of_stretch,
    expanded,
    flag,
    now,
    positive_int,
    publishers,
    spin_for,
    stretch_of,
    suggest,
    topics,
    unsigned_int,
)

if TYPE_CHECKING:
    from rclpy.node import Node
    from rclpy.qos import QoSProfile
    from rclpy.task import Future


TRUNCATE = 128
PRESET = "sensor_data"


def arguments(parser: ArgumentParser) -> None:
    """The arguments, in the real tool's order."""
    add_node_arguments(parser)
    parser.add_argument("topic_name", help="Name of the topic, such as /turtle1/pose")
    parser.add_argument("message_type", nargs="?", help="Type of its messages, such as turtlesim/msg/Pose")
    add_qos_arguments(parser, "subscribe", PRESET, automatic=True)
    flag(parser, "--csv", "Print each message as one line, with commas between values")
    parser.add_argument("--field", help="Print only this field; a dot leads to a field of a field, as in header.stamp")
    flag(parser, "--full-length -f", "Do not cut off long arrays and texts")
    parser.add_argument(
        "--truncate-length",
        "-l",
        type=unsigned_int,
        default=TRUNCATE,
        help="How much of long arrays and texts is printed (default: %(default)s)",
    )
    flag(parser, "--no-arr", "Print the type and length of arrays instead of them")
    flag(parser, "--no-str", "Print the length of texts instead of them")
    flag(parser, "--flow-style", "Print an array in one line, in brackets")
    flag(parser, "--lost-messages", "Deprecated, and without effect")
    flag(parser, "--no-lost-messages", "Do not report lost messages")
    flag(parser, "--raw", "Print the bytes as they are sent")
    parser.add_argument(
        "--filter",
        dest="filter_expr",
        metavar="FILTER_EXPR",
        help="Print a message m only where this Python expression is true, as in 'm.x > 5'",
    )
    flag(parser, "--once", "End after the first message")
    add_duration(parser)


def echo(args: Namespace) -> None:
    """`ros2 topic echo`."""
    from rclpy.task import Future

    if args.lost_messages:
        print("WARNING: '--lost-messages' is deprecated; lost messages are reported by default", file=sys.stderr)
    done = Future() if args.once else None
    path = _path(args.field)
    wanted = filter_of(args.filter_expr)
    show = _printer(args)

    def print_message(message: Any) -> None:
        part = part_of(message, path)
        if not wanted(part):
            return
        show(part)
        if done is not None and not done.done():
            done.set_result(True)

    with direct_node(args) as node:
        kind, given = None, args.message_type
        profile = profile_of(args, PRESET) if is_chosen(args) else matching_profile(node, args.topic_name, PRESET)
        if given is None:
            kind = class_of_topic(node, args.topic_name)
            if kind is None:
                print(not_published(args.topic_name))
                hint = suggest(expanded(node, args.topic_name), topics(node, include_hidden=True))
                raise CommandError("Could not determine the type for the passed topic", hint)
        else:
            kind = message_class(given)
        lost = None if args.no_lost_messages else _say_what_was_lost
        listen(node, args.topic_name, kind, print_message, profile, args, raw=args.raw, done=done, lost=lost)


def _say_what_was_lost(event: Any) -> None:
    counts = f"total count change:{event.total_count_change}\n\ttotal count: {event.total_count}"
    print(f"A message was lost!!!\n\t{counts}", end="---\n")


def _path(field: str | None) -> list[str]:
    """The names that lead to the field to print."""
    path = [name for name in (field or "").split(".") if name]
    if field is not None and not path:
        raise CommandError(f"Invalid field value '{field}'")
    return path


def part_of(message: Any, path: list[str]) -> Any:
    """The field of a message that some names lead to. Raises CommandError with the real tool's sentence."""
    part = message
    for name in path:
        fields = list(getattr(part, "get_fields_and_field_types", dict)())
        if name not in fields:
            error = f"'{_type_name(part)}' object has no attribute '{name}'"
            raise CommandError(f"Invalid field '{'.'.join(path)}': {error}", suggest(name, fields))
        part = getattr(part, name)
    return part


def _type_name(part: Any) -> str:
    """The name of a value's type as in Python's own errors, which name the module of `array.array`."""
    return "array.array" if isinstance(part, array) else type(part).__name__


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


def _printer(args: Namespace) -> Callable[[Any], None]:
    """What prints a message or a part of one."""
    from rosidl_runtime_py.convert import message_to_csv, message_to_yaml

    length = None if args.full_length else args.truncate_length
    style = {"truncate_length": length, "no_arr": args.no_arr, "no_str": args.no_str}

    def show(part: Any) -> None:
        is_message = hasattr(part, "get_fields_and_field_types")
        if args.csv:
            print(message_to_csv(part, **style) if is_message else part)
        elif not is_message:
            print(part, end="\n---\n")
        else:
            print(message_to_yaml(part, **style, flow_style=args.flow_style), end="---\n")

    return show


# -- what the verbs that listen to a topic share: finding its type, and saying why nothing comes -------------------

LOOK_AGAIN = 0.1


def class_of_topic(node: Node, topic: str) -> Any:
    """The class of a topic's messages, or None if no node uses the topic. Raises CommandError for two types."""
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
    """The class of a topic's messages; if no node uses the topic, waits so long for one that does."""
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


# -- hz, bw and delay ---------------------------------------------------------------------------------------------
# What is counted when follows recordings of the real tools: `hz` reports at a message that comes a second or more
# after the last report, `bw` and `delay` report every second.

SECOND = 1_000_000_000


def statistics(values: deque[int]) -> tuple[float, int, int, float]:
    """Mean, least, greatest and standard deviation."""
    mean = sum(values) / len(values)
    return mean, min(values), max(values), sqrt(sum((value - mean) ** 2 for value in values) / len(values))


def _now() -> int:
    return current_process().simulation.now


def _window_arguments(parser: ArgumentParser, topic: str, about: str, window: int) -> None:
    parser.add_argument(topic, help=f"Name of the topic, {about}")
    text = "How many messages to average over (default: %(default)s)"
    parser.add_argument("--window", "-w", metavar="WINDOW", type=positive_int, default=window, help=text)


def hz_arguments(parser: ArgumentParser) -> None:
    """The arguments of hz."""
    _window_arguments(parser, "topic_name", "such as /turtle1/pose", 10_000)
    parser.add_argument(
        "--filter", dest="filter_expr", metavar="EXPR", help="Count a message m only where this expression is true"
    )
    flag(parser, "--wall-time", "Accepted; there is only one clock here", dest="use_wtime")
    add_node_arguments(parser, daemon=False)
    add_duration(parser)


class Rate:
    """Counts messages, and prints how often they come."""

    def __init__(self, window: int) -> None:
        self._gaps: deque[int] = deque(maxlen=window)
        self._last: int | None = None
        self._printed: int | None = None

    def count(self, time: int) -> None:
        """A message comes at this time (ns)."""
        if self._last is not None:
            self._gaps.append(time - self._last)
        self._last = time
        if self._gaps and self._printed is None:
            self._printed = time
        elif self._printed is not None and time >= self._printed + SECOND:
            self._printed = time
            self._print()

    def _print(self) -> None:
        mean, least, greatest, deviation = (value / SECOND for value in statistics(self._gaps))
        print(
            f"average rate: {1 / mean if mean else 0:.3f}\n"
            f"\tmin: {least:.3f}s max: {greatest:.3f}s std dev: {deviation:.5f}s window: {len(self._gaps)}"
        )


def hz(args: Namespace) -> None:
    """`ros2 topic hz`."""
    from rclpy.qos import qos_profile_sensor_data

    rate, wanted = Rate(args.window), filter_of(args.filter_expr)
    with direct_node(args) as node:
        kind = wait_for_class(node, args.topic_name, stretch_of(args))
        listen(
            node,
            args.topic_name,
            kind,
            lambda message: rate.count(_now()) if wanted(message) else None,
            qos_profile_sensor_data,
            args,
        )


def bw_arguments(parser: ArgumentParser) -> None:
    """The arguments of bw."""
    _window_arguments(parser, "topic", "such as /turtle1/pose", 100)
    add_node_arguments(parser, daemon=False)
    add_duration(parser)


class Bandwidth:
    """Counts bytes, and prints how many come a second."""

    def __init__(self, window: int) -> None:
        self._messages: deque[tuple[int, int]] = deque(maxlen=window)

    def count(self, data: bytes) -> None:
        """A message comes now."""
        self._messages.append((_now(), len(data)))

    def report(self) -> None:
        """Print, if there is enough to say."""
        if len(self._messages) < 2:
            return
        sizes = [size for _, size in self._messages]
        rate = sum(sizes) * SECOND / (_now() - self._messages[0][0])
        shown = [_bytes(size, rate) for size in (rate, sum(sizes) / len(sizes), min(sizes), max(sizes))]
        print(
            f"{shown[0]}/s from {len(sizes)} messages\n\tMessage size mean: {shown[1]} min: {shown[2]} max: {shown[3]}"
        )


def _bytes(size: float, rate: float) -> str:
    """A number of bytes, in the unit that suits the rate."""
    if rate < 1e3:
        return f"{size:.0f} B"
    return f"{size / 1e3:.2f} KB" if rate < 1e6 else f"{size / 1e6:.2f} MB"


def bw(args: Namespace) -> None:
    """`ros2 topic bw`."""
    from rclpy.qos import qos_profile_sensor_data

    count = Bandwidth(args.window)
    with direct_node(args) as node:
        kind = wait_for_class(node, args.topic, stretch_of(args))
        print(f"Subscribed to [{args.topic}]")
        profile = qos_profile_sensor_data
        listen(node, args.topic, kind, count.count, profile, args, raw=True, period=1.0, report=count.report)


def delay_arguments(parser: ArgumentParser) -> None:
    """The arguments of delay."""
    _window_arguments(parser, "topic", "whose messages have a header", 10_000)
    add_node_arguments(parser, daemon=False)
    add_duration(parser)


class Delay:
    """Looks at the times in messages' headers, and prints how long ago they were."""

    def __init__(self, window: int) -> None:
        self._delays: deque[int] = deque(maxlen=window)
        self._begun = self._news = False

    def count(self, message: Any) -> None:
        """A message comes now; the first one only begins the count."""
        from ..sim.simulation import EPOCH

        if not hasattr(message, "header"):
            raise CommandError("msg does not have header")
        stamp = message.header.stamp
        if self._begun:
            self._delays.append(EPOCH + _now() - (stamp.sec * SECOND + stamp.nanosec))
        self._begun = self._news = True

    def report(self) -> None:
        """Print, if there is something to say."""
        if not self._delays:
            return
        if not self._news:
            print("no new messages")
            return
        self._news = False
        mean, least, greatest, deviation = (value / SECOND for value in statistics(self._delays))
        print(
            f"average delay: {mean:.3f}\n"
            f"\tmin: {least:.3f}s max: {greatest:.3f}s std dev: {deviation:.5f}s window: {len(self._delays)}"
        )


def delay(args: Namespace) -> None:
    """`ros2 topic delay`."""
    from rclpy.qos import qos_profile_sensor_data

    count = Delay(args.window)
    with direct_node(args) as node:
        kind = wait_for_class(node, args.topic, stretch_of(args))
        profile = qos_profile_sensor_data
        listen(node, args.topic, kind, count.count, profile, args, period=1.0, report=count.report)
