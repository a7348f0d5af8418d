"""What comes out of an experiment: a row for each run, in the order of the runs, whatever workers carried them out."""

from __future__ import annotations

import platform
import sys
from collections.abc import Callable, Iterable, Sequence
from copy import copy
from importlib.metadata import version
from math import sqrt
from pathlib import Path
from statistics import NormalDist
from typing import Any

import numpy as np

from ..lab import drawing
from ..lab.drawing import Picture
from ..lab.words import count, enumerated
from .one_run import CPU_TIME, DIED, FIRST, LAST, OK, OWN, VERSION, Ending, ExperimentError, Run, Setting, name_of
from .payload import hash_of, hash_of_folders, setting_for
from .replay import Replay
from .table import Table, read, save, text_of


class Results(Table):
    """The rows of an experiment. `results["seconds"]` is a column as a numpy array: nan where a run has failed.

    Attributes:
        rows: a dict for each run: its number and seed, what was swept, `outcome` ("ok", "raised", "robot time", "CPU time" or
            "worker died"), what the function has returned, and then `robot_time` (s), `error`, `traceback` and `printed`.
        columns: the names in that order.
        swept: the names of those that were inputs.
        missing: how many runs were not carried out, since the experiment was stopped.
        about: versions, hashes and settings, which are saved with the rows.
        runs: the runs, by their numbers.
        function, setting: what was run.
        smallest: what `until="failure"` has found: the values that differ from the first ones in the smallest change that
            still fails. None where nothing failed, or nothing was looked for.
    """

    smallest: dict[str, Any] | None = None

    def __init__(
        self,
        endings: Iterable[tuple[Run, Ending]],
        swept: Iterable[str],
        *,
        about: dict[str, Any] | None = None,
        missing: int = 0,
        function: Callable[..., Any] | None = None,
        setting: Setting | None = None,
    ) -> None:
        """The table of what came of some runs; `swept` names the inputs that are columns."""
        done = sorted(endings, key=lambda each: each[0].number)
        self.runs = {run.number: run for run, _ in done}
        self.swept, self.about, self.missing = list(swept), about or {}, missing
        self.function, self.setting = function, setting
        self._returned = list(dict.fromkeys(name for _, ending in done for name in ending.values))
        rows = [self.row_of(run, ending) for run, ending in done]
        super().__init__(rows, list(dict.fromkeys([*FIRST, *self.swept, "outcome", *self._returned, *LAST])))

    def where(self, **values: Any) -> Results:
        """The rows in which columns have these values: `results.where(gain=2.0)`."""
        for column in values:
            self.check(column)
        return self._with(row for row in self.rows if all(row[name] == value for name, value in values.items()))

    @property
    def ok(self) -> Results:
        """The runs that ended well."""
        return self.where(outcome=OK)

    @property
    def failed(self) -> Results:
        """The runs that raised something, took too long or lost their worker."""
        return self._with(row for row in self.rows if row["outcome"] != OK)

    def _with(self, rows: Iterable[dict[str, Any]]) -> Results:
        part = copy(self)
        part.rows, part.missing, part.smallest = list(rows), 0, None
        return part

    def row_of(self, run: Run, ending: Ending) -> dict[str, Any]:
        """The row that this table would have for what came of a run."""
        row: dict[str, Any] = {"run": run.number, "seed": run.seed}
        row |= {name: run.parameters[name] for name in self.swept}
        row["outcome"] = ending.outcome
        row |= {name: ending.values.get(name) for name in dict.fromkeys([*self._returned, *ending.values])}
        row["robot_time"] = ending.robot_time
        return row | {name: getattr(ending, name) or None for name in LAST[1:]}

    @property
    def summary(self) -> str:
        """How many runs there are, and which of them failed, in a sentence."""
        failed = [str(row["run"]) for row in self.failed]
        said = f"{len(failed)} failed: {enumerated(failed)}" if failed else "none failed"
        return f"{count(len(self), 'run')}, {said}" + (f"; {self.missing} not carried out" if self.missing else "")

    def replay(self, number: int | None = None, function: Callable[..., Any] | None = None) -> Replay:
        """Open a run in this notebook, as it was, to go on step by step: the first one that failed, unless told.

        `function` is called instead, as it is now. Raises ExperimentError where there is no such run.
        """
        rows = {row["run"]: row for row in self.rows}
        if number is None:
            number = next((row["run"] for row in self.failed), None)
            if number is None:
                raise ExperimentError("no run of this table has failed: say which one to open, as in results.replay(0)")
        if number not in rows:
            raise ExperimentError(f"there is no run {number!r} in this table: it has {enumerated(map(str, rows))}")
        row, run, setting = rows[number], self.runs[number], self.setting
        assert self.function is not None and setting is not None
        if function is not None:
            simulator, limit = setting.simulator, setting.robot_time
            setting = setting_for(function, simulator=simulator, robot_time=limit, **self.about["world"])
            now, what = function, "it is replayed as it is now, and may end otherwise."
        else:
            module = sys.modules.get(getattr(self.function, "__module__", ""))  # what its name means there now
            now = getattr(module, getattr(self.function, "__qualname__", ""), self.function)
            what = "it is replayed as it was then."
        if self.about["function"] != f"{name_of(now)} {hash_of(now)}":
            print(f"{name_of(now)}, or something that it uses, has changed since this experiment; {what}")
        if row["outcome"] == DIED:
            print(f"Run {number} ended its worker process. What did that may end this kernel, too.")
        if row["outcome"] == CPU_TIME:
            print(f"Run {number} computed for too long. Nothing limits that here; the stop button interrupts it.")
        return Replay(setting, run, lambda ending: self.row_of(run, ending), row)

    def save(self, path: str | Path) -> Path:
        """Write the table to a file, "runs.csv" or "runs.parquet", with versions and settings; `experiment(resume=…)` reads it.

        In a CSV file these are the lines at its beginning that start with "#": `pandas.read_csv(path, comment="#")` passes
        over them. Raises ExperimentError for another kind of file.
        """
        return save(self, self.about | {"swept": self.swept, "missing": self.missing}, Path(path))

    def plot(self, column: str, by: str | None = None) -> Picture:
        """A dot for each run, with quartiles and median; `by` names a column whose values are drawn side by side."""
        parts = [(head.get(by or ""), self.numbers(rows, column), len(rows)) for head, rows in self.groups(by)]
        amount = sum(len(numbers) for _, numbers, _ in parts)
        if not amount:
            return Picture(f"There is no {column} to draw: {self.summary}.")
        labels = ["all runs" if by is None else text_of(value) or "None" for value, _, _ in parts]
        names = [column if by is None else f"{by} {label}" for label in labels]
        told = [_in_words(name, numbers, runs) for name, (_, numbers, runs) in zip(names, parts, strict=True)]
        text = f"{column} of {count(amount, 'run')}{'' if by is None else f' by {by}'}. {' '.join(told)}"
        with drawing.applied():
            return _picture(text, column, by, labels, [numbers for _, numbers, _ in parts])

    def rate(self, by: str | None = None) -> Table:
        """How many runs ended well: the share, and the interval in which the true rate lies, with 95 % confidence.

        The interval is Wilson's score interval, which is right for few runs and rates near 0 or 1, too: E. B. Wilson,
        "Probable inference, the law of succession, and statistical inference", Journal of the American Statistical
        Association 22 (1927), pages 209 to 212.
        """
        rows = []
        for head, some in self.groups(by):
            good = sum(row["outcome"] == OK for row in some)
            low, high = wilson(good, len(some))
            share = good / len(some) if some else None
            rows.append(head | {"runs": len(some), "ok": good, "rate": share, "low": low, "high": high})
        return Table(rows, [*([] if by is None else [by]), "runs", "ok", "rate", "low", "high"])

    def quantiles(
        self, column: str, by: str | None = None, at: Sequence[float] = (0.05, 0.25, 0.5, 0.75, 0.95)
    ) -> Table:
        """The values of a column below which these shares of the runs lie, of runs that have one."""
        names = [f"{100 * share:g} %" for share in at]
        rows = []
        for head, some in self.groups(by):
            numbers = self.numbers(some, column)
            found = np.quantile(numbers, at).tolist() if len(numbers) else [None] * len(names)
            rows.append(head | {"runs": len(numbers)} | dict(zip(names, found, strict=True)))
        return Table(rows, [*([] if by is None else [by]), "runs", *names])

    def groups(self, by: str | None) -> list[tuple[dict[str, Any], list[dict[str, Any]]]]:
        """The rows by the values of a column, in the order in which these first come; all of them where `by` is None.

        Each group begins with the column's name and value, as a row has them.
        """
        if by is None:
            return [({}, self.rows)]
        self.check(by)
        found: dict[Any, list[dict[str, Any]]] = {}
        for row in self.rows:
            found.setdefault(row[by], []).append(row)
        return [({by: value}, some) for value, some in found.items()]

    def numbers(self, rows: Sequence[dict[str, Any]], column: str) -> np.ndarray:
        """The numbers of a column, without those that are missing. Raises ExperimentError for a column of other things."""
        self.check(column)
        values = [row[column] for row in rows if row[column] is not None]
        if not all(isinstance(value, (int, float)) for value in values):
            raise ExperimentError(f"{column} does not hold numbers")
        numbers = np.array(values, float)
        return numbers[~np.isnan(numbers)]


