"""What grading has found as a JUnit report: a suite for each copy, a case for each check."""

from __future__ import annotations

import re
from collections.abc import Sequence
from xml.etree import ElementTree

from .grade import CheckScore, Graded

_FORBIDDEN = re.compile(r"[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
"""Characters that XML cannot hold."""


def report(graded: Sequence[Graded]) -> str:
    """The report, as XML."""
    root = ElementTree.Element("testsuites", name="turtle-lesson")
    for copy in graded:
        root.append(_suite(copy))
    ElementTree.indent(root)
    return '<?xml version="1.0" encoding="utf-8"?>\n' + ElementTree.tostring(root, encoding="unicode") + "\n"


def _suite(copy: Graded) -> ElementTree.Element:
    counts: dict[str, int] = {
        "tests": len(copy.scores) + bool(copy.problem),
        "failures": sum(each.state == "failed" for each in copy.scores),
        "skipped": sum(each.state == "not run" for each in copy.scores),
        "errors": int(bool(copy.problem)),
    }
    attributes = {"name": _text(str(copy.path)), **{key: str(count) for key, count in counts.items()}}
    suite = ElementTree.Element("testsuite", attributes)
    for score in copy.scores:
        suite.append(_case(copy, score))
    if copy.problem:
        case = ElementTree.SubElement(suite, "testcase", classname=_text(copy.path.stem), name="the notebook runs")
        ElementTree.SubElement(case, "error", message=_text(copy.problem))
    return suite


def _case(copy: Graded, score: CheckScore) -> ElementTree.Element:
    case = ElementTree.Element("testcase", classname=_text(copy.path.stem), name=score.name)
    if score.state == "not run":
        ElementTree.SubElement(case, "skipped", message="it was not run")
    elif score.state == "failed":
        failure = ElementTree.SubElement(case, "failure", message=_text(score.first_miss))
        failure.text = _text("\n".join(f"{row['mark']} {row['expected']}: {row['seen']}" for row in score.rows))
    return case


def _text(text: str) -> str:
    return _FORBIDDEN.sub("?", text)
