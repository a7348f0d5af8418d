"""The case file of a trouble: what a user reports of a broken system, and hints for finding the cause."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from random import Random
from typing import TYPE_CHECKING, Any

from ..checks.registry import Expectation
from ..checks.results import CheckResult, Seen
from ..words import suggestion
from .faults import TROUBLES, Fault, Trouble

if TYPE_CHECKING:
    from ...session.trouble_environment import TroubleEnvironment


@dataclass(frozen=True, repr=False)
class Case:
    """One broken system. It does not say what is wrong until that is mended.

    Attributes:
        number: by which `lesson.trouble(number)` brings it back.
        trouble: the name under which it was asked for; None if it was drawn by its number.
        check: whether the system is well now, from the running graph alone: the same as `lesson.check("trouble")`.
    """

    number: int
    trouble: str | None
    _trouble: Trouble
    _fault: Fault
    check: Callable[[], CheckResult]

    @property
    def _title(self) -> str:
        return f"Case {self.number}, {self.trouble}" if self.trouble else f"Case {self.number}"

    def __repr__(self) -> str:
        return (
            f"{self._title}. A user reports: “{self._trouble.report}” Look at the running system, mend it, then: case.check(). "
            "If you are stuck: case.hint(1), up to 3."
        )

    def _repr_markdown_(self) -> str:
        todo = "Look at the running system, mend it, then: `case.check()`. If you are stuck: `case.hint(1)`, up to 3."
        return f"**{self._title}.** A user reports:\n\n> {self._trouble.report}\n\n{todo}"

    def hint(self, level: int = 1) -> str:
        """A hint: 1 says where to look, 2 with what, 3 nearly tells."""
        if level not in (1, 2, 3):
            raise ValueError(f"hints have levels from 1 to 3, got {level!r}: try case.hint(1)")
        return (self._trouble.where, self._trouble.how, self._fault.hint)[int(level) - 1]

    @property
    def cause(self) -> str:
        """What was wrong: told once the system is mended, which is looked at now."""
        return (
            self._fault.cause if self.check().passed else "It is not mended yet; case.check() says what is still wrong."
        )


NONE = "there is none in this world yet"

_current: tuple[Case, TroubleEnvironment] | None = None


def open_case(
    environment: TroubleEnvironment, seed: int | None, name: str | None, check: Callable[[], CheckResult]
) -> Case:
    """What `Lesson.trouble` does in a world; `check` looks at the system and says whether it is mended.

    Raises ValueError for a name that does not exist, with the one that may be meant, and for a seed that is not a number.
    """
    global _current
    number = 0 if seed is None else seed
    if isinstance(number, bool) or not isinstance(number, int):
        raise ValueError(f"a seed is a whole number, got {seed!r}: try lesson.trouble(1), or lesson.trouble(name=…)")
    chance = Random(f"trouble {number}")
    trouble = TROUBLES[chance.choice(sorted(TROUBLES))] if name is None else _named(name)
    chance = Random(f"{trouble.name} {number}")
    fault = chance.choice(list(trouble.faults(chance)))
    environment.clear()
    if fault.workspace:
        environment.make_workspace(fault.workspace)
    environment.start(fault.programs)
    if not fault.simulator:
        environment.stop_simulator()
    case = Case(number, None if name is None else trouble.name, trouble, fault, check)
    _current = (case, environment)
    return case


def _named(name: Any) -> Trouble:
    key = str(name).replace("_", " ").strip().lower()
    if key not in TROUBLES:
        raise ValueError(f"there is no trouble {name!r}. {suggestion(key, TROUBLES)}")
    return TROUBLES[key]


def carry_over(before: Any) -> None:
    """Take over the open case of an earlier import of this module, `before`; what it expects is what is written here."""
    global _current
    if before._current is not None:
        case, environment = before._current
        trouble = TROUBLES[case._trouble.name]
        _current = (Case(case.number, case.trouble, trouble, case._fault, case.check), environment)


def _open_case() -> Case | None:
    """The case that is open in a world that goes on."""
    return None if _current is None or _current[1].ended else _current[0]


def current_expectations() -> list[Expectation]:
    """What is expected of the system once the current case is mended."""
    case = _open_case()
    if case:
        return case._trouble.expectations()
    none = Seen(False, NONE, "Open one: case = lesson.trouble(1)")
    return [Expectation("a case that was opened", lambda probe: none)]


def expectations_of(number: int, name: str) -> list[Expectation]:
    """What is expected once this case is mended, after the expectation that it is the one that is open."""
    case = _open_case()
    good = case is not None and (case.number, case.trouble) == (number, name)
    seen = f"it is {case._title}" if case else NONE
    advice = f'Open this one: case = lesson.trouble({number}, name="{name}")'
    is_open = Expectation(f"the case {number}, {name}", lambda probe: Seen(good, seen, advice))
    return [is_open, *(TROUBLES[name].expectations() if good else [])]
