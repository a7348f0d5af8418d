"""What grading has found: as a table to read, as JSON, and as CSV; without what a terminal or a browser would obey."""

from __future__ import annotations

import csv
import io
import re
import textwrap
from collections import Counter
from collections.abc import Sequence
from typing import Any
from xml.etree import ElementTree

from .grade import CheckScore, Graded

MARKS = {"passed": "✓", "failed": "✗", "not run": "–"}
WIDTH = 110

LONGEST = 10_000
"""Characters of one text."""

_ESCAPES = re.compile(
    r"\x1b(?:\[[0-?]*[ -/]*[@-~]|[\]PX^_][^\x07\x1b]*(?:\x07|\x1b\\)?|[ -/]*[0-~])|\x9b[0-?]*[ -/]*[@-~]"
)
_CONTROLS = re.compile(
    "[\x00-\x08\x0b-\x1f\x7f-\x9f\u061c\u200e\u200f\u202a-\u202e\u2066-\u2069\ud800-\udfff\ufffe\uffff]"
)
_TAG = re.compile(r"<(?=[A-Za-z/!?])")


def plain(text: str) -> str:
    """The text without escape sequences, control characters and marks that turn the direction of writing; no HTML is left."""
    return _TAG.sub("‹", _CONTROLS.sub("", _ESCAPES.sub("", text)))[:LONGEST]


def in_words(graded: Sequence[Graded]) -> str:
    """A block for each copy: its learner, its path and its points, then a line for each check and for what went wrong."""
    learners = max(len(_in_line(copy.learner)) for copy in graded)
    names = [_named(copy, learners) for copy in graded]
    wide = max(map(len, names))
    lines: list[str] = []
    for copy, name in zip(graded, names, strict=True):
        lines += ["", f"{name.ljust(wide)}  {copy.earned:3} of {copy.points:3} points  {copy.page}".rstrip()]
        widest = max((len(score.name) for score in copy.scores), default=0)
        lines += [_short(f"  {MARKS[score.state]} {score.name.ljust(widest)}  {_of(score)}") for score in copy.scores]
        lines += [_short(f"  ! {plain(each)}") for each in filter(None, [copy.problem, *copy.errors])]
    return "\n".join([*lines, "", _sum(graded)]).lstrip("\n")


def in_a_line(copy: Graded) -> str:
    """A copy's learner, path and points, and why it was not run to its end."""
    why = f": {plain(copy.problem)}" if copy.problem else ""
    return f"{_named(copy)}  {copy.earned} of {copy.points} points{why}"


def _named(copy: Graded, wide: int = 0) -> str:
    """The learner, in a column of this width, and the copy's path."""
    path = _in_line(str(copy.path))
    return f"{_in_line(copy.learner).ljust(wide)}  {path}" if wide or copy.learner else path


def _in_line(text: str) -> str:
    return " ".join(plain(text).split())


def _of(score: CheckScore) -> str:
    why = "it was not run" if score.state == "not run" else plain(score.first_miss)
    return f"{score.earned:2} of {score.points:2}  {why}".rstrip()


def _short(line: str) -> str:
    indent = line[: len(line) - len(line.lstrip())]
    line = indent + " ".join(line.split("\n")).strip()
    return indent + textwrap.shorten(line.strip(), WIDTH - len(indent), placeholder=" …") if len(line) > WIDTH else line


def _sum(graded: Sequence[Graded]) -> str:
    done = sum(bool(copy.points) and copy.earned == copy.points for copy in graded)
    failed = sum(bool(copy.problem) for copy in graded)
    words = [f"{len(graded)} graded", f"{done} with all points"]
    return ", ".join(words + ([f"{failed} not run to the end"] if failed else [])) + "."


def as_json(graded: Sequence[Graded]) -> dict[str, Any]:
    """Everything: `{"copies": [{"path", "learner", "page", "earned", "points", "problem", "errors", "checks": [{…}]}]}`."""
    return {"format": 1, "copies": [_copy(each) for each in graded]}


def _copy(copy: Graded) -> dict[str, Any]:
    return {
        "path": plain(str(copy.path)),
        "learner": _in_line(copy.learner),
        "page": copy.page,
        "earned": copy.earned,
        "points": copy.points,
        "problem": plain(copy.problem),
        "errors": [plain(each) for each in copy.errors],
        "checks": [
            {
                "name": each.name,
                "state": each.state,
                "earned": each.earned,
                "points": each.points,
                "rows": [{key: plain(value) for key, value in row.items()} for row in each.rows],
            }
            for each in copy.scores
        ],
    }


def as_csv(graded: Sequence[Graded]) -> str:
    """A line for each copy: path, learner, page, points and what went wrong, then a column for each check with its points."""
    checks = list(dict.fromkeys(score.name for copy in graded for score in copy.scores))
    text = io.StringIO()
    table = csv.writer(text, lineterminator="\n")
    table.writerow(["path", "learner", "page", "earned", "points", "remarks", *checks])
    for copy in graded:
        earned = {score.name: "" if score.state == "not run" else score.earned for score in copy.scores}
        remarks = "; ".join(filter(None, [copy.problem, *copy.errors]))
        points = [earned.get(name, "") for name in checks]
        who = [_cell(str(copy.path)), _cell(copy.learner)]
        table.writerow([*who, copy.page, copy.earned, copy.points, _cell(remarks), *points])
    return text.getvalue()


def _cell(text: str) -> str:
    """A text that a spreadsheet does not take for a formula."""
    words = _in_line(text)
    return f"'{words}" if words.startswith(("=", "+", "-", "@")) else words


def report(graded: Sequence[Graded]) -> str:
    """A JUnit report, as XML: a suite for each copy, a case for each check."""
    root = ElementTree.Element("testsuites", name="turtle-lesson")
    for copy in graded:
        root.append(_suite(copy))
    ElementTree.indent(root)
    return '<?xml version="1.0" encoding="utf-8"?>\n' + ElementTree.tostring(root, encoding="unicode") + "\n"


def _suite(copy: Graded) -> ElementTree.Element:
    states = Counter(each.state for each in copy.scores)
    suite = ElementTree.Element(
        "testsuite",
        name=plain(str(copy.path)),
        tests=str(len(copy.scores) + bool(copy.problem)),
        failures=str(states["failed"]),
        skipped=str(states["not run"]),
        errors=str(int(bool(copy.problem))),
    )
    if copy.learner:
        properties = ElementTree.SubElement(suite, "properties")
        ElementTree.SubElement(properties, "property", name="learner", value=_in_line(copy.learner))
    name = plain(str(copy.path.with_suffix("")))
    for score in copy.scores:
        case = ElementTree.SubElement(suite, "testcase", classname=name, name=score.name)
        if score.state == "not run":
            ElementTree.SubElement(case, "skipped", message="it was not run")
        elif score.state == "failed":
            failure = ElementTree.SubElement(case, "failure", message=plain(score.first_miss))
            failure.text = plain("\n".join(f"{row['mark']} {row['expected']}: {row['seen']}" for row in score.rows))
    if copy.problem:
        case = ElementTree.SubElement(suite, "testcase", classname=name, name="the notebook runs")
        ElementTree.SubElement(case, "error", message=plain(copy.problem))
    if copy.errors:
        ElementTree.SubElement(suite, "system-out").text = plain("\n".join(copy.errors))
    return suite
