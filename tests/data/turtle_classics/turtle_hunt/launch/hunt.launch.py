from pathlib import Path

from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch_ros.actions import Node


def generate_launch_description():
    settings = str(Path(get_package_share_directory("turtle_hunt")) / "config" / "hunt.yaml")
    description = LaunchDescription()
    description.add_action(Node(package="turtlesim", executable="turtlesim_node"))
    for program in ("spawner", "hunter"):
        description.add_action(Node(package="turtle_hunt", executable=program, parameters=[settings], output="screen"))
    return description
