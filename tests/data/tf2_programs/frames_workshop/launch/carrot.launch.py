"""turtle2 follows a carrot that turtle1 carries; `moving` chooses one that circles."""

import os

from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription
from launch.conditions import IfCondition, UnlessCondition
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description():
    follow = os.path.join(get_package_share_directory("frames_workshop"), "launch", "follow.launch.py")
    moving = LaunchConfiguration("moving")
    return LaunchDescription(
        [
            DeclareLaunchArgument("moving", default_value="false"),
            IncludeLaunchDescription(
                PythonLaunchDescriptionSource(follow), launch_arguments={"target_frame": "carrot1"}.items()
            ),
            Node(package="frames_workshop", executable="carrot_fixed", condition=UnlessCondition(moving)),
            Node(package="frames_workshop", executable="carrot_moving", condition=IfCondition(moving)),
            Node(
                package="tf2_ros",
                executable="static_transform_publisher",
                name="map_of_the_world",
                arguments=["--x", "0", "--frame-id", "map", "--child-frame-id", "world"],
            ),
        ]
    )
