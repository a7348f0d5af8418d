"""The arguments of a launch file: what it takes, what was given, and whether the two fit."""

from __future__ import annotations

import textwrap
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

from ..workspace.errors import did_you_mean

if TYPE_CHECKING:
    from launch import LaunchDescription


@dataclass(frozen=True)
class LaunchArgument:
    """One argument that a launch file takes.

    Attributes:
        name: its name.
        description: what it is for.
        default: its default as `--show-args` shows it (`'10'`), or None if it must be given.
        choices: the values that it may have, or None for any.
    """

    name: str
    description: str
    default: str | None
    choices: tuple[str, ...] | None = None


def declared_in(description: LaunchDescription) -> list[LaunchArgument]:
    """The arguments that a description and what it includes declare."""
    return [
        LaunchArgument(
            argument.name,
            argument.description,
            None if argument.default_value is None else " + ".join(part.describe() for part in argument.default_value),
            None if argument.choices is None else tuple(argument.choices),
        )
        for argument in description.get_launch_arguments()
    ]


def as_text(arguments: Mapping[str, object]) -> dict[str, str]:
    """Values as they would be written on a command line: True is `true`."""
    return {name: str(value).lower() if isinstance(value, bool) else str(value) for name, value in arguments.items()}


def as_shown(arguments: Iterable[LaunchArgument]) -> str:
    """The text that `--show-args` prints."""
    parts = ["Arguments (pass arguments as '<name>:=<value>'):"]
    for argument in arguments:
        lines = [f"    '{argument.name}':"]
        lines += textwrap.indent(argument.description, "        ").split("\n")
        if argument.default is not None:
            lines.append(f"        (default: {argument.default})")
        parts.append("\n".join(lines))
    if len(parts) == 1:
        parts.append("  No arguments.")
    return "\n\n".join(parts)


def unknown_warnings(given: Iterable[str], declared: Iterable[str], read: set[str]) -> list[str]:
    """A line for each argument that was given although nothing takes it; the real tool says nothing."""
    known = list(declared)
    lines = []
    for name in given:
        if name not in known and name not in read:
            takes = f"It takes: {', '.join(known)}." if known else "It takes no arguments."
            hint = did_you_mean(name, known) or takes
            lines.append(f"nothing in this launch file takes the argument '{name}'. {hint}")
    return lines
