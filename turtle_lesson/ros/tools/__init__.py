"""Programs that come with a ROS 2: `ros2 run tf2_ros …`, `ros2 run tf2_tools …`. Each is plain rclpy.

- ``tf2_echo``: prints the transform between two frames, again and again;
- ``tf2_monitor``: says how old transforms are when they come;
- ``static_transform_publisher``: tells of a frame that never moves;
- ``view_frames``: draws the tree of all frames.
"""

from __future__ import annotations

import importlib
import sys
from collections.abc import Callable
from functools import partial
from pathlib import Path

from ..workspace.package import Package

SITE = Path(__file__).resolve().parents[1] / "site"
_PROGRAMS = {
    "tf2_ros": ("static_transform_publisher", "tf2_echo", "tf2_monitor"),
    "tf2_tools": ("view_frames",),
}


def tf2_packages() -> list[Package]:
    """The packages with these programs, for a world to have."""
    return [
        Package(package, SITE / "tf2_ros", executables={name: program(f"{__name__}.{name}") for name in names})
        for package, names in _PROGRAMS.items()
    ]


def program(module: str) -> Callable[[], object]:
    """What runs the `main()` of a module, which is imported only then."""
    return partial(_run, module)


def _run(module: str) -> object:
    sys.exit(importlib.import_module(module).main())
