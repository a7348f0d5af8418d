"""Carrying out a launch: from files to descriptions, from descriptions to running nodes, and what `ros2 launch` prints.

    handle = launch_file(world, path, {"rate": "5.0"})      # starts the nodes and returns at once
    handle.stop()                                            # as Ctrl-C in a terminal

A description is evaluated in the cell that asks for it; its processes start at the current instant and run when the
world runs. Python programs come up one after the other, each 0.3 s of robot time after the one before, and all others
(turtlesim, echo) at once. `handle.wait_until_up()` lets that time pass.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

from .errors import LaunchError, find_launch_file

if TYPE_CHECKING:
    from .service import LaunchHandle, launch_description, launch_file, show_arguments

__all__ = [
    "LaunchError",
    "LaunchHandle",
    "find_launch_file",
    "launch_description",
    "launch_file",
    "show_arguments",
]


def __getattr__(name: str) -> Any:
    """What needs the package `launch` is imported when it is first asked for."""
    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(importlib.import_module(".service", __name__), name)
