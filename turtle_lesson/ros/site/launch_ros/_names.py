"""Namespaces, put together and checked (facts: launch_ros's namespace_utils.py)."""

from __future__ import annotations

from launch import LaunchContext


def in_namespace(context: LaunchContext, namespace: str | None) -> str | None:
    """A node's full namespace: its own, within what was pushed; None if there is neither."""
    pushed = context.launch_configurations.get("ros_namespace")
    if namespace is None:
        return pushed
    if namespace.startswith("/") or pushed is None:
        return absolute(namespace)
    return absolute(f"{pushed.rstrip('/')}/{namespace}") if namespace else pushed


def absolute(namespace: str) -> str:
    """The same namespace beginning with a slash and not ending with one."""
    return "/" + namespace.strip("/")


def check_namespace(namespace: str) -> None:
    """Raise rclpy's InvalidNamespaceException unless it is a good one."""
    from rclpy.validate_namespace import validate_namespace

    validate_namespace(namespace)


def check_node_name(name: str) -> None:
    """Raise rclpy's InvalidNodeNameException unless it is a good one."""
    from rclpy.validate_node_name import validate_node_name

    validate_node_name(name)
