"""Goals for the navigator: sent to /navigate_to as any client would, and what became of each."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any
from weakref import WeakSet

from rcl_interfaces.msg import Log
from rclpy.subscription import Subscription

from ...ros.stdlib.clocks import real_monotonic
from ..graph import owner, servers
from ..words import within
from .backend import DISCOVERY, Backend

SERVICE = "/navigate_to"
AT_ONCE = 0.5
"""An answer within so much robot time, s, that tells of no driving, is a refusal."""

WARNING = 30
"""rcl_interfaces/msg/Log: this level and those above it."""

SLACK = 0.1
"""Robot time, s, by which a warning may be older than its call, or newer than the answer to it."""

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
        x, y, theta = within("goal's x", x), within("goal's y", y), within("goal's heading", theta)
        goal = Goal(len(self.goals) + 1, x, y, theta, self._backend.now)
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
                by_hand = "ros2 run robot_controller navigator"
                how = f'Start the navigator: lesson.launch("robot_controller", "start_system.launch.py") or {by_hand} &'
                if self._backend.clock is None:
                    how = f"Start the navigator in a terminal: {by_hand}"
                self._finish(goal, "not sent", f"No node answers {SERVICE}. {how}")
            return
        goal.state = "on its way"
        self._asked[goal.number] = future = self._client.call_async(request)
        self.server.listen()  # after the request, which need not wait for it: nothing is heard within this turn of the loop
        future.add_done_callback(partial(self._answered, goal))

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


class ServerWatcher:
    """Watches the node that offers one service: whether it is still there, and its warnings; `said()` is called at each."""

    def __init__(self, backend: Backend, service: str, said: Callable[[], None]) -> None:
        self._backend, self._service, self._said = backend, service, said
        self._subscription: Subscription | None = None
        self._names: list[str] = []
        self._ends: set[tuple[int, ...]] = set()
        self._warnings: deque[tuple[float, str]] = deque(maxlen=1000)

    def listen(self) -> None:
        """Notice which node offers the service now, and listen to its warnings."""
        self._names = [name for name, _ in servers(self._backend.node, self._service)]
        self._ends = self._rosout_ends()
        if self._subscription is None:
            self._subscription = self._backend.node.create_subscription(Log, "/rosout", self._hear, 1000)

    def close(self) -> None:
        """Listen no more."""
        if self._subscription is not None:
            self._backend.node.destroy_subscription(self._subscription)
            self._subscription = None

    def is_there(self) -> bool:
        """Whether it is the one that was there when `listen` was called: started again, it has forgotten all calls."""
        return bool(servers(self._backend.node, self._service)) and self._ends <= self._rosout_ends()

    def why(self, called: float, answered: float, *, last: bool) -> str:
        """What it warned of between a call and its answer (robot time, s), or "". A warning is given out once.

        Of several, one about a goal is preferred; then the first, or the `last`.
        """
        found = [each for each in self._warnings if called - SLACK <= each[0] <= answered + SLACK]
        found = [each for each in found if "goal" in each[1].lower()] or found
        if not found:
            return ""
        chosen = found[-1 if last else 0]
        self._warnings.remove(chosen)
        # without "Goal refused:" in front, since the state says that already; with a capital and a full stop
        head, colon, rest = chosen[1].partition(": ")
        text = rest if colon and head.lower().startswith("goal") else chosen[1]
        return f"{text[:1].upper()}{text[1:]}".rstrip(".") + "."

    def _hear(self, message: Any) -> None:
        names = [name.strip("/").replace("/", ".") for name in self._names]
        if message.level >= WARNING and any(f"{message.name}.".startswith(f"{name}.") for name in names):
            stamp = message.stamp.sec * 1_000_000_000 + message.stamp.nanosec
            self._warnings.append((self._backend.recorder.seconds(stamp), message.msg))
            self._said()

    def _rosout_ends(self) -> set[tuple[int, ...]]:
        """What tells this very node from the next one of its name: the end with which it publishes its log."""
        return {
            tuple(end.endpoint_gid)
            for end in self._backend.node.get_publishers_info_by_topic("/rosout")
            if owner(end) in self._names
        }
