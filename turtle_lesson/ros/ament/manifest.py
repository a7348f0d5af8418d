"""The packages below a folder, as their `package.xml` describe them, their order, and what a real build refuses in them.

Facts: REP 149 (https://ros.org/reps/rep-0149.html; format 1 to 3), colcon_ros's package_identification/ros.py, and catkin_pkg
0.5, which every real build asks, and whose sentences are compared with ours in a test.
"""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from xml.etree import ElementTree

from ..idl.names import did_you_mean
from .package import ColconError

BUILD_TYPES = ("ament_cmake", "ament_python", "cmake")
IGNORE_MARKERS = {"COLCON_IGNORE", "AMENT_IGNORE", "CATKIN_IGNORE"}
RUNTIME = ("depend", "exec_depend", "build_export_depend", "buildtool_export_depend", "run_depend")
"""The tags that name what a package needs when it runs."""


@dataclass
class Found:
    """A package's folder: what its package.xml says, whose name and build type may be missing.

    Attributes:
        shown: the folder as seen from the workspace's.
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

    def texts(self, *tags: str) -> list[str]:
        """What package.xml says in these tags, in its order."""
        return [] if self.root is None else _texts(self.root, *tags)


def read_found(path: Path, base: Path) -> Found:
    """What one package's folder says about itself.

    For colcon, a folder whose package.xml is refused and that has a setup.py is a plain Python package without dependencies.
    Where package.xml gives no name, the package has the folder's.
    """
    shown = path.relative_to(base).as_posix() if path.is_relative_to(base) else str(path)
    try:
        root = ElementTree.fromstring((path / "package.xml").read_bytes())
    except (ElementTree.ParseError, OSError, ValueError, LookupError) as error:
        return Found(path.name, path, shown, xml_error=str(error))
    name = _text(root, "name")
    if not re.fullmatch(r"[a-zA-Z0-9][a-zA-Z0-9_-]*", name):  # colcon takes it for a package without package.xml then
        name = path.name
    build_type = _text(root, "export/build_type")
    if build_type != "ament_cmake" and (faults := faults_in(root)) and (path / "setup.py").is_file():
        fault, hint = next(iter(faults.items()))
        return Found(name, path, shown, xml_error=f"{fault}. {hint}".rstrip(". "))
    dependencies = list(dict.fromkeys(filter(None, _texts(root, *_DEPENDS[:-1], "run_depend"))))
    return Found(name, path, shown, build_type, dependencies, root)


def build_type_hint(build_type: str) -> str:
    """What to try about an unknown build type."""
    return did_you_mean(build_type, BUILD_TYPES) or f"Known are {', '.join(BUILD_TYPES)}."


# -- several packages ----------------------------------------------------------------------------------------------------


def discover(folder: Path, base: Path) -> list[Found]:
    """All packages below a folder, sorted by their place; packages inside of packages are not looked for."""
    found = []
    for place, folders, files in os.walk(folder):
        if IGNORE_MARKERS.intersection(files):
            folders.clear()
        elif "package.xml" in files:
            found.append(read_found(Path(place), base))
            folders.clear()
        else:
            folders[:] = sorted(name for name in folders if not name.startswith(".") and name != "__pycache__")
    return found


def in_order(packages: Iterable[Found]) -> list[Found]:
    """The packages so that each comes after those it depends on, otherwise by name.

    Raises ColconError where two packages have one name, or some depend on each other in a circle.
    """
    waiting = sorted(packages, key=lambda found: found.name)
    places: dict[str, list[str]] = {}
    for found in waiting:
        places.setdefault(found.name, []).append(found.shown)
    twice = [f"- {name}:\n  - " + "\n  - ".join(shown) for name, shown in places.items() if len(shown) > 1]
    if twice:
        raise ColconError("\n".join(["Duplicate package names not supported:", *twice]))
    by_name = {found.name: found for found in waiting}
    ordered, in_circles = by_rounds({name: found.dependencies for name, found in by_name.items()})
    if in_circles:
        left = [by_name[name] for name in in_circles]
        lines = [f"{name}: {sorted(needed_by(left, [name]) - {name})}" for name in in_circles]
        raise ColconError("\n".join(["Unable to order packages topologically:", *lines]))
    return [by_name[name] for name in ordered]


def by_rounds(needs: Mapping[str, Collection[str]]) -> tuple[list[str], list[str]]:
    """The names so that each comes after those it needs, otherwise sorted; and those that need each other in a circle."""
    ordered: list[str] = []
    waiting = sorted(needs)
    while ready := [name for name in waiting if not set(waiting).intersection(needs[name]) - {name}]:
        ordered += ready
        waiting = [name for name in waiting if name not in ready]
    return ordered, waiting


def reached(names: Iterable[str], needs: Callable[[str], Iterable[str]]) -> set[str]:
    """The names, and all that these need, at any distance."""
    found: set[str] = set()
    waiting = list(names)
    while waiting:
        name = waiting.pop()
        if name not in found:
            found.add(name)
            waiting += needs(name)
    return found


def needed_by(packages: Iterable[Found], names: Iterable[str]) -> set[str]:
    """The names of the packages, and of all among them that these depend on."""
    needs = {found.name: found.dependencies for found in packages}
    return reached(needs.keys() & names, lambda name: [each for each in needs[name] if each in needs])


# -- what is refused in a package.xml ------------------------------------------------------------------------------------

_DEPENDS = ("depend", "build_depend", "build_export_depend", "buildtool_depend", "buildtool_export_depend",
            "exec_depend", "test_depend", "doc_depend")  # fmt: skip
"""The last one alone has no part in the order of packages."""
_IN_ALL = {
    "name", "version", "description", "maintainer", "license", "url", "author", "conflict", "replace", "export",
    "build_depend", "buildtool_depend", "test_depend",
}  # fmt: skip
_TAGS = {
    "1": _IN_ALL | {"run_depend"},
    "2": _IN_ALL | {*_DEPENDS},
    "3": _IN_ALL | {*_DEPENDS, "group_depend", "member_of_group"},
}
_EMAIL = re.compile(r"[-a-zA-Z0-9_%+]+(\.[-a-zA-Z0-9_%+]+)*@[-a-zA-Z0-9%]+(\.[-a-zA-Z0-9%]+)*\.[a-zA-Z]{2,}")


def faults_in(root: ElementTree.Element) -> dict[str, str]:
    """Everything that is refused, in catkin_pkg's words, each with what to try; the first alone where it would stop at it."""
    version, name = root.get("format", "1"), _text(root, "name")
    if root.tag != "package":
        return {'The manifest must contain a single "package" root tag': ""}
    if version not in _TAGS:
        fault = f"Unable to handle package.xml format version '{version}', please update catkin_pkg"
        return {fault: 'Write <package format="3">.'}
    for tag in ("name", "version", "description"):
        if len(root.findall(tag)) != 1:
            fault = f'The manifest must contain exactly one "{tag}" tag'
            return {fault: "Write that tag once, directly inside <package>."}
    if len(root.findall("export")) > 1:
        fault = 'The manifest must not contain more than one "export" tags'
        return {fault: "Put everything that is exported into one <export>."}
    if tags := sorted({child.tag for child in root if isinstance(child.tag, str)} - _TAGS[version]):
        hint = " ".join(filter(None, (did_you_mean(tag, _TAGS["3"]) for tag in tags)))
        if version != "3":
            hint = 'Write <package format="3"> in the second line: these tags belong to a newer format than it names.'
        start = f'The manifest of package "{name}" (with format version {version})'
        return {f"{start} must not contain the following tags: {', '.join(tags)}": hint}
    return dict(_redundant(root)) or dict(_values(root, name))


