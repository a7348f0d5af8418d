"""What talker_listener_launch.py is called in Humble."""

from launch import LaunchDescription
from launch.actions import IncludeLaunchDescription
from launch.substitutions import PathJoinSubstitution, ThisLaunchFileDir


def generate_launch_description() -> LaunchDescription:
    """What is launched."""
    file = PathJoinSubstitution([ThisLaunchFileDir(), "talker_listener_launch.py"])
    return LaunchDescription([IncludeLaunchDescription(file)])
