"""Troubles on purpose: each is found before it is mended, gone after it, and not mended by something else."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator
from pathlib import Path
from random import Random

import pytest

from turtle_lesson import Lesson, start
from turtle_lesson.lab.troubles.cases import TROUBLES, Case
from turtle_lesson.ros.cli.shell import run_line
from turtle_lesson.ros.runtime import files

RUN_NAVIGATOR, RUN_MONITOR = "ros2 run robot_controller navigator", "ros2 run robot_controller status_monitor"
NAMED = {"CMakeLists.txt": '"msg/TurtleStatus.msg"\n  "srv/NavigateTo.srv"'}
"""What the learner types into that file."""


def cases() -> list[tuple[str, int]]:
    """Each trouble with each fault that ten seeds choose for it, by the name and the first such seed."""
    found: dict[tuple[str, str], int] = {}
    for name, trouble in TROUBLES.items():
        for seed in range(10):
            chance = Random(f"{trouble.name} {seed}")
            found.setdefault((name, chance.choice(list(trouble.faults(chance))).cause), seed)
    return [(name, seed) for (name, _), seed in found.items()]


@pytest.fixture(autouse=True)
def in_a_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    before = Path.cwd()
    monkeypatch.setattr(files, "_home", tmp_path)
    os.chdir(tmp_path)
    yield
    os.chdir(before)


def mend(case: Case) -> list[str]:
    """What a learner types for a cause; `{name}` is the pid that the launch told of that program."""
    ways = {
        "TurtleStatus.msg was not named": [
            "EDIT",
            "cd trouble_ws",
            "colcon build",
            "source install/setup.bash",
            RUN_MONITOR,
        ],
        "The package was written": ["cd trouble_ws", "colcon build", "source install/setup.bash", RUN_MONITOR],
        "The package was built": ["source trouble_ws/install/setup.bash", RUN_MONITOR],
        "The navigator did not run": [RUN_NAVIGATOR],
        "The navigator offered": ["kill {navigator}", RUN_NAVIGATOR],
        "A callback of the navigator": ["kill {navigator_waiting}", RUN_NAVIGATOR],
        "The status monitor did not run": [RUN_MONITOR],
        "The status monitor published": ["kill {status_monitor}", RUN_MONITOR],
        "The parameter publish_rate": ["ros2 param set /status_monitor publish_rate 10"],
        "The simulator did not run": ["ros2 run turtlesim turtlesim_node"],
        "The navigator published": ["kill {navigator}", RUN_NAVIGATOR],
        "The speed limiter let no more": ["ros2 param set /speed_limiter max_speed 4.0"],
        "The speed limiter let a command": ["ros2 param set /speed_limiter command_period 0.1"],
        "The laser sends": [
            "kill {obstacle_alarm}",
            "ros2 run robot_draft obstacle_alarm --ros-args -p reliability:=best_effort",
        ],
        "A node published": ["kill {status_text}", f"ros2 node list | grep status_monitor || {RUN_MONITOR}"],
        "The navigator subtracted": ["ros2 param set /navigator short_way true"],
        "The node made its timer twice": ["kill {status_twice}", RUN_MONITOR],
        "The status monitor ran twice": ["kill {status_monitor}"],
        "The status monitor heard": ["kill {status_monitor}", RUN_MONITOR],
    }
    return next(way for cause, way in ways.items() if case._fault.cause.startswith(cause))


def carry_out(lesson: Lesson, commands: list[str], said: str) -> None:
    pids = dict(re.findall(r"\[INFO\] \[(\w+)-\d+\]: process started with pid \[(\d+)\]", said))
    for command in commands:
        if command == "EDIT":
            file = Path("trouble_ws/src/robot_controller/CMakeLists.txt")
            file.write_text(file.read_text().replace('"srv/NavigateTo.srv"', NAMED[file.name]))
        elif not re.search(r"\{(\w+)\}", command) or re.search(r"\{(\w+)\}", command)[1] in pids:  # type: ignore[index]
            run_line(lesson._world, command.format(**pids))


@pytest.mark.parametrize(("name", "seed"), cases())
def test_it_is_found_before_the_mend_and_gone_after_it(
    name: str, seed: int, capsys: pytest.CaptureFixture[str]
) -> None:
    lesson = start()
    case = lesson.trouble(seed, name=name)
    said = capsys.readouterr().out
    assert not case.check().passed
    carry_out(lesson, mend(case), said)
    result = lesson.check("trouble")
    assert result.passed, f"{case._fault.cause}\n{result}\n{capsys.readouterr()}"
    assert case.cause == case._fault.cause


@pytest.mark.parametrize("later", [0, 4])
@pytest.mark.parametrize(("name", "seed"), cases())
def test_the_mend_of_another_fault_does_not_count(
    name: str, seed: int, later: int, capsys: pytest.CaptureFixture[str]
) -> None:
    """Each fault, and one of two others, which later seeds choose."""
    others = [each for each in TROUBLES if each not in (name, "message not found")]
    lesson = start()
    other = lesson.trouble(seed + later, name=others[(seed + later) % len(others)])
    case = lesson.trouble(seed, name=name)
    if mend(case)[-1].rpartition("|| ")[2] in " ".join(mend(other)):
        return  # two symptoms, one fault: what mends one mends the other
    said = capsys.readouterr().out.rpartition("[launch]")[2]
    carry_out(lesson, mend(other), said)
    assert not case.check().passed
    assert case.cause.startswith("It is not mended yet")


def test_doing_nothing_but_waiting_mends_nothing() -> None:
    lesson = start()
    case = lesson.trouble(name="status frozen")
    lesson.run(60)
    assert not case.check().passed


def test_it_can_be_mended_by_code_in_a_cell(capsys: pytest.CaptureFixture[str]) -> None:
    lesson = start()
    seed = next(s for s in range(50) if "did not run" in lesson.trouble(s, name="topic silent")._fault.cause)
    case = lesson.trouble(seed, name="topic_silent")
    import rclpy
    from robot_controller.msg import TurtleStatus

    rclpy.init()
    node = rclpy.create_node("status_monitor")
    publisher = node.create_publisher(TurtleStatus, "/robot/status", 10)
    assert not case.check().passed
    node.create_timer(0.1, lambda: publisher.publish(TurtleStatus(x=5.54, y=5.54, battery=50.0)))
    assert case.check().passed


def test_one_status_in_two_seconds_shows_no_fall() -> None:
    lesson = start()
    case = lesson.trouble(name="status comes twice")
    run_line(lesson._world, "kill 1004 1007")
    import rclpy
    from robot_controller.msg import TurtleStatus

    rclpy.init()
    node = rclpy.create_node("status_monitor")
    publisher = node.create_publisher(TurtleStatus, "/robot/status", 10)
    node.create_timer(1.9, lambda: publisher.publish(TurtleStatus(battery=50.0)))
    assert case.check().rows[-1].seen == "not looked at, because only one message came on /robot/status in 2 s"


def test_a_seed_always_brings_the_same_case_and_all_of_them_come(capsys: pytest.CaptureFixture[str]) -> None:
    lesson = start()
    first, again = lesson.trouble(3), lesson.trouble(3)
    assert first._fault.cause == again._fault.cause
    assert repr(first) == repr(again)
    assert {lesson.trouble(seed)._trouble.name for seed in range(40)} == set(TROUBLES)


def test_the_case_tells_the_symptom_and_not_the_cause() -> None:
    case = start().trouble(name="turtle stands still")
    text = repr(case)
    assert text.startswith("Case 0, turtle stands still. A user reports: “I send the turtle to a goal")
    assert "Case 0. A user" in repr(start().trouble(0))
    assert case._fault.cause not in text
    assert case.hint(1) != case.hint(2) != case.hint(3)


def test_what_was_typed_wrong_is_explained() -> None:
    lesson = start()
    with pytest.raises(ValueError, match='Did you mean "turtle stands still"'):
        lesson.trouble(name="turtle stands stil")
    with pytest.raises(ValueError, match="a seed is a whole number"):
        lesson.trouble("three")  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="levels from 1 to 3"):
        lesson.trouble(1).hint(4)


def test_a_check_without_a_case_says_so() -> None:
    lesson = start()
    lesson.trouble(1)
    assert "there is none in this world yet" in repr(start().check("trouble"))
