"""`validate_node_name`: rclpy's check of a node's name."""

from turtle_lesson.ros.rmw.names import node_name_flaw

from .exceptions import InvalidNodeNameException


def validate_node_name(node_name: str) -> bool:
    """True for a good name; raises InvalidNodeNameException with a caret under the bad character."""
    if (flaw := node_name_flaw(node_name)) is not None:
        raise InvalidNodeNameException(node_name, *flaw)
    return True
