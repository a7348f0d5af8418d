"""Timers, and rates to sleep by.

A timer's ticks lie on a fixed grid: a late callback does not shift the next one, and ticks that were missed are dropped
(rcl's timer.c). A timer of period zero is called as often as a real one manages to: about every 47 µs.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from turtle_lesson.ros.core import NeverWakes, running_strand

from ._blocking import drives_the_simulation
from ._entity import TIMER, Entity
from ._mistakes import shown
from ._notebook import is_notebook
from .callback_groups import CallbackGroup
from .constants import S_TO_NS
from .exceptions import RCLError

if TYPE_CHECKING:
    from .clock import Clock
    from .context import Context

SHORTEST = 47_000


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
        callback_group: CallbackGroup | None,
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
        self._period = int(timer_period_ns)
        self._canceled = not autostart
        self._last = self._simulation.now
        self._next = self._last + self._period
        self._armed: int | None = None  # when the simulation calls next, which may be too early (ns)
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
        return not self._canceled and self._simulation.now >= self._next

    def is_canceled(self) -> bool:
        """Whether the timer was cancelled."""
        return self._canceled

    def cancel(self) -> None:
        """Stop ticking, until `reset`."""
        self._canceled = True

    def reset(self) -> None:
        """Begin anew: the next tick is one period from now."""
        self._canceled = False
        self._next = self._simulation.now + self._period
        self._arm()

    def time_since_last_call(self) -> int:
        """How long ago the last tick was, in ns."""
        return self._simulation.now - self._last

    def time_until_next_call(self) -> int | None:
        """How long until the next tick, in ns; None for a cancelled timer."""
        return None if self._canceled else self._next - self._simulation.now

    def _arm(self) -> None:
        """Be called when the next tick is due. A call that comes earlier is used: then there is only ever one.

        So a watchdog that is reset a thousand times a second does not fill the simulation with calls for nothing.
        """
        if self._armed is None or self._armed > self._next:
            self._armed = self._next
            self._simulation.at(self._next, self._on_due, self._next)

    def _on_due(self, due: int) -> None:
        if due != self._armed:
            return
        self._armed = None
        if self._canceled:
            return
        if due >= self._next:
            self._signal()
        else:
            self._arm()

    def _has_work(self) -> bool:
        return not self._canceled and self._simulation.now >= self._next

    def _take(self) -> tuple[Any, ...]:
        now = self._simulation.now
        self._last = now
        period = self._period
        due = self._next + period
        if due < now:
            due = due + period * (1 + (now - due - 1) // period) if period else now
        if period < SHORTEST:
            due = max(due, now + SHORTEST)
        self._next = due
        if self._armed is None:
            self._armed = due
            self._simulation.at(due, self._on_due, due)
        return ()

    def destroy(self) -> None:
        """Never tick again."""
        self._canceled = True
        super().destroy()


class Rate:
    """Made by `Node.create_rate`: `sleep()` returns once a period. Another thread must be spinning the node."""

    def __init__(self, timer: Timer, *, context: Context | None = None) -> None:
        self._timer = timer
        self._period = timer.timer_period_ns
        self._next = timer._simulation.now + self._period

    @drives_the_simulation
    def sleep(self) -> None:
        """Hold up the caller until the next whole period."""
        self._check_somebody_spins()
        simulation = self._timer._simulation
        while self._next <= simulation.now:
            self._next += self._period
        simulation.sleep_until(self._next)
        self._next += self._period

    def _check_somebody_spins(self) -> None:
        strand = running_strand()
        if strand is None or is_notebook(strand.process):
            return
        executor = self._timer._executor
        if executor is None or not executor._spun_by_another(strand):
            raise NeverWakes(
                "this rate would sleep for ever: it is woken by a timer of its node, and no other thread is spinning "
                "the node. Use a timer instead of a loop, or a MultiThreadedExecutor."
            )

    def destroy(self) -> None:
        """Stop the timer behind it."""
        self._timer.destroy()
