"""`Parser`: the text of an XML launch file becomes entities that know their line."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from typing import TextIO
from xml.parsers import expat

from launch import frontend
from launch.frontend.parser import read

from .entity import Entity


class Parser(frontend.Parser):
    """Reads XML."""

    @classmethod
    def load(cls, file: str | TextIO) -> tuple[Entity, Parser]:
        """The root entity of a file."""
        name, text = read(file)
        return cls.load_text(text, name)

    @classmethod
    def load_text(cls, text: str, name: str) -> tuple[Entity, Parser]:
        """The root entity of a text.

        Raises:
            xml.etree.ElementTree.ParseError: if it is not well formed.
        """
        lines: dict[ET.Element, int] = {}
        return Entity(_tree(text, name, lines), file=name, lines=lines), cls()

    @classmethod
    def get_file_extensions(cls) -> set[str]:
        """How such files end."""
        return {"launch.xml"}


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
        broken = ET.ParseError(str(error))
        broken.place = (name, error.lineno)  # type: ignore[attr-defined]
        broken.hint = _hint(error)  # type: ignore[attr-defined]
        raise broken from None
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
