"""Parameters: a value with its type, a file, and how both are read from launch files.

Facts: launch_ros's normalize_parameters.py and evaluate_parameters.py. A Python value keeps its type, text
stays text, and what a substitution gives is read as YAML: `5.0` is a double, `10` an integer, `true` a bool.
"""

from __future__ import annotations

import re
import shutil
import weakref
from collections.abc import Iterator, Mapping, Sequence
from os import PathLike, fspath
from pathlib import Path
from tempfile import mkdtemp
from typing import Any, get_args, get_origin

import yaml
from launch import LaunchContext
from launch._entities import SomeSubstitutionsType, Substitution, explained, text_of
from launch._entities import normalize_to_list_of_substitutions as pieces
from launch.frontend import Entity, attribute, parse_substitution, tags
from launch.utilities import SCALARS, perform_text_as

from turtle_lesson.ros.runtime.bounded_yaml import safe_load

__all__ = ["ParameterFile", "ParameterValue"]


def parameters_in(context: LaunchContext, given: Mapping[Any, Any]) -> Iterator[tuple[str, Any]]:
    """The names and values of a dictionary of parameters; nested dictionaries give names with dots."""
    for key, value in given.items():
        name = text_of(context, key)
        if isinstance(value, Mapping):
            for inner, inner_value in parameters_in(context, value):
                yield f"{name}.{inner}", inner_value
            continue
        try:
            yield name, value_of(context, value)
        except TypeError as error:
            error.add_note(f"This is parameter '{name}'.")
            raise


def value_of(context: LaunchContext, value: Any) -> Any:
    """One value, substitutions performed. Raises TypeError if no ROS parameter can have it."""
    if isinstance(value, ParameterValue):
        return value.evaluate(context)
    if isinstance(value, SCALARS):
        return value
    if isinstance(value, Substitution):
        value = [value]
    if not isinstance(value, Sequence) or isinstance(value, bytes):
        raise TypeError(f"Unexpected type for parameter value {value!r}; it can be a bool, int, float, text, or a list")
    if any(isinstance(item, Substitution) for item in value):
        text = text_of(context, value)
        found = safe_load(text) if text else ""  # an empty text stays one (launch_ros, pull request 300)
        try:
            return uniform(found) if isinstance(found, list) else value_of(context, found)
        except TypeError as error:
            hint = f"The text is {text!r}; ParameterValue(…, value_type=str) keeps it as text."
            raise explained(error, hint) from None
    if any(isinstance(item, list | tuple) for item in value):
        value = [safe_load(text_of(context, item)) for item in value]
    return uniform(list(value))


def uniform(items: list[Any]) -> list[Any]:
    """The items if they are of one type, integers among floats made floats.

    Raises TypeError if they are not, or if there are none.
    """
    kinds = {type(item) for item in items}
    if kinds == {int, float}:
        return [float(item) for item in items]
    if len(kinds) == 1 and kinds <= set(SCALARS):
        return items
    raise TypeError(
        "Expected a non-empty sequence, with items of uniform type. Allowed sequence item types are bool, "
        f"int, float, str. Got {items!r}."
    )


def as_argument(value: Any) -> str:
    """A value as it stands after `name:=` on a command line, such that YAML reads the same value again."""
    for readable in (True, False):
        text = yaml.safe_dump(value, default_flow_style=True, allow_unicode=readable, width=float("inf"))
        if not re.search("[\x85\u2028\u2029]", text):  # which PyYAML would fold away
            break
    return text.removesuffix("\n").removesuffix("\n...")


class ParameterValue:
    """A value with its type (None: by YAML's rules): `ParameterValue(LaunchConfiguration('id'), value_type=str)`."""

    def __init__(self, value: Any, *, value_type: Any = None) -> None:
        self.value = value
        self.value_type = value_type

    def evaluate(self, context: LaunchContext) -> Any:
        """The value in this context. Raises TypeError if it is not of the type."""
        if self.value_type is None:
            return value_of(context, self.value)
        if get_origin(self.value_type) is not list:
            return perform_text_as(context, self.value, self.value_type)
        items = self.value
        if isinstance(items, Substitution):
            items = safe_load(text_of(context, items))
        return uniform([perform_text_as(context, item, get_args(self.value_type)[0]) for item in items])


class ParameterFile:
    """A YAML file with parameters; with `allow_substs`, `$(…)` in it stand for something."""

    def __init__(
        self,
        param_file: PathLike[str] | SomeSubstitutionsType,
        *,
        allow_substs: bool | SomeSubstitutionsType = False,
    ) -> None:
        self.param_file = pieces(fspath(param_file) if isinstance(param_file, PathLike) else param_file)
        self.allow_substs = allow_substs

    def evaluate(self, context: LaunchContext) -> Path:
        """The file's path in this context; with `allow_substs` that of a copy with the substitutions performed.

        Raises SubstitutionFailure if one of them has no value.
        """
        path = Path(text_of(context, self.param_file))
        if not perform_text_as(context, self.allow_substs, bool) or not path.is_file():
            return path
        text = text_of(context, parse_substitution(path.read_text(encoding="utf-8")))
        return file_for_this_launch(self, path.name, text)


def file_for_this_launch(owner: object, name: str, text: str) -> Path:
    """A file of parameters that is there as long as `owner`, which is a part of the launch description."""
    folder = mkdtemp(prefix="launch_params_")
    weakref.finalize(owner, shutil.rmtree, folder, ignore_errors=True)
    file = Path(folder) / name
    file.write_text(text, encoding="utf-8")
    return file


TYPES: dict[str, Any] = {
    **{kind.__name__: kind for kind in SCALARS},
    "yaml": None,
    **{f"list_of_{kind.__name__}": list[kind] for kind in SCALARS},  # type: ignore[valid-type]
}
"""What the attribute `type` of a parameter can be."""


def parameters(entity: Entity) -> list[Any] | None:
    """What `Node(parameters=…)` takes, from nested tags: files first, then one dictionary with all others."""
    found = tags("param", _parameter)(entity) or []
    named = {name: value for each in found if isinstance(each, dict) for name, value in each.items()}
    files = [each for each in found if isinstance(each, ParameterFile)]
    return [*files, named] if named else files


def _parameter(param: Entity) -> ParameterFile | dict[Any, Any]:
    """What one tag stands for: a file, or a name with its value or with nested names."""
    file, name = attribute("from", optional=True)(param), attribute("name", optional=True)(param)
    if (file is None) == (name is None):
        raise ValueError("param Entity should have either name or from attribute")
    if file is not None:
        return ParameterFile(file, allow_substs=attribute("allow_substs", bool, optional=True)(param) or False)
    type_name = param.get_attr("type", optional=True)
    if type_name is not None and type_name not in TYPES:
        raise ValueError(f"Unexpected type attribute `{type_name}`. It must be one of {list(TYPES)}")
    kind = None if type_name is None else TYPES[type_name]
    value: Any = attribute("value", kind, optional=True)(param)
    nested = tags("param", _parameter)(param)
    if (value is None) == (nested is None) or not all(isinstance(each, dict) for each in nested or ()):
        raise ValueError("either a value attribute or nested params are needed")
    if nested:
        value = {inner: inner_value for each in nested for inner, inner_value in each.items()}
    elif kind is not None:
        value = ParameterValue(value, value_type=kind)
    return {name if isinstance(name, str) else tuple(name): value}
