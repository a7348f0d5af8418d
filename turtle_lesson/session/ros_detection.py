"""Whether a real ROS 2 is sourced in this Python, and the packages that the simulated one brings: its underlay."""

from __future__ import annotations

from collections.abc import Callable
from importlib.util import find_spec
from pathlib import Path

from ..ros.ament.package import Package, Target
from ..ros.tools import demo_packages, program, tf2_packages

HERE = Path(__file__).resolve().parents[1]


def real_ros() -> str:
    """Where the rclpy of a real ROS 2 is; "" where only the simulated one would be imported. Nothing is imported."""
    found = find_spec("rclpy")
    if found is None or found.origin is None:
        return "nowhere"
    return "" if Path(found.origin).resolve().is_relative_to(HERE) else found.origin


SIMULATOR: Callable[[], object] = program("turtle_lesson.turtlesim.node")
"""What runs the turtle simulator."""


def underlay_packages() -> list[Package]:
    """The packages of a fresh ROS 2 whose programs `ros2 run` and launch files find: turtlesim, tf2, demos, xacro."""
    modules = {"draw_square": "draw_square", "mimic": "mimic", "turtle_teleop_key": "teleop_turtle_key"}
    programs: dict[str, Target] = {
        name: program(f"turtle_lesson.turtlesim.{module}") for name, module in modules.items()
    }
    turtlesim = Package("turtlesim", HERE / "turtlesim", executables={"turtlesim_node": SIMULATOR, **programs})
    packages = [turtlesim, *tf2_packages(), *demo_packages()]
    xacro = find_spec("xacro")  # a package of PyPI, which may be installed
    if xacro is not None and xacro.origin is not None:
        packages.append(Package("xacro", Path(xacro.origin).parent, executables={"xacro": program("xacro")}))
    return packages
