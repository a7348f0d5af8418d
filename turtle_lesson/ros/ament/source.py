"""`source install/setup.bash`: what was built becomes findable and importable, on top of what was there before."""

from __future__ import annotations

import importlib
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, TextIO

from ..idl.names import did_you_mean
from ..idl.registry import registry
from .install_tree import (
    LAYOUT,
    PYTHON_FOLDERS,
    Environment,
    Outcome,
    installed_names,
    python_folders,
    read_installed,
)
from .manifest import Found, build_type_hint, read_found
from .package import Package, PackageError, PythonProgram, Target, forget_below

if TYPE_CHECKING:
    from ..runtime.world import World

_SETUP_FILES = {f"{name}.{shell}" for name in ("setup", "local_setup") for shell in ("bash", "sh", "zsh", "ps1")}
_UNDERLAY = "/opt/ros/"


def source(world: World, words: list[str], *, cwd: Path | None = None, stdout: TextIO, stderr: TextIO) -> int:
    """`source FILE`: returns bash's exit code; a wrong name is answered in bash's words, and with what to try."""
    if not words:
        print("bash: source: filename argument required\nsource: usage: source filename [arguments]", file=stderr)
        return 2
    if words[0].startswith(_UNDERLAY):
        return 0  # the simulation's own packages are always there
    file = (cwd or Path.cwd()) / Path(words[0]).expanduser()
    if problem := _problem(words[0], file):
        print(problem, file=stderr)
        return 1
    overlay(world, file.resolve().parent)
    return 0


def _problem(word: str, file: Path) -> str:
    if file.is_dir():
        return f"bash: source: {word}: is a directory. Name the file in it: source {word.rstrip('/')}/setup.bash"
    if not file.is_file():
        text = f"bash: {word}: No such file or directory"
        if file.parent.is_dir() and (close := did_you_mean(file.name, _SETUP_FILES)):
            return f"{text}. {close}" if (file.parent / LAYOUT).is_file() else text
        return f"{text}. Have you run colcon build, and are you in the workspace's folder (the one that contains src/)?"
    if file.name not in _SETUP_FILES or not (file.parent / LAYOUT).is_file():
        return f"bash: {word}: this simulated terminal sources only what colcon build makes: source install/setup.bash"
    return ""


# -- overlays ----------------------------------------------------------------------------------------------------------


@dataclass
class _Overlay:
    """One sourced package, and what it hides in the registry of interfaces."""

    install: Path
    package: Package
    paths: list[Path]
    hidden: tuple[Path, tuple[str, ...] | None] | None


def overlay(world: World, install: Path) -> list[str]:
    """Make the packages of an install folder findable; return their names, each after those it needs."""
    names = installed_names(install)
    for name in names:
        _add(world, install, name)
    importlib.invalidate_caches()
    return names


def resource(world: World, install: Path, name: str) -> None:
    """Read one package anew, if it is sourced: its files have changed."""
    install = install.resolve()
    if any((each.install, each.package.name) == (install, name) for each in overlays(world)):
        _add(world, install, name)
        importlib.invalidate_caches()


class _Overlays(list[_Overlay]):
    """What is sourced in a world."""


def overlays(world: World) -> list[_Overlay]:
    """What is sourced, in its order."""
    return world.notebook.state(_Overlays)


def _add(world: World, install: Path, name: str) -> None:
    if not overlays(world):
        world.notebook.at_exit.append(lambda: remove_all(world))
    _remove(world, install, name)
    package = read_installed(install, name)
    prefix = package.prefix or install
    paths = python_folders(prefix)
    if paths:
        package.executables = {
            name: PythonProgram(target, tuple(paths)) if isinstance(target, Path) else target
            for name, target in package.executables.items()
        }
    hidden = None  # the interfaces of this name that were added before; a built-in package shows again by itself
    if package.interfaces and registry.was_added(package.name):
        before = registry.package(package.name)
        hidden = before.directory, before.files
    overlays(world).append(_Overlay(install, package, paths, hidden))
    world.packages.add(package)
    if package.interfaces:
        registry.add(package.name, package.share, package.interfaces)
    forget_below([prefix])
    for path in paths:
        if str(path) not in sys.path:
            sys.path.append(str(path))


