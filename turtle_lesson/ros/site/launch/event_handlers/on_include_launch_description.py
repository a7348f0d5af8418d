"""`OnIncludeLaunchDescription`: takes a description in when an event asks for it."""

from __future__ import annotations

from typing import Any

from ..event import Event
from ..event_handler import BaseEventHandler
from ..events import IncludeLaunchDescription
from ..launch_context import LaunchContext
from ..launch_description_entity import LaunchDescriptionEntity
from ..some_types import SomeEntitiesType


class OnIncludeLaunchDescription(BaseEventHandler):
    """Reacts to IncludeLaunchDescription. Launch itself does already; a second one takes it in twice."""

    def __init__(self, **kwargs: Any) -> None:
        super().__init__(matcher=lambda event: isinstance(event, IncludeLaunchDescription), **kwargs)

    def describe(self) -> tuple[str, list[LaunchDescriptionEntity]]:
        """In words."""
        return "OnIncludeLaunchDescription()", []

    def handle(self, event: Event, context: LaunchContext) -> SomeEntitiesType | None:
        """Give the description."""
        super().handle(event, context)
        assert isinstance(event, IncludeLaunchDescription)
        return event.launch_description
