"""Timers.

A timer's ticks lie on a fixed grid: a late callback does not shift the next one, and ticks that were missed are dropped
(rcl's timer.c). A timer of period zero is called as often as a real one manages to: about every 47 µs. A timer whose
clock follows /clock is looked at whenever that clock is set.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from turtle_lesson.ros.sim.errors import NeverWakes
from turtle_lesson.ros.sim.simulation import EPOCH, NEVER
from turtle_lesson.ros.sim.strand import running_strand

from ._blocking import WakeUp, drives_the_simulation, somebody_spins
from ._entity import TIMER, Entity
from ._hints import shown
from .callback_groups import CallbackGroup
from .constants import S_TO_NS
from .exceptions import InvalidHandle, RCLError, ROSInterruptException

if TYPE_CHECKING:
    from turtle_lesson.ros.sim.simulation import Simulation
    from turtle_lesson.ros.sim.strand import Strand

    from .clock import Clock, _Followed
    from .context import Context

SHORTEST = 47_000
NOT_BY_THE_SIMULATION = -NEVER


def period_ns(seconds: Any) -> int:
    """A timer's period in ns. Raises TypeError, ValueError or OverflowError for what is no number of seconds."""
    try:
        return int(float(seconds) * S_TO_NS)
    except (TypeError, ValueError, OverflowError) as error:
        raise type(error)(
            f"a timer's period must be a number of seconds, got {shown(seconds)}: try create_timer(0.1, self.tick)"
        ) from None


