"""The packages of a world: those that a fresh ROS 2 brings, its underlay, and the lesson's own or another from its source."""

from __future__ import annotations

from collections.abc import Callable
from importlib.util import find_spec
from pathlib import Path

from ..learner.story import FINISHED, HERE
from ..ros.ament.package import Package
from ..ros.ament.source import make_importable, read_source_package
from ..ros.idl.registry import registry
from ..ros.runtime.world import World
from ..ros.tools import demo_packages, program, tf2_packages

SIMULATOR: Callable[[], object] = program("turtle_lesson.turtlesim.node")
"""What runs the turtle simulator."""


def underlay_packages() -> list[Package]:
    """The packages of a fresh ROS 2 whose programs `ros2 run` and launch files find: turtlesim, tf2, demos, xacro."""
    names = ("draw_square", "mimic", "turtle_teleop_key")
    programs = {name: program("turtle_lesson.turtlesim.tutorials", name) for name in names}
    turtlesim = Package("turtlesim", HERE / "turtlesim", executables={"turtlesim_node": SIMULATOR, **programs})
    packages = [turtlesim, *tf2_packages(), *demo_packages()]
    xacro = find_spec("xacro")  # a package of PyPI, which may be installed
    if xacro is not None and xacro.origin is not None:
        packages.append(Package("xacro", Path(xacro.origin).parent, executables={"xacro": program("xacro")}))
    return packages


def package_folder(package: str | Path | None) -> Path | None:
    """The source folder of the package that `start` is asked for, None for none. Raises ValueError where it is not there."""
    if package is None:
        return None
    if package == "finished":
        return FINISHED
    if isinstance(package, (str, Path)) and Path(package).is_dir():
        return Path(package).resolve()
    raise ValueError(
        f'package must be "finished", "mine", None or the folder of a package, got {package!r}, which is not a folder here'
    )


def install(world: World, folder: Path) -> None:
    """Make a package's executables, launch files and interfaces findable, as building and sourcing it would."""
    package = read_source_package(folder)
    world.packages.add(package)
    make_importable(world, package)
    if package.interfaces:
        if package.name in registry.packages():
            registry.remove(package.name)
        registry.add(package.name, folder, package.interfaces)
