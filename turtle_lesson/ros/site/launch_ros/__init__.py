"""`launch_ros`: starting ROS nodes from a launch description (facts: launch_ros of ROS 2 Humble)."""

from __future__ import annotations

from launch._package import explain_missing, provide_modules

from . import actions, descriptions, parameter_descriptions, substitutions

__all__ = [
    "actions",
    "descriptions",
    "event_handlers",
    "events",
    "parameter_descriptions",
    "substitutions",
]

provide_modules(
    {
        "launch_ros.actions._nodes": {
            "launch_ros.actions.composable": "ComposableNodeContainer LoadComposableNodes",
            "launch_ros.actions.node": "Node",
        },
        "launch_ros._lifecycle": {
            "launch_ros.actions.lifecycle_node": "LifecycleNode",
            "launch_ros.event_handlers": "OnStateTransition",
            "launch_ros.event_handlers.on_state_transition": "OnStateTransition",
            "launch_ros.events": "matches_node_name",
            "launch_ros.events.lifecycle": "ChangeState StateTransition",
            "launch_ros.events.matchers": "matches_node_name",
        },
        "launch_ros.actions._settings": {
            "launch_ros.actions.push_ros_namespace": "PushROSNamespace PushRosNamespace",
            "launch_ros.actions.ros_timer": "ROSTimer RosTimer",
            "launch_ros.actions.set_parameter": "SetParameter SetParametersFromFile SetRemap SetUseSimTime",
            "launch_ros.actions.set_remap": "SetRemap",
        },
        "launch_ros.substitutions": {
            "launch_ros.substitutions.executable_in_package": "ExecutableInPackage",
            "launch_ros.substitutions.find_package": "FindPackage FindPackagePrefix FindPackageShare",
        },
    }
)

__getattr__ = explain_missing(
    __name__,
    {"parameters_type": "it has type hints only", "remap_rule_type": "it has type hints only", "utilities": ""},
)
