"""The whole robot: what plans its way, and what drives it."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description():
    return LaunchDescription(
        [
            DeclareLaunchArgument("gain", default_value="4.0", description="How hard the driver turns, 1/s"),
            Node(package="patrol", executable="planner"),
            Node(package="patrol", executable="driver", parameters=[{"gain": LaunchConfiguration("gain")}]),
        ]
    )
