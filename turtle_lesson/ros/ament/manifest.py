"""What a package says about itself: its `package.xml`, `setup.py` and `setup.cfg`, and what a real build refuses in them.

Facts: REP 149 (https://ros.org/reps/rep-0149.html; format 1 to 3) and catkin_pkg 0.5, which every real build asks, and whose
sentences are compared with ours in a test. A `setup.py` is read by running it in a process of its own (see `setup_runner`), as
colcon does.
"""

from __future__ import annotations

import configparser
import json
import re
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

from ..idl.names import did_you_mean
from ..sim.errors import shown_path
from .errors import PackageError

BUILD_TYPES = ("ament_cmake", "ament_python", "cmake")
_NAME = re.compile(r"[a-z][a-z0-9_-]*")

_DEPENDS = ("depend", "build_depend", "build_export_depend", "buildtool_depend", "buildtool_export_depend",
            "exec_depend", "test_depend", "doc_depend", "group_depend")  # fmt: skip
_IN_ALL = {
    "name", "version", "description", "maintainer", "license", "url", "author", "conflict", "replace", "export",
    "build_depend", "buildtool_depend", "test_depend",
}  # fmt: skip
_SINCE_2 = {"depend", "build_export_depend", "buildtool_export_depend", "exec_depend", "doc_depend"}
_SINCE_3 = {"group_depend", "member_of_group"}
_TAGS = {"1": _IN_ALL | {"run_depend"}, "2": _IN_ALL | _SINCE_2, "3": _IN_ALL | _SINCE_2 | _SINCE_3}
_VERSIONS = {"version_lt", "version_lte", "version_eq", "version_gte", "version_gt"}
_ATTRIBUTES = {
    "maintainer": {"email"},
    "author": {"email"},
    "url": {"type"},
    "group_depend": set(),
    "member_of_group": set(),
}
_EMAIL = re.compile(r"[-a-zA-Z0-9_%+]+(\.[-a-zA-Z0-9_%+]+)*@[-a-zA-Z0-9%]+(\.[-a-zA-Z0-9%]+)*\.[a-zA-Z]{2,}")
_RUNNER = Path(__file__).with_name("setup_runner.py")
LONGEST = 10.0
"""What a setup.py may take, in s of real time."""


@dataclass
class Manifest:
    """The parts of a `package.xml` by which a package is used as it lies there."""

    name: str
    build_type: str
    groups: list[str]
    file: Path


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
        build_type=_build_type(root, file),
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


def faults_in(root: ElementTree.Element) -> list[str]:
    """Everything that is refused, in catkin_pkg's words; the first alone where it would stop at it."""
    if root.tag != "package":
        return ['The manifest must contain a single "package" root tag']
    if root.get("format", "1") not in _TAGS:
        return [f"Unable to handle package.xml format version '{root.get('format')}', please update catkin_pkg"]
    for tag in ("name", "version", "description"):
        if len(root.findall(tag)) != 1:
            return [f'The manifest must contain exactly one "{tag}" tag']
    name = _text(root, "name")
    if len(root.findall("export")) > 1:
        return ['The manifest must not contain more than one "export" tags']
    return _unknown(root, name) or _redundant(root) + _odd(root) or _values(root, name)


def hint_for(fault: str) -> str:
    """What to try about a fault, or nothing."""
    if re.search(r"format version [12]\)", fault):
        return 'Write <package format="3"> in the second line: these tags belong to a newer format than the one that it names.'
    for part, advice in _HINTS.items():
        if part in fault:
            return advice
    if match := re.search(r"following tags: (.*)", fault):
        return " ".join(filter(None, (did_you_mean(tag, _TAGS["3"]) for tag in match[1].split(", "))))
    return ""


def _names(root: ElementTree.Element, *tags: str) -> list[str]:
    return [(element.text or "").strip() for tag in tags for element in root.findall(tag)]


def _values(root: ElementTree.Element, name: str) -> list[str]:
    found = []
    version = _text(root, "version")
    if not re.match(r"[a-zA-Z0-9][a-zA-Z0-9_-]*$", name):
        found.append(f'Package name "{name}" does not follow naming conventions')
    if not version:
        found.append("Package version must not be empty")
    elif not re.fullmatch(r"[0-9]+\.[0-9]+\.[0-9]+", version):
        found.append(f'Package version "{version}" does not follow version conventions')
    description = root.find("description")
    if not _text(root, "description") and (description is None or len(description) == 0):
        found.append("Package description must not be empty")
    found += _people(root, name)
    licences = _names(root, "license")
    if not licences:
        found.append('The package node must contain at least one "license" tag')
    if not all(licences):
        found.append("The license tag must neither be empty nor only contain whitespaces")
    return found + _own_name(root, name)


def _people(root: ElementTree.Element, name: str) -> list[str]:
    maintainers = root.findall("maintainer")
    if not maintainers:
        return [f"Package '{name}' must declare at least one maintainer"]
    found = []
    for person in maintainers:
        email = person.get("email")
        if email is None:
            found.append('The "maintainer" tag must have the attribute "email"')
        elif not _EMAIL.fullmatch(email):
            found.append(_no_address(person))
    authors = [each for each in root.findall("author") if each.get("email") is not None]
    return found + [_no_address(each) for each in authors if not _EMAIL.fullmatch(each.get("email", ""))]