def _text(root: ElementTree.Element, tag: str) -> str:
    return " ".join((root.findtext(tag) or "").split())


def _texts(root: ElementTree.Element, *tags: str) -> list[str]:
    return [(child.text or "").strip() for child in root if child.tag in tags]


def _redundant(root: ElementTree.Element) -> Iterator[tuple[str, str]]:
    generic = _texts(root, "depend")
    for name in generic:
        parts = ("build_depend", "build_export_depend", "exec_depend")
        if others := [tag for tag in parts if name in _texts(root, tag) or generic.count(name) > 1]:
            fault = f"The generic dependency on '{name}' is redundant with: {', '.join(others)}"
            yield fault, "<depend> says all of these at once: delete the others."


def _values(root: ElementTree.Element, name: str) -> Iterator[tuple[str, str]]:
    version, licences = _text(root, "version"), _texts(root, "license")
    address = '<maintainer email="you@example.org">Your Name</maintainer>.'
    if not re.match(r"[a-zA-Z0-9][a-zA-Z0-9_-]*$", name):
        hint = "A name has small letters, digits and '_', and begins with a letter."
        yield f'Package name "{name}" does not follow naming conventions', hint
    if not re.fullmatch(r"[0-9]+\.[0-9]+\.[0-9]+", version):
        wrong = f'"{version}" does not follow version conventions' if version else "must not be empty"
        yield f"Package version {wrong}", "A version is three numbers, such as <version>0.1.0</version>."
    if not _text(root, "description") and not root.findall("description/*"):
        yield "Package description must not be empty", ""
    if root.find("maintainer") is None:
        yield f"Package '{name}' must declare at least one maintainer", f"Add {address}"
    for person in [*root.findall("maintainer"), *root.findall("author")]:
        email = person.get("email")
        if email is not None and not _EMAIL.fullmatch(email):
            fault = f'Invalid email "{email}" for person "{(person.text or "").strip()}"'
            yield fault, "An address looks like you@example.org."
        elif email is None and person.tag == "maintainer":
            yield 'The "maintainer" tag must have the attribute "email"', f"Write {address}"
    if not licences:
        yield 'The package node must contain at least one "license" tag', "Add <license>Apache-2.0</license>."
    if not all(licences):
        yield "The license tag must neither be empty nor only contain whitespaces", ""
    for tag in _DEPENDS:
        if name in _texts(root, tag):
            kind = "build" if tag == "depend" else tag.removesuffix("_depend")
            fault = f'The package "{name}" must not "{kind}_depend" on a package with the same name as this package'
            yield fault, "Delete that line: a package does not depend on itself."
