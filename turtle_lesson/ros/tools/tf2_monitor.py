"""`ros2 run tf2_ros tf2_monitor [A B]`: how late transforms come, all of them or those between two frames.

Facts: geometry2, tf2_ros/src/tf2_monitor.cpp.
"""

from __future__ import annotations

import sys
from collections import deque
from contextlib import suppress

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from rclpy.time import Time
from rclpy.utilities import remove_ros_args
from tf2_msgs.msg import TFMessage
from tf2_ros import Buffer, TransformException, TransformListener

AUTHORITY = "<no authority available>"
LOOK_PERIOD = 0.5
LOOKS = 20
SHORTEST = 1e-3
"""Messages that come within less time (s) have no rate: those on /tf_static."""
KEPT = 1000
"""How many delays of each frame are averaged at most."""


class Monitor(Node):
    """Notes how old each transform is when it comes, and prints it every ten seconds."""

    def __init__(self, frames: list[str]) -> None:
        super().__init__("tf2_monitor_main")
        self._frames, self._chain = frames, list[str]()
        self._delays: dict[str, deque[float]] = {}
        self._means: deque[float] = deque(maxlen=KEPT)
        self._times: deque[float] = deque(maxlen=KEPT)
        self._net: list[float] = []
        self._looks = 0
        self._buffer = Buffer()
        self._listener = TransformListener(self._buffer, self)
        self.create_subscription(TFMessage, "/tf", self._on_transforms, 100)
        static = QoSProfile(depth=100, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self.create_subscription(TFMessage, "/tf_static", self._on_transforms, static)
        self.create_timer(LOOK_PERIOD, self._look)
        if not frames:
            print("Gathering data on all frames for 10 seconds...")

    def _now(self) -> float:
        return self.get_clock().now().nanoseconds / 1e9

    def _on_transforms(self, message: TFMessage) -> None:
        now = self._now()
        delays = []
        for each in message.transforms:
            delays.append(now - each.header.stamp.sec - each.header.stamp.nanosec / 1e9)
            self._delays.setdefault(each.child_frame_id, deque(maxlen=KEPT)).append(delays[-1])
        self._means.append(sum(delays) / max(1, len(delays)))
        self._times.append(now)

    def _look(self) -> None:
        if self._frames and not self._chain:
            self._find_chain()
            return
        if self._frames:
            try:
                stamp = self._buffer.lookup_transform(self._frames[0], self._frames[1], Time()).header.stamp
                self._net.append(self._now() - stamp.sec - stamp.nanosec / 1e9)
            except TransformException as error:
                self.get_logger().warning(f"Transform Exception {error}")
        self._looks += 1
        if self._looks > LOOKS:
            self._looks = 0
            self._print()

    def _find_chain(self) -> None:
        one, other = self._frames
        there, why_not = self._buffer.can_transform(one, other, Time(), return_debug_tuple=True)
        if not there:
            print(f"Waiting for transform {one} ->  {other}: {why_not}")
            return
        self._chain = self._buffer._chain(other, Time(), one, Time(), other)
        print(f"Gathering data on {one} -> {other} for 10 seconds...")

    def _print(self) -> None:
        print("\n\n")
        if self._frames:
            print(f"RESULTS: for {self._frames[0]} to {self._frames[1]}\nChain is: {' -> '.join(self._chain)}")
            if self._net:
                print(f"Net delay     avg = {sum(self._net) / len(self._net):g}: max = {max(self._net):g}")
        else:
            print("RESULTS: for all Frames")
        print("\nFrames:")
        for frame in sorted(self._delays):
            if not self._frames or frame in self._chain:
                print(f"Frame: {frame}, published by {AUTHORITY}, {_delays(self._delays[frame], ', ')}")
        print("\nAll Broadcasters:")
        if self._times:
            took = self._times[-1] - self._times[0]
            rate = len(self._times) / took if took > SHORTEST else 0.0
            print(f"Node: {AUTHORITY} {rate:g} Hz, {_delays(self._means, ' ')}")


def _delays(delays: deque[float], between: str) -> str:
    return f"Average Delay: {sum(delays) / len(delays):g}{between}Max Delay: {max(0.0, *delays):g}"


def main() -> int:
    """Run until Ctrl-C."""
    words = remove_ros_args(sys.argv)[1:]
    if len(words) not in (0, 2):
        print("TF_Monitor: usage: tf2_monitor framea frameb")
        return 1
    rclpy.init()
    with suppress(KeyboardInterrupt, ExternalShutdownException):
        rclpy.spin(Monitor(words))
    return 0
