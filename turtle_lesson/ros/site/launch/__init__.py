"""`launch`: describing which programs are started, and how (facts: launch of ROS 2 Humble).

The classes have the names and signatures of the real package, so a launch file runs here and on a robot; what
is not here raises an ImportError that says so. `turtle_lesson.ros.launching` carries a description out.
"""

from . import (
    actions,
    conditions,
    event_handlers,
    events,
    frontend,
    launch_description_sources,
    logging,
    some_actions_type,
    some_entities_type,
    some_substitutions_type,
    substitutions,
    utilities,
)
from ._missing import explain_missing
from .action import Action
from .condition import Condition
from .event import Event
from .event_handler import BaseEventHandler, EventHandler
from .invalid_launch_file_error import InvalidLaunchFileError
from .launch_context import LaunchContext
from .launch_description import LaunchDescription
from .launch_description_entity import LaunchDescriptionEntity
from .launch_description_source import LaunchDescriptionSource
from .launch_service import LaunchService
from .some_types import (
    SomeActionsType,
    SomeEntitiesType,
    SomeSubstitutionsType,
    SomeSubstitutionsType_types_tuple,
)
from .substitution import Substitution

__all__ = [
    "Action",
    "BaseEventHandler",
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
    "SomeSubstitutionsType_types_tuple",
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

__getattr__ = explain_missing(
    __name__, {"LaunchIntrospector": "`ros2 launch … --show-args` lists a launch file's arguments"}
)
