"""`launch_ros`: starting ROS nodes from a launch description (facts: launch_ros of ROS 2 Humble)."""

from __future__ import annotations

from launch._package import complete_package

from . import actions, descriptions, parameter_descriptions, substitutions

__all__ = ["actions", "descriptions", "event_handlers", "events", "parameter_descriptions", "substitutions"]

complete_package(
    "launch_ros",
    modules={
        "launch_ros.event_handlers": "OnStateTransition",
        "launch_ros.event_handlers.on_state_transition": "OnStateTransition",
        "launch_ros.events": "matches_node_name",
        "launch_ros.events.lifecycle": "ChangeState StateTransition",
        "launch_ros.events.matchers": "matches_node_name",
        "launch_ros.substitutions.find_package": "FindPackage FindPackagePrefix FindPackageShare",
    },
    missing={
        "launch_ros.actions": {
            "LifecycleTransition": "emit launch_ros.events.lifecycle.ChangeState",
            "SetROSLogDir": "there are no log files",
        },
        "launch_ros.descriptions": {"RosExecutable": "use Node", "Node": "use launch_ros.actions.Node"},
        "launch_ros.substitutions": {
            "FindPackageShareDirectory": "use FindPackageShare",
            "Parameter": "give SetParameter a LaunchConfiguration, and use that",
        },
    },
)
