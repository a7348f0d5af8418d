"""`experiment(function, seeds=…, gain=[…])`: one run for each seed and each combination of parameter values."""

from __future__ import annotations

import inspect
import itertools
import os
import sys
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import closing, contextmanager
from contextvars import ContextVar
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from typing import Any

from ..lab.words import count, suggestion
from ..ros.sim.strand import running_strand
from ..session.lesson import check_world
from . import one_run
from .one_run import OK, OWN, PLAIN, Ending, ExperimentError, Run, name_of, plain
from .payload import setting_for
from .pools import ClusterPool, LocalPool, cores
from .replay import Replay
from .results import Results, described, endings_of
from .shrink import Smallest

MOST_JOBS = 512

AT_ONCE = 32
"""How many runs are carried out before it is looked whether one has failed, where only the first failure is wanted."""


@dataclass(frozen=True)
class Defaults:
    """What `turtle-lesson run` says for the experiments of a script."""

    jobs: int | None = None
    finished: Callable[[Results], object] = lambda results: None
    """Is given each table."""


defaults: ContextVar[Defaults] = ContextVar("defaults", default=Defaults())  # noqa: B039  # it never changes


def experiment(
    function: Callable[..., Any],
    *,
    seeds: Iterable[int] = range(10),
    jobs: int | None = None,
    client: Any = None,
    package: str | Path | None = "finished",
    simulator: bool = True,
    distro: str | None = None,
    start_order: str = "as written",
    robot_time: float = 600.0,
    cpu_time: float = 60.0,
    until: str | None = None,
    resume: str | Path | None = None,
    **parameters: Any,
) -> Results:
    """Call `function(lesson, **parameters)` in a fresh world for each seed and each combination of parameter values.

    The runs are numbered in the order of the parameters, the seeds innermost, and the table is in that order: it is the same
    for any number of workers. A run that raises an error, takes too long or kills its worker is a row that says so. The stop
    button, or Ctrl-C, ends the experiment; the rows that are there are returned.

    Args:
        function: such as `def drive(lesson, gain): …`, also of a cell; it returns a dict of numbers and texts, or nothing.
        seeds: one world each; see `start`.
        jobs: how many worker processes there are; None: one for each core that may be used.
        client: a `dask.distributed.Client`, or the address of a scheduler, to use a cluster instead.
        package, simulator, distro, start_order: as for `start`.
        robot_time, cpu_time: how many seconds a run may take, of robot time and of computing.
        until: "failure" carries out runs in order until one fails, and looks for the smallest change that still fails.
        resume: a file of `results.save(…)`: runs that are in it are not carried out again.
        parameters: by name, a list of values to sweep, or a single one. The function's own defaults hold for all others.

    Raises ExperimentError, a ValueError, for an experiment that cannot be carried out.
    """
    _check_place()
    _check_function(function, parameters)
    runs = plan(seeds, parameters)
    world = checked_world(package, distro, start_order)
    check_limits(jobs, robot_time=robot_time, cpu_time=cpu_time)
    if until not in (None, "failure"):
        raise ExperimentError(f'until must be "failure" or None, got {until!r}')
    setting = setting_for(function, simulator=simulator, robot_time=robot_time, cpu_time=cpu_time, **world)
    about = described(function, setting, world)
    known = [] if resume is None else endings_of(resume, runs, about)
    smallest = None
    processes = min(jobs or defaults.get().jobs or cores(), max(len(runs) - len(known), 1))
    with closing(LocalPool(setting, processes) if client is None else ClusterPool(setting, client)) as pool:
        if until is None:
            endings = known + carry_out(pool, left_of(runs, known))
        else:
            endings, smallest = search_failure(pool, runs, known)
    missing = len(runs) - len(endings)
    results = Results(endings, runs[0].parameters, about=about, missing=missing, function=function, setting=setting)
    results.smallest = smallest
    defaults.get().finished(results)
    return results


def replay(
    function: Callable[..., Any],
    *,
    seed: int = 0,
    package: str | Path | None = "finished",
    simulator: bool = True,
    distro: str | None = None,
    start_order: str = "as written",
    robot_time: float = 600.0,
    **parameters: Any,
) -> Replay:
    """Open one run in this notebook, as `results.replay` opens one of a table: `replay(drive, seed=17, gain=4.0).step(1.0)`.

    It stands before the function's first line. The world is closed by the next `start()`, and the run ends with it. Raises
    ExperimentError for a run that cannot be carried out.
    """
    _check_place()
    _check_function(function, parameters)
    [run] = plan([seed], {name: [value] for name, value in parameters.items()})
    check_limits(None, robot_time=robot_time)
    world = checked_world(package, distro, start_order)
    setting = setting_for(function, simulator=simulator, robot_time=robot_time, **world)
    table = Results([], run.parameters)
    return Replay(setting, run, lambda ending: table.row_of(run, ending))


