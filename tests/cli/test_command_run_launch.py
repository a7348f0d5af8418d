"""`ros2 run` and `ros2 launch`: they start what they are asked for and return, and answer mistakes as recorded."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from command_cases import check, type_in
from workspace_on_disk import install_robot_controller

from turtle_lesson.ros.cli.shell import run_line
from turtle_lesson.ros.idl.registry import registry
from turtle_lesson.ros.runtime.world import World

SECOND = 1_000_000_000


@pytest.fixture(autouse=True)
def workspace(world: World, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    monkeypatch.chdir(tmp_path)
    install_robot_controller(world, tmp_path)
    yield tmp_path
    registry.remove("robot_controller")


def nodes(world: World) -> list[str]:
    return sorted(node.full_name for node in world.graph.nodes)


def test_mistakes_are_answered_as_recorded(world: World) -> None:
    check(world, "run_launch.txt")


# -- run -----------------------------------------------------------------------------------------------------------------


def test_a_program_is_started_and_left_running(world: World, capsys: pytest.CaptureFixture[str]) -> None:
    assert run_line(world, "ros2 run robot_controller navigator") == 0
    first, last = capsys.readouterr().out.splitlines()
    assert first == "[INFO] [1800000000.000000000] [navigator]: Navigator node started"
    assert last == "[1] ros2 run robot_controller navigator is still running. To stop it, as Ctrl-C would: kill -INT %1"
    assert world.now == 0
    assert nodes(world) == ["/navigator"]


def test_a_program_logs_into_its_file_while_it_runs(world: World, capsys: pytest.CaptureFixture[str]) -> None:
    run_line(world, "ros2 run robot_controller navigator > log.txt 2>&1")
    run_line(world, "kill -INT %1")
    printed = capsys.readouterr()
    assert printed.out.splitlines() == [
        "[1] ros2 run robot_controller navigator is still running. To stop it, as Ctrl-C would: kill -INT %1"
    ]
    logged = Path("log.txt").read_text().splitlines()
    assert logged[0].endswith("[navigator]: Navigator node started")
    assert logged[-2:] == ["KeyboardInterrupt", "[ros2run]: Interrupt"]


def test_starting_the_same_twice_is_pointed_out(world: World, capsys: pytest.CaptureFixture[str]) -> None:
    run_line(world, "ros2 run robot_controller navigator; ros2 run robot_controller navigator")
    last = capsys.readouterr().out.splitlines()[-1]
    assert (
        last
        == "The same command is running as [1], so everything in it exists twice now. To stop that one: kill -INT %1"
    )
    run_line(world, "kill -INT %1; ros2 run robot_controller navigator")
    assert "The same command is running as [2]" in capsys.readouterr().out.splitlines()[-1]


def test_what_the_last_line_advises_ends_it_as_ctrl_c_does(world: World, capsys: pytest.CaptureFixture[str]) -> None:
    run_line(world, "ros2 run robot_controller navigator; jobs; kill -INT %1; jobs")
    out = capsys.readouterr().out
    assert "[1]  Running                 ros2 run robot_controller navigator &" in out
    assert out.splitlines()[-2:] == ["KeyboardInterrupt", "[ros2run]: Interrupt"]
    assert nodes(world) == []


@pytest.mark.parametrize(("signal", "word"), [("-9", "Killed"), ("-TERM", "Terminated"), ("", "Terminated")])
def test_other_signals(world: World, capsys: pytest.CaptureFixture[str], signal: str, word: str) -> None:
    run_line(world, f"ros2 run robot_controller navigator; kill {signal} %1")
    assert capsys.readouterr().out.splitlines()[-1] == f"[ros2run]: {word}"


def test_a_process_can_be_named_by_its_number(world: World) -> None:
    run_line(world, "ros2 run robot_controller navigator")
    pid = world.processes[-1].pid
    assert run_line(world, f"kill -INT {pid}") == 0
    assert nodes(world) == []


def test_a_job_that_is_not_there_keeps_no_other_one_running(world: World) -> None:
    run_line(world, "ros2 run robot_controller navigator")
    assert run_line(world, "kill -INT %7 %1") == 1
    assert nodes(world) == []


def test_a_program_is_told_what_stands_behind_its_name(world: World) -> None:
    run_line(world, "ros2 run robot_controller navigator --ros-args -r __node:=bob -r __ns:=/team")
    assert nodes(world) == ["/team/bob"]


def test_a_program_that_fails_at_once_gives_its_exit_code(world: World, capsys: pytest.CaptureFixture[str]) -> None:
    assert run_line(world, "ros2 run robot_controller raise_init") == 1
    lines = capsys.readouterr().out.splitlines()
    assert lines[-2:] == ["NameError: name 'Strng' is not defined", "[ros2run]: Process exited with failure 1"]


def test_a_program_that_fails_later_says_so_then(world: World, capsys: pytest.CaptureFixture[str]) -> None:
    assert run_line(world, "ros2 run robot_controller raise_cb") == 0
    assert "failure" not in capsys.readouterr().out
    world.sim.run_until(SECOND)
    lines = capsys.readouterr().out.splitlines()
    assert lines[-2:] == ["ValueError: boom in callback", "[ros2run]: Process exited with failure 1"]


def test_for_lets_time_pass_first(world: World) -> None:
    assert run_line(world, "ros2 run --for 2.5 robot_controller navigator") == 0
    assert world.now == round(2.5 * SECOND)
    assert nodes(world) == ["/navigator"]


def test_a_program_that_was_deleted_is_said_to_be_gone(world: World, workspace: Path) -> None:
    (workspace / "install/robot_controller/lib/robot_controller/navigator").unlink()
    answer = type_in(world, "ros2 run robot_controller navigator")
    assert answer.code == 1
    assert answer.stderr.startswith("No executable found\n")


# -- launch --------------------------------------------------------------------------------------------------------------


def test_a_launch_is_started_and_left_running(world: World, capsys: pytest.CaptureFixture[str]) -> None:
    assert run_line(world, "ros2 launch robot_controller start_system.launch.py") == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[0] == "[INFO] [launch]: Default logging verbosity is set to INFO"
    assert (
        lines[-1]
        == "[1] ros2 launch robot_controller start_system.launch.py is still running. To stop it, as Ctrl-C would: kill -INT %1"
    )
    assert nodes(world) == ["/navigator", "/status_monitor"]
    assert run_line(world, "kill -INT %1") == 0
    out = capsys.readouterr().out
    assert out.startswith("[WARNING] [launch]: user interrupted with ctrl-c (SIGINT)\n")
    assert "[ERROR] [status_monitor-2]: process has died [pid 1003, exit code -2, cmd" in out
    assert nodes(world) == []


def test_a_launch_file_may_be_named_by_its_path(world: World, workspace: Path) -> None:
    path = "install/robot_controller/share/robot_controller/launch/args.launch.py"
    answer = type_in(world, f"ros2 launch {path} robot:=bob")
    assert (answer.stderr, answer.code) == ("", 0)
    assert "Name of the robot" in type_in(world, f"ros2 launch {path} --show-args").stdout


def test_of_several_values_for_an_argument_the_last_one_counts(world: World) -> None:
    answer = type_in(world, "ros2 launch robot_controller args.launch.py robot:=a robot:=b rate:=5")
    assert (answer.stderr, answer.code) == ("", 0)


def test_an_argument_needs_a_colon(world: World) -> None:
    answer = type_in(world, "ros2 launch robot_controller args.launch.py robot=bob")
    assert answer.code == 1
    assert answer.stderr.splitlines() == [
        "malformed launch argument 'robot=bob', expected format '<name>:=<value>'",
        "Did you mean 'robot:=bob'?",
    ]


def test_a_syntax_error_is_placed(world: World) -> None:
    answer = type_in(world, "ros2 launch robot_controller syntax.launch.py")
    assert answer.code == 1
    assert " - SyntaxError: invalid syntax. Perhaps you forgot a comma?" in answer.stdout
    assert "syntax.launch.py, line 6" in answer.stdout
