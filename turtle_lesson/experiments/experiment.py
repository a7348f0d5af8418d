"""`experiment(function, seeds=…, gain=[…])`: one run for each seed and each combination of parameter values."""

from __future__ import annotations

import inspect
import itertools
from collections.abc import Callable, Iterable, Sequence
from typing import Any

from ..lab.words import did_you_mean, enumerated
from .one_run import ExperimentError, Run
from .payload import setting_for
from .pools import LocalPool, cores
from .results import Results


def experiment(
    function: Callable[..., Any],
    *,
    seeds: Iterable[int] = range(10),
    jobs: int | None = None,
    client: Any = None,
    package: Any = "finished",
    simulator: bool = True,
    distro: Any = None,
    start_order: Any = "as written",
    robot_time: float = 600.0,
    cpu_time: float = 60.0,
    until: str | None = None,
    resume: Any = None,
    progress: bool | None = None,
    **parameters: Any,
) -> Results:
    """Call `function(lesson, **parameters)` in a fresh world for each seed and combination of parameter values."""
    runs, swept = plan(function, seeds, parameters, package=package, distro=distro, start_order=start_order)
    setting = setting_for(function, runs, simulator=simulator, robot_time=robot_time, cpu_time=cpu_time)
    pool = LocalPool(setting, min(jobs or cores(), len(runs)))
    try:
        endings = list(pool.carry_out(runs))
    finally:
        pool.close()
    return Results.of(endings, swept, function=function, setting=setting)


def plan(
    function: Callable[..., Any], seeds: Iterable[int], parameters: dict[str, Any], **options: Any
) -> tuple[list[Run], list[str]]:
    """The runs of an experiment in their order, and the names of what is swept: parameters first to last, seeds innermost."""
    _check_names(function, parameters)
    lists = {name: values for name, values in options.items() if isinstance(values, (list, tuple))}
    swept = {name: _values(values) for name, values in {**lists, **parameters}.items()}
    fixed = {name: value for name, value in options.items() if name not in lists}
    seeds = [int(seed) for seed in seeds]
    if not seeds:
        raise ExperimentError("there are no seeds, so there is nothing to run: try seeds=range(10)")
    runs = []
    for number, (*values, seed) in enumerate(itertools.product(*swept.values(), seeds)):
        given = dict(zip(swept, values, strict=True))
        mine = {name: value for name, value in given.items() if name in parameters}
        runs.append(Run(number, seed, mine, **fixed, **{name: given[name] for name in lists}))
    return runs, list(swept)


def _values(values: Any) -> Sequence[Any]:
    """The values to sweep: those of a list, range or array; a single value is a sweep of one."""
    if hasattr(values, "tolist"):
        values = values.tolist()
    return list(values) if isinstance(values, (list, tuple, range)) else [values]


def _check_names(function: Callable[..., Any], parameters: Iterable[str]) -> None:
    name = getattr(function, "__name__", "the function")
    if not callable(function):
        raise ExperimentError(f"an experiment needs a function such as `def drive(lesson): …`, got {function!r:.80}")
    accepted = inspect.signature(function).parameters
    if any(each.kind is inspect.Parameter.VAR_KEYWORD for each in accepted.values()):
        return
    known = list(accepted)[1:]
    for each in parameters:
        if each not in known:
            guess = did_you_mean(each, known) or f"Its parameters are {enumerated(known)}."
            raise ExperimentError(f"{name} has no parameter {each!r}. {guess}")