def carry_out(
    pool: LocalPool | ClusterPool, runs: Sequence[Run], at_once: int | None = None
) -> list[tuple[Run, Ending]]:
    """Carry out runs; those that were over when the user interrupted. `at_once`: so many, and no more once one has failed."""
    done: list[tuple[Run, Ending]] = []
    failed = 0
    try:
        with bar(len(runs)) as shown:
            step = at_once or len(runs) or 1
            for first in range(0, len(runs), step):
                for run, ending in pool.carry_out(runs[first : first + step]):
                    done.append((run, ending))
                    failed += ending.outcome != OK
                    if failed:
                        shown.set_postfix_str(f"{failed} failed", refresh=False)
                    shown.update()
                if at_once and failed:
                    break
    except KeyboardInterrupt:
        print(
            f"Stopped: {len(done)} of {len(runs)} runs were over. They are in the table; resume= goes on from a saved one."
        )
    return done


def left_of(runs: Sequence[Run], known: Sequence[tuple[Run, Ending]]) -> list[Run]:
    """The runs of which it is not known yet what comes of them."""
    there = {run.number for run, _ in known}
    return [run for run in runs if run.number not in there]


def search_failure(
    pool: LocalPool | ClusterPool, runs: Sequence[Run], known: Sequence[tuple[Run, Ending]] = ()
) -> tuple[list[tuple[Run, Ending]], dict[str, Any] | None]:
    """Carry out runs in their order until one fails; then look for the smallest change with which that fails.

    What was carried out beyond the failing run, since workers work side by side, is left out of the table.
    """
    failing = min((run.number for run, ending in known if ending.outcome != OK), default=len(runs))
    carried_out = carry_out(pool, left_of(runs[:failing], known), AT_ONCE)
    done = sorted([*known, *carried_out], key=lambda each: each[0].number)
    first = next((at for at, (_, ending) in enumerate(done) if ending.outcome != OK), None)
    if first is None:
        if len(done) == len(runs):
            print(f"None of the {count(len(runs), 'run')} failed." if len(runs) > 1 else "The run did not fail.")
        return done, None
    run, ending = done[first]
    if first != run.number:  # the user has stopped it before all others of a lower number were over
        return done, None
    print(f"Run {run.number} (seed {run.seed}) failed: {ending.error or ending.outcome}")
    found = Smallest(run, ending, runs[0].parameters, lambda another: next(iter(pool.carry_out([another])))[1])
    found.search()
    if text := found.told():
        print(text)
    return done[: first + 1], found.change


# -- the plan ------------------------------------------------------------------------------------------------------------


def plan(seeds: Iterable[int], parameters: dict[str, Any]) -> list[Run]:
    """The runs of an experiment in their order. Raises ExperimentError."""
    swept = {name: _values(name, values) for name, values in parameters.items()}
    combined = itertools.product(*swept.values(), _seeds(seeds))
    return [Run(number, seed, dict(zip(swept, values, strict=True))) for number, (*values, seed) in enumerate(combined)]


def _seeds(seeds: Any) -> list[int]:
    try:
        found = [plain(seed) for seed in seeds]
    except TypeError:  # it cannot be iterated over
        found = [None]
    if isinstance(seeds, bytes) or any(isinstance(seed, bool) or not isinstance(seed, int) for seed in found):
        raise ExperimentError(f"seeds must be a list or range of whole numbers, got {seeds!r:.80}: try seeds=range(10)")
    if not found:
        raise ExperimentError("there are no seeds, so there is nothing to run: try seeds=range(10)")
    return found


def _values(name: str, values: Any) -> list[Any]:
    """The values to sweep: those of a list, a range or an array; a single value is a sweep of one."""
    if hasattr(values, "tolist"):
        values = values.tolist()
    found = [plain(value) for value in (values if isinstance(values, (list, range)) else [values])]
    if not found:
        raise ExperimentError(f"{name} has no values, so there is nothing to run: try {name}=[1.0, 2.0]")
    for value in found:
        if not _is_plain(value):
            raise ExperimentError(
                f"{name} must be numbers, texts, True, False, None or tuples of these, got {value!r:.80} "
                f"({type(value).__name__})"
            )
    return found


# -- what is asked for ---------------------------------------------------------------------------------------------------


