from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, ExecuteProcess, TimerAction
from launch.conditions import IfCondition
from launch.substitutions import FindExecutable, LaunchConfiguration, PythonExpression
from launch_ros.actions import Node


def generate_launch_description():
    ns = LaunchConfiguration("turtlesim_ns")
    use_given = LaunchConfiguration("use_given_red")
    red = LaunchConfiguration("red")
    ros2 = FindExecutable(name="ros2")
    return LaunchDescription(
        [
            DeclareLaunchArgument("turtlesim_ns", default_value="party"),
            DeclareLaunchArgument("use_given_red", default_value="False"),
            DeclareLaunchArgument("red", default_value="200"),
            Node(package="turtlesim", namespace=ns, executable="turtlesim_node", name="sim"),
            ExecuteProcess(
                cmd=[[ros2, " service call ", ns, "/spawn ", "turtlesim/srv/Spawn ", '"{x: 2, y: 2, theta: 0.2}"']],
                shell=True,
            ),
            ExecuteProcess(cmd=[[ros2, " param set ", ns, "/sim background_r ", "120"]], shell=True),
            TimerAction(
                period=2.0,
                actions=[
                    ExecuteProcess(
                        condition=IfCondition(PythonExpression([red, " == 200", " and ", use_given])),
                        cmd=[[ros2, " param set ", ns, "/sim background_r ", red]],
                        shell=True,
                    )
                ],
            ),
        ]
    )
