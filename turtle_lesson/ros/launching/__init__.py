"""Carrying out a launch: from files to descriptions, from descriptions to running nodes, and what `ros2 launch` prints.

    handle = launch_file(world, path, {"rate": "5.0"})      # starts the nodes and returns at once
    handle.stop()                                            # as Ctrl-C in a terminal

A description is evaluated in the cell that asks for it; its processes start at the current instant and run when the
world runs. Python programs come up one after the other, each 0.3 s of robot time after the one before, and all others
(turtlesim, echo) at once. `handle.wait_until_up()` lets that time pass.
"""

from __future__ import annotations

from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .errors import LaunchError, find_launch_file

if TYPE_CHECKING:
    from .service import LaunchHandle, launch_arguments, launch_description, launch_file, show_arguments

__all__ = [
    "LaunchError",
    "LaunchHandle",
    "find_launch_file",
    "launch_arguments",
    "launch_description",
    "launch_file",
    "show_arguments",
]

_SITE = Path(__file__).resolve().parents[1] / "site"


def __getattr__(name: str) -> Any:
    """What needs the package `launch` is imported when it is first asked for.

    Raises LaunchError if another package named launch or launch_ros hides the simulation's.
    """
    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    for package in ("launch", "launch_ros", "launch_xml", "launch_yaml"):
        spec = find_spec(package)
        if spec is None or not spec.origin or _SITE not in Path(spec.origin).resolve().parents:
            raise LaunchError(
                f"`import {package}` finds {spec.origin if spec else 'nothing'}, not the simulation's package",
                None,
                "If a real ROS 2 is sourced, start Jupyter from a terminal without it; if pip installed it, "
                f"pip uninstall {package}.",
            )
    from . import service

    return getattr(service, name)
