"""`ros2 topic hz`, `bw` and `delay`: how often messages come, how large they are, and how old.

What is counted when follows recordings of the real tools: `hz` reports at a message that comes a second or more after the
last report, `bw` and `delay` report every second.
"""

from __future__ import annotations

from argparse import ArgumentParser, Namespace
from collections import deque
from math import sqrt
from typing import Any

from ..runtime.world import current_process
from .arg_types import positive_int
from .topic_echo import filter_of, listen, wait_for_class
from .verb import CommandError, add_duration, add_node_arguments, direct_node, stretch_of

__all__ = [
    "bw",
    "bw_arguments",
    "delay",
    "delay_arguments",
    "hz",
    "hz_arguments",
]


HZ_WINDOW = DELAY_WINDOW = 10_000
BW_WINDOW = 100
SECOND = 1_000_000_000


def statistics(values: deque[int]) -> tuple[float, int, int, float]:
    """Mean, least, greatest and standard deviation."""
    mean = sum(values) / len(values)
    return mean, min(values), max(values), sqrt(sum((value - mean) ** 2 for value in values) / len(values))


def _now() -> int:
    return current_process().simulation.now


def hz_arguments(parser: ArgumentParser) -> None:
    """The arguments of hz."""
    parser.add_argument("topic_name", help="Name of the topic, such as /turtle1/pose")
    parser.add_argument(
        "--window",
        "-w",
        dest="window_size",
        metavar="WINDOW",
        type=positive_int,
        default=HZ_WINDOW,
        help="How many messages to average over (default: %(default)s)",
    )
    parser.add_argument(
        "--filter", dest="filter_expr", metavar="EXPR", help="Count a message m only where this expression is true"
    )
    parser.add_argument(
        "--wall-time", dest="use_wtime", action="store_true", help="Accepted; there is only one clock here"
    )
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

    rate, wanted = Rate(args.window_size), filter_of(args.filter_expr)
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
    parser.add_argument("topic", help="Name of the topic, such as /turtle1/pose")
    parser.add_argument(
        "--window",
        "-w",
        metavar="WINDOW",
        type=positive_int,
        default=BW_WINDOW,
        help="How many messages to average over (default: %(default)s)",
    )
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
    parser.add_argument("topic", help="Name of the topic, whose messages have a header")
    parser.add_argument(
        "--window",
        "-w",
        metavar="WINDOW",
        type=positive_int,
        default=DELAY_WINDOW,
        help="How many messages to average over (default: %(default)s)",
    )
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
