from launch import LaunchDescription
from launch.actions import (
    DeclareLaunchArgument,
    EmitEvent,
    ExecuteProcess,
    LogInfo,
    RegisterEventHandler,
    TimerAction,
)
from launch.event_handlers import OnExecutionComplete, OnProcessExit, OnProcessIO, OnProcessStart, OnShutdown
from launch.events import Shutdown
from launch.substitutions import EnvironmentVariable, FindExecutable, LaunchConfiguration, LocalSubstitution
from launch_ros.actions import Node


def generate_launch_description():
    ns = LaunchConfiguration("turtlesim_ns")
    ros2 = FindExecutable(name="ros2")
    sim = Node(package="turtlesim", namespace=ns, executable="turtlesim_node", name="sim")
    spawn = ExecuteProcess(
        cmd=[[ros2, " service call ", ns, "/spawn ", "turtlesim/srv/Spawn ", '"{x: 2, y: 2, theta: 0.2}"']], shell=True
    )
    paint = ExecuteProcess(cmd=[[ros2, " param set ", ns, "/sim background_r 120"]], shell=True)
    repaint = ExecuteProcess(cmd=[[ros2, " param set ", ns, "/sim background_r 200"]], shell=True)
    return LaunchDescription(
        [
            DeclareLaunchArgument("turtlesim_ns", default_value="party"),
            sim,
            RegisterEventHandler(
                OnProcessStart(target_action=sim, on_start=[LogInfo(msg="started, spawning a turtle"), spawn])
            ),
            RegisterEventHandler(
                OnProcessIO(
                    target_action=spawn,
                    on_stdout=lambda event: LogInfo(msg=f'the answer is "{event.text.decode().strip()}"'),
                )
            ),
            RegisterEventHandler(
                OnExecutionComplete(
                    target_action=spawn,
                    on_completion=[LogInfo(msg="spawned"), paint, TimerAction(period=2.0, actions=[repaint])],
                )
            ),
            RegisterEventHandler(
                OnProcessExit(
                    target_action=sim,
                    on_exit=[
                        LogInfo(
                            msg=(EnvironmentVariable(name="LAUNCH_TEST_USER", default_value="somebody"), " closed it")
                        ),
                        EmitEvent(event=Shutdown(reason="window closed")),
                    ],
                )
            ),
            RegisterEventHandler(
                OnShutdown(on_shutdown=[LogInfo(msg=["asked to shut down: ", LocalSubstitution("event.reason")])])
            ),
        ]
    )
