"""What add_two_ints_async_launch.py is called in Humble."""

from launch import LaunchDescription
from launch.actions import IncludeLaunchDescription
from launch.substitutions import PathJoinSubstitution, ThisLaunchFileDir


def generate_launch_description() -> LaunchDescription:
    """What is launched."""
    file = PathJoinSubstitution([ThisLaunchFileDir(), "add_two_ints_async_launch.py"])
    return LaunchDescription([IncludeLaunchDescription(file)])
