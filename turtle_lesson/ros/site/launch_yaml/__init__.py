"""`launch_yaml`: launch files in YAML (facts: launch_yaml of ROS 2 Humble)."""

from .entity import Entity
from .parser import Parser

__all__ = ["Entity", "Parser"]
