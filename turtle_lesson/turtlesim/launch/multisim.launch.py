"""Two simulators at once, each in a namespace of its own: /turtlesim1 and /turtlesim2.

Source of facts: turtlesim's multisim.launch.py (Humble).
"""

from launch import LaunchDescription
from launch_ros.actions import Node


def generate_launch_description() -> LaunchDescription:
    """What is launched."""
    return LaunchDescription(
        [
            Node(package="turtlesim", executable="turtlesim_node", namespace=namespace, output="screen")
            for namespace in ("turtlesim1", "turtlesim2")
        ]
    )
