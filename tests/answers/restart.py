"""Runs each section of a page as after a restart of its kernel: the set-up cell, and then the section alone.

The sections follow one another in one folder, on the files that earlier ones left. Each has a process of its own, forked from
one that has only imported the lesson.
"""

from __future__ import annotations

import contextlib
import io
import json

from . import NOTEBOOKS
from .server import Page, forked


def sections(page: str) -> list[tuple[str, list[tuple[str, bool]]]]:
    """Each section (`## …`) that has code: its title, and its code cells, with whether an error is wanted there."""
    found: list[tuple[str, list[tuple[str, bool]]]] = []
    for cell in json.loads((NOTEBOOKS / f"{page}.ipynb").read_text(encoding="utf-8"))["cells"]:
        source = "".join(cell["source"])
        if not found or (cell["cell_type"] == "markdown" and source.startswith("## ")):
            found.append((source.partition("\n")[0], []))
        if cell["cell_type"] == "code":
            found[-1][1].append((source, "raises-exception" in cell["metadata"].get("tags", [])))
    return [section for section in found if section[1]]


def problem(page: Page, cells: list[tuple[str, bool]]) -> str:
    """Run cells; the first error that is not wanted and what was printed as one, or ""."""
    printed, errors = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(printed), contextlib.redirect_stderr(errors):
        for source, wanted in cells:
            done = page.run(source)
            error = done.error_before_exec or done.error_in_exec
            if error is not None and not wanted:
                return f"{type(error).__name__}: {error}\nin:\n{source}\n{printed.getvalue()[-2000:]}"
    return errors.getvalue() if "Traceback" in errors.getvalue() else ""


def problem_in_a_child(page: Page, cells: list[tuple[str, bool]]) -> str:
    """The problem of these cells, run in a fork of this process."""
    said, status = forked(lambda: problem(page, cells))
    return said or (f"the process ended with status {status}" if status else "")


def problems(page: Page, name: str) -> dict[str, str]:
    """What went wrong in a page, by the titles of its sections."""
    (title, opening), *later = sections(name)
    found = {title: problem_in_a_child(page, opening)}
    found |= {title: problem_in_a_child(page, [opening[0], *cells]) for title, cells in later}
    return {title: text for title, text in found.items() if text}
