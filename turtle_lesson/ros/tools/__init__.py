"""Programs that come with a ROS 2: `ros2 run tf2_ros …`, `tf2_tools …`, `demo_nodes_py …`. Each is a plain rclpy program.

`tf2` has those about frames, `demos` a talker, a listener, and a service that adds; `demo_nodes_cpp` has launch files for them.
"""

from __future__ import annotations

import importlib
import sys
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING

from ..ament.package import Package, Target

if TYPE_CHECKING:
    from rclpy.node import Node

HERE = Path(__file__).resolve().parent
SITE = HERE.parent / "site"


def tf2_packages() -> list[Package]:
    """The packages with these programs, for a world to have."""
    programs = {"tf2_ros": ("static_transform_publisher", "tf2_echo"), "tf2_tools": ("view_frames",)}
    return [
        Package(package, SITE / "tf2_ros", executables={name: program(f"{__name__}.tf2", name) for name in names})
        for package, names in programs.items()
    ]


def demo_packages() -> list[Package]:
    """The demos, as Python packages and as what they are called where they are C++."""
    demos = f"{__name__}.demos"
    names = ("listener", "add_two_ints_server", "add_two_ints_client")
    of_both: dict[str, Target] = {name: program(demos, name) for name in names}
    of_both["add_two_ints_client_async"] = of_both["add_two_ints_client"]  # which print the same
    of_python = {**of_both, "talker": program(demos, "talker", 0, 'Publishing: "{}"')}
    of_cpp = {
        **of_both,
        "talker": program(demos, "talker", 1, "Publishing: '{}'"),
        "listener_best_effort": program(demos, "listener_best_effort"),
    }
    cpp = HERE / "demo_nodes_cpp"
    launch_files = {path.relative_to(cpp).as_posix(): path for path in cpp.glob("launch/*/*_launch.*")}
    launch_files |= {name.replace("_launch.", ".launch."): path for name, path in launch_files.items()}  # as in Humble
    return [
        Package("demo_nodes_py", HERE / "demos", executables=of_python),
        Package("demo_nodes_cpp", cpp, executables=of_cpp, installed=launch_files),
    ]


def program(module: str, function: str = "main", *arguments: object) -> Callable[[], object]:
    """What calls a function of a module, which is imported only then."""
    return lambda: sys.exit(getattr(importlib.import_module(module), function)(*arguments))


def spin(make: Callable[[], Node]) -> int:
    """Initialize rclpy, make a program's node, and spin it until Ctrl-C; the exit code."""
    import rclpy
    from rclpy.executors import ExternalShutdownException

    with suppress(KeyboardInterrupt, ExternalShutdownException):
        rclpy.init()
        rclpy.spin(make())
    return 0
