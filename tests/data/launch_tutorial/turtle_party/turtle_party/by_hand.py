import sys

from launch import LaunchDescription, LaunchService
from launch.actions import ExecuteProcess, LogInfo, TimerAction


def main():
    service = LaunchService(argv=sys.argv[1:])
    service.include_launch_description(
        LaunchDescription(
            [
                LogInfo(msg="by hand"),
                ExecuteProcess(cmd=["sleep", "1.5"]),
                TimerAction(period=1.0, actions=[LogInfo(msg="a second later")]),
            ]
        )
    )
    print("it returned", service.run())
