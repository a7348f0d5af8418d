"""A JupyterLab and its pages, as Playwright sees them: what browser tests and the live lab's benchmark share."""

from __future__ import annotations

import json
import os
import shutil
import socket
import subprocess
import sys
import time
import urllib.error
import urllib.request
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from axe_playwright_python.sync_playwright import Axe
from playwright.sync_api import Browser, Frame, Page

NAMES = ("chromium", "chromium-browser", "google-chrome", "chrome")
FLAGS = [
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
]
"""What a headless Chromium is started with."""

PATIENCE = 180_000
"""How long (ms) a page may take for anything, on a machine that is busy with other things: it only ends what hangs."""

NOTEBOOK = "window.jupyterapp.shell.currentWidget"
KERNEL = f"{NOTEBOOK}?.sessionContext?.session?.kernel"


def find_chromium() -> str | None:
    """The path of a Chromium, if there is one on this machine."""
    return next(filter(None, map(shutil.which, NAMES)), None)


def free_port() -> int:
    """A port of this machine that nobody uses."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def isolated(folder: Path) -> dict[str, str]:
    """The environment of a Jupyter with nobody's settings: it keeps its own in `folder`/home."""
    home = folder / "home"
    home.mkdir()
    return {**os.environ, **{name: str(home) for name in ("HOME", "JUPYTER_CONFIG_DIR", "JUPYTER_DATA_DIR")}}


@dataclass(frozen=True)
class Lab:
    """A JupyterLab: its address, which is also what it is as a text, and the folder that it serves."""

    address: str
    folder: Path

    def __str__(self) -> str:
        return self.address


@contextmanager
def jupyterlab(folder: Path) -> Iterator[Lab]:
    """The JupyterLab of README's first command, with nobody's settings: it serves a learner's folder, made in `folder`."""
    port = free_port()
    options = {
        "IdentityProvider.token": "",
        "ServerApp.allow_root": True,
        "LabApp.expose_app_in_browser": True,
        "LanguageServerManager.autodetect": False,
    }
    words = [f"--{name}={value}" for name, value in options.items()]
    with (folder / "server.log").open("w") as log:
        command = [sys.executable, "-m", "turtle_lesson", "open", "--no-browser", "--port", str(port), *words]
        server = subprocess.Popen(command, cwd=folder, env=isolated(folder), stdout=log, stderr=log)
    address = f"http://127.0.0.1:{port}"
    try:
        wait_until_it_answers(f"{address}/api/status", server, folder / "server.log")
        yield Lab(address, folder / "my-lesson")
    finally:
        server.terminate()
        server.wait(100)


def wait_until_it_answers(address: str, server: subprocess.Popen[bytes], log: Path, seconds: float = 400) -> None:
    """Wait for a server, also on a busy machine. Raises RuntimeError, with its log's end, if it ends or never answers."""
    deadline = time.monotonic() + seconds
    while time.monotonic() < deadline and server.poll() is None:
        try:
            with urllib.request.urlopen(address, timeout=5):
                return
        except urllib.error.HTTPError as error:
            error.close()
            return  # an answer, too
        except OSError:
            time.sleep(0.2)
    why = (
        f"does not answer in {seconds:g} s" if server.poll() is None else f"has ended with the code {server.returncode}"
    )
    raise RuntimeError(f"the server of {address} {why}. The end of its log {log}:\n{log.read_text()[-3000:]}")


# -- windows and notebooks -----------------------------------------------------------------------------------------------


OF_A_CLOSED_NOTEBOOK = "Cannot read properties of null (reading 'footer')"
"""What JupyterLab says if it is about to focus a notebook that was closed a moment ago (`_ensureFocus` of its Notebook)."""


def listeners(problems: list[str]) -> dict[str, Callable[[Any], None]]:
    """By the events of a window: what adds to `problems` what the browser complains of there."""

    def add(problem: str) -> None:
        if OF_A_CLOSED_NOTEBOOK not in problem:
            problems.append(problem)

    return {
        "pageerror": lambda error: add(str(error)),
        "console": lambda message: add(message.text) if message.type == "error" else None,
    }


def new_window(browser: Browser, problems: list[str], width: int = 1280) -> Page:
    """A window of its own; what the browser complains of there is added to `problems`."""
    page = browser.new_page(viewport={"width": width, "height": 1000})
    page.set_default_timeout(PATIENCE)
    for event, listener in listeners(problems).items():
        page.on(event, listener)  # type: ignore[call-overload]
    return page


