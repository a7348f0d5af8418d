"""From a file or a description to a running launch, and what a cell holds of it; the arguments of launch files."""

from __future__ import annotations

import textwrap
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

from launch import LaunchDescription, LaunchDescriptionSource
from launch.actions import IncludeLaunchDescription
from launch.launch_description_sources import AnyLaunchDescriptionSource

from ..ament.index import LaunchedPackages, is_launch_file, seeing
from ..idl.names import did_you_mean
from ..runtime.run_world import run_for
from ..runtime.world import World
from ..sim.errors import shown_path
from ..sim.simulation import NANOSECONDS
from .errors import LaunchError, learners_cause
from .service import LaunchService, as_launch_error

if TYPE_CHECKING:
    from ..sim.process import Process


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


class LaunchHandle:
    """A running launch: its processes, and how to stop it."""

    def __init__(self, service: LaunchService, name: str) -> None:
        self._service: LaunchService | Any = service
        self.name = name
        service.world.at_close.append(self._let_go)

    def _let_go(self) -> None:
        """Keep the names, and nothing of the world that is closed: Jupyter's `Out` may keep this handle for long."""
        left = [SimpleNamespace(name=name, alive=False, process=None) for name in self.names]
        self._service = SimpleNamespace(processes=left, running=False)

    @property
    def processes(self) -> list[Process]:
        """Its processes in the order of their start, dead ones included."""
        return [entry.process for entry in self._service.processes if entry.process is not None]

    @property
    def names(self) -> list[str]:
        """What its processes are called in the output, such as `navigator-1`."""
        return [entry.name for entry in self._service.processes]

    @property
    def running(self) -> bool:
        """Whether a process of it runs, or something in it is still to come."""
        return self._service.running

    def wait_until_up(self) -> None:
        """Let robot time pass until the programs that have been started so far are up, one after the other."""
        world = self._service.world
        run_for(world, max(0, self._service.processes.up_at - world.now) / NANOSECONDS)
        world.sim.settle()

    def stop(self) -> None:
        """End it, as Ctrl-C in its terminal would. Does nothing if it has ended already."""
        if self.running:
            text = "user interrupted with ctrl-c (SIGINT)"
            self._service.screen.say("WARNING", "launch", text)
            self._service.shut_down("ctrl-c (SIGINT)", due_to_sigint=True)

    def __repr__(self) -> str:
        alive = [entry.name for entry in self._service.processes if entry.alive]
        state = f"running: {', '.join(alive)}" if alive else "running" if self.running else "ended"
        return f"<Launch of {self.name}, {state}>"


def launch_file(world: World, path: Path, arguments: Mapping[str, object], show_all_output: bool) -> LaunchHandle:
    """As `turtle_lesson.ros.launching.launch_file`."""
    source = AnyLaunchDescriptionSource(_existing(path))
    return _begin(world, source, as_text(arguments), path.name, show_all_output)


def launch_description(world: World, description: LaunchDescription, arguments: Mapping[str, object]) -> LaunchHandle:
    """As `turtle_lesson.ros.launching.launch_description`."""
    source = LaunchDescriptionSource(description, "notebook cell")
    return _begin(world, source, as_text(arguments), "a description")


def launch_arguments(world: World, path: Path) -> list[LaunchArgument]:
    """As `turtle_lesson.ros.launching.launch_arguments`."""
    source = AnyLaunchDescriptionSource(_existing(path))
    try:
        with seeing(LaunchedPackages(world.packages)):
            return declared_in(source._get_launch_description(str(path)))
    except Exception as error:
        raise as_launch_error(error, None, {}) from learners_cause(error)


def _existing(path: Path) -> str:
    if path.is_file():
        return str(path.resolve())
    others = (
        sorted(other.name for other in path.parent.glob("*") if is_launch_file(other.name))
        if path.parent.is_dir()
        else []
    )
    hint = f"There are: {', '.join(others)}." if others else ""
    raise LaunchError(f"there is no launch file {shown_path(str(path))}", None, hint)


def _begin(
    world: World,
    source: LaunchDescriptionSource,
    arguments: dict[str, str],
    name: str,
    show_all_output: bool = False,
) -> LaunchHandle:
    service = LaunchService(world, arguments)
    service.context._output_override = "both" if show_all_output else None
    include = IncludeLaunchDescription(source, launch_arguments=arguments.items())
    include._written_at = None  # it stands in no launch file
    try:
        service.begin(include)
    except LaunchError as error:
        raise error from learners_cause(error.__cause__)
    declared = [argument.name for argument in declared_in(source.get_launch_description(service.context))]
    for text in unknown_warnings(arguments, declared, service.context._configurations_read):
        service.screen.say("WARNING", "launch", text)
    return LaunchHandle(service, name)
