"""Substitutions for paths, and for what commands print."""

from __future__ import annotations

import os
import shutil
from collections.abc import Iterable
from typing import Any

from turtle_lesson.ros import hooks

from .._context import LaunchContext
from .._entities import SomeSubstitutionsType, Substitution
from ..frontend import expose_substitution
from ..utilities import normalize_to_list_of_substitutions, perform_substitutions
from ._values import SubstitutionFailure, arguments


class CommandFailure(RuntimeError):
    """A command has failed, or the simulation does not have it. `hint` says what to do instead."""

    def __init__(self, message: str, hint: str = "") -> None:
        super().__init__(message)
        self.hint = hint


class PathSubstitution(Substitution):
    """A path, to which `/` adds further parts: `PathSubstitution(FindPackageShare('p')) / 'launch' / 'x.py'`."""

    def __init__(self, path: SomeSubstitutionsType) -> None:
        self.__path = normalize_to_list_of_substitutions(path)

    @property
    def path(self) -> list[Substitution]:
        """The pieces of the path."""
        return self.__path

    def __truediv__(self, additional_path: SomeSubstitutionsType) -> PathJoinSubstitution:
        return PathJoinSubstitution([self, additional_path])

    def describe(self) -> str:
        """The pieces in words."""
        return f"Path({' + '.join(piece.describe() for piece in self.__path)})"

    def perform(self, context: LaunchContext) -> str:
        """The path."""
        return perform_substitutions(context, self.__path)


class PathJoinSubstitution(Substitution):
    """Joins its parts with the system's separator; a part may itself be a list of pieces, and `/` adds one."""

    def __init__(self, substitutions: Iterable[SomeSubstitutionsType]) -> None:
        self.__parts = [normalize_to_list_of_substitutions(part) for part in substitutions]

    @property
    def substitutions(self) -> list[list[Substitution]]:
        """The parts, each a list of pieces."""
        return self.__parts

    def __truediv__(self, additional_path: SomeSubstitutionsType) -> PathJoinSubstitution:
        return PathJoinSubstitution([*self.__parts, additional_path])

    def describe(self) -> str:
        """The parts in words."""
        parts = [" + ".join(piece.describe() for piece in part) for part in self.__parts]
        return f"PathJoin({', '.join(parts)})"

    def perform(self, context: LaunchContext) -> str:
        """The path."""
        return os.path.join(*[perform_substitutions(context, part) for part in self.__parts])


PROGRAMS = {"ros2", "python3", "python", "xacro"}
"""Programs that the simulation itself has."""


@expose_substitution("find-exec")
class FindExecutable(Substitution):
    """Stands for the path at which a program is found."""

    @classmethod
    def parse(cls, data: Any) -> tuple[type, dict[str, Any]]:
        """Its arguments as they stand behind `$(find-exec `."""
        return cls, arguments("find-exec", data, ["name"], 1)

    def __init__(self, *, name: SomeSubstitutionsType) -> None:
        self.__name = normalize_to_list_of_substitutions(name)

    @property
    def name(self) -> list[Substitution]:
        """The program's name."""
        return self.__name

    def describe(self) -> str:
        """As in `FindExec('bash')`."""
        return f"FindExec({' + '.join(part.describe() for part in self.name)})"

    def perform(self, context: LaunchContext) -> str:
        """The path.

        Raises:
            SubstitutionFailure: if it is not on the PATH.
        """
        name = perform_substitutions(context, self.name)
        if name in PROGRAMS:
            return name
        path = shutil.which(name, path=context.environment.get("PATH"))
        if path is None:
            raise SubstitutionFailure(f"executable '{name}' not found on the PATH")
        return path


@expose_substitution("command")
class Command(Substitution):
    """Stands for the output of a command. Here these are `cat FILE`, `echo …` and `xacro FILE`.

    Args:
        command: the command, as one text.
        on_stderr: what to do if it prints to stderr: fail, ignore, warn or capture.
    """

    def __init__(self, command: SomeSubstitutionsType, *, on_stderr: SomeSubstitutionsType = "fail") -> None:
        self.__command = normalize_to_list_of_substitutions(command)
        self.__on_stderr = normalize_to_list_of_substitutions(on_stderr)

    @classmethod
    def parse(cls, data: Any) -> tuple[type, dict[str, Any]]:
        """Its arguments as they stand behind `$(command `."""
        return cls, arguments("command", data, ["command", "on_stderr"], 1)

    @property
    def command(self) -> list[Substitution]:
        """The pieces of the command."""
        return self.__command

    @property
    def on_stderr(self) -> list[Substitution]:
        """What to do if it prints to stderr."""
        return self.__on_stderr

    def describe(self) -> str:
        """As in `Command('cat robot.urdf')`."""
        return f"Command({' + '.join(piece.describe() for piece in self.command)})"

    def perform(self, context: LaunchContext) -> str:
        """What it prints.

        Raises:
            SubstitutionFailure: if it fails, or the simulation does not have it.
            NotHereError: if it needs a Python package that is not installed; then the launch goes on without the action.
        """
        text = perform_substitutions(context, self.command)
        if perform_substitutions(context, self.on_stderr) not in ("fail", "ignore", "warn", "capture"):
            raise SubstitutionFailure("expected 'on_stderr' to be one of: 'fail', 'ignore', 'warn' or 'capture'")
        try:
            return hooks.output_of_command(text)
        except CommandFailure as error:
            raise SubstitutionFailure(
                f"executed command failed. Command: {text}\nCaptured stderr output: {error}", error.hint
            ) from error
