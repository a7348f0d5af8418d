"""Goals for the navigator: sent to /navigate_to as any client would, and what became of each."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any
from weakref import WeakSet

from .station import Station

SERVICE = "/navigate_to"
WORLD = 11.088889
"""Side of turtlesim's square world, m."""


@dataclass(slots=True)
class Goal:
    """One goal that was sent: a place (m), a heading (rad), and what is known of it."""

    number: int
    x: float
    y: float
    theta: float
    sent: float
    """Robot time at which it was sent, s."""
    state: str = "on its way"
    """"on its way", "reached", "not reached", "refused" or "not sent"."""
    answer: str = ""
    """The service's answer, or why there is none, in words."""

    def as_state(self) -> dict[str, Any]:
        """What the browser is told."""
        return {name: getattr(self, name) for name in ("number", "x", "y", "theta", "sent", "state", "answer")}


_desks: WeakSet[GoalDesk] = WeakSet()


def goals_from(station: Station) -> list[Goal]:
    """All goals that were sent from this page, whichever of its widgets sent them, in their order."""
    here = [desk for desk in _desks if desk.recorder is station.recorder]
    return sorted((goal for desk in here for goal in desk.goals), key=lambda goal: goal.sent)


class GoalDesk:
    """Sends goals and keeps their list; `changed(goal)` is called with each news of one."""

    def __init__(self, station: Station, changed: Callable[[Goal], None]) -> None:
        self._station, self._changed = station, changed
        self._client: Any = None
        self.goals: list[Goal] = []
        _desks.add(self)

    @property
    def recorder(self) -> object:
        """What this desk's system is known by."""
        return self._station.recorder

    @property
    def current(self) -> Goal | None:
        """The goal that the turtle is on its way to."""
        return next((goal for goal in reversed(self.goals) if goal.state == "on its way"), None)

    def send(self, x: float, y: float, theta: float) -> Goal:
        """Ask the navigator to drive there. Raises ValueError for what is no number."""
        for name, value in (("x", x), ("y", y), ("theta", theta)):
            if isinstance(value, bool) or not isinstance(value, (int, float)) or not math.isfinite(value):
                raise ValueError(f"A goal's {name} must be a number, got {value!r}.")
        goal = Goal(len(self.goals) + 1, float(x), float(y), float(theta), self._station.now)
        self.goals.append(goal)
        self._call(goal)
        self._changed(goal)
        return goal

    def close(self) -> None:
        """Ask no more."""
        if self._client is not None:
            self._station.node.destroy_client(self._client)
            self._client = None

    def _call(self, goal: Goal) -> None:
        try:
            from robot_controller.srv import NavigateTo
        except ImportError as error:
            self._finish(goal, "not sent", f"There is no NavigateTo to ask with: {error}")
            return
        if self._client is None:
            self._client = self._station.node.create_client(NavigateTo, SERVICE)
        if not self._client.service_is_ready():
            self._finish(goal, "not sent", f"Nobody offers {SERVICE}. Start the navigator, then click again.")
            return
        future = self._client.call_async(NavigateTo.Request(x=goal.x, y=goal.y, theta=goal.theta))
        future.add_done_callback(lambda done: self._station.loop.now_or_soon(self._answered, goal, done))

    def _answered(self, goal: Goal, future: Any) -> None:
        try:
            response = future.result()
        except Exception as error:
            self._finish(goal, "not reached", f"The call failed: {error}")
            return
        seconds = f"{response.time_taken:.1f} s"
        if response.success:
            self._finish(goal, "reached", f"success: True, time_taken: {seconds}")
        elif response.time_taken == 0:
            self._finish(goal, "refused", f"success: False, time_taken: {seconds}")
        else:
            self._finish(goal, "not reached", f"success: False, time_taken: {seconds}")

    def _finish(self, goal: Goal, state: str, answer: str) -> None:
        goal.state, goal.answer = state, answer
        self._changed(goal)
