"""Waiting for a transform: by looking again and again, as tf2_ros does, or by a future.

Facts: geometry2, tf2_ros_py/tf2_ros/buffer.py. What waits holds up its thread. So in a callback of a single-threaded
executor no transform can come while one is waited for, here as on a robot.
"""

from __future__ import annotations

from collections.abc import Callable
from time import sleep
from typing import Any

from rclpy._blocking import drives_the_simulation
from rclpy.clock import Clock
from rclpy.duration import Duration
from rclpy.task import Future

PAUSE = 0.02
"""Seconds between two looks."""


def wait_until(ready: Callable[[], bool], timeout: Duration) -> None:
    """Look until it is ready, or the timeout is over. Raises TypeError for something else than a Duration."""
    if not isinstance(timeout, Duration):
        raise TypeError(f"timeout must be a rclpy.duration.Duration, got {timeout!r}: write Duration(seconds=1.0)")
    if timeout.nanoseconds > 0:
        _look_again(ready, timeout)


@drives_the_simulation
def _look_again(ready: Callable[[], bool], timeout: Duration) -> None:
    clock = Clock()
    end = clock.now() + timeout
    while clock.now() < end and not ready():
        sleep(PAUSE)


class Waiting:
    """A future that is done as soon as a transform can be looked up."""

    def __init__(self, ready: Callable[[], bool], look_up: Callable[[], Any]) -> None:
        self._ready, self._look_up = ready, look_up
        self.future = Future()
        self.try_again()

    @property
    def over(self) -> bool:
        """Whether nobody waits any more."""
        return self.future.done() or self.future.cancelled()

    def try_again(self) -> None:
        """Something new was heard."""
        try:
            if not self.over and self._ready():
                self.future.set_result(self._look_up())
        except Exception as error:
            self.future.set_exception(error)
