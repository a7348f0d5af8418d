"""Carrying out a launch: from files to descriptions, from descriptions to running nodes, and what `ros2 launch` prints.

    handle = launch_file(world, path, {"rate": "5.0"})      # starts the nodes and returns at once
    handle.stop()                                            # as Ctrl-C in a terminal

A description is evaluated in the cell that asks for it; its processes start at the current instant and run when the
world runs. Python programs come up one after the other, each 0.3 s of robot time after the one before, and all others
(turtlesim, echo) at once. `handle.wait_until_up()` lets that time pass.
"""

from __future__ import annotations

import sys
from collections.abc import Mapping
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .errors import LaunchError

if TYPE_CHECKING:
    from launch import LaunchDescription

    from ..runtime.world import World
    from .start import LaunchArgument, LaunchHandle

__all__ = [
    "LaunchError",
    "find_launch_file",
    "launch_arguments",
    "launch_description",
    "launch_file",
    "show_arguments",
]


def find_launch_file(world: World, package: str, file_name: str) -> Path:
    """The launch file of this name that a package has installed.

    Raises:
        LaunchError: with the words of `ros2 launch`, and what to try.
    """
    from ..ament import index

    try:
        return index.find_launch_file(world.packages, package, file_name)
    except index.PackageNotFoundError as error:
        reason = f"Package '{package}' not found: {error.text!r}"
        raise LaunchError(reason, None, error.hint) from None
    except index.LaunchFileNotFoundError as error:
        raise LaunchError(error.text, None, error.hint) from None


def launch_file(
    world: World,
    path: Path | str,
    arguments: Mapping[str, object] | None = None,
    *,
    show_all_output: bool = False,
) -> LaunchHandle:
    """Carry out a launch file.

    Args:
        world: where the nodes are to run.
        path: the file.
        arguments: its launch arguments, as `name:=value` on a command line; values become text.
        show_all_output: whether all that its processes print is shown (`ros2 launch -a`).

    Raises:
        LaunchError: if the file cannot be carried out; nothing was started then.
    """
    handle: LaunchHandle = _start().launch_file(world, Path(path), arguments or {}, show_all_output)
    return handle


def launch_description(
    world: World, description: LaunchDescription, arguments: Mapping[str, object] | None = None
) -> LaunchHandle:
    """Carry out a description that was made in a notebook cell. As `launch_file` otherwise."""
    handle: LaunchHandle = _start().launch_description(world, description, arguments or {})
    return handle


def launch_arguments(world: World, path: Path | str) -> list[LaunchArgument]:
    """The arguments that a launch file takes.

    Raises:
        LaunchError: if the file cannot be loaded.
    """
    arguments: list[LaunchArgument] = _start().launch_arguments(world, Path(path))
    return arguments


def show_arguments(world: World, path: Path | str) -> str:
    """What `ros2 launch … --show-args` prints.

    Raises:
        LaunchError: if the file cannot be loaded.
    """
    from .start import as_shown

    return as_shown(launch_arguments(world, path))


_SITE = Path(__file__).resolve().parents[1] / "site"


def _start() -> Any:
    """The module that does the work, once `import launch` is sure to find the simulation's package.

    Raises:
        LaunchError: if another package named launch or launch_ros hides the simulation's.
    """
    if str(_SITE) not in sys.path:
        sys.path.append(str(_SITE))  # after all others
    for name in ("launch", "launch_ros", "launch_xml", "launch_yaml"):
        spec = find_spec(name)
        if spec is None or not spec.origin or _SITE not in Path(spec.origin).resolve().parents:
            raise LaunchError(
                f"`import {name}` finds {spec.origin if spec else 'nothing'}, not the simulation's package",
                None,
                "If a real ROS 2 is sourced, start Jupyter from a terminal without it; if pip installed it, "
                f"pip uninstall {name}.",
            )
    from . import start

    return start


def __getattr__(name: str) -> Any:
    """LaunchHandle and LaunchArgument, imported when first asked for, since they need the package launch."""
    if name in ("LaunchHandle", "LaunchArgument"):
        from . import start

        return getattr(start, name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
