"""The first failure, and the smallest change that still fails: functions of which that is known."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from types import SimpleNamespace
from typing import Any

import pytest

from turtle_lesson.experiments import ExperimentError, experiment
from turtle_lesson.experiments.experiment import plan, search_failure
from turtle_lesson.experiments.one_run import OK, RAISED, Ending, Run, call_in
from turtle_lesson.experiments.shrink import MOST_RUNS, Smallest, rounder


def shrunk(fails: Callable[..., object], base: dict[str, Any], failed: dict[str, Any]) -> tuple[Smallest, list[Any]]:
    """What is found for a function that fails where this is true (or raises the error that this text names)."""
    tried: list[Any] = []

    def carry_out(run: Run) -> Ending:
        tried.append(run.parameters)
        found = fails(**run.parameters)
        return (
            Ending(RAISED, error=f"{found if isinstance(found, str) else 'AssertionError'}: why")
            if found
            else Ending(OK)
        )

    ending = carry_out(Run(17, 17, failed))
    assert ending.outcome == RAISED, "the run that is made smaller must fail"
    found = Smallest(Run(17, 17, failed), ending, base, carry_out)
    found.search()
    assert fails(**found.run.parameters), "what is reported was tried, and fails"
    assert len(tried) == found.tried + 1 <= MOST_RUNS + 1
    assert len({repr(each) for each in tried}) == len(tried), "nothing is tried twice"
    return found, tried


def test_a_threshold_is_found_to_a_hundredth_and_is_a_round_number() -> None:
    found, tried = shrunk(lambda loss: loss >= 0.3, {"loss": 0.0}, {"loss": 0.8})
    assert found.change == {"loss": 0.3} and found.complete
    assert len(tried) <= 16
    assert found.told() == "The smallest change that still fails with this seed: loss=0.3 instead of 0.0 (9 more runs)."
    found, _ = shrunk(lambda loss: loss > 0.31416, {"loss": 0.0}, {"loss": 0.8})
    assert 0.31416 < found.change["loss"] < 0.3242


def test_numbers_below_their_base_too() -> None:
    assert shrunk(lambda gain: gain <= -2.5, {"gain": 4.0}, {"gain": -8.0})[0].change == {"gain": -2.5}
    assert shrunk(lambda count: count < 17, {"count": 100}, {"count": 3})[0].change == {"count": 16}
    assert type(shrunk(lambda count: count > 7, {"count": 0}, {"count": 1000})[0].change["count"]) is int


def test_only_what_matters_stays() -> None:
    given = {"loss": 0.0, "gain": 1.0, "driver": "calm", "deep": True}
    failed = {"loss": 0.5, "gain": 4.0, "driver": "hasty", "deep": False}

    def fails(loss: float, gain: float, driver: str, deep: bool) -> bool:
        return driver == "hasty"

    assert shrunk(fails, given, failed)[0].change == {"driver": "hasty"}

    def needs_both(loss: float, gain: float, driver: str, deep: bool) -> bool:
        return loss >= 0.2 and not deep

    assert shrunk(needs_both, given, failed)[0].change == {"loss": 0.2, "deep": False}


def test_one_that_makes_another_one_smaller_is_searched_again() -> None:
    """With a small gain, less loss is enough: what was found for the first one changes after the second."""
    found, _ = shrunk(
        lambda loss, gain: loss >= 0.05 + 0.1 * gain and (gain > 0.5 or loss >= 0.4),
        {"loss": 0.0, "gain": 2.0},
        {"loss": 0.9, "gain": 3.0},
    )
    assert found.change == {"loss": 0.25}


def test_what_fails_here_and_there_is_still_true() -> None:
    def patchy(loss: float) -> bool:
        return 0.4 <= loss <= 0.5 or 0.61 <= loss <= 0.62 or loss >= 0.9

    found, _ = shrunk(patchy, {"loss": 0.0}, {"loss": 1.0})
    assert found.change == {"loss": 0.4}
    found, _ = shrunk(lambda count: count % 7 == 3, {"count": 0}, {"count": 997})
    assert found.change["count"] % 7 == 3


def test_another_failure_is_not_the_one() -> None:
    def fails(driver: str, loss: float) -> object:
        return "TypeError" if driver == "calm" else loss > 0.2

    found, _ = shrunk(fails, {"driver": "calm", "loss": 0.0}, {"driver": "hasty", "loss": 0.5})
    assert found.change["driver"] == "hasty"


def test_a_failure_without_any_change_says_so() -> None:
    found, _ = shrunk(lambda loss, gain: True, {"loss": 0.0, "gain": 1.0}, {"loss": 0.5, "gain": 9.0})
    assert found.change == {}
    assert (
        found.told() == "All parameters have their first values there, so no change is needed for that (2 more runs)."
    )


def test_there_is_an_end_to_it() -> None:
    names = [f"p{number}" for number in range(40)]
    found, _ = shrunk(
        lambda **values: all(value > 0.123456 for value in values.values()),
        dict.fromkeys(names, 0.0),
        dict.fromkeys(names, 1.0),
    )
    assert found.tried == MOST_RUNS and not found.complete
    assert found.told().endswith("A smaller one was not looked for to the end.")


def test_a_stop_keeps_what_is_known(capsys: pytest.CaptureFixture[str]) -> None:
    runs: list[Run] = []

    def carry_out(run: Run) -> Ending:
        runs.append(run)
        if len(runs) == 4:
            raise KeyboardInterrupt
        return Ending(RAISED, error="E: why") if run.parameters["loss"] > 0 else Ending(OK)

    found = Smallest(Run(0, 0, {"loss": 1.0}), Ending(RAISED, error="E: why"), {"loss": 0.0}, carry_out)
    found.search()
    assert found.change == {"loss": 0.25} and not found.complete
    assert "Stopped" in capsys.readouterr().out


def test_round_numbers() -> None:
    assert rounder(0.29, 0.3078125) == 0.3
    assert rounder(-0.29, -0.3078125) == -0.3
    assert rounder(0.5, 0.4078) == 0.41
    assert rounder(1234.5, 1290.25) == 1290.0
    assert rounder(0.0, 7e-12) == 7e-12
    assert rounder(0.1, 0.1 + 2e-17 + 1e-16) > 0.1


# -- in an experiment ----------------------------------------------------------------------------------------------------


def breaks(lesson: Any, loss: float, gain: float = 1.0, driver: str = "calm") -> dict[str, float]:
    lesson.run(0.1)
    seed = lesson._world.seed
    assert not (seed >= 3 and loss >= 0.2 and driver == "hasty"), "lost"
    return {"loss": loss}


SWEEP: dict[str, Any] = {"loss": [0.0, 0.4], "gain": [1.0, 2.0], "driver": ["calm", "hasty"]}


class Backwards:
    """A pool that carries runs out in this process, the last one first."""

    def __init__(self) -> None:
        self.carried_out: list[int] = []

    def carry_out(self, runs: Sequence[Run]) -> Iterator[tuple[Run, Ending]]:
        for run in reversed(runs):
            self.carried_out.append(run.number)
            lesson: Any = SimpleNamespace(run=lambda seconds: None, _world=SimpleNamespace(seed=run.seed), now=0.1)
            yield run, call_in(lesson, breaks, run)

    def close(self) -> None:
        """Nothing is open."""


SAID = (
    "Run 28 (seed 3) failed: AssertionError: lost\n"
    "The smallest change that still fails with this seed: loss=0.2 instead of 0.0, driver='hasty' instead of 'calm' "
    "(10 more runs).\n"
)


def test_the_same_failure_whatever_the_workers(capsys: pytest.CaptureFixture[str]) -> None:
    results = experiment(breaks, seeds=range(5), until="failure", simulator=False, jobs=2, **SWEEP)
    assert capsys.readouterr().out == SAID
    assert len(results) == 29 and results.missing == 11 and [row["run"] for row in results.failed] == [28]
    assert results.smallest == {"loss": 0.2, "driver": "hasty"}
    runs = plan(range(5), SWEEP)
    endings, smallest = search_failure(Backwards(), runs)
    assert capsys.readouterr().out == SAID
    assert [(run.number, ending.outcome) for run, ending in endings] == [
        (row["run"], row["outcome"]) for row in results
    ]
    assert smallest == results.smallest


def test_what_is_known_already_is_not_carried_out_again() -> None:
    runs, first, pool = plan(range(5), SWEEP), Backwards(), Backwards()
    known = list(first.carry_out([run for run in runs if run.number in (0, 5, 29, 38)]))
    endings, _ = search_failure(pool, runs, known)
    assert [run.number for run, _ in endings] == list(range(29))
    assert sorted(pool.carried_out[:27]) == [number for number in range(29) if number not in (0, 5)]


def test_nothing_that_fails_is_said(capsys: pytest.CaptureFixture[str]) -> None:
    runs = plan(range(3), {"loss": [0.1]})
    endings, smallest = search_failure(Backwards(), runs)
    assert capsys.readouterr().out == "None of the 3 runs failed.\n"
    assert len(endings) == 3 and smallest is None
    with pytest.raises(ExperimentError, match='until must be "failure" or None'):
        experiment(breaks, until="error", loss=0.1)
