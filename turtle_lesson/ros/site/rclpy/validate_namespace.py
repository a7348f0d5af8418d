"""`validate_namespace`: rclpy's check of a namespace."""

from turtle_lesson.ros.rmw.names import namespace_flaw

from .exceptions import InvalidNamespaceException


def validate_namespace(namespace: str) -> bool:
    """True for a good namespace; raises InvalidNamespaceException with a caret under the bad character."""
    if (flaw := namespace_flaw(namespace)) is not None:
        raise InvalidNamespaceException(namespace, *flaw)
    return True
