"""What a robot's ROS 2 has: the packages that builds find, and those that are not here (windows, Gazebo, drivers), and why.

The names, in `catalog.txt`, are those of packages in the ROS index (https://index.ros.org), and of programs that launch
files start.
"""

from __future__ import annotations

import re
from pathlib import Path

from .package import NotHereError, sections

_WINDOWS = "there are no windows here; lesson.dashboard(), lesson.scene() and the lesson's plots draw into the page"
_GAZEBO = "there is no Gazebo here; the simulated world is turtlesim"
_XACRO = "the Python package xacro is not installed: pip install xacro (in a notebook: %pip install xacro)"
_OTHER = "it is not part of this simulation"


def _words(section: str) -> tuple[str, ...]:
    """The words of a section of `catalog.txt`."""
    return tuple(sections("catalog.txt")[section].split())


_WITH_MODULES = _words("programs and modules")
"""Packages that have programs for launch files, and modules for programs."""

_ONLY_IMPORTED = _words("modules")
"""Packages that programs import, and launch files and builds hardly ever name."""

_NAMES = {
    _WINDOWS: _words("names: windows"),
    _GAZEBO: _words("names: gazebo"),
    _XACRO: ("xacro",),
    _OTHER: _WITH_MODULES + _words("names: other"),
}
_BEGINNINGS = {
    why: _words(f"beginnings: {kind}") for why, kind in ((_WINDOWS, "windows"), (_GAZEBO, "gazebo"), (_OTHER, "other"))
}
_INTERFACES = ("_msgs", "_interfaces", "_srvs", "_actions")
_PLACE = Path("/opt/ros/not_here/share")


def why_not_here(name: str) -> str:
    """Why a package or program that robots have is not available; nothing for a name that is none of theirs."""
    for why, names in _NAMES.items():
        if name in names:
            return why
    for why, beginnings in _BEGINNINGS.items():
        if name.startswith(beginnings) and not name.endswith(_INTERFACES):
            return why
    return ""


_INSTEAD = {
    "rosbag2_py": " Bags are recorded, played and described by `ros2 bag` and by lesson.record().",
    "sensor_msgs_py": " The messages themselves, such as PointCloud2, are in sensor_msgs.msg.",
    "tf2_sensor_msgs": " The types of geometry_msgs can be transformed: import tf2_geometry_msgs.",
}


def missing_module(name: str) -> str:
    """A sentence about a package that robots have and that cannot be imported here; nothing for every other name."""
    if name not in _WITH_MODULES and name not in _ONLY_IMPORTED:
        return ""
    return (
        f"{name} is a package of ROS 2 that is not available here: a program that needs it runs on a robot "
        f"where it is installed (sudo apt install ros-$ROS_DISTRO-{name.replace('_', '-')}).{_INSTEAD.get(name, '')}"
    )


def place_of(name: str) -> Path:
    """A folder that does not exist, and stands for an absent package's share folder in a launch file."""
    return _PLACE / name


def package_of(path: str | Path) -> str:
    """The absent package whose folder a path leads into; nothing for every other path."""
    path = Path(path)
    return path.relative_to(_PLACE).parts[0] if path.is_relative_to(_PLACE) and path != _PLACE else ""


def left_out(what: str, name: str) -> NotHereError:
    """The error for something of an absent package, such as its program or launch file."""
    return NotHereError(what, why_not_here(name))


CMAKE_PACKAGES = frozenset(_words("found by find_package"))
"""What `find_package` finds, besides packages of interfaces."""

PYTHON_PACKAGES = frozenset(_words("Python packages"))
"""Packages that package.xml may name, but that `find_package` cannot find: they are Python alone."""

CMAKE_COMMANDS = frozenset(_words("commands of CMake"))
"""The commands that CMake itself has."""

_LISTED = dict(
    line.split(": ", 1) for line in re.split(r"\n(?! )", sections("catalog.txt")["commands by package"].strip())
)


def _commands(package: str) -> frozenset[str]:
    """The commands that are listed for a package; the name of another package stands for all of its commands."""
    return frozenset().union(*(_commands(word) if word in _LISTED else {word} for word in _LISTED[package].split()))


COMMANDS_OF = {package: _commands(package) for package in _LISTED}
"""The commands that each package brings to those who find it."""


def brought_by(command: str) -> list[str]:
    """The packages that bring a command, the most usual first."""
    return [package for package, commands in COMMANDS_OF.items() if command in commands]
