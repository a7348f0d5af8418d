"""Modules, and names in modules, that are not there."""

from __future__ import annotations

import difflib
import re
import sys
from pathlib import Path
from types import ModuleType

from ..ament.catalog import missing_module
from ..idl.names import did_you_mean
from ..idl.registry import FOLDERS, INSTALLED_SEPARATELY, SHARE, registry
from .attributes import module_left_out, name_left_out

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
    if top in _FOR_ROBOTS_TOO:
        return f"{top} is a Python package that works here, too, once it is installed: {_pip_install(top)}."
    if missing := missing_module(top):
        return missing
    if rest and (parent := module_left_out(name) or _newer(top, name) or _parent(name)):
        return parent
    site = sorted(path.name for path in (Path(__file__).parents[1] / "site").iterdir() if path.is_dir())
    close = difflib.get_close_matches(top, [*registry.packages(), *site], n=1, cutoff=0.8)
    return f"Did you mean '{close[0]}'?" if close else _of_ones_own(top)


def _pip_install(name: str) -> str:
    return f"pip install {_ON_PYPI.get(name, name)} (in a notebook: %pip install {_ON_PYPI.get(name, name)})"


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
    from ..ament.index import current_packages

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

_FOR_ROBOTS_TOO = ("xacro",)
"""Packages of PyPI that programs for robots use, and that need nothing of ROS's own to work."""

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
