"""Grading copies: what each earns is decided here, from the rows that its checks saw; and the reports of it.

Points, titles and what a check expects are those of this process, which has read them before any copy ran. Reports hold nothing
that a terminal or a browser would obey.
"""

from __future__ import annotations

import csv
import io
import re
import sys
import textwrap
from collections import Counter
from collections.abc import Iterator, Sequence
from contextlib import closing
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

from ..lab.checks.registry import all_checks
from ..lab.checks.results import GOOD
from .copies import Copy
from .pages import page_of
from .runner import Runner, Seen, run_all

LONGEST = 10_000
"""Characters of one text in a report."""

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


@dataclass
class CheckScore:
    """One check in one copy. Its texts and those of a `Graded` hold nothing that a terminal or a browser would obey."""

    name: str
    points: int
    state: str
    """"passed", "failed" or "not run"."""
    rows: list[dict[str, str]] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.rows = [{key: plain(value) for key, value in row.items()} for row in self.rows]

    @property
    def earned(self) -> int:
        """All of the points, or none."""
        return self.points if self.state == "passed" else 0

    @property
    def first_miss(self) -> str:
        """What was not as expected, first of all."""
        return next((f"{row['expected']}: {row['seen']}" for row in self.rows if row["mark"] != GOOD), "")


@dataclass
class Graded:
    """One copy."""

    path: Path
    page: str = ""
    scores: list[CheckScore] = field(default_factory=list)
    problem: str = ""
    """Why it could not be run, or not to its end."""
    errors: list[str] = field(default_factory=list)
    """Cells that raised something, and what the copy has replaced in the lesson, in words."""
    learner: str = ""
    """Who handed it in, where the folder says so."""

    def __post_init__(self) -> None:
        self.path, self.learner = Path(plain(str(self.path))), _in_line(plain(self.learner))
        self.problem, self.errors = plain(self.problem), [plain(each) for each in self.errors]

    @property
    def earned(self) -> int:
        """Points earned."""
        return sum(each.earned for each in self.scores)

    @property
    def points(self) -> int:
        """Points to be had."""
        return sum(each.points for each in self.scores)


def grade(copies: Sequence[Copy], timeout: float, memory: float, jobs: int, client: str | None = None) -> list[Graded]:
    """Grade copies, some at once, and say of each on the standard error that it is done. Answers in the copies' order.

    Args:
        timeout: computing time, s, that each may take.
        memory: GB that each process of a copy may take, where the system limits that.
        jobs: how many run at once on this machine.
        client: the address of a Dask scheduler, whose workers run the copies instead of this machine.
    """
    all_checks()
    graded: dict[int, Graded] = {}
    if client is None:
        running = run_all(copies, Runner(timeout, memory).run, jobs)
    else:
        from .cluster import run_on_cluster  # here, since Dask is optional, and takes long to import

        running = run_on_cluster(copies, timeout, memory, client)
    with closing(running) as ran:
        for number, seen in ran:
            graded[number] = judged(copies[number], seen)
            done = f"{len(graded)} of {len(copies)}: {in_a_line(graded[number])}"
            print(done, file=sys.stderr, flush=True)
    return [graded[number] for number in range(len(copies))]


def judged(copy: Copy, seen: Seen) -> Graded:
    """What a copy has earned, by what was seen of it."""
    problem, rows = seen.problem, seen.rows
    if any(name.startswith("teaching/") for name in seen.changed):
        problem, rows = "it cannot be graded by a grader that was changed meanwhile", {}
    page = page_of(copy.path, seen.metadata)
    errors = [*_remarks(copy.path, page, seen.replaced, seen.changed), *seen.errors]
    return Graded(copy.path, page, _scored(page, seen.asked, rows), problem, errors, copy.learner)


def _remarks(path: Path, page: str, replaced: list[str], changed: list[str]) -> Iterator[str]:
    """What a teacher should know of a copy: what it has replaced or claims, and which files were changed."""
    if replaced:
        yield f"from then on its checks earned nothing, because it replaced {', '.join(replaced)}"
    if changed:
        yield f"the installed lesson was changed before this copy was done: {', '.join(changed[:3])}"
    named = page_of(path)
    if named and page != named:
        yield f"its metadata say that it is {page}, and its name that it is {named}"


