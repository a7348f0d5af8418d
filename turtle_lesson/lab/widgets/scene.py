"""The world in three dimensions: meshcat's viewer inside a widget, fed over the notebook's own channel."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import traitlets

from ..path import Trail
from ..words import point
from . import scene_commands
from .goal_client import Goal, goals_from
from .live_widget import LiveWidget
from .scene_commands import viewer_bundle
from .scene_picture import brief, describe, draw_scene

if TYPE_CHECKING:
    from ..picture import Picture
    from .backend import Backend
    from .scene_page import ScenePage

VIEW_SCRIPTS = ("dom", "scene_theme", "scene_quality", "scene_stage", "scene_camera", "scene_view")
TRAIL_RATE, DESCRIPTION_RATE = 10.0, 1.0
"""So many times a second at most, the trail and a screen reader's description of the scene are sent again."""


def _commands() -> Any:
    """A trait for a part of the scene: meshcat commands, each as bytes, that bring it up to date."""
    return traitlets.List(traitlets.Bytes()).tag(sync=True)


class Scene(LiveWidget):
    """Floor, walls, obstacles, turtle, trail, laser and goal, to be turned under the mouse.

    The whole state is in the traits, one for each part of the scene, so that a view that comes late, a second window or a
    reloaded frame is complete at once; what has not changed is not sent again.
    """

    SCRIPTS = (*VIEW_SCRIPTS, "scene")
    STYLES = ("base", "scene")

    bundle = traitlets.Bytes().tag(sync=True)
    """The viewer's script, compressed; it travels once."""
    stage = _commands()
    turtle = traitlets.Bytes().tag(sync=True)
    """One command that says where the turtle is; empty until a pose was heard."""
    trail = _commands()
    """The older part of the trail."""
    tip = _commands()
    """Its newest piece."""
    scan = _commands()
    obstacles = _commands()
    goal = _commands()
    description = traitlets.Unicode().tag(sync=True)
    """The scene in words, for a screen reader."""

    def __init__(self, backend: Backend) -> None:
        self._trail = Trail()
        self._drawn: dict[str, Any] = {}
        super().__init__(backend, bundle=viewer_bundle(), stage=scene_commands.stage())
        self.tick()

    def snapshot(self) -> ScenePage:
        """The scene as it is now, as one page of HTML that needs neither kernel nor network.

        The page is shown where it is the last value of a cell; `save("scene.html")` writes it to a file.
        """
        from .scene_page import snapshot_page

        return snapshot_page(self)

    def animation(self, since: float | None = None, until: float | None = None) -> ScenePage:
        """The turtle's run as a page of HTML with a play bar, from `since` to `until` (seconds of robot time).

        Raises ValueError where no pose was heard in that time.
        """
        from .scene_page import replay_page

        return replay_page(self, since, until)

    def text(self) -> str:
        """Where the turtle is, and what is around it."""
        return f"3-D scene: {describe(self.backend.recorder, self._current_goal())}"

    def picture(self) -> Picture | None:
        """The same scene drawn by matplotlib, from one side."""
        return draw_scene(self.backend.recorder, self._current_goal())

    def redraw(self) -> None:
        """Bring everything up to date, also what usually waits a little; of an ended world, nothing changes."""
        self._paces.clear()
        if not self.ended:
            self.tick()

    def tick(self) -> None:
        recorder = self.backend.recorder
        pose = recorder.pose()
        if pose is not None and self._is_new("turtle", pose):
            self.turtle = scene_commands.turtle_at(*pose)
        if self.due("trail", TRAIL_RATE) and self._trail.follow(recorder.poses):
            if self._is_new("trail", self._trail.changes):
                self.trail = scene_commands.trail("lab/trail", self._trail.old)
            self.tip = scene_commands.trail("lab/tip", [self._trail.tip])
        scanned_from = recorder.pose_at_scan()
        if scanned_from is not None and self._drawn.get("scan") is not recorder.last_scan:
            self._drawn["scan"] = recorder.last_scan
            self.scan = scene_commands.scan(recorder.last_scan, *scanned_from)
        standing = list(recorder.obstacles.values())
        if self._is_new("obstacles", standing):
            self.obstacles = scene_commands.obstacles(standing)
        goal = self._current_goal()
        if self._is_new("goal", None if goal is None else (goal.x, goal.y, goal.theta, goal.state)):
            self.goal = scene_commands.goal(goal)
        if goal is not None and self._is_new("news", (goal.sent, goal.state)):
            self.words = f"Goal {point(goal.x, goal.y)} m: {goal.state}."
        if self.due("description", DESCRIPTION_RATE):
            self.description = brief(recorder, goal)

    def _current_goal(self) -> Goal | None:
        """The newest goal from this page, unless the navigator did not take it."""
        goals = [goal for goal in goals_from(self.backend) if goal.state in ("on its way", "reached")]
        return goals[-1] if goals else None

    def _is_new(self, name: str, value: object) -> bool:
        """Whether a part has to be drawn again; the first time it has."""
        if name in self._drawn and self._drawn[name] == value:
            return False
        self._drawn[name] = value
        return True
