"""`launch_ros`: starting ROS nodes from a launch description (facts: launch_ros of ROS 2 Humble)."""

from __future__ import annotations

from launch._package import complete_package

from . import actions, descriptions, parameter_descriptions, substitutions

__all__ = ["actions", "descriptions", "event_handlers", "events", "parameter_descriptions", "substitutions"]

complete_package("launch_ros")
