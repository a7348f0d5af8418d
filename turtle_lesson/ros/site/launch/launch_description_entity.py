"""`LaunchDescriptionEntity`: whatever can stand in a launch description."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .launch_context import LaunchContext


class LaunchDescriptionEntity:
    """Base of descriptions and actions. Visiting one gives the entities that are to be visited next."""

    def visit(self, context: LaunchContext) -> list[LaunchDescriptionEntity] | None:
        """Do what it stands for; return further entities, or None."""
        return None

    def describe(self) -> str:
        """A short text that names it."""
        return repr(self)

    def describe_sub_entities(self) -> list[LaunchDescriptionEntity]:
        """The entities that it will give, as far as that is known beforehand."""
        return []

    def describe_conditional_sub_entities(
        self,
    ) -> list[tuple[str, Iterable[LaunchDescriptionEntity]]]:
        """The entities that it may give, each group with the condition in words."""
        return []
