"""The packages that `colcon` finds below a folder, their order, and which of them it is to take (`--packages-select` …)."""

from __future__ import annotations

import argparse
import os
import re
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from pathlib import Path
from xml.etree import ElementTree

from ..idl.names import did_you_mean
from .manifest import BUILD_TYPES, SetupError, faults_in, read_setup

IGNORE_MARKERS = ("COLCON_IGNORE", "AMENT_IGNORE", "CATKIN_IGNORE")
_ORDERING = {"depend", "build_depend", "build_export_depend", "buildtool_depend", "buildtool_export_depend",
             "exec_depend", "run_depend", "test_depend"}  # fmt: skip
_ACCEPTED = re.compile(r"[a-zA-Z0-9][a-zA-Z0-9_-]*")
Warn = Callable[[str], None]


class ColconError(Exception):
    """Why colcon builds nothing at all; the text is what stands after `ERROR:colcon:colcon build: `."""


@dataclass
class Found:
    """A package's folder.

    Attributes:
        name: what package.xml says, or the folder's name where it cannot be read.
        path: the folder.
        shown: the folder from the workspace's.
        build_type: as package.xml says, empty if it says nothing.
        dependencies: all packages that it names.
        root: the parsed package.xml, or None.
        xml_error: why package.xml cannot be read, empty if it can; beside a setup.py also what is refused in it.
    """

    name: str
    path: Path
    shown: str
    build_type: str = ""
    dependencies: list[str] = field(default_factory=list)
    root: ElementTree.Element | None = None
    xml_error: str = ""

    @property
    def kind(self) -> str:
        """As `colcon list` names it: `ros.ament_cmake`."""
        if self.root is None:
            return "python" if (self.path / "setup.py").is_file() else "cmake"
        return f"ros.{self.build_type or 'catkin'}"

    @property
    def is_python(self) -> bool:
        """Whether it is built by its setup.py."""
        return self.kind in {"ros.ament_python", "python"}

    @property
    def buildable(self) -> bool:
        """Whether colcon knows how to build it at all."""
        return self.root is None or not self.build_type or self.build_type in BUILD_TYPES

    def member_of(self, group: str) -> bool:
        """Whether package.xml has `<member_of_group>` of this group."""
        elements = [] if self.root is None else self.root.findall("member_of_group")
        return any((element.text or "").strip() == group for element in elements)

    def runtime_dependencies(self) -> list[str]:
        """The packages that are needed when it runs."""
        tags = {"depend", "exec_depend", "build_export_depend", "buildtool_export_depend", "run_depend"}
        children = [] if self.root is None else list(self.root)
        return [(child.text or "").strip() for child in children if child.tag in tags]


def discover(folder: Path, base: Path | None = None) -> list[Found]:
    """All packages below a folder, sorted by their place; packages inside of packages are not looked for."""
    base = base or folder
    found = []
    for place, folders, files in os.walk(folder):
        path = Path(place)
        if any(marker in files for marker in IGNORE_MARKERS):
            folders.clear()
        elif "package.xml" in files:
            found.append(read_found(path, base))
            folders.clear()
        else:
            folders[:] = sorted(name for name in folders if not name.startswith(".") and name != "__pycache__")
    return found


def read_found(path: Path, base: Path) -> Found:
    """What one package's folder says about itself.

    A folder whose package.xml is refused and that has a setup.py is a plain Python package for colcon, which has its name
    from setup.py and knows of no dependencies (colcon_ros's package_identification/ros.py, colcon_python_setup_py).
    """
    shown = path.relative_to(base).as_posix() if path.is_relative_to(base) else str(path)
    try:
        root = ElementTree.fromstring((path / "package.xml").read_bytes())
    except (ElementTree.ParseError, OSError, ValueError, LookupError) as error:
        return Found(_name_of_project(path) or _name_in_setup(path) or path.name, path, shown, xml_error=str(error))
    name = " ".join((root.findtext("name") or "").split())
    if not _ACCEPTED.fullmatch(name):  # colcon takes it for a package without package.xml then
        name = _name_of_project(path) or path.name
    build_type = (root.findtext("export/build_type") or "").strip()
    if build_type != "ament_cmake" and (faults := faults_in(root)) and (name_in_setup := _name_in_setup(path)):
        return Found(name_in_setup, path, shown, xml_error=faults[0])
    dependencies = [(child.text or "").strip() for child in root if child.tag in _ORDERING]
    return Found(name, path, shown, build_type, list(dict.fromkeys(filter(None, dependencies))), root)


def _name_of_project(path: Path) -> str:
    file = path / "CMakeLists.txt"
    text = file.read_text(encoding="utf-8", errors="replace") if file.is_file() else ""
    match = re.search(r"^\s*project\s*\(\s*([\w-]+)", text, re.MULTILINE | re.IGNORECASE)
    return match[1] if match else ""


def _name_in_setup(path: Path) -> str:
    """The name that setup.py gives; nothing without one that can be run."""
    if not (path / "setup.py").is_file():
        return ""
    try:
        return str(read_setup(path).get("name", ""))
    except SetupError:
        return ""


