"""Rates to sleep by. Everybody knows them as `rclpy.timer.Rate`."""

from __future__ import annotations

from typing import TYPE_CHECKING

from turtle_lesson.ros.core import NeverWakes, running_strand

from ._alarm import Alarm, somebody_spins
from ._blocking import drives_the_simulation
from ._notebook import is_notebook
from .exceptions import InvalidHandle, ROSInterruptException

if TYPE_CHECKING:
    from turtle_lesson.ros.core import Strand

    from .context import Context
    from .timer import Timer


class Rate:
    """Made by `Node.create_rate`: `sleep()` returns when its timer ticks. Another thread must be spinning the node.

    A tick that came while nobody slept is not lost: the next `sleep` returns at once, once (rclpy's timer.py). That is why
    a loop of `rclpy.spin_once(node)` and `rate.sleep()` works if the timer is all that the node has.
    """

    __module__ = "rclpy.timer"

    def __init__(self, timer: Timer, *, context: Context) -> None:
        self._timer = timer
        self._context = context
        self._is_shutdown = False
        self._is_destroyed = False
        self._ticked = False
        self._sleepers: list[Alarm] = []
        timer.callback = self.tick
        context.wake_at_the_end(self._on_shutdown)

    def tick(self) -> None:
        """The timer ticks."""
        self._ticked = True
        for alarm in self._sleepers:
            alarm.ring()

    def _on_shutdown(self) -> None:
        self._is_shutdown = True
        self.destroy()

    @drives_the_simulation
    def sleep(self) -> None:
        """Hold up the caller until the next tick.

        Raises ROSInterruptException after the shutdown, RuntimeError if the rate was destroyed, and NeverWakes where
        nobody could ever let the timer tick (a real one hangs there).
        """
        if self._is_shutdown:
            raise ROSInterruptException()
        if self._is_destroyed:
            raise RuntimeError("Rate cannot sleep because it has been destroyed")
        if self._timer._destroyed:
            self.destroy()
            raise InvalidHandle("Rate cannot sleep because the timer has been destroyed")
        strand = running_strand()
        assert strand is not None
        self._wait(strand)
        if self._is_shutdown:
            raise ROSInterruptException()

    def _wait(self, strand: Strand) -> None:
        if self._ticked:
            self._ticked = bool(self._sleepers)  # the last one who leaves clears the tick
            return
        executor = self._timer._executor
        if is_notebook(strand.process) and (executor is None or not executor._spun_by_another(strand)):
            self._wait_alone()
            return
        if not somebody_spins(executor, strand):
            raise NeverWakes(
                "this rate would sleep forever: it is woken by a timer of its node, and no other thread is spinning "
                "the node. Use a timer instead of a loop, or a MultiThreadedExecutor."
            )
        alarm = Alarm(self._context)
        self._sleepers.append(alarm)
        try:
            alarm.wait(None)
        finally:
            self._sleepers.remove(alarm)
            if not self._sleepers:
                self._ticked = False

    def _wait_alone(self) -> None:
        """In a notebook's cell, where nobody spins: until the timer is due."""
        timer, alarm = self._timer, Alarm(self._context)
        left = timer.time_until_next_call() or 0
        if timer._time is not timer._simulation and left > 0:
            raise NeverWakes(
                "this rate would sleep forever: its clock follows /clock, and nothing receives /clock meanwhile"
            )
        alarm.wait(timer._simulation.now + left)
        timer._take()

    def destroy(self) -> None:
        """Wake the sleeping callers, and never sleep again."""
        self._is_destroyed = True
        for alarm in self._sleepers:
            alarm.ring()
