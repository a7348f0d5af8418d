"""Parameters: a value with its type, a file, and how both are read from launch files.

Facts: launch_ros's normalize_parameters.py and evaluate_parameters.py. A Python value keeps its type, text
stays text, and what a substitution gives is read as YAML: `5.0` is a double, `10` an integer, `true` a bool.
"""

from __future__ import annotations

import shutil
import weakref
from collections.abc import Iterable, Iterator, Mapping, Sequence
from os import PathLike, fspath
from pathlib import Path
from tempfile import mkdtemp
from typing import Any, get_args, get_origin

from launch import LaunchContext
from launch._entities import SomeSubstitutionsType, Substitution
from launch._package import explain_missing
from launch.frontend import Entity, Parser, parse_substitution
from launch.substitutions import TextSubstitution
from launch.utilities import (
    normalize_to_list_of_substitutions,
    perform_substitutions,
    perform_text_as,
)

__all__ = ["Parameter", "ParameterFile", "ParameterValue"]


PLAIN = (bool, int, float, str)


class ParameterTypeError(TypeError):
    """A parameter's value is of no type that ROS has. `hint` says what to try."""

    def __init__(self, message: str, hint: str = "") -> None:
        super().__init__(message)
        self.hint = hint


def parameters_in(context: LaunchContext, given: Mapping[Any, Any]) -> Iterator[tuple[str, Any]]:
    """The names and values of a dictionary of parameters; nested dictionaries give names with dots."""
    for key, value in given.items():
        name = perform_substitutions(context, normalize_to_list_of_substitutions(key))
        if isinstance(value, Mapping):
            for inner, inner_value in parameters_in(context, value):
                yield f"{name}.{inner}", inner_value
        else:
            yield name, _named(name, context, value)


def _named(name: str, context: LaunchContext, value: Any) -> Any:
    try:
        return value_of(context, value)
    except ParameterTypeError as error:
        error.hint = f"This is parameter '{name}'. {error.hint}".strip()
        raise


def value_of(context: LaunchContext, value: Any) -> Any:
    """One value, substitutions performed.

    Raises:
        ParameterTypeError: if no ROS parameter can have it.
    """
    if hasattr(value, "evaluate"):  # a ParameterValue
        return value.evaluate(context)
    if isinstance(value, PLAIN):
        return value
    if isinstance(value, Substitution):
        return _from_text(perform_substitutions(context, [value]))
    if isinstance(value, Sequence) and not isinstance(value, bytes):
        return _from_sequence(context, value)
    raise ParameterTypeError(
        f"Unexpected type for parameter value {value!r}",
        "It can be a bool, int, float, text, or a list.",
    )


def _from_text(text: str) -> Any:
    """What YAML makes of a substitution's text; an empty text stays one (launch_ros, pull request 300)."""
    from turtle_lesson.ros.runtime.files import safe_load

    if not text:
        return ""
    value = safe_load(text)
    if isinstance(value, PLAIN):
        return value
    if isinstance(value, list):
        return uniform(value)
    raise ParameterTypeError(
        "Allowed value types are bytes, bool, int, float, str, Sequence[bool], Sequence[int], "
        f"Sequence[float], Sequence[str]. Got {type(value)}.",
        f"The text is {text!r}; ParameterValue(…, value_type=str) keeps it as text.",
    )


def _from_sequence(context: LaunchContext, items: Sequence[Any]) -> Any:
    from turtle_lesson.ros.runtime.files import safe_load

    if any(isinstance(item, Substitution) for item in items):
        pieces = normalize_to_list_of_substitutions(items)
        return _from_text(perform_substitutions(context, pieces))
    if any(isinstance(item, Sequence) and not isinstance(item, str) for item in items):
        texts = [perform_substitutions(context, normalize_to_list_of_substitutions(item)) for item in items]
        return uniform([safe_load(text) for text in texts])
    return uniform(list(items))


def uniform(items: list[Any]) -> list[Any]:
    """The items if they are of one type, integers among floats made floats.

    Raises:
        ParameterTypeError: if they are not, or if there are none.
    """
    kinds = {type(item) for item in items}
    if kinds == {int, float}:
        return [float(item) for item in items]
    if len(kinds) == 1 and kinds <= set(PLAIN):
        return items
    raise ParameterTypeError(
        "Expected a non-empty sequence, with items of uniform type. Allowed sequence item types are bool, "
        "int, float, str.",
        f"Got {items!r}.",
    )


