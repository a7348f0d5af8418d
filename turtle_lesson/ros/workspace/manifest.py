"""What a `package.xml` says (format 1 to 3; facts: REP 149, https://ros.org/reps/rep-0149.html)."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from pathlib import Path
from xml.etree import ElementTree

from .errors import PackageError, did_you_mean

BUILD_TYPES = ("ament_cmake", "ament_python", "cmake")
_NAME = re.compile(r"[a-z][a-z0-9_-]*")


@dataclass
class Manifest:
    """The parts of a `package.xml` that a build needs."""

    name: str
    version: str = "0.0.0"
    description: str = ""
    build_type: str = ""
    dependencies: dict[str, list[str]] = field(default_factory=dict)
    groups: list[str] = field(default_factory=list)
    file: Path = Path("package.xml")

    def all_dependencies(self) -> list[str]:
        """Every package that is named in any kind of dependency, once."""
        return list(dict.fromkeys(name for names in self.dependencies.values() for name in names))


def read_manifest(file: Path) -> Manifest:
    """Read a `package.xml`.

    Raises:
        PackageError: if it is missing, is no XML, or lacks what every package needs.
    """
    root = _root(file)
    name = _text(root, "name")
    if not name:
        raise PackageError("it has no <name>; write <name>…</name>, the same as in project(…)", file)
    if not _NAME.fullmatch(name):
        rule = "small letters, digits and '_', beginning with a letter"
        reason = f"the package name '{name}' is not allowed: {rule}"
        raise PackageError(reason, file)
    return Manifest(
        name=name,
        version=_text(root, "version"),
        description=_text(root, "description"),
        build_type=_build_type(root, file),
        dependencies=_dependencies(root),
        groups=[(element.text or "").strip() for element in root.findall("member_of_group")],
        file=file,
    )


def _root(file: Path) -> ElementTree.Element:
    if not file.is_file():
        reason = "it is missing: a folder is a ROS 2 package if it holds a package.xml"
        raise PackageError(reason, file, hint="ros2 pkg create <name> --build-type ament_cmake makes one.")
    try:
        root = ElementTree.fromstring(file.read_bytes())
    except ElementTree.ParseError as error:
        line = error.position[0]
        hint = "Is every <tag> closed by a </tag>?"
        raise PackageError(f"this is not well-formed XML ({error})", file, line, hint) from None
    if root.tag != "package":
        raise PackageError(f'the outermost tag is <{root.tag}>; it must be <package format="3">', file)
    return root


def _text(root: ElementTree.Element, tag: str) -> str:
    return " ".join((root.findtext(tag) or "").split())


def _build_type(root: ElementTree.Element, file: Path) -> str:
    build_type = _text(root, "export/build_type")
    if not build_type:
        raise PackageError(
            "it does not say how to build the package",
            file,
            hint="Add <export><build_type>ament_cmake</build_type></export>.",
        )
    if build_type not in BUILD_TYPES:
        hint = did_you_mean(build_type, BUILD_TYPES) or f"Known are {', '.join(BUILD_TYPES)}."
        raise PackageError(f"the build_type '{build_type}' is unknown", file, hint=hint)
    return build_type


def _dependencies(root: ElementTree.Element) -> dict[str, list[str]]:
    found: dict[str, list[str]] = {}
    for element in root:
        if element.tag == "depend" or element.tag.endswith("_depend"):
            found.setdefault(element.tag, []).append((element.text or "").strip())
    return found
