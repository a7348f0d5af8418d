"""Actions that start ROS nodes and decide how."""

from launch._missing import explain_missing

from .composable import ComposableNodeContainer, LoadComposableNodes
from .lifecycle_node import LifecycleNode, LifecycleTransition
from .node import Node
from .push_ros_namespace import PushROSNamespace, PushRosNamespace
from .ros_timer import ROSTimer, RosTimer
from .set_parameter import SetParameter, SetParametersFromFile, SetRemap, SetUseSimTime
from .set_ros_log_dir import SetROSLogDir

__all__ = [
    "ComposableNodeContainer",
    "LifecycleNode",
    "LifecycleTransition",
    "LoadComposableNodes",
    "Node",
    "PushROSNamespace",
    "PushRosNamespace",
    "ROSTimer",
    "RosTimer",
    "SetParameter",
    "SetParametersFromFile",
    "SetROSLogDir",
    "SetRemap",
    "SetUseSimTime",
]

__getattr__ = explain_missing(__name__, {})
