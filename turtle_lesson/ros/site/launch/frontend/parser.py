"""`Parser`: a launch file in XML or YAML becomes a launch description."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any, TextIO

from ..invalid_launch_file_error import InvalidFrontendLaunchFileError
from ..substitution import Substitution
from .entity import Entity
from .expose import instantiate_action
from .parse_substitution import parse_substitution, replace_escaped_characters

if TYPE_CHECKING:
    from ..action import Action
    from ..launch_description import LaunchDescription

__all__ = ["InvalidFrontendLaunchFileError", "Parser"]

MOST_ACTIONS = 10_000
"""So many actions may stand in a file; YAML's anchors could make any number of them out of a few lines."""


class Parser:
    """Base of `launch_xml.Parser` and `launch_yaml.Parser`, which say how their text is read."""

    def __init__(self) -> None:
        self._actions = 0

    @classmethod
    def load(cls, file: str | TextIO) -> tuple[Entity, Parser]:
        """The root entity of a file, by the reader that its ending asks for, or else by any that can read it.

        Raises:
            InvalidFrontendLaunchFileError: if none can.
        """
        name, text = read(file)
        extension = Path(name).suffix.lstrip(".")
        readers = _implementations()
        first = readers.get("yaml" if extension == "yml" else extension)
        errors = []
        for reader in [*([first] if first else []), *(other for other in readers.values() if other is not first)]:
            try:
                return reader.load_text(text, name)
            except Exception as error:
                errors.append(error)
        raise InvalidFrontendLaunchFileError(extension if first else "", likely_errors=errors) from errors[0]

    @classmethod
    def load_text(cls, text: str, name: str) -> tuple[Entity, Parser]:
        """The root entity of a text; `name` is the file's, for messages."""
        raise NotImplementedError(f"{cls.__name__} does not say how to read a launch file")

    @classmethod
    def load_launch_extensions(cls) -> None:
        """Make all actions and substitutions known."""
        import launch_ros  # noqa: F401

    @classmethod
    def get_available_extensions(cls) -> list[str]:
        """The endings that there are readers for."""
        return list(_implementations())

    @classmethod
    def is_extension_valid(cls, extension: str) -> bool:
        """Whether there is a reader for files that end so."""
        return extension in _implementations()

    @classmethod
    def get_parser_from_extension(cls, extension: str) -> type[Parser]:
        """The reader for files that end so."""
        try:
            return _implementations()[extension]
        except KeyError:
            raise RuntimeError("Not recognized frontend implementation") from None

    def parse_action(self, entity: Entity) -> Action:
        """The action that an entity stands for."""
        self.load_launch_extensions()
        self._actions += 1
        if self._actions > MOST_ACTIONS:
            raise RuntimeError(f"a launch file of more than {MOST_ACTIONS} actions; does it repeat itself?")
        return instantiate_action(entity, self)

    def parse_substitution(self, value: str) -> list[Substitution]:
        """The pieces of a text with substitutions in it."""
        self.load_launch_extensions()
        return parse_substitution(value)

    def parse_if_substitutions(self, value: Any) -> Any:
        """A value, with substitutions where its texts have any."""
        from .parse_substitution import parse_if_substitutions

        self.load_launch_extensions()
        return parse_if_substitutions(value)

    def escape_characters(self, value: str) -> str:
        """The text without the backslashes that take a character's meaning away."""
        return replace_escaped_characters(value)

    def parse_description(self, entity: Entity) -> LaunchDescription:
        """The description that a root entity stands for.

        Raises:
            RuntimeError: if the root is not `launch`; and whatever is wrong below it.
        """
        from ..launch_description import LaunchDescription

        if entity.type_name != "launch":
            error = RuntimeError("Expected 'launch' as root tag")
            error.place = entity.place  # type: ignore[attr-defined]
            raise error
        try:
            deprecated = entity.get_attr("deprecated", optional=True)
            actions = [self.parse_action(child) for child in entity.children]
            entity.assert_entity_completely_parsed()
        except Exception as wrong:
            if getattr(wrong, "place", None) is None:
                wrong.place = entity.place  # type: ignore[attr-defined]
            raise
        return LaunchDescription(actions, deprecated_reason=deprecated)


def read(file: str | TextIO) -> tuple[str, str]:
    """The name of a file, or of an open one, and its text."""
    if isinstance(file, str | Path):
        return str(file), Path(file).read_text(encoding="utf-8-sig")
    return str(getattr(file, "name", "")), file.read()


def _implementations() -> dict[str, type[Parser]]:
    """The readers by the endings of their files."""
    import launch_xml
    import launch_yaml

    return {"xml": launch_xml.Parser, "yaml": launch_yaml.Parser}
