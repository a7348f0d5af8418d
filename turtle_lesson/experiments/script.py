"""What `turtle-lesson run` does: run a script that calls `experiment(…)`, and print and save its tables."""

from __future__ import annotations

import runpy
import sys
from pathlib import Path

from ..ros.sim.errors import print_error
from .experiment import Defaults, defaults
from .one_run import ExperimentError
from .results import Results
from .storage import check_suffix


def run_script(path: Path, jobs: int | None = None, table: Path | None = None) -> int:
    """Run a script, and return the exit code: 0 if all runs of its experiments ended well, or else 1.

    Args:
        path: the script. The tables of its experiments are printed.
        jobs: how many worker processes an experiment has that does not say so itself.
        table: the file to save the table in; those of further experiments go to files beside it: runs.csv, runs-2.csv …

    Raises ExperimentError where there is no such script, or no table can be saved in such a file.
    """
    if not path.is_file():
        raise ExperimentError(f"there is no script {path}")
    if table is not None:
        check_suffix(table)
    seen: list[Results] = []

    def finished(results: Results) -> None:
        seen.append(results)
        print(results, flush=True)
        if table is not None:
            path = table if len(seen) == 1 else table.with_stem(f"{table.stem}-{len(seen)}")
            print(f"saved as {results.save(path)}", flush=True)

    token = defaults.set(Defaults(jobs, finished))
    arguments, folders = sys.argv, sys.path[:]
    sys.argv, sys.path[0:1] = [str(path)], [str(path.resolve().parent)]
    ended_well = True
    try:
        runpy.run_path(str(path), run_name="__main__")
    except ExperimentError as error:
        print(f"turtle-lesson run: {error}", file=sys.stderr)
        ended_well = False
    except SystemExit as error:
        ended_well = error.code in (None, 0)
        if isinstance(error.code, str):
            print(error.code, file=sys.stderr)
    except Exception as error:
        print_error(error)
        ended_well = False
    finally:
        sys.argv, sys.path[:] = arguments, folders
        defaults.reset(token)
    if ended_well and not seen:
        print(f"turtle-lesson run: {path} carries out no experiment", file=sys.stderr)
    return 0 if ended_well and seen and not any(results.missing or len(results.failed) for results in seen) else 1
