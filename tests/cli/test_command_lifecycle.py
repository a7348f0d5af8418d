"""`ros2 lifecycle`, with the formats of ros2lifecycle (ros2/ros2cli), which its own tests pin."""

from __future__ import annotations

import command_system as system
import pytest
import rclpy
from command_cases import type_in
from rclpy.lifecycle import LifecycleNode, TransitionCallbackReturn

from turtle_lesson.ros.cli.completion import complete
from turtle_lesson.ros.runtime.world import World


def simple() -> None:
    """A managed node."""
    rclpy.init(args=[])
    rclpy.spin(LifecycleNode("simple"))


def hidden() -> None:
    """A managed node with a hidden name."""
    rclpy.init(args=[])
    rclpy.spin(LifecycleNode("_hidden"))


def stubborn() -> None:
    """A managed node that cannot be configured."""

    class Stubborn(LifecycleNode):
        def on_configure(self, state: object) -> TransitionCallbackReturn:
            return TransitionCallbackReturn.FAILURE

    rclpy.init(args=[])
    rclpy.spin(Stubborn("stubborn", namespace="/robots"))


def plain() -> None:
    """A node that is not managed."""
    rclpy.init(args=[])
    rclpy.spin(rclpy.create_node("plain"))


@pytest.fixture
def running(world: World) -> World:
    """A world with all of them."""
    system.start(world, simple, hidden, stubborn, plain)
    return world


CASES = [
    ("nodes", "/robots/stubborn\n/simple\n", "", 0),
    ("nodes -a", "/_hidden\n/robots/stubborn\n/simple\n", "", 0),
    ("nodes -c", "2\n", "", 0),
    ("nodes --all --count-nodes", "3\n", "", 0),
    ("get /simple", "unconfigured [1]\n", "", 0),
    ("get simple", "unconfigured [1]\n", "", 0),
    ("get", "/robots/stubborn: unconfigured [1]\n/simple: unconfigured [1]\n", "", 0),
    ("get --include-hidden-nodes /_hidden", "unconfigured [1]\n", "", 0),
    ("get /_hidden", "", "Node not found\n", 1),
    ("get /nope", "", "Node not found\n", 1),
    ("get /smple", "", "Node not found\nDid you mean '/simple'?\n", 1),
    ("get /plain", "", "Node not found\n/plain is not a managed node.\n", 1),
    (
        "list simple",
        "- configure [1]\n\tStart: unconfigured\n\tGoal: configuring\n"
        "- shutdown [5]\n\tStart: unconfigured\n\tGoal: shuttingdown\n",
        "",
        0,
    ),
    ("list _hidden -a", "", "Node not found\n", 1),
    (
        "set /simple noop",
        "",
        "Unknown transition requested, available ones are:\n- configure [1]\n- shutdown [5]\n",
        1,
    ),
    ("set /nope configure", "", "Node not found\n", 1),
    ("set /robots/stubborn configure", "", "Transitioning failed\n", 0),
]


@pytest.mark.parametrize(("command", "stdout", "stderr", "code"), CASES)
def test_what_the_commands_answer(running: World, command: str, stdout: str, stderr: str, code: int) -> None:
    answer = type_in(running, f"ros2 lifecycle {command}")
    assert (answer.stdout, answer.stderr, answer.code) == (stdout, stderr, code)


def test_all_transitions_are_listed_in_rcls_order(running: World) -> None:
    lines = type_in(running, "ros2 lifecycle list /_hidden --include-hidden-nodes --all").stdout.splitlines()
    numbers = [1, 10, 11, 12, 2, 20, 21, 22, 3, 30, 31, 32, 4, 40, 41, 42, 5, 6, 7, 50, 51, 52, 60, 61, 62]
    assert [int(line.partition("[")[2].rstrip("]")) for line in lines[::3]] == numbers
    assert lines[3:6] == ["- transition_success [10]", "\tStart: configuring", "\tGoal: inactive"]
    assert lines[-3:] == ["- transition_error [62]", "\tStart: errorprocessing", "\tGoal: finalized"]


def test_a_node_is_moved_through_its_states_by_labels_and_by_numbers(running: World) -> None:
    for transition, state in (
        ("configure", "inactive [2]"),
        ("3", "active [3]"),
        ("deactivate", "inactive [2]"),
        ("cleanup", "unconfigured [1]"),
        ("shutdown", "finalized [4]"),
    ):
        answer = type_in(running, f"ros2 lifecycle set /simple {transition}")
        assert (answer.stdout, answer.stderr, answer.code) == ("Transitioning successful\n", "", 0)
        assert type_in(running, "ros2 lifecycle get /simple").stdout == f"{state}\n"


def test_a_node_that_is_not_managed_offers_no_transitions(running: World) -> None:
    answer = type_in(running, "ros2 lifecycle set /plain configure")
    assert answer.code == 1
    assert answer.stderr == "Node not found\n/plain is not a managed node.\n"


def test_a_node_that_is_busy_is_not_waited_for_for_ever(world: World) -> None:
    def busy() -> None:
        import time

        rclpy.init(args=[])
        LifecycleNode("busy")
        time.sleep(1000.0)

    system.start(world, busy)
    answer = type_in(world, "ros2 lifecycle get /busy")
    assert answer.code == 1 and answer.seconds < 6.0
    assert answer.stderr.startswith("No answer from /busy in 5 s of robot time")
    answer = type_in(world, "ros2 lifecycle get")
    assert answer.code == 0
    assert answer.stderr.startswith("Exception while calling service of node '/busy': No answer")


def test_tab_offers_verbs_nodes_and_transitions(running: World) -> None:
    assert complete(running, "ros2 lifecycle s") == ["set"]
    assert complete(running, "ros2 lifecycle get /si") == ["/simple"]
    assert complete(running, "ros2 lifecycle set /simple s") == ["shutdown"]
