"""Programs with tf2, as learners and the official tutorials write them: built by colcon, run and launched."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from workshop import Workshop, built, distance

from turtle_lesson.ros.runtime.world import World


@pytest.fixture
def workshop(
    world: World, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> Iterator[Workshop]:
    with built("tf2_programs", world, tmp_path, monkeypatch, capsys) as workshop:
        yield workshop


def run(*programs: str) -> list[str]:
    return [f"ros2 run frames_workshop {each}" for each in programs]


def start(**arguments: str) -> str:
    words = "".join(f" {name}:={value}" for name, value in arguments.items() if name != "file")
    return f"ros2 launch frames_workshop {arguments['file']}.launch.py{words}"


def test_a_static_frame_is_known_to_who_comes_later(workshop: Workshop) -> None:
    workshop.say(*run("static_frame shelf 1 2 3 0 0 1.5708"), seconds=5)
    printed = workshop.say("ros2 run tf2_ros tf2_echo world shelf", seconds=1.5)
    unknown = 'Invalid frame ID "world" passed to canTransform argument target_frame - frame does not exist'
    assert printed == [
        f"5.0 tf2_echo: Waiting for transform world ->  shelf: {unknown}",
        "At time 0.0",
        "- Translation: [1.000, 2.000, 3.000]",
        "- Rotation: in Quaternion [0.000, 0.000, 0.707, 0.707]",
        "- Rotation: in RPY (radian) [0.000, -0.000, 1.571]",
        "- Rotation: in RPY (degree) [0.000, -0.000, 90.000]",
        "- Matrix:",
        " -0.000 -1.000  0.000  1.000",
        "  1.000 -0.000  0.000  2.000",
        "  0.000  0.000  1.000  3.000",
        "  0.000  0.000  0.000  1.000",
    ]


def test_a_static_frame_needs_all_its_words(workshop: Workshop) -> None:
    assert workshop.say(*run("static_frame shelf 1 2")) == [
        "static_frame NAME x y z roll pitch yaw",
        "[ros2run]: Process exited with failure 1",
    ]


def test_turtle2_is_spawned_and_follows_turtle1(workshop: Workshop) -> None:
    seen = workshop.watch("turtle1", "turtle2")
    printed = workshop.say(start(file="follow"), seconds=3)
    assert "1.9 sim: Spawning turtle [turtle2] at x=[4.000000], y=[2.000000], theta=[0.000000]" in printed
    apart = distance(seen["turtle1"][-1], seen["turtle2"][-1])
    workshop.run(12)
    assert apart > 2.0
    assert distance(seen["turtle1"][-1], seen["turtle2"][-1]) < 0.01


def test_it_follows_one_that_drives_too(workshop: Workshop) -> None:
    seen = workshop.watch("turtle1", "turtle2")
    push = "'{linear: {x: 0.5}, angular: {z: 0.3}}'"
    workshop.say(start(file="follow"), seconds=2)
    workshop.say(f"ros2 topic pub --rate 5 /turtle1/cmd_vel geometry_msgs/msg/Twist {push} &", seconds=20)
    gaps = [distance(one, other) for one, other in zip(seen["turtle1"][-600:], seen["turtle2"][-600:], strict=True)]
    assert distance(seen["turtle1"][-600], seen["turtle1"][-1]) > 1.0
    assert min(gaps) > 0.2 and max(gaps) < 2.5


def test_it_follows_a_carrot_that_turtle1_carries(workshop: Workshop) -> None:
    seen = workshop.watch("turtle1", "turtle2")
    workshop.say(start(file="carrot"), seconds=20)
    assert seen["turtle2"][-1][:2] == pytest.approx((5.544445, 7.544445), abs=0.01)
    assert workshop.say("ros2 run tf2_ros tf2_echo map carrot1", seconds=1.5)[2:4] == [
        "- Translation: [5.544, 7.544, 0.000]",
        "- Rotation: in Quaternion [0.000, 0.000, 0.000, 1.000]",
    ]


def test_a_carrot_that_circles_is_chased_around(workshop: Workshop) -> None:
    seen = workshop.watch("turtle1", "turtle2")
    workshop.say(start(file="carrot", moving="true"), seconds=30)
    sides = {(x > 5.544, y > 5.544) for x, y, _ in seen["turtle2"][-900:]}
    assert len(sides) == 4


def test_a_listener_that_looks_into_the_past_hears_why_it_cannot_yet(workshop: Workshop) -> None:
    workshop.say(start(file="follow"))
    printed = workshop.say(*run("late_follower"), seconds=7.5)
    said = [line.partition("late_follower: ")[2] for line in printed if "late_follower" in line]
    where = "when looking up transform from frame [turtle1] to frame [world]"
    requested = "Requested time 1800000009.900001 but the earliest data is at time 1800000010.912114"
    assert said[0] == 'LookupException: "turtle2" passed to lookupTransform argument target_frame does not exist. '
    assert said[3] == (
        "ExtrapolationException: Lookup would require extrapolation into the past.  " + f"{requested}, {where}"
    )
    assert said[5:] == ["five seconds ago turtle1 was at 0.33 0.02", "five seconds ago turtle1 was at 0.17 0.00"]


def test_frames_are_awaited_in_a_coroutine_by_a_future_and_in_a_thread(workshop: Workshop) -> None:
    assert workshop.say(*run("patient_listener"), seconds=5) == [
        "1.5 patient_listener: thread, after one second: False"
    ]
    gate = "ros2 run tf2_ros static_transform_publisher --x 4.5 --frame-id world --child-frame-id gate"
    assert sorted(workshop.say(gate, seconds=1))[:3] == [
        "5.0 patient_listener: coroutine: 4.5",
        "5.0 patient_listener: future: 4.5",
        "5.0 patient_listener: thread: 4.5",
    ]
    answer = workshop.say("ros2 service call /tf2_frames tf2_msgs/srv/FrameGraph")
    assert "frame_yaml=\"gate: \\n  parent: 'world'\\n" in answer[3]


def test_points_are_transformed_as_soon_as_their_frame_is_known(workshop: Workshop) -> None:
    point = '"{header: {frame_id: cam}, point: {x: 1.0}}"'
    tell = f"ros2 topic pub --once /points geometry_msgs/msg/PointStamped {point}"
    camera = "ros2 run tf2_ros static_transform_publisher 4.5 0 0 1.5707963 0 0 world cam"
    workshop.say(*run("point_transformer"), seconds=1)
    unknown = '"world" passed to lookupTransform argument target_frame does not exist. '
    assert f"1.3 WARN point_transformer: {unknown}" in workshop.say(tell, seconds=1)
    workshop.say(camera, seconds=1)
    assert workshop.say(tell, seconds=1)[-1].endswith("point_transformer: 4.50 1.00 0.00")


def test_a_quaternion_of_zeros_is_ignored_and_tf2_says_so(workshop: Workshop) -> None:
    whose = 'Ignoring transform for child_frame_id "robot" from authority "default_authority"'
    nan = "(0.000000 0.000000 0.000000) (nan nan nan nan)"
    wrong = 'Invalid frame ID "world" passed to canTransform argument target_frame - frame does not exist'
    assert workshop.say(*run("broken_broadcaster"), seconds=2) == [
        f"Error:   TF_NAN_INPUT: {whose} because of a nan value in the transform {nan}",
        f"Error:   TF_DENORMALIZED_QUATERNION: {whose} because of an invalid quaternion in the transform (nan nan nan nan)",
        f"(False, '{wrong}')",
    ]
