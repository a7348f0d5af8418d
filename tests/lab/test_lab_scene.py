"""The 3-D scene without a browser: its commands, what changes them, its words, and the pages that it makes."""

from __future__ import annotations

import gzip
import html
import json
import re
import subprocess
import sys
from base64 import b64decode
from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import umsgpack
from hypothesis import given
from hypothesis import strategies as st

from turtle_lesson import Lesson, start
from turtle_lesson.lab.path import MOST_POINTS, Trail
from turtle_lesson.lab.recording import Table
from turtle_lesson.lab.status_and_scan import read_beams
from turtle_lesson.lab.widgets import scene_mesh
from turtle_lesson.lab.widgets.scene import Scene
from turtle_lesson.lab.widgets.scene_commands import viewer_bundle
from turtle_lesson.lab.widgets.scene_mesh import fan, ribbon
from turtle_lesson.turtlesim.obstacles import Box, Circle

# isort: split
from lab_fakes import scan

PARTS = ("stage", "trail", "tip", "scan", "obstacles", "goal")
FLOATS = 0x17


@pytest.fixture
def lesson() -> Iterator[Lesson]:
    """A world with the whole system, after a second."""
    lesson = start(seed=0)
    lesson.launch("robot_controller", "start_system.launch.py", source="world")
    lesson.run(1)
    yield lesson
    lesson._world.close()


@pytest.fixture
def scene(lesson: Lesson) -> Scene:
    return lesson.scene()


def commands(scene: Scene, part: str) -> list[dict[str, Any]]:
    """What the viewer is told of a part."""
    return [umsgpack.unpackb(each) for each in getattr(scene, part)]


def paths(scene: Scene, part: str, kind: str = "set_object") -> list[str]:
    return [each["path"] for each in commands(scene, part) if each["type"] == kind]


def corners(command: dict[str, Any]) -> np.ndarray:
    """The corners of the mesh that a command shows: n by 3."""
    packed = command["object"]["geometries"][0]["data"]["attributes"]["position"]
    assert packed["itemSize"] == 3 and packed["array"].type == FLOATS
    return np.frombuffer(packed["array"].data, "<f4").reshape(-1, 3)


def drive_to(lesson: Lesson, x: float, y: float, seconds: float = 5.0) -> None:
    """Send a goal from the goal pad, and wait."""
    lesson.goal_pad().do_goal(x, y, 0.0)
    lesson.run(seconds)


# -- commands --------------------------------------------------------------------------------------------------------


def test_every_command_is_one_that_the_viewer_knows(lesson: Lesson, scene: Scene) -> None:
    lesson.set_obstacles("three pillars")
    drive_to(lesson, 8.0, 8.0)
    scene.redraw()
    told = [command for part in PARTS for command in commands(scene, part)]
    told.append(umsgpack.unpackb(scene.turtle))
    assert {each["type"] for each in told} == {"set_object", "set_transform", "set_property", "delete"}
    assert all(each["path"].startswith("/") for each in told)
    for each in told:
        if each["type"] == "set_transform":
            assert len(each["matrix"]) == 16 and all(isinstance(number, float) for number in each["matrix"])
        if each["type"] == "set_object" and each["object"]["geometries"]:
            thing = each["object"]
            assert thing["object"]["geometry"] == thing["geometries"][0]["uuid"]
            assert thing["object"]["material"] == thing["materials"][0]["uuid"]


def test_the_same_scene_is_the_same_bytes() -> None:
    def made() -> list[Any]:
        lesson = start(seed=0)
        lesson.set_obstacles("rooms")
        lesson.run(2)
        scene = lesson.scene()
        return [scene.turtle, *(getattr(scene, part) for part in PARTS)]

    assert made() == made()


def test_the_turtle_goes_where_its_pose_says(lesson: Lesson, scene: Scene) -> None:
    before = scene.turtle
    drive_to(lesson, 8.0, 5.5)
    scene.redraw()
    matrix = np.array(umsgpack.unpackb(scene.turtle)["matrix"]).reshape(4, 4).T
    pose = lesson._recording.poses.newest(1)[0]
    assert scene.turtle != before
    assert matrix[:3, 3] == pytest.approx([pose["x"], pose["y"], 0], abs=1e-4)
    assert np.arctan2(matrix[1, 0], matrix[0, 0]) == pytest.approx(pose["theta"], abs=1e-4)


