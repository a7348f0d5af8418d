from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description():
    names = {"background_r": "0", "background_g": "84", "background_b": "122"}
    return LaunchDescription(
        [
            *[DeclareLaunchArgument(name, default_value=value) for name, value in names.items()],
            Node(
                package="turtlesim",
                executable="turtlesim_node",
                name="sim",
                parameters=[{name: LaunchConfiguration(name) for name in names}],
            ),
        ]
    )
