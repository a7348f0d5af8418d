"""A table: rows as dicts, columns as arrays; what print and a notebook show; CSV and Parquet files of it."""

from __future__ import annotations

import csv
import html
import io
import json
from collections.abc import Iterable, Iterator, Sequence
from itertools import takewhile
from pathlib import Path
from typing import Any

import numpy as np

from ..lab.words import shortened, suggestion
from ..ros.runtime import files
from .one_run import ExperimentError, plain

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
            raise ExperimentError(f"there is no column {column!r}. {suggestion(str(column), self.columns)}")

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


KEY = b"turtle_lesson"
"""What a Parquet file's metadata calls ours."""


def save(table: Table, head: dict[str, Any], path: Path) -> Path:
    """Write a table to a CSV or Parquet file; `head` is what else is known of it, by name, as JSON can hold it.

    A column of one type is written as it is; one that holds several types, tuples or odd texts, as JSON.
    """
    check_suffix(path)
    kinds = {column: _kind([row[column] for row in table.rows if row[column] is not None]) for column in table.columns}
    head = head | {"columns": kinds}
    cells = [
        {
            name: json.dumps(row[name]) if kind == "json" and row[name] is not None else row[name]
            for name, kind in kinds.items()
        }
        for row in table.rows
    ]
    if path.suffix.lower() == ".csv":
        text = io.StringIO(newline="")
        text.writelines(f"# {name}: {json.dumps(value)}\n" for name, value in head.items())
        writer = csv.DictWriter(text, list(kinds), lineterminator="\n")
        writer.writeheader()
        writer.writerows(cells)
        files.write(path, text.getvalue())
    else:
        arrow, parquet = _pyarrow()
        parquet.write_table(arrow.Table.from_pylist(cells).replace_schema_metadata({KEY: json.dumps(head)}), path)
    return path


def check_suffix(path: Path) -> None:
    """Raise ExperimentError for a file that no table is saved in."""
    if path.suffix.lower() not in (".csv", ".parquet"):
        raise ExperimentError(f'a table is saved as "….csv" or "….parquet", got {str(path)!r}')


def read(path: Path) -> tuple[Table, dict[str, Any]]:
    """Read a table that `save` has written, and what else was saved with it. Raises ExperimentError where it is none."""
    try:
        if path.suffix.lower() == ".parquet":
            arrow = _pyarrow()[1].read_table(path)
            head, cells = json.loads((arrow.schema.metadata or {})[KEY]), arrow.to_pylist()
        else:
            lines = path.read_text(encoding="utf-8").split("\n")
            about = list(takewhile(lambda line: line.startswith("# "), lines))
            head = {name: json.loads(value) for name, _, value in (line[2:].partition(": ") for line in about)}
            cells = list(csv.DictReader(f"{line}\n" for line in lines[len(about) :]))
        kinds = head.pop("columns")
        rows = [{name: _value(row[name], kind) for name, kind in kinds.items()} for row in cells]
    except FileNotFoundError:
        raise ExperimentError(f"there is no file {path}") from None
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise ExperimentError(f"{path} is no table that results.save() has written ({error})") from None
    return Table(rows, list(kinds)), head


def _pyarrow() -> tuple[Any, Any]:
    try:
        import pyarrow
        from pyarrow import parquet
    except ImportError:
        raise ExperimentError("Parquet files need pyarrow, which is not installed here: save a .csv instead") from None
    return pyarrow, parquet


def _kind(values: Sequence[Any]) -> str:
    kind = {type(value).__name__ for value in values}
    if kind == {"int"} and any(abs(value) >= 2**63 for value in values):
        return "json"
    if kind <= {"str"}:
        return "json" if any(value == "" or "\r" in value for value in values) else "str"
    return kind.pop() if kind in ({"int"}, {"float"}, {"bool"}) else "json"


def _value(cell: Any, kind: str) -> Any:
    """The value of a cell, which is a text if it comes from a CSV file."""
    if cell is None or cell == "":
        return None
    if kind == "str" or not isinstance(cell, str):
        return cell
    if kind == "bool":
        return {"True": True, "False": False}[cell]  # a spreadsheet may have made TRUE of it
    return float(cell) if kind == "float" else plain(json.loads(cell))
