"""`lesson.export(…)`: a package as it goes to a robot: checked with every rule of the build, and with a README."""

from __future__ import annotations

import ast
import shutil
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

from ..idl.names import did_you_mean
from ..idl.registry import registry
from ..sim.errors import shown_path
from .build import types_for
from .index import CMAKE_PACKAGES, PYTHON_PACKAGES, is_launch_file
from .install_tree import Environment, Outcome
from .manifest import Found, discover, read_found
from .package import PackageError, filled
from .source import checked_build

if TYPE_CHECKING:
    from ..distro import Release
    from ..runtime.world import World

_LEFT_OUT = (
    "__pycache__", "*.pyc", ".git", ".ipynb_checkpoints", ".mypy_cache", ".pytest_cache", "build", "install", "log",
)  # fmt: skip
_TEXT = {".py", ".xml", ".txt", ".msg", ".srv", ".action", ".cfg", ".yaml", ".yml", ".md", ""}
_OURS = "turtle_lesson"


@dataclass
class Exported:
    """What was written: the workspace's folder, the package in it, and what to look at before a robot runs it."""

    folder: Path
    package: Path
    name: str
    programs: list[str] = field(default_factory=list)
    interfaces: list[str] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)

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
    _check_target(found, target, overwrite)
    with tempfile.TemporaryDirectory() as scratch:
        install, build = Path(scratch, "install"), Path(scratch, "build")
        environment = Environment(install, build, frozenset(registry.packages()), types_for(found, {}))
        outcome = checked_build(found, environment)
    imports = list(_imports(found.path))
    for file, line, name in imports:
        if name == _OURS:
            hint = "A robot does not have it: use only rclpy and the topics."
            raise PackageError(f"this imports {_OURS}", file, line, hint)
    if target.exists():
        shutil.rmtree(target)
    shutil.copytree(found.path, target, ignore=shutil.ignore_patterns(*_LEFT_OUT))
    for file in target.rglob("*"):  # line ends as Linux wants them
        if file.is_file() and file.suffix in _TEXT and b"\r\n" in (data := file.read_bytes()):
            file.write_bytes(data.replace(b"\r\n", b"\n"))
    for item in outcome.items:
        if item.program and item.source is not None:
            (target / item.source.relative_to(found.path)).chmod(0o755)
    result = _describe(found, target, outcome)
    result.notes += [*_missing_dependencies(found, imports), *_newer_than(world.release, found), *_left_to_do(target)]
    (target.parent.parent / "README.md").write_text(_readme(result, found), encoding="utf-8", newline="\n")
    return result


def _find(world: World, package: str | Path) -> Found:
    folder = Path(package)
    if (folder / "package.xml").is_file():
        return read_found(folder.resolve(), folder.resolve().parent)
    name = str(package)
    here = {each.name: each for each in discover(Path.cwd() / "src", Path.cwd())}
    if name in here:
        return here[name]
    known = {each.name: each.source for each in world.packages if each.source is not None}
    source = known.get(name)
    if source is None and name == "robot_controller":
        source = Path(__file__).resolve().parents[2] / "robot_controller"
    if source is None:
        names = {*here, *known, "robot_controller"}
        hint = did_you_mean(name, names) or f"There are: {', '.join(sorted(names))}."
        raise PackageError(f"the source of the package {name!r} is not known", hint=hint)
    return read_found(source, source.parent)


def _check_target(found: Found, target: Path, overwrite: bool) -> None:
    if target == found.path or found.path in target.parents or target in found.path.parents:
        raise PackageError(f"{shown_path(str(target))} is the package's own source; export it to another folder")
    readme = target.parent.parent / "README.md"
    own = readme.exists() and "package from Turtle Lesson" not in readme.read_text(encoding="utf-8", errors="replace")
    if (target.exists() or own) and not overwrite:
        hint = "Choose another folder, or write overwrite=True."
        raise PackageError(f"{shown_path(str(readme if own else target))} already exists", hint=hint)


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


def _describe(found: Found, target: Path, outcome: Outcome) -> Exported:
    programs = [item.target.rpartition("/")[2] for item in outcome.items if item.program]
    share = f"share/{found.name}/"
    interfaces = [item.target.removeprefix(share) for item in outcome.items if item.source and item.copied]
    hints = [line.removeprefix("Hint: ") for line in outcome.stderr.splitlines() if line.startswith("Hint: ")]
    return Exported(target.parent.parent, target, found.name, sorted(programs), sorted(interfaces), hints)


def _left_to_do(target: Path) -> Iterator[str]:
    """What is to be looked at in the exported folder."""
    folder = target.parent.parent
    if (Path.cwd() / "src").is_dir() and Path.cwd() in target.parents:
        yield f"{shown_path(str(target))} lies in this workspace, where colcon build now finds {target.name} twice"
    if built := [f"{name}/" for name in ("build", "install", "log") if (folder / name).is_dir()]:
        yield f"{shown_path(str(folder))} holds {', '.join(built)} from a build on this computer: do not copy them"
    text = (target / "package.xml").read_text(encoding="utf-8")
    for word in ("TODO: Package description", "TODO: License"):
        if word in text:
            yield f"package.xml still says '{word}'"


def _missing_dependencies(found: Found, imports: list[tuple[Path, int, str]]) -> list[str]:
    """Packages that the code imports and that package.xml does not name: `rosdep` would not install them."""
    known = {*registry.packages(), *CMAKE_PACKAGES, *PYTHON_PACKAGES} - {found.name, *found.dependencies}
    notes: dict[str, str] = {}
    for file, line, name in imports:
        if name in known:
            place = f"{file.relative_to(found.path).as_posix()}, line {line}"
            notes.setdefault(name, f"{place}, imports {name}: add <exec_depend>{name}</exec_depend> to package.xml")
    return list(notes.values())


def _newer_than(release: Release, found: Found) -> Iterator[str]:
    """What the package's programs have used in this world, although the world's release lacks it."""
    for (change, place), line in release.lacked.items():
        for file in found.path.rglob(Path(place).name):
            if file.parts[-2:] == Path(place).parts[-2:]:  # programs may run from a copy that a build has made
                used = f"{file.relative_to(found.path).as_posix()}, line {line}, uses what {release.title} lacks"
                yield f"{used}. Since {change.since.capitalize()} {change.what}; before, {change.before}"
                break


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
