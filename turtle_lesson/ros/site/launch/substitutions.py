"""Substitutions: text that is known only when the launch runs."""

from __future__ import annotations

import difflib
import importlib
import math
import os
import shutil
from collections.abc import Iterable
from typing import Any

from turtle_lesson.ros import hooks

from ._context import LaunchContext
from ._entities import SomeSubstitutionsType, Substitution, TextSubstitution, described
from ._tags import expose_as
from .utilities import normalize_to_list_of_substitutions as pieces
from .utilities import perform_substitutions

__all__ = [
    "AndSubstitution",
    "AnonName",
    "Command",
    "EnvironmentVariable",
    "EqualsSubstitution",
    "FindExecutable",
    "IfElseSubstitution",
    "LaunchConfiguration",
    "LocalSubstitution",
    "NotEqualsSubstitution",
    "NotSubstitution",
    "OrSubstitution",
    "PathJoinSubstitution",
    "PathSubstitution",
    "PythonExpression",
    "SubstitutionFailure",
    "TextSubstitution",
    "ThisLaunchFile",
    "ThisLaunchFileDir",
]


class SubstitutionFailure(RuntimeError):
    """A substitution could not be performed. `hint` says what to try."""

    def __init__(self, message: str = "", hint: str = "") -> None:
        super().__init__(message)
        self.hint = hint


# -- values that are known while the launch runs -------------------------------------------------------------------------


@expose_as("var")
class LaunchConfiguration(Substitution):
    """Stands for the launch argument or configuration of a name."""

    _shown = "LaunchConfig({variable_name})"

    def __init__(
        self,
        variable_name: SomeSubstitutionsType,
        *,
        default: Any | Iterable[Any] | None = None,
    ) -> None:
        self.variable_name = pieces(variable_name)
        if default is not None:
            parts = [default] if isinstance(default, str) or not isinstance(default, Iterable) else default
            default = pieces(part if isinstance(part, str | Substitution) else str(part) for part in parts)
        self._default: list[Substitution] | None = default

    def perform(self, context: LaunchContext) -> str:
        """The value, or the default. Raises SubstitutionFailure if it has neither."""
        name = perform_substitutions(context, self.variable_name)
        context._configurations_read.add(name)
        if name in context.launch_configurations:
            return str(context.launch_configurations[name])
        if self._default is not None:
            return perform_substitutions(context, self._default)
        close = difflib.get_close_matches(name, list(context.launch_configurations), n=1)
        declare = (
            f"Before its first use put DeclareLaunchArgument('{name}', default_value='…'), "
            f'in XML <arg name="{name}" default="…"/>.'
        )
        hint = f"Did you mean LaunchConfiguration('{close[0]}')?" if close else declare
        raise SubstitutionFailure(f"launch configuration '{name}' does not exist", hint)


@expose_as("env")
class EnvironmentVariable(Substitution):
    """Stands for the environment variable of a name, as this launch sees it."""

    _shown = "EnvVar({name})"

    def __init__(self, name: SomeSubstitutionsType, *, default_value: SomeSubstitutionsType | None = None) -> None:
        self.name = pieces(name)
        self.default_value = None if default_value is None else pieces(default_value)

    def perform(self, context: LaunchContext) -> str:
        """The value, or the default. Raises SubstitutionFailure if it has neither."""
        name = perform_substitutions(context, self.name)
        if name in context.environment:
            return context.environment[name]
        if self.default_value is None:
            hint = f"Give a default: EnvironmentVariable('{name}', default_value='…')."
            raise SubstitutionFailure(f"environment variable '{name}' does not exist", hint)
        return perform_substitutions(context, self.default_value)


class LocalSubstitution(Substitution):
    """Stands for an attribute of `context.locals`, written with dots, as in `event.action.name`."""

    def __init__(self, expression: str, description: str | None = None) -> None:
        self.expression = expression
        self._shown = f"LocalVar('{description or expression}')"

    def perform(self, context: LaunchContext) -> str:
        """The value as text. Raises SubstitutionFailure if there is no such value."""
        value: object = context.locals
        for name in self.expression.split("."):
            try:
                value = getattr(value, name)
            except AttributeError as error:
                raise SubstitutionFailure(f"'{self.expression}': {error}") from error
        return str(value)


