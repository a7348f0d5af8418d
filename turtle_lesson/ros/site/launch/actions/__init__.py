"""Actions: what a launch description can do."""

from .._missing import explain_missing
from .declare_launch_argument import DeclareLaunchArgument
from .emit_event import EmitEvent
from .environment import (
    AppendEnvironmentVariable,
    PopEnvironment,
    PushEnvironment,
    ResetEnvironment,
    SetEnvironmentVariable,
    UnsetEnvironmentVariable,
)
from .execute_local import ExecuteLocal
from .execute_process import ExecuteProcess
from .group_action import GroupAction
from .include_launch_description import IncludeLaunchDescription
from .launch_configurations import (
    PopLaunchConfigurations,
    PushLaunchConfigurations,
    ResetLaunchConfigurations,
    SetLaunchConfiguration,
    UnsetLaunchConfiguration,
)
from .log_info import LogInfo
from .opaque_function import OpaqueFunction
from .register_event_handler import RegisterEventHandler, UnregisterEventHandler
from .shutdown_action import Shutdown
from .timer_action import TimerAction

__all__ = [
    "AppendEnvironmentVariable",
    "DeclareLaunchArgument",
    "EmitEvent",
    "ExecuteLocal",
    "ExecuteProcess",
    "GroupAction",
    "IncludeLaunchDescription",
    "LogInfo",
    "OpaqueFunction",
    "PopEnvironment",
    "PopLaunchConfigurations",
    "PushEnvironment",
    "PushLaunchConfigurations",
    "RegisterEventHandler",
    "ResetEnvironment",
    "ResetLaunchConfigurations",
    "SetEnvironmentVariable",
    "SetLaunchConfiguration",
    "Shutdown",
    "TimerAction",
    "UnregisterEventHandler",
    "UnsetEnvironmentVariable",
    "UnsetLaunchConfiguration",
]

__getattr__ = explain_missing(
    __name__,
    {
        "ForEach": "write a Python loop that makes the list of actions",
        "ForLoop": "write a Python loop that makes the list of actions",
        "Log": "use LogInfo",
        "LogDebug": "use LogInfo",
        "LogError": "use LogInfo",
        "LogWarning": "use LogInfo",
        "OpaqueCoroutine": "use OpaqueFunction, or a TimerAction",
        "SetROSLogDir": "there are no log files here",
        "Node": "it is in launch_ros: from launch_ros.actions import Node",
    },
)
