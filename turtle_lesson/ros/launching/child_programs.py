"""Which commands of `subprocess` and `os.system` the world runs, and by which program; `stdlib/subprocesses.py` runs it."""

from __future__ import annotations

import os
import re
import sys
from functools import partial
from typing import Any, NoReturn

from greenlet import getcurrent
from launch import LaunchDescription, LaunchService
from launch.actions import IncludeLaunchDescription
from launch.launch_description_sources import AnyLaunchDescriptionSource

from ..ament.errors import PackageNotFoundError
from ..runtime.world import current_world
from ..sim.strand import Strand
from ..stdlib.ownership import notebook_here
from . import commands, find_launch_file
from .errors import LaunchError

_SETUP = re.compile(r"^\s*(?:(?:source|\.)\s+\S*setup\.\w+\s*(?:&&|;)\s*)+")
_OF_THE_WORLD = re.compile(r"(?:^|[\s;&|('\"])(?:ros2|colcon|killall|pkill)\b")


def plan(args: Any, shell: bool) -> tuple[Any, list[str]] | None:
    """The program's file or function, by which the world runs a command, and its arguments; None if the computer is to.

    Raises:
        NotImplementedError: for a command that the computer could not run, and the world cannot.
    """
    one = isinstance(args, (str, bytes, os.PathLike))
    words = [os.fsdecode(args)] if one else [os.fsdecode(word) for word in args][: 1 if shell else None]
    if shell and words:
        words[0] = _SETUP.sub("", words[0])  # what a setup file sets up is there already
    line = " ".join(words)
    if not line.strip() or (type(getcurrent()) is not Strand and not _of_a_cell(line)):
        return None
    if line.startswith("ros2 launch ") and not (shell and set(line) & set(";&|<>")):
        words = line.split() if shell else words
        return partial(_launch, words[2:]), words
    try:
        program = commands.program(words, shell=shell)
    except (commands.UnknownCommand, PackageNotFoundError) as error:
        if line.startswith("ros2 run "):  # which only complains
            return partial(_fail, f"{error}"), words
        if _OF_THE_WORLD.search(line):
            raise NotImplementedError(_refusal(line, error)) from None
        return None
    return program.target, program.argv


def _of_a_cell(line: str) -> bool:
    """Whether a cell, or a launch file that it loads, runs a `ros2` command, which only the world has."""
    notebook = notebook_here()
    return notebook is not None and not notebook.simulation.running and line.split()[:1] == ["ros2"]


def _refusal(line: str, error: Exception) -> str:
    said = f"{error}" if not str(error).startswith("ExecuteProcess(") else "it is a program of the operating system"
    why = f"{line!r} cannot be started by a program here ({getattr(error, 'why', said)})"
    return f"{why}: ros2 commands, Python files, echo and sleep can. {getattr(error, 'hint', '')}".strip()


def _launch(words: list[str]) -> None:
    """`ros2 launch` as a program of its own, which goes on until its programs have ended."""
    given = [(name, value) for name, sign, value in (word.partition(":=") for word in words) if sign]
    names = [word for word in words if ":=" not in word and not word.startswith("-")]
    try:
        path = find_launch_file(current_world(), *names) if len(names) == 2 else "".join(names)
    except LaunchError as error:
        _fail(error.console)
    source = AnyLaunchDescriptionSource(str(path))
    service = LaunchService(argv=words)
    service.include_launch_description(LaunchDescription([IncludeLaunchDescription(source, launch_arguments=given)]))
    sys.exit(service.run())


def _fail(sentence: str) -> NoReturn:
    """End the program with a complaint."""
    print(sentence, file=sys.stderr)
    sys.exit(1)
