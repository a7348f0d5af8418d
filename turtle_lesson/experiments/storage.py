"""Tables in files: CSV that any program reads, or Parquet; with versions and settings, and every value as it was."""

from __future__ import annotations

import csv
import io
import json
import platform
from collections.abc import Callable, Sequence
from importlib.metadata import version
from itertools import takewhile
from pathlib import Path
from typing import Any

from ..lab.words import listed
from ..ros.runtime import files
from .one_run import CPU_TIME, DIED, OPTIONS, VERSION, Ending, ExperimentError, Run, Setting, name_of, plain
from .payload import hash_of, hash_of_folders
from .results import Results, ending_of

KEY = b"turtle_lesson"
"""What a Parquet file's metadata calls ours."""


def about(function: Callable[..., Any], setting: Setting, world: dict[str, Any]) -> dict[str, Any]:
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


# -- files ---------------------------------------------------------------------------------------------------------------


def save(results: Results, path: Path) -> Path:
    """Write a table to a CSV or Parquet file."""
    kinds = {column: _kind([row[column] for row in results.rows]) for column in results.columns}
    head = results.about | {"swept": results.swept, "missing": results.missing, "columns": kinds}
    cells = [{name: _cell(row[name], kind) for name, kind in kinds.items()} for row in results.rows]
    if path.suffix.lower() == ".csv":
        files.write(path, _as_csv(head, cells))
    elif path.suffix.lower() == ".parquet":
        arrow, parquet = _pyarrow()
        types = {"int": arrow.int64(), "float": arrow.float64(), "bool": arrow.bool_()}
        fields = [(name, types.get(kind, arrow.string())) for name, kind in kinds.items()]
        schema = arrow.schema(fields, metadata={KEY: json.dumps(head)})
        parquet.write_table(arrow.Table.from_pylist(cells, schema=schema), path)
    else:
        raise ExperimentError(f'a table is saved as "….csv" or "….parquet", got {str(path)!r}')
    return path


def read(path: Path) -> Results:
    """Read a table from a CSV or Parquet file."""
    try:
        head, rows = _from_parquet(path) if path.suffix.lower() == ".parquet" else _from_csv(path)
        kinds, swept, missing = head.pop("columns"), head.pop("swept"), head.pop("missing")
        rows = [{name: _value(row[name], kind) for name, kind in kinds.items()} for row in rows]
    except FileNotFoundError:
        raise ExperimentError(f"there is no file {path}") from None
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise ExperimentError(f"{path} is no table that results.save() has written ({error})") from None
    return Results(rows, list(kinds), swept=swept, about=head, missing=missing)


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


# -- going on with an experiment -----------------------------------------------------------------------------------------


def known(path: Path, runs: Sequence[Run], swept: Sequence[str], mine: dict[str, Any]) -> list[tuple[Run, Ending]]:
    """What came of those runs that a saved table has. Runs whose process was ended are not among them: they are tried again.

    Raises ExperimentError, which says what differs, where the table is of another experiment.
    """
    table = read(path)
    theirs = table.about
    if table.swept != list(swept):
        raise ExperimentError(
            f"{path} cannot be resumed: it sweeps {listed(table.swept) or 'nothing'}, and this experiment "
            f"{listed(list(swept)) or 'nothing'}"
        )
    for name in ("turtle_lesson", "function", "folders", "simulator", "robot_time", "world"):
        if theirs.get(name) != mine[name]:
            raise ExperimentError(
                f"{path} cannot be resumed: its {name} is {theirs.get(name)!r}, and that of this experiment {mine[name]!r}"
            )
    rows = {_inputs(row["seed"], [row[name] for name in swept]): row for row in table.rows}
    found = []
    for run in runs:
        given = [getattr(run, name) if name in OPTIONS else run.parameters[name] for name in swept]
        row = rows.get(_inputs(run.seed, given))
        if row is not None and row["outcome"] not in (CPU_TIME, DIED):
            found.append((run, ending_of(row, swept)))
    return found


def _inputs(seed: int, values: Sequence[Any]) -> str:
    return repr((seed, *values))
