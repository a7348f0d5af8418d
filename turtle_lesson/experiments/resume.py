"""What makes an experiment the same: versions, the function's source, folders and settings. Rows of the same one are kept."""

from __future__ import annotations

import platform
from collections.abc import Callable, Sequence
from importlib.metadata import version
from pathlib import Path
from typing import Any

from ..lab.words import listed
from .one_run import CPU_TIME, DIED, VERSION, Ending, ExperimentError, Run, Setting, name_of
from .payload import hash_of, hash_of_folders
from .results import Results, ending_of


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


def rows_of(
    path: str | Path, runs: Sequence[Run], swept: Sequence[str], mine: dict[str, Any]
) -> list[tuple[Run, Ending]]:
    """What came of those runs that a saved table has. Runs whose process was ended are not among them: they are tried again.

    Raises ExperimentError, which says what differs, where the table is of another experiment.
    """
    table = Results.read(path)
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
        given = [run.value_of(name) for name in swept]
        row = rows.get(_inputs(run.seed, given))
        if row is not None and row["outcome"] not in (CPU_TIME, DIED):
            found.append((run, ending_of(row, swept)))
    return found


def _inputs(seed: int, values: Sequence[Any]) -> str:
    return repr((seed, *values))
