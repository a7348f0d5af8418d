"""What launch files can run here besides nodes.

`ExecuteProcess` runs `ros2 …`, Python files, and a few small commands, all in robot time: a command's words, or a shell's
text, become a program, which is a file or a function that is the main program of a process. `Command` gets what a command
prints.
"""

from __future__ import annotations

import contextlib
import importlib
import io
import os
import re
import shlex
import sys
import time
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path, PurePath
from typing import Any, NoReturn

from launch import LaunchDescription, LaunchService
from launch._entities import explained
from launch.actions import IncludeLaunchDescription
from launch.actions._processes import Program
from launch.launch_description_sources import AnyLaunchDescriptionSource
from launch.substitutions import SubstitutionFailure

from .. import hooks
from ..ament.index import current_packages, why_not_here
from ..ament.package import ExecutableNotFoundError, NotHereError, PackageNotFoundError
from ..runtime.world import current_world
from ..sim.errors import shown_path
from ..sim.process import INTERRUPTED
from ..sim.strand import running_strand
from ..stdlib.ownership import notebook_here
from .errors import LaunchError, find_launch_file

SHELLS = {"bash", "sh", "dash", "zsh"}
Main = Callable[[], int | None]


class UnknownCommand(NotImplementedError):
    """A command that is wrong, such as one that names a file that is not there."""


def program(words: Sequence[str], *, shell: bool = False) -> Program:
    """What the words of a command run; a `shell` takes them apart itself.

    Raises UnknownCommand if the command is wrong, NotHereError if only a robot's computer has it, and PackageNotFoundError
    or ExecutableNotFoundError if `ros2 run` names what is not there.
    """
    shown = " ".join(words)
    in_shell = PurePath(words[0]).name in SHELLS and len(words) == 3 and words[1] == "-c"
    commands = hooks.commands_of_text(shown if shell else words[2]) if shell or in_shell else [("", list(words))]
    if len(commands) == 1:
        words = commands[0][1]
        if found := _program_file(words, shown):
            return found
    mains = [(sign, _main(command)) for sign, command in commands]

    def in_turn() -> NoReturn:
        """Run the commands as a shell does, and end the process; Ctrl-C ends it without a word."""
        code = 0
        try:
            for sign, main in mains:
                if not ((sign == "&&" and code) or (sign == "||" and not code)):
                    code = main() or 0
        except KeyboardInterrupt:
            code = INTERRUPTED
        sys.exit(code)

    return Program(in_turn, list(words), shown)


def _program_file(words: list[str], shown: str) -> Program | None:
    """What a command runs if it is a program of a package or a Python file."""
    packages = current_packages()
    if words[:2] == ["ros2", "run"] and len(words) > 2:  # the program itself, without `ros2` around it
        given = hooks.run_arguments(words[1:])
        try:
            target = packages.executable(given.package_name, given.executable_name)
        except ExecutableNotFoundError as error:
            raise explained(UnknownCommand("No executable found"), error.hint) from None
        path = packages.get(given.package_name).libexec / given.executable_name
        return Program(target, [path.as_posix(), *given.argv], shown)
    if "/" in words[0] and (found := packages.program_at(words[0])):
        return Program(packages.executable(*found), words, shown.replace(words[0], shown_path(words[0]), 1))
    is_python = words[0] == sys.executable or PurePath(words[0]).name in {"python", "python3"}
    argv = words[1:] if is_python else words
    if argv and (is_python or (argv[0].endswith(".py") and "/" in argv[0])):
        path = Path(argv[0])
        if not path.is_file():
            what = f"there is no file {path}" if argv[0][0] != "-" else "a Python file is run by its path"
            raise UnknownCommand(f"ExecuteProcess(cmd='{shown}'): {what}")
        return Program(path.resolve(), argv, shown)
    return None


def _main(words: list[str]) -> Main:
    """The function that a command is. Raises NotHereError if the simulation does not have it."""
    name = PurePath(words[0]).name
    if words[:2] == ["ros2", "launch"]:
        why = "a launch file is included with IncludeLaunchDescription(path_of_the_launch_file)"
        raise NotHereError(" ".join(words), why)
    if name == "ros2":
        return lambda: hooks.run_ros2(words)
    if name in _SMALL:
        return lambda: _SMALL[name](words[1:])
    if " " in words[0]:
        raise explained(
            UnknownCommand(f"ExecuteProcess(cmd='{' '.join(words)}'): there is no program called '{words[0]}'"),
            "cmd is a list of single words, ['ros2', 'topic', 'list']; a single string needs shell=True.",
        )
    why = why_not_here(name) or hooks.advice_about_command([name, *words[1:]])
    raise NotHereError(name or "a command without a name", why or "it is a program of the operating system")


