"""Names that nothing has: of attributes, methods, fields and variables."""

from __future__ import annotations

import inspect
import re
import sys
from types import FrameType
from typing import Any

from ..idl.names import did_you_mean
from ..idl.registry import FOLDERS, registry
from ..sim.errors import learners_frames

OF_OTHERS = {
    "loginfo": "get_logger().info(…)", "logwarn": "get_logger().warning(…)", "logerr": "get_logger().error(…)",
    "logdebug": "get_logger().debug(…)", "info": "get_logger().info(…)", "now": "get_clock().now()",
    "log": "get_logger().info(…)", "get_time": "get_clock().now()", "get_param": "get_parameter('name').value",
    "set_param": "set_parameters([Parameter('name', value=…)])", "param": "declare_parameter('name', …)",
    "advertise": "create_publisher(type, topic, qos)", "subscribe": "create_subscription(type, topic, callback, qos)",
    "publish": "create_publisher(…).publish(message)", "spin": "rclpy.spin(node), which is not a method",
    "logger": "get_logger()", "destroy": "destroy_node()", "sleep": "time.sleep(seconds), or a timer",
    "create_service_client": "create_client(type, name)",
    "create_subscriber": "create_subscription(type, topic, callback, qos)",
}  # fmt: skip
"""What people write who come from ROS 1 or from C++, and what it is called on a node."""

OF_RCLPY = {
    "sleep": "time.sleep(seconds), node.create_rate(hz), or a timer", "Rate": "node.create_rate(hz)",
    "Time": "from rclpy.time import Time; the time itself is node.get_clock().now()",
    "Duration": "from rclpy.duration import Duration", "Publisher": "node.create_publisher(type, topic, qos)",
    "Subscriber": "node.create_subscription(type, topic, callback, qos)", "Node": "from rclpy.node import Node",
    "init_node": "rclpy.init(), then rclpy.create_node('name')", "loginfo": "node.get_logger().info(…)",
    "is_shutdown": "not rclpy.ok()", "get_param": "node.get_parameter('name').value", "spinOnce": "rclpy.spin_once(node)",
    "on_shutdown": "node.context.on_shutdown(callback)", "Service": "node.create_service(type, name, callback)",
    "ServiceProxy": "node.create_client(type, name)", "Timer": "node.create_timer(seconds, callback)",
    "is_ok": "rclpy.ok()", "QoSProfile": "from rclpy.qos import QoSProfile",
}  # fmt: skip


def attribute_advice(error: BaseException) -> str:
    """A sentence about a name that is not there."""
    if isinstance(error, AttributeError):
        return _attribute(error)
    if isinstance(error, NameError):
        return _variable(error)
    return ""


def _attribute(error: AttributeError) -> str:
    text, owner, name = str(error), error.obj, error.name or ""
    if match := re.match(r"the simulated module 'rclpy' has no '(\w+)'", text):
        return f"Here it is: {OF_RCLPY[match[1]]}." if match[1] in OF_RCLPY else _case("rclpy", match[1])
    if match := re.match(r"(?:property '(\w+)' of '\w+' object has no setter|can't set attribute '(\w+)')", text):
        taken = match[1] or match[2]
        return (
            f"Every node already has {taken!r}, which cannot be replaced: choose another name, as in self.my_{taken}."
        )
    if not name and (match := re.match(r"'(\w+)' object has no attribute '(\w+)'", text)):
        kind = message_class(match[1])  # its field was to be set
        return "" if kind is None else _field(kind(), match[2])
    if "Did you mean" in text or not name or name.startswith("__"):
        return ""
    if owner is None:
        return "" if _is_within_ours(error) else _of_none(error, name)
    if callable(owner) and hasattr(owner, "__name__") and not isinstance(owner, type):
        return f"{owner.__name__} is a function: call it with brackets, {owner.__name__}().{name}"
    if hasattr(owner, "get_fields_and_field_types"):
        return _field(owner, name)
    if hasattr(owner, "create_publisher") and name in OF_OTHERS:
        return f"On a node it is: {OF_OTHERS[name]}."
    if left_out := name_left_out(owner, name):
        return left_out
    return did_you_mean(name, [each for each in dir(owner) if not each.startswith("_")])


def _of_none(error: BaseException, name: str) -> str:
    line = _line(error)
    if re.search(r"result\(\)\s*\." + name, line):
        return (
            "A future's result() is None until it is done: spin until then, with "
            "rclpy.spin_until_future_complete(node, future), or take the result in future.add_done_callback(…)."
        )
    found = re.findall(r"(\w[\w.]*(?:\[[^\]]*\]|\(\))*)\." + name, line)
    frame = learners_frames(error.__traceback__)[-1].tb_frame
    what = next((each for each in found if _may_be_none(each, frame)), f"the part before .{name}")
    return f"Here {what} is None: has it been given a value yet, or has the callback that sets it not been called?"


