"""Actions that give further actions: groups, included launch files, timers and functions."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Mapping
from typing import Any, ClassVar

from turtle_lesson.ros.ament import index
from turtle_lesson.ros.ament.package import NotHereError

from .._context import LaunchContext
from .._entities import Action, LaunchDescription, LaunchDescriptionEntity, SomeSubstitutionsType, explained, text_of
from .._entities import normalize_to_list_of_substitutions as pieces
from ..frontend import Entity, actions, attribute, expose_action, pair, tags
from ..launch_description_sources import AnyLaunchDescriptionSource, InvalidLaunchFileError, LaunchDescriptionSource
from ._configuration import SetLaunchConfiguration

__all__ = ["GroupAction", "IncludeLaunchDescription", "OpaqueFunction", "TimerAction"]


def _scope(context: LaunchContext, *names: str) -> OpaqueFunction:
    """Begin a scope of these values of the context; the action that is returned ends it."""
    context._push(*names)
    return OpaqueFunction(function=lambda context: context._pop(*names))


@expose_action("group")
class GroupAction(Action):
    """Gives its actions; if it is scoped, what they set is forgotten at the end."""

    _tag: ClassVar = {
        "scoped": attribute("scoped", bool, optional=True, can_be_str=False),
        "actions": actions,
    }

    def __init__(self, actions: Iterable[Action], *, scoped: bool = True, **left_over_kwargs: Any) -> None:
        super().__init__(**left_over_kwargs)
        self.__actions = list(actions)
        self.__scoped = scoped

    def describe_sub_entities(self) -> list[LaunchDescriptionEntity]:
        """What it gives."""
        return [*self.__actions]

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity]:
        """Give its actions, in a scope of their own."""
        end = [_scope(context, "launch_configurations", "environment")] if self.__scoped else []
        return [*self.__actions, *end]


DEEPEST = 50
"""So many launch files may lie within one another."""


def _given(entity: Entity) -> list[Any]:
    """The names and values of nested `arg` and `let` tags."""
    return [each for tag in ("arg", "let") for each in tags(tag, pair())(entity) or ()]


@expose_action("include")
class IncludeLaunchDescription(Action):
    """Includes a launch description; its arguments are given as pairs of name and value."""

    _tag: ClassVar = {"launch_description_source": attribute("file"), "launch_arguments": _given}

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

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity]:
        """Load the description, check its arguments, and give it.

        Raises NotHereError if it is one of a package that only robots have, or imports such a package.
        """
        description = self._load(context)
        path = os.path.abspath(self.launch_description_source.location)
        end = _scope(context, "_locals")
        context.extend_locals({"current_launch_file_path": path})
        if len(context._scopes["_locals"]) > DEEPEST:
            name = os.path.basename(path)
            hint = f"{name} is included again and again: give the include a condition that ends it."
            raise explained(RuntimeError("launch files include one another endlessly"), hint)
        given = [text_of(context, name) for name, _ in self.launch_arguments]
        for argument, includes in description.get_launch_arguments_with_include_launch_description_actions():
            inner = [name for include in includes for name, _ in include.launch_arguments]
            known = [*given, *(name for name in inner if isinstance(name, str))]
            needed = argument.default_value is None and not argument._conditionally_included
            if needed and argument.name not in known:
                hint = f"Give it a value: {argument.name}:=… (in a notebook lesson.launch(…, {argument.name}='…'))."
                error = RuntimeError(
                    f"Included launch description missing required argument '{argument.name}' "
                    f"(description: '{argument.description}'), given: [{', '.join(known)}]"
                )
                raise explained(error, hint)
        sets = [SetLaunchConfiguration(name, value) for name, value in self.launch_arguments]
        return [*sets, description, end]

    def _load(self, context: LaunchContext) -> LaunchDescription:
        source = self.launch_description_source
        try:
            return source.get_launch_description(context)
        except FileNotFoundError:
            if package := index.package_of(source.location):
                what = f"{os.path.basename(source.location)} of {package}"
                raise NotHereError(what, index.why_not_here(package)) from None
            raise
        except InvalidLaunchFileError as error:
            module = getattr(error.__cause__, "name", None) if isinstance(error.__cause__, ImportError) else None
            if self._written_at is not None and module and (why := index.why_not_here(module)):
                raise NotHereError(os.path.basename(source.location), f"it imports {module}, and {why}") from None
            raise


@expose_action("timer")
class TimerAction(Action):
    """Gives its actions when `period` seconds have passed, once, unless it is cancelled before."""

    _completes_later = True
    _tag: ClassVar = {
        "period": attribute("period", float),
        "cancel_on_shutdown": attribute("cancel_on_shutdown", bool, optional=True),
        "actions": actions,
    }

    def __init__(
        self,
        *,
        period: float | SomeSubstitutionsType,
        actions: Iterable[LaunchDescriptionEntity],
        cancel_on_shutdown: bool = True,
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        self.period = pieces(str(period) if isinstance(period, int | float) else period)
        self.actions = list(actions)
        self.__cancel_on_shutdown = cancel_on_shutdown
        self.__cancelled = False

    def describe_conditional_sub_entities(self) -> list[LaunchDescriptionEntity]:
        """What it gives when its time is over."""
        return self.actions

    def cancel(self) -> None:
        """Do not do it after all."""
        self.__cancelled = True

    def execute(self, context: LaunchContext) -> None:
        """Begin to wait."""
        if self.__cancelled:
            return

        def time_is_over() -> None:
            if not (self.__cancelled or (self.__cancel_on_shutdown and context.is_shutdown)):
                for each in self.actions:
                    context._host.visit(each)
                self._complete(context)

        context._host.call_later(float(text_of(context, self.period)), time_is_over)


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
