"""The panel with the goals: those that were sent from here, and what became of each."""

from __future__ import annotations

from typing import Any

import traitlets

from ..words import point
from .goals import Goal, GoalDesk
from .live_widget import LiveWidget


class GoalsPanel(LiveWidget):
    """Sends goals to the navigator, and shows its answers."""

    goals = traitlets.List(traitlets.Dict()).tag(sync=True)

    def __init__(self, *arguments: Any, **traits: Any) -> None:
        super().__init__(*arguments, **traits)
        self.desk = GoalDesk(self.station, self._goal_changed)

    def do_goal(self, x: float, y: float, theta: float) -> None:
        """Send a goal, and let time go on if it stands still."""
        goal = self.desk.send(x, y, theta)
        clock = self.station.clock
        if goal.state == "on its way" and clock is not None and not clock.playing:
            clock.play(clock.rate)

    def _goal_changed(self, goal: Goal) -> None:
        self.goals = [each.as_state() for each in self.desk.goals]
        self.words = f"Goal {goal.number} at {point(goal.x, goal.y)} m: {goal.state}. {goal.answer}".strip()

    def close(self) -> None:
        """Ask no more, and go."""
        self.desk.close()
        super().close()
