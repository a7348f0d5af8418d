"""Grading copies: what each earns is decided here, from the rows that its checks saw, wherever it was run.

Points, titles and what a check expects are those of this process, which has read them before any copy ran.
"""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterator, Sequence
from contextlib import closing
from dataclasses import dataclass, field
from pathlib import Path

from ..lab.checks.registry import Check, all_checks, checks_of
from ..lab.checks.results import GOOD
from .copies import Copy
from .limits import MEMORY
from .pages import page_of
from .runner import HOME, Seen, run_here

OWN_CASE = "trouble"
"""The check whose expectations depend on the case that was opened."""


@dataclass
class CheckScore:
    """One check in one copy."""

    name: str
    points: int
    state: str
    """"passed", "failed" or "not run"."""
    rows: list[dict[str, str]] = field(default_factory=list)

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

    @property
    def earned(self) -> int:
        """Points earned."""
        return sum(each.earned for each in self.scores)

    @property
    def points(self) -> int:
        """Points to be had."""
        return sum(each.points for each in self.scores)


Told = Callable[[int, int, Graded], object]


def grade(
    copies: Sequence[Copy],
    timeout: float,
    jobs: int = 1,
    told: Told | None = None,
    memory: float = MEMORY,
    client: str | None = None,
) -> list[Graded]:
    """Grade copies, some at once; the answers are in the order of the copies. `told` hears of each that is done.

    Args:
        copies: as they were handed in.
        timeout: computing time, s, that each may take.
        jobs: how many run at once on this machine.
        told: is given how many are done, how many there are, and the one that was done last.
        memory: GB that each process of a copy may take, where the system limits that.
        client: the address of a Dask scheduler, whose workers run the copies instead of this machine.
    """
    all_checks()
    graded: dict[int, Graded] = {}
    with closing(_run(copies, timeout, memory, jobs, client)) as ran:
        for number, seen in ran:
            graded[number] = judged(copies[number], seen)
            if told is not None:
                told(len(graded), len(copies), graded[number])
    return [graded[number] for number in range(len(copies))]


def _run(
    copies: Sequence[Copy], timeout: float, memory: float, jobs: int, client: str | None
) -> Generator[tuple[int, Seen]]:
    if client is None:
        yield from run_here(copies, timeout, memory, jobs)
    else:
        from .cluster import run_on_cluster  # here, since Dask is optional, and takes long to import

        yield from run_on_cluster(copies, timeout, memory, client)


def judged(copy: Copy, seen: Seen) -> Graded:
    """What a copy has earned, by what was seen of it."""
    problem, rows = seen.problem, seen.rows
    if any(name.startswith("teaching/") for name in seen.changed):
        problem, rows = "it cannot be graded by a grader that was changed meanwhile", {}
    page = page_of(copy.path, seen.metadata)
    errors = [*_remarks(copy.path, page, seen.replaced, seen.changed), *seen.errors]
    return Graded(copy.path, page, _scored(page, seen.asked, rows), problem, errors, copy.learner)


def _remarks(path: Path, page: str, replaced: list[str], changed: list[str]) -> Iterator[str]:
    """What a teacher should know of a copy: what it has replaced, brings along, or claims, and which files were changed."""
    if replaced:
        yield f"from then on its checks earned nothing, because it replaced {', '.join(replaced)}"
    if changed:
        yield f"the installed lesson was changed before this copy was done: {', '.join(changed[:3])}"
    for name in ("turtle_lesson", "rclpy"):
        beside = path.with_name(name)
        if beside.resolve() != HOME and (beside.exists() or beside.with_suffix(".py").exists()):
            yield f"a package {name} lies beside it; the installed one was used"
    named = page_of(path)
    if named and page != named:
        yield f"its metadata say that it is {page}, and its name that it is {named}"


def _scored(page: str, asked: list[str], rows: dict[str, list[dict[str, str]]]) -> list[CheckScore]:
    """What was seen, held against the checks that there are."""
    known = {each.name: each for each in all_checks()}
    wanted = {each.name: each for each in checks_of(page)} if page else {}
    wanted |= {name: known[name] for name in asked if name in known}
    return [_score(each, rows.get(each.name)) for each in wanted.values()]


def _score(check: Check, rows: list[dict[str, str]] | None) -> CheckScore:
    """The verdict: everything that the check expects was looked at, and all that was seen is as expected."""
    if rows is None:
        return CheckScore(check.name, check.points, "not run")
    wanted = set() if check.name == OWN_CASE else {each.expected for each in check.expectations}
    passed = all(row["mark"] == GOOD for row in rows) and wanted <= {row["expected"] for row in rows}
    return CheckScore(check.name, check.points, "passed" if passed else "failed", rows)