def test_the_path_grows_and_only_its_tip_is_sent_again(lesson: Lesson, scene: Scene) -> None:
    drive_to(lesson, 9.0, 5.5, seconds=0.4)
    scene.redraw()
    old, tip = scene.trail, scene.tip
    lesson.run(0.2)
    scene.redraw()
    assert scene.trail is old and scene.tip != tip
    drawn = corners(commands(scene, "tip")[0])
    here = lesson._recording.poses.newest(1)[0]
    assert np.hypot(*(drawn[:, :2] - (here["x"], here["y"])).T).min() < 0.06


def test_nothing_is_sent_while_nothing_moves(scene: Scene) -> None:
    scene.redraw()
    before = {part: getattr(scene, part) for part in (*PARTS, "turtle")}
    for _ in range(5):
        scene.redraw()
    assert all(getattr(scene, part) is value for part, value in before.items())


def test_obstacles_come_and_go(lesson: Lesson, scene: Scene) -> None:
    lesson.set_obstacles([Circle(8.0, 5.5, 0.5), Box(3.0, 3.0, 2.0, 1.0, 0.3)])
    lesson.run(1.2)
    scene.tick()
    shapes = [each["object"]["geometries"][0] for each in commands(scene, "obstacles") if each["type"] == "set_object"]
    assert [shape["type"] for shape in shapes if "type" in shape][::2] == ["CylinderGeometry", "BoxGeometry"]
    assert commands(scene, "obstacles")[0] == {"type": "delete", "path": "/lab/obstacles"}
    lesson.set_obstacles([])
    lesson.run(0.1)
    scene.tick()
    assert commands(scene, "obstacles") == [{"type": "delete", "path": "/lab/obstacles"}]


def test_a_goal_of_the_goal_pad_has_a_flag_until_it_is_refused(lesson: Lesson, scene: Scene) -> None:
    assert paths(scene, "goal") == []
    drive_to(lesson, 8.0, 8.0, seconds=0.5)
    scene.tick()
    assert paths(scene, "goal") == ["/lab/goal/mark", "/lab/goal/flag"]
    assert "Goal (8.00, 8.00) m: on its way." in scene.words
    lesson.run(5)
    scene.tick()
    assert "Goal (8.00, 8.00) m: reached." in scene.words
    assert scene.text().endswith("the goal at (8.00, 8.00) m is 0.03 m away.")


def test_the_laser_s_fan_starts_where_the_turtle_was(lesson: Lesson, scene: Scene) -> None:
    scene.redraw()
    free = next(each for each in commands(scene, "scan") if each["path"] == "/lab/scan/free")
    assert corners(free)[0, :2] == pytest.approx([5.544, 5.544], abs=0.01)
    fans = corners(free)
    assert fans[:, :2].min() > -0.01 and fans[:, :2].max() < 11.1


def test_a_new_window_finds_the_whole_state_in_the_traits(lesson: Lesson, scene: Scene) -> None:
    """What a widget manager asks the kernel for when another window opens."""
    scene.redraw()
    state = scene.get_state()
    assert {"bundle", "turtle", *PARTS} <= set(state)
    assert all(state[name] for name in ("bundle", "turtle", "stage", "tip", "scan"))
    scene._order(scene, {"do": "open", "view": "late"}, [])
    assert len(scene._views) == 1
    scene._order(scene, {"do": "close", "view": "late"}, [])
    assert len(scene._views) == 0


def test_showing_the_scene_leaves_robot_time_alone(lesson: Lesson) -> None:
    now = lesson.now
    lesson.scene()._repr_mimebundle_()
    lesson.scene()._order(lesson.scene(), {"do": "open", "view": "v"}, [])
    assert lesson.now == now
    lesson.scene()._order(lesson.scene(), {"do": "close", "view": "v"}, [])


SCENES = """
import socket, subprocess, sys, threading

def refused(*_):
    raise AssertionError("neither a port nor a program is needed")

socket.socket.bind = socket.socket.listen = subprocess.Popen.__init__ = refused

from turtle_lesson import start
lesson = start(seed=0)
lesson.launch("robot_controller", "start_system.launch.py", source="world")
lesson.run(1)
before = threading.enumerate()
scene = lesson.scene()
lesson.run(1)
scene.redraw(), scene.snapshot(), scene.animation()
print("umsgpack" in sys.modules, "meshcat" in sys.modules, "pyngrok" in sys.modules, set(threading.enumerate()) <= set(before))
"""


