"""Tables in files: CSV that any program reads, or Parquet; with what belongs to them, and every value as it was."""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Sequence
from itertools import takewhile
from pathlib import Path
from typing import Any

from ..ros.runtime import files
from .one_run import ExperimentError, plain
from .table import Table

KEY = b"turtle_lesson"
"""What a Parquet file's metadata calls ours."""


def save(table: Table, head: dict[str, Any], path: Path) -> Path:
    """Write a table to a CSV or Parquet file, and what else is known of it: by name, what JSON can hold."""
    check_suffix(path)
    kinds = {column: _kind([row[column] for row in table.rows]) for column in table.columns}
    head = head | {"columns": kinds}
    cells = [{name: _cell(row[name], kind) for name, kind in kinds.items()} for row in table.rows]
    if path.suffix.lower() == ".csv":
        files.write(path, _as_csv(head, cells))
    else:
        arrow, parquet = _pyarrow()
        types = {"int": arrow.int64(), "float": arrow.float64(), "bool": arrow.bool_()}
        fields = [(name, types.get(kind, arrow.string())) for name, kind in kinds.items()]
        schema = arrow.schema(fields, metadata={KEY: json.dumps(head)})
        parquet.write_table(arrow.Table.from_pylist(cells, schema=schema), path)
    return path


def check_suffix(path: Path) -> None:
    """Raise ExperimentError for a file that no table is saved in."""
    if path.suffix.lower() not in (".csv", ".parquet"):
        raise ExperimentError(f'a table is saved as "….csv" or "….parquet", got {str(path)!r}')


def read(path: Path) -> tuple[Table, dict[str, Any]]:
    """Read a table from a CSV or Parquet file, and what else was saved with it."""
    try:
        head, cells = _from_parquet(path) if path.suffix.lower() == ".parquet" else _from_csv(path)
        kinds = head.pop("columns")
        return Table(
            [{name: _value(row[name], kind) for name, kind in kinds.items()} for row in cells], list(kinds)
        ), head
    except FileNotFoundError:
        raise ExperimentError(f"there is no file {path}") from None
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise ExperimentError(f"{path} is no table that results.save() has written ({error})") from None


def _as_csv(head: dict[str, Any], rows: list[dict[str, Any]]) -> str:
    text = io.StringIO(newline="")
    text.writelines(f"# {name}: {json.dumps(value)}\n" for name, value in head.items())
    writer = csv.DictWriter(text, list(head["columns"]), lineterminator="\n")
    writer.writeheader()
    writer.writerows(rows)
    return text.getvalue()


def _from_csv(path: Path) -> tuple[dict[str, Any], list[dict[str, Any]]]:
    lines = path.read_text(encoding="utf-8").split("\n")
    about = list(takewhile(lambda line: line.startswith("# "), lines))
    head = {name: json.loads(value) for name, _, value in (line[2:].partition(": ") for line in about)}
    return head, list(csv.DictReader(line + "\n" for line in lines[len(about) :]))


def _from_parquet(path: Path) -> tuple[dict[str, Any], list[dict[str, Any]]]:
    table = _pyarrow()[1].read_table(path)
    return json.loads((table.schema.metadata or {})[KEY]), table.to_pylist()


def _pyarrow() -> tuple[Any, Any]:
    try:
        import pyarrow
        from pyarrow import parquet
    except ImportError:
        raise ExperimentError("Parquet files need pyarrow, which is not installed here: save a .csv instead") from None
    return pyarrow, parquet


# -- values --------------------------------------------------------------------------------------------------------------
# A column of one type is written as it is. One that holds several types, tuples or texts that a CSV file would change is
# written as JSON.


def _kind(values: Sequence[Any]) -> str:
    types = {type(value) for value in values if value is not None}
    if types <= {str} and not any(value == "" or "\r" in value for value in values if value is not None):
        return "text"
    if types == {int} and all(value is None or abs(value) < 2**63 for value in values):
        return "int"
    return "float" if types == {float} else "bool" if types == {bool} else "json"


def _cell(value: Any, kind: str) -> Any:
    return value if value is None or kind != "json" else json.dumps(value)


def _value(cell: Any, kind: str) -> Any:
    """The value of a cell, which is a text if it comes from a CSV file."""
    if cell is None or cell == "":
        return None
    if kind == "json":
        return plain(json.loads(cell))
    if not isinstance(cell, str) or kind == "text":
        return cell
    return int(cell) if kind == "int" else float(cell) if kind == "float" else cell == "True"
