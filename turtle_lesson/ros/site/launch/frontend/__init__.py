"""Launch files that are not Python: from XML or YAML text to actions (facts: launch.frontend of ROS 2 Humble)."""

from .._missing import explain_missing
from . import type_utils
from .entity import Entity
from .expose import expose_action, expose_substitution
from .parse_substitution import parse_if_substitutions, parse_substitution
from .parser import InvalidFrontendLaunchFileError, Parser

__all__ = [
    "Entity",
    "InvalidFrontendLaunchFileError",
    "Parser",
    "expose_action",
    "expose_substitution",
    "parse_if_substitutions",
    "parse_substitution",
    "type_utils",
]

__getattr__ = explain_missing(__name__, {})
