"""All checks, by name."""

from __future__ import annotations

import importlib
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from ...learner.story import PAGES
from ..words import did_you_mean, enumerated
from .results import Seen

if TYPE_CHECKING:
    from .probe import Probe

MODULES = tuple(f"page_{page.partition('_')[0]}" for page in PAGES)
"""The modules beside this one that define checks, one a page; they are imported when a check is first asked for."""


@dataclass(frozen=True)
class Expectation:
    """One thing that should be so: in words, and how to look. `look` may raise CannotLook, or anything else."""

    expected: str
    look: Callable[[Probe], Seen]


def expectation(expected: str) -> Callable[[Callable[[Probe], Seen]], Expectation]:
    """Decorator that makes an expectation of a function that looks; `expected` says it in words."""
    return lambda look: Expectation(expected, look)


@dataclass(frozen=True)
class Check:
    """A named list of expectations, worth some points, that may take so much robot time (s)."""

    name: str
    title: str
    page: str
    points: int
    limit: float
    make: Callable[[], Iterable[Expectation]]
    learnt: str = ""
    """What the exercise teaches, in a sentence that is shown when it is passed."""

    @property
    def expectations(self) -> tuple[Expectation, ...]:
        """What it expects, made anew."""
        return tuple(self.make())


_checks: dict[str, Check] = {}
Maker = Callable[[], Iterable[Expectation]]


def check(name: str, *, points: int, limit: float, learnt: str = "", page: str = "") -> Callable[[Maker], Check]:
    """Decorator that makes a check of a function which returns its expectations; its docstring is the title.

    Args:
        name: what `lesson.check` is given.
        points: what it is worth, if every expectation is met.
        limit: robot time, in s, that it may take at most; what is not looked at by then is marked with –.
        learnt: one sentence that is shown when the check is passed: what the learner can do now.
        page: one of `PAGES`; the page of the function's module unless told.
    """
    if page and page not in PAGES:
        raise ValueError(f"there is no page {page!r}. {did_you_mean(page, PAGES)}".strip())

    def register(function: Maker) -> Check:
        title = (function.__doc__ or "").strip().splitlines()[0]
        its_page = page or PAGES[MODULES.index(function.__module__.rpartition(".")[2])]
        made = _checks[name] = Check(name, title, its_page, points, limit, function, learnt)
        return made

    return register


def all_checks() -> list[Check]:
    """All checks: by page, and on a page in the order in which its module has them."""
    for module in MODULES:
        importlib.import_module(f"{__package__}.{module}")
    return sorted(_checks.values(), key=lambda each: PAGES.index(each.page))


def checks_of(page: str) -> list[Check]:
    """The checks of a page."""
    return [each for each in all_checks() if each.page == page]


def find(name: object) -> Check:
    """The check of a name. Raises ValueError, which says which one may be meant."""
    known = {each.name: each for each in all_checks()}
    if isinstance(name, str) and name in known:
        return known[name]
    hint = did_you_mean(name, known) if isinstance(name, str) else ""
    raise ValueError(f"there is no check {name!r}. {hint or f'There are {enumerated(known)}.'}")
