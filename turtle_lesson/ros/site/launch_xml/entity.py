"""`Entity`: one tag of an XML launch file."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from typing import Any

from launch.frontend import Entity as BaseEntity
from launch.frontend.type_utils import check_is_list_entity
from launch.utilities.type_utils import get_typed_value


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
        self.__parent = parent
        self.__file = file
        self.__lines = lines or {}
        self.__read: set[str] = set()
        self.__read_tags: set[str] = set()
        self.__asked: set[str] = set()
        self.__asked_tags: set[str] = set()
        if file and xml_element in self.__lines:
            self.place = (file, self.__lines[xml_element])

    @property
    def type_name(self) -> str:
        """The tag's name."""
        return self.__element.tag

    @property
    def parent(self) -> Entity | None:
        """The tag around it."""
        return self.__parent

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
        attributes = set(self.__element.attrib) - self.__read
        if attributes:
            raise self._unexpected("attribute(s)", attributes, self.__asked)

    def get_attr(self, name: str, *, data_type: Any = str, optional: bool = False, can_be_str: bool = True) -> Any:
        """As `launch.frontend.Entity.get_attr`; `name-sep` says what parts the items of a list."""
        if check_is_list_entity(data_type):
            return self._nested(name, data_type, optional)
        self.__asked.add(name)
        if name not in self.__element.attrib:
            if optional:
                return None
            raise self._absent(name, data_type, self.__element.attrib)
        self.__read.add(name)
        value: Any = self.__element.attrib[name]
        separator = self.__element.attrib.get(f"{name}-sep")
        if separator is not None:
            self.__read.add(f"{name}-sep")
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
