"""All checks, by name, and how one is carried out: each expectation is looked at, whatever the others come to."""

from __future__ import annotations

import importlib
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import wraps
from inspect import signature
from typing import TYPE_CHECKING, Concatenate, ParamSpec

from ...learner.story import PAGES
from ...ros.sim.errors import learners_frames
from ..words import suggestion
from .probe import Probe
from .results import NO_ERROR, Advice, CannotLook, CheckResult, Row, Seen, Stopped, in_words, row_of

if TYPE_CHECKING:
    from ...session.check_target import CheckTarget

MODULES = (
    "pages_00_02",
    "pages_03",
    "page_04",
    "page_05",
    "pages_06_07",
    "pages_08_09",
    "page_10",
    "page_11",
    "page_12",
)
"""The modules beside this one that define checks; they are imported when a check is first asked for."""

P = ParamSpec("P")


@dataclass(frozen=True)
class Expectation:
    """One thing that should be so: in words, and how to look. `look` may raise CannotLook, or anything else."""

    expected: str
    look: Callable[[Probe], Seen]


def expectation(text: str) -> Callable[[Callable[Concatenate[Probe, P], Seen]], Callable[P, Expectation]]:
    """Decorator: a function that looks, with a probe and other arguments, then takes the others and returns an expectation.

    `text` says in words what is expected; it is a format string, which may name the arguments.
    """

    def decorate(look: Callable[Concatenate[Probe, P], Seen]) -> Callable[P, Expectation]:
        names = signature(look)

        @wraps(look)
        def make(*given: P.args, **options: P.kwargs) -> Expectation:
            bound = names.bind(None, *given, **options)
            bound.apply_defaults()
            return Expectation(text.format(**bound.arguments), lambda probe: look(probe, *given, **options))

        return make

    return decorate


@dataclass(frozen=True)
class Check:
    """A named list of expectations, worth some points, that may take so much robot time (s)."""

    name: str
    title: str
    page: str
    points: int
    limit: float
    make: Maker
    learnt: str = ""
    """What the exercise teaches, in a sentence that is shown when it is passed."""

    @property
    def expectations(self) -> tuple[Expectation, ...]:
        """What it expects, made anew."""
        return tuple(self.make())


Maker = Callable[[], Iterable[Expectation]]
_checks: dict[str, Check] = {}


def check(page: str, *, points: int, limit: float, learnt: str = "") -> Callable[[Maker], Check]:
    """Decorator that makes a check of a function which returns its expectations; its docstring is the title.

    The function's name is what `lesson.check` is given, and `page` is one of `PAGES`. What is not looked at within `limit` s of
    robot time is marked with –.
    """

    def register(function: Maker) -> Check:
        title = (function.__doc__ or "").strip().splitlines()[0]
        name = function.__name__
        made = _checks[name] = Check(name, title, page, points, limit, function, learnt)
        return made

    return register


def all_checks() -> list[Check]:
    """All checks: by page, and on a page in the order in which its module has them."""
    for module in MODULES:
        importlib.import_module(f"{__package__}.{module}")
    return sorted(_checks.values(), key=lambda each: PAGES.index(each.page))


def find(name: object) -> Check:
    """The check of a name. Raises ValueError, which says which one may be meant."""
    known = {each.name: each for each in all_checks()}
    if str(name) not in known:
        raise ValueError(f"there is no check {name!r}. {suggestion(str(name), known)}")
    return known[str(name)]


ODD = "Run the cells from the set-up cell on again; if it stays, compare your interfaces and types with the page's."


def run(check: Check, target: CheckTarget) -> CheckResult:
    """Look at everything that a check expects of the system at `target`."""
    began = target.now
    if target.ended:
        step = "Use the lesson that start() returned last, or run the set-up cell again."
        rows = [Seen(False, "it was closed by a later start()", Advice(step, step)).row("a world to look at")]
        rows += [Row.unseen(each.expected, "the world has ended") for each in check.expectations]
    else:
        with Probe(target, check.limit) as probe:
            rows = _with_errors([_look(each, probe) for each in check.expectations], probe)
    seconds = round(target.now - began, 3)
    return CheckResult(check.name, check.title, check.page, check.points, tuple(rows), seconds, check.learnt)


def _look(expectation: Expectation, probe: Probe) -> Row:
    try:
        return expectation.look(probe).row(expectation.expected)
    except Stopped:
        return Row.unseen(expectation.expected, "your code was stopped")
    except CannotLook as reason:
        return Row.unseen(expectation.expected, str(reason))
    except Exception as error:  # whatever a learner's classes may do
        if learners_frames(error.__traceback__):
            return row_of(error, expectation.expected)
        return Seen(False, f"looking at it raised {in_words(error)}", ODD).row(expectation.expected)


def _with_errors(rows: list[Row], probe: Probe) -> list[Row]:
    """The rows with the learner's own error first, since it explains the others; nothing is added to a good result."""
    if probe.stopped:
        first = Row.stopped("every callback returns", probe.stopped)
        return [first, *(row for row in rows if row.mark != first.mark)]
    error = next(iter(probe.errors()), None)
    if error is None or all(row.good for row in rows):
        return sorted(rows, key=lambda row: not row.trace)
    first = row_of(error, NO_ERROR)
    return [first, *(row for row in rows if row.expected != NO_ERROR and row.trace != first.trace)]
