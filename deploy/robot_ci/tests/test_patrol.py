"""The robot in many worlds: from any place, with its nodes in any order, on a bad network."""

import math
import random

import pytest
import rclpy
from patrol.driver import command
from std_msgs.msg import Int32
from turtlesim.srv import TeleportAbsolute


def corners_reached(lesson, seconds):
    """Start the robot somewhere, let it drive, and return how many corners it has reached."""
    rclpy.init()
    node = rclpy.create_node("observer")
    heard = [0]
    node.create_subscription(Int32, "/patrol/reached", lambda message: heard.append(message.data), 10)
    somewhere = TeleportAbsolute.Request(x=random.uniform(1, 10), y=random.uniform(1, 10), theta=random.uniform(-3, 3))
    node.create_client(TeleportAbsolute, "/turtle1/teleport_absolute").call(somewhere)
    lesson.launch("patrol", "patrol.launch.py")
    lesson.spin(seconds, node)
    return heard[-1]


@pytest.mark.worlds(seeds=20, package="src/patrol", start_order="shuffled")
def test_it_patrols_from_anywhere_whichever_node_is_up_first(lesson):
    assert corners_reached(lesson, 30) >= 4


@pytest.mark.worlds(seeds=10, package="src/patrol", loss=[0.1, 0.3])
def test_it_goes_on_when_messages_are_lost(lesson, loss):
    lesson.network("/turtle1/*", loss=loss, latency=0.02)
    assert corners_reached(lesson, 40) >= 4


@pytest.mark.parametrize("theta", [0.0, 3.0, -3.0])
def test_it_turns_the_short_way(theta):
    """A plain function needs no world."""
    _, turn = command(5.0, 5.0, theta, (5.0 + math.cos(theta + 0.5), 5.0 + math.sin(theta + 0.5)), gain=1.0)
    assert turn == pytest.approx(0.5)