def wilson(good: int, amount: int) -> tuple[float, float]:
    """The interval of Wilson's score for so many successes: https://doi.org/10.1080/01621459.1927.10502953 (1927)."""
    if not amount:
        return 0.0, 1.0
    z = NormalDist().inv_cdf(0.975)
    share = good / amount
    middle = (share + z * z / (2 * amount)) / (1 + z * z / amount)
    half = z / (1 + z * z / amount) * sqrt(share * (1 - share) / amount + z * z / (4 * amount * amount))
    return (0.0 if good == 0 else middle - half), (1.0 if good == amount else middle + half)


def described(function: Callable[..., Any], setting: Setting, world: dict[str, Any]) -> dict[str, Any]:
    """What is saved with the rows of an experiment; `world` is what all of its runs have in common."""
    return {
        "turtle_lesson": VERSION,
        "python": platform.python_version(),
        "numpy": version("numpy"),
        "function": f"{name_of(function)} {hash_of(function)}",
        "folders": hash_of_folders(setting.folders),
        "simulator": setting.simulator,
        "robot_time": float(setting.robot_time),
        "world": world,
    }


def endings_of(path: str | Path, runs: Sequence[Run], mine: dict[str, Any]) -> list[tuple[Run, Ending]]:
    """What came of those runs that a saved table has. Runs whose process was ended are not among them: they are tried again.

    Raises ExperimentError, which says what differs, where the table is of another experiment than `mine`.
    """
    table, theirs = read(Path(path))
    mine = mine | {"swept": list(runs[0].parameters)}
    for name in ("swept", "turtle_lesson", "function", "folders", "simulator", "robot_time", "world"):
        if theirs.get(name) != mine[name]:
            raise ExperimentError(
                f"{path} cannot be resumed: its {name} is {theirs.get(name)!r}, and that of this experiment {mine[name]!r}"
            )
    returned = [name for name in table.columns if name not in {*OWN, *mine["swept"]}]
    rows = {repr((row["seed"], *(row[name] for name in mine["swept"]))): row for row in table.rows}
    found = []
    for run in runs:
        row = rows.get(repr((run.seed, *run.parameters.values())))
        if row is not None and row["outcome"] not in (CPU_TIME, DIED):
            values = {name: row[name] for name in returned if row["outcome"] == OK}
            found.append(
                (run, Ending(row["outcome"], values, row["robot_time"], *(row[name] or "" for name in LAST[1:])))
            )
    return found


