from launch import LaunchDescription
from launch_ros.actions import Node


def generate_launch_description():
    return LaunchDescription(
        [
            Node(package="turtlesim", namespace="left", executable="turtlesim_node", name="sim"),
            Node(package="turtlesim", namespace="right", executable="turtlesim_node", name="sim"),
            Node(
                package="turtlesim",
                executable="mimic",
                name="mimic",
                remappings=[("/input/pose", "/left/turtle1/pose"), ("/output/cmd_vel", "/right/turtle1/cmd_vel")],
            ),
        ]
    )
