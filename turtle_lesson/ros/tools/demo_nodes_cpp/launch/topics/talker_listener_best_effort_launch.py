"""A talker, and a listener that does not ask for lost messages again.

Source of facts: launch/topics/talker_listener_best_effort_launch.py of demo_nodes_cpp (ros2/demos).
"""

from launch import LaunchDescription
from launch_ros.actions import Node


def generate_launch_description() -> LaunchDescription:
    """What is launched."""
    programs = ("talker", "listener_best_effort")
    return LaunchDescription([Node(package="demo_nodes_cpp", executable=each, output="screen") for each in programs])
