"""What a lower room has done by a room above it, which it must not import: one name a need.

`turtle_lesson/ros/__init__.py` says which function of which room each of them is; `is_page` is the lesson's.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import threading

    from launch.actions._processes import Program

    from .ament.index import PackageIndex
    from .launching.service import LaunchService
    from .runtime.world import World
    from .sim.process import Process
    from .sim.strand import Strand

# -- sim asks stdlib ---------------------------------------------------------------------------------------------------

wind_down: Callable[[Process], None]
"""Waits for the threads of a process whose main program has ended."""
name_of_wait: Callable[[Strand], str]
"""What a strand waits for, as it stands in the program."""

# -- stdlib asks itself, without a circle of imports ---------------------------------------------------------------------

thread_of: Callable[[Strand], threading.Thread]
"""The thread object of a strand."""

# -- stdlib asks runtime and launching ---------------------------------------------------------------------------------

current_process: Callable[[], Process]
"""The process that the running code belongs to."""
current_world: Callable[[], World]
"""The world that the running code lives in."""
plan_child: Callable[[Any, bool], tuple[Any, list[str]] | None]
"""The program by which the world runs a command of `subprocess` or (True) a shell's line, and its arguments; None if the
computer is to run it."""

# -- idl asks runtime --------------------------------------------------------------------------------------------------

learners_folder: Callable[[], Path]
"""The folder with the learner's files."""

# -- runtime asks ament, hints and the lesson --------------------------------------------------------------------------

package_index: Callable[[], PackageIndex]
"""Makes the index of packages of a new world."""
advise_about_errors: Callable[[], None]
"""Has each error that is shown be looked at for advice."""


def is_page(place: Path) -> bool:
    """Whether a file is a page of the lesson, which no command changes."""
    return False


# -- launch asks launching ---------------------------------------------------------------------------------------------

launch_service: Callable[[], LaunchService]
"""What carries out a program's own `LaunchService`."""
program_of_command: Callable[..., Program]
"""What the words of an `ExecuteProcess` run."""
output_of_command: Callable[[str], str]
"""What the words of a `Command` print."""

# -- launching asks cli ------------------------------------------------------------------------------------------------

commands_of_text: Callable[[str], list[tuple[str, list[str]]]]
"""The commands of a shell's text, each with the sign before it."""
run_arguments: Callable[[list[str]], Any]
"""The arguments of `ros2 run`."""
run_ros2: Callable[[list[str]], int]
"""Runs a `ros2` command in the process that runs, and gives its exit code."""
advice_about_command: Callable[[list[str]], str]
"""What to do instead of a command that is not here."""
