"""What looking at one expectation gives: ✓, ✗ with what was seen, – with the reason why not, or ■ where code was stopped."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

GOOD, BAD, OPEN, STOPPED = "✓", "✗", "–", "■"
IN_WORDS = {GOOD: "yes", BAD: "no", OPEN: "not looked at", STOPPED: "stopped"}


class CannotLook(Exception):
    """This cannot be looked at; the message completes "not looked at, because …"."""


class OutOfTime(CannotLook):
    """The robot time of the check is over."""


class Stopped(CannotLook):
    """The learner's code let no time pass and was stopped; the message says where."""


@dataclass(frozen=True, slots=True)
class Advice:
    """What is said of a ✗, in three steps: at the first failure of a check, at the second, and from the third on.

    Attributes:
        symptom: what the fault looks like, where the row's own words do not say it yet.
        direction: where to look, or what to think about; not the line to write.
        hint: which hint to open ("Open Hint 2 under the exercise."); shown together with the direction.
    """

    symptom: str = ""
    direction: str = ""
    hint: str = ""

    def after(self, failures: int) -> str:
        """What is said when a check has failed so many times in a row."""
        if failures <= 1:
            return self.symptom
        return self.direction if failures == 2 else " ".join(filter(None, (self.direction, self.hint)))


class Seen(NamedTuple):
    """What was seen: whether it is as expected, in words, and advice if it is not; a plain text is the direction."""

    good: bool
    words: str
    advice: str | Advice = ""


@dataclass(frozen=True, slots=True)
class Row:
    """One line of a result."""

    mark: str
    expected: str
    seen: str
    advice: Advice = Advice()
    """Only where the mark is ✗ or ■."""
    trace: str = ""
    """Lines of the learner's code in which an error came up, outermost first."""

    @property
    def good(self) -> bool:
        """Whether it is as expected."""
        return self.mark == GOOD
