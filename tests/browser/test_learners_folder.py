"""README's first command in a browser: the learner's folder opens on page 00, without outputs, with the lesson's kernel.

This comes before other browser tests, so that the window is loaded once: they go on in it.
"""

from __future__ import annotations

import nbformat
from jupyter_pages import KERNEL, NOTEBOOK, Lab, close_all, execute
from playwright.sync_api import Page

RUN_CELL = "notebook:run-cell-and-select-next"


def test_page_00_opens_and_works_and_says_what_to_run_after_a_restart(desktop: Page, lab: Lab) -> None:
    page = desktop
    page.set_viewport_size({"width": 1280, "height": 900})
    page.goto(lab.address)
    page.wait_for_selector(".jp-Notebook .jp-Cell")
    page.wait_for_function(f"{NOTEBOOK}?.context?.path === '00_welcome.ipynb'")
    page.wait_for_function(f"{KERNEL}?.status === 'idle'")
    outputs = f"{NOTEBOOK}.content.widgets.map(cell => cell.model.outputs?.length ?? 0).reduce((a, b) => a + b)"
    assert page.evaluate(outputs) == 0
    select = "at => (window.jupyterapp.shell.currentWidget.content.activeCellIndex = at)"
    code = [cell.cell_type for cell in nbformat.read(lab.folder / "00_welcome.ipynb", 4).cells]
    page.evaluate(select, code.index("code") + 2)
    page.evaluate(f"{NOTEBOOK}.content.activeCell.model.sharedModel.setSource('ros2 topic list')")
    execute(page, RUN_CELL)
    page.wait_for_selector(".jp-OutputArea-output >> text=Run the set-up cell first")
    page.evaluate(select, code.index("code"))
    execute(page, RUN_CELL)
    page.evaluate(select, code.index("code") + 2)
    execute(page, RUN_CELL)
    page.wait_for_selector(".jp-OutputArea-output >> text=cmd_vel")
    assert page.locator("text=Jupyter news").count() == 0

    page.evaluate("() => { window.jupyterapp.shell.mode = 'single-document'; window.jupyterapp.shell.collapseLeft() }")
    close_all(page)
