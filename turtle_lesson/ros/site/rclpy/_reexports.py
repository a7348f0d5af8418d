"""Names that rclpy's modules import for themselves, and that programs take from there, as in
`from rclpy.node import ParameterDescriptor` or `from rclpy.action.client import GoalStatus`.

Nobody promised them; but on a real ROS 2 they work, editors offer them, and so many programs have such lines. They are
looked up when a program asks, so that our modules import no more than they need. (Source of facts: the import lines of
rclpy's modules, Humble to Kilted.)
"""

from __future__ import annotations

import importlib
from collections.abc import Callable
from typing import Any

_PARAMETERS = {
    "rcl_interfaces.msg": "FloatingPointRange IntegerRange ParameterMsg=Parameter ParameterDescriptor ParameterEvent"
    " ParameterType ParameterValue SetParametersResult ListParametersResult"
}
_TYPING = {
    "typing": "Any Callable Coroutine Dict Generator Iterator List Optional Sequence Set Tuple Type TypeVar Union"
}
_MESSAGE = {"rclpy.type_support": "MsgType=MsgT", "rclpy.event_handler": "QoSEventHandler"}
_SERVICE = {"rclpy.type_support": "SrvType=SrvT SrvTypeRequest=SrvRequestT SrvTypeResponse=SrvResponseT"}

REEXPORTS: dict[str, dict[str, str]] = {
    "rclpy.node": _PARAMETERS
    | _TYPING
    | {
        "rclpy.callback_groups": "ReentrantCallbackGroup",
        "rclpy.constants": "S_TO_NS",
        "rclpy.event_handler": "PublisherEventCallbacks SubscriptionEventCallbacks",
        "rclpy.exceptions": "InvalidHandle InvalidParameterException InvalidParameterTypeException"
        " InvalidParameterValueException"
        " InvalidTopicNameException NodeNameNonExistentError ParameterAlreadyDeclaredException ParameterImmutableException"
        " ParameterNotDeclaredException ParameterUninitializedException",
        "rclpy.executors": "Executor",
        "rclpy.expand_topic_name": "expand_topic_name",
        "rclpy.logging": "get_logger",
        "rclpy.qos": "qos_profile_parameter_events qos_profile_services_default",
        "rclpy.timer": "Rate",
        "rclpy.topic_endpoint_info": "TopicEndpointInfo",
        "rclpy.type_support": "MsgType=MsgT SrvType=SrvT SrvTypeRequest=SrvRequestT SrvTypeResponse=SrvResponseT"
        " check_is_valid_msg_type check_is_valid_srv_type",
        "rclpy.validate_full_topic_name": "validate_full_topic_name",
        "rclpy.validate_namespace": "validate_namespace",
        "rclpy.validate_node_name": "validate_node_name",
        "rclpy.validate_parameter_name": "validate_parameter_name",
        "rclpy.validate_topic_name": "validate_topic_name",
    },
    "rclpy.action.client": {
        "action_msgs.msg": "GoalStatus",
        "rclpy.type_support": "check_for_type_support",
        "unique_identifier_msgs.msg": "UUID",
    },
    "rclpy.action.server": {"action_msgs.msg": "GoalInfo GoalStatus", "rclpy.type_support": "check_for_type_support"},
    "rclpy.executors": _TYPING
    | {
        "rclpy.client": "Client",
        "rclpy.clock": "Clock",
        "rclpy.clock_type": "ClockType",
        "rclpy.context": "Context",
        "rclpy.exceptions": "InvalidHandle",
        "rclpy.guard_condition": "GuardCondition",
        "rclpy.service": "Service",
        "rclpy.subscription": "Subscription",
        "rclpy.task": "Future Task",
        "rclpy.timer": "Timer",
        "rclpy.utilities": "get_default_context timeout_sec_to_nsec",
    },
    "rclpy.client": _SERVICE | {"rclpy.context": "Context"},
    "rclpy.service": _SERVICE,
    "rclpy.publisher": _MESSAGE,
    "rclpy.subscription": _MESSAGE,
    "rclpy.parameter": {"rcl_interfaces.msg": "ParameterMsg=Parameter ParameterType ParameterValue"},
    "rclpy.parameter_client": {"rclpy.node": "Node"},
    "rclpy.time_source": {"rcl_interfaces.msg": "SetParametersResult", "rclpy.clock": "Clock"},
    "rclpy.timer": {
        "rclpy.clock": "Clock",
        "rclpy.context": "Context",
        "rclpy.exceptions": "InvalidHandle ROSInterruptException",
        "rclpy.utilities": "get_default_context",
    },
    "rclpy.wait_for_message": {"rclpy.node": "Node", "rclpy.qos": "QoSProfile"},
}
"""Per module: where it has names from. `here=there` is another name for it."""


def reexported(module: str) -> Callable[[str], Any]:
    """A module-level `__getattr__` that finds what `module` would have imported on a real ROS 2."""
    origins = {
        here: (origin, there or here)
        for origin, names in REEXPORTS[module].items()
        for here, _, there in (name.partition("=") for name in names.split())
    }

    def find(name: str) -> Any:
        if name not in origins:
            raise AttributeError(f"module {module!r} has no attribute {name!r}")
        origin, there = origins[name]
        return getattr(importlib.import_module(origin), there)

    return find
