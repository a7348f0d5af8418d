"""Parameters and remappings as XML and YAML launch files write them (facts: launch_ros.actions.node)."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

from launch.frontend import Entity, Parser
from launch.substitution import Substitution
from launch.substitutions import TextSubstitution

from .parameter_descriptions import ParameterFile, ParameterValue

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
