"""Names that nothing has: of attributes, methods, fields and variables, of modules, and of what modules hold."""

from __future__ import annotations

import importlib
import linecache
import pkgutil
import re
import sys
import traceback
from pathlib import Path
from types import ModuleType
from typing import Any

from ..ament.index import current_packages, missing_module
from ..idl.names import did_you_mean, nearest
from ..idl.registry import FOLDERS, INSTALLED_SEPARATELY, SHARE, registry
from ..sim.errors import learners_frames

# -- attributes, fields and variables ----------------------------------------------------------------------------------

_IN_ROS_2 = {
    "Duration": "from rclpy.duration import Duration",
    "Node": "from rclpy.node import Node",
    "Publisher": "node.create_publisher(type, topic, qos)",
    "Rate": "node.create_rate(hz)",
    "ServiceProxy": "node.create_client(type, name)",
    "Subscriber": "node.create_subscription(type, topic, callback, qos)",
    "Time": "from rclpy.time import Time; the time itself is node.get_clock().now()",
    "advertise": "node.create_publisher(type, topic, qos)",
    "create_subscriber": "node.create_subscription(type, topic, callback, qos)",
    "get_param": "node.get_parameter('name').value",
    "info": "node.get_logger().info(…)",
    "init_node": "rclpy.init(), then rclpy.create_node('name')",
    "is_shutdown": "not rclpy.ok()",
    "logerr": "node.get_logger().error(…)",
    "loginfo": "node.get_logger().info(…)",
    "logwarn": "node.get_logger().warning(…)",
    "now": "node.get_clock().now()",
    "publish": "node.create_publisher(…).publish(message)",
    "sleep": "time.sleep(seconds), node.create_rate(hz), or a timer",
    "subscribe": "node.create_subscription(type, topic, callback, qos)",
}
"""What is asked of a node or of rclpy by those who come from ROS 1 or from C++, and what to write instead."""


def attribute_advice(error: BaseException) -> str:
    """A sentence about a name that is not there."""
    if isinstance(error, NameError):
        return _variable(error)
    if not isinstance(error, AttributeError):
        return ""
    text, owner, name = str(error), error.obj, error.name or ""
    if match := re.match(r"property '(\w+)' of '\w+' object has no setter", text):
        taken = match[1]
        return f"Every node has {taken!r}, which cannot be replaced: choose another name, as in self.my_{taken}."
    of_rclpy = text.startswith("the simulated module 'rclpy' has no")
    if name in _IN_ROS_2 and (of_rclpy or hasattr(owner, "create_publisher")):
        return f"Here it is: {_IN_ROS_2[name]}."
    if of_rclpy:
        return "" if "did you mean" in text else _like(name, dir(sys.modules["rclpy"]))
    if not name and (match := re.match(r"'(\w+)' object has no attribute '(\w+)'", text)):
        kind = message_class(match[1])  # its field was to be set
        return "" if kind is None else _field(kind(), match[2])
    if "Did you mean" in text or not name or name.startswith("__"):
        return ""
    if owner is None:
        return _of_none(error, name)
    if callable(owner) and hasattr(owner, "__name__") and not isinstance(owner, type):
        return f"{owner.__name__} is a function: call it with brackets, {owner.__name__}().{name}"
    if hasattr(owner, "get_fields_and_field_types"):
        return _field(owner, name)
    kinds = owner.__mro__ if isinstance(owner, type) else type(owner).__mro__
    left_out = next(filter(None, (_left_out(f"{kind.__module__}.{name}") for kind in kinds)), "")
    return left_out or _like(name, dir(owner))


def _of_none(error: BaseException, name: str) -> str:
    """Which part of the learner's line is None; nothing if the line where it happened is not the learner's."""
    frames = learners_frames(error.__traceback__)
    if not frames or frames[-1].tb_next is not None:
        return ""
    place = traceback.extract_tb(frames[-1], limit=1)[0]
    line = linecache.getline(place.filename, place.lineno or 0).encode()
    owner = line[place.colno or 0 : place.end_colno].decode(errors="replace").rpartition(f".{name}")[0]
    if owner.endswith("result()"):
        return (
            "A future's result() is None until it is done: spin until then, with "
            "rclpy.spin_until_future_complete(node, future), or take the result in future.add_done_callback(…)."
        )
    what = owner or f"the part before .{name}"
    return f"Here {what} is None: has it been given a value yet, or has the callback that sets it not been called?"


def message_class(name: str) -> Any:
    """A message's class of this name, or None. Of two such classes the one that was imported first is taken."""
    modules = [module for key, module in list(sys.modules.items()) if re.search(r"\.(msg|srv|action)\._", key)]
    kinds = [vars(module).get(name) for module in modules]
    owners = [each for each in registry.packages() if name in registry.package(each).names_in("msg")]
    kinds += [registry.get(f"{owner}/msg/{name}") for owner in owners]
    return next((kind for kind in kinds if hasattr(kind, "get_fields_and_field_types")), None)


