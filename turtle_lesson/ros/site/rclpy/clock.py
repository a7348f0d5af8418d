"""Clocks. All of them show virtual time: system and ROS time since 1970, steady time since the world's start.

A ROS clock that is told to (by the parameter use_sim_time of its node) follows the topic /clock instead.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from turtle_lesson.ros.runtime.world import current_world
from turtle_lesson.ros.sim.simulation import EPOCH

from ._blocking import WakeUp, drives_the_simulation
from ._entity import Handle
from .clock_type import CEnum, ClockType
from .context import Context
from .duration import Duration
from .exceptions import NotInitializedException
from .time import Time
from .utilities import get_default_context

if TYPE_CHECKING:
    from turtle_lesson.ros.sim.simulation import Simulation

    from .time_source import TimeSource
    from .timer import Timer


class Clock:
    """A clock of one kind; looking at it costs a microsecond of virtual time.

    `Clock(clock_type=ClockType.ROS_TIME)` is a `ROSClock`.
    """

    _clock_type: ClockType
    _origin: int
    """What it showed when the world began (ns)."""
    _simulation: Simulation
    _time: Simulation | _Followed
    """What it goes by: the simulation, or what is heard on /clock."""
    _followed: _Followed
    _source: TimeSource | None
    _timers: list[Timer]
    _jump_handles: list[JumpHandle]

    def __new__(cls, *, clock_type: ClockType = ClockType.SYSTEM_TIME) -> Clock:
        if not isinstance(clock_type, ClockType):
            raise TypeError("Clock type must be a ClockType enum")
        clock = super().__new__(ROSClock if clock_type is ClockType.ROS_TIME else cls)
        clock._clock_type = clock_type
        clock._origin = 0 if clock_type == ClockType.STEADY_TIME else EPOCH
        clock._time = clock._simulation = current_world().sim
        clock._followed, clock._source = _Followed(), None
        clock._timers, clock._jump_handles = [], []
        return clock

    @property
    def clock_type(self) -> ClockType:
        """Which kind of clock this is."""
        return self._clock_type

    @property
    def handle(self) -> Handle:
        """What stands for the C object of the real one."""
        return Handle(self)

    def __repr__(self) -> str:
        return f"Clock(clock_type={self._clock_type.name})"

    def now(self) -> Time:
        """The time now. One that follows /clock stands still between two messages, and shows 0 before the first."""
        self._simulation.read_clock()
        return Time(nanoseconds=self._origin + self._time.now, clock_type=self._clock_type)

    def _now(self) -> int:
        """The time now (ns); looking at it costs no virtual time."""
        return self._origin + self._time.now

    def create_jump_callback(
        self,
        threshold: JumpThreshold,
        *,
        pre_callback: Callable[[], object] | None = None,
        post_callback: Callable[[TimeJump], object] | None = None,
    ) -> JumpHandle:
        """Have functions called right before and after a jump: `pre_callback()` and `post_callback(time_jump)`.

        Raises ValueError if neither is given, or one is no function.
        """
        return JumpHandle(clock=self, threshold=threshold, pre_callback=pre_callback, post_callback=post_callback)

    @drives_the_simulation
    def sleep_until(self, until: Time, context: Context | None = None) -> bool:
        """Hold up the caller until a time on this clock; True when it has come.

        False if the context was shut down meanwhile, or ROS time began or ended to follow /clock. Raises ValueError
        for a time of another kind of clock, NotInitializedException without a context that is up.
        """
        context = get_default_context() if context is None else context
        if not context.ok():
            raise NotInitializedException()
        if until.clock_type != self._clock_type:
            raise ValueError("until's clock type does not match this clock's type")
        changed = False
        wake_up = WakeUp(context)

        def on_jump(jump: TimeJump) -> None:
            nonlocal changed
            changed = changed or jump.clock_change != ClockChange.ROS_TIME_NO_CHANGE
            if changed or self._now() >= until.nanoseconds:
                wake_up.wake()

        every_jump = JumpThreshold(min_forward=Duration(nanoseconds=1), min_backward=None)
        with self.create_jump_callback(every_jump, post_callback=on_jump):
            if self._time is self._simulation:
                wake_up.wait(until.nanoseconds - self._origin)
            elif self._now() < until.nanoseconds:
                if self._source is not None:
                    self._source.check_it_may_hear(wake_up.strand)
                wake_up.wait(None)
        return context.ok() and not changed and self._now() >= until.nanoseconds

    @drives_the_simulation
    def sleep_for(self, rel_time: Duration, context: Context | None = None) -> bool:
        """Hold up the caller for a duration on this clock; True when it is over, False as for `sleep_until`.

        A negative duration is over at once.
        """
        now = Time(nanoseconds=self._now(), clock_type=self._clock_type)
        rel_time = max(rel_time, Duration(nanoseconds=-now.nanoseconds))  # steady time is small, and never negative
        return self.sleep_until(now + rel_time, context)


class _Followed:
    """The time that was last heard of on /clock, in the place of a simulation.

    Attributes:
        now: in ns, counted as the simulation counts them; ROS time, which is that since 1970, is 0 before the first message.
    """

    now = -EPOCH


class ROSClock(Clock):
    """The clock of nodes."""

    def __new__(cls) -> ROSClock:
        clock: Any = super().__new__(Clock, clock_type=ClockType.ROS_TIME)
        return clock

    @property
    def ros_time_is_active(self) -> bool:
        """Whether a `/clock` topic rules this clock."""
        return self._time is self._followed

    def _set_ros_time_is_active(self, enabled: bool) -> None:
        """Begin or end to follow /clock; a TimeSource does it."""
        if self.ros_time_is_active == enabled:
            return
        before = self._time.now

        def change() -> None:
            self._time = self._followed if enabled else self._simulation
            for timer in self._timers:
                timer._follow(self._time, before)

        what = ClockChange.ROS_TIME_ACTIVATED if enabled else ClockChange.ROS_TIME_DEACTIVATED
        self._jump(TimeJump(what, Duration()), change)

    def set_ros_time_override(self, time: Time) -> None:
        """Set the time that this clock shows while it is ruled by /clock. Raises TypeError for what is no Time."""
        if not isinstance(time, Time):
            raise TypeError(f"Time must be specified as rclpy.time.Time. Received type: {type(time)}")
        now = time.nanoseconds - EPOCH

        def change() -> None:
            self._followed.now = now
            for timer in self._timers:
                timer._jumped()

        if self.ros_time_is_active:
            delta = Duration(nanoseconds=now - self._followed.now)
            self._jump(TimeJump(ClockChange.ROS_TIME_NO_CHANGE, delta), change)
        else:
            self._followed.now = now

    def _jump(self, jump: TimeJump, change: Callable[[], None]) -> None:
        """Carry out the change that a jump is; call before and after it what wants to know of such jumps."""
        handles = [handle for handle in self._jump_handles if handle.wants(jump)]
        for handle in handles:
            if handle.pre_callback is not None:
                handle.pre_callback()
        change()
        for handle in handles:
            if handle.post_callback is not None:
                handle.post_callback(jump)


# -- jumps of a clock (which callbacks are called: rcl's time.c) ------------------------------------------------------


class ClockChange(CEnum):
    """Whether a jump changes the source of ROS time: /clock (activated), or the system's clock (deactivated)."""

    ROS_TIME_NO_CHANGE = 1
    ROS_TIME_ACTIVATED = 2
    ROS_TIME_DEACTIVATED = 3
    SYSTEM_TIME_NO_CHANGE = 4


