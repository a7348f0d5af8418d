"""`DeclareLaunchArgument`: an argument that a launch file takes."""

from __future__ import annotations

from typing import Any

from .. import logging
from ..action import Action
from ..frontend import Entity, Parser, expose_action
from ..launch_context import LaunchContext
from ..launch_description_entity import LaunchDescriptionEntity
from ..some_types import SomeSubstitutionsType
from ..substitution import Substitution
from ..utilities import normalize_to_list_of_substitutions, perform_substitutions


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
