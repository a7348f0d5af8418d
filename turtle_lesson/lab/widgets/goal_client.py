"""Goals for the navigator: sent to /navigate_to as any client would, and what became of each."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any
from weakref import WeakSet

from ...ros.stdlib.clocks import real_monotonic
from .backend import Backend
from .lazy_endpoints import DISCOVERY, ServerWatcher

SERVICE = "/navigate_to"
AT_ONCE = 0.5
"""An answer within so much robot time, s, that tells of no driving, is a refusal."""

WAITING = ("looking for the navigator", "on its way")


@dataclass(slots=True)
class Goal:
    """One goal that was sent: a place (m), a heading (rad), and what is known of it."""

    number: int
    x: float
    y: float
    theta: float
    sent: float
    """Robot time at which it was sent, s."""
    away: float | None = None
    """How far it was from the turtle then, m."""
    state: str = "looking for the navigator"
    """One of WAITING, or "reached", "not reached", "refused", "busy", "not sent", "no answer"."""
    answer: str = ""
    """The service's answer, and what the navigator said about it, or why there is none."""
    ended: float | None = None
    """Robot time of the answer, s."""

    def as_state(self) -> dict[str, Any]:
        """What the browser is told."""
        return {name: getattr(self, name) for name in self.__slots__}

    @property
    def was_taken(self) -> bool:
        """Whether the navigator set out for it, and did not lose it on the way."""
        return self.state in ("on its way", "reached", "not reached")

    @property
    def waits(self) -> bool:
        """Whether there is no answer yet."""
        return self.state in WAITING


_desks: WeakSet[GoalClient] = WeakSet()


def goals_from(backend: Backend) -> list[Goal]:
    """All goals that were sent from this page, whichever of its widgets sent them, the oldest first."""
    here = [desk for desk in _desks if desk.recorder is backend.recorder]
    return sorted((goal for desk in here for goal in desk.goals), key=lambda goal: goal.sent)


class GoalClient:
    """Sends goals and keeps their list; `changed(goal)` is called with each news of one."""

    def __init__(self, backend: Backend, changed: Callable[[Goal], None]) -> None:
        self._backend, self._changed = backend, changed
        self._client: Any = None
        self._found_by = 0.0
        self._asked: dict[int, Any] = {}
        self._unexplained: dict[int, Goal] = {}
        self._wanted = False
        self.server = ServerWatcher(backend, SERVICE, self._explain)
        self.goals: list[Goal] = []
        _desks.add(self)

    @property
    def recorder(self) -> object:
        """What the desk's system is known by; None once it has ended."""
        return None if self._backend.ended else self._backend.recorder

    def send(self, x: float, y: float, theta: float) -> Goal:
        """Ask the navigator to drive there. Raises ValueError for what is no number."""
        for name, value in (("x", x), ("y", y), ("heading", theta)):
            if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
                raise ValueError(f"A goal's {name} must be a number, got {value!r}.")
        goal = Goal(len(self.goals) + 1, float(x), float(y), float(theta), self._backend.now)
        if pose := self._backend.recorder.pose():
            goal.away = math.dist((goal.x, goal.y), pose[:2])
        self.goals.append(goal)
        self._ask(goal)
        self._changed(goal)
        return goal

    def look(self) -> None:
        """Look whether the navigator is there for the goals that wait. Call it now and then."""
        if not any(goal.waits for goal in self.goals):
            return
        gone = not self.server.is_there()
        for goal in [goal for goal in self.goals if goal.waits]:
            if goal.state != "on its way":
                self._ask(goal)
            elif gone:
                self._client.remove_pending_request(self._asked.pop(goal.number, None))
                words = "The navigator was stopped on the way; send the goal again when another one is running."
                self._finish(goal, "no answer", words)

    def open(self) -> None:
        """Somebody looks."""
        self._wanted = True

    def rest(self) -> None:
        """The widget is no longer shown: stop listening, as soon as every goal has its answer."""
        self._wanted = False
        self._leave_if_done()

    def close(self) -> None:
        """Ask no more."""
        self._asked.clear()
        self.server.close()
        if self._client is not None:
            self._backend.node.destroy_client(self._client)
            self._client = None

    def _ask(self, goal: Goal) -> None:
        try:
            from robot_controller.srv import NavigateTo

            request = NavigateTo.Request(x=goal.x, y=goal.y, theta=goal.theta)
        except ImportError:
            build = "colcon build --packages-select robot_controller, then source install/setup.bash"
            words = f"The package robot_controller is not here. Build it and source it: {build}"
            self._finish(goal, "not sent", words)
        except (AssertionError, TypeError, ValueError) as error:  # too large for its float32
            self._finish(goal, "not sent", f"{error}")
        else:
            self._call(goal, NavigateTo, request)

    def _call(self, goal: Goal, service: Any, request: Any) -> None:
        now = real_monotonic()
        if self._client is None or self._client.srv_type is not service:  # built anew, it is another one
            self.close()
            self._client = self._backend.node.create_client(service, SERVICE)
            self._found_by = now + (DISCOVERY if self._backend.clock is None else 0)
        if not self._client.service_is_ready():
            if now >= self._found_by:
                self._finish(goal, "not sent", f"No node answers {SERVICE}. {self._how_to_start()}")
            return
        goal.state = "on its way"
        self._asked[goal.number] = future = self._client.call_async(request)
        self.server.listen()  # after the request, which need not wait for it: nothing is heard within this turn of the loop
        future.add_done_callback(partial(self._answered, goal))

    def _how_to_start(self) -> str:
        by_hand = "ros2 run robot_controller navigator"
        if self._backend.clock is None:
            return f"Start the navigator in a terminal: {by_hand}"
        return f'Start the navigator: lesson.launch("robot_controller", "start_system.launch.py") or {by_hand} &'

    def _answered(self, goal: Goal, future: Any) -> None:
        if self._asked.pop(goal.number, None) is None:
            return
        try:
            response = future.result()
        except Exception as error:
            self._finish(goal, "no answer", f"The call failed: {error}")
            return
        state = "reached"
        if not response.success:
            drove = response.time_taken or self._backend.now - goal.sent > AT_ONCE
            busy = any(other.state == "on its way" and other.number < goal.number for other in self.goals)
            state = "not reached" if drove else "busy" if busy else "refused"
            self._unexplained[goal.number] = goal
        self._finish(goal, state, f"success: {response.success}, time_taken: {response.time_taken:.1f} s")
        self._explain()

    def _explain(self) -> None:
        """Give the goals that failed the navigator's own words; these come a little after its answer."""
        for number, goal in list(self._unexplained.items()):
            assert goal.ended is not None
            reason = self.server.why(goal.sent, goal.ended, last=goal.state == "not reached")
            if reason:
                del self._unexplained[number]
                goal.answer = f"{reason} ({goal.answer})"
                self._changed(goal)

    def _finish(self, goal: Goal, state: str, answer: str) -> None:
        goal.state, goal.answer, goal.ended = state, answer, self._backend.now
        self._changed(goal)
        self._leave_if_done()

    def _leave_if_done(self) -> None:
        if not self._wanted and not any(goal.waits for goal in self.goals):
            self.close()