def _check_place() -> None:
    if running_strand() is not None:
        raise ExperimentError("a simulated program cannot carry out an experiment: call it in a cell or a script")
    if one_run.is_worker():
        raise ExperimentError("a run of an experiment cannot carry out an experiment of its own")


def _check_function(function: Callable[..., Any], parameters: dict[str, Any]) -> None:
    if not callable(function):
        raise ExperimentError(f"an experiment needs a function such as `def drive(lesson): …`, got {function!r:.80}")
    name, signature, kinds = name_of(function), inspect.signature(function), inspect.Parameter
    try:
        signature.bind_partial(None)
    except TypeError:
        raise ExperimentError(f"{name} must take the lesson as its first parameter: def {name}(lesson): …") from None
    accepted = list(signature.parameters.values())[1:]
    known = [each.name for each in accepted if each.kind in (kinds.POSITIONAL_OR_KEYWORD, kinds.KEYWORD_ONLY)]
    if not any(each.kind is kinds.VAR_KEYWORD for each in accepted):
        check_names(name, parameters, known)
    own = [each for each in known if each in inspect.signature(experiment).parameters]
    own += [each for each in parameters if each in OWN]
    if own:
        raise ExperimentError(
            f"{name} has a parameter {own[0]!r}, as experiment() or its table has: give it another name"
        )
    for parameter in accepted:
        if parameter.name in known and parameter.default is kinds.empty and parameter.name not in parameters:
            raise ExperimentError(
                f"{name} needs a value of {parameter.name!r}: add {parameter.name}=[…] with the values to try"
            )


def check_names(function: str, parameters: Iterable[str], known: list[str]) -> None:
    """Raise ExperimentError for a parameter that the function of this name does not have."""
    for each in parameters:
        if each not in known:
            raise ExperimentError(f"{function} has no parameter {each!r}. {suggestion(each, known)}")


def _is_plain(value: Any) -> bool:
    return all(map(_is_plain, value)) if isinstance(value, tuple) else isinstance(value, PLAIN)


def checked_world(package: str | Path | None, distro: str | None, start_order: str) -> dict[str, Any]:
    """What the worlds of all runs have in common, by the names of `start`. Raises ExperimentError for what makes no sense."""
    try:
        check_world(package, distro, start_order)
    except ValueError as error:
        raise ExperimentError(str(error)) from None
    return {"package": package and str(package), "distro": distro, "start_order": start_order}


def check_limits(jobs: Any, **limits: Any) -> None:
    """Raise ExperimentError for a number of workers, or a limit in seconds, that makes no sense."""
    if jobs is not None and (isinstance(jobs, bool) or not isinstance(jobs, int) or not 1 <= jobs <= MOST_JOBS):
        raise ExperimentError(f"jobs must be a whole number from 1 to {MOST_JOBS}, got {jobs!r}")
    for name, seconds in limits.items():
        if isinstance(seconds, bool) or not isinstance(seconds, (int, float)) or not 0 < seconds <= 1e9:
            raise ExperimentError(f"{name} must be a number of seconds above 0, got {seconds!r}")


# -- the bar -------------------------------------------------------------------------------------------------------------


@contextmanager
def bar(total: int) -> Iterator[Any]:
    """A bar of tqdm's for so many runs, in a live notebook or a terminal, of which nothing is left; elsewhere none is shown."""
    ipython: Any = sys.modules.get("IPython")
    kernel = getattr(ipython and ipython.get_ipython(), "kernel", None)
    watched = "CI" not in os.environ and (sys.stderr.isatty() if kernel is None else _is_live(kernel))
    notebook = watched and kernel is not None
    tqdm: Any = import_module("tqdm.notebook" if notebook else "tqdm.std").tqdm
    Bar = type("Bar", (tqdm,), {"monitor_interval": 0})  # no thread stays behind
    options = {"display": False} if notebook else {"dynamic_ncols": True, "disable": not watched}
    with closing(Bar(total=total, unit="run", leave=False, **options)) as shown:
        if not notebook:
            yield shown
            return
        from IPython.display import display

        output: Any = display(shown.container, display_id=True)
        try:
            yield shown
        finally:
            shown.n = shown.total  # or a bar that is stopped would stay, in red
            shown.close()
            output.update({"text/plain": ""}, raw=True)


def _is_live(kernel: Any) -> bool:
    """Whether the cell that runs could ask for input: those that nbval, nbconvert or a grader runs could not."""
    try:
        return bool(kernel.get_parent("shell")["content"]["allow_stdin"])
    except (AttributeError, KeyError, TypeError):
        return False
