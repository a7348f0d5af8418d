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
from ._package import explain_missing, provide_modules
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

provide_modules(
    {
        "launch._entities": {
            "launch.action": "Action",
            "launch.condition": "Condition",
            "launch.launch_description": "LaunchDescription",
            "launch.launch_description_entity": "LaunchDescriptionEntity",
            "launch.some_actions_type": "SomeActionsType",
            "launch.some_entities_type": "SomeEntitiesType",
            "launch.some_substitutions_type": "SomeSubstitutionsType SomeSubstitutionsType_types_tuple",
            "launch.some_types": (
                "SomeActionsType SomeEntitiesType SomeSubstitutionsType SomeSubstitutionsType_types_tuple"
            ),
            "launch.substitution": "Substitution",
            "launch.substitutions.text_substitution": "TextSubstitution",
        },
        "launch.actions._configuration": {
            "launch.actions.declare_launch_argument": "DeclareLaunchArgument",
            "launch.actions.environment": (
                "AppendEnvironmentVariable PopEnvironment PushEnvironment ResetEnvironment "
                "SetEnvironmentVariable UnsetEnvironmentVariable"
            ),
            "launch.actions.launch_configurations": (
                "PopLaunchConfigurations PushLaunchConfigurations ResetLaunchConfigurations "
                "SetLaunchConfiguration UnsetLaunchConfiguration"
            ),
            "launch.actions.set_environment_variable": "SetEnvironmentVariable",
            "launch.actions.set_launch_configuration": "SetLaunchConfiguration",
        },
        "launch.actions._events": {
            "launch.actions.emit_event": "EmitEvent",
            "launch.actions.log": "Log LogDebug LogError LogInfo LogWarning",
            "launch.actions.log_info": "LogInfo",
            "launch.actions.register_event_handler": "RegisterEventHandler",
            "launch.actions.shutdown_action": "Shutdown",
        },
        "launch.actions._processes": {
            "launch.actions.execute_local": "ExecuteLocal",
            "launch.actions.execute_process": "ExecuteProcess",
        },
        "launch.actions._groups": {
            "launch.actions.group_action": "GroupAction",
            "launch.actions.include_launch_description": "IncludeLaunchDescription MissingLaunchArgumentError",
            "launch.actions.opaque_function": "OpaqueFunction",
            "launch.actions.timer_action": "TimerAction",
        },
        "launch.conditions": {
            "launch.conditions.evaluate_condition_expression_impl": (
                "VALID_FALSE_EXPRESSIONS VALID_TRUE_EXPRESSIONS evaluate_condition_expression"
            ),
            "launch.conditions.if_condition": "IfCondition",
            "launch.conditions.invalid_condition_expression_error": "InvalidConditionExpressionError",
            "launch.conditions.launch_configuration_equals": "LaunchConfigurationEquals LaunchConfigurationNotEquals",
            "launch.conditions.launch_configuration_not_equals": "LaunchConfigurationNotEquals",
            "launch.conditions.unless_condition": "UnlessCondition",
        },
        "launch._context": {
            "launch.event": "Event",
            "launch.event_handler": "BaseEventHandler EventHandler",
            "launch.launch_context": "LaunchContext",
        },
        "launch.event_handlers": {
            "launch.event_handlers.on_action_event_base": "OnActionEventBase",
            "launch.event_handlers.on_execution_complete": "OnExecutionComplete",
            "launch.event_handlers.on_process_exit": "OnProcessExit",
            "launch.event_handlers.on_process_io": "OnProcessIO",
            "launch.event_handlers.on_process_start": "OnProcessStart",
            "launch.event_handlers.on_shutdown": "OnShutdown",
        },
        "launch.events": {
            "launch.events.include_launch_description": "IncludeLaunchDescription",
            "launch.events.matchers": "matches_action",
        },
        "launch.frontend": {
            "launch.invalid_launch_file_error": "InvalidFrontendLaunchFileError InvalidLaunchFileError",
            "launch.frontend.entity": "Entity",
            "launch.frontend.expose": (
                "action_parse_methods expose_action expose_substitution instantiate_action "
                "instantiate_substitution substitution_parse_methods"
            ),
            "launch.frontend.parse_substitution": "parse_if_substitutions parse_substitution replace_escaped_characters",
            "launch.frontend.parser": "InvalidFrontendLaunchFileError Parser",
            "launch.frontend.type_utils": "check_is_list_entity",
        },
        "launch.launch_description_sources": {
            "launch.launch_description_source": "LaunchDescriptionSource",
            "launch.launch_description_sources.any_launch_description_source": (
                "AnyLaunchDescriptionSource get_launch_description_from_any_launch_file"
            ),
            "launch.launch_description_sources.frontend_launch_description_source": "FrontendLaunchDescriptionSource",
            "launch.launch_description_sources.frontend_launch_file_utilities": (
                "get_launch_description_from_frontend_launch_file"
            ),
            "launch.launch_description_sources.python_launch_description_source": "PythonLaunchDescriptionSource",
            "launch.launch_description_sources.python_launch_file_utilities": (
                "InvalidPythonLaunchFileError get_launch_description_from_python_launch_file "
                "load_python_launch_file_as_module"
            ),
        },
        "launch.substitutions._values": {
            "launch.substitutions.anon_name": "AnonName",
            "launch.substitutions.environment_variable": "EnvironmentVariable",
            "launch.substitutions.launch_configuration": "LaunchConfiguration",
            "launch.substitutions.local_substitution": "LocalSubstitution",
            "launch.substitutions.python_expression": "PythonExpression",
            "launch.substitutions.substitution_failure": "SubstitutionFailure",
            "launch.substitutions.this_launch_file": "ThisLaunchFile ThisLaunchFileDir",
            "launch.substitutions.this_launch_file_dir": "ThisLaunchFileDir",
        },
        "launch.substitutions._logic": {
            "launch.substitutions.boolean_substitution": "AndSubstitution NotSubstitution OrSubstitution",
            "launch.substitutions.equals_substitution": "EqualsSubstitution IfElseSubstitution NotEqualsSubstitution",
        },
        "launch.substitutions._paths": {
            "launch.substitutions.command": "Command",
            "launch.substitutions.find_executable": "FindExecutable",
            "launch.substitutions.path_join_substitution": "PathJoinSubstitution PathSubstitution",
        },
        "launch.utilities": {
            "launch.utilities.type_utils": (
                "SCALARS coerce_to_type extract_type get_typed_value is_instance_of is_instance_of_valid_type"
            ),
        },
    }
)

__getattr__ = explain_missing(
    __name__, {"LaunchIntrospector": "`ros2 launch … --show-args` lists a launch file's arguments"}
)
