"""A table: rows as dicts, columns as arrays; what print and a notebook show; a CSV file of it."""

from __future__ import annotations

import csv
import html
import io
import json
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ..lab.words import did_you_mean, enumerated, shortened
from ..ros.runtime import files
from .one_run import ExperimentError

MOST_ROWS = 20
"""Rows that are shown."""

WIDEST = 60
"""Characters of a value that are shown."""

HIDDEN = ("traceback", "printed")
"""Columns of long texts, which are not shown."""

AT_TIMES = ("error",)
"""Columns that are shown if there is anything in them."""


class Table:
    """Rows, each a dict with the same keys. `table["seconds"]` is a column as a numpy array, in which None is nan."""

    def __init__(self, rows: Iterable[dict[str, Any]], columns: Sequence[str]) -> None:
        self.rows = list(rows)
        self.columns = list(columns)

    def __len__(self) -> int:
        return len(self.rows)

    def __iter__(self) -> Iterator[dict[str, Any]]:
        return iter(self.rows)

    def __getitem__(self, column: str) -> np.ndarray:
        self.check(column)
        values = [row[column] for row in self.rows]
        kinds = {type(value) for value in values} - {type(None)}
        if kinds == {bool} and None not in values:
            return np.array(values)
        if kinds <= {bool, int, float}:
            return np.array([np.nan if value is None else value for value in values])
        array = np.empty(len(values), object)
        array[:] = values
        return array

    @property
    def summary(self) -> str:
        """A sentence below the rows."""
        return ""

    def check(self, column: str) -> None:
        """Raise ExperimentError, which is a ValueError, if there is no such column."""
        if column not in self.columns:
            there = did_you_mean(str(column), self.columns) or f"There are {enumerated(self.columns)}."
            raise ExperimentError(f"there is no column {column!r}. {there}")

    def __repr__(self) -> str:
        head, rows = self._shown()
        widths = [max(map(len, cells)) for cells in zip(head, *rows, strict=True)]
        lines = ["  ".join(map(str.rjust, cells, widths)) for cells in [head, *rows]]
        more = ["…"] if len(self.rows) > MOST_ROWS else []
        return "\n".join([*map(str.rstrip, lines), *more, *filter(None, [self.summary])])

    def _repr_html_(self) -> str:
        head, rows = self._shown()
        titles = "".join(f"<th>{html.escape(each)}</th>" for each in head)
        body = "".join(f"<tr>{''.join(f'<td>{html.escape(cell)}</td>' for cell in cells)}</tr>" for cells in rows)
        more = f'<tr><td colspan="{len(head)}">…</td></tr>' if len(self.rows) > MOST_ROWS else ""
        below = f"<p>{html.escape(self.summary)}</p>" if self.summary else ""
        return f"<table><thead><tr>{titles}</tr></thead><tbody>{body}{more}</tbody></table>{below}"

    def _shown(self) -> tuple[list[str], list[list[str]]]:
        """The heads and cells that are shown, as texts."""
        rows = self.rows[:MOST_ROWS]
        empty = {name for name in AT_TIMES if all(row.get(name) is None for row in rows)}
        shown = [name for name in self.columns if name not in HIDDEN and name not in empty]
        return shown, [[text_of(row[name]) for name in shown] for row in rows]


def text_of(value: Any) -> str:
    """A value as it is shown: numbers with five digits, long texts cut."""
    if value is None:
        return ""
    text = f"{value:.5g}" if isinstance(value, float) else " ".join(str(value).split())
    return shortened(text, WIDEST)


# -- files ---------------------------------------------------------------------------------------------------------------


def save(table: Table, head: dict[str, Any], path: Path) -> Path:
    """Write a table to a CSV file, below lines that begin with "#": what else is known of it, as JSON."""
    check_suffix(path)
    text = io.StringIO(newline="")
    text.writelines(f"# {name}: {json.dumps(value)}\n" for name, value in head.items())
    writer = csv.DictWriter(text, table.columns, lineterminator="\n")
    writer.writeheader()
    writer.writerows(table.rows)
    files.write(path, text.getvalue())
    return path


def check_suffix(path: Path) -> None:
    """Raise ExperimentError for a file that no table is saved in."""
    if path.suffix.lower() != ".csv":
        raise ExperimentError(f'a table is saved as "….csv", got {str(path)!r}')