def test_meshcats_server_never_runs_and_the_tunnel_that_it_could_open_is_never_imported() -> None:
    done = subprocess.run([sys.executable, "-c", SCENES], capture_output=True, text=True, check=False)
    assert done.stdout.splitlines()[-1:] == ["True False False True"], done.stderr


# -- shapes ----------------------------------------------------------------------------------------------------------


def test_the_turtle_stands_on_the_floor_and_is_as_long_as_in_the_plots() -> None:
    body = scene_mesh.body()
    low, high = body.corners.reshape(-1, 3).min(axis=0), body.corners.reshape(-1, 3).max(axis=0)
    assert low[2] > 0 and high[2] < 0.4
    assert high[0] - low[0] == pytest.approx(scene_mesh.LENGTH, abs=0.12)
    assert low[1] == pytest.approx(-high[1], abs=1e-9)
    assert len(scene_mesh.legs()) == 4


@given(st.lists(st.one_of(st.floats(0.05, 9.9), st.sampled_from([float("nan"), float("inf"), 0.0])), max_size=40))
def test_any_scan_can_be_drawn(ranges: list[float]) -> None:
    free, marks = fan(read_beams(scan(ranges)), 5.0, 5.0, 0.3)
    assert np.isfinite(free.corners).all() and np.isfinite(marks.corners).all()
    assert len(free) == max(len(ranges) - 1, 0)


steps = st.lists(st.tuples(st.floats(-0.03, 0.03), st.floats(-0.03, 0.03)), min_size=1, max_size=200)


@given(steps)
def test_a_trail_in_few_points_is_never_far_from_the_poses(moves: list[tuple[float, float]]) -> None:
    table, (x, y) = Table("x", "y", "theta", "speed"), (5.0, 5.0)
    trail, places = Trail(), []
    for number, (across, up) in enumerate(moves):
        x, y = x + across, y + up
        places.append((x, y))
        table.append(number * 16_000_000, x, y, 0.0, 3.0)
        if number % 7 == 0:
            trail.follow(table)
    trail.follow(table)
    mesh = ribbon([*trail.old, trail.tip], width=0.001)
    assert tuple(trail.tip[-1]) == places[-1]
    kept = np.concatenate([*trail.old, trail.tip])
    assert len(kept) <= len(places) + 2 * len(trail.old) + 2
    assert np.isfinite(mesh.corners).all()
    for place in places:
        assert _distance(np.array(place), [*trail.old, trail.tip]) <= 0.1  # a way there and back again is left out


@pytest.mark.parametrize("side", [0.35, 0.93, 2.0])
def test_a_trail_has_its_corners_where_the_turtle_turned(side: float) -> None:
    table, trail, corners = Table("x", "y", "theta", "speed"), Trail(), []
    at = np.array([3.0, 3.0])
    for turn in range(4):
        for theta in np.linspace(turn - 1, turn, 30)[1:] * np.pi / 2:
            table.append(len(table) * 16_000_000, *at, theta, 0.0)
        corners.append(at)
        way = np.array([np.cos(theta), np.sin(theta)])
        for far in np.linspace(0, side, 40)[1:]:
            table.append(len(table) * 16_000_000, *(at + far * way), theta, 3.0)
        at = at + side * way
        trail.follow(table)
    for corner in corners:
        assert _distance(corner, [*trail.old, trail.tip]) < 0.015


def _distance(place: np.ndarray, pieces: list[np.ndarray]) -> float:
    """From a place to the nearest of some lines."""
    best = np.inf
    for piece in pieces:
        best = min(best, np.hypot(*(piece - place).T).min())
        for begin, end in pairwise(piece):
            length = float(((end - begin) ** 2).sum())
            part = np.clip(((place - begin) @ (end - begin)) / length, 0, 1) if length else 0.0
            best = min(best, float(np.hypot(*(begin + part * (end - begin) - place))))
    return best