@contextmanager
def notebook_in(page: Page, lab: Lab, name: str, problems: list[str], width: int = 1280) -> Iterator[Page]:
    """A window with a notebook. It may show JupyterLab already, which takes seconds to load; afterwards it is empty again.

    What the browser complains of meanwhile is added to `problems`.
    """
    hear = listeners(problems)
    page.set_viewport_size({"width": width, "height": 1000})
    for event, listener in hear.items():
        page.on(event, listener)  # type: ignore[call-overload]
    try:
        open_notebook(page, lab, name)
        yield page
    finally:
        for event, listener in hear.items():
            page.remove_listener(event, listener)
        close_all(page)


def write_notebook(lab: Lab, name: str, cells: Sequence[str]) -> None:
    """Put a notebook with these cells where the server finds it."""
    empty: dict[str, Any] = {"cell_type": "code", "metadata": {}, "outputs": [], "execution_count": None}
    kernel = {"display_name": "Python 3 (ipykernel)", "language": "python", "name": "python3"}
    notebook = {
        "cells": [{**empty, "id": f"c{at}", "source": cell} for at, cell in enumerate(cells)],
        "metadata": {"kernelspec": kernel},
        "nbformat": 4,
        "nbformat_minor": 5,
    }
    (lab.folder / name).write_text(json.dumps(notebook), encoding="utf-8")


def open_notebook(page: Page, lab: Lab, name: str) -> None:
    """Open a notebook alone, and wait until its kernel is there."""
    if page.url.startswith(f"{lab}/"):
        execute(page, "docmanager:open", {"path": name, "factory": "Notebook"})
    else:
        page.goto(f"{lab}/doc/tree/{name}?reset")
        page.wait_for_selector(".jp-Notebook .jp-Cell")
    page.wait_for_function(f"name => {NOTEBOOK}?.context?.path === name", arg=name)
    page.wait_for_selector(".jp-Notebook .jp-Cell")
    page.wait_for_function(f"{KERNEL}?.status === 'idle'")


def close_all(page: Page) -> None:
    """Close all documents of a window, unsaved, and end all kernels of the server."""
    choose_theme(page, "Light")
    page.evaluate("""async () => {
      for (const each of Array.from(window.jupyterapp.shell.widgets('main'))) {
        if (each.context) each.context.model.dirty = false;
        each.close();
      }
      await window.jupyterapp.serviceManager.sessions.shutdownAll();
    }""")


def execute(page: Page, command: str, arguments: dict[str, Any] | None = None) -> None:
    """Carry out a command of JupyterLab, as its menus do."""
    call = "([command, arguments]) => window.jupyterapp.commands.execute(command, arguments).then(() => null)"
    page.evaluate(call, [command, arguments or {}])


def python(page: Page, code: str) -> str:
    """Run code in the notebook's kernel, and return what it printed, or its traceback."""
    ask = f"""async code => {{
      const answer = {KERNEL}.requestExecute({{ code, silent: false, store_history: false }});
      let said = '';
      answer.onIOPub = ({{ content }}) => (said += content.text ?? (content.traceback ?? []).join('\\n'));
      await answer.done;
      return said;
    }}"""
    return page.evaluate(ask, code)


def value(page: Page, expression: str) -> Any:
    """What a Python expression is in the notebook's kernel."""
    said = python(page, f"print(repr({expression}))")
    assert "Traceback" not in said, said
    return eval(said)


def choose_theme(page: Page, theme: str) -> None:
    """Show JupyterLab's pages "Light" or "Dark"."""
    wanted = f"JupyterLab {theme}"
    if page.evaluate("() => document.body.dataset.jpThemeName") != wanted:
        execute(page, "apputils:change-theme", {"theme": wanted})
        page.wait_for_function("theme => document.body.dataset.jpThemeName === theme", arg=wanted)


def serious_violations(page: Page | Frame, selector: str) -> list[tuple[str, list[str]]]:
    """What axe-core finds wrong, seriously or worse, in the elements of a selector: the rule, and where it is broken."""
    # JupyterLab's body has no height, so axe-core takes all its texts for invisible, and would not look at their contrast
    page.evaluate("() => (document.body.style.minHeight = '100vh')")
    found = Axe().run(page, context=selector).response["violations"]
    serious = [each for each in found if each["impact"] in ("serious", "critical")]
    return [(each["id"], [node["html"][:200] for node in each["nodes"]]) for each in serious]