def as_argument(value: Any) -> str:
    """A value as it stands after `name:=` on a command line, such that YAML reads the same value again."""
    import yaml

    def dump(readable: bool) -> str:
        return yaml.safe_dump(value, default_flow_style=True, allow_unicode=readable, width=float("inf"))

    text = dump(True)
    if any(line_end in text for line_end in "\x85\u2028\u2029"):  # which PyYAML would fold away
        text = dump(False)
    return text.removesuffix("\n").removesuffix("\n...")


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
        from turtle_lesson.ros.runtime.files import safe_load

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
        self.__allow_substs = (
            allow_substs if isinstance(allow_substs, bool) else normalize_to_list_of_substitutions(allow_substs)
        )

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
        if not perform_text_as(context, self.__allow_substs, bool) or not path.is_file():
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


TYPES: dict[str, Any] = {
    "bool": bool,
    "int": int,
    "float": float,
    "str": str,
    "yaml": None,
    "list_of_bool": list[bool],
    "list_of_int": list[int],
    "list_of_float": list[float],
    "list_of_str": list[str],
}
"""What the attribute `type` of a parameter can be."""


def remap_rules(remaps: Iterable[Entity], parser: Parser) -> list[tuple[list[Substitution], list[Substitution]]]:
    """The pairs of `remap` tags."""
    rules = []
    for remap in remaps:
        source, target = remap.get_attr("from"), remap.get_attr("to")
        rules.append((parser.parse_substitution(source), parser.parse_substitution(target)))
        remap.assert_entity_completely_parsed()
    return rules


def nested_parameters(params: Sequence[Entity], parser: Parser) -> list[Any]:
    """What `Node(parameters=…)` takes, from `param` tags: files first, then one dictionary with all others.

    Raises:
        RuntimeError, ValueError: with the real texts, if a tag has too much in it or too little.
    """
    files: list[Any] = []
    named = []
    for param in params:
        file, name = param.get_attr("from", optional=True), param.get_attr("name", optional=True)
        if file is not None and name is not None:
            raise RuntimeError("name and from attributes are mutually exclusive")
        if file is not None:
            files.append(_file(param, file, parser))
        elif name is not None:
            named.append(param)
        else:
            raise ValueError("param Entity should have name or from attribute")
    return [*files, *([_dictionary(named, parser)] if named else [])]


def _file(param: Entity, path: str, parser: Parser) -> ParameterFile:
    allowed = param.get_attr("allow_substs", data_type=bool, optional=True)
    param.assert_entity_completely_parsed()
    return ParameterFile(
        parser.parse_substitution(path),
        allow_substs=False if allowed is None else parser.parse_if_substitutions(allowed),
    )


def _dictionary(params: Iterable[Entity], parser: Parser) -> dict[Any, Any]:
    found: dict[Any, Any] = {}
    for param in params:
        name = tuple(parser.parse_substitution(param.get_attr("name")))
        kind = _kind(param)
        value = param.get_attr("value", data_type=kind, optional=True)
        nested = param.get_attr("param", data_type=list[Entity], optional=True)
        if value is not None and nested:
            raise RuntimeError("param and value attributes are mutually exclusive")
        if value is not None:
            given = typed_value(value, parser)
            found[name] = given if kind is None else ParameterValue(given, value_type=kind)
        elif nested:
            found[name] = _dictionary(nested, parser)
        else:
            raise RuntimeError("either a value attribute or nested params are needed")
        param.assert_entity_completely_parsed()
    return found


def _kind(param: Entity) -> Any:
    """The type that a parameter is to have, by its attribute `type`."""
    name = param.get_attr("type", optional=True)
    if name is None:
        return None
    if name not in TYPES:
        raise ValueError(f"Unexpected type attribute `{name}`. It must be one of {list(TYPES)}")
    return TYPES[name]


def typed_value(value: Any, parser: Parser) -> Any:
    """A value with its substitutions; a text without any stays text, whatever YAML would make of it."""
    if isinstance(value, list):
        return [typed_value(item, parser) for item in value]
    if not isinstance(value, str):
        return value
    pieces = parser.parse_substitution(value)
    if len(pieces) == 1 and isinstance(pieces[0], TextSubstitution):
        return pieces[0].text
    return pieces


__getattr__ = explain_missing(__name__, {})
