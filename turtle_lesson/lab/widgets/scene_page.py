"""The scene as one page of HTML, which needs neither kernel nor network: the widget's own view, with its state inside."""

from __future__ import annotations

import base64
import html
import json
import math
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..path import distance_driven, find_jumps
from ..recording import POSE_TOPIC
from ..words import number, point
from . import scene_commands
from .goal_client import Goal
from .live_widget import pack, source
from .scene_commands import cast_no_shadow, packed, show
from .scene_mesh import TRAIL, goal_flag, goal_mark, ribbon

if TYPE_CHECKING:
    from .scene import Scene

VIEW_SCRIPTS = ("dom", "scene_theme", "scene_quality", "scene_stage", "scene_camera", "scene_view")
PARTS = ("stage", "trail", "tip", "scan", "obstacles", "goal")
HEIGHT = 560
"""Pixels in a notebook."""


class ScenePage:
    """A page of HTML, and the same in words. `html` is the page, `text` says what it shows."""

    def __init__(self, title: str, text: str, state: dict[str, Any]) -> None:
        self.text = text
        written = json.dumps(  # bytes as text that JavaScript's `atob` reads, marked as such
            state, sort_keys=True, default=lambda value: {"base64": base64.b64encode(value).decode("ascii")}
        )
        self.html = source("html", "scene_page").format(
            title=html.escape(title),
            css=source("css", "base", "scene", "scene_page"),
            state=written.replace("<", "\\u003c"),
            script=source("js", *VIEW_SCRIPTS, "scene_page"),
        )

    def save(self, path: str | Path) -> Path:
        """Write the page to a file that any browser opens; returns the path."""
        path = Path(path)
        path.write_text(self.html, encoding="utf-8")
        return path

    def __repr__(self) -> str:
        return self.text

    def _repr_html_(self) -> str:
        """The page in a frame of its own, which the notebook's styles do not reach."""
        look = f'style="width: 100%; max-width: 1100px; border: 0" height="{HEIGHT}" allow="fullscreen"'
        return f'<iframe title="{html.escape(self.text)}" {look} srcdoc="{html.escape(self.html)}"></iframe>'


def state_of(scene: Scene) -> dict[str, Any]:
    """What a view needs to know."""
    state: dict[str, Any] = {name: getattr(scene, name) for name in ("bundle", "turtle", *PARTS)}
    return {**state, "description": scene.description, "words": "", "ended": False}


PERIOD = 0.05
"""Seconds between two poses of a replay, which are joined evenly …"""
MOST = 4000
"""… and more for a run that would need more poses than this."""

Track = dict[str, Any]
"""How one property changes, as three.js has it."""


def replay_page(scene: Scene) -> ScenePage:
    """The run as a page with a play bar."""
    recorder = scene.backend.recorder
    poses = recorder.poses.array()
    poses = poses[np.isfinite(poses["x"]) & np.isfinite(poses["y"]) & np.isfinite(poses["theta"])]
    if len(poses) < 2:
        raise ValueError(f"There is no run to replay. {recorder.why_silent(POSE_TOPIC)}")
    scene.redraw()
    begin, end = (float(recorder.seconds(poses[at]["stamp"])) for at in (0, -1))
    driven = distance_driven(poses, find_jumps(poses))
    text = (
        f"Replay of turtle1 from {number(begin)} s to {number(end)} s of robot time: {number(driven)} m driven, "
        f"from {point(poses[0]['x'], poses[0]['y'])} m to {point(poses[-1]['x'], poses[-1]['y'])} m."
    )
    turtle, trail, growth = _run(poses)
    taken = [goal for goal in recorder.goals if goal.state in ("on its way", "reached", "not reached")]
    flags, appear = _flags(taken, begin, end)
    clips = {scene_commands.TURTLE: turtle, **appear}
    animations = [  # one frame a second, so that a frame's number is its time
        {"path": f"/{path}", "clip": {"fps": 1, "name": "default", "tracks": tracks}} for path, tracks in clips.items()
    ]
    state = {
        **state_of(scene),
        "turtle": scene_commands.turtle_at(*(float(poses[0][name]) for name in ("x", "y", "theta"))),
        "trail": trail,
        "tip": [],
        "scan": [],
        "goal": flags,
        "description": text,
        "animation": packed("set_animation", "", animations=animations, options={"play": False, "repetitions": 1}),
        "growth": growth,
        "begin": begin,
        "seconds": end - begin,
    }
    return ScenePage("3-D replay", text, state)


def _track(name: str, kind: str, times: Iterable[float], values: Iterable[Any]) -> Track:
    keys = [{"time": round(time, 4), "value": value} for time, value in zip(times, values, strict=True)]
    return {"name": f".{name}", "type": kind, "keys": keys}


def _run(poses: np.ndarray) -> tuple[list[Track], list[bytes], bytes]:
    """Where the turtle is, its whole trail, and how much of that is drawn when, from fewer poses than were heard.

    A mesh's extent is nothing that three.js animates, so the page itself sets it (js/scene_page.js): it gets times (s), each
    with a number of corners, six a step.
    """
    jumps, times = find_jumps(poses), (poses["stamp"] - poses["stamp"][0]) / 1e9
    regular = np.searchsorted(times, np.arange(0.0, times[-1], max(PERIOD, times[-1] / MOST)))
    chosen = np.unique([*regular, *jumps, *(jumps - 1), 0, len(poses) - 1])
    places = np.column_stack([poses["x"], poses["y"], poses["theta"]])[chosen]
    changes = (places[1:] != places[:-1]).any(axis=1)
    kept = np.append(True, changes) | np.append(changes, True)  # none while it stands, but when it began and ended that
    chosen, places = chosen[kept], places[kept]
    when = times[chosen].tolist()
    turns = [[0.0, 0.0, round(math.sin(half), 5), round(math.cos(half), 5)] for half in (places[:, 2] / 2).tolist()]
    where = [[round(x, 4), round(y, 4), 0.0] for x, y, _ in places.tolist()]
    tracks = [_track("position", "vector3", when, where), _track("quaternion", "quaternion", when, turns)]
    steps = np.stack([places[:-1, :2], places[1:, :2]], axis=1)
    driven = (steps[:, 0] != steps[:, 1]).any(axis=1) & ~np.isin(chosen[1:], jumps)
    if not driven.any():
        return tracks, [], b""
    mesh = ribbon(list(steps[driven]))
    trail = [show("lab/trail", mesh, lit=False, color=int(TRAIL[1:], 16)), cast_no_shadow("lab/trail")]
    return tracks, trail, pack(np.column_stack([when, 6 * np.append(0, np.cumsum(driven))]))


def _flags(goals: list[Goal], begin: float, end: float) -> tuple[list[bytes], dict[str, list[Track]]]:
    """A flag for each goal, to be seen from when it was sent until its answer came."""
    flags, appear = [], {}
    for index, goal in enumerate(goals):
        gone = math.inf if goal.ended is None else goal.ended
        path = f"lab/goals/{index}"
        flags.append(show(f"{path}/mark", goal_mark(goal.x, goal.y, goal.theta)))
        flags.append(show(f"{path}/flag", goal_flag(goal.x, goal.y, reached=False)))
        keys = [(0.0, goal.sent <= begin < gone), (goal.sent - begin, True), (gone - begin, False)]
        kept = [(time, seen) for time, seen in keys if time == 0 or 0 < time < end - begin]
        appear[path] = [_track("visible", "bool", *zip(*kept, strict=True))]
    return flags, appear
