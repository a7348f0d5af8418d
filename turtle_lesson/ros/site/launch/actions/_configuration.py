"""Actions that declare, set and forget launch arguments, launch configurations and environment variables."""

from __future__ import annotations

import os
from collections.abc import Mapping, MutableMapping
from typing import Any

from .. import logging
from .._context import LaunchContext
from .._entities import Action, LaunchDescriptionEntity, SomeSubstitutionsType, Substitution
from ..frontend import Entity, Parser, expose_action
from ..utilities import (
    normalize_to_list_of_substitutions,
    perform_substitutions,
    perform_text_as,
)


@expose_action("arg")
class DeclareLaunchArgument(Action):
    """Names an argument, with its default, what it is for, and which values it may have."""

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
        self.__name = name
        self.__default_value = None if default_value is None else normalize_to_list_of_substitutions(default_value)
        if choices is not None:
            _check_choices(choices, default_value)
        self.__choices = choices
        self.__description = _describe(description, choices)
        self._conditionally_included = False

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[type, dict[str, Any]]:
        """Its arguments from `name`, `default`, `description` and nested `choice` tags."""
        _, kwargs = super().parse(entity, parser)
        kwargs["name"] = parser.escape_characters(entity.get_attr("name"))
        default = entity.get_attr("default", optional=True)
        if default is not None:
            kwargs["default_value"] = parser.parse_substitution(default)
        description = entity.get_attr("description", optional=True)
        if description is not None:
            kwargs["description"] = parser.escape_characters(description)
        choices = entity.get_attr("choice", data_type=list[Entity], optional=True)
        if choices is not None:
            kwargs["choices"] = [parser.escape_characters(choice.get_attr("value")) for choice in choices]
            for choice in choices:
                choice.assert_entity_completely_parsed()
        return cls, kwargs

    @property
    def name(self) -> str:
        """The argument's name."""
        return self.__name

    @property
    def default_value(self) -> list[Substitution] | None:
        """The default, or None if the argument must be given."""
        return self.__default_value

    @property
    def description(self) -> str:
        """What it is for."""
        return self.__description

    @property
    def choices(self) -> list[str] | None:
        """The values that it may have, or None for any."""
        return self.__choices

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity] | None:
        """Take the default if nothing was given, and check the value.

        Raises:
            RuntimeError: if a value is missing, or not among the choices.
        """
        configurations = context.launch_configurations
        if self.name not in configurations:
            if self.default_value is None:
                what = f'"{self.name}" (description: "{self.description}")'
                _say(f"Required launch argument {what} was not provided")
                raise RuntimeError(f'Required launch argument "{self.name}" was not provided.')
            configurations[self.name] = perform_substitutions(context, self.default_value)
        if self.choices is not None and configurations[self.name] not in self.choices:
            text = (
                f'Argument "{self.name}" provided value "{configurations[self.name]}" is not valid. '
                f"Valid options are: {self.choices}"
            )
            _say(text)
            raise RuntimeError(text)
        return None


def _check_choices(choices: list[str], default_value: object) -> None:
    text = ""
    if not choices:
        text = "Provided choices arg is empty. Use None to ignore the choice list."
    elif isinstance(default_value, str) and default_value not in choices:
        text = f'Provided default_value "{default_value}" is not in provided choices "{choices}".'
    if text:
        _say(text)
        raise RuntimeError(text)


def _say(text: str) -> None:
    """Print an error before it is raised, as the real action does (launch's declare_launch_argument.py)."""
    logging.get_logger("launch.actions.declare_launch_argument").error(text)


def _describe(description: str | None, choices: list[str] | None) -> str:
    if description is None:
        return "no description given" if choices is None else f"One of: {choices}"
    if choices is None:
        return description
    end = "" if description.endswith(".") else "."
    return f"{description}{end} Valid choices are: {choices}"


class _Named(Action):
    """Is about one of the values that a context keeps by name."""

    def __init__(self, name: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.__name = normalize_to_list_of_substitutions(name)

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[type, dict[str, Any]]:
        """Its argument from `name`."""
        _, kwargs = super().parse(entity, parser)
        kwargs["name"] = parser.parse_substitution(entity.get_attr("name"))
        return cls, kwargs

    @property
    def name(self) -> list[Substitution]:
        """The name of the value."""
        return self.__name

    def kept_in(self, context: LaunchContext) -> MutableMapping[str, str]:
        """Where the context keeps such values."""
        raise NotImplementedError


class Setting(_Named):
    """Sets one value."""

    def __init__(self, name: SomeSubstitutionsType, value: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(name, **kwargs)
        self.__value = normalize_to_list_of_substitutions(value)

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[type, dict[str, Any]]:
        """Its arguments from `name` and `value`."""
        _, kwargs = super().parse(entity, parser)
        kwargs["value"] = parser.parse_substitution(entity.get_attr("value"))
        return cls, kwargs

    @property
    def value(self) -> list[Substitution]:
        """Its new value."""
        return self.__value

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity] | None:
        """Set it."""
        name = perform_substitutions(context, self.name)
        self.kept_in(context)[name] = perform_substitutions(context, self.value)
        return None


class Unsetting(_Named):
    """Forgets one value."""

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity] | None:
        """Forget it."""
        self.kept_in(context).pop(perform_substitutions(context, self.name), None)
        return None


