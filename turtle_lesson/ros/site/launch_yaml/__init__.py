"""`launch_yaml`: launch files in YAML (facts: launch_yaml of ROS 2 Humble)."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import yaml
from launch import frontend
from launch._entities import SomeSubstitutionsType, explained
from launch._package import complete_package
from launch.frontend import Entity as BaseEntity
from launch.frontend import check_is_list_entity
from launch.launch_description_sources import FrontendLaunchDescriptionSource
from launch.utilities import is_instance_of

from turtle_lesson.ros.runtime.files import BoundedLoader
from turtle_lesson.ros.sim.errors import shown_path

__all__ = ["Entity", "Parser"]


class Mapping(dict[Any, Any]):
    """A YAML mapping that knows the lines of its keys, counted from 1."""

    def __init__(self) -> None:
        super().__init__()
        self.lines: dict[Any, int] = {}


class Entity(BaseEntity):
    """An item: its name, and what stands below it, a mapping or a list of further items."""

    def __init__(
        self,
        element: Any,
        type_name: str,
        *,
        parent: Entity | None = None,
        file: str = "",
        line: int | None = None,
    ) -> None:
        super().__init__(type_name, parent, (file, line) if file and line is not None else None)
        self.__element = element
        self.__file = file
        self.__children_read = False

    @property
    def children(self) -> list[BaseEntity]:
        """The items below it: its list, or the list called `children` in its mapping."""
        self._asked.add("children")
        below = self.__element
        if not isinstance(below, dict | list):
            raise TypeError(f"Expected a dict or list, got {type(below)}")
        if isinstance(below, dict):
            if "children" not in below:
                raise ValueError(
                    f"Expected entity `{self.type_name}` to have children entities."
                    "That can be a list of subentities or a dictionary with a `children` list element"
                )
            self._read.add("children")
            below = below["children"]
        self.__children_read = True
        return [self._child(item) for item in (below if isinstance(below, list) else [below])]

    def _child(self, item: Any) -> Entity:
        if not isinstance(item, Mapping) or len(item) != 1:
            error = RuntimeError("Subentity must be a dictionary with only one key, which is the entity type")
            lines = list(item.lines.values()) if isinstance(item, Mapping) else []
            raise explained(error, _hint(item), (self.__file, lines[-1]) if lines else None)
        name = next(iter(item))
        return Entity(item[name], str(name), parent=self, file=self.__file, line=item.lines.get(name))

    def assert_entity_completely_parsed(self) -> None:
        """Check that every key in it was asked for."""
        if isinstance(self.__element, list):
            if not self.__children_read:
                raise ValueError(f"Unexpected nested entity(ies) found in `{self.type_name}`: {self.__element}")
            return
        keys = set(self._mapping) - self._read
        if keys:
            raise self._unexpected("key(s)", keys, self._asked)

    @property
    def _mapping(self) -> dict[Any, Any]:
        """What stands below it, if that is a mapping or nothing."""
        if self.__element is None:
            return {}
        if isinstance(self.__element, dict):
            return self.__element
        error = TypeError(f"Expected a dict or list, got {type(self.__element)}")
        raise explained(error, f"Write the attributes of {self.type_name} below it, each on a line of its own.")

    def get_attr(self, name: str, *, data_type: Any = str, optional: bool = False, can_be_str: bool = True) -> Any:
        """As `launch.frontend.Entity.get_attr`. YAML knows types, so a value must be of the one asked for."""
        self._asked.add(name)
        below = {} if isinstance(self.__element, list) else self._mapping
        if name not in below:
            if optional:
                return None
            raise self._absent(name, data_type, below)
        self._read.add(name)
        value = below[name]
        if check_is_list_entity(data_type):
            return self._nested(name, value)
        if not is_instance_of(value, data_type, can_be_str=can_be_str):
            error = TypeError(
                f"Attribute '{name}' of Entity '{self.type_name}' expected to be of type '{data_type}', "
                f"got '{type(value)}'"
            )
            is_plain = data_type is str and isinstance(value, bool | int | float)
            raise explained(error, f'Put it into quotation marks: {name}: "{value}"' if is_plain else "")
        return value

    def _nested(self, name: str, value: Any) -> list[Entity]:
        if not isinstance(value, list) or not all(isinstance(item, dict) for item in value):
            error = TypeError(f"Attribute '{name}' of Entity '{self.type_name}' expected to be a list of dictionaries.")
            raise explained(error, f"Begin each {name} with a hyphen.")
        lines = [min(getattr(item, "lines", {}).values(), default=None) for item in value]
        return [
            Entity(item, name, parent=self, file=self.__file, line=line)
            for item, line in zip(value, lines, strict=True)
        ]


def _hint(item: Any) -> str:
    if isinstance(item, dict) and len(item) > 1:
        return f"Indent what belongs to {next(iter(item))!s} deeper than {next(iter(item))!s} itself."
    return "Each item is a hyphen, the name of an action and a colon, as in - node:"


class Parser(frontend.Parser):
    """Reads YAML."""

    @classmethod
    def load_text(cls, text: str, name: str) -> tuple[Entity, Parser]:
        """The root entity of a text.

        Raises:
            yaml.YAMLError: if it is no YAML.
            RuntimeError: if it has not exactly one root.
        """
        try:
            tree = _tree(text, name)
        except yaml.MarkedYAMLError as error:
            mark = error.problem_mark
            explained(error, _hint_for_syntax(error), None if mark is None else (name, mark.line + 1))
            raise
        if not isinstance(tree, Mapping) or len(tree) != 1:
            hint = "The file begins with launch: and all actions are a list below it."
            raise explained(RuntimeError("Expected only one root"), hint, (name, 1))
        root = next(iter(tree))
        return Entity(tree[root], str(root), file=name, line=tree.lines.get(root, 1)), cls()


def _tree(text: str, name: str) -> Any:
    loader = _Loader(text)
    loader.name = shown_path(name) or loader.name
    try:
        return loader.get_single_data()
    finally:
        loader.dispose()


class _Loader(BoundedLoader):
    """Reads mappings as `Mapping`s, which know the lines of their keys."""


def _mapping(loader: _Loader, node: yaml.MappingNode) -> Iterator[Mapping]:
    found = Mapping()
    yield found
    found.update(loader.construct_mapping(node))
    for key, _ in node.value:
        found.lines.setdefault(getattr(key, "value", ""), key.start_mark.line + 1)


_Loader.add_constructor("tag:yaml.org,2002:map", _mapping)


def _hint_for_syntax(error: Any) -> str:
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
    """Gets the description from an YAML launch file."""

    def __init__(self, launch_file_path: SomeSubstitutionsType) -> None:
        super().__init__(launch_file_path, method="interpreted YAML launch file", parser=Parser)


complete_package("launch_yaml", {"launch_yaml.launch_description_sources": "YAMLLaunchDescriptionSource"})
