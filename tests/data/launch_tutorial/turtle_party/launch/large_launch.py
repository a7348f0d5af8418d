import os

from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.actions import GroupAction, IncludeLaunchDescription
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import PathJoinSubstitution
from launch_ros.actions import Node, PushRosNamespace
from launch_ros.substitutions import FindPackageShare
from launch_xml.launch_description_sources import XMLLaunchDescriptionSource


def generate_launch_description():
    launch_dir = PathJoinSubstitution([FindPackageShare("turtle_party"), "launch"])
    first = IncludeLaunchDescription(
        PythonLaunchDescriptionSource(
            [os.path.join(get_package_share_directory("turtle_party"), "launch"), "/world_1_launch.py"]
        ),
        launch_arguments={"background_r": "7"}.items(),
    )
    return LaunchDescription(
        [
            GroupAction([PushRosNamespace("world1"), first]),
            IncludeLaunchDescription(XMLLaunchDescriptionSource([launch_dir, "/world_2_launch.xml"])),
            IncludeLaunchDescription(PathJoinSubstitution([launch_dir, "world_3_launch.yaml"])),
            Node(
                package="turtlesim",
                executable="mimic",
                name="mimic",
                namespace="mimics",
                remappings=[("/input/pose", "/world2/turtle1/pose"), ("/output/cmd_vel", "/world3/turtle1/cmd_vel")],
            ),
        ]
    )
