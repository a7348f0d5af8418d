"""The panel with the goals: those that were sent from here, and what became of each."""

from __future__ import annotations

from collections import Counter
from typing import Any

import traitlets

from ..words import angle, count, listed, point
from .goals import Goal, GoalDesk
from .live_widget import LiveWidget
from .outlet import let_time_go_on

SHOWN = 60
"""How many of the newest goals the browser is told of."""


class GoalsPanel(LiveWidget):
    """Sends goals to the navigator, and shows its answers."""

    goals = traitlets.List(traitlets.Dict()).tag(sync=True)
    """The newest goals, in the order in which they were sent; `Goal` says what there is of each."""
    earlier = traitlets.Int(0).tag(sync=True)
    """How many were sent before those."""

    def __init__(self, *arguments: Any, **traits: Any) -> None:
        super().__init__(*arguments, **traits)
        self.desk = GoalDesk(self.station, self._goal_changed)
        self._goal_news = False

    def opened(self) -> None:
        """Somebody looks."""
        super().opened()
        self.desk.open()

    def closed(self) -> None:
        """Nobody looks."""
        super().closed()
        self.desk.rest()

    def tick(self) -> None:
        """Tell the browser of news."""
        super().tick()
        self.desk.look()
        if self._goal_news:
            self._goal_news = False
            self.goals = [each.as_state() for each in self.desk.goals[-SHOWN:]]
            self.earlier = max(0, len(self.desk.goals) - SHOWN)

    def do_goal(self, x: float, y: float, theta: float) -> None:
        """Send a goal, and let time go on if it stands still."""
        if self.desk.send(x, y, theta).waits:
            let_time_go_on(self.station)

    def left(self) -> None:
        """Ask no more."""
        super().left()
        self.desk.close()

    def goals_in_words(self) -> str:
        """How many goals were sent, what became of them, and what of the last one."""
        goals = self.desk.goals
        if not goals:
            return "No goal sent yet."
        states = Counter(goal.state for goal in goals)
        last = goals[-1]
        place = f"Goal {last.number} at {point(last.x, last.y)} m facing {angle(last.theta)}"
        counted = listed([f"{amount} {state}" for state, amount in states.items()])
        return f"{count(len(goals), 'goal').capitalize()} sent: {counted}. {place}: {_ending(last)}"

    def _goal_changed(self, goal: Goal) -> None:
        self._goal_news = True
        self.words = f"Goal {goal.number} at {point(goal.x, goal.y)} m: {_ending(goal)}"


def _ending(goal: Goal) -> str:
    return f"{goal.state}. {goal.answer}" if goal.answer else f"{goal.state}."
