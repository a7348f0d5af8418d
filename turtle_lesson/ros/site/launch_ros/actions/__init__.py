"""Actions that start ROS nodes and decide how."""

from launch._missing import explain_missing

from .composable import ComposableNodeContainer, LoadComposableNodes
from .lifecycle_node import LifecycleNode
from .node import Node
from .push_ros_namespace import PushROSNamespace, PushRosNamespace
from .ros_timer import ROSTimer, RosTimer
from .set_parameter import SetParameter, SetParametersFromFile, SetRemap, SetUseSimTime

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
