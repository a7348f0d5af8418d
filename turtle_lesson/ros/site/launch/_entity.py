"""What stands in an XML or YAML launch file, whichever it is: tags with attributes, and with further tags in them."""

from __future__ import annotations

from typing import Any, get_args

from turtle_lesson.ros.idl.names import did_you_mean

from ._entities import Place, explained
from .utilities import is_of_type, value_in_text

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


class Mapping(dict[Any, Any]):
    """What stands in a tag, by name: the values of its attributes, and for each name of tags in it a list of them.

    `line` is where it begins, counted from 1. In XML, `in_xml` has all of these tags in their order, each as YAML writes it, a
    mapping of its name alone.
    """

    def __init__(self, line: int, given: dict[str, Any] | None = None, in_xml: list[Mapping] | None = None) -> None:
        super().__init__(given or {})
        self.line = line
        self.in_xml = in_xml


class Entity:
    """A tag of a launch file, which was written at `place`.

    What is asked for (`get_attr`, `nested`, `children`) is remembered, so that what nobody asks for can be refused.
    """

    def __init__(self, type_name: str, inside: Any, place: Place) -> None:
        if isinstance(inside, list | None):
            inside = Mapping(place[1], {} if inside is None else {"children": inside})
        if not isinstance(inside, Mapping):
            error = TypeError(f"Expected a dict or list, got {type(inside)}")
            raise explained(error, f"Write the attributes of {type_name} below it, each on a line of its own.", place)
        self.type_name = type_name
        self.place = place
        self._inside = inside
        self._asked: set[str] = set()

    @property
    def children(self) -> list[Entity]:
        """The tags in it. In YAML they are its list, or the list called `children` in its mapping."""
        below = self._inside.in_xml
        if below is None:
            self._asked.add("children")
            below = self._inside.get("children")
        if not isinstance(below, list):
            what = f"Expected entity `{self.type_name}` to have children entities."
            raise explained(ValueError(what), "Write them as a list below it, each indented and with a hyphen: - node:")
        found = []
        for item in below:
            if not isinstance(item, Mapping) or len(item) != 1:
                error = RuntimeError("Subentity must be a dictionary with only one key, which is the entity type")
                hint = "Write each item as - node: (or another action), and indent what belongs to it deeper."
                line = item.line if isinstance(item, Mapping) else self.place[1]
                raise explained(error, hint, (self.place[0], line))
            [(name, inside)] = item.items()
            if self._inside.in_xml is not None:
                self._asked.add(name)
            found.append(Entity(str(name), inside, (self.place[0], item.line)))
        return found

    def nested(self, name: str) -> list[Entity]:
        """The tags of a name in it."""
        self._asked.add(name)
        given = self._inside.get(name, [])
        if not isinstance(given, list) or not all(isinstance(item, Mapping) for item in given):
            error = TypeError(f"Attribute '{name}' of Entity '{self.type_name}' expected to be a list of dictionaries.")
            raise explained(error, f"Write each {name} as a tag of its own; in YAML it begins with a hyphen.")
        return [Entity(name, item, (self.place[0], item.line)) for item in given]

    def get_attr(self, name: str, *, data_type: Any = str, optional: bool = False, can_be_str: bool = True) -> Any:
        """An attribute's value.

        The type is bool, int, float, str, a list of one of these, or None for YAML's rules; with `can_be_str`, text,
        which may have substitutions in it, is as good. Raises AttributeError if it is absent and not optional, and
        TypeError for another type.
        """
        self._asked.add(name)
        value: Any = self._inside.get(name)
        if name not in self._inside:
            if optional:
                return None
            other = next((f"not {word}" for word in self._inside if MEANT.get(word) == name), "and is needed")
            what = f"Attribute '{name}' of type '{data_type}' not found in Entity '{self.type_name}'"
            raise explained(AttributeError(what), f"It is called {name} here, {other}.")
        expected = f"Attribute '{name}' of Entity '{self.type_name}' expected to be of type '{data_type}'"
        if self._inside.in_xml is not None and isinstance(value, str):
            try:
                return self._value_in_text(name, value, data_type, can_be_str)
            except ValueError:
                raise TypeError(f"{expected}.'{value}' can not be converted to one of those types") from None
        if not is_of_type(value, data_type, can_be_str):
            hint = f"Write {name} as an attribute, with its value in quotation marks."
            raise explained(TypeError(f"{expected}, got '{type(value)}'"), hint if data_type is str else "")
        return value

    def _value_in_text(self, name: str, text: str, data_type: Any, can_be_str: bool) -> Any:
        """XML knows text only. An attribute `name-sep` says what parts the items of the list `name`."""
        separator = self._inside.get(f"{name}-sep")
        if separator is None:
            return value_in_text(text, data_type, can_be_str)
        self._asked.add(f"{name}-sep")
        item_type = next(iter(get_args(data_type)), None)
        items = text.split(separator) if separator else [text]
        return [value_in_text(item, item_type, can_be_str) for item in items]

    def ignore_rest(self) -> None:
        """Pass over whatever was not asked for, as the way in which an action reads its tag."""
        self._asked.update(self._inside)

    def assert_entity_completely_parsed(self) -> None:
        """Check that everything in it was asked for. Raises ValueError naming what nobody knows, and what was perhaps meant."""
        names, kind = sorted(self._inside.keys() - self._asked, key=str), "key(s)"
        if self._inside.in_xml is not None:
            nested = [name for name in names if isinstance(self._inside[name], list)]
            names, kind = (nested, "nested tag(s)") if nested else (names, "attribute(s)")
        if names:
            what = f"Unexpected {kind} found in `{self.type_name}`: {{{', '.join(map(repr, names))}}}"
            known = sorted(self._asked)
            hints = [f"Did you mean '{MEANT[name]}'?" for name in names if MEANT.get(name) in known]
            hints += [did_you_mean(str(name)[:100], known) for name in names]
            raise explained(ValueError(what), next(filter(None, hints), f"It can have: {', '.join(known)}."))
