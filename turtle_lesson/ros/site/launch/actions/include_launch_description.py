"""`IncludeLaunchDescription`: take another launch file in, with arguments."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from typing import Any

from turtle_lesson.ros.workspace import absent
from turtle_lesson.ros.workspace.errors import NotHereError

from ..action import Action
from ..frontend import Entity, Parser, expose_action
from ..invalid_launch_file_error import InvalidLaunchFileError
from ..launch_context import LaunchContext
from ..launch_description import LaunchDescription
from ..launch_description_entity import LaunchDescriptionEntity
from ..launch_description_source import LaunchDescriptionSource
from ..launch_description_sources import AnyLaunchDescriptionSource
from ..some_types import SomeSubstitutionsType
from ..substitution import Substitution
from ..utilities import normalize_to_list_of_substitutions, perform_substitutions
from .launch_configurations import SetLaunchConfiguration
from .opaque_function import OpaqueFunction

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
            if package := absent.package_of(self.__source.location):
                raise absent.left_out(f"{os.path.basename(self.__source.location)} of {package}", package) from None
            raise
        except InvalidLaunchFileError as error:
            module = getattr(error.__cause__, "name", None) if isinstance(error.__cause__, ImportError) else None
            if self._written_at is not None and module and absent.why_not_here(module):
                name = os.path.basename(self.__source.location)
                raise NotHereError(name, f"it imports {module}, and {absent.why_not_here(module)}") from None
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
