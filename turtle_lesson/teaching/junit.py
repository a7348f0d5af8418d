"""What grading has found as a JUnit report: a suite for each copy, a case for each check."""

from __future__ import annotations

from collections.abc import Sequence
from xml.etree import ElementTree

from .grade import CheckScore, Graded
from .report import plain


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
    attributes = {"name": plain(str(copy.path)), **{key: str(count) for key, count in counts.items()}}
    suite = ElementTree.Element("testsuite", attributes)
    for score in copy.scores:
        suite.append(_case(copy, score))
    if copy.problem:
        case = ElementTree.SubElement(
            suite, "testcase", classname=plain(str(copy.path.with_suffix(""))), name="the notebook runs"
        )
        ElementTree.SubElement(case, "error", message=plain(copy.problem))
    if copy.errors:
        ElementTree.SubElement(suite, "system-out").text = plain("\n".join(copy.errors))
    return suite


def _case(copy: Graded, score: CheckScore) -> ElementTree.Element:
    case = ElementTree.Element("testcase", classname=plain(str(copy.path.with_suffix(""))), name=score.name)
    if score.state == "not run":
        ElementTree.SubElement(case, "skipped", message="it was not run")
    elif score.state == "failed":
        failure = ElementTree.SubElement(case, "failure", message=plain(score.first_miss))
        failure.text = plain("\n".join(f"{row['mark']} {row['expected']}: {row['seen']}" for row in score.rows))
    return case
