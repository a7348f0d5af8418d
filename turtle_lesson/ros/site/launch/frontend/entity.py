"""`Entity`: one tag of an XML launch file, or one item of a YAML one, before it becomes an action."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from .._places import Place

MEANT = {
    "package": "pkg",
    "executable": "exec",
    "type": "exec",
    "ns": "namespace",
    "default_value": "default",
    "value": "default",
    "msg": "message",
    "text": "message",
    "arguments": "args",
    "path": "file",
}
"""What attributes are called in Python launch files or in ROS 1, and what they are called here."""


class Entity:
    """Base of `launch_xml.Entity` and `launch_yaml.Entity`, which say how their text is read.

    What is asked for (`get_attr`, `children`) is remembered, so that what nobody asks for can be refused.
    """

    place: Place | None = None
    """The file and line where it is written, if that is known."""

    @property
    def type_name(self) -> str:
        """What it is, such as `node`."""
        raise NotImplementedError

    @property
    def parent(self) -> Entity | None:
        """The entity around it, if it knows."""
        raise NotImplementedError

    @property
    def children(self) -> list[Entity]:
        """The entities in it."""
        raise NotImplementedError

    def assert_entity_completely_parsed(self) -> None:
        """Check that everything in it was asked for.

        Raises:
            ValueError: naming what nobody knows.
        """
        raise NotImplementedError

    def get_attr(self, name: str, *, data_type: Any = str, optional: bool = False, can_be_str: bool = True) -> Any:
        """An attribute's value, or the nested entities of that name if `data_type` is `List[Entity]`.

        Args:
            name: its name.
            data_type: bool, int, float, str, a list of one of these, List[Entity], or None for YAML's rules.
            optional: whether it may be absent; it is None then.
            can_be_str: whether text, which may have substitutions in it, is as good as the type.

        Raises:
            AttributeError: if it is absent.
            TypeError: if it is of another type.
        """
        raise NotImplementedError

    def _absent(self, name: str, data_type: Any, given: Iterable[Any]) -> AttributeError:
        """The error about an attribute that must be given; what was perhaps given instead is pointed out."""
        error = AttributeError(f"Attribute '{name}' of type '{data_type}' not found in Entity '{self.type_name}'")
        other = next((word for word in given if MEANT.get(word) == name), None)
        error.hint = (  # type: ignore[attr-defined]
            f"It is called {name} here, not {other}." if other else f"Give {self.type_name} the attribute {name}."
        )
        return error

    def _unexpected(self, what: str, names: set[str], known: set[str]) -> ValueError:
        """The error about names that nobody has asked for, with what was perhaps meant."""
        from turtle_lesson.ros.workspace.errors import did_you_mean

        listed = ", ".join(repr(name) for name in sorted(names, key=str))
        error = ValueError(f"Unexpected {what} found in `{self.type_name}`: {{{listed}}}")
        close = [MEANT.get(name) for name in sorted(names, key=str) if MEANT.get(name) in known]
        hints = [f"Did you mean '{name}'?" for name in close]
        hints += [did_you_mean(str(name)[:100], sorted(known)) for name in sorted(names, key=str)]
        takes = f"`{self.type_name}` can have: {', '.join(sorted(known))}." if known else ""
        error.hint = next(filter(None, hints), takes)  # type: ignore[attr-defined]
        return error
