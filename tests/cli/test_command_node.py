"""`ros2 node`, against recordings of the real one."""

from __future__ import annotations

from collections.abc import Iterator

import command_system as system
import pytest
import rclpy
from command_cases import check, type_in
from command_interfaces import interfaces  # noqa: F401

from turtle_lesson.ros.runtime.world import World

pytestmark = pytest.mark.usefixtures("interfaces")


@pytest.fixture
def lesson(world: World) -> Iterator[World]:
    """A world in which the lesson's three nodes run."""
    system.start(world, *system.LESSON)
    yield world


def test_what_the_real_one_prints(lesson: World) -> None:
    check(lesson, "node.txt")


def test_two_nodes_of_one_name_are_listed_twice_and_warned_of(world: World) -> None:
    def robot1_obstacle_detector() -> None:
        from sensor_msgs.msg import LaserScan

        rclpy.init(args=[])
        node = rclpy.create_node("obstacle_detector", namespace="/robot1")
        node.create_publisher(LaserScan, "/obstacles", 10)
        rclpy.spin(node)

    system.start(world, robot1_obstacle_detector, system.status_monitor, system.status_monitor)
    check(world, "node_twins.txt")


def test_in_an_empty_world_there_is_nothing_to_list(world: World) -> None:
    answer = type_in(world, "ros2 node list")
    assert (answer.stdout, answer.stderr, answer.code) == ("", "", 0)
    assert type_in(world, "ros2 node list -c").stdout == "0\n"


def test_a_command_leaves_no_node_behind_and_takes_a_tenth_of_a_second(lesson: World) -> None:
    before = [entry.full_name for entry in lesson.graph.nodes]
    assert type_in(lesson, "ros2 node list").seconds == pytest.approx(0.1)
    assert type_in(lesson, "ros2 node list --spin-time 2").seconds == pytest.approx(2.0)
    assert [entry.full_name for entry in lesson.graph.nodes] == before


def test_hidden_topics_of_a_node_are_shown_when_asked_for(world: World) -> None:
    def shy() -> None:
        from std_msgs.msg import Empty

        rclpy.init(args=[])
        node = rclpy.create_node("shy")
        node.create_publisher(Empty, "_secret", 10)
        rclpy.spin(node)

    system.start(world, shy)
    assert "/_secret" not in type_in(world, "ros2 node info /shy").stdout
    assert "    /_secret: std_msgs/msg/Empty\n" in type_in(world, "ros2 node info /shy --include-hidden").stdout


def test_an_action_shows_as_one_instead_of_what_it_consists_of(world: World) -> None:
    def turner() -> None:
        from rclpy.action import ActionServer
        from turtlesim.action import RotateAbsolute

        rclpy.init(args=[])
        node = rclpy.create_node("turner")
        ActionServer(node, RotateAbsolute, "rotate", lambda goal_handle: RotateAbsolute.Result())
        rclpy.spin(node)

    system.start(world, turner)
    text = type_in(world, "ros2 node info /turner").stdout
    assert "  Action Servers:\n    /rotate: turtlesim/action/RotateAbsolute\n  Action Clients:\n\n" in text
    assert "_action" not in text.partition("Action Servers")[0]
