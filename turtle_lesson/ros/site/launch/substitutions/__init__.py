"""Substitutions: text that is known only when the launch runs."""

from .._missing import explain_missing
from .anon_name import AnonName
from .boolean_substitution import (
    AllSubstitution,
    AndSubstitution,
    AnySubstitution,
    NotSubstitution,
    OrSubstitution,
)
from .environment_variable import EnvironmentVariable
from .equals_substitution import EqualsSubstitution, IfElseSubstitution, NotEqualsSubstitution
from .find_executable import FindExecutable
from .launch_configuration import LaunchConfiguration
from .local_substitution import LocalSubstitution
from .path_join_substitution import PathJoinSubstitution
from .python_expression import PythonExpression
from .substitution_failure import SubstitutionFailure
from .text_substitution import TextSubstitution
from .this_launch_file import ThisLaunchFile, ThisLaunchFileDir

__all__ = [
    "AllSubstitution",
    "AndSubstitution",
    "AnonName",
    "AnySubstitution",
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
    "PythonExpression",
    "SubstitutionFailure",
    "TextSubstitution",
    "ThisLaunchFile",
    "ThisLaunchFileDir",
]

__getattr__ = explain_missing(
    __name__,
    {
        "Command": "it runs a program of the operating system, and here everything runs inside the notebook",
        "FileContent": "read the file in Python: open(path).read()",
        "LaunchLogDir": "there are no log files here",
        "ThisLaunchFileName": "",
        "ForEachVar": "",
        "ForLoopIndex": "",
        "StringJoinSubstitution": "join the texts in a list: ['a', LaunchConfiguration('b')]",
    },
)
