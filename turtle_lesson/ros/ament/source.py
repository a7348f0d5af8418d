"""A package from its source on: sourced after a build, used as it lies there, or exported for a robot.

`source install/setup.bash` makes what was built findable and importable, on top of what was there before.
"""

from __future__ import annotations

import ast
import importlib
import shutil
import sys
import tempfile
from collections.abc import Collection, Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TextIO

from ..distro import Release
from ..idl.names import did_you_mean
from ..idl.registry import Registry, registry
from ..runtime.world import World
from ..sim.errors import shown_path
from .index import CMAKE_PACKAGES, PYTHON_PACKAGES, is_launch_file
from .install_tree import LAYOUT, PYTHON_FOLDERS, SETUP_FILES, Environment, Outcome, installed_names, read_installed
from .manifest import Found, build_type_hint, discover, read_found
from .package import Package, PackageError, PythonProgram, Target, filled, forget_below


def source(world: World, words: list[str], *, stdout: TextIO, stderr: TextIO, cwd: Path) -> int:
    """`source FILE`: returns bash's exit code; a wrong name is answered in bash's words, and with what to try."""
    if not words:
        print("bash: source: filename argument required\nsource: usage: source filename [arguments]", file=stderr)
        return 2
    if words[0].startswith("/opt/ros/"):
        return 0  # the simulation's own packages are always there
    file = cwd / Path(words[0]).expanduser()
    is_install = (file.parent / LAYOUT).is_file()
    if is_install and file.is_file() and file.name in SETUP_FILES:
        overlay(world, file.resolve().parent)
        return 0
    word, text = words[0], f"bash: {words[0]}: No such file or directory"
    if file.is_dir():
        text = f"bash: source: {word}: is a directory. Name the file in it: source {word.rstrip('/')}/setup.bash"
    elif file.is_file():
        text = f"bash: {word}: this simulated terminal sources only what colcon build makes: source install/setup.bash"
    elif is_install:
        text = f"{text}. {did_you_mean(file.name, SETUP_FILES)}".removesuffix(". ")
    else:
        text += ". Have you run colcon build, and are you in the workspace's folder (the one that contains src/)?"
    print(text, file=stderr)
    return 1


# -- overlays ----------------------------------------------------------------------------------------------------------


class _Overlays(list[tuple[Path, Package]]):
    """What is sourced in a world."""


def overlays(world: World) -> list[tuple[Path, Package]]:
    """The packages that are sourced, in their order, each with the install folder that it is in."""
    return world.notebook.state(_Overlays)


def overlay(world: World, install: Path) -> None:
    """Make the packages of an install folder findable, each after those it needs."""
    for name in installed_names(install):
        _add(world, install, name)


def resource(world: World, install: Path, name: str) -> None:
    """Read one package anew, if it is sourced: its files have changed."""
    if (install.resolve(), name) in [(place, package.name) for place, package in overlays(world)]:
        _add(world, install.resolve(), name)


def _add(world: World, install: Path, name: str) -> None:
    if not overlays(world):
        world.notebook.at_exit.append(lambda: remove_all(world))
    for place, package in overlays(world)[:]:
        if (place, package.name) == (install, name):
            _remove(world, package)
    package = read_installed(install, name)
    overlays(world).append((install, package))
    _show(world, package)


def _show(world: World, package: Package) -> None:
    world.packages.add(package)
    if package.interfaces:
        registry.add(package.name, package.share, package.interfaces)
    forget_below([package.prefix] if package.prefix else package.modules)
    sys.path += [str(path) for path in package.modules if str(path) not in sys.path]
    importlib.invalidate_caches()


def _remove(world: World, package: Package) -> None:
    overlays(world)[:] = [each for each in overlays(world) if each[1] is not package]
    world.packages.remove(package)
    if any((each.name, each.directory) == (package.name, package.share) for each in registry.added()):
        registry.remove(package.name)  # unless somebody else has put another in its place
        if package.name in world.packages and (hidden := world.packages.get(package.name)).interfaces:
            registry.add(package.name, hidden.share, hidden.interfaces)
    shared = {path for _, other in overlays(world) for path in other.modules}  # in a merged install folder
    _forget(package, {*package.modules} - shared)


def _forget(package: Package, folders: Collection[Path]) -> None:
    """Take folders of a package's modules from the path, and have its modules be imported anew."""
    sys.path[:] = [path for path in sys.path if path not in set(map(str, folders))]
    forget_below([package.prefix] if package.prefix else package.modules)


