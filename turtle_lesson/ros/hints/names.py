"""Names that nothing has: of attributes, methods, fields and variables, of modules, and of what modules hold."""

from __future__ import annotations

import difflib
import inspect
import re
import sys
import traceback
from pathlib import Path
from types import FrameType, ModuleType
from typing import Any

from ..ament.index import current_packages, missing_module
from ..idl.names import did_you_mean
from ..idl.registry import FOLDERS, INSTALLED_SEPARATELY, SHARE, registry
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
    return _variable(error) if isinstance(error, NameError) else ""


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
    **{name: f"from rclpy.{name.lower()} import {name}" for name in ("Node", "Duration", "Time", "Parameter")},
    **{name: f"from rclpy.action import {name}" for name in ("ActionServer", "ActionClient")},
    **{name: f"from rclpy.qos import {name}" for name in ("QoSProfile", "ReliabilityPolicy", "DurabilityPolicy")},
    **{name: f"from rclpy.executors import {name}" for name in ("MultiThreadedExecutor", "SingleThreadedExecutor")},
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
    """What to do without an attribute that a real rclpy's module or object has; an empty text for any other name.

    `owner` is the object or class that was asked, or the name of the module.
    """
    kinds = owner.__mro__ if isinstance(owner, type) else type(owner).__mro__
    homes = [owner] if isinstance(owner, str) else [kind.__module__ for kind in kinds]
    return _NAMES.get(name, "") if any(home.partition(".")[0] == "rclpy" for home in homes) else ""


# -- imports -----------------------------------------------------------------------------------------------------------

# Devices that a program in the simulation reaches in another way, or not at all: keys, a screen, a user who answers.

KEYS = (
    "Here a program reads keys from sys.stdin (with termios, tty and select), by pynput.keyboard or by curses; you press "
    "them in lesson.teleop(), or by lesson.press('w')."
)
SCREEN = (
    "A program here has no screen for a window of its own. lesson.dashboard() may show the same; the "
    "program's nodes can do their work without the window."
)
ANSWER = (
    "Nobody is here to answer input(). Give the lines beforehand (lesson.run(5, input=['3']), `ros2 run … < FILE` or "
    "`echo 3 | ros2 run …`), or the values as arguments (sys.argv) or parameters (-p name:=value)."
)

_BY_KIND = {
    "termios.error": KEYS, "_curses.error": KEYS, "tty.error": KEYS, "builtins.EOFError": ANSWER,
    "IPython.core.error.StdinNotImplementedError": ANSWER, "ipykernel.kernelbase.StdinNotImplementedError": ANSWER,
}  # fmt: skip
_SCREEN_WORDS = ("no display", "could not connect to display", "couldn't connect to display", "cannot open display")


def device_advice(error: BaseException) -> str:
    """A sentence about a device that is not there."""
    kind = f"{type(error).__module__}.{type(error).__qualname__}"
    text = str(error)
    if kind == "builtins.EOFError" and "reading a line" not in text:
        return ""
    if kind in _BY_KIND:
        return _BY_KIND[kind]
    if kind == "io.UnsupportedOperation" and text == "fileno":
        return KEYS
    return SCREEN if any(words in text for words in _SCREEN_WORDS) else ""


FROM_ROS_1 = {
    "rospy": "rospy is ROS 1's library; in ROS 2 it is rclpy.",
    "roslib": "roslib is ROS 1's; in ROS 2 it is not needed.",
    "rospkg": "rospkg is ROS 1's; in ROS 2 use ament_index_python.packages.get_package_share_directory.",
    "actionlib": "actionlib is ROS 1's; in ROS 2 it is rclpy.action.",
    "tf": "tf is ROS 1's; in ROS 2 it is tf2_ros, and for angles tf_transformations.",
    "moveit_commander": "moveit_commander is ROS 1's; there is no MoveIt here.",
    "dynamic_reconfigure": "dynamic_reconfigure is ROS 1's; in ROS 2 nodes have parameters.",
    "rclcpp": "rclcpp is the library of C++; in Python it is rclpy.",
}


def import_advice(error: BaseException) -> str:
    """A sentence about a failed import."""
    if isinstance(error, ModuleNotFoundError) and error.name:
        return _no_module(error.name)
    if not isinstance(error, ImportError) or not error.name or "Did you mean" in str(error):
        return ""
    match = re.match(r"cannot import name '(\w+)'", str(error))
    return _no_name(error.name, match[1]) if match else ""


def _no_module(name: str) -> str:
    top, _, rest = name.partition(".")
    if top in FROM_ROS_1:
        return FROM_ROS_1[top]
    if top in _DEVICES:
        return f"{top} is installed separately from ROS 2 ({_DEVICES[top][1]}). {_DEVICES[top][0]}"
    if top == "xacro":
        install = "pip install xacro (in a notebook: %pip install xacro)"
        return f"xacro is a Python package that works here, too, once it is installed: {install}."
    if missing := missing_module(top):
        return missing
    if rest and (parent := module_left_out(name) or _newer(top, name) or _parent(name)):
        return parent
    site = sorted(path.name for path in (Path(__file__).parents[1] / "site").iterdir() if path.is_dir())
    close = difflib.get_close_matches(top, [*registry.packages(), *site], n=1, cutoff=0.8)
    return f"Did you mean '{close[0]}'?" if close else _of_ones_own(top)


