"""Substitutions: text that is known only when the launch runs."""

from __future__ import annotations

from .._entities import TextSubstitution
from .._package import explain_missing
from ._logic import (
    AndSubstitution,
    EqualsSubstitution,
    IfElseSubstitution,
    NotEqualsSubstitution,
    NotSubstitution,
    OrSubstitution,
)
from ._paths import Command, FindExecutable, PathJoinSubstitution, PathSubstitution
from ._values import (
    AnonName,
    EnvironmentVariable,
    LaunchConfiguration,
    LocalSubstitution,
    PythonExpression,
    SubstitutionFailure,
    ThisLaunchFile,
    ThisLaunchFileDir,
)

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
