"""`launch`: describing which programs are started, and how (facts: launch of ROS 2 Humble).

The classes have the names and signatures of the real package, so a launch file runs here and on a robot; what
is not here raises an ImportError that says so. `turtle_lesson.ros.launching` carries a description out.
"""

from __future__ import annotations

from . import (
    actions,
    conditions,
    event_handlers,
    events,
    frontend,
    launch_description_sources,
    logging,
    substitutions,
    utilities,
)
from ._context import Event, EventHandler, LaunchContext
from ._entities import (
    Action,
    Condition,
    LaunchDescription,
    LaunchDescriptionEntity,
    SomeActionsType,
    SomeEntitiesType,
    SomeSubstitutionsType,
    Substitution,
)
from ._package import complete_package
from .launch_description_sources import InvalidLaunchFileError, LaunchDescriptionSource
from .launch_service import LaunchService

__all__ = [
    "Action",
    "Condition",
    "Event",
    "EventHandler",
    "InvalidLaunchFileError",
    "LaunchContext",
    "LaunchDescription",
    "LaunchDescriptionEntity",
    "LaunchDescriptionSource",
    "LaunchService",
    "SomeActionsType",
    "SomeEntitiesType",
    "SomeSubstitutionsType",
    "Substitution",
    "actions",
    "conditions",
    "event_handlers",
    "events",
    "frontend",
    "launch_description_sources",
    "logging",
    "some_actions_type",
    "some_entities_type",
    "some_substitutions_type",
    "substitutions",
    "utilities",
]

complete_package("launch")
