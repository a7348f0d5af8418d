"""`launch_yaml`: launch files in YAML (facts: launch_yaml of ROS 2 Humble)."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import yaml
from launch._entities import explained
from launch._entity import Mapping
from launch._package import complete_package
from launch.frontend import Entity
from launch.launch_description_sources import FrontendLaunchDescriptionSource

from turtle_lesson.ros.runtime.bounded_yaml import BoundedLoader
from turtle_lesson.ros.sim.errors import shown_path


def read(file: str) -> Entity:
    """The root tag of a file. Raises yaml.YAMLError if it is no YAML, and RuntimeError for several roots."""
    loader = _Loader(Path(file).read_text(encoding="utf-8-sig"))
    loader.name = shown_path(file)
    try:
        tree = loader.get_single_data()
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark
        hint = next((hint for said, hint in _HINTS.items() if said in str(error.problem)), "")
        explained(error, hint, None if mark is None else (file, mark.line + 1))
        raise
    finally:
        loader.dispose()
    if not isinstance(tree, Mapping) or len(tree) != 1:
        hint = "The file begins with launch: and all actions are a list below it."
        raise explained(RuntimeError("Expected only one root"), hint, (file, 1))
    [(root, inside)] = tree.items()
    return Entity(str(root), inside, (file, tree.line))


class _Loader(BoundedLoader):
    """Reads mappings as `Mapping`s, which know their lines."""


def _mapping(loader: _Loader, node: yaml.MappingNode) -> Iterator[Mapping]:
    found = Mapping(node.start_mark.line + 1)
    yield found
    found.update(loader.construct_mapping(node))


_Loader.add_constructor("tag:yaml.org,2002:map", _mapping)


_HINTS = {
    "\\t": "YAML is indented with spaces, never with tabs.",
    "mapping values are not allowed": "Put a value that contains ': ' in quotation marks, and indent all items alike.",
    "expected": "Look at the indentation, brackets and quotation marks of this line and of the one before.",
}
"""What to try, by a part of what the parser says of a text that is no YAML."""


class YAMLLaunchDescriptionSource(FrontendLaunchDescriptionSource):
    """Gets the description from a YAML launch file."""

    _read = staticmethod(read)


complete_package("launch_yaml")
