"""What comes out of an experiment: a row for each run, in the order of the runs, whatever workers carried them out."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..lab.words import count, enumerated
from .one_run import OK, OPTIONS, Ending, ExperimentError, Run, Setting
from .table import Table

if TYPE_CHECKING:
    from ..lab.picture import Picture
    from .replay import Replay
    from .shrink import Smallest

FIRST = ("run", "seed")
LAST = ("robot_time", "error", "traceback", "printed")
"""The columns at the beginning, and at the end. Between them are what was swept, the outcome and what the function returned."""


class Results(Table):
    """The rows of an experiment. `results["seconds"]` is a column as a numpy array: nan where a run has failed.

    Attributes:
        rows: a dict for each run: its number and seed, what was swept, `outcome` ("ok", "raised", "robot time", "CPU time" or
            "worker died"), what the function has returned, and then `robot_time` (s), `error`, `traceback` and `printed`.
        columns: the names in that order.
        swept: the names of those that were inputs.
        missing: how many runs were not carried out, since the experiment was stopped.
        about: versions, hashes and settings, which are saved with the rows.
        function, setting: what was run; None where the rows were read from a file.
    """

    def __init__(
        self,
        rows: Iterable[dict[str, Any]],
        columns: Sequence[str],
        *,
        swept: Sequence[str] = (),
        about: dict[str, Any] | None = None,
        missing: int = 0,
        function: Callable[..., Any] | None = None,
        setting: Setting | None = None,
    ) -> None:
        super().__init__(rows, columns)
        self.swept, self.about, self.missing = list(swept), about or {}, missing
        self.function, self.setting = function, setting
        self.found: Smallest | None = None

    @classmethod
    def of(cls, endings: Iterable[tuple[Run, Ending]], swept: Sequence[str], **more: Any) -> Results:
        """The table of what came of some runs; `swept` names the inputs that are columns."""
        done = sorted(endings, key=lambda each: each[0].number)
        values = list(dict.fromkeys(name for _, ending in done for name in ending.values))
        rows = [_row(run, ending, swept, values) for run, ending in done]
        return cls(rows, [*FIRST, *swept, "outcome", *values, *LAST], swept=swept, **more)

    # -- parts -------------------------------------------------------------------------------------------------------

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
        return Results(
            rows, self.columns, swept=self.swept, about=self.about, function=self.function, setting=self.setting
        )

    @cached_property
    def runs(self) -> dict[int, Run]:
        """By number, the run of each row."""
        return {row["run"]: run_of(row, self.swept, self.about.get("world", {})) for row in self.rows}

    def row_of(self, run: Run, ending: Ending) -> dict[str, Any]:
        """The row that this table would have for what came of a run."""
        inputs = {*FIRST, *self.swept, "outcome", *LAST}
        known = [name for name in self.columns if name not in inputs]
        return _row(run, ending, self.swept, list(dict.fromkeys([*known, *ending.values])))

    @property
    def summary(self) -> str:
        """How many runs there are, and which of them failed, in a sentence."""
        failed = [str(row["run"]) for row in self.failed]
        said = f"{len(failed)} failed: {enumerated(failed)}" if failed else "none failed"
        return f"{count(len(self), 'run')}, {said}" + (f"; {self.missing} not carried out" if self.missing else "")

    @property
    def smallest(self) -> dict[str, Any] | None:
        """What `until="failure"` has found: the values that differ from the first ones in the smallest change that still fails.

        None where nothing failed, or nothing was looked for.
        """
        return None if self.found is None else self.found.change

    def replay(self, number: int | str | None = None, function: Callable[..., Any] | None = None) -> Replay:
        """Open a run in this notebook, as it was, to go on step by step: the first one that failed, unless told.

        "smallest" is the run with the smallest change that `until="failure"` has found. A table that was read from a file does
        not hold the function: it must be given. Raises ExperimentError where there is no such run.
        """
        from .replay import replay_of

        return replay_of(self, number, function)

    # -- files -------------------------------------------------------------------------------------------------------

    def save(self, path: str | Path) -> Path:
        """Write the table to a file, "runs.csv" or "runs.parquet", with versions and settings; `experiment(resume=…)` reads it.

        In a CSV file these are the lines at its beginning that start with "#": `pandas.read_csv(path, comment="#")` passes
        over them. Raises ExperimentError for another kind of file.
        """
        from .storage import save

        return save(self, self.about | {"swept": self.swept, "missing": self.missing}, Path(path))

    @staticmethod
    def read(path: str | Path) -> Results:
        """The table of a file that `save` has written. Raises ExperimentError where it is none."""
        from .storage import read

        table, about = read(Path(path))
        try:
            swept, missing = about.pop("swept"), about.pop("missing")
        except KeyError:
            raise ExperimentError(f"{path} is no table of an experiment") from None
        return Results(table.rows, table.columns, swept=swept, about=about, missing=missing)

    # -- statistics --------------------------------------------------------------------------------------------------

    def plot(self, column: str, by: str | None = None) -> Picture:
        """A dot for each run, with quartiles and median; `by` names a column whose values are drawn side by side."""
        from .pictures import plot

        return plot(self, column, by)

    def rate(self, by: str | None = None) -> Table:
        """How many runs ended well: the share, and the interval in which the true rate lies, with 95 % confidence.

        The interval is Wilson's score interval, which is right for few runs and rates near 0 or 1, too: E. B. Wilson,
        "Probable inference, the law of succession, and statistical inference", Journal of the American Statistical
        Association 22 (1927), pages 209 to 212.
        """
        from .pictures import rate

        return rate(self, by)

    def quantiles(
        self, column: str, by: str | None = None, at: Sequence[float] = (0.05, 0.25, 0.5, 0.75, 0.95)
    ) -> Table:
        """The values of a column below which these shares of the runs lie, of runs that have one."""
        from .pictures import quantiles

        return quantiles(self, column, by, at)


def _row(run: Run, ending: Ending, swept: Sequence[str], values: Sequence[str]) -> dict[str, Any]:
    row: dict[str, Any] = {"run": run.number, "seed": run.seed}
    row |= {name: run.value_of(name) for name in swept}
    row["outcome"] = ending.outcome
    row |= {name: ending.values.get(name) for name in values}
    row["robot_time"] = ending.robot_time
    return row | {name: getattr(ending, name) or None for name in LAST[1:]}


def run_of(row: dict[str, Any], swept: Sequence[str], world: dict[str, Any]) -> Run:
    """The run that a row is of; `world` is what was not swept."""
    given = {name: row[name] for name in swept}
    parameters = {name: value for name, value in given.items() if name not in OPTIONS}
    return Run(
        row["run"], row["seed"], parameters, **(world | {name: given[name] for name in OPTIONS if name in given})
    )


def ending_of(row: dict[str, Any], swept: Sequence[str]) -> Ending:
    """What came of the run that a row is of."""
    inputs = {*FIRST, *swept, "outcome", *LAST}
    values = {name: value for name, value in row.items() if name not in inputs} if row["outcome"] == OK else {}
    return Ending(row["outcome"], values, row["robot_time"], *(row[name] or "" for name in LAST[1:]))
