"""Actions that give further actions: groups, included launch files, timers and functions."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Mapping
from typing import Any, ClassVar

from turtle_lesson.ros.ament import index
from turtle_lesson.ros.ament.package import NotHereError

from .._context import EventHandler, LaunchContext
from .._entities import (
    Action,
    LaunchDescription,
    LaunchDescriptionEntity,
    SomeSubstitutionsType,
    described,
    explained,
)
from .._tags import actions, pair, tags, text, typed
from ..event_handlers import OnShutdown
from ..events import TimerEvent
from ..frontend import Entity, InvalidLaunchFileError, Parser, expose_action
from ..launch_description_sources import AnyLaunchDescriptionSource, LaunchDescriptionSource
from ..utilities import ensure_argument_type, normalize_to_list_of_substitutions, perform_substitutions, text_of
from ._configuration import (
    PopEnvironment,
    PopLaunchConfigurations,
    PushEnvironment,
    PushLaunchConfigurations,
    ResetEnvironment,
    ResetLaunchConfigurations,
    SetLaunchConfiguration,
)

__all__ = ["GroupAction", "IncludeLaunchDescription", "OpaqueFunction", "TimerAction"]


@expose_action("group")
class GroupAction(Action):
    """Gives its actions; in a scope, what they set is forgotten at the end.

    The scope begins with what was set outside if it is `forwarding`, and with these launch configurations.
    """

    _tag: ClassVar = {
        "scoped": typed("scoped", bool, can_be_str=False),
        "forwarding": typed("forwarding", bool, can_be_str=False),
        "launch_configurations": tags("keep", pair()),
        "actions": actions(without=("keep",)),
    }

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

    def describe_sub_entities(self) -> list[LaunchDescriptionEntity]:
        """What it gives."""
        return self.get_sub_entities() if self.condition is None else []

    def describe_conditional_sub_entities(self) -> list[tuple[str, Iterable[LaunchDescriptionEntity]]]:
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


def _given(entity: Entity, parser: Parser) -> list[Any]:
    """The names and values of nested `arg` and `let` tags."""
    return [each for tag in ("arg", "let") for each in tags(tag, pair())(entity, parser) or ()]


@expose_action("include")
class IncludeLaunchDescription(Action):
    """Includes a launch description; its arguments are given as pairs of name and value."""

    _tag: ClassVar = {"launch_description_source": text("file"), "launch_arguments": _given}

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
        self.launch_description_source = launch_description_source
        if isinstance(launch_arguments, Mapping):
            error = ValueError("launch_arguments is a dictionary, expected pairs of name and value")
            raise explained(error, "Write launch_arguments={…}.items()")
        self.launch_arguments = list(launch_arguments or [])

    def describe_sub_entities(self) -> list[LaunchDescriptionEntity]:
        """The description, if it can be had before the launch runs."""
        description = self.launch_description_source.try_get_launch_description_without_context()
        return [description] if description is not None else []

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity] | None:
        """Load the description, check its arguments, and give it.

        Raises NotHereError if it is one of a package that only robots have, or imports such a package.
        """
        values = context.get_locals_as_dict()
        places = {name: values[name] for name in _PLACES if name in values}
        description = self._load(context)
        context._include_depth += 1
        path = os.path.abspath(self.launch_description_source.location)
        if context._include_depth > DEEPEST:
            error = RuntimeError("launch files include one another endlessly")
            name = os.path.basename(path)
            error.add_note(f"{name} is included again and again: give the include a condition that ends it.")
            raise error
        context.extend_locals(
            {"current_launch_file_directory": os.path.dirname(path), "current_launch_file_path": path}
        )
        self._check_arguments(description, context)

        def restore(context: LaunchContext) -> None:
            context._include_depth -= 1
            for name in _PLACES:
                context._locals.pop(name, None)
            context.extend_locals(places)

        sets = [SetLaunchConfiguration(name, value) for name, value in self.launch_arguments]
        return [*sets, description, OpaqueFunction(function=restore)]

    def _load(self, context: LaunchContext) -> LaunchDescription:
        source = self.launch_description_source
        try:
            return source.get_launch_description(context)
        except FileNotFoundError:
            if package := index.package_of(source.location):
                raise index.left_out(f"{os.path.basename(source.location)} of {package}", package) from None
            raise
        except InvalidLaunchFileError as error:
            module = getattr(error.__cause__, "name", None) if isinstance(error.__cause__, ImportError) else None
            if self._written_at is not None and module and (why := index.why_not_here(module)):
                raise NotHereError(os.path.basename(source.location), f"it imports {module}, and {why}") from None
            raise

    def _check_arguments(self, description: LaunchDescription, context: LaunchContext) -> None:
        given = [text_of(context, name) for name, _ in self.launch_arguments]
        for argument, includes in description.get_launch_arguments_with_include_launch_description_actions():
            if argument._conditionally_included or argument.default_value is not None:
                continue
            inner = [name for include in includes or [] for name, _ in include.launch_arguments]
            known = [*given, *(name for name in inner if isinstance(name, str))]
            if argument.name not in known:
                raise MissingLaunchArgumentError(
                    f"Included launch description missing required argument '{argument.name}' "
                    f"(description: '{argument.description}'), given: [{', '.join(known)}]",
                    argument.name,
                )


@expose_action("timer")
class TimerAction(Action):
    """Gives its actions when `period` seconds have passed, once, unless it is cancelled before."""

    _completes_later = True
    _tag: ClassVar = {
        "period": typed("period", float, optional=False),
        "cancel_on_shutdown": typed("cancel_on_shutdown", bool),
        "actions": actions(),
    }

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
        self.period = normalize_to_list_of_substitutions(str(period) if isinstance(period, int | float) else period)
        self.actions = list(actions)
        self.__cancel_on_shutdown = str(cancel_on_shutdown).lower() not in {"false", "0"}
        self.__cancelled = False

    def describe_conditional_sub_entities(self) -> list[tuple[str, Iterable[LaunchDescriptionEntity]]]:
        """What it gives when its time is over."""
        return [(f"{described(self.period)} seconds pass without being canceled", self.actions)]

    def cancel(self) -> None:
        """Do not do it after all."""
        self.__cancelled = True

    def execute(self, context: LaunchContext) -> None:
        """Begin to wait."""
        if self.__cancelled or context._host is None:
            return
        seconds = float(perform_substitutions(context, self.period))
        if self.__cancel_on_shutdown:
            context.register_event_handler(OnShutdown(on_shutdown=lambda event, context: self.cancel()))
        context._host.call_later(seconds, lambda: self._time_is_over(context))

    def _time_is_over(self, context: LaunchContext) -> None:
        if not self.__cancelled:
            handler = EventHandler(matcher=self._is_mine, entities=self.actions, handle_once=True)
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