def _field(message: Any, name: str) -> str:
    """A message's fields, and where in it a field of this name is."""
    kinds = message.get_fields_and_field_types()
    close = did_you_mean(name, kinds)
    inside = [each for each in kinds if hasattr(getattr(message, each, None), f"_{name}")]
    where = f" {name!r} is a field of {' and of '.join(inside)}: .{inside[0]}.{name}" if inside else ""
    return f"{close or 'The fields are: ' + ', '.join(kinds) + '.'}{where}"


_USUAL = (
    *(f"rclpy.{name}" for name in ("duration", "time", "qos", "action", "executors", "callback_groups", "node")),
    *(f"{name}.msg" for name in ("std_msgs", "geometry_msgs", "sensor_msgs", "nav_msgs", "turtlesim")),
    *(f"{name}.srv" for name in ("std_srvs", "example_interfaces", "turtlesim")),
)
"""Modules from which programs often import classes."""


def _variable(error: NameError) -> str:
    name = error.name or ""
    frames = learners_frames(error.__traceback__)
    if not name or not frames or isinstance(error, UnboundLocalError):
        return ""
    frame = frames[-1].tb_frame
    if hasattr(frame.f_locals.get("self"), name):
        return f"Inside a class, write self.{name}."
    if name in ("rclpy", "math", "time", "sys", "os", "random", "threading", "json"):
        return f"Add at the top of the file: import {name}"
    for module in _USUAL:
        found = getattr(importlib.import_module(module), name, None)
        if getattr(found, "__module__", "").partition(".")[0] == module.partition(".")[0]:
            return f"Add at the top of the file: from {module} import {name}"
    return did_you_mean(name, [*frame.f_locals, *frame.f_globals])


# -- parts of rclpy that are left out, because no course uses them: what to do without each ---------------------------
# Most came after Humble. A program meets them as a module that is not there, or as an attribute that nothing has.

_LEFT_OUT_PARTS = {
    "Content filters are not available here (in Python, ROS 2 has them since Kilted): let the callback return early from "
    "messages that it does not want.": "subscription_content_filter_options set_content_filter get_content_filter",
    "QoS overrides are not available here: declare a parameter of your own, and make the QoSProfile from its value.": (
        "qos_overriding_options QoSOverridingOptions"
    ),
    "Waitables of a program's own are not available here: use a guard condition, node.create_guard_condition(callback), "
    "or a timer. QoS events are heard by event_callbacks, when the publisher or subscription is made.": (
        "waitable Waitable add_waitable"
    ),
    "Service introspection is not available here (ROS 2 has it since Iron): log or publish requests and responses in the "
    "service's callback.": "service_introspection configure_introspection",
    "Type descriptions and their hashes are not available here (ROS 2 has them since Iron): `ros2 interface show` prints "
    "a type's definition.": "type_description_service type_hash",
    "Policies that adapt to the other side are not available here (ROS 2 has them since Iron): name the policy, such as "
    "ReliabilityPolicy.RELIABLE or BEST_EFFORT; `ros2 topic info -v` shows what the other side has.": (
        "BEST_AVAILABLE qos_profile_best_available"
    ),
    "TimerInfo is not available here (in Python, ROS 2 has it since Jazzy): a timer's callback has no parameter, and "
    "node.get_clock().now() is the time.": "TimerInfo",
    "AsyncNode and EventsExecutor are not available here: use Node and SingleThreadedExecutor. Callbacks of a Node may be "
    "`async def`: they can await client.call_async(request).": "experimental AsyncNode EventsExecutor",
}
"""What to do without each part, and the modules and names by which programs ask for it."""

_LEFT_OUT = {word: advice for advice, words in _LEFT_OUT_PARTS.items() for word in words.split()}


def _left_out(path: str) -> str:
    """What to do without a module or attribute that a real rclpy has; an empty text for any other path."""
    package, *words = path.split(".")
    return next((_LEFT_OUT[word] for word in words if word in _LEFT_OUT), "") if package == "rclpy" else ""


# -- devices that a program in the simulation reaches in another way, or not at all: keys, a screen, a user -------------

_KEYS = (
    "Here a program reads keys from sys.stdin (with termios, tty and select), by pynput.keyboard or by curses; you press "
    "them in lesson.teleop(), or by lesson.press('w')."
)
_SCREEN = (
    "A program here has no screen for a window of its own. lesson.dashboard() may show the same; the "
    "program's nodes can do their work without the window."
)
_ANSWER = (
    "Nobody is here to answer input(). Give the lines beforehand (lesson.run(5, input=['3']), `ros2 run … < FILE` or "
    "`echo 3 | ros2 run …`), or the values as arguments (sys.argv) or parameters (-p name:=value)."
)
_READ_KEYS = ("pynput", "keyboard", "sshkeyboard", "getkey", "readchar", "inputs")
_SHOW_WINDOWS = ("PyQt5", "PyQt6", "PySide2", "PySide6", "pygame", "kivy", "tkinter", "_tkinter", "customtkinter", "wx")


