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
from types import FunctionType
from typing import Any

from ..lab.words import count
from ..ros.sim.strand import running_strand
from ..session.lesson import check_world
from . import one_run
from .one_run import OK, OWN, PLAIN, Ending, ExperimentError, Run, Setting, name_of, plain
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
    world = {"package": package, "distro": distro, "start_order": start_order}
    limits = {"robot_time": robot_time, "cpu_time": cpu_time}
    runs, setting = _planned(function, seeds, parameters, simulator=simulator, **world, **limits)
    if jobs is not None and (isinstance(jobs, bool) or not isinstance(jobs, int) or not 1 <= jobs <= MOST_JOBS):
        raise ExperimentError(f"jobs must be a whole number from 1 to {MOST_JOBS}, got {jobs!r}")
    if until not in (None, "failure"):
        raise ExperimentError(f'until must be "failure" or None, got {until!r}')
    about = described(function, setting, world | {"package": package and str(package)})
    known = [] if resume is None else endings_of(resume, runs, about)
    smallest = None
    processes = min(jobs or defaults.get().jobs or cores(), max(len(runs) - len(known), 1))
    with closing(LocalPool(setting, processes) if client is None else ClusterPool(setting, client)) as pool:
        if until is None:
            endings = carry_out(pool, runs, known)
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
    one_each = {name: [value] for name, value in parameters.items()}
    options = {"simulator": simulator, "start_order": start_order, "robot_time": robot_time}
    [run], setting = _planned(function, [seed], one_each, package=package, distro=distro, **options)
    table = Results([], run.parameters)
    return Replay(setting, run, lambda ending: table.row_of(run, ending))


def carry_out(
    pool: LocalPool | ClusterPool, runs: Sequence[Run], known: Sequence[tuple[Run, Ending]], at_once: int | None = None
) -> list[tuple[Run, Ending]]:
    """What is known of runs, and what comes of the others; of those that were over if the user interrupts.

    `at_once`: so many are carried out, and no more once one has failed.
    """
    there = {run.number for run, _ in known}
    runs = [run for run in runs if run.number not in there]
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
    return [*known, *done]


def search_failure(
    pool: LocalPool | ClusterPool, runs: Sequence[Run], known: Sequence[tuple[Run, Ending]] = ()
) -> tuple[list[tuple[Run, Ending]], dict[str, Any] | None]:
    """Carry out runs in their order until one fails; then look for the smallest change with which that fails.

    What was carried out beyond the failing run, since workers work side by side, is left out of the table.
    """
    failing = min((run.number for run, ending in known if ending.outcome != OK), default=len(runs))
    done = sorted(carry_out(pool, runs[:failing], known, AT_ONCE), key=lambda each: each[0].number)
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


# -- what is asked for ---------------------------------------------------------------------------------------------------


def plan(seeds: Iterable[int], parameters: dict[str, Any]) -> list[Run]:
    """The runs of an experiment in their order. Raises ExperimentError."""
    numbers = [plain(seed) for seed in seeds] if isinstance(seeds, Iterable) else []
    if not numbers or any(type(seed) is not int for seed in numbers):
        raise ExperimentError(f"seeds must be one or more whole numbers, got {seeds!r:.80}: try seeds=range(10)")
    swept = {name: _values(name, values) for name, values in parameters.items()}
    combined = itertools.product(*swept.values(), numbers)
    return [Run(number, seed, dict(zip(swept, values, strict=True))) for number, (*values, seed) in enumerate(combined)]


def _values(name: str, values: Any) -> list[Any]:
    """The values to sweep: those of a list, a range or an array; a single value is a sweep of one."""
    if hasattr(values, "tolist"):
        values = values.tolist()
    found = [plain(value) for value in (values if isinstance(values, (list, range)) else [values])]
    if not found or not all(map(_is_plain, found)):
        kinds = "numbers, texts, True, False, None or tuples of these"
        raise ExperimentError(f"{name} must be one or more {kinds}, got {values!r:.80}: try {name}=[1.0, 2.0]")
    return found


def _is_plain(value: Any) -> bool:
    return all(map(_is_plain, value)) if isinstance(value, tuple) else isinstance(value, PLAIN)


def _planned(
    function: Callable[..., Any], seeds: Iterable[int], parameters: dict[str, Any], **options: Any
) -> tuple[list[Run], Setting]:
    """The runs of a function, and what they share by `options`. Raises ExperimentError for what cannot be carried out."""
    if running_strand() is not None:
        raise ExperimentError("a simulated program cannot carry out an experiment: call it in a cell or a script")
    if one_run.is_worker():
        raise ExperimentError("a run of an experiment cannot carry out an experiment of its own")
    if not isinstance(function, FunctionType):
        raise ExperimentError(f"an experiment needs a function such as `def drive(lesson): …`, got {function!r:.80}")
    name = name_of(function)
    try:
        inspect.signature(function).bind(None, **parameters)
    except TypeError as error:
        call = ", ".join(["lesson", *(f"{each}=…" for each in parameters)])
        raise ExperimentError(f"{name} cannot be called as {name}({call}): {error}") from None
    if own := [each for each in parameters if each in OWN]:
        raise ExperimentError(f"{name} has a parameter {own[0]!r}, as each table has: give it another name")
    runs = plan(seeds, parameters)
    check_options(**options)
    return runs, setting_for(function, **options)


def check_options(*, package: str | Path | None, distro: str | None, start_order: str, **others: Any) -> None:
    """Raise ExperimentError for a world that cannot be, or a limit in seconds that makes no sense."""
    try:
        check_world(package, distro, start_order)
    except ValueError as error:
        raise ExperimentError(str(error)) from None
    for name in ("robot_time", "cpu_time"):
        seconds = others.get(name, 1.0)
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
