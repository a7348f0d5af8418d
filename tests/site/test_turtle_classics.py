"""The turtlesim classics, as they are found in textbooks and repositories: built by colcon, run and launched."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path

import pytest
from workshop import Place, Workshop, built, distance

from turtle_lesson.ros.runtime.world import World

SIMULATOR = "ros2 run turtlesim turtlesim_node"
MIDDLE = 5.544445


@pytest.fixture
def workshop(
    world: World, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> Iterator[Workshop]:
    with built("turtle_classics", world, tmp_path, monkeypatch, capsys) as workshop:
        yield workshop


def run(program: str) -> str:
    return f"ros2 run turtle_classics {program}"


def closest(poses: list[Place], x: float, y: float) -> float:
    """How near a turtle has come to a point."""
    return min(distance((x, y, 0.0), pose) for pose in poses)


def said_by(node: str, printed: list[str]) -> list[str]:
    return [line.partition(f"{node}: ")[2] for line in printed if f" {node}: " in line]


# ---------------------------------------------------------------- squares and spirals


def test_a_square_by_the_clock_alone(workshop: Workshop) -> None:
    seen = workshop.watch("turtle1")
    printed = workshop.say(SIMULATOR, run("square_open_loop"), seconds=20)
    assert said_by("square_open_loop", printed) == ["corner 1", "corner 2", "corner 3", "corner 4"]
    for x, y in ((0, 0), (2, 0), (2, 2), (0, 2)):
        assert closest(seen["turtle1"], MIDDLE + x, MIDDLE + y) < 0.05
    assert distance(seen["turtle1"][-1], (MIDDLE, MIDDLE, 0.0)) < 0.05


def test_a_square_with_an_eye_on_the_pose(workshop: Workshop) -> None:
    seen = workshop.watch("turtle1")
    printed = workshop.say(SIMULATOR, run("square_feedback --ros-args -p side:=2.0"), seconds=20)
    assert said_by("square_feedback", printed) == ["at 7.5 5.5", "at 7.5 7.5", "at 5.6 7.5", "at 5.5 5.6"]
    assert closest(seen["turtle1"], MIDDLE + 2.0, MIDDLE + 2.0) < 0.06
    assert "/square_feedback" not in workshop.say("ros2 node list")


def test_a_spiral_grows_until_the_wall_is_near(workshop: Workshop) -> None:
    seen = workshop.watch("turtle1")
    printed = workshop.say(SIMULATOR, run("spiral --ros-args -p growth:=0.5"), seconds=30)
    assert said_by("spiral", printed)[0].startswith("near the wall at a speed of ")
    turtle = seen["turtle1"]
    second = [distance(turtle[62 * time], turtle[62 * time + 1]) for time in range(1, 14)]
    assert second == sorted(second) and second[-1] > 5 * second[0]
    assert turtle[-1] == turtle[-100] and min(10.1 - max(turtle[-1][:2]), min(turtle[-1][:2]) - 0.9) > 0.0


# ---------------------------------------------------------------- go to goal


@pytest.mark.parametrize(("words", "goal"), [("2.0 9.0", (2.0, 9.0)), ("--ros-args -p x:=9.0 -p y:=1.5", (9.0, 1.5))])
def test_a_goal_is_reached(workshop: Workshop, words: str, goal: tuple[float, float]) -> None:
    seen = workshop.watch("turtle1")
    printed = workshop.say(SIMULATOR, run(f"go_to_goal {words}"), seconds=10)
    assert said_by("go_to_goal", printed)[0].startswith("arrived at ")
    assert closest(seen["turtle1"], *goal) < 0.1
    assert distance(seen["turtle1"][-1], (*goal, 0.0)) < 0.15


def test_a_goal_behind_the_wall_is_given_up(workshop: Workshop) -> None:
    printed = workshop.say(SIMULATOR, run("go_to_goal 20.0 8.0"), seconds=31)
    assert said_by("go_to_goal", printed) == ["gave up"]
    assert "[ros2run]: Process exited with failure 1" in printed


# ---------------------------------------------------------------- follow the leader


def test_turtles_follow_in_a_row(workshop: Workshop) -> None:
    seen = workshop.watch("turtle1", "turtle2", "turtle3", "turtle4")
    workshop.say("ros2 launch turtle_classics chain.launch.py length:=3", seconds=25)
    row = [seen[turtle] for turtle in ("turtle1", "turtle2", "turtle3", "turtle4")]
    for leader, follower in pairwise(row):
        assert distance(leader[-1], follower[-1]) == pytest.approx(1.0, abs=0.05)
        assert all(distance(*pair) > 0.3 for pair in zip(leader[400:], follower[400:], strict=False))
    assert workshop.say("ros2 run tf2_tools view_frames", seconds=6)[-3].startswith("├── turtle")


# ---------------------------------------------------------------- a letter


def test_a_turtle_writes_a_letter(workshop: Workshop) -> None:
    workshop.say(SIMULATOR, seconds=0.1)
    workshop.say("ros2 run turtle_letters write_letter.py h --ros-args -p colour:=[0,200,0]", seconds=2)
    colours = {}
    for place in ((0.0, 1.0), (2.0, 2.0), (1.0, 1.5), (1.0, 2.5), (0.5, 0.5)):
        colours[place] = colour_at(workshop, 4.0 + place[0], 4.0 + place[1])
    green, bare = (0, 200, 0), (255, 255, 255)
    assert list(colours.values()) == [green, green, green, bare, bare]


def colour_at(workshop: Workshop, x: float, y: float) -> tuple[int, ...]:
    """What the turtle's colour sensor says at a place to which it is carried."""
    lift = "ros2 service call /turtle1/set_pen turtlesim/srv/SetPen \"{'off': 1}\""  # a bare off is YAML for False
    carry = f"ros2 service call /turtle1/teleport_absolute turtlesim/srv/TeleportAbsolute '{{x: {x}, y: {y}}}'"
    workshop.say(lift, carry, seconds=0.1)
    lines = workshop.say("ros2 topic echo --once /turtle1/color_sensor", seconds=0.5)
    return tuple(int(line.partition(": ")[2]) for line in lines if line[:2] in ("r:", "g:", "b:"))