class Timer(Entity):
    """Made by `Node.create_timer`. `timer_period_ns` can be set; it takes effect after the next tick."""

    _kind = TIMER

    def __init__(
        self,
        callback: Callable[..., Any] | None,
        callback_group: CallbackGroup,
        timer_period_ns: int,
        clock: Clock,
        *,
        context: Context | None = None,
        autostart: bool = True,
    ) -> None:
        super().__init__(callback, callback_group)
        if timer_period_ns < 0:
            raise RCLError(
                f"failed to create timer: timer period must be non-negative, got {timer_period_ns / S_TO_NS:g} s"
            )
        self._clock = clock
        self._simulation = clock._simulation
        self._time = clock._time
        self._period = int(timer_period_ns)
        self._canceled = not autostart
        # When the simulation calls next, which may be too early (ns).
        self._armed: int | None = None if self._time is self._simulation else NOT_BY_THE_SIMULATION
        clock._timers.append(self)
        self._last = self._time.now
        self._next = self._last + self._period
        if autostart:
            self._arm()

    def __repr__(self) -> str:
        return f"<Timer, every {self._period / 1e9:g} s>"

    @property
    def clock(self) -> Clock:
        """The clock that the timer goes by."""
        return self._clock

    @property
    def timer_period_ns(self) -> int:
        """The period in ns."""
        return self._period

    @timer_period_ns.setter
    def timer_period_ns(self, value: int) -> None:
        self._period = int(value)

    def is_ready(self) -> bool:
        """Whether a tick is due."""
        self._check_alive()
        return self._has_work()

    def is_canceled(self) -> bool:
        """Whether the timer was cancelled."""
        self._check_alive()
        return self._canceled

    def cancel(self) -> None:
        """Stop ticking, until `reset`."""
        self._check_alive()
        self._canceled = True

    def reset(self) -> None:
        """Begin anew: the next tick is one period from now."""
        self._check_alive()
        self._canceled = False
        self._next = self._time.now + self._period
        self._arm()

    def time_since_last_call(self) -> int:
        """How long ago the last tick was, in ns."""
        self._check_alive()
        return self._time.now - self._last

    def time_until_next_call(self) -> int | None:
        """How long until the next tick, in ns; None for a cancelled timer."""
        self._check_alive()
        return None if self._canceled else self._next - self._time.now

    # -- in the simulation's time ------------------------------------------------------------------------------------

    def _arm(self) -> None:
        """Be called when the next tick is due. A call that comes earlier is used: then there is only ever one.

        So a watchdog that is reset a thousand times a second does not fill the simulation with calls for nothing.
        """
        if self._armed is None or self._armed > self._next:
            self._armed = self._next
            self._simulation.at(self._next, _on_due, self)

    def _has_work(self) -> bool:
        return not self._canceled and self._time.now >= self._next

    def _take(self) -> tuple[Any, ...]:
        now = self._time.now
        self._last = now
        period = self._period
        due = self._next + period
        if due <= now:
            due = due + period * (1 + (now - due) // period) if period else now
        if period < SHORTEST:
            due = max(due, now + SHORTEST)
        self._next = due
        if self._armed is None:
            self._armed = due
            self._simulation.at(due, _on_due, self)
        return ()

    # -- in the time that is heard on /clock -------------------------------------------------------------------------

    def _follow(self, time: Simulation | _Followed, before: int) -> None:
        """The clock begins or ends to follow /clock: it goes by `time` from now on, and showed `before` (ns) until now.

        What is left of the period is waited for in the new time, if both times are known: 0 in ROS time is not. These are
        rcl's rules.
        """
        now, left = time.now, self._next - before
        self._time = time
        if self._traced is not None:
            self._traced.arrivals = None if time is self._simulation else deque()
        if left and -EPOCH not in (now, before):
            self._last, self._next = now - left, now - left + self._period
        if time is self._simulation:
            self._armed, self._next = None, max(self._next, now)
            self._arm()
        else:
            self._armed = NOT_BY_THE_SIMULATION
            if self._has_work():
                self._signal()

    def _jumped(self) -> None:
        """The clock was set."""
        now = self._time.now
        if self._next <= now:
            if not self._canceled:
                self._signal()
        elif now < self._last:
            self._last, self._next = now, now + self._period

    def destroy(self) -> None:
        """Never tick again."""
        self._canceled = True
        if self in self._clock._timers:
            self._clock._timers.remove(self)
        super().destroy()


def _on_due(timer: Timer) -> None:
    """The simulation calls, as a timer has asked for."""
    now = timer._simulation.now
    if now != timer._armed:
        return  # it has asked for an earlier call since
    timer._armed = None
    if timer._canceled:
        return
    if now >= timer._next:
        timer._signal()
    else:
        timer._arm()


class Rate:
    """Made by `Node.create_rate`: `sleep()` returns when its timer ticks. Another thread must be spinning the node.

    A tick that came while nobody slept is not lost: the next `sleep` returns at once, once (rclpy's timer.py). That is why
    a loop of `rclpy.spin_once(node)` and `rate.sleep()` works if the timer is all that the node has.
    """

    def __init__(self, timer: Timer, *, context: Context) -> None:
        self._timer = timer
        self._context = context
        self._is_destroyed = False
        self._ticked = False
        self._sleepers: list[WakeUp] = []
        timer.callback = self.tick

    def tick(self) -> None:
        """The timer ticks."""
        self._ticked = True
        for wake_up in self._sleepers:
            wake_up.wake()

    @drives_the_simulation
    def sleep(self) -> None:
        """Hold up the caller until the next tick.

        Raises ROSInterruptException after the shutdown, RuntimeError if the rate was destroyed, and NeverWakes where
        nobody could ever let the timer tick (a real one hangs there).
        """
        if not self._context.ok():
            raise ROSInterruptException()
        if self._is_destroyed:
            raise RuntimeError("Rate cannot sleep because it has been destroyed")
        if self._timer._destroyed:
            self.destroy()
            raise InvalidHandle("Rate cannot sleep because the timer has been destroyed")
        strand = running_strand()
        assert strand is not None
        self._wait(strand)
        if not self._context.ok():
            raise ROSInterruptException()

    def _wait(self, strand: Strand) -> None:
        if self._ticked:
            self._ticked = bool(self._sleepers)  # the last caller that leaves clears the tick
            return
        executor = self._timer._executor
        if strand.process.is_notebook and (executor is None or not executor._spun_by_another(strand)):
            # a cell in which nobody spins waits until the timer is due
            timer = self._timer
            WakeUp(self._context).wait(timer._simulation.now + (timer.time_until_next_call() or 0))
            timer._take()
            return
        if not somebody_spins(executor, strand):
            raise NeverWakes(
                "this rate would sleep forever: it is woken by a timer of its node, and no other thread is spinning "
                "the node. Use a timer instead of a loop, or a MultiThreadedExecutor."
            )
        wake_up = WakeUp(self._context)
        self._sleepers.append(wake_up)
        try:
            wake_up.wait(None)
        finally:
            self._sleepers.remove(wake_up)
            if not self._sleepers:
                self._ticked = False

    def destroy(self) -> None:
        """Wake the sleeping callers, and never sleep again."""
        self._is_destroyed = True
        for wake_up in self._sleepers:
            wake_up.wake()
