"""Substitutions: text that is known only when the launch runs."""

from __future__ import annotations

import importlib
import math
import os
from collections.abc import Iterable
from dataclasses import dataclass, field
from operator import attrgetter
from typing import Any

from turtle_lesson.ros import hooks
from turtle_lesson.ros.idl.names import did_you_mean

from ._context import LaunchContext
from ._entities import SomeSubstitutionsType, Substitution, TextSubstitution, described, explained, text_of
from ._entities import normalize_to_list_of_substitutions as pieces
from .frontend import expose_substitution
from .utilities import perform_text_as

__all__ = [
    "AndSubstitution",
    "Command",
    "EnvironmentVariable",
    "EqualsSubstitution",
    "FindExecutable",
    "LaunchConfiguration",
    "LocalSubstitution",
    "NotEqualsSubstitution",
    "NotSubstitution",
    "OrSubstitution",
    "PathJoinSubstitution",
    "PythonExpression",
    "SubstitutionFailure",
    "TextSubstitution",
    "ThisLaunchFile",
    "ThisLaunchFileDir",
]


class SubstitutionFailure(RuntimeError):
    """A substitution could not be performed."""


# -- values that are known while the launch runs -------------------------------------------------------------------------


@expose_substitution("var")
class LaunchConfiguration(Substitution):
    """Stands for the launch argument or configuration of a name."""

    variable_name: SomeSubstitutionsType
    default: Any = field(default=None, kw_only=True)
    _shown = "LaunchConfig({variable_name})"

    def __post_init__(self) -> None:
        if self.default is not None:
            parts = self.default if isinstance(self.default, list | tuple) else [self.default]
            self.default = [part if isinstance(part, Substitution) else str(part) for part in parts]
        super().__post_init__()

    def perform(self, context: LaunchContext) -> str:
        """The value, or the default. Raises SubstitutionFailure if it has neither."""
        name = text_of(context, self.variable_name)
        context._configurations_read.add(name)
        if name in context.launch_configurations:
            return str(context.launch_configurations[name])
        if self.default is not None:
            return text_of(context, self.default)
        declare = f"DeclareLaunchArgument('{name}', default_value='…'), in XML <arg name=\"{name}\" default=\"…\"/>"
        hint = did_you_mean(name[:100], context.launch_configurations) or f"Before its first use put {declare}."
        raise explained(SubstitutionFailure(f"launch configuration '{name}' does not exist"), hint)


@expose_substitution("env")
class EnvironmentVariable(Substitution):
    """Stands for the environment variable of a name, as this launch sees it."""

    name: SomeSubstitutionsType
    default_value: SomeSubstitutionsType | None = field(default=None, kw_only=True)
    _shown = "EnvVar({name})"

    def perform(self, context: LaunchContext) -> str:
        """The value, or the default. Raises SubstitutionFailure if it has neither."""
        name = text_of(context, self.name)
        if name in context.environment:
            return context.environment[name]
        if self.default_value is None:
            hint = f"Give a default: EnvironmentVariable('{name}', default_value='…')."
            raise explained(SubstitutionFailure(f"environment variable '{name}' does not exist"), hint)
        return text_of(context, self.default_value)


class LocalSubstitution(Substitution):
    """Stands for an attribute of `context.locals`, written with dots, as in `event.action.name`."""

    def __init__(self, expression: str, description: str | None = None) -> None:
        self.expression = expression
        self._shown = f"LocalVar('{description or expression}')"

    def perform(self, context: LaunchContext) -> str:
        """The value as text. Raises SubstitutionFailure if there is no such value."""
        try:
            return str(attrgetter(self.expression)(context.locals))
        except AttributeError as error:
            what = f"context.locals does not contain attribute '{error.name}'"
            raise SubstitutionFailure(f"'{self.expression}': {what}") from None


@expose_substitution("filename")
class ThisLaunchFile(Substitution):
    """The path of the launch file."""

    def perform(self, context: LaunchContext) -> str:
        """The path. Raises SubstitutionFailure outside of a launch file."""
        path = context._locals.get("current_launch_file_path")
        if path is None:
            raise SubstitutionFailure(f"{type(self).__name__} used outside of a launch file (in a script)")
        return str(path)


@expose_substitution("dirname")
class ThisLaunchFileDir(ThisLaunchFile):
    """The folder of the launch file."""

    def perform(self, context: LaunchContext) -> str:
        """The path. Raises SubstitutionFailure outside of a launch file."""
        return os.path.dirname(super().perform(context))


