"""Actions that start ROS nodes and decide how."""

from launch._missing import explain_missing

from .node import Node
from .push_ros_namespace import PushROSNamespace, PushRosNamespace
from .set_parameter import SetParameter, SetParametersFromFile, SetRemap, SetUseSimTime

__all__ = [
    "Node",
    "PushROSNamespace",
    "PushRosNamespace",
    "SetParameter",
    "SetParametersFromFile",
    "SetRemap",
    "SetUseSimTime",
]

_COMPOSABLE = "composable nodes are C++ libraries, and this classroom runs Python; use Node"

__getattr__ = explain_missing(
    __name__,
    {
        "ComposableNodeContainer": _COMPOSABLE,
        "LoadComposableNodes": _COMPOSABLE,
        "LifecycleNode": "",
        "LifecycleTransition": "",
        "RosTimer": "use launch.actions.TimerAction",
        "SetROSLogDir": "there are no log files here",
    },
)
