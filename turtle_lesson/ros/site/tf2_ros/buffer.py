"""The buffer of transforms that nodes use. Facts: geometry2, tf2_ros_py/tf2_ros/buffer.py."""

from __future__ import annotations

from time import sleep
from typing import Any

from geometry_msgs.msg import TransformStamped
from rclpy._blocking import drives_the_simulation
from rclpy.clock import Clock, JumpThreshold, TimeJump
from rclpy.duration import Duration
from rclpy.logging import get_logger
from rclpy.node import Node
from rclpy.task import Future
from rclpy.time import Time
from tf2_msgs.srv import FrameGraph
from tf2_py import BufferCore
from tf2_py._buffer_core import Way, nanoseconds

from .buffer_interface import TransformRegistration

AT_ONCE = Duration()
"""A timeout of no time: nothing is waited for."""

PAUSE = 0.02
"""Seconds between two looks for a transform that is waited for, as in tf2_ros."""


class Buffer(BufferCore):
    """Keeps the transforms that a TransformListener hears (10 s unless told otherwise), and answers for any two frames.

    A node given offers the service `tf2_frames`, which lists all frames as YAML. Where a `timeout` is given, lookups wait that
    long at most, in robot time, and hold up their thread meanwhile. So in a callback of a single-threaded executor no transform
    can come while one is waited for, here as on a robot.
    """

    def __init__(self, cache_time: Duration | None = None, node: Node | None = None) -> None:
        super().__init__(cache_time)
        self.registration = TransformRegistration()
        self._waiting: list[tuple[Future, Way]] = []
        if node is not None:
            self.srv = node.create_service(FrameGraph, "tf2_frames", self._get_frames)
            self.clock = node.get_clock()
            backwards = JumpThreshold(min_forward=None, min_backward=Duration(nanoseconds=-1), on_clock_change=False)
            self.jump_handle = self.clock.create_jump_callback(backwards, post_callback=self.time_jump_callback)

    def _get_frames(self, request: FrameGraph.Request, response: FrameGraph.Response) -> FrameGraph.Response:
        response.frame_yaml = self.all_frames_as_yaml()
        return response

    def time_jump_callback(self, time_jump: TimeJump) -> None:
        """Forget everything when the node's clock is set back, as a bag that is played again does."""
        get_logger("tf2_buffer").warning("Detected jump back in time. Clearing tf buffer.")
        self.clear()

    def _set(self, transform: TransformStamped, authority: str, span: int | None) -> None:
        super()._set(transform, authority, span)
        for future, way in self._waiting:
            if not (future.done() or future.cancelled()) and self._can(way)[0]:
                future.set_result(self._look_up(way))
        self._waiting = [each for each in self._waiting if not (each[0].done() or each[0].cancelled())]

    def transform(self, object_stamped: Any, target_frame: str, timeout: Duration = AT_ONCE) -> Any:
        """Stamped data as seen from the target frame, at the time of its stamp.

        Raises TypeException for a type that is not registered, and TransformException.
        """
        do_transform = self.registration.get(type(object_stamped))
        header = object_stamped.header
        return do_transform(object_stamped, self.lookup_transform(target_frame, header.frame_id, header.stamp, timeout))

    def lookup_transform(
        self, target_frame: str, source_frame: str, time: Time, timeout: Duration = AT_ONCE
    ) -> TransformStamped:
        """Where the source frame is, seen from the target frame, at a time (`Time()`: the latest).

        Raises LookupException, ConnectivityException, ExtrapolationException, InvalidArgumentException.
        """
        way = (target_frame, source_frame, nanoseconds(time))
        self._wait(timeout, way)
        return self._look_up(way)

    async def lookup_transform_async(self, target_frame: str, source_frame: str, time: Time) -> TransformStamped:
        """The same, awaited until it is there."""
        await self.wait_for_transform_async(target_frame, source_frame, time)
        return self.lookup_transform_core(target_frame, source_frame, time)

    def lookup_transform_full(
        self,
        target_frame: str,
        target_time: Time,
        source_frame: str,
        source_time: Time,
        fixed_frame: str,
        timeout: Duration = AT_ONCE,
    ) -> TransformStamped:
        """Where the source frame was at its time, seen from where the target frame is at its own.

        `fixed_frame` is one that does not move between the two, such as "world". Raises as `lookup_transform`.
        """
        there = (target_frame, fixed_frame, nanoseconds(target_time))
        here = (fixed_frame, source_frame, nanoseconds(source_time))
        self._wait(timeout, there, here)
        return self._look_up(there, here)

    def can_transform(
        self,
        target_frame: str,
        source_frame: str,
        time: Time,
        timeout: Duration = AT_ONCE,
        return_debug_tuple: bool = False,
    ) -> Any:
        """Whether there is such a transform; with `return_debug_tuple` also why not."""
        found = self._wait(timeout, (target_frame, source_frame, nanoseconds(time)))
        return found if return_debug_tuple else found[0]

    def wait_for_transform_async(self, target_frame: str, source_frame: str, time: Time) -> Future:
        """A future whose result is the transform, as soon as it can be looked up."""
        future, way = Future(), (target_frame, source_frame, nanoseconds(time))
        if self._can(way)[0]:
            future.set_result(self._look_up(way))
        else:
            self._waiting.append((future, way))
        return future

    def _wait(self, timeout: Duration, *ways: Way) -> tuple[bool, str]:
        """Wait until what is asked can be looked up, or the timeout is over: whether it can, and if not, why."""
        if not isinstance(timeout, Duration):
            raise TypeError(f"timeout must be a rclpy.duration.Duration, got {timeout!r}: write Duration(seconds=1.0)")
        return self._look_again(timeout, *ways) if timeout.nanoseconds > 0 else self._can(*ways)

    @drives_the_simulation
    def _look_again(self, timeout: Duration, *ways: Way) -> tuple[bool, str]:
        clock = Clock()
        end = clock.now() + timeout
        while clock.now() < end and not self._can(*ways)[0]:
            sleep(PAUSE)
        return self._can(*ways)
