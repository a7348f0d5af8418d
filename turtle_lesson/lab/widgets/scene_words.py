"""The 3-D scene in words, exactly."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from ..beams import read_beams
from ..words import angle, count, listed, number, point

if TYPE_CHECKING:
    from ..recording import Obstacle, Recording
    from .goals import Goal


def newest_pose(recorder: Recording, until: int | None = None) -> tuple[float, float, float] | None:
    """The newest pose (m, m, rad), of those not later than `until` (ns); None where none was heard."""
    poses = recorder.poses.newest(1 if until is None else 256)
    if until is not None and len(poses) and poses["stamp"][0] <= until:
        poses = poses[poses["stamp"] <= until]
    if not len(poses):
        return None
    place = tuple(float(poses[-1][name]) for name in ("x", "y", "theta"))
    return place if all(map(math.isfinite, place)) else None  # type: ignore[return-value]


def brief(recorder: Recording, goal: Goal | None, beams: bool = True) -> str:
    """A scene in a line: turtle, obstacles, laser and goal."""
    pose = newest_pose(recorder)
    if pose is None:
        return "No pose heard yet."
    x, y, theta = pose
    facts = [f"Turtle at {point(x, y)} m facing {number(math.degrees(theta), 1)}°"]
    if recorder.obstacles:
        facts.append(count(len(recorder.obstacles), "obstacle"))
    if beams and recorder.last_scan is not None:
        scan = read_beams(recorder.last_scan)
        facts.append(f"{int(scan.sees.sum())} of {count(len(scan), 'beam')} see something")
    if goal is not None:
        facts.append(f"goal {number(math.hypot(goal.x - x, goal.y - y))} m away")
    return f"{'; '.join(facts)}."


def describe(recorder: Recording, goal: Goal | None) -> str:
    """A scene in one sentence: turtle, obstacles, laser and goal."""
    pose = newest_pose(recorder)
    if pose is None:
        return "no pose heard yet."
    x, y, theta = pose
    around = [*_standing(list(recorder.obstacles.values())), *_seen(recorder.last_scan)]
    if goal is not None:
        away = number(math.hypot(goal.x - x, goal.y - y))
        around.append(f"the goal at {point(goal.x, goal.y)} m is {away} m away")
    rest = f"; {listed(around)}" if around else ""
    return f"the turtle is at {point(x, y)} m facing {angle(theta)}{rest}."


def _standing(obstacles: list[Obstacle]) -> list[str]:
    if not obstacles:
        return []
    places = ", ".join(f"{each.shape} at {point(each.x, each.y)} m" for each in obstacles)
    return [f"{count(len(obstacles), 'obstacle')} ({places})"]


def _seen(scan: Any) -> list[str]:
    if scan is None:
        return []
    beams = read_beams(scan)
    return [f"{int(beams.sees.sum())} of the laser's {count(len(beams), 'beam')} see something"]
