"""The scene as one page of HTML, which needs neither kernel nor network: the widget's own view, with its state inside."""

from __future__ import annotations

import base64
import html
import json
import math
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..path import distance_driven, find_jumps, thinned
from ..words import number, point
from . import scene_commands
from .live_widget import pack, script, styles
from .scene_commands import cast_no_shadow, packed, show
from .scene_mesh import TRAIL, goal_flag, goal_mark, ribbon

if TYPE_CHECKING:
    from .goal_client import Goal
    from .scene import Scene


VIEW_SCRIPTS = ("dom", "scene_theme", "scene_quality", "scene_stage", "scene_camera", "scene_view")
PARTS = ("stage", "trail", "tip", "scan", "obstacles", "goal")
HEIGHT = 560
"""Pixels in a notebook."""

# The page may run what is written in it and show pictures that it made, and nothing else: no address is ever asked.
POLICY = (
    "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data: blob:; font-src data:"
)

FRAME = """<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta http-equiv="Content-Security-Policy" content="{policy}">
<title>{title}</title>
<style>
{css}
</style>
</head>
<body>
<main id="page"></main>
<script type="application/json" id="state">
{state}
</script>
<script>
{script}
</script>
</body>
</html>
"""


class ScenePage:
    """A page of HTML, and the same in words. `html` is the page, `text` says what it shows."""

    def __init__(self, title: str, text: str, state: dict[str, Any]) -> None:
        self.text = text
        self.html = FRAME.format(
            policy=POLICY,
            title=html.escape(title),
            css=styles("base", "scene", "scene_page"),
            state=json.dumps(state, sort_keys=True, default=_written).replace("<", "\\u003c"),
            script=script(*VIEW_SCRIPTS, "scene_page"),
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


def _written(value: bytes) -> dict[str, str]:
    """Bytes as text that JavaScript's `atob` reads, marked as such."""
    return {"base64": base64.b64encode(value).decode("ascii")}


PERIOD = 0.1
"""Seconds between two poses of the animation, which are joined evenly …"""
MOST = 4000
"""… and more for a run that would need more poses than this."""

Tracks = dict[str, tuple[str, list[float], list[Any]]]
"""By a property's name: its type in three.js, times (s) and values."""


def replay_page(scene: Scene, since: float | None, until: float | None) -> ScenePage:
    """The run from `since` to `until` (seconds of robot time) as a page with a play bar."""
    recorder = scene.backend.recorder
    poses = recorder.window(recorder.poses, since, until)
    poses = poses[np.isfinite(poses["x"]) & np.isfinite(poses["y"]) & np.isfinite(poses["theta"])]
    if len(poses) < 2:
        raise ValueError(f"There is no run to replay in that time. {recorder.why_silent(recorder.pose_topic)}")
    scene.redraw()
    jumps = find_jumps(poses)
    times = (poses["stamp"] - poses["stamp"][0]) / 1e9
    begin, end = (float(recorder.seconds(poses[at]["stamp"])) for at in (0, -1))
    driven = distance_driven(poses, jumps)
    text = (
        f"Replay of {recorder.turtle} from {number(begin)} s to {number(end)} s of robot time: {number(driven)} m driven, "
        f"from {point(poses[0]['x'], poses[0]['y'])} m to {point(poses[-1]['x'], poses[-1]['y'])} m."
    )
    goals = [goal for goal in recorder.goals if goal.was_taken]
    trail, growth = _trail(poses, times, jumps, driven)
    flags, appear = _flags(goals, begin, end)
    tracks = {scene_commands.TURTLE: _drive(poses, times, jumps), **appear}
    state = {
        **state_of(scene),
        "turtle": scene_commands.turtle_at(*(float(poses[0][name]) for name in ("x", "y", "theta"))),
        "trail": trail,
        "tip": [],
        "scan": [],
        "goal": flags,
        "description": text,
        "animation": _animation(tracks),
        "growth": growth,
        "begin": begin,
        "seconds": end - begin,
    }
    return ScenePage("3-D replay", text, state)


def _drive(poses: np.ndarray, times: np.ndarray, jumps: np.ndarray) -> Tracks:
    """Where the turtle is: fewer poses than were heard, and none while it stands."""
    period = max(PERIOD, float(times[-1]) / MOST)
    regular = np.searchsorted(times, np.arange(0.0, times[-1], period))
    chosen = np.unique([*regular, *jumps, *(jumps - 1), 0, len(poses) - 1])
    places = np.column_stack([poses["x"], poses["y"], poses["theta"]])[chosen]
    stays = np.zeros(len(chosen), bool)
    stays[1:-1] = (places[1:-1] == places[:-2]).all(axis=1) & (places[1:-1] == places[2:]).all(axis=1)
    when = [round(each, 4) for each in times[chosen[~stays]].tolist()]
    kept = places[~stays].tolist()
    where = [[round(x, 4), round(y, 4), 0.0] for x, y, _ in kept]
    turns = [[0.0, 0.0, round(math.sin(theta / 2), 5), round(math.cos(theta / 2), 5)] for _, _, theta in kept]
    return {"position": ("vector3", when, where), "quaternion": ("quaternion", when, turns)}


def _trail(poses: np.ndarray, times: np.ndarray, jumps: np.ndarray, driven: float) -> tuple[list[bytes], bytes]:
    """The whole trail, and how much of it is drawn when: times (s), each with a number of corners, six a step.

    A mesh's extent is nothing that three.js animates, so the page itself sets it (js/scene_page.js).
    """
    chosen = thinned(poses, jumps, spacing=max(0.1, driven / MOST))
    places = np.column_stack([poses["x"], poses["y"]])
    drives = ((begin, end) for begin, end in pairwise(chosen) if end not in jumps)
    steps = [(begin, end) for begin, end in drives if (places[begin] != places[end]).any()]
    if not steps:
        return [], b""
    when, corners = [0.0], [0.0]
    for step, (begin, end) in enumerate(steps):
        for index, amount in ((begin, 6.0 * step), (end, 6.0 * (step + 1))):
            if times[index] > when[-1]:
                when.append(round(float(times[index]), 4))
                corners.append(amount)
    mesh = ribbon([places[[begin, end]] for begin, end in steps])
    drawn = [show("lab/trail", mesh, lit=False, color=int(TRAIL[1:], 16)), cast_no_shadow("lab/trail")]
    return drawn, pack(np.column_stack([when, corners]))


def _flags(goals: list[Goal], begin: float, end: float) -> tuple[list[bytes], dict[str, Tracks]]:
    """A flag for each goal, to be seen from when it was sent until its answer came."""
    flags, appear = [], {}
    ends = [math.inf if goal.ended is None else goal.ended for goal in goals]
    for index, (goal, gone) in enumerate(zip(goals, ends, strict=True)):
        if goal.sent >= end or gone <= begin:
            continue
        path = f"lab/goals/{index}"
        flags.append(show(f"{path}/mark", goal_mark(goal.x, goal.y, goal.theta)))
        flags.append(show(f"{path}/flag", goal_flag(goal.x, goal.y, reached=False)))
        keys = [(0.0, goal.sent <= begin), (goal.sent - begin, True), (gone - begin, False)]
        kept = [(round(time, 4), seen) for time, seen in keys if time == 0 or 0 < time < end - begin]
        appear[path] = {"visible": ("bool", [time for time, _ in kept], [seen for _, seen in kept])}
    return flags, appear


def _animation(tracks: dict[str, Tracks]) -> bytes:
    """The command for all tracks; one frame a second, so that a frame's number is its time."""
    animations = [
        {
            "path": f"/{path}",
            "clip": {
                "fps": 1,
                "name": "default",
                "tracks": [
                    {
                        "name": f".{name}",
                        "type": kind,
                        "keys": [{"time": time, "value": value} for time, value in zip(times, values, strict=True)],
                    }
                    for name, (kind, times, values) in named.items()
                ],
            },
        }
        for path, named in tracks.items()
    ]
    return packed("set_animation", "", animations=animations, options={"play": False, "repetitions": 1})
