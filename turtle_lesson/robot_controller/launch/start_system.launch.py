"""Start the whole controller: `ros2 launch robot_controller start_system.launch.py`.

Turtlesim is started apart from it, as a robot would be: `ros2 run turtlesim turtlesim_node`.
Any argument can be given behind the command, such as `source:=world` or `goal_timeout:=8.0`.
"""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue


def generate_launch_description() -> LaunchDescription:
    """Return the four arguments with their default values, and the three nodes that take them."""
    # As a float on purpose: `goal_timeout:=8` would be an integer otherwise, and the node would refuse it.
    goal_timeout = ParameterValue(LaunchConfiguration("goal_timeout"), value_type=float)
    return LaunchDescription(
        [
            DeclareLaunchArgument(
                "goal_timeout",
                default_value="5.0",
                description="Longest time that a goal may take, in seconds",
            ),
            DeclareLaunchArgument(
                "publish_rate", default_value="10", description="Status messages a second, an integer"
            ),
            DeclareLaunchArgument("scan_rate", default_value="5", description="Scans a second, an integer"),
            DeclareLaunchArgument(
                "source",
                default_value="mock",
                description="Where scans come from: mock (made up) or world (what is around the turtle)",
            ),
            Node(
                package="robot_controller",
                executable="navigator",
                name="navigator",
                output="screen",
                parameters=[{"goal_timeout": goal_timeout}],
            ),
            Node(
                package="robot_controller",
                executable="status_monitor",
                name="status_monitor",
                output="screen",
                parameters=[{"publish_rate": LaunchConfiguration("publish_rate")}],
            ),
            Node(
                package="robot_controller",
                executable="obstacle_detector",
                name="obstacle_detector",
                output="screen",
                parameters=[
                    {
                        "scan_rate": LaunchConfiguration("scan_rate"),
                        "source": LaunchConfiguration("source"),
                    }
                ],
            ),
        ]
    )
