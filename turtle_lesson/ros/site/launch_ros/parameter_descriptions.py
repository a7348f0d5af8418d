"""A parameter's value, a parameter, and a parameter file, said more exactly than by a plain dictionary."""

from __future__ import annotations

import shutil
import weakref
from os import PathLike, fspath
from pathlib import Path
from tempfile import mkdtemp
from typing import Any, get_args, get_origin

from launch import LaunchContext
from launch._missing import explain_missing
from launch.frontend import parse_substitution
from launch.some_types import SomeSubstitutionsType
from launch.substitution import Substitution
from launch.utilities import (
    normalize_to_list_of_substitutions,
    perform_substitutions,
    perform_text_as,
)
from launch.utilities.type_utils import normalize_typed_substitution, perform_typed_substitution

from ._values import uniform, value_of

__all__ = ["Parameter", "ParameterFile", "ParameterValue"]


class ParameterValue:
    """A value with its type: `ParameterValue(LaunchConfiguration('id'), value_type=str)`."""

    def __init__(self, value: Any, *, value_type: Any = None) -> None:
        self.__value = value
        self.__value_type = value_type

    @property
    def value(self) -> Any:
        """The value as it was given."""
        return self.__value

    @property
    def value_type(self) -> Any:
        """The type: bool, int, float, str, a list of one of these, or None for YAML's rules."""
        return self.__value_type

    def evaluate(self, context: LaunchContext) -> Any:
        """The value in this context.

        Raises:
            TypeError: if it is not of the type.
        """
        if self.__value_type is None:
            return value_of(context, self.__value)
        if get_origin(self.__value_type) is list:
            return self._list(context, get_args(self.__value_type)[0])
        return perform_text_as(context, self.__value, self.__value_type)

    def _list(self, context: LaunchContext, kind: type) -> list[Any]:
        from turtle_lesson.ros.bounded_yaml import safe_load

        items = self.__value
        if isinstance(items, Substitution):
            items = safe_load(perform_substitutions(context, normalize_to_list_of_substitutions(items)))
        return uniform([perform_text_as(context, item, kind) for item in items])


class Parameter:
    """A parameter: name and value, for `parameters=[Parameter('rate', 5.0)]`."""

    def __init__(self, name: SomeSubstitutionsType, value: Any, *, value_type: Any = None) -> None:
        self.name = normalize_to_list_of_substitutions(name)
        self.__parameter_value = ParameterValue(value, value_type=value_type)

    @property
    def value(self) -> Any:
        """The value as it was given."""
        return self.__parameter_value.value

    @property
    def value_type(self) -> Any:
        """The type that it is to have, or None."""
        return self.__parameter_value.value_type

    def evaluate(self, context: LaunchContext) -> tuple[str, Any]:
        """Name and value in this context."""
        return perform_substitutions(context, self.name), self.__parameter_value.evaluate(context)


class ParameterFile:
    """A YAML file with parameters."""

    def __init__(
        self,
        param_file: PathLike[str] | SomeSubstitutionsType,
        *,
        allow_substs: bool | SomeSubstitutionsType = False,
    ) -> None:
        if isinstance(param_file, PathLike):
            param_file = fspath(param_file)
        self.param_file = normalize_to_list_of_substitutions(param_file)
        self.__allow_substs = normalize_typed_substitution(allow_substs, bool)

    @property
    def allow_substs(self) -> Any:
        """Whether `$(…)` in the file stand for something."""
        return self.__allow_substs

    def evaluate(self, context: LaunchContext) -> Path:
        """The file's path in this context; with `allow_substs` that of a copy with the substitutions performed.

        Raises:
            SubstitutionFailure: if one of them has no value.
        """
        path = Path(perform_substitutions(context, self.param_file))
        if not perform_typed_substitution(context, self.__allow_substs, bool) or not path.is_file():
            return path
        text = perform_substitutions(context, parse_substitution(path.read_text(encoding="utf-8")))
        return file_for_this_launch(self, path.name, text)


def file_for_this_launch(owner: object, name: str, text: str) -> Path:
    """A file of parameters that is there as long as `owner`, which is a part of the launch description."""
    folder = mkdtemp(prefix="launch_params_")
    weakref.finalize(owner, shutil.rmtree, folder, ignore_errors=True)
    file = Path(folder) / name
    file.write_text(text, encoding="utf-8")
    return file


__getattr__ = explain_missing(__name__, {})
