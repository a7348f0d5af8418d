"""`launch_ros`: starting ROS nodes from a launch description (facts: launch_ros of ROS 2 Humble)."""

from launch._missing import explain_missing

from . import (
    actions,
    descriptions,
    event_handlers,
    events,
    parameter_descriptions,
    parameters_type,
    remap_rule_type,
    substitutions,
)

__all__ = [
    "actions",
    "descriptions",
    "event_handlers",
    "events",
    "parameter_descriptions",
    "parameters_type",
    "remap_rule_type",
    "substitutions",
]

__getattr__ = explain_missing(__name__, {"utilities": ""})
