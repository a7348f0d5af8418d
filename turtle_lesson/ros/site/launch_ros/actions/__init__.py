"""Actions that start ROS nodes and decide how."""

# ruff: noqa: F403  (each module says in its __all__ what it exports)

from . import _lifecycle, _nodes
from ._lifecycle import *
from ._nodes import *

__all__ = [*_lifecycle.__all__, *_nodes.__all__]
