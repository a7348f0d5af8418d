"""From a file or a description to a running launch."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from launch import LaunchDescription, LaunchDescriptionSource
from launch.actions import IncludeLaunchDescription
from launch.launch_description_sources import AnyLaunchDescriptionSource

from ..core.tracebacks import shown_path
from ..workspace.index import LaunchedPackages, is_launch_file, seeing
from ..world import World
from .arguments import LaunchArgument, as_text, declared_in, unknown_warnings
from .errors import LaunchError, learners_cause
from .handle import LaunchHandle
from .service import LaunchService, as_launch_error


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
