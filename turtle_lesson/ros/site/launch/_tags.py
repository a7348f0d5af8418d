"""How the arguments of actions and substitutions are written in XML and YAML files.

An action's `_tag` says of each argument how it is read, as in `{"msg": text("message")}`. What is absent is None, and then
the constructor's default counts.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable, Container, Sequence
from typing import Any, TypeVar

from ._entities import Action, Substitution, explained
from .frontend import Entity, Parser, expose_substitution

Reader = Callable[[Entity, Parser], Any]


def text(name: str, *, optional: bool = False) -> Reader:
    """An attribute that is text with substitutions."""

    def read(entity: Entity, parser: Parser) -> list[Substitution] | None:
        value = entity.get_attr(name, optional=optional)
        return None if value is None else parser.parse_substitution(value)

    return read


def plain(name: str, *, optional: bool = False) -> Reader:
    """An attribute that is text, in which `$(…)` stands for nothing."""

    def read(entity: Entity, parser: Parser) -> str | None:
        value = entity.get_attr(name, optional=optional)
        return None if value is None else parser.escape_characters(value)

    return read


def typed(name: str, kind: type | None, *, optional: bool = True, can_be_str: bool = True) -> Reader:
    """An attribute of a type, or of any (None); with `can_be_str` substitutions may stand for it."""

    def read(entity: Entity, parser: Parser) -> Any:
        value = entity.get_attr(name, data_type=kind, optional=optional, can_be_str=can_be_str)
        return None if value is None else parser.parse_if_substitutions(value)

    return read


def tags(name: str, read: Reader) -> Reader:
    """The nested tags of a name, each of them read in the same way."""

    def read_all(entity: Entity, parser: Parser) -> list[Any] | None:
        found = []
        for tag in entity.get_attr(name, data_type=list[Entity], optional=True) or ():
            found.append(read(tag, parser))
            tag.assert_entity_completely_parsed()
        return found or None

    return read_all


def pair(first: str = "name", second: str = "value") -> Reader:
    """Two attributes that are text with substitutions; the first may be a key of a dictionary."""
    read_first, read_second = text(first), text(second)
    return lambda entity, parser: (tuple(read_first(entity, parser)), read_second(entity, parser))


def actions(*, without: Container[str] = ()) -> Reader:
    """The actions in a tag."""

    def read(entity: Entity, parser: Parser) -> list[Action]:
        return [parser.parse_action(child) for child in entity.children if child.type_name not in without]

    return read


Kind = TypeVar("Kind", bound=type[Substitution])


def expose_as(tag: str) -> Callable[[Kind], Kind]:
    """Let `$(tag …)` stand for a substitution; what follows the tag are the constructor's arguments, in order."""

    def expose(kind: Kind) -> Kind:
        known = inspect.signature(kind).parameters.values()
        least = sum(argument.default is argument.empty for argument in known)
        names = [argument.name for argument in known]

        def parse(cls: type, data: Sequence[Any]) -> tuple[type, dict[str, Any]]:
            """The class and its arguments."""
            if not least <= len(data) <= len(names):
                raise _wrong_number(tag, names, least)
            return cls, dict(zip(names, data, strict=False))

        kind.parse = classmethod(parse)  # type: ignore[attr-defined]
        return expose_substitution(tag)(kind)

    return expose


def _wrong_number(tag: str, names: list[str], least: int) -> TypeError:
    most = len(names)
    number = f"{least} {'or' if most == least + 1 else 'to'} {most}" if least < most else str(most or "no")
    error = TypeError(f"{tag} substitution expects {number} {'argument' if number == '1' else 'arguments'}")
    shown = " ".join([tag, *(f"<{name}>" for name in names)])
    return explained(error, f"Write $({shown}); put an argument with spaces in quotes.")
