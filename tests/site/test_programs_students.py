"""A student's turtlesim projects in many shapes: a menu, globals, a state machine, a tree, a library of their own."""

from __future__ import annotations

import pytest
from program_terminal import PACKAGES, Terminal, having


@pytest.fixture
def terminal(fresh_terminal: Terminal) -> Terminal:
    """A terminal where a student's packages are built, and the simulator is there."""
    fresh_terminal.build("student_tools", "student_turtles")
    return fresh_terminal


def run(terminal: Terminal, *programs: str, seconds: float = 0.0) -> list[str]:
    """What a student's programs print beside a simulator; that one's own lines are left out."""
    simulator = ["turtlesim turtlesim_node"] if terminal.world.now <= 10_000_000_000 else []
    printed = terminal.run(*simulator, *(f"student_turtles {each}" for each in programs), seconds=seconds)
    return [line for line in printed if "turtlesim:" not in line]


def test_a_menu_in_the_main_thread(terminal: Terminal) -> None:
    assert run(terminal, "menu", seconds=8) == [
        "1: forward  2: turn  3: spawn  q: quit",
        "x = 7.54",
        "theta = 89",
        "spawned friend",
        "unknown choice x",
    ]
    assert terminal.exit_codes() == [None, 0]


def test_global_variables(terminal: Terminal) -> None:
    assert run(terminal, "globals", seconds=3) == ["1.6 with_globals: reached 7.0 after 99 poses"]


def test_a_state_machine_with_arguments(terminal: Terminal) -> None:
    assert run(terminal, "spin_once -n 2 --ros-args -r __node:=polygon", seconds=4) == [
        "0.0 polygon: WAIT -> DRIVE",
        "1.0 polygon: DRIVE -> TURN",
        "1.5 polygon: TURN -> DRIVE",
        "2.5 polygon: DRIVE -> TURN",
        "3.0 polygon: TURN -> STOP",
    ]
    assert run(terminal, "spin_once --sides many")[-2:] == [
        "spin_once: error: argument -n/--sides: invalid int value: 'many'",
        "[ros2run]: Process exited with failure 2",
    ]
    assert terminal.exit_codes() == [None, 0, 2]


def test_a_state_machine_is_stopped(terminal: Terminal) -> None:
    run(terminal, "spin_once", seconds=1.5)
    assert terminal.interrupt() == ["stopped by the user", "[ros2run]: Process exited with failure 3"]


def test_a_library_of_ones_own_and_a_resource_file(terminal: Terminal) -> None:
    assert run(terminal, "go_to_goal", seconds=10) == [
        "3.4 go_to_goal: at corner (7.0, 7.0)",
        "7.9 go_to_goal: at goal (4.0, 6.5)",
    ]
    assert terminal.exit_codes() == [None, 0]


def test_a_project_is_launched_with_its_parameters(terminal: Terminal) -> None:
    printed = terminal.say("ros2 launch student_turtles all.launch.py", seconds=3)
    assert having(printed, "patrol-2]") == [
        "[INFO] [patrol-2]: process started with pid [1003]",
        "[patrol-2] 0.3 patrol: a: 2.0 2.0",
        "[patrol-2] 0.8 patrol: b: 8.0 2.0",
        "[patrol-2] tolerance 0.3",
        "[INFO] [patrol-2]: process has finished cleanly [pid 1003]",
    ]


def test_a_project_is_launched_in_part(terminal: Terminal) -> None:
    printed = terminal.say("ros2 launch student_turtles all.launch.py patrol:=false", seconds=1)
    assert not having(printed, "patrol-2") and having(printed, "process started")


def test_a_behaviour_tree_shuts_itself_down(terminal: Terminal) -> None:
    """`spin` then returns: only a shutdown from outside is an exception."""
    assert run(terminal, "behaviour", seconds=4) == ["2.5 tree: done at x 8.1 theta 1.1"]
    assert terminal.exit_codes() == [None, 0]


def test_a_service_that_awaits_other_services(terminal: Terminal) -> None:
    run(terminal, "mission")
    printed = terminal.say("ros2 service call /go std_srvs/srv/Empty", "ros2 topic list", seconds=0.1)
    assert [line.partition(" ")[2] for line in having(printed, "mission:")] == [
        "mission: killed: turtlesim.srv.Kill_Response()",
        "mission: t0 has a pen: True",
        "mission: t1 has a pen: True",
    ]
    assert "/t1/pose" in printed and "/turtle1/pose" not in printed


def test_a_students_unit_test(terminal: Terminal) -> None:
    """Two nodes in one process, and no simulator: time passes while the test spins."""
    source = (PACKAGES / "student_turtles/test/test_nodes.py").read_text()
    room: dict[str, object] = {"__name__": "test_nodes"}
    exec(compile(source, "test_nodes.py", "exec"), room)
    import rclpy

    with rclpy.init():
        room["test_it_drives_until_the_right_edge"](None)  # type: ignore[operator]
