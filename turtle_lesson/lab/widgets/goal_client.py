"""Goals for the navigator: sent to /navigate_to as any client would, and what became of each."""

from __future__ import annotations

import math
import re
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any

from rcl_interfaces.msg import Log
from rclpy.subscription import Subscription
from rclpy.task import Future

from ..graph import owner, servers
from ..recording import NANOSECONDS
from ..words import within
from .backend import DISCOVERY, Link

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

    @property
    def waits(self) -> bool:
        """Whether there is no answer yet."""
        return self.state in WAITING


class GoalClient:
    """Sends goals and keeps their list; `changed(goal)` is called with each news of one.

    It also watches the node that answers: whether it is still there, and its warnings, which say why a goal failed.
    """

    def __init__(self, backend: Link, changed: Callable[[Goal], None]) -> None:
        self._backend, self._changed = backend, changed
        self._client: Any = None
        self._unexplained: dict[int, Goal] = {}
        self._log: Subscription | None = None
        self._servers: list[str] = []
        self._ends: set[tuple[int, ...]] = set()
        self._warnings: deque[tuple[float, str]] = deque(maxlen=1000)
        self.goals: list[Goal] = []

    def send(self, x: float, y: float, theta: float) -> Goal:
        """Ask the navigator to drive there. Raises ValueError for what is no number."""
        x, y, theta = within("goal's x", x), within("goal's y", y), within("goal's heading", theta)
        goal = Goal(len(self.goals) + 1, x, y, theta, self._backend.now)
        if pose := self._backend.recorder.pose():
            goal.away = math.dist((goal.x, goal.y), pose[:2])
        self.goals.append(goal)
        self._backend.recorder.goals.append(goal)
        self._ask(goal)
        self._changed(goal)
        return goal

    def look(self) -> None:
        """Look whether the navigator is there for the goals that wait. Call it now and then."""
        for goal in [goal for goal in self.goals if goal.waits]:
            if goal.state != "on its way":
                self._ask(goal)
            # started again, it has forgotten all calls: the end with which it publishes its log is another one then
            elif not (self._client.service_is_ready() and self._ends <= self._rosout_ends()):
                words = "The navigator was stopped on the way; send the goal again when another one is running."
                self._finish(goal, "no answer", words)

    def close(self) -> None:
        """Ask no more, and listen no more."""
        if self._log is not None:
            self._backend.node.destroy_subscription(self._log)
        if self._client is not None:
            self._backend.node.destroy_client(self._client)
        self._log = self._client = None

    def _ask(self, goal: Goal) -> None:
        try:
            from robot_controller.srv import NavigateTo

            request = NavigateTo.Request(x=goal.x, y=goal.y, theta=goal.theta)
        except ImportError:
            build = "colcon build --packages-select robot_controller, then source install/setup.bash"
            self._finish(goal, "not sent", f"The package robot_controller is not here. Build it and source it: {build}")
            return
        except (AssertionError, TypeError, ValueError) as error:  # too large for its float32
            self._finish(goal, "not sent", f"{error}")
            return
        node = self._backend.node
        if self._client is None or self._client.srv_type is not NavigateTo:  # built anew, it is another one
            self.close()
            self._client = node.create_client(NavigateTo, SERVICE)
        if self._client.service_is_ready():
            goal.state = "on its way"
            future = self._client.call_async(request)
            # after the request, which need not wait for it: nothing is heard within this turn of the loop
            self._servers = [name for name, _ in servers(node, SERVICE)]
            self._ends = self._rosout_ends()
            self._log = self._log or node.create_subscription(Log, "/rosout", self._hear, 1000)
            future.add_done_callback(partial(self._answered, goal))
        elif self._backend.clock is not None or self._backend.now - goal.sent > DISCOVERY:
            by_hand = "ros2 run robot_controller navigator"
            how = f'Start the navigator: lesson.launch("robot_controller", "start_system.launch.py") or {by_hand} &'
            if self._backend.clock is None:
                how = f"Start the navigator in a terminal: {by_hand}"
            self._finish(goal, "not sent", f"No node answers {SERVICE}. {how}")

    def _answered(self, goal: Goal, future: Future) -> None:
        if not goal.waits:
            return
        response, state = future.result(), "reached"
        if not response.success:
            drove = response.time_taken or self._backend.now - goal.sent > AT_ONCE
            busy = any(other.state == "on its way" and other.number < goal.number for other in self.goals)
            state = "not reached" if drove else "busy" if busy else "refused"
            self._unexplained[goal.number] = goal
        self._finish(goal, state, f"success: {response.success}, time_taken: {response.time_taken:.1f} s")
        self._explain()

    def _finish(self, goal: Goal, state: str, answer: str) -> None:
        goal.state, goal.answer, goal.ended = state, answer, self._backend.now
        self._changed(goal)

    def _hear(self, message: Log) -> None:
        names = [name.strip("/").replace("/", ".") for name in self._servers]
        if message.level >= WARNING and any(f"{message.name}.".startswith(f"{name}.") for name in names):
            stamp = message.stamp.sec * NANOSECONDS + message.stamp.nanosec
            self._warnings.append((self._backend.recorder.seconds(stamp), message.msg))
            self._explain()

    def _explain(self) -> None:
        """Give the goals that failed the navigator's own words; these come a little after its answer.

        Of several warnings between a call and its answer, one about a goal is preferred; then the first, or, after a drive,
        the last. Each is given out once.
        """
        for number, goal in list(self._unexplained.items()):
            assert goal.ended is not None
            said = [each for each in self._warnings if goal.sent - SLACK <= each[0] <= goal.ended + SLACK]
            said = [each for each in said if "goal" in each[1].lower()] or said
            if not said:
                continue
            chosen = said[-1 if goal.state == "not reached" else 0]
            self._warnings.remove(chosen)
            del self._unexplained[number]
            # without "Goal refused:" in front, since the state says that already; with a capital and a full stop
            text = re.sub(r"^goal[^:]*: ", "", chosen[1], flags=re.IGNORECASE)
            goal.answer = f"{text[:1].upper()}{text[1:]}".rstrip(".") + f". ({goal.answer})"
            self._changed(goal)

    def _rosout_ends(self) -> set[tuple[int, ...]]:
        """The ends with which the nodes that answer publish their logs."""
        ends = self._backend.node.get_publishers_info_by_topic("/rosout")
        return {tuple(end.endpoint_gid) for end in ends if owner(end) in self._servers}
