"""The checks of page 09: each is about its own case, and never about another one. (Answers to them: answers/page_09.py.)"""

from __future__ import annotations

from pathlib import Path

import pytest

from turtle_lesson import start
from turtle_lesson.ros.cli.shell import run_line
from turtle_lesson.ros.runtime import files

CASES = {
    "topic_case": (9, "topic silent"),
    "service_case": (9, "service times out"),
    "message_case": (12, "message not found"),
    "turtle_case": (1, "turtle stands still"),
}


@pytest.fixture(autouse=True)
def in_a_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(files, "_home", tmp_path)
    monkeypatch.chdir(tmp_path)


@pytest.mark.parametrize("check", CASES)
def test_another_case_does_not_count(check: str) -> None:
    lesson = start()
    case = lesson.trouble(8, name="topic silent")
    run_line(lesson._world, "kill -INT 1004 && ros2 run robot_controller status_monitor")
    assert case.check().passed
    result = lesson.check(check)
    assert not result.passed
    seed, name = CASES[check]
    assert result.rows[0].advice.direction == f'Open this one: case = lesson.trouble({seed}, name="{name}")'


@pytest.mark.parametrize("check", CASES)
def test_without_a_case_it_says_which_one_to_open(check: str) -> None:
    start().trouble(8, name="topic silent")
    assert "there is none in this world yet" in repr(start().check(check))


def test_a_case_uses_a_copy_of_the_learners_package_and_removes_it_again(capsys: pytest.CaptureFixture[str]) -> None:
    lesson = start(page="09_debugging_lab")
    package = lesson.workspace.package
    before = {path: path.read_bytes() for path in sorted(package.rglob("*")) if path.is_file()}
    lesson.trouble(12, name="message not found")
    copied = Path("trouble_ws/src/robot_controller")
    assert "TurtleStatus" not in (copied / "CMakeLists.txt").read_text()
    source = "robot_controller/status_monitor_node.py"
    assert (copied / source).read_bytes() == (package / source).read_bytes()
    run_line(lesson._world, "cd trouble_ws")
    lesson.trouble(8, name="topic silent")
    assert not Path("trouble_ws").exists()
    run_line(lesson._world, "ros2 pkg prefix robot_controller")
    assert capsys.readouterr().out.endswith("workspace/install/robot_controller\n")
    assert {path: path.read_bytes() for path in sorted(package.rglob("*")) if path.is_file()} == before


def test_the_copy_goes_with_its_world(tmp_path: Path) -> None:
    start().trouble(12, name="message not found")
    assert (tmp_path / "trouble_ws").is_dir()
    start()
    assert not (tmp_path / "trouble_ws").exists()


def test_a_folder_of_the_learners_own_is_never_replaced(tmp_path: Path) -> None:
    (tmp_path / "trouble_ws").mkdir()
    lesson = start()
    with pytest.raises(FileExistsError, match="trouble_ws is a folder of your own"):
        lesson.trouble(12, name="message not found")
    assert (tmp_path / "trouble_ws").is_dir()