@expose_substitution("eval")
class PythonExpression(Substitution):
    """Evaluates an expression; the names of the modules, and what `math` has in it, may be used."""

    expression: SomeSubstitutionsType
    python_modules: SomeSubstitutionsType = ("math",)
    _shown = "PythonExpr({expression})"

    def perform(self, context: LaunchContext) -> str:
        """The expression's value as text. Raises SubstitutionFailure if it is no expression, or fails."""
        text = text_of(context, self.expression)
        names: dict[str, Any] = {}
        for part in pieces(self.python_modules):
            module = importlib.import_module(part.perform(context))
            names[module.__name__] = module
            if module is math:
                names.update(vars(math))
        try:
            return str(eval(compile(text, "<generated expression>", "eval"), {}, names))
        except Exception as error:
            failure = SubstitutionFailure(f"the Python expression {text!r} failed: {type(error).__name__}: {error}")
            hint = "Text that is compared needs quotes: [\"'\", LaunchConfiguration('mode'), \"' == 'fast'\"]."
            raise explained(failure, hint) from error


# -- truth values --------------------------------------------------------------------------------------------------------


class _Truth(Substitution):
    """Something that holds or not."""

    def perform(self, context: LaunchContext) -> str:
        """`true` or `false`. Raises TypeError if a part that must be a truth value is none."""
        return str(self._holds(context)).lower()

    def _holds(self, context: LaunchContext) -> bool:
        raise NotImplementedError


@expose_substitution("not")
class NotSubstitution(_Truth):
    """True if its part is false."""

    value: SomeSubstitutionsType

    def _holds(self, context: LaunchContext) -> bool:
        return not perform_text_as(context, self.value, bool)


@dataclass(repr=False, eq=False)
class _Pair(_Truth):
    """Two texts made into a truth value."""

    left: SomeSubstitutionsType
    right: SomeSubstitutionsType


@expose_substitution("and")
class AndSubstitution(_Pair):
    """True if both are."""

    def _holds(self, context: LaunchContext) -> bool:
        return all(perform_text_as(context, side, bool) for side in (self.left, self.right))


@expose_substitution("or")
class OrSubstitution(_Pair):
    """True if one is."""

    def _holds(self, context: LaunchContext) -> bool:
        return any(perform_text_as(context, side, bool) for side in (self.left, self.right))


@expose_substitution("equals")
class EqualsSubstitution(_Pair):
    """True if both sides are the same text, the same truth value, or numbers that are nearly equal."""

    def __post_init__(self) -> None:
        for name, side in vars(self).items():
            setattr(self, name, "" if side is None else str(side).lower() if isinstance(side, int | float) else side)
        super().__post_init__()

    def _holds(self, context: LaunchContext) -> bool:
        left, right = text_of(context, self.left), text_of(context, self.right)
        if {left.lower(), right.lower()} <= {"true", "false"} or left == right:
            return left.lower() == right.lower()
        try:
            return math.isclose(float(left), float(right))
        except ValueError:
            return False


@expose_substitution("not-equals")
class NotEqualsSubstitution(EqualsSubstitution):
    """The opposite."""

    def _holds(self, context: LaunchContext) -> bool:
        return not super()._holds(context)


# -- paths, and what commands print --------------------------------------------------------------------------------------


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
        return os.path.join(*[text_of(context, part) for part in self.substitutions])


@expose_substitution("find-exec")
class FindExecutable(Substitution):
    """Stands for a program, which is found here by its name alone, so that it is the same on every computer."""

    name: SomeSubstitutionsType = field(kw_only=True)
    _shown = "FindExec({name})"

    def perform(self, context: LaunchContext) -> str:
        """The name. Whether there is such a program shows when it is started."""
        return text_of(context, self.name)


@expose_substitution("command")
class Command(Substitution):
    """Stands for the output of a command. Here these are `cat FILE`, `echo …` and `xacro FILE`."""

    command: SomeSubstitutionsType
    on_stderr: SomeSubstitutionsType = field(default="fail", kw_only=True)
    _shown = "Command({command})"

    def perform(self, context: LaunchContext) -> str:
        """What it prints.

        Raises SubstitutionFailure if it fails, or the simulation does not have it, and NotHereError if it needs a
        Python package that is not installed; then the launch goes on without the action.
        """
        text = text_of(context, self.command)
        try:
            return hooks.output_of_command(text)
        except SubstitutionFailure as error:
            raise SubstitutionFailure(
                f"executed command failed. Command: {text}\nCaptured stderr output: {error}"
            ) from error