def in_order(packages: Iterable[Found]) -> list[Found]:
    """The packages so that each comes after those it depends on, otherwise by name.

    Raises:
        ColconError: two packages have one name, or some depend on each other in a circle.
    """
    waiting = sorted(packages, key=lambda found: found.name)
    _check_unique(waiting)
    ordered: list[Found] = []
    while waiting:
        names = {found.name for found in waiting}
        ready = [found for found in waiting if not names.intersection(found.dependencies) - {found.name}]
        if not ready:
            lines = [f"{each.name}: {sorted(needed_by(waiting, [each.name]) - {each.name})}" for each in waiting]
            raise ColconError("\n".join(["Unable to order packages topologically:", *lines]))
        ordered += ready
        waiting = [found for found in waiting if found not in ready]
    return ordered


def _check_unique(packages: list[Found]) -> None:
    places: dict[str, list[str]] = {}
    for found in packages:
        places.setdefault(found.name, []).append(found.shown)
    twice = {name: shown for name, shown in places.items() if len(shown) > 1}
    if twice:
        lines = [line for name, shown in twice.items() for line in (f"- {name}:", *(f"  - {each}" for each in shown))]
        raise ColconError("\n".join(["Duplicate package names not supported:", *lines]))


def needed_by(packages: Iterable[Found], names: Iterable[str]) -> set[str]:
    """The names of the packages, and of all among them that these depend on."""
    by_name = {found.name: found for found in packages}
    found: set[str] = set()
    waiting = [name for name in names if name in by_name]
    while waiting:
        name = waiting.pop()
        if name not in found:
            found.add(name)
            waiting += [each for each in by_name[name].dependencies if each in by_name]
    return found


def build_type_hint(build_type: str) -> str:
    """What to try about an unknown build type."""
    return did_you_mean(build_type, BUILD_TYPES) or f"Known are {', '.join(BUILD_TYPES)}."


class UnknownPackageError(ColconError):
    """A package that an option names, and without which nothing makes sense."""


def add_selection(parser: argparse.ArgumentParser) -> None:
    """The options that choose packages."""
    parser.add_argument("--base-paths", nargs="*", metavar="PATH", help="folders to look for packages in (default: .)")
    for option, text in _MANY.items():
        parser.add_argument(option, nargs="*", metavar="PATTERN" if "regex" in option else "PKG_NAME", help=text)
    parser.add_argument("--packages-start", metavar="PKG_NAME", help="this package and those that come after it")
    parser.add_argument("--packages-end", metavar="PKG_NAME", help="this package and those that come before it")


_MANY = {
    "--packages-ignore": "packages to ignore, as if they did not exist",
    "--packages-up-to": "these packages and all that they depend on",
    "--packages-above": "these packages and all that depend on them",
    "--packages-select": "only these packages",
    "--packages-skip": "all packages except these",
    "--packages-select-regex": "only packages whose names match",
    "--packages-skip-regex": "all packages except those whose names match",
}


def choose(args: argparse.Namespace, found: list[Found], warn: Warn) -> list[Found]:
    """The packages that are left. What is named and is not there is told to `warn`.

    Raises:
        UnknownPackageError: an option that needs its package names one that is not there.
        ColconError: a pattern is no regular expression.
    """
    found = [each for each in found if each.name not in set(args.packages_ignore or [])]
    names = {each.name for each in found}
    _check_names(args, names, warn)
    chosen = set(names)
    if args.packages_select is not None:
        chosen &= set(args.packages_select)
    if args.packages_up_to is not None:
        chosen &= needed_by(found, args.packages_up_to)
    if args.packages_above is not None:
        above = set(args.packages_above)
        chosen &= {each.name for each in found if needed_by(found, [each.name]) & above}
    if args.packages_select_regex is not None:
        chosen &= _matching(names, args.packages_select_regex)
    chosen -= set(args.packages_skip or []) | _matching(names, args.packages_skip_regex or [])
    if args.packages_start or args.packages_end:
        ordered = [each.name for each in in_order(found)]
        first = ordered.index(args.packages_start) if args.packages_start else 0
        chosen &= set(ordered[first : ordered.index(args.packages_end) + 1 if args.packages_end else None])
    return [each for each in found if each.name in chosen]


def advice(name: str, names: Iterable[str]) -> str:
    """What was perhaps meant, or all that there is."""
    names = sorted(names)
    return did_you_mean(name, names) or (f"There are: {', '.join(names)}." if names else "")


def _check_names(args: argparse.Namespace, names: set[str], warn: Warn) -> None:
    for option in ("--packages-up-to", "--packages-above", "--packages-start", "--packages-end"):
        given = getattr(args, option.removeprefix("--").replace("-", "_")) or []
        for name in [given] if isinstance(given, str) else given:
            if name not in names:
                text = f"Package '{name[:80]}' specified with {option} was not found"
                raise UnknownPackageError(f"{text}\nHint: {advice(name, names)}" if names else text)
    for option in ("packages_select", "packages_skip"):
        for name in getattr(args, option) or []:
            if name not in names:
                flag = "--" + option.replace("_", "-")
                hint = advice(name, names)
                warn(f"ignoring unknown package '{name[:80]}' in {flag}" + (f"\nHint: {hint}" if hint else ""))


def _matching(names: set[str], patterns: list[str]) -> set[str]:
    try:
        return {name for name in names if any(re.fullmatch(pattern, name) for pattern in patterns)}
    except re.error as error:
        raise ColconError(f"{' '.join(patterns)[:80]} is not a regular expression: {error}") from None
