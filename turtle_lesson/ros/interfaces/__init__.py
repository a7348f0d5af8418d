"""ROS 2 interfaces: from the text of `.msg`, `.srv` and `.action` files to Python classes and CDR bytes.

>>> from turtle_lesson.ros.interfaces import finder, registry
>>> finder.install()
>>> from geometry_msgs.msg import Twist
"""

from turtle_lesson.ros.interfaces import finder
from turtle_lesson.ros.interfaces.definition import parse_action, parse_message, parse_service
from turtle_lesson.ros.interfaces.errors import InvalidDefinition
from turtle_lesson.ros.interfaces.registry import Registry, registry

__all__ = [
    "InvalidDefinition",
    "Registry",
    "finder",
    "parse_action",
    "parse_message",
    "parse_service",
    "registry",
]
