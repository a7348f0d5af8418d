"""Actions: what a launch description can do."""

from __future__ import annotations

from .._package import explain_missing
from ._configuration import (
    AppendEnvironmentVariable,
    DeclareLaunchArgument,
    PopEnvironment,
    PopLaunchConfigurations,
    PushEnvironment,
    PushLaunchConfigurations,
    ResetEnvironment,
    ResetLaunchConfigurations,
    SetEnvironmentVariable,
    SetLaunchConfiguration,
    UnsetEnvironmentVariable,
    UnsetLaunchConfiguration,
)
from ._events import EmitEvent, Log, LogDebug, LogError, LogInfo, LogWarning, RegisterEventHandler, Shutdown
from ._groups import GroupAction, IncludeLaunchDescription, OpaqueFunction, TimerAction
from ._processes import ExecuteLocal, ExecuteProcess

__all__ = [
    "AppendEnvironmentVariable",
    "DeclareLaunchArgument",
    "EmitEvent",
    "ExecuteLocal",
    "ExecuteProcess",
    "GroupAction",
    "IncludeLaunchDescription",
    "Log",
    "LogDebug",
    "LogError",
    "LogInfo",
    "LogWarning",
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
    "UnsetEnvironmentVariable",
    "UnsetLaunchConfiguration",
]


__getattr__ = explain_missing(
    __name__,
    {
        "ForEach": "write the loop in Python: [Node(…) for name in names]",
        "ForLoop": "write the loop in Python: [Node(…) for name in names]",
        "OpaqueCoroutine": "OpaqueFunction calls a function, TimerAction waits",
        "UnregisterEventHandler": "a handler with handle_once=True reacts only once",
        "Node": "it is in launch_ros: from launch_ros.actions import Node",
    },
)
