"""`ros2 service`, against recordings of the real one."""

from __future__ import annotations

import command_system as system
import pytest
import rclpy
from command_cases import check, type_in
from command_interfaces import interfaces  # noqa: F401

from turtle_lesson.ros.runtime.world import World

pytestmark = pytest.mark.usefixtures("interfaces")


@pytest.fixture
def lesson(world: World) -> World:
    """A world in which the lesson's three nodes run."""
    system.start(world, *system.LESSON)
    return world


def test_what_the_real_one_prints(lesson: World) -> None:
    check(lesson, "service.txt")


def test_a_call_takes_as_long_as_the_service_needs(lesson: World) -> None:
    answer = type_in(lesson, "ros2 service call /navigate_to robot_controller/srv/NavigateTo '{x: 9.0}'")
    assert answer.seconds == pytest.approx(9.1, abs=0.01)
    assert answer.code == 0


def test_values_without_quotes_are_explained(lesson: World) -> None:
    answer = type_in(lesson, "ros2 service call /navigate_to robot_controller/srv/NavigateTo x: 9.0")
    *_, error, hint = answer.stderr.splitlines()
    assert (error, answer.code) == ("ros2: error: unrecognized arguments: 9.0", 2)
    assert hint == 'Put the values in quotes, so that they form one word: "{x: 5.0, y: 5.0}"'


def test_a_call_again_and_again_ends_after_a_stretch(lesson: World) -> None:
    command = "ros2 service call /navigate_to robot_controller/srv/NavigateTo '{y: 1.0}' -r 2 --for 3"
    answer = type_in(lesson, command)
    assert answer.stdout.count("response:\n") == 5  # the first one takes a second
    assert (answer.stderr.count("stopped after 3 s"), answer.code) == (1, 2)
    assert answer.seconds == pytest.approx(3.1)


def test_info_counts_both_sides(lesson: World) -> None:
    answer = type_in(lesson, "ros2 service info /navigate_to")
    assert answer.stdout == "Type: robot_controller/srv/NavigateTo\nClients count: 0\nServices count: 1\n"
    answer = type_in(lesson, "ros2 service info /navigate_too")
    assert (answer.stderr, answer.code) == ("Unknown service '/navigate_too'\nDid you mean '/navigate_to'?\n", 1)


def test_names_and_types_that_are_nearly_right_are_found(lesson: World) -> None:
    answer = type_in(lesson, "ros2 service type navigate_to")
    assert answer.stderr == "Unknown service 'navigate_to'\nDid you mean '/navigate_to'?\n"
    answer = type_in(lesson, "ros2 service call /navigate robot_controller/srv/NavigateTo")
    assert answer.stderr.endswith("no node offers /navigate\nDid you mean '/navigate_to'?\n")
    answer = type_in(lesson, "ros2 service call /navigate_to std_msgs/msg/String")
    assert answer.stderr.startswith("The passed type is not a service\n")
    answer = type_in(lesson, "ros2 service call /navigate_to NavigateTo")
    assert answer.stderr == "The passed service type is invalid\nDid you mean 'robot_controller/srv/NavigateTo'?\n"


def test_a_service_whose_node_dies_over_it_is_not_waited_for(world: World) -> None:
    def clumsy() -> None:
        from std_srvs.srv import Empty

        rclpy.init(args=[])
        node = rclpy.create_node("clumsy")
        node.create_service(Empty, "drop", lambda request, response: 1 / 0)
        rclpy.spin(node)

    system.start(world, clumsy)
    answer = type_in(world, "ros2 service call /drop std_srvs/srv/Empty")
    assert answer.code == 1
    assert answer.stdout == "requester: making request: std_srvs.srv.Empty_Request()\n\n"
    assert answer.stderr.startswith("/drop went away before it answered") and answer.seconds < 2


def test_a_service_that_never_answers_is_given_up(world: World) -> None:
    def lazy() -> None:
        import time

        from std_srvs.srv import Empty

        rclpy.init(args=[])
        node = rclpy.create_node("lazy")
        node.create_service(Empty, "wait", lambda request, response: time.sleep(1e6))
        rclpy.spin(node)

    system.start(world, lazy)
    answer = type_in(world, "ros2 service call /wait std_srvs/srv/Empty --for 20")
    assert answer.code == 1 and answer.stderr.startswith("No answer from /wait in 20 s of robot time")
    assert answer.seconds == pytest.approx(20.1)
    assert type_in(world, "ros2 service call /wait std_srvs/srv/Empty").seconds == pytest.approx(600.1)


def test_a_message_is_yaml_in_many_ways(lesson: World) -> None:
    asked = {}
    for values in ("'{x: 0, y: \"1\"}'", "'x: 1e1'", "''", "'{x: .nan}'"):
        answer = type_in(lesson, f"ros2 service call /navigate_to robot_controller/srv/NavigateTo {values} --for 60")
        asked[values] = answer.stdout.partition("\n")[0].partition("_Request")[2] or answer.stderr
    assert asked["'{x: 0, y: \"1\"}'"] == "(x=0.0, y=1.0, theta=0.0)"
    assert asked["'x: 1e1'"] == "(x=10.0, y=0.0, theta=0.0)"
    assert asked["''"] == ("Failed to populate field: Value 'None' is expected to be a dictionary but is a NoneType\n")
