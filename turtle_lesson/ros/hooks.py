"""What a lower room has done by a room above it, which it must not import: one name a need, and the function that meets it.

Each is imported at its first call. `is_page` is the lesson's.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from importlib import import_module
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


def _late(module: str, name: str) -> Callable[..., Any]:
    """A function of a module of this folder, which is imported at the first call."""

    @cache
    def function() -> Callable[..., Any]:
        found: Callable[..., Any] = getattr(import_module(f"{__package__}.{module}"), name)
        return found

    return lambda *arguments, **keywords: function()(*arguments, **keywords)


# -- sim asks stdlib ---------------------------------------------------------------------------------------------------

wind_down: Callable[[Process], None] = _late("stdlib.threads", "wind_down")
"""Waits for the threads of a process whose main program has ended."""
name_of_wait: Callable[[Strand], str] = _late("stdlib.deadlock", "wait_of")
"""What a strand waits for, as it stands in the program."""

# -- stdlib asks itself, without a circle of imports ---------------------------------------------------------------------

thread_of: Callable[[Strand], threading.Thread] = _late("stdlib.threads", "thread_of")
"""The thread object of a strand."""

# -- stdlib asks runtime and launching ---------------------------------------------------------------------------------

current_process: Callable[[], Process] = _late("runtime.world", "current_process")
"""The process that the running code belongs to."""
current_world: Callable[[], World] = _late("runtime.world", "current_world")
"""The world that the running code lives in."""
plan_child: Callable[[Any, bool], tuple[Any, list[str]] | None] = _late("launching.commands", "plan")
"""The program by which the world runs a command of `subprocess` or (True) a shell's line, and its arguments; None if the
computer is to run it."""

# -- idl asks runtime --------------------------------------------------------------------------------------------------

learners_folder: Callable[[], Path] = _late("runtime.files", "folder")
"""The folder with the learner's files."""

# -- runtime asks ament, hints and the lesson --------------------------------------------------------------------------

package_index: Callable[[], PackageIndex] = _late("ament.index", "PackageIndex")
"""Makes the index of packages of a new world."""
advise_about_errors: Callable[[], None] = _late("hints.advice", "install")
"""Has each error that is shown be looked at for advice."""


def is_page(place: Path) -> bool:
    """Whether a file is a page of the lesson, which no command changes."""
    return False


# -- launch asks launching ---------------------------------------------------------------------------------------------

launch_service: Callable[[World], LaunchService] = _late("launching.service", "LaunchService")
"""What carries out a program's own `LaunchService` in a world."""
program_of_command: Callable[..., Program] = _late("launching.commands", "program")
"""What the words of an `ExecuteProcess` run."""
output_of_command: Callable[[str], str] = _late("launching.commands", "output_of")
"""What the words of a `Command` print."""

# -- launching asks cli ------------------------------------------------------------------------------------------------

commands_of_text: Callable[[str], list[tuple[str, list[str]]]] = _late("cli.run_command", "commands_of_text")
"""The commands of a shell's text, each with the sign before it."""
run_arguments: Callable[[list[str]], Any] = _late("cli.run_command", "run_arguments")
"""The arguments of `ros2 run`."""
run_ros2: Callable[[list[str]], int] = _late("cli.run_command", "run_here")
"""Runs a `ros2` command in the process that runs, and gives its exit code."""
advice_about_command: Callable[[list[str]], str] = _late("cli.cells", "advice")
"""What to do instead of a command that is not here."""
