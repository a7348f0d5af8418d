"""Checks of the debugging lab: whether the trouble that was brought in on purpose is mended."""

from __future__ import annotations

from .registry import Expectation, check

PAGE = "09_debugging_lab"
LIMIT = 600


@check("trouble", page=PAGE, points=1, limit=LIMIT)
def trouble() -> list[Expectation]:
    """A system that does again what it should."""
    from ..troubles import current_expectations

    return current_expectations()


@check("slow_case", page=PAGE, points=3, limit=LIMIT)
def slow_case() -> list[Expectation]:
    """The first guided case: a turtle that gets where it is sent."""
    from ..troubles import expectations_of

    return expectations_of("turtle stands still")


@check("deaf_case", page=PAGE, points=3, limit=LIMIT)
def deaf_case() -> list[Expectation]:
    """The second guided case: an alarm that rings."""
    from ..troubles import expectations_of

    return expectations_of("alarm stays silent")


@check("own_case", page=PAGE, points=5, limit=LIMIT)
def own_case() -> list[Expectation]:
    """A case that was drawn by its number, mended."""
    from ..troubles import expectations_of

    return expectations_of(None)
