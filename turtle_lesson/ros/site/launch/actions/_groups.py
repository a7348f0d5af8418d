"""Actions that give further actions: groups, included launch files, timers and functions."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Mapping
from typing import Any

from turtle_lesson.ros.ament import catalog
from turtle_lesson.ros.ament.errors import NotHereError

from .._context import EventHandler, LaunchContext
from .._entities import Action, LaunchDescription, LaunchDescriptionEntity, SomeSubstitutionsType, Substitution
from ..event_handlers import OnShutdown
from ..events import TimerEvent
from ..frontend import Entity, InvalidLaunchFileError, Parser, expose_action
from ..launch_description_sources import AnyLaunchDescriptionSource, LaunchDescriptionSource
from ..utilities import ensure_argument_type, normalize_to_list_of_substitutions, perform_substitutions
from ._configuration import (
    PopEnvironment,
    PopLaunchConfigurations,
    PushEnvironment,
    PushLaunchConfigurations,
    ResetEnvironment,
    ResetLaunchConfigurations,
    SetLaunchConfiguration,
    kept,
)


@expose_action("group")
class GroupAction(Action):
    """Gives its actions; in a scope, what they set is forgotten at the end.

    Args:
        actions: what is in the group.
        scoped: whether it has a scope of its own.
        forwarding: whether the scope begins with what was set outside.
        launch_configurations: what is set at the beginning.
    """

    def __init__(
        self,
        actions: Iterable[Action],
        *,
        scoped: bool = True,
        forwarding: bool = True,
        launch_configurations: Mapping[SomeSubstitutionsType, SomeSubstitutionsType] | None = None,
        **left_over_kwargs: Any,
    ) -> None:
        super().__init__(**left_over_kwargs)
        self.__actions = list(actions)
        self.__scoped = scoped
        self.__forwarding = forwarding
        self.__launch_configurations = dict(launch_configurations or {})

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[type, dict[str, Any]]:
        """Its arguments from `scoped`, `forwarding`, nested `keep` tags and the actions in it."""
        _, kwargs = super().parse(entity, parser)
        for name in ("scoped", "forwarding"):
            value = entity.get_attr(name, data_type=bool, optional=True, can_be_str=False)
            if value is not None:
                kwargs[name] = value
        if configurations := kept(entity, parser):
            kwargs["launch_configurations"] = configurations
        kwargs["actions"] = [parser.parse_action(child) for child in entity.children if child.type_name != "keep"]
        return cls, kwargs

    def describe_sub_entities(self) -> list[LaunchDescriptionEntity]:
        """What it gives."""
        return self.get_sub_entities() if self.condition is None else []

    def describe_conditional_sub_entities(
        self,
    ) -> list[tuple[str, Iterable[LaunchDescriptionEntity]]]:
        """What it gives if its condition holds."""
        return [] if self.condition is None else [("if its condition holds", self.get_sub_entities())]

    def get_sub_entities(self) -> list[LaunchDescriptionEntity]:
        """Its actions, between those that begin and end the scope."""
        sets = [SetLaunchConfiguration(name, value) for name, value in self.__launch_configurations.items()]
        if not self.__scoped:
            return [*sets, *self.__actions]
        begin: list[LaunchDescriptionEntity] = [PushLaunchConfigurations(), PushEnvironment()]
        if self.__forwarding:
            begin += sets
        else:
            begin += [ResetEnvironment(), ResetLaunchConfigurations(self.__launch_configurations)]
        return [*begin, *self.__actions, PopEnvironment(), PopLaunchConfigurations()]

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity] | None:
        """Give them."""
        return self.get_sub_entities()


DEEPEST = 50
"""So many launch files may lie within one another."""

_PLACES = ("current_launch_file_directory", "current_launch_file_path")


class MissingLaunchArgumentError(RuntimeError):
    """An included launch file needs an argument that was not given."""

    def __init__(self, message: str, argument: str) -> None:
        super().__init__(message)
        self.argument = argument


@expose_action("include")
class IncludeLaunchDescription(Action):
    """Includes a launch description; its arguments are given as pairs of name and value."""

    def __init__(
        self,
        launch_description_source: LaunchDescriptionSource | SomeSubstitutionsType,
        *,
        launch_arguments: Iterable[tuple[SomeSubstitutionsType, SomeSubstitutionsType]] | None = None,
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        if not isinstance(launch_description_source, LaunchDescriptionSource):
            launch_description_source = AnyLaunchDescriptionSource(launch_description_source)
        self.__source = launch_description_source
        if isinstance(launch_arguments, Mapping):
            error = ValueError("launch_arguments is a dictionary, expected pairs of name and value")
            error.hint = "Write launch_arguments={…}.items()"  # type: ignore[attr-defined]
            raise error
        self.__launch_arguments = list(launch_arguments or [])
        self.__places: dict[str, Any] = {}

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[type, dict[str, Any]]:
        """Its arguments from `file` and nested `arg` (or `let`) tags."""
        _, kwargs = super().parse(entity, parser)
        kwargs["launch_description_source"] = parser.parse_substitution(entity.get_attr("file"))
        given = []
        for tag in ("arg", "let"):
            for argument in entity.get_attr(tag, data_type=list[Entity], optional=True) or []:
                name = parser.parse_substitution(argument.get_attr("name"))
                given.append((name, parser.parse_substitution(argument.get_attr("value"))))
                argument.assert_entity_completely_parsed()
        if given:
            kwargs["launch_arguments"] = given
        return cls, kwargs

    @property
    def launch_description_source(self) -> LaunchDescriptionSource:
        """Where the description comes from."""
        return self.__source

    @property
    def launch_arguments(self) -> list[tuple[SomeSubstitutionsType, SomeSubstitutionsType]]:
        """The arguments that are given."""
        return self.__launch_arguments

    def describe_sub_entities(self) -> list[LaunchDescriptionEntity]:
        """The description, if it can be had before the launch runs."""
        description = self.__source.try_get_launch_description_without_context()
        return [description] if description is not None else []

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity] | None:
        """Load the description, check its arguments, and give it.

        Raises:
            NotHereError: if it is one of a package that only robots have, or imports such a package.
        """
        self._remember_places(context)
        try:
            description = self.__source.get_launch_description(context)
        except FileNotFoundError:
            if package := catalog.package_of(self.__source.location):
                raise catalog.left_out(f"{os.path.basename(self.__source.location)} of {package}", package) from None
            raise
        except InvalidLaunchFileError as error:
            module = getattr(error.__cause__, "name", None) if isinstance(error.__cause__, ImportError) else None
            if self._written_at is not None and module and catalog.why_not_here(module):
                name = os.path.basename(self.__source.location)
                raise NotHereError(name, f"it imports {module}, and {catalog.why_not_here(module)}") from None
            raise
        self._check_depth(context)
        context.extend_locals(
            {
                "current_launch_file_directory": os.path.dirname(os.path.abspath(self.__source.location)),
                "current_launch_file_path": os.path.abspath(self.__source.location),
            }
        )
        self._check_arguments(description, context)
        sets = [SetLaunchConfiguration(name, value) for name, value in self.__launch_arguments]
        return [*sets, description, OpaqueFunction(function=self._restore_places)]

    def _check_depth(self, context: LaunchContext) -> None:
        context._include_depth += 1
        if context._include_depth > DEEPEST:
            error = RuntimeError("launch files include one another endlessly")
            name = os.path.basename(self.__source.location)
            error.add_note(f"{name} is included again and again: give the include a condition that ends it.")
            raise error

    def _check_arguments(self, description: LaunchDescription, context: LaunchContext) -> None:
        given = [
            perform_substitutions(context, normalize_to_list_of_substitutions(name))
            for name, _ in self.__launch_arguments
        ]
        declared = description.get_launch_arguments_with_include_launch_description_actions()
        for argument, includes in declared:
            if argument._conditionally_included or argument.default_value is not None:
                continue
            known = [
                *given,
                *(name for include in includes or [] for name in include._plain_argument_names()),
            ]
            if argument.name not in known:
                raise MissingLaunchArgumentError(
                    f"Included launch description missing required argument '{argument.name}' "
                    f"(description: '{argument.description}'), given: [{', '.join(known)}]",
                    argument.name,
                )

    def _plain_argument_names(self) -> list[str]:
        """The names of the arguments that it gives, as far as they are plain text."""
        names = [name for name, _ in self.__launch_arguments]
        return [name for name in names if isinstance(name, str) and not isinstance(name, Substitution)]

    def _remember_places(self, context: LaunchContext) -> None:
        values = context.get_locals_as_dict()
        self.__places = {name: values[name] for name in _PLACES if name in values}

    def _restore_places(self, context: LaunchContext) -> None:
        context._include_depth -= 1
        for name in _PLACES:
            context._locals.pop(name, None)
        context.extend_locals(self.__places)


@expose_action("timer")
class TimerAction(Action):
    """Gives its actions when `period` seconds have passed, once, unless it is cancelled before."""

    _completes_later = True

    def __init__(
        self,
        *,
        period: float | SomeSubstitutionsType,
        actions: Iterable[LaunchDescriptionEntity],
        cancel_on_shutdown: bool | SomeSubstitutionsType = True,
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        ensure_argument_type(actions, Iterable, "actions", "TimerAction")
        self.__period = normalize_to_list_of_substitutions(str(period) if isinstance(period, int | float) else period)
        self.__actions = list(actions)
        self.__cancel_on_shutdown = str(cancel_on_shutdown).lower() not in {"false", "0"}
        self.__cancelled = False
        self.__locals: dict[str, Any] = {}

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[type, dict[str, Any]]:
        """Its arguments from `period`, `cancel_on_shutdown` and the actions in it."""
        _, kwargs = super().parse(entity, parser)
        kwargs["period"] = parser.parse_if_substitutions(entity.get_attr("period", data_type=float, can_be_str=True))
        cancel = entity.get_attr("cancel_on_shutdown", data_type=bool, optional=True, can_be_str=True)
        if cancel is not None:
            kwargs["cancel_on_shutdown"] = parser.parse_if_substitutions(cancel)
        kwargs["actions"] = [parser.parse_action(child) for child in entity.children]
        return cls, kwargs

    @property
    def period(self) -> Any:
        """The time to wait, as substitutions."""
        return self.__period

    @property
    def actions(self) -> list[LaunchDescriptionEntity]:
        """What it gives."""
        return self.__actions

    def describe_conditional_sub_entities(
        self,
    ) -> list[tuple[str, Iterable[LaunchDescriptionEntity]]]:
        """What it gives when its time is over."""
        seconds = " + ".join(part.describe() for part in self.__period)
        return [(f"{seconds} seconds pass without being canceled", self.__actions)]

    def cancel(self) -> None:
        """Do not do it after all."""
        self.__cancelled = True

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity] | None:
        """Begin to wait."""
        if self.__cancelled or context._host is None:
            return None
        seconds = float(perform_substitutions(context, self.__period))
        self.__locals = context.get_locals_as_dict()
        if self.__cancel_on_shutdown:
            context.register_event_handler(OnShutdown(on_shutdown=lambda event, context: self.cancel()))
        context._host.call_later(seconds, lambda: self._time_is_over(context))
        return None

    def _time_is_over(self, context: LaunchContext) -> None:
        if not self.__cancelled:
            handler = EventHandler(matcher=self._is_mine, entities=self.__actions, handle_once=True)
            context.register_event_handler(handler)
            context.emit_event_sync(TimerEvent(timer_action=self))
            self._complete(context)

    def _is_mine(self, event: object) -> bool:
        return isinstance(event, TimerEvent) and event.timer_action is self


class OpaqueFunction(Action):
    """Calls `function(context, *args, **kwargs)`, which may return a list of entities."""

    def __init__(
        self,
        *,
        function: Callable[..., list[LaunchDescriptionEntity] | None],
        args: Iterable[Any] | None = None,
        kwargs: dict[str, Any] | None = None,
        **left_over_kwargs: Any,
    ) -> None:
        super().__init__(**left_over_kwargs)
        if not callable(function):
            raise TypeError(f"OpaqueFunction expected a callable for 'function', got '{type(function)}'")
        self.__function = function
        self.__args = list(args or [])
        self.__kwargs = dict(kwargs or {})

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity] | None:
        """Call it."""
        return self.__function(context, *self.__args, **self.__kwargs)
