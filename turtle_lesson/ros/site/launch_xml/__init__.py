"""`launch_xml`: launch files in XML (facts: launch_xml of ROS 2 Humble)."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Mapping
from pathlib import Path
from typing import Any, get_args
from xml.parsers import expat

from launch import LaunchDescription, frontend
from launch._entities import explained
from launch._package import complete_package
from launch.launch_description_sources import FrontendLaunchDescriptionSource
from launch.utilities import value_in_text

__all__ = ["Entity"]


class Element(ET.Element):
    """A tag that knows its line, counted from 1."""

    line: int | None = None


class Entity(frontend.Entity):
    """A tag, its attributes, and the tags in it. XML knows text only, so values are made what is asked for.

    An attribute `name-sep` says what parts the items of the list `name`.
    """

    TAGS, ATTRIBUTES = "nested tag(s)", "attribute(s)"

    def __init__(self, element: ET.Element, *, parent: frontend.Entity | None = None, file: str = "") -> None:
        super().__init__(element, element.tag, parent=parent, file=file, line=getattr(element, "line", None))

    @property
    def children(self) -> list[frontend.Entity]:
        """The tags in it."""
        self._asked[self.TAGS] |= set(self._given(self.TAGS))
        return self._nested("", self._element)

    def _given(self, kind: str) -> Mapping[str, Any]:
        if kind == self.ATTRIBUTES:
            return self._element.attrib
        return {inner.tag: self._element.findall(inner.tag) for inner in self._element}

    def _nested(self, name: str, given: list[ET.Element]) -> list[frontend.Entity]:
        return [Entity(inner, parent=self) for inner in given]

    def _value(self, name: str, data_type: Any, can_be_str: bool) -> Any:
        text, separator = self._element.get(name), self._element.get(f"{name}-sep")
        try:
            if separator is None:
                return value_in_text(text, data_type, can_be_str)
            self._asked[self.ATTRIBUTES].add(f"{name}-sep")
            item_type = next(iter(get_args(data_type)), None)
            items = text.split(separator) if separator else [text]
            return [value_in_text(item, item_type, can_be_str) for item in items]
        except ValueError:
            raise TypeError(
                f"Attribute '{name}' of Entity '{self.type_name}' expected to be of type '{data_type}'."
                f"'{text}' can not be converted to one of those types"
            ) from None


def read(file: str) -> Entity:
    """The root tag of a file. Raises xml.etree.ElementTree.ParseError if it is not well formed."""
    builder = ET.TreeBuilder(element_factory=Element)
    parser = expat.ParserCreate()

    def start(tag: str, attributes: dict[str, str]) -> None:
        builder.start(tag, attributes).line = parser.CurrentLineNumber  # type: ignore[attr-defined]

    parser.StartElementHandler = start
    parser.EndElementHandler = builder.end
    parser.CharacterDataHandler = builder.data
    try:
        parser.Parse(Path(file).read_text(encoding="utf-8-sig").encode(), True)
    except expat.ExpatError as error:
        hint = _HINTS.get(expat.ErrorString(error.code), "Are all tags closed, and all values in quotation marks?")
        raise explained(ET.ParseError(str(error)), hint, (file, error.lineno)) from None
    return Entity(builder.close(), file=file)


_HINTS = {
    "mismatched tag": "Every <tag> needs its </tag>, in the right order, or ends with />.",
    "not well-formed (invalid token)": "Put values in quotation marks; & is written &amp; and < is &lt;.",
    "no element found": "The file ends too early: is </launch> missing?",
    "junk after document element": "Put everything between <launch> and </launch>.",
    "unclosed token": "A tag is not closed: is > or a quotation mark missing?",
    "duplicate attribute": "A tag can have each attribute only once.",
    "syntax error": "Put everything in tags: the file begins with <launch>.",
}
"""What to try, by what the parser says of a text that is not well formed."""


class XMLLaunchDescriptionSource(FrontendLaunchDescriptionSource):
    """Gets the description from an XML launch file."""

    def _get_launch_description(self, location: str) -> LaunchDescription:
        return frontend.description_of(read(location))


complete_package("launch_xml", {"launch_xml.launch_description_sources": "XMLLaunchDescriptionSource"})
