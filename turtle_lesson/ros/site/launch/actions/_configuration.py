"""Actions that declare and set launch arguments, launch configurations and environment variables."""

from __future__ import annotations

import os
from typing import Any, ClassVar, NoReturn

from .. import logging
from .._context import LaunchContext
from .._entities import Action, SomeSubstitutionsType, text_of
from .._entities import normalize_to_list_of_substitutions as pieces
from ..frontend import attribute, expose_action, plain, tags
from ..utilities import perform_text_as

__all__ = ["AppendEnvironmentVariable", "DeclareLaunchArgument", "SetEnvironmentVariable", "SetLaunchConfiguration"]


@expose_action("arg")
class DeclareLaunchArgument(Action):
    """Names an argument, with its default, what it is for, and which values it may have (None: any)."""

    _tag: ClassVar = {
        "name": plain("name"),
        "default_value": attribute("default", optional=True),
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
        if choices and isinstance(default_value, str) and default_value not in choices:
            _refuse(f'Provided default_value "{default_value}" is not in provided choices "{choices}".')
        self.choices = choices
        self.description = description or "no description given"
        if choices:
            end = "" if self.description.endswith(".") else "."
            one_of = f"{description}{end} Valid choices are" if description else "One of"
            self.description = f"{one_of}: {choices}"
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
            configurations[self.name] = text_of(context, self.default_value)
        if self.choices and configurations[self.name] not in self.choices:
            given = f'Argument "{self.name}" provided value "{configurations[self.name]}" is not valid.'
            _refuse(f"{given} Valid options are: {self.choices}")


def _refuse(said: str, raised: str = "") -> NoReturn:
    """Print an error before it is raised, as the real action does (launch's declare_launch_argument.py)."""
    logging.get_logger("launch.actions.declare_launch_argument").error(said)
    raise RuntimeError(raised or said)


class _Setting(Action):
    """Sets one of the values that a context keeps by name."""

    _tag: ClassVar = {"name": attribute("name"), "value": attribute("value")}

    def __init__(self, name: SomeSubstitutionsType, value: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.name, self.value = pieces(name), pieces(value)


@expose_action("let")
class SetLaunchConfiguration(_Setting):
    """Gives a launch configuration a value."""

    def execute(self, context: LaunchContext) -> None:
        """Set it."""
        context.launch_configurations[text_of(context, self.name)] = text_of(context, self.value)


@expose_action("set_env")
class SetEnvironmentVariable(_Setting):
    """Gives an environment variable a value."""

    def execute(self, context: LaunchContext) -> None:
        """Set it."""
        context.environment[text_of(context, self.name)] = text_of(context, self.value)


@expose_action("append_env")
class AppendEnvironmentVariable(_Setting):
    """Adds something behind or before what is in an environment variable that is a list, such as a path."""

    _tag: ClassVar = {
        **_Setting._tag,
        "prepend": attribute("prepend", bool, optional=True),
        "separator": attribute("separator", optional=True),
    }

    def __init__(
        self,
        name: SomeSubstitutionsType,
        value: SomeSubstitutionsType,
        prepend: bool | SomeSubstitutionsType = False,
        separator: SomeSubstitutionsType = os.pathsep,
        **kwargs: Any,
    ) -> None:
        super().__init__(name, value, **kwargs)
        self.prepend = prepend
        self.separator = pieces(separator)

    def execute(self, context: LaunchContext) -> None:
        """Add it."""
        name = text_of(context, self.name)
        parts = [text_of(context, self.value)]
        if name in context.environment:
            first = perform_text_as(context, self.prepend, bool)
            parts.insert(1 if first else 0, context.environment[name])
        context.environment[name] = text_of(context, self.separator).join(parts)
