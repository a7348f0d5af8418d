"""Programs that start programs: `subprocess`, `os.system` and `os.popen` in robot time."""

from __future__ import annotations

import io
import os
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import rclpy

from turtle_lesson.ros.runtime.world import World
from turtle_lesson.session.lesson import underlay_packages

Run = Callable[..., list[Any]]
SECOND = 1_000_000_000


@pytest.fixture
def counter(tmp_path: Path) -> list[str]:
    """The command of a program that counts to three, a number a second, and ends with code 7."""
    path = tmp_path / "count.py"
    path.write_text(
        "import sys, time\nfor number in (1, 2, 3):\n    print(number, *sys.argv[1:])\n    time.sleep(1)\nsys.exit(7)\n"
    )
    return ["python3", str(path)]


def test_a_program_waits_for_the_one_that_it_runs(world: World, run: Run, counter: list[str]) -> None:
    def program(found: list[Any]) -> None:
        found.append(subprocess.run([*counter, "sheep"], capture_output=True, text=True))
        found.append(world.now / SECOND)

    done, when = run(program)
    assert (done.returncode, done.stdout, done.stderr) == (7, "1 sheep\n2 sheep\n3 sheep\n", "")
    assert when == pytest.approx(3, abs=0.001)


def test_lines_of_a_pipe_come_as_they_are_printed(world: World, run: Run, counter: list[str]) -> None:
    def program(found: list[Any]) -> None:
        with subprocess.Popen(counter, stdout=subprocess.PIPE, stderr=subprocess.STDOUT) as child:
            found += [(line, round(world.now / SECOND)) for line in child.stdout or ()]
        found.append(child.returncode)

    assert run(program) == [(b"1\n", 0), (b"2\n", 1), (b"3\n", 2), 7]