def _remove(world: World, install: Path, name: str) -> None:
    for each in [each for each in overlays(world) if (each.install, each.package.name) == (install, name)]:
        overlays(world).remove(each)
        world.packages.remove(each.package)
        name, is_known = each.package.name, each.package.name in registry.packages()
        if each.package.interfaces and is_known and registry.package(name).directory == each.package.share:
            registry.remove(name)  # unless somebody else has put another in its place
            if each.hidden is not None:
                registry.add(name, *each.hidden)
        for path in each.paths:
            shared = any(path in other.paths for other in overlays(world))  # in a merged install folder
            if str(path) in sys.path and not shared:
                sys.path.remove(str(path))
        forget_below([each.package.prefix or each.install])


def remove_all(world: World) -> None:
    """Undo every `source` of a world."""
    for each in reversed(overlays(world)[:]):
        _remove(world, each.install, each.package.name)


# -- a package that is used as it lies there ---------------------------------------------------------------------------


def read_source_package(folder: Path | str) -> Package:
    """Take a package as it lies in its source folder, as if it had just been built and sourced.

    Raises PackageError, in a build's own words, for what it would refuse.
    """
    folder = Path(folder).resolve()
    file = folder / "package.xml"
    if not file.is_file():
        hint = "A folder is a ROS 2 package if it holds a package.xml; ros2 pkg create makes one."
        raise PackageError("it is missing", file, hint=hint)
    found = read_found(folder, folder.parent)
    environment = Environment(folder / "install", folder / "build", symlink=found.is_python, compiles=False)
    outcome = checked_build(found, environment)
    share, libexec, site = f"share/{found.name}/", f"lib/{found.name}/", PYTHON_FOLDERS["python"]
    modules = {
        item.source.parents[item.target.removeprefix(site).count("/") - 1]
        for item in outcome.items
        if item.source and item.target.startswith(f"{site}/")
    }
    executables: dict[str, Target] = {}
    for item in outcome.items:
        if item.program and item.target.startswith(libexec):
            path, text = (item.source, None) if item.source else (folder / item.target, item.text)
            program = PythonProgram(path, tuple(sorted(modules)), text)
            executables[item.target.removeprefix(libexec)] = program if modules else path
    installed = {
        item.target.removeprefix(share): item.source
        for item in outcome.items
        if item.source and item.target.startswith(share)
    }
    interfaces = [item.target.removeprefix(share) for item in outcome.items if item.source and item.copied]
    return Package(found.name, folder, executables, interfaces, folder, installed=installed, modules=sorted(modules))


def checked_build(found: Found, environment: Environment) -> Outcome:
    """What a build makes of a package.

    Raises PackageError where a real build would refuse the package, with the build's own words.
    """
    if not found.buildable:
        hint = build_type_hint(found.build_type)
        raise PackageError(f"the build_type '{found.build_type}' is unknown", found.path / "package.xml", hint=hint)
    if found.is_python:
        from .ament_python import build_ament_python as build
    else:
        from .ament_cmake import build_ament_cmake as build
    outcome = build(found, environment)
    if outcome.code:
        raise PackageError(f"a real build would refuse {found.name}:\n{outcome.stderr.strip()}")
    return outcome


def make_importable(world: World, package: Package) -> None:
    """Have the modules of a package that is used as it lies there be found, as long as the world lasts."""
    added = [str(path) for path in package.modules if str(path) not in sys.path]
    sys.path += added
    forget_below(package.modules)
    importlib.invalidate_caches()

    def undo() -> None:
        sys.path[:] = [path for path in sys.path if path not in added]
        forget_below(package.modules)

    world.notebook.at_exit.append(undo)
