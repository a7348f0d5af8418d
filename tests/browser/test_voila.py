"""The dashboard as a page of its own: `voila notebooks/lab.ipynb` shows it without a cell of code, and it lives."""

from __future__ import annotations

import os
import shutil
import socket
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from jupyter_pages import wait_until_it_answers
from playwright.sync_api import Page, expect

PAGE = Path(__file__).resolve().parents[2] / "notebooks" / "lab.ipynb"


@pytest.fixture(scope="module")
def voila(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    """The address of a Voila that serves a copy of the page, on this machine only."""
    folder = tmp_path_factory.mktemp("voila")
    shutil.copy(PAGE, folder)
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    options = ["--Voila.ip=127.0.0.1", f"--port={port}", "--no-browser"]
    places = {name: str(folder) for name in ("HOME", "JUPYTER_CONFIG_DIR", "JUPYTER_DATA_DIR")}
    with (folder / "server.log").open("w") as log:
        server = subprocess.Popen(
            [sys.executable, "-m", "voila", str(folder / "lab.ipynb"), *options],
            env={**os.environ, **places},
            stdout=log,
            stderr=log,
        )
    try:
        address = f"http://127.0.0.1:{port}"
        wait_until_it_answers(f"{address}/voila/static/", server, folder / "server.log")
        yield address
    finally:
        server.terminate()
        server.wait(100)


def test_the_dashboard_lives_without_a_notebook(page: Page, voila: str) -> None:
    problems: list[str] = []
    page.on("pageerror", lambda error: problems.append(str(error)))
    page.goto(voila)
    dashboard = page.locator(".tl-dashboard")
    dashboard.wait_for()
    expect(page.locator(".tl-light-present")).to_have_count(5)
    assert page.locator(".jp-CodeMirrorEditor, .jp-InputArea-editor").count() == 0

    battery = page.locator(".tl-strip-value").last
    before = battery.inner_text()
    page.get_by_role("button", name="Play").click()
    expect(battery).not_to_have_text(before)
    expect(page.locator(".tl-log-line").first).to_contain_text("Starting turtlesim")
    assert problems == []
