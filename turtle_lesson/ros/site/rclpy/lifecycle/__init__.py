"""Managed nodes: they are configured, activated, deactivated and cleaned up from outside (rclpy.lifecycle).

Facts: rclpy's lifecycle package, rcl_lifecycle's default_state_machine.c, https://design.ros2.org/articles/node_lifecycle.html.
"""

# ruff: noqa: F401

from .managed_entity import ManagedEntity, SimpleManagedEntity, TransitionCallbackReturn
from .node import LifecycleNode, LifecycleNodeMixin, LifecycleState
from .publisher import LifecyclePublisher

Node = LifecycleNode
NodeMixin = LifecycleNodeMixin
State = LifecycleState
Publisher = LifecyclePublisher
