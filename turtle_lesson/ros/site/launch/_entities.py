"""What a launch description is made of: entities, actions, conditions and substitutions, and the description itself."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterable, Iterator, Mapping
from traceback import walk_stack
from typing import TYPE_CHECKING, Any, ClassVar, TypeVar, Union

from turtle_lesson.ros.sim.errors import is_ours

if TYPE_CHECKING:
    from ._context import LaunchContext
    from .actions import DeclareLaunchArgument, IncludeLaunchDescription
    from .frontend import Entity

    ArgumentWithIncludes = tuple[DeclareLaunchArgument, list[IncludeLaunchDescription]]


SomeSubstitutionsType = Union[str, "Substitution", Iterable[Union[str, "Substitution"]]]
SomeActionsType = Union["Action", Iterable["Action"]]
SomeEntitiesType = Union["LaunchDescriptionEntity", Iterable["LaunchDescriptionEntity"]]


class Substitution:
    """Base of everything that stands for text in a launch description.

    Those here are dataclasses, whose fields become lists of substitutions.
    """

    _shown = ""
    """How one is shown, with the names of its fields in braces; if empty, by its class and all fields."""

    def __post_init__(self) -> None:
        for name, value in vars(self).items():
            if value is not None:
                setattr(self, name, normalize_to_list_of_substitutions(value))

    def perform(self, context: LaunchContext) -> str:
        """The text, in this context."""
        raise NotImplementedError(f"{type(self).__name__} must define perform(self, context)")

    def __repr__(self) -> str:
        return self.describe()

    def describe(self) -> str:
        """How `--show-args` shows it."""
        values = {name: described(value) for name, value in vars(self).items() if isinstance(value, list)}
        return self._shown.format(**values) if self._shown else f"{type(self).__name__}({', '.join(values.values())})"


def described(pieces: Iterable[Substitution]) -> str:
    """How pieces of a text are shown."""
    return " + ".join(piece.describe() for piece in pieces)


class TextSubstitution(Substitution):
    """Text that is known beforehand."""

    def __init__(self, *, text: str) -> None:
        if not isinstance(text, str):
            raise TypeError(f"TextSubstitution expected Text object got '{type(text)}' instead.")
        self.text = text

    def describe(self) -> str:
        """The text in quotation marks."""
        return f"'{self.text}'"

    def perform(self, context: LaunchContext) -> str:
        """The text."""
        return self.text


def normalize_to_list_of_substitutions(subs: SomeSubstitutionsType) -> list[Substitution]:
    """A list of substitutions, whether text, one substitution, or several of both were given."""
    found = []
    for part in [subs] if isinstance(subs, str | Substitution) or not isinstance(subs, Iterable) else subs:
        if not isinstance(part, str | Substitution):
            raise TypeError(
                f"Failed to normalize given item of type '{type(part)}', when only "
                "'str' or 'launch.Substitution' were expected."
            )
        found.append(TextSubstitution(text=part) if isinstance(part, str) else part)
    return found


def perform_substitutions(context: LaunchContext, subs: Iterable[Substitution]) -> str:
    """The texts of all, joined."""
    return "".join([part.perform(context) for part in subs])


def text_of(context: LaunchContext, given: SomeSubstitutionsType) -> str:
    """The text of whatever can stand for text."""
    return perform_substitutions(context, normalize_to_list_of_substitutions(given))


class LaunchDescriptionEntity:
    """Base of descriptions and actions. Visiting one gives the entities that are to be visited next."""

    def visit(self, context: LaunchContext) -> list[LaunchDescriptionEntity] | None:
        """Do what it stands for; return further entities, or None."""
        return None

    def describe_sub_entities(self) -> list[LaunchDescriptionEntity]:
        """The entities that it will give, as far as that is known beforehand."""
        return []

    def describe_conditional_sub_entities(self) -> list[LaunchDescriptionEntity]:
        """The entities that it may give."""
        return []


class Condition:
    """Wraps a predicate of the context; no predicate always holds."""

    def __init__(self, *, predicate: Callable[[LaunchContext], bool] | None = None) -> None:
        self._predicate = predicate

    def evaluate(self, context: LaunchContext) -> bool:
        """Whether it holds now."""
        return self._predicate is None or self._predicate(context)


Place = tuple[str, int]
"""A file and a line in it, counted from 1."""


def written_at() -> Place | None:
    """The file and line of the innermost caller that is not part of the simulation's own code."""
    for frame, line in walk_stack(sys._getframe(1)):
        if not is_ours(frame.f_code.co_filename):
            return frame.f_code.co_filename, line
    return None


