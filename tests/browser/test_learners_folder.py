"""README's first command in a browser: the learner's folder opens on page 00, without outputs, with the lesson's kernel."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import nbformat
from jupyter_pages import KERNEL, NOTEBOOK, execute, free_port, isolated, wait_until_it_answers
from playwright.sync_api import Page

RUN_CELL = "notebook:run-cell-and-select-next"


def test_page_00_opens_and_works_and_says_what_to_run_after_a_restart(page: Page, tmp_path: Path) -> None:
    port = free_port()
    words = [sys.executable, "-m", "turtle_lesson", "open", "--no-browser", "--port", str(port)]
    words += ["--allow-root", "--IdentityProvider.token=", "--LabApp.expose_app_in_browser=True"]
    words += ["--LanguageServerManager.autodetect=False"]
    with (tmp_path / "server.log").open("w") as log:
        server = subprocess.Popen(words, cwd=tmp_path, env=isolated(tmp_path), stdout=log, stderr=log)
    try:
        wait_until_it_answers(f"http://127.0.0.1:{port}/api/status", server, tmp_path / "server.log")
        page.goto(f"http://127.0.0.1:{port}")
        page.wait_for_selector(".jp-Notebook .jp-Cell")
        page.wait_for_function(f"{NOTEBOOK}?.context?.path === '00_welcome.ipynb'")
        page.wait_for_function(f"{KERNEL}?.status === 'idle'")
        outputs = f"{NOTEBOOK}.content.widgets.map(cell => cell.model.outputs?.length ?? 0).reduce((a, b) => a + b)"
        assert page.evaluate(outputs) == 0
        select = "at => (window.jupyterapp.shell.currentWidget.content.activeCellIndex = at)"
        code = [cell.cell_type for cell in nbformat.read(tmp_path / "my-lesson" / "00_welcome.ipynb", 4).cells]
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
    finally:
        server.terminate()
        server.wait(60)
