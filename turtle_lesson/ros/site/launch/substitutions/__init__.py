"""Substitutions: text that is known only when the launch runs."""

from .._missing import explain_missing
from .anon_name import AnonName
from .boolean_substitution import (
    AndSubstitution,
    NotSubstitution,
    OrSubstitution,
)
from .command import Command
from .environment_variable import EnvironmentVariable
from .equals_substitution import EqualsSubstitution, IfElseSubstitution, NotEqualsSubstitution
from .find_executable import FindExecutable
from .launch_configuration import LaunchConfiguration
from .local_substitution import LocalSubstitution
from .path_join_substitution import PathJoinSubstitution, PathSubstitution
from .python_expression import PythonExpression
from .substitution_failure import SubstitutionFailure
from .text_substitution import TextSubstitution
from .this_launch_file import ThisLaunchFile, ThisLaunchFileDir

__all__ = [
    "AndSubstitution",
    "AnonName",
    "Command",
    "EnvironmentVariable",
    "EqualsSubstitution",
    "FindExecutable",
    "IfElseSubstitution",
    "LaunchConfiguration",
    "LocalSubstitution",
    "NotEqualsSubstitution",
    "NotSubstitution",
    "OrSubstitution",
    "PathJoinSubstitution",
    "PathSubstitution",
    "PythonExpression",
    "SubstitutionFailure",
    "TextSubstitution",
    "ThisLaunchFile",
    "ThisLaunchFileDir",
]

__getattr__ = explain_missing(
    __name__,
    {
        "AllSubstitution": "use AndSubstitution",
        "AnySubstitution": "use OrSubstitution",
        "FileContent": "use Command(['cat ', path])",
        "ForEachVar": "write the loop in Python",
        "ForLoopIndex": "write the loop in Python",
        "LaunchLogDir": "there are no log files",
        "StringJoinSubstitution": "put the pieces into a list: [a, '-', b]",
        "ThisLaunchFileName": "use ThisLaunchFile",
    },
)
