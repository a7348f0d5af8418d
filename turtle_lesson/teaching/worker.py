"""Runs one copy of a page in a kernel, and writes what its checks said into a file: `worker NOTEBOOK ANSWER FOLDER SECONDS`.

A cell that takes too long is interrupted, and the next ones are run all the same; a kernel that does not listen is killed.
"""

from __future__ import annotations

import asyncio
import json
import logging
import re
import sys
import warnings
from pathlib import Path
from typing import Any

from nbclient import NotebookClient
from nbclient.exceptions import DeadKernelError
from nbclient.util import ensure_async

from ..lab.checks.result import METADATA
from .pages import PageError, clear, page_of, read

SHARE = 0.4
"""What part of the copy's time one cell may take."""

ASKED = re.compile(r"\.check\(\s*[\"'](\w+)[\"']")
"""A call of `lesson.check` in a cell."""

ROW = ("mark", "expected", "seen", "next")
NOISE = ("stream", "update_display_data", "clear_output")
"""Outputs that nobody reads here: an endless one would fill the memory."""


class Runner(NotebookClient):
    """Runs cells, and keeps only the outputs that may hold the result of a check, or an error."""

    def output(self, outs: Any, msg: Any, display_id: Any, cell_index: int) -> Any:
        """Take an output, unless it is noise."""
        if msg["msg_type"] in NOISE or len(outs) >= 100:
            return None
        return super().output(outs, msg, display_id, cell_index)


def main(arguments: list[str]) -> None:
    """Run a copy and write the answer."""
    notebook, answer, folder, seconds = arguments
    logging.disable(logging.CRITICAL)
    warnings.simplefilter("ignore")
    found = examine(Path(notebook), Path(folder), float(seconds))
    Path(answer).write_text(json.dumps(found), encoding="utf-8")


def examine(path: Path, folder: Path, seconds: float) -> dict[str, Any]:
    """Run a copy for at most `seconds`: its page, the checks that it asks for, their results, and what went wrong."""
    try:
        notebook = clear(read(path))
    except PageError as error:
        reason = str(error).removeprefix(f"{path} ")
        return {"problem": reason, "page": page_of(path)}
    problem = _run(notebook, folder, seconds)
    return {
        "page": page_of(path, notebook),
        "asked": [name for cell in notebook.cells if cell.cell_type == "code" for name in ASKED.findall(cell.source)],
        "results": results_in(notebook),
        "errors": errors_in(notebook, seconds),
        "problem": problem,
    }


def _run(notebook: Any, folder: Path, seconds: float) -> str:
    """Run all cells; returns why that did not come to its end, or ""."""
    client = Runner(
        notebook,
        timeout=max(1, round(SHARE * seconds)),
        interrupt_on_timeout=True,
        allow_errors=True,
        kernel_name="python3",
        shutdown_kernel="immediate",
        resources={"metadata": {"path": str(folder)}},
    )
    try:
        asyncio.run(_limited(client, seconds))
    except TimeoutError:
        return f"it had not finished after {seconds:g} s, and was stopped"
    except DeadKernelError:
        return "its kernel died"
    except Exception as error:  # whatever a damaged notebook can do to the one that runs it
        return f"it could not be run: {type(error).__name__}: {' '.join(str(error).split())[:120]}"
    return ""


async def _limited(client: Runner, seconds: float) -> None:
    running = asyncio.ensure_future(client.async_execute())
    try:
        done, _ = await asyncio.wait({running}, timeout=seconds)
        if not done:
            raise TimeoutError
        running.result()
    finally:
        running.cancel()
        if client.km is not None and client.km.has_kernel:
            await ensure_async(client.km.shutdown_kernel(now=True))


def results_in(notebook: Any) -> dict[str, dict[str, Any]]:
    """The result of each check that was shown; of one that was asked several times a good one counts."""
    found: dict[str, dict[str, Any]] = {}
    for _, output in _outputs(notebook):
        figures = output.get("metadata", {}).get(METADATA)
        if not isinstance(figures, dict) or not isinstance(figures.get("rows"), list):
            continue
        name, passed = str(figures.get("name")), figures.get("passed") is True
        if passed or not found.get(name, {}).get("passed"):
            found[name] = {"passed": passed, "rows": [_row(each) for each in figures["rows"]]}
    return found


def _row(row: Any) -> dict[str, str]:
    return {key: str(row.get(key, "")) if isinstance(row, dict) else "" for key in ROW}


def errors_in(notebook: Any, seconds: float) -> list[str]:
    """The cells that raised something, in words; those that are meant to are left out."""
    found = []
    for cell, output in _outputs(notebook):
        if output.output_type != "error" or "raises-exception" in cell.metadata.get("tags", []):
            continue
        number = notebook.cells.index(cell) + 1
        if output.ename == "KeyboardInterrupt":
            found.append(f"cell {number} took more than {round(SHARE * seconds)} s, and was stopped")
        else:
            found.append(f"cell {number} raised {output.ename}: {' '.join(output.evalue.split())[:120]}")
    return found


def _outputs(notebook: Any) -> list[tuple[Any, Any]]:
    return [(cell, output) for cell in notebook.cells if cell.cell_type == "code" for output in cell.outputs]


if __name__ == "__main__":
    main(sys.argv[1:])
