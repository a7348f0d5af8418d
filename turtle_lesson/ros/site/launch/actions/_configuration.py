"""Actions that declare, set and forget launch arguments, launch configurations and environment variables."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any, ClassVar, NoReturn

from .. import logging
from .._context import LaunchContext
from .._entities import Action, SomeSubstitutionsType
from .._tags import pair, plain, tags, text, typed
from ..frontend import expose_action
from ..utilities import normalize_to_list_of_substitutions as pieces
from ..utilities import perform_substitutions, perform_text_as, text_of

__all__ = [
    "AppendEnvironmentVariable",
    "DeclareLaunchArgument",
    "PopEnvironment",
    "PopLaunchConfigurations",
    "PushEnvironment",
    "PushLaunchConfigurations",
    "ResetEnvironment",
    "ResetLaunchConfigurations",
    "SetEnvironmentVariable",
    "SetLaunchConfiguration",
    "UnsetEnvironmentVariable",
    "UnsetLaunchConfiguration",
]


@expose_action("arg")
class DeclareLaunchArgument(Action):
    """Names an argument, with its default, what it is for, and which values it may have (None: any)."""

    _tag: ClassVar = {
        "name": plain("name"),
        "default_value": text("default", optional=True),
        "description": plain("description", optional=True),
        "choices": tags("choice", plain("value")),
    }

    def __init__(
        self,
        name: str,
        *,
        default_value: SomeSubstitutionsType | None = None,
        description: str | None = None,
        choices: list[str] | None = None,
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        self.name = name
        self.default_value = None if default_value is None else pieces(default_value)
        if choices is not None and not choices:
            _refuse("Provided choices arg is empty. Use None to ignore the choice list.")
        if choices and isinstance(default_value, str) and default_value not in choices:
            _refuse(f'Provided default_value "{default_value}" is not in provided choices "{choices}".')
        self.choices = choices
        self.description = _describe(description, choices)
        self._conditionally_included = False

    def execute(self, context: LaunchContext) -> None:
        """Take the default if nothing was given, and check the value.

        Raises RuntimeError if a value is missing, or not among the choices.
        """
        configurations = context.launch_configurations
        if self.name not in configurations:
            if self.default_value is None:
                _refuse(
                    f'Required launch argument "{self.name}" (description: "{self.description}") was not provided',
                    f'Required launch argument "{self.name}" was not provided.',
                )
            configurations[self.name] = perform_substitutions(context, self.default_value)
        if self.choices is not None and configurations[self.name] not in self.choices:
            given = f'Argument "{self.name}" provided value "{configurations[self.name]}" is not valid.'
            _refuse(f"{given} Valid options are: {self.choices}")


def _refuse(said: str, raised: str = "") -> NoReturn:
    """Print an error before it is raised, as the real action does (launch's declare_launch_argument.py)."""
    logging.get_logger("launch.actions.declare_launch_argument").error(said)
    raise RuntimeError(raised or said)


def _describe(description: str | None, choices: list[str] | None) -> str:
    if description is None:
        return "no description given" if choices is None else f"One of: {choices}"
    if choices is None:
        return description
    end = "" if description.endswith(".") else "."
    return f"{description}{end} Valid choices are: {choices}"


class _Setting(Action):
    """Sets one of the values that a context keeps by name."""

    _values: ClassVar[str]
    _tag: ClassVar = {"name": text("name"), "value": text("value")}

    def __init__(self, name: SomeSubstitutionsType, value: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.name, self.value = pieces(name), pieces(value)

    def execute(self, context: LaunchContext) -> None:
        """Set it."""
        name, value = perform_substitutions(context, self.name), perform_substitutions(context, self.value)
        getattr(context, self._values)[name] = value


@expose_action("let")
class SetLaunchConfiguration(_Setting):
    """Gives a launch configuration a value."""

    _values = "launch_configurations"


@expose_action("set_env")
class SetEnvironmentVariable(_Setting):
    """Gives an environment variable a value."""

    _values = "environment"


class _Unsetting(Action):
    """Forgets one of the values that a context keeps by name."""

    _values: ClassVar[str]
    _tag: ClassVar = {"name": text("name")}

    def __init__(self, name: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.name = pieces(name)

    def execute(self, context: LaunchContext) -> None:
        """Forget it."""
        getattr(context, self._values).pop(perform_substitutions(context, self.name), None)


@expose_action("unset")
class UnsetLaunchConfiguration(_Unsetting):
    """Forgets a launch configuration."""

    _values = "launch_configurations"


@expose_action("unset_env")
class UnsetEnvironmentVariable(_Unsetting):
    """Forgets an environment variable."""

    _values = "environment"


class _Scoping(Action):
    """Begins or ends a scope of the values that a context keeps by name."""

    _values: ClassVar[str]
    _does: ClassVar[str]

    def execute(self, context: LaunchContext) -> None:
        """Begin or end it."""
        getattr(context, self._does)(self._values)


class PushLaunchConfigurations(_Scoping):
    """Begins a scope: what is set from here on is forgotten at the matching pop."""

    _values, _does = "launch_configurations", "_push"


class PopLaunchConfigurations(_Scoping):
    """Ends a scope."""

    _values, _does = "launch_configurations", "_pop"


@expose_action("push_env")
class PushEnvironment(_Scoping):
    """Begins a scope: what is set from here on is forgotten at the matching pop."""

    _values, _does = "environment", "_push"


@expose_action("pop_env")
class PopEnvironment(_Scoping):
    """Ends a scope."""

    _values, _does = "environment", "_pop"


@expose_action("reset")
class ResetLaunchConfigurations(Action):
    """Forgets all launch configurations but the given ones."""

    _tag: ClassVar = {"launch_configurations": tags("keep", pair())}

    def __init__(
        self,
        launch_configurations: Mapping[SomeSubstitutionsType, SomeSubstitutionsType] | None = None,
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        self.__kept = dict(launch_configurations or {})

    def execute(self, context: LaunchContext) -> None:
        """Forget them."""
        kept = {text_of(context, name): text_of(context, value) for name, value in self.__kept.items()}
        context.launch_configurations.clear()
        context.launch_configurations.update(kept)


@expose_action("reset_env")
class ResetEnvironment(Action):
    """Makes the environment what it was when the launch began."""

    def execute(self, context: LaunchContext) -> None:
        """Reset it."""
        context.environment = dict(context._environment_at_start)


@expose_action("append_env")
class AppendEnvironmentVariable(Action):
    """Adds something behind or before what is in an environment variable that is a list, such as a path."""

    _tag: ClassVar = {
        "name": text("name"),
        "value": text("value"),
        "prepend": typed("prepend", bool),
        "separator": text("separator", optional=True),
    }

    def __init__(
        self,
        name: SomeSubstitutionsType,
        value: SomeSubstitutionsType,
        prepend: bool | SomeSubstitutionsType = False,
        separator: SomeSubstitutionsType = os.pathsep,
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        self.name, self.value = pieces(name), pieces(value)
        self.prepend = prepend if isinstance(prepend, bool) else pieces(prepend)
        self.separator = pieces(separator)

    def execute(self, context: LaunchContext) -> None:
        """Add it."""
        name = perform_substitutions(context, self.name)
        parts = [perform_substitutions(context, self.value)]
        if name in context.environment:
            first = perform_text_as(context, self.prepend, bool)
            parts.insert(1 if first else 0, context.environment[name])
        context.environment[name] = perform_substitutions(context, self.separator).join(parts)