Failure = TypeVar("Failure", bound=BaseException)


def explained(error: Failure, hint: str = "", place: Place | None = None) -> Failure:
    """The error, with what to try and the place to look at, which are said below its text; what it has already counts."""
    for name, value in (("hint", hint), ("place", place)):
        if value and not getattr(error, name, None):
            setattr(error, name, value)
    return error


class Action(LaunchDescriptionEntity):
    """Base of all actions. A subclass says in `execute` what it does."""

    _completes_later = False
    _tag: ClassVar[Mapping[str, Callable[[Entity], Any]]] = {}
    """How each argument of the constructor is read from a tag of an XML or YAML file; `frontend.py` has the functions."""

    def __init__(self, *, condition: Condition | None = None) -> None:
        self.condition = condition
        self._written_at = written_at()

    def __repr__(self) -> str:
        return f"<{type(self).__module__}.{type(self).__qualname__} object>"

    def visit(self, context: LaunchContext) -> list[LaunchDescriptionEntity] | None:
        """Carry it out if its condition holds."""
        if self.condition is not None and not self.condition.evaluate(context):
            return None
        entities = self.execute(context)
        if not self._completes_later:
            self._complete(context)
        return entities

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity] | None:
        """What the action does; returns further entities to visit, or None."""
        return None

    def _complete(self, context: LaunchContext) -> None:
        """Tell the waiting callers that the action is done."""
        from .events import ExecutionComplete

        event = ExecutionComplete(action=self)
        if context.would_handle_event(event):
            context.emit_event_sync(event)


class LaunchDescription(LaunchDescriptionEntity):
    """What a launch file's `generate_launch_description()` returns: entities, in order."""

    def __init__(self, initial_entities: Iterable[LaunchDescriptionEntity] | None = None) -> None:
        self.entities = list(initial_entities or [])

    def add_entity(self, entity: LaunchDescriptionEntity) -> None:
        """Append an entity."""
        self.entities.append(entity)

    def add_action(self, action: Action) -> None:
        """Append an action."""
        self.add_entity(action)

    def describe_sub_entities(self) -> list[LaunchDescriptionEntity]:
        """Its entities."""
        return self.entities

    def visit(self, context: LaunchContext) -> list[LaunchDescriptionEntity] | None:
        """Give its entities."""
        return self.entities

    def get_launch_arguments(self) -> list[DeclareLaunchArgument]:
        """The arguments that it and what it includes declare."""
        return [argument for argument, _ in self.get_launch_arguments_with_include_launch_description_actions()]

    def get_launch_arguments_with_include_launch_description_actions(self) -> list[ArgumentWithIncludes]:
        """Each declared argument, with the includes that lead to it; the first declaration of a name counts."""
        found: dict[str, ArgumentWithIncludes] = {}
        for argument, includes in _declared(self.entities, False, []):
            found.setdefault(argument.name, (argument, includes))
        return list(found.values())


def _declared(
    entities: Iterable[LaunchDescriptionEntity], conditional: bool, includes: list[IncludeLaunchDescription]
) -> Iterator[ArgumentWithIncludes]:
    """The arguments declared in `entities`, with the includes that lead to each."""
    from .actions import DeclareLaunchArgument, IncludeLaunchDescription

    for entity in entities:
        only_if = conditional or (isinstance(entity, Action) and entity.condition is not None)
        if isinstance(entity, DeclareLaunchArgument):
            entity._conditionally_included = only_if
            yield entity, includes
        inner = includes
        below = entity.describe_sub_entities()
        if isinstance(entity, IncludeLaunchDescription):
            location = entity.launch_description_source.location
            if location in [outer.launch_description_source.location for outer in includes]:
                continue  # a file that includes itself takes no other arguments within itself
            inner = [*includes, entity]
        yield from _declared(below, only_if, inner)
        yield from _declared(entity.describe_conditional_sub_entities(), True, inner)
