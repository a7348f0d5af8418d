"""Which ROS 2 there is in this Python: a real one that was sourced, or the simulated one with the packages that it brings."""

from __future__ import annotations

import importlib.util
from collections.abc import Callable
from importlib.util import find_spec
from pathlib import Path

from ..ros.ament.package import Package, Target
from ..ros.tools import demo_packages, program, tf2_packages

# -- sourced ------------------------------------------------------------------------------------------------------
# Which ROS 2 there is in this Python: a real one that was sourced, or the simulated one of this package alone.

HERE = Path(__file__).resolve().parents[1]


def real_ros() -> str:
    """Where the rclpy of a real ROS 2 is; "" where only the simulated one would be imported. Nothing is imported."""
    found = importlib.util.find_spec("rclpy")
    if found is None or found.origin is None:
        return "nowhere"
    return "" if Path(found.origin).resolve().is_relative_to(HERE) else found.origin


# -- underlay -----------------------------------------------------------------------------------------------------
# The packages with programs that a fresh ROS 2 has, below those of a learner: turtlesim, tf2, the demos.

SIMULATOR: Callable[[], object] = program("turtle_lesson.turtlesim.node")
"""What runs the turtle simulator."""


def underlay_packages() -> list[Package]:
    """All of them, so that `ros2 run`, `ros2 pkg` and launch files find them."""
    others = ("draw_square", "mimic")
    programs: dict[str, Target] = {name: program(f"turtle_lesson.turtlesim.{name}") for name in others}
    programs["turtle_teleop_key"] = program("turtle_lesson.turtlesim.teleop_turtle_key")
    turtlesim = Package("turtlesim", HERE / "turtlesim", executables={"turtlesim_node": SIMULATOR, **programs})
    return [turtlesim, *tf2_packages(), *demo_packages(), *_of_pypi()]


def _of_pypi() -> list[Package]:
    """`ros2 run xacro xacro FILE`, where the Python package xacro is installed."""
    spec = find_spec("xacro")
    if spec is None or spec.origin is None:
        return []
    return [Package("xacro", Path(spec.origin).parent, executables={"xacro": program("xacro")})]
