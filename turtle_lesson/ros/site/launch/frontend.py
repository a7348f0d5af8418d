"""Launch files that are not Python: from XML or YAML text to actions (facts: launch.frontend of ROS 2 Humble).

An action's `_tag` says of each argument of its constructor how it is read from a tag, as in `{"msg": attribute("message")}`.
What is absent is None, and then the constructor's default counts. `launch_xml` and `launch_yaml` read the two formats.
"""

from __future__ import annotations

import inspect
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, TypeVar, dataclass_transform

from turtle_lesson.ros.idl.names import did_you_mean

from ._entities import Action, LaunchDescription, Substitution, TextSubstitution, explained
from ._entity import Entity

__all__ = ["Entity", "parse_substitution"]


# -- how the arguments of an action are read from its tag ----------------------------------------------------------------

Reader = Callable[[Entity], Any]


def attribute(name: str, data_type: Any = str, *, optional: bool = False, can_be_str: bool = True) -> Reader:
    """An attribute of a type, or of any (None); with `can_be_str` substitutions may stand for it."""

    def read(entity: Entity) -> Any:
        value = entity.get_attr(name, data_type=data_type, optional=optional, can_be_str=can_be_str)
        return [_parsed(item) for item in value] if isinstance(value, list) else _parsed(value)

    return read


def _parsed(value: Any) -> Any:
    """A value, in whose text `$(…)` stands for something; text without it stays text, and other values as they are."""
    pieces = parse_substitution(value) if isinstance(value, str) else []
    if len(pieces) == 1 and isinstance(pieces[0], TextSubstitution):
        return pieces[0].text
    return pieces or value


def plain(name: str, *, optional: bool = False) -> Reader:
    """An attribute that is text, in which `$(…)` stands for nothing."""

    def read(entity: Entity) -> str | None:
        value = entity.get_attr(name, optional=optional)
        return None if value is None else _without_backslashes(value)

    return read


def tags(name: str, read: Reader) -> Reader:
    """The nested tags of a name, each of them read in the same way."""

    def read_all(entity: Entity) -> list[Any] | None:
        found = []
        for tag in entity.nested(name):
            found.append(read(tag))
            tag.assert_entity_completely_parsed()
        return found or None

    return read_all


def pair(first: str = "name", second: str = "value") -> Reader:
    """Two attributes that are text with substitutions."""
    read_first, read_second = attribute(first), attribute(second)
    return lambda entity: (read_first(entity), read_second(entity))


def actions(entity: Entity) -> list[Action]:
    """The actions in a tag."""
    return [action_of(child) for child in entity.children]


# -- which action or substitution a name stands for ----------------------------------------------------------------------

_actions: dict[str, type[Action]] = {}
_substitutions: dict[str, type[Substitution]] = {}
Kind = TypeVar("Kind", bound=type)


def expose_action(name: str) -> Callable[[Kind], Kind]:
    """Let a tag of this name stand for an action: decorates its class."""

    def expose(kind: Kind) -> Kind:
        _actions[name] = kind
        return kind

    return expose


@dataclass_transform(eq_default=False, field_specifiers=(field,))
def expose_substitution(name: str) -> Callable[[Kind], Kind]:
    """Let `$(name …)` stand for a substitution: makes its class a dataclass, whose fields follow the name, in order."""

    def expose(kind: Kind) -> Kind:
        _substitutions[name] = dataclass(repr=False, eq=False)(kind)
        return kind

    return expose


def _named(known: Mapping[str, Kind], name: str, complaint: str) -> Kind:
    if name in known:
        return known[name]
    hint = did_you_mean(name[:100], known) or f"Available here are: {', '.join(sorted(known))}."
    raise explained(RuntimeError(f"{complaint}{name}"), hint)


def action_of(entity: Entity) -> Action:
    """The action that a tag stands for.

    Raises RuntimeError if no action has this name, or it has both `if` and `unless`; and whatever is wrong with what is
    written in it, with the place.
    """
    from .conditions import IfCondition, UnlessCondition

    try:
        kind = _named(_actions, entity.type_name, "Unrecognized entity of the type: ")
        conditions = [
            condition(parse_substitution(text))
            for name, condition in (("if", IfCondition), ("unless", UnlessCondition))
            if (text := entity.get_attr(name, optional=True)) is not None
        ]
        if len(conditions) > 1:
            raise RuntimeError("if and unless conditions can't be used simultaneously")
        arguments: dict[str, Any] = {"condition": next(iter(conditions), None)}
        for name, read in kind._tag.items():
            if (value := read(entity)) is not None:
                arguments[name] = value
        entity.assert_entity_completely_parsed()
        action = kind(**arguments)
    except Exception as error:
        explained(error, place=entity.place)
        raise
    action._written_at = entity.place
    return action


