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
from ._context import BaseEventHandler, Event, EventHandler, LaunchContext
from ._entities import (
    Action,
    Condition,
    LaunchDescription,
    LaunchDescriptionEntity,
    SomeActionsType,
    SomeEntitiesType,
    SomeSubstitutionsType,
    SomeSubstitutionsType_types_tuple,
    Substitution,
)
from ._package import complete_package
from .frontend import InvalidLaunchFileError
from .launch_description_sources import LaunchDescriptionSource
from .launch_service import LaunchService

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

_SOME_SUBSTITUTIONS = "SomeSubstitutionsType SomeSubstitutionsType_types_tuple"

complete_package(
    "launch",
    modules={
        "launch.actions.log": "Log LogDebug LogError LogInfo LogWarning",
        "launch.actions.log_info": "LogInfo",
        "launch.actions.shutdown_action": "Shutdown",
        "launch.conditions.evaluate_condition_expression_impl": (
            "VALID_FALSE_EXPRESSIONS VALID_TRUE_EXPRESSIONS evaluate_condition_expression"
        ),
        "launch.event_handler": "BaseEventHandler EventHandler",
        "launch.events.matchers": "matches_action",
        "launch.frontend.expose": (
            "action_parse_methods expose_action expose_substitution instantiate_action "
            "instantiate_substitution substitution_parse_methods"
        ),
        "launch.frontend.parse_substitution": "parse_if_substitutions parse_substitution replace_escaped_characters",
        "launch.frontend.parser": "InvalidFrontendLaunchFileError Parser",
        "launch.frontend.type_utils": "check_is_list_entity",
        "launch.invalid_launch_file_error": "InvalidLaunchFileError",
        "launch.launch_description_source": "LaunchDescriptionSource",
        "launch.launch_description_sources.any_launch_description_source": (
            "AnyLaunchDescriptionSource get_launch_description_from_any_launch_file"
        ),
        "launch.launch_description_sources.frontend_launch_file_utilities": (
            "get_launch_description_from_frontend_launch_file"
        ),
        "launch.launch_description_sources.python_launch_file_utilities": (
            "InvalidPythonLaunchFileError get_launch_description_from_python_launch_file "
            "load_python_launch_file_as_module"
        ),
        "launch.some_actions_type": "SomeActionsType",
        "launch.some_entities_type": "SomeEntitiesType",
        "launch.some_substitutions_type": _SOME_SUBSTITUTIONS,
        "launch.some_types": f"SomeActionsType SomeEntitiesType {_SOME_SUBSTITUTIONS}",
        "launch.substitutions.boolean_substitution": "AndSubstitution NotSubstitution OrSubstitution",
        "launch.utilities.type_utils": (
            "SCALARS coerce_to_type extract_type get_typed_value is_instance_of is_instance_of_valid_type"
        ),
    },
    missing={
        "launch": {"LaunchIntrospector": "`ros2 launch … --show-args` lists a launch file's arguments"},
        "launch.actions": {
            "ForEach": "write the loop in Python: [Node(…) for name in names]",
            "ForLoop": "write the loop in Python: [Node(…) for name in names]",
            "OpaqueCoroutine": "OpaqueFunction calls a function, TimerAction waits",
            "UnregisterEventHandler": "a handler with handle_once=True reacts only once",
            "Node": "it is in launch_ros: from launch_ros.actions import Node",
        },
        "launch.event_handlers": {
            "OnIncludeLaunchDescription": "launch itself carries an included description out",
        },
        "launch.events.process": {"ProcessStdin": "processes here read no standard input"},
        "launch.launch_description_sources": {
            "XMLLaunchDescriptionSource": "it is in launch_xml.launch_description_sources",
            "YAMLLaunchDescriptionSource": "it is in launch_yaml.launch_description_sources",
        },
        "launch.logging": {"get_output_loggers": "there are no log files"},
        "launch.substitutions": {
            "AllSubstitution": "use AndSubstitution",
            "AnySubstitution": "use OrSubstitution",
            "FileContent": "use Command(['cat ', path])",
            "ForEachVar": "write the loop in Python",
            "ForLoopIndex": "write the loop in Python",
            "LaunchLogDir": "there are no log files",
            "StringJoinSubstitution": "put the pieces into a list: [a, '-', b]",
            "ThisLaunchFileName": "use ThisLaunchFile",
        },
    },
)