@expose_as("anon")
class AnonName(Substitution):
    """The given name with a number behind it; the same name gives the same one within a launch.

    The real one puts the machine, the process and random digits there; here it is the same in every run.
    """

    _shown = "AnonName({name})"

    def __init__(self, name: SomeSubstitutionsType) -> None:
        self.name = pieces(name)

    def perform(self, context: LaunchContext) -> str:
        """The name."""
        name = perform_substitutions(context, self.name)
        known = context.launch_configurations
        numbers = [key for key in known if key.startswith("anon")]
        return str(known.setdefault(f"anon{name}", f"{name}_{len(numbers) + 1}"))


class _Place(Substitution):
    """Something about the launch file, which a context's locals have."""

    _local: str

    def perform(self, context: LaunchContext) -> str:
        """The path. Raises SubstitutionFailure outside of a launch file."""
        values = context.get_locals_as_dict()
        if self._local not in values:
            raise SubstitutionFailure(f"{type(self).__name__} used outside of a launch file (in a script)")
        return str(values[self._local])


@expose_as("filename")
class ThisLaunchFile(_Place):
    """The path of the launch file."""

    _local = "current_launch_file_path"


@expose_as("dirname")
class ThisLaunchFileDir(_Place):
    """The folder of the launch file."""

    _local = "current_launch_file_directory"


@expose_as("eval")
class PythonExpression(Substitution):
    """Evaluates an expression; the names of the modules, and what `math` has in it, may be used."""

    _shown = "PythonExpr({expression})"

    def __init__(self, expression: SomeSubstitutionsType, python_modules: SomeSubstitutionsType = ("math",)) -> None:
        self.expression = pieces(expression)
        self.python_modules = pieces(python_modules)

    def perform(self, context: LaunchContext) -> str:
        """The expression's value as text. Raises SubstitutionFailure if it is no expression, or fails."""
        text = perform_substitutions(context, self.expression)
        names: dict[str, Any] = {}
        for part in self.python_modules:
            module = importlib.import_module(part.perform(context))
            names[module.__name__] = module
            if module.__name__ == "math":
                names.update(vars(module))
        try:
            return str(eval(compile(text, "<generated expression>", "eval"), {}, names))
        except Exception as error:
            reason = f"the Python expression {text!r} failed: {type(error).__name__}: {error}"
            hint = "Text that is compared needs quotes: [\"'\", LaunchConfiguration('mode'), \"' == 'fast'\"]."
            raise SubstitutionFailure(reason, hint) from error


# -- truth values, and choices between texts -----------------------------------------------------------------------------


def _truth(context: LaunchContext, value: list[Substitution]) -> bool:
    """Whether a text says yes; SubstitutionFailure if it says neither yes nor no."""
    text = perform_substitutions(context, value).strip()
    if text.lower() in {"true", "1", "yes", "on"}:
        return True
    if text.lower() in {"false", "0", "no", "off"}:
        return False
    raise SubstitutionFailure(f"'{text}' is neither true nor false")


@expose_as("not")
class NotSubstitution(Substitution):
    """True if its part is false."""

    _shown = "NotSubstitution({value})"

    def __init__(self, value: SomeSubstitutionsType) -> None:
        self.value = pieces(value)

    def perform(self, context: LaunchContext) -> str:
        """`true` or `false`."""
        return str(not _truth(context, self.value)).lower()


class _Pair(Substitution):
    """Two truth values made into one."""

    _enough: int
    """How many of them must be true."""

    def __init__(self, left: SomeSubstitutionsType, right: SomeSubstitutionsType) -> None:
        self.left, self.right = pieces(left), pieces(right)

    def perform(self, context: LaunchContext) -> str:
        """`true` or `false`."""
        return str(_truth(context, self.left) + _truth(context, self.right) >= self._enough).lower()


@expose_as("and")
class AndSubstitution(_Pair):
    """True if both are."""

    _shown = "AndSubstitution({left} {right})"
    _enough = 2


@expose_as("or")
class OrSubstitution(_Pair):
    """True if one is."""

    _shown = "OrSubstitution({left} {right})"
    _enough = 1


@expose_as("equals")
class EqualsSubstitution(Substitution):
    """`true` if both sides are the same text, the same truth value, or numbers that are nearly equal."""

    _shown = "EqualsSubstitution({left} {right})"

    def __init__(
        self,
        left: SomeSubstitutionsType | int | float | bool | None,
        right: SomeSubstitutionsType | int | float | bool | None,
    ) -> None:
        self.left, self.right = _side(left), _side(right)

    def perform(self, context: LaunchContext) -> str:
        """`true` or `false`."""
        return str(self._same(context)).lower()

    def _same(self, context: LaunchContext) -> bool:
        left, right = perform_substitutions(context, self.left), perform_substitutions(context, self.right)
        if {left.lower(), right.lower()} <= {"true", "false"} or left == right:
            return left.lower() == right.lower()
        try:
            return math.isclose(float(left), float(right))
        except ValueError:
            return False


