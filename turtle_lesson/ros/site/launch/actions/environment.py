"""Actions that change the environment variables which this launch sees."""

from __future__ import annotations

import os
from collections.abc import MutableMapping
from typing import Any

from ..action import Action
from ..frontend import Entity, Parser, expose_action
from ..launch_context import LaunchContext
from ..launch_description_entity import LaunchDescriptionEntity
from ..some_types import SomeSubstitutionsType
from ..substitution import Substitution
from ..substitutions import TextSubstitution
from ..utilities import normalize_to_list_of_substitutions, perform_substitutions
from ..utilities.type_utils import normalize_typed_substitution, perform_typed_substitution
from ._setting import Setting, Unsetting


@expose_action("set_env")
class SetEnvironmentVariable(Setting):
    """Gives an environment variable a value."""

    def kept_in(self, context: LaunchContext) -> MutableMapping[str, str]:
        """In the context's `environment`."""
        return context.environment


@expose_action("unset_env")
class UnsetEnvironmentVariable(Unsetting):
    """Forgets an environment variable."""

    def kept_in(self, context: LaunchContext) -> MutableMapping[str, str]:
        """In the context's `environment`."""
        return context.environment


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
        self.__prepend = normalize_typed_substitution(
            TextSubstitution(text=prepend) if isinstance(prepend, str) else prepend, bool
        )
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
            first = perform_typed_substitution(context, self.__prepend, bool)
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
