"""`launch_xml`: launch files in XML (facts: launch_xml of ROS 2 Humble)."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Mapping
from typing import Any
from xml.parsers import expat

from launch import frontend
from launch._entities import SomeSubstitutionsType, explained
from launch._package import complete_package
from launch.frontend import Entity as BaseEntity
from launch.launch_description_sources import FrontendLaunchDescriptionSource
from launch.utilities import get_typed_value

__all__ = ["Entity", "Parser"]


TAGS, ATTRIBUTES = "nested tag(s)", "attribute(s)"


class Element(ET.Element):
    """A tag that knows its line, counted from 1."""

    line: int | None = None


class Entity(BaseEntity):
    """A tag, its attributes, and the tags in it. XML knows text only, so values are made what is asked for.

    An attribute `name-sep` says what parts the items of the list `name`.
    """

    def __init__(self, xml_element: ET.Element, *, parent: BaseEntity | None = None, file: str = "") -> None:
        line = getattr(xml_element, "line", None)
        super().__init__(xml_element, xml_element.tag, parent=parent, file=file, line=line)

    @property
    def children(self) -> list[BaseEntity]:
        """The tags in it."""
        self._read[TAGS] = {inner.tag for inner in self._element}
        return [Entity(inner, parent=self) for inner in self._element]

    def _given(self) -> dict[str, Mapping[str, Any]]:
        return {
            TAGS: {inner.tag: self._element.findall(inner.tag) for inner in self._element},
            ATTRIBUTES: self._element.attrib,
        }

    def _nested(self, name: str, given: list[ET.Element]) -> list[BaseEntity]:
        return [Entity(inner, parent=self) for inner in given]

    def _value(self, name: str, given: Mapping[str, Any], data_type: Any, can_be_str: bool) -> Any:
        value, separator = given[name], given.get(f"{name}-sep")
        if separator is not None:
            self._read[ATTRIBUTES].add(f"{name}-sep")
            value = value.split(separator) if separator else [value]
        try:
            return get_typed_value(value, data_type, can_be_str=can_be_str)
        except ValueError:
            raise TypeError(
                f"Attribute '{name}' of Entity '{self.type_name}' expected to be of type '{data_type}'."
                f"'{value}' can not be converted to one of those types"
            ) from None


class Parser(frontend.Parser):
    """Reads XML."""

    @classmethod
    def load_text(cls, text: str, name: str) -> tuple[Entity, Parser]:
        """The root entity of a text. Raises xml.etree.ElementTree.ParseError if it is not well formed."""
        return Entity(_tree(text, name), file=name), cls()


def _tree(text: str, name: str) -> ET.Element:
    """The elements of a text."""
    builder = ET.TreeBuilder(element_factory=Element)
    parser = expat.ParserCreate()

    def start(tag: str, attributes: dict[str, str]) -> None:
        builder.start(tag, attributes).line = parser.CurrentLineNumber  # type: ignore[attr-defined]

    parser.StartElementHandler = start
    parser.EndElementHandler = builder.end
    parser.CharacterDataHandler = builder.data
    try:
        parser.Parse(text.encode(), True)
    except expat.ExpatError as error:
        raise explained(ET.ParseError(str(error)), _hint(error), (name, error.lineno)) from None
    return builder.close()


def _hint(error: expat.ExpatError) -> str:
    said = expat.ErrorString(error.code)
    return {
        "mismatched tag": "Every <tag> needs its </tag>, in the right order, or ends with />.",
        "not well-formed (invalid token)": "Put values in quotation marks; & is written &amp; and < is &lt;.",
        "no element found": "The file ends too early: is </launch> missing?",
        "junk after document element": "Put everything between <launch> and </launch>.",
        "unclosed token": "A tag is not closed: is > or a quotation mark missing?",
        "duplicate attribute": "A tag can have each attribute only once.",
        "syntax error": "Put everything in tags: the file begins with <launch>.",
    }.get(said, "Is this line well-formed: are tags closed, and values in quotation marks?")


class XMLLaunchDescriptionSource(FrontendLaunchDescriptionSource):
    """Gets the description from an XML launch file."""

    def __init__(self, launch_file_path: SomeSubstitutionsType) -> None:
        super().__init__(launch_file_path, method="interpreted XML launch file", parser=Parser)


complete_package("launch_xml", {"launch_xml.launch_description_sources": "XMLLaunchDescriptionSource"})