class _OfConfigurations(_Named):
    def kept_in(self, context: LaunchContext) -> MutableMapping[str, str]:
        """In the context's `launch_configurations`."""
        return context.launch_configurations


class _OfEnvironment(_Named):
    def kept_in(self, context: LaunchContext) -> MutableMapping[str, str]:
        """In the context's `environment`."""
        return context.environment


@expose_action("let")
class SetLaunchConfiguration(_OfConfigurations, Setting):
    """Gives a launch configuration a value."""


@expose_action("unset")
class UnsetLaunchConfiguration(_OfConfigurations, Unsetting):
    """Forgets a launch configuration."""


class PushLaunchConfigurations(Action):
    """Begins a scope: what is set from here on is forgotten at the matching pop."""

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity] | None:
        """Begin it."""
        context._push_launch_configurations()
        return None


class PopLaunchConfigurations(Action):
    """Ends a scope."""

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity] | None:
        """End it."""
        context._pop_launch_configurations()
        return None


@expose_action("reset")
class ResetLaunchConfigurations(Action):
    """Forgets all launch configurations but the given ones."""

    def __init__(
        self,
        launch_configurations: Mapping[SomeSubstitutionsType, SomeSubstitutionsType] | None = None,
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        self.__kept = dict(launch_configurations or {})

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[type, dict[str, Any]]:
        """Its arguments; each `keep` names a configuration with its value."""
        _, kwargs = super().parse(entity, parser)
        kwargs["launch_configurations"] = kept(entity, parser)
        return cls, kwargs

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity] | None:
        """Forget them."""
        kept = {
            perform_substitutions(context, normalize_to_list_of_substitutions(name)): perform_substitutions(
                context, normalize_to_list_of_substitutions(value)
            )
            for name, value in self.__kept.items()
        }
        context.launch_configurations.clear()
        context.launch_configurations.update(kept)
        return None


def kept(entity: Entity, parser: Parser) -> dict[Any, Any]:
    """The names and values of the `keep` tags in a tag."""
    found = {}
    for keep in entity.get_attr("keep", data_type=list[Entity], optional=True) or []:
        name = tuple(parser.parse_substitution(keep.get_attr("name")))
        found[name] = parser.parse_substitution(keep.get_attr("value"))
        keep.assert_entity_completely_parsed()
    return found


@expose_action("set_env")
class SetEnvironmentVariable(_OfEnvironment, Setting):
    """Gives an environment variable a value."""


@expose_action("unset_env")
class UnsetEnvironmentVariable(_OfEnvironment, Unsetting):
    """Forgets an environment variable."""


@expose_action("append_env")
class AppendEnvironmentVariable(Action):
    """Adds something to an environment variable that is a list, such as a path."""

    def __init__(
        self,
        name: SomeSubstitutionsType,
        value: SomeSubstitutionsType,
        prepend: bool | SomeSubstitutionsType = False,
        separator: SomeSubstitutionsType = os.pathsep,
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        self.__name = normalize_to_list_of_substitutions(name)
        self.__value = normalize_to_list_of_substitutions(value)
        self.__prepend = prepend if isinstance(prepend, bool) else normalize_to_list_of_substitutions(prepend)
        self.__separator = normalize_to_list_of_substitutions(separator)

    @property
    def name(self) -> list[Substitution]:
        """The variable's name."""
        return self.__name

    @property
    def value(self) -> list[Substitution]:
        """What is added."""
        return self.__value

    @property
    def prepend(self) -> Any:
        """Whether it is put before the others, as a truth value or as substitutions."""
        return self.__prepend

    @property
    def separator(self) -> list[Substitution]:
        """What stands between."""
        return self.__separator

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[type, dict[str, Any]]:
        """Its arguments from `name`, `value`, `prepend` and `separator`."""
        _, kwargs = super().parse(entity, parser)
        kwargs["name"] = parser.parse_substitution(entity.get_attr("name"))
        kwargs["value"] = parser.parse_substitution(entity.get_attr("value"))
        prepend = entity.get_attr("prepend", optional=True, data_type=bool, can_be_str=True)
        if prepend is not None:
            kwargs["prepend"] = parser.parse_if_substitutions(prepend)
        separator = entity.get_attr("separator", optional=True)
        if separator is not None:
            kwargs["separator"] = parser.parse_substitution(separator)
        return cls, kwargs

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity] | None:
        """Add it."""
        name = perform_substitutions(context, self.__name)
        parts = [perform_substitutions(context, self.__value)]
        if name in context.environment:
            first = perform_text_as(context, self.__prepend, bool)
            parts.insert(1 if first else 0, context.environment[name])
        context.environment[name] = perform_substitutions(context, self.__separator).join(parts)
        return None


@expose_action("push_env")
class PushEnvironment(Action):
    """Begins a scope: what is set from here on is forgotten at the matching pop."""

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity] | None:
        """Begin it."""
        context._push_environment()
        return None


@expose_action("pop_env")
class PopEnvironment(Action):
    """Ends a scope."""

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity] | None:
        """End it."""
        context._pop_environment()
        return None


@expose_action("reset_env")
class ResetEnvironment(Action):
    """Makes the environment what it was when the launch began."""

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity] | None:
        """Reset it."""
        context._reset_environment()
        return None