@dataclass(kw_only=True)
class JumpThreshold:
    """Of which jumps one wants to know. Raises ValueError if a duration has the wrong sign, or no jump at all is wanted."""

    min_forward: Duration | None
    """The shortest jump forward, a positive Duration; None for no jump forward."""
    min_backward: Duration | None
    """The shortest jump back, a negative Duration; None for no jump back."""
    on_clock_change: bool = True
    """Whether to know of changes of the source."""

    def __post_init__(self) -> None:
        if self.min_forward is not None and self.min_forward.nanoseconds <= 0:
            raise ValueError("min_forward must be a positive non-zero duration")
        if self.min_backward is not None and self.min_backward.nanoseconds >= 0:
            raise ValueError("min_backward must be a negative non-zero duration")
        if self.min_forward is None and self.min_backward is None and not self.on_clock_change:
            raise ValueError("At least one jump threshold must be enabled")


@dataclass(frozen=True)
class TimeJump:
    """A jump: whether the source of time changed, and how far it went (negative for back)."""

    clock_change: ClockChange
    delta: Duration


@dataclass(kw_only=True, eq=False)
class JumpHandle:
    """Made by `Clock.create_jump_callback`. As a context manager it ends with its block."""

    clock: Clock
    threshold: JumpThreshold
    pre_callback: Callable[[], object] | None
    post_callback: Callable[[TimeJump], object] | None

    def __post_init__(self) -> None:
        given = [callback for callback in (self.pre_callback, self.post_callback) if callback is not None]
        if not given or not all(map(callable, given)):
            raise ValueError("One of pre_callback or post_callback must be callable, and so must the other if given")
        self.clock._jump_handles.append(self)

    def unregister(self) -> None:
        """No longer tell of jumps."""
        if self in self.clock._jump_handles:
            self.clock._jump_handles.remove(self)

    def __enter__(self) -> JumpHandle:
        return self

    def __exit__(self, *error: object) -> None:
        self.unregister()

    def wants(self, jump: TimeJump) -> bool:
        """Whether this is one of the jumps to know of."""
        wish, delta = self.threshold, jump.delta
        if jump.clock_change in (ClockChange.ROS_TIME_ACTIVATED, ClockChange.ROS_TIME_DEACTIVATED):
            return wish.on_clock_change
        if wish.min_backward is not None and delta <= wish.min_backward:
            return True
        return wish.min_forward is not None and delta >= wish.min_forward
