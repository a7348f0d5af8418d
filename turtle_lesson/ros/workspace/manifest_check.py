"""What `catkin_pkg`, which every real build asks, refuses in a `package.xml`: its words, and what to try.

Facts: REP 149 (https://ros.org/reps/rep-0149.html) and catkin_pkg 0.5, whose sentences are compared with ours in a test.
"""

from __future__ import annotations

import re
from xml.etree import ElementTree

from .errors import did_you_mean

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


def faults(root: ElementTree.Element) -> list[str]:
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


def hint(fault: str) -> str:
    """What to try about a fault, or nothing."""
    if re.search(r"format version [12]\)", fault):
        return 'Write <package format="3"> in the second line: these tags belong to a newer format than the one that it names.'
    for part, advice in _HINTS.items():
        if part in fault:
            return advice
    if match := re.search(r"following tags: (.*)", fault):
        return " ".join(filter(None, (did_you_mean(tag, _TAGS["3"]) for tag in match[1].split(", "))))
    return ""


def _text(root: ElementTree.Element, tag: str) -> str:
    return " ".join((root.findtext(tag) or "").split())


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
