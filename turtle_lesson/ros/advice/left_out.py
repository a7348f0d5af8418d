"""Parts of rclpy that are left out, because no course uses them: what to do without each.

Most came after Humble. A program meets them as a module that is not there, or as an attribute that nothing has.
"""

from __future__ import annotations

_CONTENT_FILTERS = (
    "Content filters are not available here (in Python, ROS 2 has them since Kilted): let the callback return early from "
    "messages that it does not want."
)
_QOS_OVERRIDES = (
    "QoS overrides are not available here: declare a parameter of your own, and make the QoSProfile from its value."
)
_WAITABLES = (
    "Waitables of a program's own are not available here: use a guard condition, node.create_guard_condition(callback), or "
    "a timer. QoS events are heard by event_callbacks, when the publisher or subscription is made."
)
_INTROSPECTION = (
    "Service introspection is not available here (ROS 2 has it since Iron): log or publish requests and responses in the "
    "service's callback."
)
_TYPE_DESCRIPTIONS = (
    "Type descriptions and their hashes are not available here (ROS 2 has them since Iron): `ros2 interface show` prints "
    "a type's definition."
)
_BEST_AVAILABLE = (
    "Policies that adapt to the other side are not available here (ROS 2 has them since Iron): name the policy, such as "
    "ReliabilityPolicy.RELIABLE or BEST_EFFORT; `ros2 topic info -v` shows what the other side has."
)
_TIMER_INFO = (
    "TimerInfo is not available here (in Python, ROS 2 has it since Jazzy): a timer's callback has no parameter, and "
    "node.get_clock().now() is the time."
)
_EXPERIMENTAL = (
    "rclpy.experimental is not available here: use SingleThreadedExecutor instead of EventsExecutor. Callbacks of a Node "
    "may be `async def`, so that no AsyncNode is needed: they can await client.call_async(request)."
)

_MODULES = {
    "rclpy.experimental": _EXPERIMENTAL,
    "rclpy.qos_overriding_options": _QOS_OVERRIDES,
    "rclpy.service_introspection": _INTROSPECTION,
    "rclpy.subscription_content_filter_options": _CONTENT_FILTERS,
    "rclpy.type_description_service": _TYPE_DESCRIPTIONS,
    "rclpy.type_hash": _TYPE_DESCRIPTIONS,
    "rclpy.waitable": _WAITABLES,
}
_NAMES = {
    "TimerInfo": _TIMER_INFO,
    "QoSOverridingOptions": _QOS_OVERRIDES,
    "configure_introspection": _INTROSPECTION,
    "topic_type_hash": _TYPE_DESCRIPTIONS,
    **dict.fromkeys(("BEST_AVAILABLE", "qos_profile_best_available"), _BEST_AVAILABLE),
    **dict.fromkeys(("Waitable", "NumberOfEntities", "add_waitable", "remove_waitable", "waitables"), _WAITABLES),
    **dict.fromkeys(
        ("set_content_filter", "get_content_filter", "is_cft_enabled", "is_cft_supported", "configure_nodes_filter"),
        _CONTENT_FILTERS,
    ),
}


def module_left_out(name: str) -> str:
    """What to do without a module of rclpy that is left out; an empty text for any other module."""
    return next((advice for each, advice in _MODULES.items() if f"{name}.".startswith(f"{each}.")), "")


def name_left_out(owner: object, name: str) -> str:
    """What to do without a name that a real rclpy's module or object has; an empty text for any other name.

    Args:
        owner: the object or class that was asked for the attribute, or the name of the module.
        name: the attribute.
    """
    kinds = owner.__mro__ if isinstance(owner, type) else type(owner).__mro__
    homes = [owner] if isinstance(owner, str) else [kind.__module__ for kind in kinds]
    return _NAMES.get(name, "") if any(home.partition(".")[0] == "rclpy" for home in homes) else ""
