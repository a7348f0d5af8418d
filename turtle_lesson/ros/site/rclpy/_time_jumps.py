"""Jumps of a clock: when ROS time begins or ends to follow /clock, or is set to another time, its callbacks are called.

What is told to whom are the rules of rcl's time.c. Everybody knows these classes as `rclpy.clock.…`.
"""

from __future__ import annotations

from collections.abc import Callable
from enum import IntEnum
from typing import TYPE_CHECKING, Any

from .duration import Duration

if TYPE_CHECKING:
    from .clock import Clock


class ClockChange(IntEnum):
    """Whether a jump changes the source of ROS time: /clock (activated), or the system's clock (deactivated)."""

    __module__ = "rclpy.clock"

    ROS_TIME_NO_CHANGE = 1
    ROS_TIME_ACTIVATED = 2
    ROS_TIME_DEACTIVATED = 3
    SYSTEM_TIME_NO_CHANGE = 4

    def __str__(self) -> str:
        return f"ClockChange.{self.name}"

    def __format__(self, format_spec: str) -> str:
        return format(str(self), format_spec)


class JumpThreshold:
    """Of which jumps one wants to know.

    Args:
        min_forward: the shortest jump forward, a positive Duration; None for no jump forward.
        min_backward: the shortest jump back, a negative Duration; None for no jump back.
        on_clock_change: whether to know of changes of the source.

    Raises:
        ValueError: if a duration has the wrong sign, or no jump at all is wanted.
    """

    __module__ = "rclpy.clock"

    def __init__(
        self, *, min_forward: Duration | None, min_backward: Duration | None, on_clock_change: bool = True
    ) -> None:
        if min_forward is not None and min_forward.nanoseconds <= 0:
            raise ValueError("min_forward must be a positive non-zero duration")
        if min_backward is not None and min_backward.nanoseconds >= 0:
            raise ValueError("min_backward must be a negative non-zero duration")
        if min_forward is None and min_backward is None and not on_clock_change:
            raise ValueError("At least one jump threshold must be enabled")
        self.min_forward = min_forward
        self.min_backward = min_backward
        self.on_clock_change = on_clock_change


class TimeJump:
    """A jump: whether the source of time changed, and how far it went (a Duration, negative for back)."""

    __module__ = "rclpy.clock"

    def __init__(self, clock_change: ClockChange, delta: Duration) -> None:
        if not isinstance(clock_change, ClockChange):
            raise TypeError("clock_change must be an instance of rclpy.clock.ClockChange")
        self._clock_change = clock_change
        self._delta = delta

    def __repr__(self) -> str:
        return f"<TimeJump {self._clock_change.name}, delta {self._delta}>"

    @property
    def clock_change(self) -> ClockChange:
        """Whether the source of time changed."""
        return self._clock_change

    @property
    def delta(self) -> Duration:
        """How far it went."""
        return self._delta


class JumpHandle:
    """Made by `Clock.create_jump_callback`. As a context manager it ends with its block."""

    __module__ = "rclpy.clock"

    def __init__(
        self,
        *,
        clock: Clock,
        threshold: JumpThreshold,
        pre_callback: Callable[[], object] | None,
        post_callback: Callable[[Any], object] | None,
    ) -> None:
        if pre_callback is None and post_callback is None:
            raise ValueError("One of pre_callback or post_callback must be callable")
        for name, callback in (("pre_callback", pre_callback), ("post_callback", post_callback)):
            if callback is not None and not callable(callback):
                raise ValueError(f"{name} must be callable if given")
        self._clock: Clock | None = clock
        self._threshold = threshold
        self._pre_callback = pre_callback
        self._post_callback = post_callback
        clock._jump_handles.append(self)

    def unregister(self) -> None:
        """No longer tell of jumps."""
        if self._clock is not None:
            self._clock._jump_handles.remove(self)
            self._clock = None

    def __enter__(self) -> JumpHandle:
        return self

    def __exit__(self, *error: object) -> None:
        self.unregister()

    def before(self, jump: TimeJump) -> None:
        """The clock is about to jump."""
        if self._pre_callback is not None and self._is_wanted(jump):
            self._pre_callback()

    def after(self, jump: TimeJump) -> None:
        """The clock has jumped."""
        if self._post_callback is not None and self._is_wanted(jump):
            self._post_callback(jump)

    def _is_wanted(self, jump: TimeJump) -> bool:
        wish, delta = self._threshold, jump.delta
        if wish.on_clock_change and jump.clock_change in _CHANGES:
            return True
        if wish.min_backward is not None and delta <= wish.min_backward:
            return True
        return wish.min_forward is not None and delta >= wish.min_forward


_CHANGES = (ClockChange.ROS_TIME_ACTIVATED, ClockChange.ROS_TIME_DEACTIVATED)
