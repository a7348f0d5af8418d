"""`until="failure"`: the smallest change of the parameters with which a run still fails, found by delta debugging.

The base of each parameter is the first of its values. A failing run differs from the base in some parameters. Each of them is
put back to its base where the run still fails, then numbers are brought nearer to it by bisection, until nothing changes. Every
value that is reported was tried, so it fails, also where larger ones do not. Runs are tried one after the other, so the outcome
does not depend on how many workers there are.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import replace
from decimal import ROUND_CEILING, ROUND_FLOOR, Decimal
from typing import Any

from ..lab.words import count
from .one_run import RAISED, Ending, Run

MOST_RUNS = 200
"""How many runs are tried at most."""

STEPS = 12
"""How many steps a bisection has at most."""

NEAR = 0.01
"""A bisection ends when it knows the value to this share of the whole change."""


class Smallest:
    """The smallest change from `base` with which a run is known to fail as it did.

    Attributes:
        run, ending: the run, and what came of it.
        base: the first value of each parameter.
        tried: how many runs were needed.
        complete: whether nothing smaller fails, as far as this search can tell; False if it was ended before.
    """

    def __init__(
        self, failed: Run, ending: Ending, base: Mapping[str, Any], carry_out: Callable[[Run], Ending]
    ) -> None:
        self.run, self.ending, self.base = failed, ending, base
        self.tried = 0
        self.complete = False
        self._carry_out = carry_out
        self._spans = dict(failed.parameters)
        self._passes = set[str]()

    @property
    def change(self) -> dict[str, Any]:
        """The parameters that differ from their base, with their values."""
        return {name: value for name, value in self.run.parameters.items() if not _equal(value, self.base[name])}

    def told(self) -> str:
        """The change in a sentence."""
        if not self.base:
            return ""
        tried = count(self.tried, "more run")
        if not self.change:
            return f"All parameters have their first values there, so no change is needed for that ({tried})."
        parts = [f"{name}={value!r} instead of {self.base[name]!r}" for name, value in self.change.items()]
        rest = "" if self.complete else " A smaller one was not looked for to the end."
        return f"The smallest change that still fails with this seed: {', '.join(parts)} ({tried}).{rest}"

    def search(self) -> None:
        """Make the change smaller until nothing changes, there were too many runs, or the user stops it (KeyboardInterrupt)."""
        try:
            self._search()
        except KeyboardInterrupt:
            print("Stopped; a smaller change was not looked for any further.")

    def _search(self) -> None:
        searched: dict[str, list[Any]] = {}
        while self.tried < MOST_RUNS and not self.complete:
            before = self.run.parameters
            for name in before:
                self._fails_with(name, self.base[name])
            for name in before:
                others = [value for other, value in self.run.parameters.items() if other != name]
                if searched.get(name) != others:  # or it is known already
                    searched[name] = others
                    self._bisect(name)
            self.complete = self.tried < MOST_RUNS and self.run.parameters == before

    def _fails_with(self, name: str, value: Any) -> bool:
        """Whether the run still fails with another value; then it is kept."""
        if _equal(self.run.parameters[name], value):
            return True
        run = replace(self.run, parameters=self.run.parameters | {name: value})
        key = repr(list(run.parameters.values()))
        if key in self._passes or self.tried >= MOST_RUNS:
            return False
        self.tried += 1
        ending = self._carry_out(run)
        if _kind(ending) != _kind(self.ending):
            self._passes.add(key)
            return False
        self.run, self.ending = run, ending
        return True

    def _bisect(self, name: str) -> None:
        """Bring a number nearer to its base, which does not fail, and make it a round one."""
        passes, fails = self.base[name], self.run.parameters[name]
        if not (_is_number(passes) and _is_number(fails)) or _equal(passes, fails):
            return
        whole = isinstance(passes, int) and isinstance(fails, int)
        near = 1 if whole else NEAR * abs(self._spans[name] - passes)
        for _ in range(STEPS):
            if abs(fails - passes) <= near:
                break
            middle = (passes + fails) // 2 if whole else (passes + fails) / 2
            if self._fails_with(name, middle):
                fails = middle
            else:
                passes = middle
        if not whole:
            self._fails_with(name, rounder(passes, fails))


def rounder(passes: float, fails: float) -> float:
    """The number with the fewest digits beyond `passes` and up to `fails`, the nearest such one to `fails`."""
    size = math.floor(math.log10(max(abs(passes), abs(fails))))
    rounding = ROUND_FLOOR if fails > passes else ROUND_CEILING
    for digits in range(17):
        candidate = float(Decimal(fails).quantize(Decimal(1).scaleb(size - digits), rounding=rounding))
        if min(passes, fails) <= candidate <= max(passes, fails) and candidate != passes:
            return candidate
    return fails


def _kind(ending: Ending) -> tuple[str, str]:
    """How a run has failed: another error would be another failure."""
    return ending.outcome, ending.error.partition(":")[0] if ending.outcome == RAISED else ""


def _is_number(value: Any) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool) and math.isfinite(value)


def _equal(one: Any, other: Any) -> bool:
    return type(one) is type(other) and repr(one) == repr(other)