def description_of(root: Entity) -> LaunchDescription:
    """The description that a root tag stands for.

    Raises RuntimeError if the root is not `launch`; and whatever is wrong below it.
    """
    import launch_ros  # noqa: F401  (makes its actions known)

    try:
        if root.type_name != "launch":
            raise RuntimeError("Expected 'launch' as root tag")
        description = LaunchDescription(actions(root))
        root.assert_entity_completely_parsed()
        return description
    except Exception as error:
        explained(error, place=root.place)
        raise


def read_launch_file(file: str) -> Entity:
    """The root tag of a file: YAML if its name ends so, otherwise XML. Raises what the reader of its format raises."""
    import launch_xml
    import launch_yaml

    return (launch_yaml if file.endswith((".yaml", ".yml")) else launch_xml).read(file)


# -- `$(…)` in a text ----------------------------------------------------------------------------------------------------


class SubstitutionSyntaxError(ValueError):
    """A text's `$(…)` are not well formed."""


def _without_backslashes(text: str) -> str:
    """The text without the backslashes that take a character's meaning away."""
    return re.sub(r"\\(.?)", r"\1", text, flags=re.DOTALL)


def parse_substitution(string_value: str) -> list[Substitution]:
    """The pieces of a text: what is plain, and what stands for something.

    Raises SubstitutionSyntaxError if a `$(` is not closed, or is otherwise wrong.
    """
    try:
        return _Reader(string_value).pieces("", "") or [TextSubstitution(text=string_value)]
    except RecursionError:
        raise SubstitutionSyntaxError("the substitutions are nested too deeply") from None


class _Reader:
    """Reads one text from left to right. Within quotation marks, `quote`, such a mark ends everything."""

    def __init__(self, text: str) -> None:
        self._text = text
        self._at = 0

    def _take(self, pattern: str) -> str:
        """What matches here, and go on behind it; nothing if it does not match."""
        match = re.compile(pattern, re.DOTALL).match(self._text, self._at)
        if match is None:
            return ""
        self._at = match.end()
        return match[0]

    def pieces(self, stops: str, quote: str) -> list[Substitution]:
        """Everything up to one of these characters, or to the end."""
        found: list[Substitution] = []
        while self._at < len(self._text) and self._text[self._at] not in stops:
            if plain := self._take(rf"(?:\\.?|[^\\${stops}])+"):
                found.append(TextSubstitution(text=_without_backslashes(plain)))
            elif self._take(r"\$\("):
                found.append(self._substitution(quote))
            else:
                raise self._wrong(r"A dollar sign that begins no $(…) is written \$.")
        return found

    def _substitution(self, quote: str) -> Substitution:
        """What begins with a `$(`, which has been taken."""
        begin = self._at - len("$(")
        name = self._take("[A-Za-z][A-Za-z0-9_-]*")
        if not name:
            raise self._wrong("After $( comes the name of a substitution, as in $(var rate).")
        arguments = []
        while self._take(" "):
            arguments.append(self._argument(quote))
        if not self._take(r"\)"):
            raise self._wrong(f"Is the bracket of {self._text[begin : begin + 20]!r} closed?")
        return _substitution_of(name, arguments)

    def _argument(self, quote: str) -> list[Substitution]:
        mark = "" if quote else self._take("['\"]")
        found = self.pieces(mark or (quote or "'\"") + " ()", mark or quote)
        if (mark and not self._take(mark)) or not (mark or found):
            raise self._wrong("Separate arguments by one space; put an argument with spaces in quotes.")
        return found or [TextSubstitution(text="")]

    def _wrong(self, hint: str) -> SubstitutionSyntaxError:
        what = f"the text {self._text!r} is not understood from character {self._at + 1} on"
        return explained(SubstitutionSyntaxError(what), hint)


def _substitution_of(name: str, arguments: Sequence[list[Substitution]]) -> Substitution:
    """What `$(name arguments…)` stands for.

    Raises RuntimeError if there is no such substitution, and TypeError for a wrong number of arguments.
    """
    kind = _named(_substitutions, name, "Unknown substitution: ")
    known = inspect.signature(kind).parameters.values()
    if not sum(each.default is each.empty for each in known) <= len(arguments) <= len(known):
        shown = " ".join([name, *(f"<{each.name}>" for each in known)])
        error = TypeError(f"the substitution {name} cannot have {len(arguments)} arguments")
        raise explained(error, f"Write $({shown}); put an argument with spaces in quotes.")
    return kind(**{each.name: given for each, given in zip(known, arguments, strict=False)})
