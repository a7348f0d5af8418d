"""A learner in JupyterLab: a folder of pages without outputs, solutions typed into the exercises, page after page.

Playing 02, 03 and 06 one after the other in one folder shows what only a browser shows: that typing, running and looking
lead from an empty page to a robot of one's own on the dashboard.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import nbformat
import pytest
from jupyter_pages import KERNEL, NOTEBOOK, Lab, execute, notebook_in
from playwright.sync_api import Page

from turtle_lesson.teaching.pages import LearnersFolder

PAGES = ("02_services_and_interfaces", "03_navigator", "06_parameters_and_launch")
CELLS = f"Array.from({NOTEBOOK}.content.model.cells).map(cell => cell.toJSON())"
LONGEST = 300_000
"""Milliseconds that a page may take on a busy machine."""


@pytest.fixture(scope="module")
def folder(lab: Lab) -> Path:
    """A learner's folder in which nothing was done yet, in the one that JupyterLab serves."""
    folder = lab.folder / "new"
    LearnersFolder(folder).update()
    return folder


@pytest.mark.parametrize("name", PAGES)
def test_a_page_is_played_from_empty_cells_to_right_answers(desktop: Page, lab: Lab, folder: Path, name: str) -> None:
    problems: list[str] = []
    with notebook_in(desktop, lab, f"new/{name}.ipynb", problems) as page:
        play(page, folder / f"{name}.ipynb")
    assert problems == []


def play(page: Page, file: Path) -> None:
    """Type the solutions, run all cells, and look."""
    assert not any(cell.get("outputs") for cell in page.evaluate(CELLS)), "nothing is given away before it is run"
    solutions = type_solutions(page, file)
    run_all(page)
    cells = page.evaluate(CELLS)
    assert [cell["source"] for cell in cells if unexpected_error(cell)] == []
    checks = [cell for cell in cells if "check" in cell["metadata"].get("tags", [])]
    assert len(checks) == solutions > 0
    for cell in checks:
        said = "".join(cell["outputs"][-1]["data"]["text/plain"])
        assert said.startswith("✓"), said
    if file.name.startswith("06"):
        dashboard = page.locator(".jp-OutputArea-output", has_text="obstacle_detector").last
        dashboard.wait_for(state="attached")


def type_solutions(page: Page, file: Path) -> int:
    """Replace what stands in each exercise's cell by its solution, typed; how many exercises there are."""
    cells = nbformat.read(file, as_version=4).cells
    solutions = {
        cell.metadata.turtle_lesson.exercise: cell.source.partition("\n")[2]
        for cell in cells
        if "solution" in cell.metadata.get("tags", [])
    }
    exercises = [place for place, cell in enumerate(cells) if "exercise" in cell.metadata.get("tags", [])]
    for place in exercises:
        solution = solutions[cells[place].metadata.turtle_lesson.exercise]
        page.evaluate(
            f"place => {{ {NOTEBOOK}.content.activeCellIndex = place; {NOTEBOOK}.content.mode = 'edit'; }}", place
        )
        editor = page.locator(".jp-Cell.jp-mod-active .cm-content")
        editor.click()
        page.keyboard.press("ControlOrMeta+a")
        page.keyboard.insert_text(solution)
        assert page.evaluate(CELLS)[place]["source"] == solution
    return len(exercises)


def run_all(page: Page) -> None:
    """Run all cells, and wait until the last one has ended, or one with an error that stops the rest."""
    execute(page, "notebook:run-all-cells")
    ended = f"""() => {{
      const code = {CELLS}.filter(cell => cell.cell_type === 'code');
      const fatal = cell => !cell.metadata.tags?.includes('raises-exception')
        && cell.outputs.some(output => output.output_type === 'error');
      return {KERNEL}?.status === 'idle' && (code.at(-1).execution_count || code.some(fatal));
    }}"""
    page.wait_for_function(ended, timeout=LONGEST, polling=200)  # not at each frame: it reads the whole page


def unexpected_error(cell: dict[str, Any]) -> bool:
    """Whether a cell ended with an error that the page does not want."""
    wanted = "raises-exception" in cell["metadata"].get("tags", [])
    return not wanted and any(output["output_type"] == "error" for output in cell.get("outputs", []))
