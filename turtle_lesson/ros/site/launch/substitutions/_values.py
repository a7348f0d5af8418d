"""Substitutions for values that are known while the launch runs: arguments, variables, files, expressions."""

from __future__ import annotations

import importlib
from collections.abc import Iterable, Sequence
from typing import Any

from .._context import LaunchContext
from .._entities import SomeSubstitutionsType, Substitution
from ..frontend import expose_substitution
from ..utilities import normalize_to_list_of_substitutions, perform_substitutions


class SubstitutionFailure(RuntimeError):
    """A substitution could not be performed. `hint` says what to try."""

    def __init__(self, message: str = "", hint: str = "") -> None:
        super().__init__(message)
        self.hint = hint


def arguments(tag: str, data: Sequence[Any], names: Sequence[str], least: int) -> dict[str, Any]:
    """What stands behind `$(tag `, by the names of the constructor's arguments.

    Args:
        tag: what the substitution is called.
        data: what stands there.
        names: the constructor's arguments, in order.
        least: how many of them must be given.

    Raises:
        TypeError: if there are too few or too many.
    """
    if not least <= len(data) <= len(names):
        most = len(names)
        number = (
            "no"
            if most == 0
            else str(least)
            if least == most
            else f"{least} or {most}"
            if (most == least + 1)
            else f"{least} to {most}"
        )
        plural = "argument" if number == "1" else "arguments"
        error = TypeError(f"{tag} substitution expects {number} {plural}")
        shown = " ".join(f"<{name}>" for name in names)
        error.hint = f"Write $({f'{tag} {shown}'.strip()}); put an argument with spaces in quotes."  # type: ignore[attr-defined]
        raise error
    return dict(zip(names, data, strict=False))


@expose_substitution("var")
class LaunchConfiguration(Substitution):
    """Stands for the launch argument or configuration of a name."""

    @classmethod
    def parse(cls, data: Any) -> tuple[type, dict[str, Any]]:
        """Its arguments as they stand behind `$(var `."""
        return cls, arguments("var", data, ["variable_name", "default"], 1)

    def __init__(
        self,
        variable_name: SomeSubstitutionsType,
        *,
        default: Any | Iterable[Any] | None = None,
    ) -> None:
        self.__variable_name = normalize_to_list_of_substitutions(variable_name)
        self.__default = None if default is None else normalize_to_list_of_substitutions(_texts(default))

    @property
    def variable_name(self) -> list[Substitution]:
        """The name."""
        return self.__variable_name

    def describe(self) -> str:
        """As in `LaunchConfig('rate')`."""
        return f"LaunchConfig({' + '.join(part.describe() for part in self.variable_name)})"

    def perform(self, context: LaunchContext) -> str:
        """The value, or the default.

        Raises:
            SubstitutionFailure: if it has neither.
        """
        name = perform_substitutions(context, self.variable_name)
        context._configurations_read.add(name)
        if name in context.launch_configurations:
            return str(context.launch_configurations[name])
        if self.__default is None:
            raise SubstitutionFailure(f"launch configuration '{name}' does not exist", _hint(name, context))
        return perform_substitutions(context, self.__default)


def _texts(default: Any) -> Any:
    """The default's parts as text, since any value may be given."""
    if isinstance(default, str | Substitution):
        return default
    if isinstance(default, Iterable):
        return [part if isinstance(part, str | Substitution) else str(part) for part in default]
    return str(default)


def _hint(name: str, context: LaunchContext) -> str:
    import difflib

    close = difflib.get_close_matches(name, list(context.launch_configurations), n=1)
    if close:
        return f"Did you mean LaunchConfiguration('{close[0]}')?"
    return (
        f"Before its first use put DeclareLaunchArgument('{name}', default_value='…'), "
        f'in XML <arg name="{name}" default="…"/>.'
    )


@expose_substitution("env")
class EnvironmentVariable(Substitution):
    """Stands for the environment variable of a name, as this launch sees it."""

    @classmethod
    def parse(cls, data: Any) -> tuple[type, dict[str, Any]]:
        """Its arguments as they stand behind `$(env `."""
        return cls, arguments("env", data, ["name", "default_value"], 1)

    def __init__(self, name: SomeSubstitutionsType, *, default_value: SomeSubstitutionsType | None = None) -> None:
        self.__name = normalize_to_list_of_substitutions(name)
        self.__default_value = None if default_value is None else normalize_to_list_of_substitutions(default_value)

    @property
    def name(self) -> list[Substitution]:
        """The variable's name."""
        return self.__name

    @property
    def default_value(self) -> list[Substitution] | None:
        """What counts if there is no such variable."""
        return self.__default_value

    def describe(self) -> str:
        """As in `EnvVar('HOME')`."""
        return f"EnvVar({' + '.join(part.describe() for part in self.name)})"

    def perform(self, context: LaunchContext) -> str:
        """The value, or the default.

        Raises:
            SubstitutionFailure: if it has neither.
        """
        name = perform_substitutions(context, self.name)
        if name in context.environment:
            return context.environment[name]
        if self.default_value is None:
            hint = f"Give a default: EnvironmentVariable('{name}', default_value='…')."
            raise SubstitutionFailure(f"environment variable '{name}' does not exist", hint)
        return perform_substitutions(context, self.default_value)


