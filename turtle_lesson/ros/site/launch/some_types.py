"""What may be given where text, actions or entities are expected."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Union

from .substitution import Substitution

if TYPE_CHECKING:
    from .action import Action
    from .launch_description_entity import LaunchDescriptionEntity

SomeSubstitutionsType = str | Substitution | Iterable[str | Substitution]
SomeSubstitutionsType_types_tuple = (str, Substitution, Iterable)
SomeActionsType = Union["Action", Iterable["Action"]]
SomeEntitiesType = Union["LaunchDescriptionEntity", Iterable["LaunchDescriptionEntity"]]