def test_a_letter_needs_a_turtle(workshop: Workshop) -> None:
    assert workshop.say("ros2 run turtle_letters write_letter.py h", seconds=6) == [
        "/turtle1/set_pen is not there",
        "[ros2run]: Process exited with failure 1",
    ]


# ---------------------------------------------------------------- catch them all


def test_all_turtles_are_caught(workshop: Workshop) -> None:
    printed = workshop.say("ros2 launch turtle_hunt hunt.launch.py", seconds=20)
    assert said_by("hunter", printed) == [f"caught prey_{number}, {number} so far" for number in range(1, 9)]
    assert sum("Spawning turtle [prey_" in line for line in printed) == 8
    topics = workshop.say("ros2 topic list")
    assert "/turtle1/pose" in topics and not any("prey" in topic for topic in topics)
    assert workshop.say("ros2 param get /spawner most") == ["Integer value is: 8"]


def test_the_first_is_caught_first_and_one_that_is_gone_cannot_be_caught(workshop: Workshop) -> None:
    hunter = "ros2 run turtle_hunt hunter --ros-args -p closest_first:=false"
    spawner = "ros2 run turtle_hunt spawner --ros-args -p period:=0.2 -p most:=5"
    printed = workshop.say(SIMULATOR, spawner, seconds=2)
    assert sum("Spawning turtle [turtle_" in line for line in printed) == 5
    told = workshop.say("ros2 topic info /free_turtles")
    assert told[0] == "Type: hunt_interfaces/msg/PreyArray"
    answers = [
        workshop.say(f"ros2 service call /catch_turtle hunt_interfaces/srv/Catch '{{name: {name}}}'", seconds=0.5)
        for name in ("turtle_3", "turtle_3")
    ]
    assert any("Catch_Response(success=True, left=4)" in line for line in answers[0])
    assert any("Catch_Response(success=False, left=4)" in line for line in answers[1])
    workshop.say(hunter, seconds=0.5)
    workshop.say("ros2 service call /catch_turtle hunt_interfaces/srv/Catch '{name: turtle_5}'", seconds=0.1)
    caught = said_by("hunter", workshop.say(seconds=12))
    assert caught == ["caught turtle_1, 1 so far", "caught turtle_2, 2 so far", "caught turtle_4, 3 so far"]


def test_prey_appears_at_the_same_places_in_every_run(workshop: Workshop) -> None:
    printed = workshop.say("ros2 launch turtle_hunt hunt.launch.py", seconds=5)
    assert "prey_1] at x=[8.599858], y=[4.810770]" in next(line for line in printed if "Spawning turtle [prey_" in line)