def _parent(name: str) -> str:
    """What a module that is there has, instead of the submodule that is not."""
    above, _, last = name.rpartition(".")
    module = sys.modules.get(above)
    if module is None:
        return ""
    if last in FOLDERS and above in registry.packages():
        has = [folder for folder in FOLDERS if registry.package(above).names_in(folder)]
        return f"The package {above} has {' and '.join(has)}, and no {last}."
    inner = set(FOLDERS) if above in registry.packages() else _submodules(module)
    if left_out := _left_out(above, last):
        return left_out
    return did_you_mean(last, inner) or f"There is a module {above}, but it has no module {last}."


def _left_out(above: str, last: str) -> str:
    """What to do about a folder of modules that is there, but that setup.py does not list."""
    top = above.partition(".")[0]
    packages = current_packages()
    source = packages.get(top).source if top in packages else None
    if source is None or not source.joinpath(*above.split("."), last).is_dir():
        return ""
    return (
        f"The folder {last} is there, but setup.py leaves it out: add '{above}.{last}' to its packages=[…], or write "
        "packages=find_packages(); then build again."
    )


def _submodules(module: ModuleType) -> set[str]:
    folders = list(getattr(module, "__path__", []))
    found = {path.stem for folder in folders for path in Path(folder).glob("*") if path.suffix in ("", ".py")}
    inner = [
        (f"{module.__name__}.{name}", value) for name, value in vars(module).items() if isinstance(value, ModuleType)
    ]
    found |= {
        value.__name__.rpartition(".")[2] for path, value in inner if value.__name__ == path
    }  # launch's have no file
    return {name for name in found if not name.startswith("_")}


_OF_MESSAGES = re.compile(r"_(msgs|srvs|actions|interfaces?)$")
"""What packages of messages are usually called."""


def _of_ones_own(name: str) -> str:
    sources = [path.parent for path in Path.cwd().glob("src/**/package.xml") if path.parent.name == name]
    if sources or (Path.cwd() / "src" / name).is_dir():
        return f"There is a package {name} in src: build it (colcon build), then source install/setup.bash."
    if _OF_MESSAGES.search(name):
        return (
            f"Is the name spelled correctly? Packages of messages are built here, too: put the folder {name} (with its "
            "package.xml, CMakeLists.txt and msg, srv or action) into src, build it (colcon build), and source "
            "install/setup.bash."
        )
    return (
        "Is the name spelled correctly? A package of your own is found when it is built (colcon build) and sourced "
        "(source install/setup.bash); a module beside the program, when its package is installed; "
        f"any other when it is installed for this Python (pip install {_ON_PYPI.get(name, name)})."
    )


_TURTLE = " If it has none, an editor may have inserted a line like `from turtle import …`: delete that."
_DEVICES = {
    **{name: (KEYS, f"pip install {name}") for name in ("pynput", "keyboard", "sshkeyboard", "getkey", "readchar", "inputs")},
    **{name: (SCREEN, f"pip install {name}") for name in ("PyQt5", "PyQt6", "PySide2", "PySide6", "pygame", "kivy")},
    **dict.fromkeys(("tkinter", "_tkinter"), (SCREEN + _TURTLE, "sudo apt install python3-tk")),
    "customtkinter": (SCREEN, "pip install customtkinter"), "wx": (SCREEN, "pip install wxPython"),
}  # fmt: skip
"""Modules that read keys or show windows: what stands in for that here, and how they are installed on a robot."""

_ON_PYPI = {"cv2": "opencv-python", "PIL": "pillow", "yaml": "pyyaml", "serial": "pyserial", "sklearn": "scikit-learn"}


def _newer(package: str, path: str) -> str:
    """What to write instead of what came after the releases that are known here (rclpy, pull request 1620)."""
    if package != "rclpy" or not re.search(r"\.(Async[A-Z]|async_)", path):
        return ""
    return (
        "AsyncNode is newer than the releases that are known here (up to Kilted). Callbacks of a Node may be `async def`, "
        "too: they can await client.call_async(request), and rclpy.spin(node) runs them."
    )


def _no_name(module: str, name: str) -> str:
    """What a module has instead of a name. For a package's interfaces, those of its other folders, too."""
    package, _, folder = module.partition(".")
    if newer := name_left_out(module, name) or _newer(package, f"{module}.{name}"):
        return newer
    if package in registry.packages() and folder in ("", *FOLDERS):
        owner = registry.package(package)
        for each in FOLDERS:
            if name in owner.names_in(each):
                return f"It is in {package}.{each}: from {package}.{each} import {name}"
        everything = [known for each in FOLDERS for known in owner.names_in(each)]
        return _like(name, everything) or _left_to_its_sources(package, name)
    found = sys.modules.get(module)
    return "" if found is None else _like(name, dir(found))


def _left_to_its_sources(package: str, name: str) -> str:
    """What to do about an interface that a robot may have, and of whose package only a part is built in."""
    if package not in INSTALLED_SEPARATELY or registry.package(package).directory.parent != SHARE:
        return ""
    return (
        f"{name} is not among the interfaces of {package} that are available here: if a robot has it, put that package's "
        "own sources into src, build it (colcon build), and source install/setup.bash."
    )


def _like(name: str, known: list[str]) -> str:
    return did_you_mean(name, [each for each in known if not each.startswith("__")])
