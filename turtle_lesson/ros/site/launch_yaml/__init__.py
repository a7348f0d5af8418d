"""`launch_yaml`: launch files in YAML (facts: launch_yaml of ROS 2 Humble)."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import yaml
from launch import LaunchDescription, frontend
from launch._entities import explained
from launch._package import complete_package
from launch.launch_description_sources import FrontendLaunchDescriptionSource
from launch.utilities import is_of_type

from turtle_lesson.ros.runtime.bounded_yaml import BoundedLoader
from turtle_lesson.ros.sim.errors import shown_path

__all__ = ["Entity"]


class Mapping(dict[Any, Any]):
    """A YAML mapping that knows the lines of its keys, counted from 1."""

    def __init__(self) -> None:
        super().__init__()
        self.lines: dict[Any, int] = {}


class Entity(frontend.Entity):
    """An item: its name, and what stands below it, a mapping or a list of further items.

    YAML knows types, so a value must be of the one that is asked for.
    """

    @property
    def children(self) -> list[frontend.Entity]:
        """The items below it: its list, or the list called `children` in its mapping."""
        self._asked[self.TAGS].add("children")
        given = self._given(self.TAGS)
        if "children" not in given:
            raise ValueError(
                f"Expected entity `{self.type_name}` to have children entities."
                "That can be a list of subentities or a dictionary with a `children` list element"
            )
        below = given["children"]
        found: list[frontend.Entity] = []
        for item in below if isinstance(below, list) else [below]:
            if not isinstance(item, Mapping) or len(item) != 1:
                error = RuntimeError("Subentity must be a dictionary with only one key, which is the entity type")
                hint = "Each item is a hyphen, the name of an action and a colon, as in - node:"
                if isinstance(item, Mapping) and item:
                    hint = f"Indent what belongs to {next(iter(item))} deeper than {next(iter(item))} itself."
                    explained(error, place=(self._file, max(item.lines.values())))
                raise explained(error, hint)
            [name] = item
            found.append(Entity(item[name], str(name), parent=self, line=item.lines.get(name)))
        return found

    def _given(self, kind: str) -> dict[Any, Any]:
        if isinstance(self._element, list):
            return {"children": self._element}
        if not isinstance(self._element, dict | None):
            error = TypeError(f"Expected a dict or list, got {type(self._element)}")
            raise explained(error, f"Write the attributes of {self.type_name} below it, each on a line of its own.")
        return self._element or {}

    def _value(self, name: str, data_type: Any, can_be_str: bool) -> Any:
        value = self._element[name]
        if not is_of_type(value, data_type, can_be_str):
            error = TypeError(
                f"Attribute '{name}' of Entity '{self.type_name}' expected to be of type '{data_type}', "
                f"got '{type(value)}'"
            )
            is_plain = data_type is str and isinstance(value, bool | int | float)
            raise explained(error, f'Put it into quotation marks: {name}: "{value}"' if is_plain else "")
        return value

    def _nested(self, name: str, given: Any) -> list[frontend.Entity]:
        if not isinstance(given, list) or not all(isinstance(item, Mapping) for item in given):
            error = TypeError(f"Attribute '{name}' of Entity '{self.type_name}' expected to be a list of dictionaries.")
            raise explained(error, f"Begin each {name} with a hyphen.")
        return [Entity(item, name, parent=self, line=min(item.lines.values(), default=None)) for item in given]


def read(file: str) -> Entity:
    """The root tag of a file. Raises yaml.YAMLError if it is no YAML, and RuntimeError for several roots."""
    loader = _Loader(Path(file).read_text(encoding="utf-8-sig"))
    loader.name = shown_path(file)
    try:
        tree = loader.get_single_data()
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark
        explained(error, _hint(error), None if mark is None else (file, mark.line + 1))
        raise
    finally:
        loader.dispose()
    if not isinstance(tree, Mapping) or len(tree) != 1:
        hint = "The file begins with launch: and all actions are a list below it."
        raise explained(RuntimeError("Expected only one root"), hint, (file, 1))
    [root] = tree
    return Entity(tree[root], str(root), file=file, line=tree.lines.get(root, 1))


class _Loader(BoundedLoader):
    """Reads mappings as `Mapping`s, which know the lines of their keys."""


def _mapping(loader: _Loader, node: yaml.MappingNode) -> Iterator[Mapping]:
    found = Mapping()
    yield found
    found.update(loader.construct_mapping(node))
    for key, _ in node.value:
        found.lines.setdefault(getattr(key, "value", ""), key.start_mark.line + 1)


_Loader.add_constructor("tag:yaml.org,2002:map", _mapping)


def _hint(error: yaml.MarkedYAMLError) -> str:
    problem = str(error.problem or "")
    if "\\t" in problem:
        return "YAML is indented with spaces, never with tabs."
    if "mapping values are not allowed" in problem or "found character '%'" in problem:
        return "Put a value that contains ': ' in quotation marks, and indent all items of one level alike."
    if "flow mapping" in str(error.context or ""):
        return "Within {…}, put a value that contains braces, commas or quotation marks in quotation marks."
    if "expected <block end>" in problem or "could not find expected ':'" in problem:
        return "Look at the indentation of this line and of the one before."
    return ""


class YAMLLaunchDescriptionSource(FrontendLaunchDescriptionSource):
    """Gets the description from a YAML launch file."""

    def _get_launch_description(self, location: str) -> LaunchDescription:
        return frontend.description_of(read(location))


complete_package("launch_yaml", {"launch_yaml.launch_description_sources": "YAMLLaunchDescriptionSource"})
