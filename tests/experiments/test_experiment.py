"""One function in many fresh worlds: the table that comes out, whatever workers carried the runs out."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from turtle_lesson.experiments import ExperimentError, experiment


def drive(lesson: Any, gain: float, loss: float = 0.0) -> dict[str, float]:
    lesson.run(gain)
    assert gain < 3 or lesson._world.seed != 1, "the turtle did not arrive"
    return {"seconds": lesson.now, "lost": loss}


def test_there_is_a_row_for_each_combination_and_seed_in_their_order() -> None:
    results = experiment(drive, seeds=range(2), gain=[1.0, 3.0], jobs=2)
    assert [(row["run"], row["seed"], row["gain"], row["outcome"]) for row in results] == [
        (0, 0, 1.0, "ok"),
        (1, 1, 1.0, "ok"),
        (2, 0, 3.0, "ok"),
        (3, 1, 3.0, "raised"),
    ]
    np.testing.assert_equal(results["seconds"], [1.0, 1.0, 3.0, np.nan])
    assert len(results.failed) == 1
    assert results.failed.rows[0]["error"] == "AssertionError: the turtle did not arrive"
    assert list(results.where(gain=3.0)["run"]) == [2, 3]
    assert repr(results).splitlines()[-1] == "4 runs, 1 failed: 3"


def test_a_parameter_that_the_function_does_not_have_is_named() -> None:
    with pytest.raises(ExperimentError, match=r"drive has no parameter 'gian'\. Did you mean \"gain\""):
        experiment(drive, gian=[1.0])