def test_a_long_trail_forgets_its_beginning_and_a_teleport_breaks_it() -> None:
    table = Table("x", "y", "theta", "speed")
    trail = Trail()
    angles = np.linspace(0, 600, 20000)
    for number, angle in enumerate(angles):
        table.append(number * 16_000_000, 5 + 4 * np.cos(angle), 5 + 4 * np.sin(angle), 0.0, 8.0)
    trail.follow(table)
    assert sum(map(len, trail.old)) <= MOST_POINTS
    here = trail.tip[-1]
    table.append(20001 * 16_000_000, 1.0, 1.0, 0.0, 0.0)
    table.append(20002 * 16_000_000, 1.06, 1.0, 0.0, 4.0)
    trail.follow(table)
    assert tuple(trail.old[-1][-1]) == tuple(here)
    assert tuple(trail.tip[0]) == (1.0, 1.0)


# -- words and the picture that stays ----------------------------------------------------------------------------------


def test_the_text_is_exact(lesson: Lesson) -> None:
    lesson.set_obstacles([Circle(8.0, 5.5, 0.5)])
    lesson.run(1.2)
    assert repr(lesson.scene()) == (
        "3-D scene: the turtle is at (5.54, 5.54) m facing 0.00 rad (0.0°); 1 obstacle (circle at (8.00, 5.50) m) and "
        "181 of the laser's 181 beams see something."
    )
    lesson.scene().redraw()
    assert lesson.scene().description == "Turtle at (5.54, 5.54) m facing 0.0°; 1 obstacle."


def test_without_a_pose_it_says_so() -> None:
    scene = start(seed=0, simulator=False).scene()
    assert scene.text() == "3-D scene: no pose heard yet."
    assert scene.turtle == b"" and scene.picture() is not None
    assert "image/png" not in scene._repr_mimebundle_()[0]
    with pytest.raises(ValueError, match="There is no run to replay"):
        scene.animation()


def test_a_reader_without_a_kernel_sees_a_picture(lesson: Lesson) -> None:
    lesson.set_obstacles("rooms")
    drive_to(lesson, 8.0, 9.0)
    data, metadata = lesson.scene()._repr_mimebundle_()
    assert data["text/plain"] == lesson.scene().text()
    assert metadata["image/png"]["alt"] == lesson.scene().text()
    assert data["image/png"][:4] == b"\x89PNG" and len(data["image/png"]) < 120_000


# -- pages -----------------------------------------------------------------------------------------------------------


def read_state(page: str) -> dict[str, Any]:
    found = re.search(r'<script type="application/json" id="state">\n(.*?)\n</script>', page, re.S)
    assert found
    return json.loads(found[1])


def test_the_viewer_travels_compressed_with_its_licences() -> None:
    script = gzip.decompress(viewer_bundle()).decode()
    assert len(viewer_bundle()) < 250_000 and "MeshCat" in script
    assert "Permission is hereby granted" in script and "Three.js Authors" in script


def test_a_snapshot_fetches_nothing(lesson: Lesson, tmp_path: Path) -> None:
    lesson.set_obstacles("three pillars")
    lesson.run(1)
    page = lesson.scene().snapshot()
    saved = page.save(tmp_path / "scene.html")
    text = saved.read_text(encoding="utf-8")
    assert text == page.html and str(page).startswith("Snapshot of the 3-D scene: the turtle is at (5.54, 5.54) m")
    assert not re.search(r"https?:|\bsrc=|\bhref=|@import|url\(", text)
    assert "default-src 'none'" in text
    state = read_state(text)
    assert {"bundle", "turtle", *PARTS} <= set(state)
    assert html.unescape(page._repr_html_()).count(page.html) == 1


def test_an_animation_replays_the_run(lesson: Lesson) -> None:
    drive_to(lesson, 8.0, 8.0)
    page = lesson.scene().animation()
    assert str(page).startswith("Replay of turtle1 from 0.02 s to 6.90 s of robot time: ")
    state = read_state(page.html)
    command = umsgpack.unpackb(b64decode(state["animation"]["base64"]))
    assert command["type"] == "set_animation" and command["options"] == {"play": False, "repetitions": 1}
    clips = {each["path"]: each["clip"] for each in command["animations"]}
    assert set(clips) == {"/lab/turtle", "/lab/goals/0"}
    position = next(track for track in clips["/lab/turtle"]["tracks"] if track["name"] == ".position")
    times = [key["time"] for key in position["keys"]]
    assert times == sorted(times) and times[0] == 0 and times[-1] == pytest.approx(state["seconds"], abs=1e-3)
    last = lesson._recording.poses.newest(1)[0]
    assert position["keys"][-1]["value"][:2] == pytest.approx([last["x"], last["y"]], abs=1e-3)
