"""Programs with actions, as learners and the official examples write them: built by colcon, started with `ros2 run`."""

from __future__ import annotations

import re
import shutil
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from turtle_lesson.ros.cli.shell import run_line
from turtle_lesson.ros.idl.registry import forget_modules, registry
from turtle_lesson.ros.runtime.world import World

PACKAGES = Path(__file__).parents[1] / "data" / "action_programs"
SECOND = 1_000_000_000
BUILT = 10
"""When (s) the building has ended for sure, and the programs are started."""

Say = Callable[..., list[str]]


@pytest.fixture
def say(
    world: World, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> Iterator[Say]:
    """Returns `say(line, …, seconds=…)`: types lines in a terminal where both packages are built, lets time pass, and
    returns what was printed, with only the seconds of each time, since the start of the programs."""
    shutil.copytree(PACKAGES, tmp_path / "src")
    monkeypatch.chdir(tmp_path)
    assert run_line(world, "colcon build && source install/setup.bash") == 0
    world.sim.run_until(BUILT * SECOND)
    capsys.readouterr()

    def say(*lines: str, seconds: float = 0.0) -> list[str]:
        for line in lines:
            run_line(world, line)
        world.sim.run_until(world.now + round(seconds * SECOND))
        printed = capsys.readouterr().out.splitlines()
        return [_short(line) for line in printed if "is still running. To stop it" not in line]

    yield say
    for name in ("workshop_interfaces", "countdown"):
        forget_modules(name)
        if name in registry.packages():
            registry.remove(name)


def _short(line: str) -> str:
    found = re.fullmatch(r"\[INFO\] \[18000000(\d\d)\.\d+\] \[(\w+)\]: (.*)", line)
    return f"{int(found[1]) - BUILT} {found[2]}: {found[3]}" if found else line


def run(*programs: str) -> list[str]:
    return [f"ros2 run countdown {each}" for each in programs]


def test_a_goal_with_feedback_and_result(say: Say) -> None:
    printed = say(*run("simple_server", "client 3"), seconds=5)
    assert printed == [
        "0 client: Waiting for the action server...",
        "0 client: Goal accepted :)",
        "0 simple_server: Executing goal...",
        "0 client: 3 left",
        "1 client: 2 left",
        "2 client: 1 left",
        "3 client: Goal succeeded: [3, 2, 1]",
    ]


def test_a_server_decides_which_goals_it_takes(say: Say) -> None:
    assert say(*run("parallel_server", "client 11"), seconds=1) == [
        "0 client: Waiting for the action server...",
        "0 parallel_server: Goal 11: rejected",
        "0 client: Goal rejected :(",
    ]


def test_goals_side_by_side_in_several_threads(say: Say) -> None:
    clients = [f"client {start} --ros-args -r __node:=client_{start}" for start in (3, 2)]
    printed = say(*run("parallel_server", *clients), seconds=5)
    assert [line for line in printed if "succeeded" in line or "reached" in line] == [
        "2 parallel_server: Goal 2 reached",
        "2 client_2: Goal succeeded: [2, 1]",
        "3 parallel_server: Goal 3 reached",
        "3 client_3: Goal succeeded: [3, 2, 1]",
    ]


def test_one_thread_reaches_one_goal_after_the_other(say: Say) -> None:
    clients = [f"client {start} --ros-args -r __node:=client_{start}" for start in (2, 1)]
    printed = say(*run("simple_server", *clients), seconds=5)
    assert [line for line in printed if "client_1" in line] == [
        "0 client_1: Waiting for the action server...",
        "2 client_1: Goal accepted :)",  # the thread was busy until then
        "2 client_1: 1 left",
        "3 client_1: Goal succeeded: [1]",
    ]


def test_a_goal_is_cancelled_on_the_way(say: Say) -> None:
    printed = say(*run("parallel_server", "cancelling_client"), seconds=6)
    assert printed[-5:] == [
        "2 cancelling_client: Canceling goal",
        "2 parallel_server: Cancel goal 5",
        "2 cancelling_client: Goal is being canceled",
        "3 parallel_server: Goal 5 canceled at 2",
        "3 cancelling_client: Goal failed with status 5: [5, 4, 3]",
    ]


def test_a_server_that_cancels_nothing_goes_on(say: Say) -> None:
    """Nor could it: its one thread only hears of the wish when the goal is reached. The newer answer comes first."""
    printed = say(*run("simple_server", "cancelling_client"), seconds=6)
    assert [line for line in printed[4:] if "left" not in line] == [
        "2 cancelling_client: Canceling goal",
        "5 cancelling_client: Goal succeeded: [5, 4, 3, 2, 1]",
    ]


def test_an_async_server_hears_of_it_in_one_thread(say: Say) -> None:
    printed = say(*run("plain_server", "cancelling_client"), seconds=6)
    assert printed[-4:] == [
        "2 cancelling_client: Canceling goal",
        "2 plain_server: Received cancel request",
        "2 cancelling_client: Goal is being canceled",
        "3 cancelling_client: Goal failed with status 5: [5, 4, 3]",
    ]


def test_a_new_goal_puts_an_end_to_the_one_before(say: Say) -> None:
    say(*run("single_goal_server", "client 5"), seconds=1.5)
    printed = say(*run("client 1 --ros-args -r __node:=another"), seconds=3)
    assert printed == [
        "1 another: Waiting for the action server...",
        "1 single_goal_server: Goal 1: accepted",
        "1 single_goal_server: Give up goal 5",
        "1 another: Goal accepted :)",
        "1 single_goal_server: Count down from 1",
        "1 another: 1 left",
        "2 single_goal_server: Goal 5 was given up at 3",
        "2 client: Goal failed with status 6: [5, 4]",
        "2 single_goal_server: Goal 1 reached",
        "2 another: Goal succeeded: [1]",
    ]


def test_goals_wait_in_a_queue(say: Say) -> None:
    say(*run("queue_server"))
    printed = []
    for start in (2, 3, 1):
        printed += say(*run(f"client {start} --ros-args -r __node:=client_{start}"), seconds=0.1)
    printed += say(seconds=8)
    assert [line for line in printed if "left" not in line and "Waiting" not in line] == [
        "0 queue_server: Goal 2: accepted",
        "0 client_2: Goal accepted :)",
        "0 queue_server: Count down from 2",
        "0 queue_server: Goal 3: accepted",
        "0 queue_server: Goal 3 has to wait",
        "0 client_3: Goal accepted :)",
        "0 queue_server: Goal 1: accepted",
        "0 queue_server: Goal 1 has to wait",
        "0 client_1: Goal accepted :)",
        "2 queue_server: Goal 2 reached",
        "2 client_2: Goal succeeded: [2, 1]",
        "2 queue_server: Count down from 3",
        "5 queue_server: Goal 3 reached",
        "5 client_3: Goal succeeded: [3, 2, 1]",
        "5 queue_server: Count down from 1",
        "6 queue_server: Goal 1 reached",
        "6 client_1: Goal succeeded: [1]",
    ]


def test_a_goal_is_accepted_now_and_executed_later(say: Say) -> None:
    assert say(*run("deferring_server", "client 1"), seconds=6)[1:] == [
        "0 deferring_server: Goal 1: accepted",
        "0 deferring_server: Later",
        "0 client: Goal accepted :)",
        "3 deferring_server: Count down from 1",
        "3 client: 1 left",
        "4 deferring_server: Goal 1 reached",
        "4 client: Goal succeeded: [1]",
    ]


def test_a_goal_is_cancelled_before_it_was_begun(say: Say) -> None:
    printed = say(*run("deferring_server", "cancelling_client"), seconds=6)
    assert printed[-4:] == [
        "2 cancelling_client: Goal is being canceled",
        "3 deferring_server: Count down from 5",
        "3 deferring_server: Goal 5 canceled at 5",
        "3 cancelling_client: Goal failed with status 5: []",
    ]


def test_a_client_that_spins_while_it_waits(say: Say) -> None:
    assert say(*run("plain_server", "plain_client"), seconds=5) == [
        "accepted True",
        "feedback 2",
        "feedback 1",
        "result [2, 1] status 4",
    ]


def test_a_client_that_blocks_while_another_thread_spins(say: Say) -> None:
    assert say(*run("simple_server", "blocking_client"), seconds=5)[1:] == [
        "feedback 2",
        "feedback 1",
        "result [2, 1] status 4",
        "shut down",
    ]


def test_a_client_in_asyncios_loop(say: Say) -> None:
    printed = say(*run("parallel_server", "asyncio_client"), seconds=6)
    assert [line for line in printed if "parallel_server" not in line] == ["together [[2, 1], [3, 2, 1]]", "alone [1]"]


def test_a_server_that_runs_asyncios_loop_for_each_goal(say: Say) -> None:
    printed = say(*run("asyncio_server", "asyncio_client"), seconds=6)
    assert [line for line in printed if "asyncio_server" not in line] == ["together [[2, 1], [3, 2, 1]]", "alone [1]"]


def test_a_node_that_is_server_and_client_in_one_thread(say: Say) -> None:
    say(*run("plain_server", "relay", "client 2 --ros-args -r countdown:=double_countdown"))
    assert say(seconds=6)[-2:] == ["3 relay: 1 left", "4 client: Goal succeeded: [2, 1, 2, 1]"]


def test_the_command_line_sends_a_goal_to_a_learners_server(say: Say) -> None:
    say(*run("simple_server"))
    printed = say("ros2 action send_goal --feedback /countdown workshop_interfaces/action/Countdown '{start: 1}'")
    assert [re.sub("[0-9a-f]{32}", "…", line) for line in printed] == [
        "Waiting for an action server to become available...",
        "Sending goal:",
        "     start: 1",
        "",
        "Goal accepted with ID: …",
        "",
        "0 simple_server: Executing goal...",
        "Feedback:",
        "    left: 1",
        "",
        "Result:",
        "    counted:",
        "- 1",
        "",
        "Goal finished with status: SUCCEEDED",
    ]
