"""ROS 2 in one process: `README.md` beside this file tells its rooms, and how a message travels.

Here what lower rooms have done by higher ones (`hooks.py`) is connected. The rooms are imported when they are first needed.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from importlib import import_module
from typing import Any

from . import hooks


def _late(module: str, name: str) -> Callable[..., Any]:
    """A function of a module below this one, which is imported at the first call."""

    @cache
    def function() -> Callable[..., Any]:
        found: Callable[..., Any] = getattr(import_module(f"{__name__}.{module}"), name)
        return found

    return lambda *arguments, **keywords: function()(*arguments, **keywords)


hooks.wind_down = _late("stdlib.threads", "wind_down")
hooks.name_of_wait = _late("stdlib.deadlock", "wait_of")
hooks.thread_of = _late("stdlib.threads", "thread_of")
hooks.current_process = _late("runtime.world", "current_process")
hooks.current_world = _late("runtime.world", "current_world")
hooks.plan_child = _late("launching.commands", "plan")
hooks.learners_folder = _late("runtime.files", "folder")
hooks.package_index = _late("ament.index", "PackageIndex")
hooks.advise_about_errors = _late("hints.advice", "install")
hooks.launch_service = _late("launching.service", "service_here")
hooks.program_of_command = _late("launching.commands", "program")
hooks.output_of_command = _late("launching.commands", "output_of")
hooks.commands_of_text = _late("cli.run_command", "commands_of_text")
hooks.run_arguments = _late("cli.run_command", "run_arguments")
hooks.run_ros2 = _late("cli.run_command", "run_here")
hooks.advice_about_command = _late("cli.cells", "advice")
