"""`Parser`: the text of a YAML launch file becomes entities that know their line."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, TextIO

import yaml
from launch import frontend
from launch.frontend.parser import read

from turtle_lesson.ros.bounded_yaml import BoundedLoader
from turtle_lesson.ros.core.tracebacks import shown_path

from .entity import Entity, Mapping


class Parser(frontend.Parser):
    """Reads YAML."""

    @classmethod
    def load(cls, file: str | TextIO) -> tuple[Entity, Parser]:
        """The root entity of a file."""
        name, text = read(file)
        return cls.load_text(text, name)

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
            if error.problem_mark is not None:
                error.place = (name, error.problem_mark.line + 1)
            error.hint = _hint(error)
            raise
        if not isinstance(tree, Mapping) or len(tree) != 1:
            wrong: Any = RuntimeError("Expected only one root")
            wrong.place = (name, 1)
            wrong.hint = "The file begins with launch: and all actions are a list below it."
            raise wrong
        root = next(iter(tree))
        return Entity(tree[root], str(root), file=name, line=tree.lines.get(root, 1)), cls()

    @classmethod
    def get_file_extensions(cls) -> set[str]:
        """How such files end."""
        return {"launch.yaml", "launch.yml"}


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


def _hint(error: Any) -> str:
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
