"""`connect()` on a stand-in for a real ROS 2: everything that the widgets do is done in the notebook's loop."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from turtle_lesson import connect

HERE = Path(__file__).parents[1]
STANDIN = HERE / "real_rclpy_standin"
RELEASES = ("humble", "jazzy")


@pytest.fixture(scope="module")
def stories() -> Iterator[dict[str, Any]]:
    """The facts of `robot_story.py`, told once on each release, side by side."""
    programs = {release: _begin(release) for release in RELEASES}
    try:
        yield {release: _facts(program) for release, program in programs.items()}
    finally:
        for program in programs.values():
            program.kill()
            program.wait()


def _begin(release: str) -> subprocess.Popen[str]:
    path = os.pathsep.join(map(str, (STANDIN, HERE.parent)))
    environment = {**os.environ, "PYTHONPATH": path, "STANDIN": release}
    story = [sys.executable, "-W", "error", str(HERE / "robot_story.py")]
    return subprocess.Popen(story, env=environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


def _facts(program: subprocess.Popen[str]) -> dict[str, Any]:
    said, errors = program.communicate(timeout=540)
    assert program.returncode == 0, errors
    return {**json.loads(said.splitlines()[-1]), "errors": errors}


@pytest.fixture(params=RELEASES)
def story(request: pytest.FixtureRequest, stories: dict[str, Any]) -> Any:
    """A function: the facts of one scene."""
    facts = stories[request.param]

    def tell(name: str) -> Any:
        found = facts[name]
        assert not (isinstance(found, dict) and "failed" in found), found["failed"]
        return found

    return tell


def test_the_real_rclpy_is_used_and_ours_never_imported(story):
    assert Path(story("rclpy")).is_relative_to(STANDIN)
    assert story("ours") == []


def test_nothing_of_the_lab_ever_runs_in_another_thread(story):
    assert story("elsewhere") == []
    assert story("errors") == ""


def test_poses_are_heard_with_their_times_even_while_a_cell_computes(story):
    facts = story("hears_poses")
    assert facts["during"] == 0
    assert facts["least"] >= 0 and facts["stamped_meanwhile"] > 0
    assert 0 <= facts["age"] < 60  # s: it is the same clock


def test_no_thread_wakes_for_messages(story):
    facts = story("hears_poses")
    assert {"/turtle1/pose", "/robot/status", "/obstacles", "/parameter_events"} <= set(facts["taken"])
    assert facts["awaited"] == []


def test_a_goal_reaches_the_service_and_its_answer_comes_back_in_the_loop(story):
    facts = story("goal_reaches_the_service")
    first, second = facts["goals"]
    assert first == {"state": "reached", "answer": "success: True, time_taken: 0.3 s"}
    assert second["state"] == "refused" and second["answer"].startswith("X = 20.0 is outside of the world.")
    assert facts["only_loop"] and facts["server_threads"] == 1
    assert "the turtle is at (2.00, 3.00) m" in facts["text"]


def test_the_dashboard_ticks_with_a_clock_that_cannot_be_turned(story):
    facts = story("dashboard_ticks")
    assert facts["clock"]["turns"] is False and facts["went_on"] > 0
    assert set(facts["lights"].values()) == {"present"}
    assert ["WARN", "navigator", "Goal refused: x = 20.0 is outside of the world"] in facts["log"]
    assert facts["scan"].startswith("2.00 m")
    assert "all expected nodes and services are there" in facts["text"]


def test_teleop_drives_and_stops_when_nobody_holds_the_stick(story):
    facts = story("teleop_publishes")
    assert facts["way"] > 1.0 and facts["sent"] >= 10
    assert facts["words"] == "Stopped: no sign of the stick for 0.3 s."


def test_a_form_publishes_its_first_message_and_asks_its_first_question(story):
    """On a network both would be lost, were they sent before the other side was discovered."""
    facts = story("form_publishes_and_calls")
    assert facts["answer"] == "success: true\ntime_taken: 0.3"


def test_a_live_plot_draws(story):
    assert "last 80.00" in story("live_plot_draws")["text"]


def test_parameters_are_found_and_set(story):
    facts = story("parameters_are_set")
    assert (facts["item"]["value"], facts["item"]["error"]) == ("3.5", "Refused: from 0 to 10")
    assert facts["text"] == "/navigator has 1 parameter: max_speed = 3.5."


def test_the_scene_follows(story):
    assert "1 obstacle" in story("scene_follows")["text"]


def test_the_pictures_are_drawn(story):
    facts = story("pictures")
    assert facts["path"].startswith("Path of turtle1") and facts["status"].startswith("Status on /robot/status")
    assert "3 beams of 7 see something" in facts["scan"]
    assert "/navigator offers /navigate_to" in facts["graph"] and "_lab" not in facts["graph"]


def test_the_notebooks_own_rclpy_is_left_alone(story):
    assert story("the_notebooks_own_nodes") == {"before": False, "after": False, "robot": "<Robot: connected>"}


def test_a_cell_that_connects_can_be_run_twice(story):
    facts = story("connecting_again")
    assert facts["labs"] <= 1
    assert facts["first"] == "<Robot: closed>" and facts["path"] == "Path of turtle"
    assert len(facts["old"]) == 7
    assert facts["error"] == "this connection has ended: robot = connect() makes a new one"


def test_silence_is_explained_without_a_lesson(story):
    silent = story("nobody_is_there")["silent"]
    assert silent.startswith("No node publishes /world/obstacles.") and "lesson" not in silent


def test_closing_ends_the_thread_and_takes_the_node_away_without_waiting(story):
    facts = story("closing")
    assert facts["robot"] == "<Robot: closed>"


def test_a_signal_that_shuts_ros_down_is_noticed(story):
    assert story("a_signal_ends_all_contexts") == {"first": "<Robot: closed>", "then": "<Robot: connected>"}


def test_the_end_of_python_takes_the_node_away(story):
    assert story("left_over") == []


def test_nothing_went_wrong_in_the_loop(stories):
    assert [story.get("loop_errors") for story in stories.values()] == [None, None]


def test_where_only_the_simulated_ros_is_here_connect_says_what_to_do():
    with pytest.raises(RuntimeError, match=r"no real ROS 2 here .* lesson = start\(\)"):
        connect()


def test_a_script_is_told_that_it_needs_a_loop():
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(map(str, (STANDIN, HERE.parent)))}
    program = "import turtle_lesson; turtle_lesson.connect()"
    run = subprocess.run([sys.executable, "-c", program], env=environment, capture_output=True, text=True, timeout=540)
    assert "RuntimeError: connect() needs a notebook" in run.stderr


def test_where_a_real_ros_is_sourced_start_points_to_connect():
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(map(str, (STANDIN, HERE.parent)))}
    program = "import turtle_lesson; turtle_lesson.start()"
    run = subprocess.run([sys.executable, "-c", program], env=environment, capture_output=True, text=True, timeout=540)
    assert "a real ROS 2 is sourced here" in run.stderr and "turtle_lesson.connect()" in run.stderr


@pytest.mark.parametrize(("path", "found"), [((HERE.parent,), "True"), ((STANDIN, HERE.parent), "False")])
def test_the_simulated_commands_are_left_out_where_there_are_real_ones(path, found):
    program = (
        "from IPython.core.interactiveshell import InteractiveShell; shell = InteractiveShell.instance(); "
        "shell.run_line_magic('load_ext', 'turtle_lesson'); print('terminal' in shell.magics_manager.magics['line'])"
    )
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(map(str, path))}
    run = subprocess.run([sys.executable, "-c", program], env=environment, capture_output=True, text=True, timeout=540)
    assert run.stdout.strip() == found, run.stderr