def device_advice(error: BaseException) -> str:
    """A sentence about a device that is not there."""
    kind, text = type(error).__name__, str(error)
    if kind == "StdinNotImplementedError" or (kind == "EOFError" and "reading a line" in text):
        return _ANSWER
    if type(error).__module__ in ("termios", "_curses", "tty") or (kind, text) == ("UnsupportedOperation", "fileno"):
        return _KEYS
    return _SCREEN if re.search(r"no display|could ?n[o']t connect to display|cannot open display", text) else ""


# -- imports -----------------------------------------------------------------------------------------------------------

_FROM_ROS_1 = {
    "rospy": "rospy is ROS 1's library; in ROS 2 it is rclpy.",
    "roslib": "roslib is ROS 1's; in ROS 2 it is not needed.",
    "rospkg": "rospkg is ROS 1's; in ROS 2 use ament_index_python.packages.get_package_share_directory.",
    "actionlib": "actionlib is ROS 1's; in ROS 2 it is rclpy.action.",
    "tf": "tf is ROS 1's; in ROS 2 it is tf2_ros, and for angles tf_transformations.",
    "rclcpp": "rclcpp is the library of C++; in Python it is rclpy.",
}
_BUILD = "build it (colcon build), then source install/setup.bash"
_ON_PYPI = {"cv2": "opencv-python", "PIL": "pillow", "yaml": "pyyaml", "serial": "pyserial", "sklearn": "scikit-learn"}


def import_advice(error: BaseException) -> str:
    """A sentence about a failed import."""
    if isinstance(error, ModuleNotFoundError) and error.name:
        return _no_module(error.name)
    if not isinstance(error, ImportError) or not error.name or "Did you mean" in str(error):
        return ""
    match = re.match(r"cannot import name '(\w+)'", str(error))
    return _no_name(error.name, match[1]) if match else ""


def _no_module(name: str) -> str:
    top = name.partition(".")[0]
    if top in _FROM_ROS_1:
        return _FROM_ROS_1[top]
    if top in _READ_KEYS or top in _SHOW_WINDOWS:
        device = _KEYS if top in _READ_KEYS else _SCREEN
        turtle = " If it has none, an editor may have inserted a line like `from turtle import …`: delete that."
        return f"{top} is installed separately from ROS 2. {device}{turtle if 'tkinter' in top else ''}"
    if known := missing_module(top) or _left_out(name) or _parent(name):
        return known
    site = sorted(path.name for path in (Path(__file__).parents[1] / "site").iterdir() if path.is_dir())
    close = nearest(top, [*registry.packages(), *site], 0.8)
    return f"Did you mean '{close}'?" if close else _of_ones_own(top)


def _parent(name: str) -> str:
    """What a module that is there has, instead of the submodule that is not."""
    above, _, last = name.rpartition(".")
    module = sys.modules.get(above)
    if module is None:
        return ""
    if above in registry.packages():
        has = [folder for folder in FOLDERS if registry.package(above).names_in(folder)]
        return did_you_mean(last, has) or f"The package {above} has {' and '.join(has)}, and no {last}."
    top = above.partition(".")[0]
    source = current_packages().get(top).source if top in current_packages() else None
    if source is not None and source.joinpath(*above.split("."), last).is_dir():
        return f"The folder {last} is there, but not in setup.py: write packages=find_packages(), and build again."
    inner = [each.name for each in pkgutil.iter_modules(getattr(module, "__path__", []))]
    inner += [key for key, value in vars(module).items() if isinstance(value, ModuleType)]  # launch's have no file
    return _like(last, inner) or f"There is a module {above}, but it has no module {last}."


def _of_ones_own(name: str) -> str:
    sources = [path.parent for path in Path.cwd().glob("src/**/package.xml") if path.parent.name == name]
    if sources or (Path.cwd() / "src" / name).is_dir():
        return f"There is a package {name} in src: {_BUILD}."
    if re.search(r"_(msgs|srvs|actions|interfaces?)$", name):
        return f"Is the name spelled correctly? Packages of messages are built here: put {name} into src, {_BUILD}."
    return (
        "Is the name spelled correctly? A package of your own is found when it is built (colcon build) and sourced "
        "(source install/setup.bash); a module beside the program, when its package is installed; "
        f"any other when it is installed for this Python (pip install {_ON_PYPI.get(name, name)})."
    )


def _no_name(module: str, name: str) -> str:
    """What a module has instead of a name. For a package's interfaces, those of its other folders, too."""
    package, _, folder = module.partition(".")
    if left_out := _left_out(f"{module}.{name}"):
        return left_out
    if package not in registry.packages() or folder not in ("", *FOLDERS):
        return _like(name, dir(sys.modules.get(module)))
    owner = registry.package(package)
    for each in FOLDERS:
        if name in owner.names_in(each):
            return f"It is in {package}.{each}: from {package}.{each} import {name}"
    if close := did_you_mean(name, [known for each in FOLDERS for known in owner.names_in(each)]):
        return close
    if package not in INSTALLED_SEPARATELY or owner.directory.parent != SHARE:
        return ""
    return f"{name} is not in {package} here: if a robot has it, put that package's sources into src, {_BUILD}."


def _like(name: str, known: list[str]) -> str:
    return did_you_mean(name, [each for each in known if not each.startswith("_")])
