"""Actions that start ROS nodes and decide how."""

from __future__ import annotations

from launch._package import explain_missing

from .._lifecycle import LifecycleNode
from ._nodes import ComposableNodeContainer, LoadComposableNodes, Node
from ._settings import (
    PushROSNamespace,
    PushRosNamespace,
    ROSTimer,
    RosTimer,
    SetParameter,
    SetParametersFromFile,
    SetRemap,
    SetUseSimTime,
)

__all__ = [
    "ComposableNodeContainer",
    "LifecycleNode",
    "LoadComposableNodes",
    "Node",
    "PushROSNamespace",
    "PushRosNamespace",
    "ROSTimer",
    "RosTimer",
    "SetParameter",
    "SetParametersFromFile",
    "SetRemap",
    "SetUseSimTime",
]


__getattr__ = explain_missing(
    __name__,
    {
        "LifecycleTransition": "emit launch_ros.events.lifecycle.ChangeState",
        "SetROSLogDir": "there are no log files",
    },
)