def _may_be_none(words: str, frame: FrameType) -> bool:
    """Whether names and attributes such as "self.pose" are None in a frame; True where only a call would tell."""
    first, *rest = words.split(".")
    if not all(each.isidentifier() for each in (first, *rest)):
        return True
    value: Any = frame.f_locals.get(first, frame.f_globals.get(first))
    for each in rest:
        value = inspect.getattr_static(value, each, None)
    return value is None or inspect.isdatadescriptor(value)


def _is_within_ours(error: BaseException) -> bool:
    frames, trace = learners_frames(error.__traceback__), error.__traceback__
    while trace is not None and trace.tb_next is not None:
        trace = trace.tb_next
    return not frames or frames[-1] is not trace


def message_class(name: str) -> Any:
    """A message's class of this name, or None. Of two such classes the one that was imported first is taken."""
    for key, module in list(sys.modules.items()):
        kind = vars(module).get(name) if re.search(r"\.(msg|srv|action)\._", key) else None
        if hasattr(kind, "get_fields_and_field_types"):
            return kind
    packages = [each for each in registry.packages() if name in registry.package(each).names_in("msg")]
    return registry.get(f"{packages[0]}/msg/{name}") if packages else None


def _line(error: BaseException) -> str:
    import traceback

    frames = learners_frames(error.__traceback__)
    return (traceback.extract_tb(frames[-1], limit=1)[0].line or "") if frames else ""


def _field(message: Any, name: str) -> str:
    """A message's fields, and where in it a field of this name is."""
    kinds = message.get_fields_and_field_types()
    close = did_you_mean(name, kinds)
    inside = [each for each in kinds if hasattr(getattr(message, each, None), f"_{name}")]
    where = f" {name!r} is a field of {' and of '.join(inside)}: .{inside[0]}.{name}" if inside else ""
    return f"{close or 'The fields are: ' + ', '.join(kinds) + '.'}{where}"


def _variable(error: NameError) -> str:
    name = error.name or ""
    frames = learners_frames(error.__traceback__)
    if not name or not frames or isinstance(error, UnboundLocalError):
        return ""
    frame = frames[-1].tb_frame
    this = frame.f_locals.get("self")
    if this is not None and hasattr(this, name):
        return f"Inside a class, write self.{name}."
    return _importable(name) or did_you_mean(name, [*frame.f_locals, *frame.f_globals, *dir(__builtins__)])


def _importable(name: str) -> str:
    """Where to import a name from that programs use often."""
    if name in _FROM:
        return f"Add at the top of the file: {_FROM[name]}"
    usual = ("std_msgs", "geometry_msgs", "sensor_msgs", "nav_msgs", "std_srvs", "example_interfaces", "turtlesim")
    for package in (each for each in usual if each in registry.packages()):
        for folder in FOLDERS:
            if name in registry.package(package).names_in(folder):
                return f"Add at the top of the file: from {package}.{folder} import {name}"
    return ""


_FROM = {
    "Node": "from rclpy.node import Node",
    "Duration": "from rclpy.duration import Duration",
    "Time": "from rclpy.time import Time",
    "Parameter": "from rclpy.parameter import Parameter",
    "ActionServer": "from rclpy.action import ActionServer",
    "ActionClient": "from rclpy.action import ActionClient",
    "QoSProfile": "from rclpy.qos import QoSProfile",
    "ReliabilityPolicy": "from rclpy.qos import ReliabilityPolicy",
    "DurabilityPolicy": "from rclpy.qos import DurabilityPolicy",
    "MultiThreadedExecutor": "from rclpy.executors import MultiThreadedExecutor",
    "SingleThreadedExecutor": "from rclpy.executors import SingleThreadedExecutor",
    "ReentrantCallbackGroup": "from rclpy.callback_groups import ReentrantCallbackGroup",
    **{name: f"import {name}" for name in ("rclpy", "math", "time", "sys", "os", "random", "threading", "json")},
    "np": "import numpy as np",
}


def _case(module: str, name: str) -> str:
    lower = {each.lower(): each for each in dir(sys.modules[module])}
    return f"Did you mean '{lower[name.lower()]}'?" if name.lower() in lower else ""


# -- parts of rclpy that are left out, because no course uses them: what to do without each ---------------------------
# Most came after Humble. A program meets them as a module that is not there, or as an attribute that nothing has.

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
