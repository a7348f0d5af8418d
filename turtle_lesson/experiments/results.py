"""The table of an experiment: a row for each run, whatever worker it came from."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import TYPE_CHECKING, Any

from ..lab.words import count, did_you_mean, enumerated
from .one_run import OK, Ending, ExperimentError, Run, Setting

if TYPE_CHECKING:
    import numpy as np

MOST_ROWS = 20
"""Rows that are printed."""

LAST = ("robot_time", "error", "traceback", "printed")
"""The columns at the end."""

LONG = ("traceback", "printed")
"""The columns that are not printed."""


class Results:
    """The rows of an experiment, in the order of its runs; each is a dict.

    `results["seconds"]` is a column as a numpy array.
    """

    def __init__(
        self,
        rows: Iterable[dict[str, Any]],
        columns: Sequence[str],
        *,
        function: Callable[..., Any] | None = None,
        setting: Setting | None = None,
        runs: Sequence[Run] = (),
        missing: int = 0,
    ) -> None:
        self.rows = list(rows)
        self.columns = list(columns)
        self.missing = missing
        self.function, self.setting = function, setting
        self.runs = {run.number: run for run in runs}

    @classmethod
    def of(cls, endings: Iterable[tuple[Run, Ending]], swept: Sequence[str], **more: Any) -> Results:
        """The table of what came of some runs; `swept` names the inputs that are columns."""
        done = sorted(endings, key=lambda each: each[0].number)
        values = list(dict.fromkeys(name for _, ending in done for name in ending.values))
        columns = ["run", "seed", *swept, "outcome", *values, *LAST]
        rows = [_row(run, ending, swept, values) for run, ending in done]
        return cls(rows, columns, runs=[run for run, _ in done], **more)

    def __len__(self) -> int:
        return len(self.rows)

    def __iter__(self) -> Iterator[dict[str, Any]]:
        return iter(self.rows)

    def __getitem__(self, column: str) -> np.ndarray:
        import numpy as np

        self._check(column)
        values = [row[column] for row in self.rows]
        numbers = all(value is None or isinstance(value, (bool, int, float)) for value in values)
        if not numbers:
            return np.array(values, dtype=object)
        return np.array([np.nan if value is None else value for value in values])

    def where(self, **values: Any) -> Results:
        """The rows in which columns have these values."""
        for column in values:
            self._check(column)
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
        some = Results(rows, self.columns, function=self.function, setting=self.setting)
        some.runs = self.runs
        return some

    def _check(self, column: str) -> None:
        if column not in self.columns:
            guess = did_you_mean(str(column), self.columns)
            raise ExperimentError(f"there is no column {column!r}. {guess or f'There are {enumerated(self.columns)}.'}")

    def __repr__(self) -> str:
        shown = [column for column in self.columns if column not in LONG]
        rows = [[_text(row[column]) for column in shown] for row in self.rows[:MOST_ROWS]]
        widths = [max(map(len, cells)) for cells in zip(shown, *rows, strict=True)]
        lines = [
            "  ".join(cell.rjust(width) for cell, width in zip(cells, widths, strict=True)) for cells in [shown, *rows]
        ]
        if len(self.rows) > MOST_ROWS:
            lines.append("…")
        return "\n".join([*map(str.rstrip, lines), self.summary])

    @property
    def summary(self) -> str:
        """How many runs there are, and which of them failed, in a sentence."""
        failed = [str(row["run"]) for row in self.failed]
        text = (
            f"{count(len(self), 'run')}, {f'{len(failed)} failed: {enumerated(failed)}' if failed else 'none failed'}"
        )
        return f"{text}; {self.missing} not carried out" if self.missing else text


def _row(run: Run, ending: Ending, swept: Sequence[str], values: Sequence[str]) -> dict[str, Any]:
    row: dict[str, Any] = {"run": run.number, "seed": run.seed}
    for name in swept:
        row[name] = run.parameters[name] if name in run.parameters else getattr(run, name)
    row["outcome"] = ending.outcome
    row |= {name: ending.values.get(name) for name in values}
    return row | {name: getattr(ending, name) or None if name != "robot_time" else ending.robot_time for name in LAST}


def _text(value: Any) -> str:
    if value is None:
        return ""
    if isinstance(value, float):
        return f"{value:.4g}"
    text = str(value)
    return text if len(text) <= 60 else f"{text[:59]}…"