def remove_all(world: World) -> None:
    """Undo every `source` of a world."""
    for _, package in reversed(overlays(world)[:]):
        _remove(world, package)


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
    files = {item.target: item.source for item in outcome.items if item.source}
    inside = {target.removeprefix(site): path for target, path in files.items() if target.startswith(f"{site}/")}
    modules = sorted({path.parents[inner.count("/") - 1] for inner, path in inside.items()})
    executables: dict[str, Target] = {}
    for item in outcome.items:
        if item.program and item.target.startswith(libexec):
            path, text = (item.source, None) if item.source else (folder / item.target, item.text)
            program = PythonProgram(path, tuple(modules), text)
            executables[item.target.removeprefix(libexec)] = program if modules else path
    installed = {target.removeprefix(share): path for target, path in files.items() if target.startswith(share)}
    interfaces = [item.target.removeprefix(share) for item in outcome.items if item.source and item.copied]
    return Package(found.name, folder, executables, interfaces, folder, installed=installed, modules=modules)


def types_for(found: Found, built: Iterable[Package] = ()) -> Registry:
    """The interfaces that a package's build sees, but for its own: the built-in ones, what is sourced, and what is `built`."""
    types = Registry()
    for sourced in registry.added():
        if sourced.name != found.name:
            types.add(sourced.name, sourced.directory, sourced.files)
    for package in built:
        if package.interfaces:
            types.add(package.name, package.share, package.interfaces)
    return types


def checked_build(found: Found, environment: Environment) -> Outcome:
    """What a build makes of a package. Raises PackageError, in a real build's words, where that would refuse it."""
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


def use_source(world: World, folder: Path) -> None:
    """Make a package's executables, modules, launch files and interfaces findable, as building and sourcing it would."""
    package = read_source_package(folder)
    added = [path for path in package.modules if str(path) not in sys.path]
    _show(world, package)
    world.notebook.at_exit.append(lambda: _forget(package, added))


# -- a package as it goes to a robot: checked with every rule of the build, and with a README ----------------------------

_LEFT_OUT = (
    "__pycache__", "*.pyc", ".git", ".ipynb_checkpoints", ".mypy_cache", ".pytest_cache", "build", "install", "log",
)  # fmt: skip
_TEXT = {".py", ".xml", ".txt", ".msg", ".srv", ".action", ".cfg", ".yaml", ".yml", ".md", ""}


@dataclass
class Exported:
    """What was written: the workspace's folder, the package in it, and what to look at before a robot runs it."""

    folder: Path
    package: Path
    name: str
    programs: list[str]
    interfaces: list[str]
    notes: list[str]

    def __repr__(self) -> str:
        lines = [
            f"{self.name} is in {shown_path(str(self.package))}/; README.md beside src/ says how to build it.",
            "Copy src/ and README.md to the robot, but not build/, install/ or log/: the robot builds its own.",
            f"programs: {', '.join(self.programs) or 'none'}",
            f"interfaces: {', '.join(self.interfaces) or 'none'}",
            *(f"look at: {note}" for note in self.notes),
        ]
        return "\n".join(lines)


def export_package(world: World, package: str | Path, to: str | Path, *, overwrite: bool = False) -> Exported:
    """Write a package, given by its name or its source folder, into `to`/src, and a README of the commands to build it.

    A name is looked for below the current folder, then in the world. Raises PackageError where there is no such package,
    where a real build would refuse it (in its own words), or where it lies there already, unless `overwrite`.
    """
    found = _find(world, package)
    target = Path(to).expanduser().resolve() / "src" / found.name
    if target == found.path or found.path in target.parents or target in found.path.parents:
        raise PackageError(f"{shown_path(str(target))} is the package's own source; export it to another folder")
    readme = target.parent.parent / "README.md"
    own = readme.exists() and "package from Turtle Lesson" not in readme.read_text(encoding="utf-8", errors="replace")
    if (target.exists() or own) and not overwrite:
        hint = "Choose another folder, or write overwrite=True."
        raise PackageError(f"{shown_path(str(readme if own else target))} already exists", hint=hint)
    with tempfile.TemporaryDirectory() as scratch:
        install, build = Path(scratch, "install"), Path(scratch, "build")
        environment = Environment(install, build, frozenset(registry.packages()), types_for(found))
        outcome = checked_build(found, environment)
    imports = list(_imports(found.path))
    for file, line, name in imports:
        if name == "turtle_lesson":
            hint = "A robot does not have it: use only rclpy and the topics."
            raise PackageError("this imports turtle_lesson", file, line, hint)
    if target.exists():
        shutil.rmtree(target)
    shutil.copytree(found.path, target, ignore=shutil.ignore_patterns(*_LEFT_OUT))
    for file in target.rglob("*"):  # line ends as Linux wants them
        if file.is_file() and file.suffix in _TEXT and b"\r\n" in (data := file.read_bytes()):
            file.write_bytes(data.replace(b"\r\n", b"\n"))
    for item in outcome.items:
        if item.program and item.source is not None:
            (target / item.source.relative_to(found.path)).chmod(0o755)
    share = f"share/{found.name}/"
    result = Exported(
        folder=target.parent.parent,
        package=target,
        name=found.name,
        programs=sorted(item.target.rpartition("/")[2] for item in outcome.items if item.program),
        interfaces=sorted(item.target.removeprefix(share) for item in outcome.items if item.source and item.copied),
        notes=[line.removeprefix("Hint: ") for line in outcome.stderr.splitlines() if line.startswith("Hint: ")],
    )
    result.notes += _notes(world.release, found, imports, target)
    readme.write_text(_readme(result, found), encoding="utf-8", newline="\n")
    return result


