"""A server that adds, and a client; the launch ends with the client.

Source of facts: launch/services/add_two_ints_launch.py of demo_nodes_cpp (ros2/demos).
"""

from launch import LaunchDescription
from launch.actions import RegisterEventHandler, Shutdown
from launch.event_handlers import OnProcessExit
from launch_ros.actions import Node


def generate_launch_description() -> LaunchDescription:
    """What is launched."""
    server = Node(package="demo_nodes_cpp", executable="add_two_ints_server", output="screen")
    client = Node(package="demo_nodes_cpp", executable="add_two_ints_client", output="screen")
    end = RegisterEventHandler(OnProcessExit(target_action=client, on_exit=[Shutdown(reason="the client has ended")]))
    return LaunchDescription([server, client, end])