class LocalSubstitution(Substitution):
    """Stands for an attribute of `context.locals`, written with dots."""

    def __init__(self, expression: str, description: str | None = None) -> None:
        self.__expression = expression
        self.__description = description

    @property
    def expression(self) -> str:
        """The attribute, as in `event.action.name`."""
        return self.__expression

    def describe(self) -> str:
        """As in `LocalVar('event.pid')`."""
        return f"LocalVar('{self.__description or self.expression}')"

    def perform(self, context: LaunchContext) -> str:
        """The value as text.

        Raises:
            SubstitutionFailure: if there is no such value.
        """
        value: object = context.locals
        for name in self.expression.split("."):
            try:
                value = getattr(value, name)
            except AttributeError as error:
                raise SubstitutionFailure(f"'{self.expression}': {error}") from error
        return str(value)


@expose_substitution("anon")
class AnonName(Substitution):
    """The given name with a number behind it; the same name gives the same one within a launch.

    The real one puts the machine, the process and random digits there; here it is the same in every run.
    """

    @classmethod
    def parse(cls, data: Any) -> tuple[type, dict[str, Any]]:
        """Its arguments as they stand behind `$(anon `."""
        return cls, arguments("anon", data, ["name"], 1)

    def __init__(self, name: SomeSubstitutionsType) -> None:
        self.__name = normalize_to_list_of_substitutions(name)

    @property
    def name(self) -> list[Substitution]:
        """The first part of the name."""
        return self.__name

    def describe(self) -> str:
        """As in `AnonName('talker')`."""
        return f"AnonName({' + '.join(part.describe() for part in self.name)})"

    def perform(self, context: LaunchContext) -> str:
        """The name."""
        name = perform_substitutions(context, self.name)
        known = context.launch_configurations
        numbers = [key for key in known if key.startswith("anon")]
        return str(known.setdefault(f"anon{name}", f"{name}_{len(numbers) + 1}"))


@expose_substitution("filename")
class ThisLaunchFile(Substitution):
    """The path of the launch file."""

    @classmethod
    def parse(cls, data: Any) -> tuple[type, dict[str, Any]]:
        """Its arguments as they stand behind `$(filename `."""
        return cls, arguments("filename", data, [], 0)

    def describe(self) -> str:
        """Its name."""
        return "ThisLaunchFile()"

    def perform(self, context: LaunchContext) -> str:
        """The path.

        Raises:
            SubstitutionFailure: outside of a launch file.
        """
        return _local(context, "current_launch_file_path", "ThisLaunchFile")


@expose_substitution("dirname")
class ThisLaunchFileDir(Substitution):
    """The folder of the launch file."""

    @classmethod
    def parse(cls, data: Any) -> tuple[type, dict[str, Any]]:
        """Its arguments as they stand behind `$(dirname `."""
        return cls, arguments("dirname", data, [], 0)

    def describe(self) -> str:
        """Its name."""
        return "ThisLaunchFileDir()"

    def perform(self, context: LaunchContext) -> str:
        """The folder.

        Raises:
            SubstitutionFailure: outside of a launch file.
        """
        return _local(context, "current_launch_file_directory", "ThisLaunchFileDir")


def _local(context: LaunchContext, name: str, who: str) -> str:
    values: dict[str, Any] = context.get_locals_as_dict()
    if name not in values:
        raise SubstitutionFailure(f"{who} used outside of a launch file (in a script)")
    return str(values[name])


@expose_substitution("eval")
class PythonExpression(Substitution):
    """Evaluates an expression; the names of the modules, and what `math` has in it, may be used."""

    @classmethod
    def parse(cls, data: Any) -> tuple[type, dict[str, Any]]:
        """Its arguments as they stand behind `$(eval `."""
        return cls, arguments("eval", data, ["expression", "python_modules"], 1)

    def __init__(
        self,
        expression: SomeSubstitutionsType,
        python_modules: SomeSubstitutionsType = ("math",),
    ) -> None:
        self.__expression = normalize_to_list_of_substitutions(expression)
        self.__python_modules = normalize_to_list_of_substitutions(python_modules)

    @property
    def expression(self) -> list[Substitution]:
        """The pieces of the expression."""
        return self.__expression

    @property
    def python_modules(self) -> list[Substitution]:
        """The modules whose names may be used."""
        return self.__python_modules

    def describe(self) -> str:
        """As in `PythonExpr('1 + 1')`."""
        return f"PythonExpr({' + '.join(part.describe() for part in self.expression)})"

    def perform(self, context: LaunchContext) -> str:
        """The expression's value as text.

        Raises:
            SubstitutionFailure: if it is no expression, or fails.
        """
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