def _side(side: Any) -> list[Substitution]:
    if isinstance(side, bool):
        return pieces(str(side).lower())
    return pieces("" if side is None else str(side) if isinstance(side, int | float) else side)


@expose_as("not-equals")
class NotEqualsSubstitution(EqualsSubstitution):
    """The opposite."""

    _shown = "NotEqualsSubstitution({left} {right})"

    def perform(self, context: LaunchContext) -> str:
        """`true` or `false`."""
        return str(not self._same(context)).lower()


@expose_as("if")
class IfElseSubstitution(Substitution):
    """One of two texts, by a condition."""

    def __init__(
        self,
        condition: SomeSubstitutionsType,
        if_value: SomeSubstitutionsType = "",
        else_value: SomeSubstitutionsType = "",
    ) -> None:
        self.condition, self.if_value, self.else_value = pieces(condition), pieces(if_value), pieces(else_value)

    def perform(self, context: LaunchContext) -> str:
        """The text that the condition chooses."""
        return perform_substitutions(context, self.if_value if _truth(context, self.condition) else self.else_value)


# -- paths, and what commands print --------------------------------------------------------------------------------------


class PathSubstitution(Substitution):
    """A path, to which `/` adds further parts: `PathSubstitution(FindPackageShare('p')) / 'launch' / 'x.py'`."""

    _shown = "Path({path})"

    def __init__(self, path: SomeSubstitutionsType) -> None:
        self.path = pieces(path)

    def __truediv__(self, additional_path: SomeSubstitutionsType) -> PathJoinSubstitution:
        return PathJoinSubstitution([self, additional_path])

    def perform(self, context: LaunchContext) -> str:
        """The path."""
        return perform_substitutions(context, self.path)


class PathJoinSubstitution(Substitution):
    """Joins its parts with the system's separator; a part may itself be a list of pieces, and `/` adds one."""

    def __init__(self, substitutions: Iterable[SomeSubstitutionsType]) -> None:
        self.substitutions = [pieces(part) for part in substitutions]

    def __truediv__(self, additional_path: SomeSubstitutionsType) -> PathJoinSubstitution:
        return PathJoinSubstitution([*self.substitutions, additional_path])

    def describe(self) -> str:
        """The parts in words."""
        return f"PathJoin({', '.join(described(part) for part in self.substitutions)})"

    def perform(self, context: LaunchContext) -> str:
        """The path."""
        return os.path.join(*[perform_substitutions(context, part) for part in self.substitutions])


PROGRAMS = {"ros2", "python3", "python", "xacro"}
"""Programs that the simulation itself has."""


@expose_as("find-exec")
class FindExecutable(Substitution):
    """Stands for the path at which a program is found."""

    _shown = "FindExec({name})"

    def __init__(self, *, name: SomeSubstitutionsType) -> None:
        self.name = pieces(name)

    def perform(self, context: LaunchContext) -> str:
        """The path. Raises SubstitutionFailure if it is not on the PATH."""
        name = perform_substitutions(context, self.name)
        if name in PROGRAMS:
            return name
        path = shutil.which(name, path=context.environment.get("PATH"))
        if path is None:
            raise SubstitutionFailure(f"executable '{name}' not found on the PATH")
        return path


class CommandFailure(SubstitutionFailure):
    """A command has failed, or the simulation does not have it."""


@expose_as("command")
class Command(Substitution):
    """Stands for the output of a command. Here these are `cat FILE`, `echo …` and `xacro FILE`."""

    _shown = "Command({command})"

    def __init__(self, command: SomeSubstitutionsType, *, on_stderr: SomeSubstitutionsType = "fail") -> None:
        self.command = pieces(command)
        self.on_stderr = pieces(on_stderr)

    def perform(self, context: LaunchContext) -> str:
        """What it prints.

        Raises SubstitutionFailure if it fails, or the simulation does not have it, and NotHereError if it needs a
        Python package that is not installed; then the launch goes on without the action.
        """
        text = perform_substitutions(context, self.command)
        if perform_substitutions(context, self.on_stderr) not in ("fail", "ignore", "warn", "capture"):
            raise SubstitutionFailure("expected 'on_stderr' to be one of: 'fail', 'ignore', 'warn' or 'capture'")
        try:
            return hooks.output_of_command(text)
        except CommandFailure as error:
            reason = f"executed command failed. Command: {text}\nCaptured stderr output: {error}"
            raise SubstitutionFailure(reason, error.hint) from error
