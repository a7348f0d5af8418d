"""Starts all three, with parameters that none of them reads."""

from launch import LaunchDescription
from launch_ros.actions import Node

PARAMETERS = {
    "navigator": {"goal_timeout": 5.0},
    "status_monitor": {"publish_rate": 10},
    "obstacle_detector": {"scan_rate": 5},
}


def generate_launch_description():
    return LaunchDescription(
        [
            Node(
                package="robot_controller",
                executable=name,
                name=name,
                output="screen",
                parameters=[parameters],
            )
            for name, parameters in PARAMETERS.items()
        ]
    )
