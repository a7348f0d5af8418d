"""The path in words and as a picture, from poses written by hand."""

import math

import numpy as np
import pytest
from lab_fakes import SECOND, START, TICK, drive, recording, stand

from turtle_lesson.lab.path import LABEL, SIGN, WORLD, distance_driven, find_jumps, plot_path
from turtle_lesson.turtlesim.obstacles import Box, Circle


def test_a_straight_drive():
    heard = drive(recording(), seconds=2.0)
    for number in range(20):
        heard.commands.append(START + number * 100_000_000, 1.0, 0.0, 0.0)
    assert repr(plot_path(heard)) == (
        "Path of turtle1 from 0.02 s to 2.00 s of robot time: from (5.56, 5.54) m facing 0.00 rad (0.0°) "
        "it drove 1.98 m to (7.54, 5.54) m facing 0.00 rad (0.0°), 1.98 m from its start. "
        "20 commands on /turtle1/cmd_vel in that time."
    )


def test_a_turtle_that_stays():
    assert plot_path(drive(recording(), speed=0.0)).text == (
        "Path of turtle1 from 0.02 s to 2.00 s of robot time: "
        "it stayed at (5.54, 5.54) m facing 0.00 rad (0.0°). No command on /turtle1/cmd_vel in that time."
    )


def test_a_turtle_that_turns_on_the_spot():
    heard = drive(recording(), speed=0.0)
    heard.poses.append(START + 3_000_000_000, 5.544445, 5.544445, -math.pi / 2, 0.0)
    assert "it turned on the spot, and is now facing -1.57 rad (-90.0°)." in plot_path(heard).text


def test_a_turtle_at_the_wall():
    heard = drive(recording(), seconds=1.0)
    heard.poses.append(START + 63 * TICK, 11.088889, 11.088889, 0.0, 400.0)
    assert "It touches the right and the upper wall." in plot_path(heard).text


def test_a_teleport_is_no_drive():
    heard = drive(recording(), seconds=1.0)
    drive(heard, seconds=1.0, at=(2.0, 2.0, math.pi / 2))
    poses = heard.poses.array()
    assert find_jumps(poses).tolist() == [62]
    assert distance_driven(poses, find_jumps(poses)) == pytest.approx(122 * 0.016)
    assert "It was put elsewhere 1 time (teleport or reset)." in plot_path(heard).text


def test_poses_that_come_in_bursts_and_with_gaps_are_a_drive():
    heard = drive(recording(), seconds=4.0)
    drive(heard, seconds=2.0, at=(2.0, 2.0, math.pi / 2))
    poses = heard.poses.array().copy()
    burst = 300_000_000
    poses["stamp"] = (
        -(-poses["stamp"] // burst) * burst + np.arange(len(poses)) * 1000
    )  # a busy kernel takes all at once
    assert find_jumps(poses).tolist() == [250]
    poses = np.delete(poses, slice(60, 65))  # and its queue was full
    assert find_jumps(poses).tolist() == [245]


def test_goals_tell_what_is_left():
    text = plot_path(drive(recording()), goal=[(8.0, 5.544445), (7.5, 5.0, math.pi)]).text
    assert text.endswith(
        "The goal (8.00, 5.54) m is 0.46 m away. "
        "The goal (7.50, 5.00) m facing 3.14 rad (180.0°) is 0.55 m away, and a turn of 3.14 rad (180.0°)."
    )


@pytest.mark.parametrize("goal", [3, (1,), (1, 2, 3, 4), ("a", "b"), [(1, 2), 5], (math.nan, 1), {"x": 1}])
def test_what_is_no_goal_is_refused_with_an_example(goal):
    with pytest.raises(ValueError, match=r"a goal is \(x, y\) in metres.*try goal=\(8\.0, 8\.0, 1\.57\)"):
        plot_path(drive(recording()), goal=goal)


def test_obstacles_are_named():
    pillar, wall = Circle(8.5, 5.5, 0.4), Box(3.0, 2.5, 2.0, 0.5, 0.3)
    text = plot_path(stand(drive(recording()), pillar, wall)).text
    assert text.endswith("2 obstacles in the world: circle at (8.50, 5.50) m, box at (3.00, 2.50) m.")


def test_nothing_heard_yet():
    picture = plot_path(recording())
    assert picture.figure is None
    silence = "No message has come on /turtle1/pose yet. Let robot time pass: lesson.run(1.0)."
    assert picture.text == f"No path yet. {silence}"


def test_one_pose_alone_can_be_drawn():
    heard = recording()
    heard.poses.append(START, 1.0, 1.0, 0.0, 0.0)
    assert plot_path(heard).png()


def test_poses_that_are_no_numbers_are_left_out():
    heard = drive(recording(), seconds=1.0)
    heard.poses.append(START + SECOND, math.nan, 1.0, 0.0, 0.0)
    picture = plot_path(heard)
    assert "Left out: 1 pose with nan, which is not a number." in picture.text and picture.png()
    nowhere = recording()
    nowhere.poses.append(START, math.nan, 1.0, 0.0, 0.0)
    assert plot_path(nowhere).text == "No path to draw: 1 pose heard, all with nan, which is not a number."


@pytest.mark.parametrize(
    ("at", "speed", "goal"),
    [
        ((5.5, 5.5, 0.0), 0.0, (5.5, 5.5)),
        ((5.5, 5.5, 0.0), 0.1, (5.5, 5.0)),
        ((0.1, 0.1, 0.0), 0.0, (1.0, 0.1)),
        ((11.0, 11.0, 1.57), 0.0, (11.0, 10.0)),
        ((2.0, 9.0, 0.0), 1.0, (1.2, 9.0)),
    ],
)
def test_the_word_start_covers_neither_turtle_nor_flag_and_stays_within_the_walls(at, speed, goal):
    heard = drive(recording(), at=at, speed=speed)
    (axes,) = plot_path(heard, goal=goal).figure.axes
    (label,) = [text for text in axes.texts if text.get_text() == "start"]
    place = label.get_position()
    last = heard.poses.array()[-1]
    for x, y in ((last["x"], last["y"]), (goal[0], goal[1] + 0.35)):
        assert (np.abs(np.subtract(place, (x, y))) >= np.add(LABEL, SIGN)).any()
    assert all(half < each < WORLD - half for each, half in zip(place, LABEL, strict=True))