def _scored(page: str, asked: list[str], rows: dict[str, list[dict[str, str]]]) -> list[CheckScore]:
    """What was seen, held against the checks that there are."""
    known = {each.name: each for each in all_checks()}
    wanted = {name: each for name, each in known.items() if each.page == page}
    wanted |= {name: known[name] for name in asked if name in known}
    scores = []
    for check in wanted.values():
        seen, state = rows.get(check.name), "not run"
        if seen is not None:  # everything that the check expects has to be looked at, and to be as expected
            # What `trouble` expects depends on the case that was opened.
            expected = set() if check.name == "trouble" else {each.expected for each in check.expectations}
            passed = all(row["mark"] == GOOD for row in seen) and expected <= {row["expected"] for row in seen}
            state = "passed" if passed else "failed"
        scores.append(CheckScore(check.name, check.points, state, seen or []))
    return scores


# -- reports: a table to read, JSON, CSV and JUnit -------------------------------------------------------------------------

MARKS = {"passed": "✓", "failed": "✗", "not run": "–"}
WIDTH = 110


def in_words(graded: Sequence[Graded]) -> str:
    """A block for each copy: its learner, its path and its points, then a line for each check and for what went wrong."""
    learners = max(len(copy.learner) for copy in graded)
    names = [_named(copy, learners) for copy in graded]
    wide = max(map(len, names))
    lines: list[str] = []
    for copy, name in zip(graded, names, strict=True):
        lines += ["", f"{name.ljust(wide)}  {copy.earned:3} of {copy.points:3} points  {copy.page}".rstrip()]
        widest = max((len(score.name) for score in copy.scores), default=0)
        for score in copy.scores:
            why = "it was not run" if score.state == "not run" else score.first_miss
            points = f"{score.earned:2} of {score.points:2}  {why}".rstrip()
            lines.append(_short(f"  {MARKS[score.state]} {score.name.ljust(widest)}  {points}"))
        lines += [_short(f"  ! {each}") for each in filter(None, [copy.problem, *copy.errors])]
    done = sum(bool(copy.points) and copy.earned == copy.points for copy in graded)
    failed = sum(bool(copy.problem) for copy in graded)
    not_run = f", {failed} not run to the end" if failed else ""
    return "\n".join([*lines, "", f"{len(graded)} graded, {done} with all points{not_run}."]).lstrip("\n")


def in_a_line(copy: Graded) -> str:
    """A copy's learner, path and points, and why it was not run to its end."""
    why = f": {copy.problem}" if copy.problem else ""
    return f"{_named(copy)}  {copy.earned} of {copy.points} points{why}"


def _named(copy: Graded, wide: int = 0) -> str:
    """The learner, in a column of this width, and the copy's path."""
    path = _in_line(str(copy.path))
    return f"{copy.learner.ljust(wide)}  {path}" if wide or copy.learner else path


def _in_line(text: str) -> str:
    return " ".join(text.split())


def _short(line: str) -> str:
    indent = line[: len(line) - len(line.lstrip())]
    line = indent + line.replace("\n", " ").strip()
    return indent + textwrap.shorten(line.strip(), WIDTH - len(indent), placeholder=" …") if len(line) > WIDTH else line


def as_json(graded: Sequence[Graded]) -> dict[str, Any]:
    """Everything: `{"copies": [{"path", "learner", "page", "earned", "points", "problem", "errors", "checks": [{…}]}]}`."""
    copies = []
    for copy in graded:
        found = asdict(copy) | {"path": str(copy.path), "earned": copy.earned, "points": copy.points}
        found["checks"] = [asdict(each) | {"earned": each.earned} for each in copy.scores]
        del found["scores"]
        copies.append(found)
    return {"format": 1, "copies": copies}


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


def as_junit(graded: Sequence[Graded]) -> str:
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
        name=str(copy.path),
        tests=str(len(copy.scores) + bool(copy.problem)),
        failures=str(states["failed"]),
        skipped=str(states["not run"]),
        errors=str(int(bool(copy.problem))),
    )
    if copy.learner:
        properties = ElementTree.SubElement(suite, "properties")
        ElementTree.SubElement(properties, "property", name="learner", value=copy.learner)
    name = str(copy.path.with_suffix(""))
    for score in copy.scores:
        case = ElementTree.SubElement(suite, "testcase", classname=name, name=score.name)
        if score.state == "not run":
            ElementTree.SubElement(case, "skipped", message="it was not run")
        elif score.state == "failed":
            failure = ElementTree.SubElement(case, "failure", message=score.first_miss)
            failure.text = "\n".join(f"{row['mark']} {row['expected']}: {row['seen']}" for row in score.rows)
    if copy.problem:
        case = ElementTree.SubElement(suite, "testcase", classname=name, name="the notebook runs")
        ElementTree.SubElement(case, "error", message=copy.problem)
    if copy.errors:
        ElementTree.SubElement(suite, "system-out").text = "\n".join(copy.errors)
    return suite
