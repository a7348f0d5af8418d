"""`launch_xml`: launch files in XML (facts: launch_xml of ROS 2 Humble)."""

from .entity import Entity
from .parser import Parser

__all__ = ["Entity", "Parser"]