# -- the picture ---------------------------------------------------------------------------------------------------------

WIDTH, HEIGHT, LEFT, RIGHT, TOP, BOTTOM = 6.4, 3.4, 0.75, 0.25, 0.72, 0.55
"""The card, and what is around the axes, in inches."""


def _in_words(name: str, numbers: np.ndarray, runs: int) -> str:
    without = f", {runs - len(numbers)} without a value" if runs > len(numbers) else ""
    if not len(numbers):
        return f"{name}: {count(runs, 'run')}{without}."
    low, middle, high = (text_of(float(each)) for each in np.quantile(numbers, [0.25, 0.5, 0.75]))
    least, most = text_of(float(numbers.min())), text_of(float(numbers.max()))
    spread = f"median {middle}, half of them from {low} to {high}, all from {least} to {most}"
    return f"{name}: {count(runs, 'run')}{without}, {spread}."


def _picture(text: str, column: str, by: str | None, labels: list[str], parts: list[np.ndarray]) -> Picture:
    figure = drawing.card(WIDTH, HEIGHT)
    beside = "" if by is None else f" by {by}"
    amount = sum(map(len, parts))
    drawing.heading(figure, f"{column}{beside}", f"{count(amount, 'run')}  ·  median and quartiles")
    axes = drawing.axes_at(figure, LEFT, BOTTOM, WIDTH - LEFT - RIGHT, HEIGHT - TOP - BOTTOM)
    axes.set_xlim(-0.5, len(parts) - 0.5)
    axes.set_xticks(range(len(parts)), labels)
    axes.grid(visible=False, axis="x")
    axes.set_ylabel(column)
    axes.set_xlabel(by or "")
    for place, numbers in enumerate(parts):
        if len(numbers):
            low, middle, high = np.quantile(numbers, [0.25, 0.5, 0.75])
            # spread evenly, so that equal dots stay apart: by the golden ratio no two lie side by side
            aside = place + 0.5 * ((np.arange(len(numbers)) * 0.618034) % 1 - 0.5)
            axes.bar(
                place, high - low, 0.62, low, color=drawing.SKY + "40", edgecolor=drawing.SKY, linewidth=0.8, zorder=2
            )
            axes.plot(
                aside, numbers, linestyle="none", marker="o", markersize=3, color=drawing.BLUE, alpha=0.7, zorder=3
            )
            axes.plot([place - 0.31, place + 0.31], [middle] * 2, color=drawing.VERMILLION, linewidth=2, zorder=4)
    return Picture(text, figure)
