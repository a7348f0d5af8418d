"""What may be given as parameters, for hints (names: launch_ros's parameters_type.py)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from os import PathLike
from pathlib import Path
from typing import Any

from launch.some_types import SomeSubstitutionsType
from launch.substitution import Substitution

from .parameter_descriptions import Parameter, ParameterFile, ParameterValue

SomeParameterFile = SomeSubstitutionsType | PathLike
SomeParameterName = SomeSubstitutionsType
SomeParameterValue = ParameterValue | SomeSubstitutionsType | Sequence[Any] | str | int | float | bool
SomeParametersDict = Mapping[SomeParameterName, Any]
SomeParameters = Sequence[SomeParameterFile | Parameter | ParameterFile | SomeParametersDict]
"""What a launch file may write."""

ParameterName = Sequence[Substitution]
ParametersDict = Mapping[ParameterName, Any]
Parameters = Sequence[ParameterFile | Parameter | ParametersDict]
"""The same when every text has become a substitution."""

EvaluatedParameterValue = (
    str | int | float | bool | Sequence[str] | Sequence[int] | Sequence[float] | Sequence[bool] | bytes
)
EvaluatedParameters = Sequence[Path | Parameter | dict[str, EvaluatedParameterValue]]
"""The same when the substitutions have been performed."""
