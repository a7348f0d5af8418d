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
from dataclasses import replace
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
    """A command that the simulation does not have. `hint` says what to do instead."""

    def __init__(self, message: str, hint: str = "") -> None:
        super().__init__(message)
        self.hint = hint


class ForeignCommand(UnknownCommand, NotHereError):
    """A command that a robot's computer would run."""

    def __init__(self, what: str, why: str, hint: str = "") -> None:
        NotHereError.__init__(self, what, why, hint)


def program(words: Sequence[str], *, shell: bool = False) -> Program:
    """What the words of a command run; a `shell` takes them apart itself.

    Raises UnknownCommand if the simulation does not have this command, and PackageNotFoundError or
    ExecutableNotFoundError if `ros2 run` names what is not there.
    """
    shown = " ".join(words)
    name = PurePath(words[0]).name if words[0] else ""
    if shell or (name in SHELLS and len(words) == 3 and words[1] == "-c"):
        return _script(shown if shell else words[2], list(words), shown)
    return _simple(list(words), shown)


def _script(text: str, argv: list[str], shown: str) -> Program:
    """A shell's text: one command, or several one after the other."""
    commands = hooks.commands_of_text(text)
    if len(commands) == 1:
        return replace(_simple(commands[0][1], shown), shown=shown)
    mains = [(sign, _main(words)) for sign, words in commands]

    def main() -> int:
        code = 0
        for sign, run in mains:
            if (sign == "&&" and code) or (sign == "||" and not code):
                continue
            code = run() or 0
        return code

    return Program(_ending(main), argv, shown)


def _ending(main: Main) -> Callable[[], None]:
    """A function that ends its process with the exit code that `main` gives; Ctrl-C ends it without a word."""

    def end() -> None:
        try:
            code = main() or 0
        except KeyboardInterrupt:
            code = INTERRUPTED
        sys.exit(code)

    return end


def _simple(words: list[str], shown: str) -> Program:
    """One command: a program of a package, a Python file, or a function of this module."""
    if words[:2] == ["ros2", "run"] and len(words) > 2:
        return _ros2_run(words, shown)
    packages = current_packages()
    if "/" in words[0] and (found := packages.program_at(words[0])):
        return Program(packages.executable(*found), words, shown.replace(words[0], shown_path(words[0]), 1))
    name = PurePath(words[0]).name
    if (words[0] == sys.executable or name in {"python", "python3"}) and len(words) > 1:
        return Program(_python_file(words[1], shown), words[1:], shown)
    if name.endswith(".py") and "/" in words[0]:
        return Program(_python_file(words[0], shown), words, shown)
    return Program(_ending(_main(words)), words, shown)


def _python_file(name: str, shown: str) -> Path:
    path = Path(name)
    if name.startswith("-") or not path.is_file():
        what = "a Python file is run by its path" if name.startswith("-") else f"there is no file {name}"
        raise UnknownCommand(f"ExecuteProcess(cmd='{shown}'): {what}")
    return path.resolve()


def _ros2_run(words: list[str], shown: str) -> Program:
    """The program that `ros2 run` names, run without `ros2` around it."""
    given = hooks.run_arguments(words[1:])
    packages = current_packages()
    try:
        target = packages.executable(given.package_name, given.executable_name)
    except ExecutableNotFoundError as error:
        raise UnknownCommand("No executable found", error.hint) from None
    path = packages.get(given.package_name).libexec / given.executable_name
    return Program(target, [path.as_posix(), *given.argv], shown)


def _main(words: list[str]) -> Main:
    """The function that a command is. Raises UnknownCommand if the simulation does not have it."""
    name = PurePath(words[0]).name
    if name == "ros2":
        if words[1:2] == ["launch"]:
            why = "a launch file is included with IncludeLaunchDescription(path_of_the_launch_file)"
            raise ForeignCommand(" ".join(words), why)
        return lambda: hooks.run_ros2(words)
    if name in _SMALL:
        return lambda: _SMALL[name](words[1:])
    if " " in words[0]:
        raise UnknownCommand(
            f"ExecuteProcess(cmd='{' '.join(words)}'): there is no program called '{words[0]}'",
            "cmd is a list of single words, ['ros2', 'topic', 'list']; a single string needs shell=True.",
        )
    why = why_not_here(name) or hooks.advice_about_command([name, *words[1:]])
    raise ForeignCommand(name or "a command without a name", why or "it is a program of the operating system")


def _echo(words: Sequence[str]) -> None:
    if words[:1] == ["-n"]:
        print(*words[1:], end="")
    else:
        print(*words)


def _sleep(words: Sequence[str]) -> int:
    units = {"s": 1.0, "m": 60.0, "h": 3600.0}
    try:
        time.sleep(sum(float(word.rstrip("smh")) * units.get(word[-1:], 1.0) for word in words))
    except (ValueError, OverflowError):
        print(f"sleep: invalid time interval {' '.join(words)!r}", file=sys.stderr)
        return 1
    return 0


_SMALL: dict[str, Callable[[Sequence[str]], Any]] = {
    "echo": _echo,
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
    try:
        words = shlex.split(text)
    except ValueError as error:
        raise SubstitutionFailure(str(error)) from None
    if not words:
        raise SubstitutionFailure("there is no command")
    name = PurePath(words[0]).name
    if name == "echo":
        return " ".join(words[1:]) + "\n"
    if name == "cat":
        return "".join(_read(word) for word in words[1:])
    if name == "xacro":
        return _xacro(words[1:])
    failure = SubstitutionFailure(f"'{name}' is a program of the operating system, which launch files cannot run here")
    raise explained(failure, "Command(…) can run cat FILE, echo TEXT and xacro FILE.")


def _read(name: str) -> str:
    try:
        return Path(name).read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise SubstitutionFailure(f"cat: {name}: {reason}") from None


def _xacro(words: Sequence[str]) -> str:
    """What xacro makes of a robot description. One without macros stays as it is; for others the package xacro is needed."""
    files = [word for word in words if not word.startswith("-") and ":=" not in word]
    if len(files) != 1:
        raise SubstitutionFailure("xacro needs the name of one file")
    text = _read(files[0])
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
    notebook = (
        notebook_here()
    )  # a cell, or a launch file that it loads, may run `ros2` commands, which only the world has
    of_cell = notebook is not None and not notebook.simulation.running and line.split()[:1] == ["ros2"]
    if not line.strip() or not (of_cell or running_strand() is not None):
        return None
    if line.startswith("ros2 launch ") and not (shell and set(line) & set(";&|<>")):
        words = line.split() if shell else words
        return partial(_launch, words[2:]), words
    try:
        found = program(words, shell=shell)
    except (UnknownCommand, PackageNotFoundError) as error:
        if line.startswith("ros2 run "):  # which only complains
            return partial(_fail, f"{error}"), words
        if _OF_THE_WORLD.search(line):
            raise NotImplementedError(_refusal(line, error)) from None
        return None
    return found.target, found.argv


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
