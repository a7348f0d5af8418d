"""What actions that set or forget a value by its name have in common; each says where such values are kept."""

from __future__ import annotations

from collections.abc import MutableMapping
from typing import Any

from ..action import Action
from ..frontend import Entity, Parser
from ..launch_context import LaunchContext
from ..launch_description_entity import LaunchDescriptionEntity
from ..some_types import SomeSubstitutionsType
from ..substitution import Substitution
from ..utilities import normalize_to_list_of_substitutions, perform_substitutions


class Setting(Action):
    """Sets one value."""

    def __init__(self, name: SomeSubstitutionsType, value: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.__name = normalize_to_list_of_substitutions(name)
        self.__value = normalize_to_list_of_substitutions(value)

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[type, dict[str, Any]]:
        """Its arguments from `name` and `value`."""
        _, kwargs = super().parse(entity, parser)
        kwargs["name"] = parser.parse_substitution(entity.get_attr("name"))
        kwargs["value"] = parser.parse_substitution(entity.get_attr("value"))
        return cls, kwargs

    @property
    def name(self) -> list[Substitution]:
        """The name of what is set."""
        return self.__name

    @property
    def value(self) -> list[Substitution]:
        """Its new value."""
        return self.__value

    def kept_in(self, context: LaunchContext) -> MutableMapping[str, str]:
        """Where the context keeps such values."""
        raise NotImplementedError

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity] | None:
        """Set it."""
        name = perform_substitutions(context, self.name)
        self.kept_in(context)[name] = perform_substitutions(context, self.value)
        return None


class Unsetting(Action):
    """Forgets one value."""

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
        """The name of what is forgotten."""
        return self.__name

    def kept_in(self, context: LaunchContext) -> MutableMapping[str, str]:
        """Where the context keeps such values."""
        raise NotImplementedError

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity] | None:
        """Forget it."""
        self.kept_in(context).pop(perform_substitutions(context, self.__name), None)
        return None