def _sleep(words: Sequence[str]) -> int:
    try:
        time.sleep(sum(float(word.removesuffix("s")) for word in words))
    except (ValueError, OverflowError):
        print(f"sleep: invalid time interval {' '.join(words)!r}", file=sys.stderr)
        return 1
    return 0


_SMALL: dict[str, Callable[[Sequence[str]], int | None]] = {
    "echo": lambda words: print(*words),
    "exit": lambda words: sys.exit(int(words[0]) if words and words[0].isdigit() else 0),
    "false": lambda words: 1,
    "sleep": _sleep,
    "true": lambda words: 0,
}


def output_of(text: str) -> str:
    """What a command prints.

    Raises SubstitutionFailure if it fails, or the simulation does not have it, and NotHereError if it needs a Python package
    that is not installed.
    """
    name, *words = shlex.split(text) or [""]
    match PurePath(name).name:
        case "echo":
            return " ".join(words) + "\n"
        case "cat":
            return "".join(_read(word) for word in words)
        case "xacro":
            return _xacro(words)
    failure = SubstitutionFailure(f"'{name}' is a program of the operating system, which launch files cannot run here")
    raise explained(failure, "Command(…) can run cat FILE, echo TEXT and xacro FILE.")


def _read(name: str) -> str:
    try:
        return Path(name).read_text(encoding="utf-8")
    except (OSError, ValueError) as error:
        raise SubstitutionFailure(f"cat: {name}: {getattr(error, 'strerror', error)}") from None


def _xacro(words: Sequence[str]) -> str:
    """What xacro makes of a robot description. One without macros stays as it is; for others the package xacro is needed."""
    text = _read(" ".join(word for word in words if not word.startswith("-") and ":=" not in word))
    if not re.search(r"<xacro:|\$\{|\$\(", text):
        return text
    try:
        main = importlib.import_module("xacro").main  # from PyPI (https://github.com/ros/xacro)
    except (ImportError, AttributeError):  # not installed, or a mere folder of this name
        raise NotHereError(f"an action that needs `xacro {' '.join(words)}`", why_not_here("xacro")) from None
    out, errors, argv = io.StringIO(), io.StringIO(), sys.argv
    sys.argv = ["xacro", *words]
    try:
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(errors):
            main()
    except SystemExit as end:
        if end.code:
            said = re.sub(r"\x1b\[[0-9;]*m", "", errors.getvalue()).strip()  # without colours
            raise SubstitutionFailure(said or f"xacro: exit code {end.code}") from None
    finally:
        sys.argv = argv
    return out.getvalue()


_SETUP = re.compile(r"^\s*(?:(?:source|\.)\s+\S*setup\.\w+\s*(?:&&|;)\s*)+")
_OF_THE_WORLD = re.compile(r"(?:^|[\s;&|('\"])(?:ros2|colcon|killall|pkill)\b")


def plan(args: Any, shell: bool) -> tuple[Any, list[str]] | None:
    """The program's file or function, by which the world runs a command, and its arguments; None if the computer is to.

    Raises NotImplementedError for a command that the computer could not run, and the world cannot.
    """
    one = isinstance(args, (str, bytes, os.PathLike))
    words = [os.fsdecode(args)] if one else [os.fsdecode(word) for word in args][: 1 if shell else None]
    if shell and words:
        words[0] = _SETUP.sub("", words[0])  # what a setup file sets up is there already
    line = " ".join(words)
    # a cell, or a launch file that it loads, may run `ros2` commands, which only the world has
    notebook = notebook_here()
    of_cell = notebook is not None and not notebook.simulation.running and line.split()[:1] == ["ros2"]
    if not line.strip() or not (of_cell or running_strand() is not None):
        return None
    if line.startswith("ros2 launch ") and not (shell and set(line) & set(";&|<>")):
        words = line.split() if shell else words
        return partial(_launch, words[2:]), words
    try:
        found = program(words, shell=shell)
    except (UnknownCommand, NotHereError, PackageNotFoundError) as error:
        if line.startswith("ros2 run "):  # which only complains
            return partial(_fail, f"{error}"), words
        if not _OF_THE_WORLD.search(line):
            return None
        why = f"{line!r} cannot be started by a program here ({getattr(error, 'why', error)})"
        raise NotImplementedError(f"{why}: ros2 commands, Python files, echo and sleep can.") from None
    return found.target, found.argv


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