def _no_address(person: ElementTree.Element) -> str:
    return f'Invalid email "{person.get("email")}" for person "{(person.text or "").strip()}"'


def _own_name(root: ElementTree.Element, name: str) -> list[str]:
    tags = [tag for tag in _DEPENDS if tag != "group_depend" and name in _names(root, tag)]
    kinds = ["build" if tag == "depend" else tag.removesuffix("_depend") for tag in tags]
    same = "on a package with the same name as this package"
    return [f'The package "{name}" must not "{kind}_depend" {same}' for kind in kinds]


def _redundant(root: ElementTree.Element) -> list[str]:
    found = []
    generic = _names(root, "depend")
    parts = ("build_depend", "build_export_depend", "exec_depend")
    for name in dict.fromkeys(generic):
        others = [tag for tag in parts if name in _names(root, tag) or generic.count(name) > 1]
        if others:
            found.append(f"The generic dependency on '{name}' is redundant with: {', '.join(others)}")
    return found


def _unknown(root: ElementTree.Element, name: str) -> list[str]:
    version = root.get("format", "1")
    tags = sorted({child.tag for child in root if isinstance(child.tag, str)} - _TAGS[version])
    if not tags:
        return []
    start = f'The manifest of package "{name}" (with format version {version})'
    return [f"{start} must not contain the following tags: {', '.join(tags)}"]


def _odd(root: ElementTree.Element) -> list[str]:
    """Attributes and inner tags where there must not be any."""
    newest = root.get("format") == "3"
    found = []
    for child in root:
        allowed = set(_ATTRIBUTES.get(child.tag, set()))
        if child.tag in {*_DEPENDS, "run_depend", "conflict", "replace"} - _SINCE_3:
            allowed |= _VERSIONS
        if newest:
            allowed |= {"version": {"compatibility"}, "license": {"file"}}.get(child.tag, set())
            allowed |= {"condition"} if child.tag in {*_DEPENDS, "conflict", "replace", *_SINCE_3} else set()
        if odd := [each for each in child.attrib if each not in allowed]:
            found.append(f'The "{child.tag}" tag must not have the following attributes: {", ".join(odd)}')
        if len(child) and child.tag not in {"description", "export"}:
            inner = ", ".join(str(each.tag) for each in child if isinstance(each.tag, str))
            found.append(f'The "{child.tag}" tag must not contain the following children: {inner}')
    return found


_HINTS = {
    "format version '": 'Write <package format="3">.',
    'more than one "export"': "Put everything that is exported into one <export>.",
    "following attributes": "Remove them; only the text between the tags counts.",
    "following children": "Close the tag before the next one begins.",
    'exactly one "': "Write that tag once, directly inside <package>.",
    "naming conventions": "A name has small letters, digits and '_', and begins with a letter.",
    "version conventions": "A version is three numbers, such as <version>0.1.0</version>.",
    "at least one maintainer": 'Add <maintainer email="you@example.org">Your Name</maintainer>.',
    'attribute "email"': 'Write <maintainer email="you@example.org">Your Name</maintainer>.',
    "Invalid email": "An address looks like you@example.org.",
    'one "license" tag': "Add <license>Apache-2.0</license>.",
    "redundant with": "<depend> says all of these at once: delete the others.",
    "same name as this package": "Delete that line: a package does not depend on itself.",
}


class SetupError(Exception):
    """A setup.py that fails; the text is Python's, shortened to the file's own lines."""


def read_setup(folder: Path) -> dict[str, Any]:
    """What the package's `setup.py` gives to `setup(…)`.

    Raises:
        SetupError: it fails, does not end, or never calls `setup`.
    """
    with tempfile.TemporaryDirectory() as scratch:
        answer = Path(scratch) / "answer.json"
        command = [sys.executable, "-I", "-X", "utf8", str(_RUNNER), str(folder.resolve()), str(answer)]
        try:
            done = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, timeout=LONGEST, check=False)
        except subprocess.TimeoutExpired:
            text = f"setup.py did not end within {LONGEST:g} s: is there a loop in it, or a wait?\n"
            raise SetupError(text) from None
        result = json.loads(answer.read_text(encoding="utf-8")) if answer.is_file() else {}
    if "error" in result:
        raise SetupError(result["error"])
    if "setup" not in result:
        ended = f" and ended Python with exit code {done.returncode}" if done.returncode else ""
        raise SetupError(f"{shown_path(str(folder / 'setup.py'))} never calls setup(…){ended}\n")
    setup: dict[str, Any] = result["setup"]
    return setup


def install_scripts(folder: Path) -> str | None:
    """Where `setup.cfg` puts programs, such as `lib/demo`; None if it does not say."""
    config = configparser.ConfigParser(interpolation=None)
    try:
        config.read(folder / "setup.cfg", encoding="utf-8")
    except (configparser.Error, UnicodeDecodeError) as error:
        raise SetupError(f"setup.cfg: {error}\n") from None
    for option in ("install_scripts", "install-scripts"):
        if config.has_option("install", option):
            return config.get("install", option).strip().removeprefix("$base").strip("/")
    return None
