"""Parameter files: `--params-file`. Which values a file holds for which nodes, by ROS's rules (rcl_yaml_param_parser)."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from turtle_lesson.ros.graph.names import node_name_flaw

from ._yaml_values import YamlValueError, line_of, tree, value_of

KEY = "ros__parameters"

Entry = tuple[str, str, Any]
"""Which nodes (a full name, or a pattern with `*` and `**`), the parameter's name, and its value."""


def read_parameter_file(path: str) -> list[Entry]:
    """The values in a file, in its order; names of nested parameters are joined by dots. Raises YamlValueError."""
    from turtle_lesson.ros.bounded_yaml import LONGEST

    try:
        with open(path, encoding="utf-8") as file:
            text = file.read(LONGEST + 1)
    except UnicodeDecodeError:
        raise YamlValueError("Error opening YAML file: it is not text in UTF-8") from None
    except (OSError, ValueError) as error:
        raise YamlValueError(f"Error opening YAML file: {getattr(error, 'strerror', None) or error}") from None
    return list(_nodes(tree(text), []))


def _nodes(found: Any, names: list[str]) -> Iterator[Entry]:
    """The entries below some names of namespaces and nodes."""
    if found is None:
        return
    if found.id == "sequence":
        kinds = "can only be values and not keys in params. Error" if names else "cannot be key"
        raise YamlValueError(f"Sequences {kinds} at line {line_of(found)}: a file maps names to values")
    if found.id != "mapping":
        raise YamlValueError(
            f"Cannot have a value before {KEY} at line {line_of(found)}: a file maps the names of nodes to `{KEY}:`, and "
            "that to parameters"
        )
    for key, value in found.value:
        name = _name(key)
        if name != KEY:
            yield from _nodes(value, [*names, name])
            continue
        if not names:
            raise YamlValueError(f"There are no node names before {KEY} at line {line_of(key)}")
        node = "/".join(names)
        _check(node, line_of(key))
        yield from ((node, parameter, value) for parameter, value in _parameters(value, ""))


def _parameters(found: Any, prefix: str) -> Iterator[tuple[str, Any]]:
    """The parameters below a prefix."""
    if found.id != "mapping":
        raise YamlValueError(
            f"Cannot have a value before {KEY} at line {line_of(found)}: names of parameters are expected"
        )
    for key, value in found.value:
        name = prefix + _name(key)
        if value.id == "mapping":
            yield from _parameters(value, f"{name}.")
        else:
            yield (name, value_of(value))


def _name(key: Any) -> str:
    if key.id != "scalar":
        raise YamlValueError(f"Sequences cannot be key at line {line_of(key)}")
    if not key.value:
        raise YamlValueError(f"No key at line {line_of(key)}")
    return key.value


def _check(node: str, line: int) -> None:
    """Raise YamlValueError for what can be no node's name."""
    for part in node.removeprefix("/").split("/"):
        flaw = None if part in ("*", "**") else node_name_flaw(part)
        if flaw is not None:
            raise YamlValueError(f"{flaw.reason} (it is '{node}', before line {line})")