def _find(world: World, package: str | Path) -> Found:
    name, folder = str(package), Path(package).resolve()
    if not (folder / "package.xml").is_file():
        known = {each.name: each.source for each in world.packages if each.source is not None}
        known |= {each.name: each.path for each in discover(Path.cwd() / "src", Path.cwd())}
        if name not in known:
            hint = did_you_mean(name, known) or f"There are: {', '.join(sorted(known))}."
            raise PackageError(f"the source of the package {name!r} is not known", hint=hint)
        folder = known[name]
    return read_found(folder, folder.parent)


def _imports(folder: Path) -> Iterator[tuple[Path, int, str]]:
    """What the package's own programs import, with the file and the line."""
    for file in sorted(folder.rglob("*.py")):
        if {"build", "install", "log", "test"} & set(file.relative_to(folder).parts):
            continue
        try:
            tree = ast.parse(file.read_bytes())
        except SyntaxError as error:
            raise PackageError(f"this is not valid Python ({error.msg})", file, error.lineno) from None
        for node in ast.walk(tree):
            if isinstance(node, ast.Import):
                yield from ((file, node.lineno, alias.name.partition(".")[0]) for alias in node.names)
            elif isinstance(node, ast.ImportFrom) and node.module and not node.level:
                yield file, node.lineno, node.module.partition(".")[0]


def _notes(release: Release, found: Found, imports: list[tuple[Path, int, str]], target: Path) -> Iterator[str]:
    """What to look at in the exported package and its folder."""
    # `rosdep` would not install what the code imports and package.xml does not name.
    unnamed = {*registry.packages(), *CMAKE_PACKAGES, *PYTHON_PACKAGES} - {found.name, *found.dependencies}
    for file, line, name in imports:
        if name in unnamed:
            unnamed.remove(name)
            place = f"{file.relative_to(found.path).as_posix()}, line {line}"
            yield f"{place}, imports {name}: add <exec_depend>{name}</exec_depend> to package.xml"
    for (change, place), line in release.lacked.items():  # used in this world, although its release lacks it
        for file in found.path.rglob(Path(place).name):
            if file.parts[-2:] == Path(place).parts[-2:]:  # programs may run from a copy that a build has made
                used = f"{file.relative_to(found.path).as_posix()}, line {line}, uses what {release.title} lacks"
                yield f"{used}. Since {change.since.capitalize()} {change.what}; before, {change.before}"
                break
    text = (target / "package.xml").read_text(encoding="utf-8")
    for word in ("TODO: Package description", "TODO: License"):
        if word in text:
            yield f"package.xml still says '{word}'"


def _readme(result: Exported, found: Found) -> str:
    launch_files = sorted(path.name for path in result.package.rglob("*") if is_launch_file(path.name))
    run = [f"ros2 launch {result.name} {name}" for name in launch_files]
    run = run or [f"ros2 run {result.name} {name}" for name in result.programs]
    if "turtlesim" in found.dependencies:
        run.insert(
            0, "ros2 run turtlesim turtlesim_node        # in a terminal of its own, which sources the same files"
        )
    notes = "\n".join(f"- {note}" for note in result.notes)
    look = f"\n\n## Look at these first\n\n{notes}" if notes else ""
    return filled("README.md", name=result.name, run="\n".join(run) or "# it has no program yet", look=look)