def test_what_a_child_prints_goes_where_its_parent_prints(
    run: Run, counter: list[str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    def program(found: list[Any]) -> None:
        subprocess.check_call(["echo", "aloud"])
        subprocess.call(counter, stdout=subprocess.DEVNULL)
        with (tmp_path / "log").open("w") as log:
            found.append(subprocess.call(counter, stdout=log))

    assert run(program) == [7]
    assert capsys.readouterr().out == "aloud\n"
    assert (tmp_path / "log").read_text() == "1\n2\n3\n"


def test_a_child_has_the_variables_that_it_is_given(run: Run, tmp_path: Path) -> None:
    script = tmp_path / "who.py"
    script.write_text("import os\nprint(os.environ.get('WHO'))\n")

    def program(found: list[Any]) -> None:
        with tempfile.NamedTemporaryFile() as log:
            subprocess.run([sys.executable, script], env={**os.environ, "WHO": "me"}, stdout=log, check=True)
            log.seek(0)
            found.append(log.read())
        found.append(subprocess.check_output([sys.executable, script]))

    assert run(program) == [b"me\n", b"None\n"]


def test_ros2_commands_are_run_in_the_same_world(run: Run) -> None:
    def program(found: list[Any]) -> None:
        rclpy.init()
        rclpy.create_node("curious")
        found.append(subprocess.check_output(["ros2", "node", "list"], text=True))
        found.append(os.popen("ros2 node list && echo done").read())
        found.append(os.system("ros2 topic list --wrong 2"))

    assert run(program) == ["/curious\n", "/curious\ndone\n", 2 << 8]


def test_a_launch_goes_on_until_it_is_interrupted(world: World, run: Run) -> None:
    for package in underlay_packages():
        world.packages.add(package)

    def nodes() -> list[str]:
        return subprocess.check_output(["ros2", "node", "list"], text=True).split()

    def program(found: list[Any]) -> None:
        with subprocess.Popen(["ros2", "launch", "turtlesim", "multisim.launch.py"]) as launch:
            time.sleep(1)
            found.append(nodes())
            launch.send_signal(signal.SIGINT)
        found += [launch.returncode, nodes()]
        found.append(subprocess.run(["ros2", "launch", "turtlesim", "multi.launch.py"]).returncode)

    both = ["/turtlesim1/turtlesim", "/turtlesim2/turtlesim"]
    assert run(program, seconds=20) == [both, 0, [], 1]


def test_a_child_is_ended_by_signals(world: World, run: Run, counter: list[str]) -> None:
    def program(found: list[Any]) -> None:
        for ask in (signal.SIGINT, signal.SIGTERM, signal.SIGKILL):
            child = subprocess.Popen(counter, stderr=subprocess.DEVNULL, start_new_session=True)
            time.sleep(0.5)
            found.append(child.poll())
            child.send_signal(ask)
            found.append(child.wait())

    assert run(program) == [None, -2, None, -15, None, -9]


def test_ctrl_c_reaches_the_children_too(world: World, counter: list[str]) -> None:
    children: list[subprocess.Popen[bytes]] = []

    def program() -> None:
        for keywords in ({}, {"start_new_session": True}):
            children.append(subprocess.Popen(counter, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, **keywords))
        time.sleep(99)

    parent = world.spawn(program, name="parent", stderr=io.StringIO())
    world.sim.run_until(SECOND)
    parent.interrupt()
    world.sim.run_until(9 * SECOND)
    assert (parent.exit_code, [child.poll() for child in children]) == (-2, [-2, 7])


def test_a_wait_may_be_too_short(world: World, run: Run, counter: list[str]) -> None:
    def program(found: list[Any]) -> None:
        try:
            subprocess.run(counter, timeout=1.5)
        except subprocess.TimeoutExpired as error:
            found += [error.timeout, world.now / SECOND]
        try:
            subprocess.run(["ros2", "run", "nowhere", "nothing"], check=True, capture_output=True, text=True)
        except subprocess.CalledProcessError as error:
            found += [error.returncode, error.stderr]

    timeout, when, code, said = run(program)
    assert (timeout, code) == (1.5, 1)
    assert when == pytest.approx(1.5, abs=0.001)
    assert "'nowhere' not found" in said


@pytest.mark.parametrize(
    "command",
    ["killall turtlesim_node", "ros2 topic list && clear", "xterm -e ros2 run a b", "ros2 topic list | wc -l"],
)
def test_what_only_the_world_knows_and_cannot_do_is_refused(run: Run, command: str) -> None:
    def program(found: list[Any]) -> None:
        subprocess.run(command, shell=True)

    with pytest.raises(NotImplementedError, match="ros2 commands, Python files, echo and sleep can"):
        run(program)


def test_all_else_is_run_by_the_computer_and_takes_no_robot_time(world: World, run: Run) -> None:
    def program(found: list[Any]) -> None:
        found.append(subprocess.check_output([sys.executable, "-c", "print(6 * 7)"]))
        found.append(os.system("cd ."))
        with subprocess.Popen([sys.executable, "-c", "print(input())"], stdin=-1, stdout=-1, text=True) as child:
            found.append(child.communicate("yes"))
        found.append(world.now)

    assert run(program) == [b"42\n", 0, ("yes\n", None), 0]
    with pytest.raises(FileNotFoundError):
        run(lambda found: subprocess.run(["no-such-program"]))


def test_a_setup_file_has_been_sourced_already(run: Run) -> None:
    def program(found: list[Any]) -> None:
        line = "source /opt/ros/humble/setup.bash && . install/setup.sh; ros2 topic list"
        found.append(subprocess.check_output(line, shell=True, executable="/bin/bash"))

    assert run(program) == [b"/parameter_events\n/rosout\n"]


@pytest.mark.parametrize("keywords", [{"stdin": subprocess.PIPE}, {"cwd": "/"}, {"stdout": 1}, {"input": "y"}])
def test_what_a_child_cannot_have_is_said(run: Run, keywords: dict[str, Any]) -> None:
    def program(found: list[Any]) -> None:
        subprocess.run(["echo"], **keywords)

    with pytest.raises(NotImplementedError, match=r"not available here|cannot be used here"):
        run(program)


def test_a_cell_may_ask_its_world(world: World) -> None:
    assert subprocess.run(["ros2", "node", "list"], capture_output=True, text=True).stdout == ""
    world.spawn(lambda: (rclpy.init(), rclpy.create_node("here"), time.sleep(99)), name="here")
    assert os.popen("ros2 node list").read() == "/here\n"
    assert os.system("ros2 node info /nobody") == 1 << 8
    with pytest.raises(subprocess.TimeoutExpired):
        subprocess.run(["ros2", "topic", "echo", "/rosout"], timeout=2)


def test_outside_of_the_world_all_is_real(world: World) -> None:
    said = subprocess.run([sys.executable, "-c", "print(6 * 7)"], capture_output=True, text=True)
    assert said.stdout == "42\n"
    with subprocess.Popen([sys.executable, "-c", "import sys; sys.exit(3)"]) as child:
        assert (type(child).__name__, child.poll() or child.wait()) == ("Popen", 3)
