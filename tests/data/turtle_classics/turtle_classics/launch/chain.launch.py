"""turtle1 walks a square, and as many turtles as `length` says follow in a row."""

from itertools import pairwise

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, OpaqueFunction
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def followers(context):
    length = int(LaunchConfiguration("length").perform(context))
    turtles = [f"turtle{number}" for number in range(1, length + 2)]
    nodes = [Node(package="turtle_classics", executable="pose_to_tf", arguments=turtles)]
    for number, (leader, me) in enumerate(pairwise(turtles)):
        parameters = [{"me": me, "leader": leader, "start": [1.0 + number, 1.0]}]
        nodes.append(
            Node(package="turtle_classics", executable="chain_follower", name=f"{me}_follower", parameters=parameters)
        )
    return nodes


def generate_launch_description():
    return LaunchDescription(
        [
            DeclareLaunchArgument("length", default_value="2"),
            Node(package="turtlesim", executable="turtlesim_node"),
            Node(package="turtle_classics", executable="square_feedback", parameters=[{"side": 3.0}]),
            OpaqueFunction(function=followers),
        ]
    )
