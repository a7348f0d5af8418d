"""`launch_xml`: launch files in XML (facts: launch_xml of ROS 2 Humble)."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from pathlib import Path
from xml.parsers import expat

from launch._entities import explained
from launch._entity import Mapping
from launch._package import complete_package
from launch.frontend import Entity
from launch.launch_description_sources import FrontendLaunchDescriptionSource


def read(file: str) -> Entity:
    """The root tag of a file. Raises xml.etree.ElementTree.ParseError if it is not well formed."""
    open_tags = [Mapping(1)]
    parser = expat.ParserCreate()

    def start(name: str, attributes: dict[str, str]) -> None:
        outer, inner = open_tags[-1], Mapping(parser.CurrentLineNumber, attributes, in_xml=[])
        if not isinstance(outer.get(name), list):
            outer[name] = []
        outer[name].append(inner)
        if outer.in_xml is not None:
            outer.in_xml.append(Mapping(inner.line, {name: inner}))
        open_tags.append(inner)

    parser.StartElementHandler = start
    parser.EndElementHandler = lambda name: open_tags.pop()
    try:
        parser.Parse(Path(file).read_text(encoding="utf-8-sig").encode(), True)
    except expat.ExpatError as error:
        hint = _HINTS.get(expat.ErrorString(error.code), "Are all tags closed, and all values in quotation marks?")
        raise explained(ET.ParseError(str(error)), hint, (file, error.lineno)) from None
    [(name, [root])] = open_tags[0].items()
    return Entity(name, root, (file, root.line))


_HINTS = {
    "mismatched tag": "Every <tag> needs its </tag>, in the right order, or ends with />.",
    "not well-formed (invalid token)": "Put values in quotation marks; & is written &amp; and < is &lt;.",
    "no element found": "The file ends too early: is </launch> missing?",
    "junk after document element": "Put everything between <launch> and </launch>.",
}
"""What to try, by what the parser says of a text that is not well formed."""


class XMLLaunchDescriptionSource(FrontendLaunchDescriptionSource):
    """Gets the description from an XML launch file."""

    _read = staticmethod(read)


complete_package("launch_xml")
