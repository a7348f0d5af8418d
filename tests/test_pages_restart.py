"""A page whose kernel was restarted: the set-up cell and then any section, on the files that earlier sections left."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import nbformat
import pytest
from test_pages import PAGES, copy_of, run

LESSONS = [page for page in PAGES if page.stem[0].isdigit()]


def sections(page: Path) -> list[tuple[str, list[Any]]]:
    """The title and the code cells of each section (`## …`) that has code, in order; the first has the page's title."""
    found: list[tuple[str, list[Any]]] = []
    for cell in nbformat.read(page, as_version=4).cells:
        if not found or (cell.cell_type == "markdown" and cell.source.startswith("## ")):
            found.append((cell.source.splitlines()[0], []))
        if cell.cell_type == "code":
            found[-1][1].append(cell)
    return [section for section in found if section[1]]


@pytest.mark.parametrize("page", LESSONS, ids=lambda page: page.stem)
@pytest.mark.filterwarnings("ignore::DeprecationWarning")
def test_each_section_runs_after_a_restart(page: Path, tmp_path: Path) -> None:
    (_, opening), *later = sections(page)
    set_up = opening[0]
    assert set_up.source.startswith("%load_ext turtle_lesson"), "a page begins with its set-up cell"
    assert len(set_up.source.splitlines()) <= 3
    run([copy_of(cell) for cell in opening], tmp_path)
    for title, cells in later:
        executed = run([copy_of(cell) for cell in (set_up, *cells)], tmp_path)  # a kernel of its own
        said = "".join(output.text for cell in executed for output in cell.outputs if output.get("name") == "stderr")
        assert "Traceback" not in said, title
