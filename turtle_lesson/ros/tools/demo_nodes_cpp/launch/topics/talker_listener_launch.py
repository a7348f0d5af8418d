"""A talker and a listener.

Source of facts: launch/topics/talker_listener_launch.py of demo_nodes_cpp (ros2/demos).
"""

from launch import LaunchDescription
from launch_ros.actions import Node


def generate_launch_description() -> LaunchDescription:
    """What is launched."""
    programs = ("talker", "listener")
    return LaunchDescription([Node(package="demo_nodes_cpp", executable=each, output="screen") for each in programs])
