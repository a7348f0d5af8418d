"""What looking at one expectation gives: ✓ or ✗ with what was seen, or – with the reason why nobody looked."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

GOOD, BAD, OPEN = "✓", "✗", "–"
IN_WORDS = {GOOD: "yes", BAD: "no", OPEN: "not looked at"}


class CannotLook(Exception):
    """This cannot be looked at; the message completes "not looked at, because …"."""


class OutOfTime(CannotLook):
    """The time of the check is over."""


class Seen(NamedTuple):
    """What was seen: whether it is as expected, in words, and what to try if it is not."""

    good: bool
    words: str
    next_step: str = ""


@dataclass(frozen=True, slots=True)
class Row:
    """One line of a result."""

    mark: str
    expected: str
    seen: str
    next_step: str = ""
    """What helps most; only where the mark is ✗."""

    @property
    def good(self) -> bool:
        """Whether it is as expected."""
        return self.mark == GOOD
