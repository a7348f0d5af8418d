"""`launch_xml`: launch files in XML (facts: launch_xml of ROS 2 Humble)."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from typing import Any
from xml.parsers import expat

from launch import frontend
from launch._entities import SomeSubstitutionsType, explained
from launch._package import complete_package
from launch.frontend import Entity as BaseEntity
from launch.frontend import check_is_list_entity
from launch.launch_description_sources import FrontendLaunchDescriptionSource
from launch.utilities import get_typed_value

__all__ = ["Entity", "Parser"]


class Entity(BaseEntity):
    """A tag, its attributes, and the tags in it. XML knows text only, so values are made what is asked for."""

    def __init__(
        self,
        xml_element: ET.Element,
        *,
        parent: Entity | None = None,
        file: str = "",
        lines: dict[ET.Element, int] | None = None,
    ) -> None:
        self.__element = xml_element
        self.__file = file
        self.__lines = lines or {}
        self.__read_tags: set[str] = set()
        self.__asked_tags: set[str] = set()
        line = self.__lines.get(xml_element)
        super().__init__(xml_element.tag, parent, (file, line) if file and line is not None else None)

    @property
    def children(self) -> list[BaseEntity]:
        """The tags in it."""
        self.__read_tags = {inner.tag for inner in self.__element}
        return [self._inner(inner) for inner in self.__element]

    def _inner(self, element: ET.Element) -> Entity:
        return Entity(element, parent=self, file=self.__file, lines=self.__lines)

    def assert_entity_completely_parsed(self) -> None:
        """Check that every attribute and tag in it was asked for."""
        tags = {inner.tag for inner in self.__element} - self.__read_tags
        if tags:
            raise self._unexpected("nested tag(s)", tags, self.__asked_tags)
        attributes = set(self.__element.attrib) - self._read
        if attributes:
            raise self._unexpected("attribute(s)", attributes, self._asked)

    def get_attr(self, name: str, *, data_type: Any = str, optional: bool = False, can_be_str: bool = True) -> Any:
        """As `launch.frontend.Entity.get_attr`; `name-sep` says what parts the items of a list."""
        if check_is_list_entity(data_type):
            return self._nested(name, data_type, optional)
        self._asked.add(name)
        if name not in self.__element.attrib:
            if optional:
                return None
            raise self._absent(name, data_type, self.__element.attrib)
        self._read.add(name)
        value: Any = self.__element.attrib[name]
        separator = self.__element.attrib.get(f"{name}-sep")
        if separator is not None:
            self._read.add(f"{name}-sep")
            value = value.split(separator) if separator else [value]
        try:
            return get_typed_value(value, data_type, can_be_str=can_be_str)
        except ValueError:
            raise TypeError(
                f"Attribute '{name}' of Entity '{self.type_name}' expected to be of type '{data_type}'."
                f"'{value}' can not be converted to one of those types"
            ) from None

    def _nested(self, name: str, data_type: Any, optional: bool) -> list[Entity] | None:
        self.__asked_tags.add(name)
        found = [inner for inner in self.__element if inner.tag == name]
        if found:
            self.__read_tags.add(name)
            return [self._inner(inner) for inner in found]
        if optional:
            return None
        raise self._absent(name, data_type, [])


class Parser(frontend.Parser):
    """Reads XML."""

    @classmethod
    def load_text(cls, text: str, name: str) -> tuple[Entity, Parser]:
        """The root entity of a text.

        Raises:
            xml.etree.ElementTree.ParseError: if it is not well formed.
        """
        lines: dict[ET.Element, int] = {}
        return Entity(_tree(text, name, lines), file=name, lines=lines), cls()


def _tree(text: str, name: str, lines: dict[ET.Element, int]) -> ET.Element:
    """The elements of a text; `lines` gets the line of each."""
    builder = ET.TreeBuilder()
    parser = expat.ParserCreate()

    def start(tag: str, attributes: dict[str, str]) -> None:
        lines[builder.start(tag, attributes)] = parser.CurrentLineNumber

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
