"""turtle2 follows a frame: turtle1, unless `target_frame` says otherwise."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description():
    return LaunchDescription(
        [
            DeclareLaunchArgument("target_frame", default_value="turtle1", description="what turtle2 follows"),
            Node(package="turtlesim", executable="turtlesim_node", name="sim"),
            *(
                Node(
                    package="frames_workshop",
                    executable="turtle_broadcaster",
                    name=f"broadcaster_{turtle}",
                    parameters=[{"turtlename": turtle}],
                )
                for turtle in ("turtle1", "turtle2")
            ),
            Node(
                package="frames_workshop",
                executable="follower",
                output="screen",
                parameters=[{"target_frame": LaunchConfiguration("target_frame")}],
            ),
        ]
    )
