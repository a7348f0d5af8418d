"""The learner's folder: the lesson's pages without outputs. What a learner has worked on is never overwritten.

A small hidden file remembers from which published version each copy was made.
"""

from __future__ import annotations

import hashlib
import json
import os
import shutil
import socket
import subprocess
import sys
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any

import nbformat

from ..lab import progress
from ..learner.story import PAGES
from ..ros.runtime import files
from ..ros.runtime.files import OPENED
from . import pages
from .pages import PageError

FOLDER = "my-lesson"
MEMORY = ".turtle_lesson_pages.json"
NAMES = tuple(f"{page}.ipynb" for page in (*PAGES, "lab"))
"""The files that a learner gets."""

NOT_TAKEN = ("build", "install", "log")
"""What a build makes anew in a workspace."""


class LearnersFolder:
    """A folder of a learner's pages, made if it is not there. Raises PageError where that cannot be."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self._memory = path / MEMORY
        elsewhere = f"Name another folder: turtle-lesson open {Path.home() / FOLDER}"
        if path.exists() and not path.is_dir():
            raise pages.PageError(f"{path} is a file, but a folder is needed. {elsewhere}")
        try:
            if not is_learners(path) and path.is_dir() and any(path.glob("[!.]*")):
                raise pages.PageError(f"{path} already holds other files, and they are left alone. {elsewhere}")
            path.mkdir(parents=True, exist_ok=True)
            self._versions: dict[str, str] = {}
            with suppress(FileNotFoundError, TypeError, ValueError):
                self._versions |= json.loads(self._memory.read_text(encoding="utf-8"))
            self._remember()
        except OSError as error:
            raise pages.PageError(f"pages cannot be kept in {path}: {error.strerror}. {elsewhere}") from None

    def _remember(self) -> None:
        files.write(self._memory, json.dumps(self._versions, indent=1) + "\n")

    def update(self, source: Path | None = None) -> list[str]:
        """Fill in pages that are missing and bring untouched ones up to date.

        A page that was worked on stays, and a newer version is put beside it, once. Returns sentences about that.
        """
        said = []
        for name in NAMES:
            content = pages.find_published(name, source)
            if content is None:
                continue
            newer = pages.clear(pages.parse(content, Path(name)))
            newest = version(newer)
            if not self._put(name, newer, newest) and self._versions.get(name) != newest:
                beside = pages.unused(self.path / name, "new")
                nbformat.write(newer, beside)
                self._versions[name] = newest
                said.append(
                    f"{name} holds your work, and the lesson has a newer version of the page: it is beside yours, "
                    f"as {beside.name}."
                )
        self._remember()
        if not any((self.path / name).is_file() for name in NAMES):
            raise pages.PageError(
                f"the lesson's pages are not here (they would be in {source or pages.PUBLISHED}). Name a folder of "
                "published pages: --from FOLDER"
            )
        return said

    def _put(self, name: str, page: Any, made_from: str) -> bool:
        """Write a page, unless the learner's copy was worked on and differs; whether the page is there now."""
        path = self.path / name
        mine = version_of(path)
        if mine != version(page):
            if path.exists() and mine != self._versions.get(name):
                return False
            nbformat.write(page, path)
        self._versions[name] = made_from
        return True

    def reset(self, path: Path, published: bytes) -> Path | None:
        """Put a page back as it was published, without outputs; returns where the learner's copy is kept, if it differs."""
        page = pages.clear(pages.parse(published, path))
        self._versions[path.name] = version(page)
        self._remember()
        return pages.reset(path, nbformat.writes(page) + "\n")

    # -- from the checkout's notebooks -------------------------------------------------------------------------------

    def take_along(self) -> list[str]:
        """Take what was begun in the checkout's `notebooks`: changed pages, the workspace, and points.

        What is here already stays. Returns sentences about what was done.
        """
        said = []
        for name in begun():
            page, path = pages.clear(pages.read(pages.PUBLISHED / name)), self.path / name
            if not self._put(name, page, self._versions.get(name, "")):
                path = pages.unused(path, "mine")
                nbformat.write(page, path)
            said.append(f"{name} was copied" + (f", as {path.name}." if path.name != name else "."))
        self._remember()
        theirs, mine = pages.PUBLISHED / "workspace", self.path / "workspace"
        if theirs.is_dir() and mine.exists():
            said.append(f"There is a workspace in {self.path} already: {theirs} was not copied.")
        elif theirs.is_dir():
            shutil.copytree(theirs, mine, ignore=shutil.ignore_patterns(*NOT_TAKEN))
            said.append("The workspace was copied without its build: build it again.")
        points = progress.ProgressFile(pages.PUBLISHED / progress.FILE).points()
        if points:
            progress.ProgressFile(self.path / progress.FILE).keep(points)
            said.append(f"{sum(points.values())} points were copied.")
        return said or [f"No page was begun in {pages.PUBLISHED}."]


def is_learners(path: Path) -> bool:
    """Whether this is a learner's folder already."""
    return (path / MEMORY).is_file()


def begun() -> list[str]:
    """The pages in the checkout's `notebooks` that differ from what its version control holds."""
    found = []
    for name in NAMES:
        committed = pages.find_published(name)
        mine = pages.PUBLISHED / name
        if committed is not None and mine.is_file() and mine.read_bytes() != committed:
            original = pages.clear(pages.parse(committed, mine))
            if version(pages.clear(pages.read(mine))) != version(original):
                found.append(name)
    return found


def version(notebook: Any) -> str:
    """A short hash of a notebook's cells: a copy with outputs or changes has another one."""
    cells = [[cell.cell_type, cell.source, cell.get("outputs", [])] for cell in notebook.cells]
    return hashlib.sha256(json.dumps(cells).encode()).hexdigest()[:16]


def version_of(path: Path) -> str:
    """The version of a file; "" if there is no such file, or no notebook in it."""
    try:
        return version(pages.read(path))
    except pages.PageError:
        return ""


# -- server -------------------------------------------------------------------------------------------------------
# JupyterLab for a learner's folder, on this machine only.

JUPYTER = Path(__file__).resolve().parent / "jupyter"
"""Holds the kernel that says which cell to run after a restart, and settings: no news, and no look for updates."""

FIRST = "00_welcome.ipynb"


def serve(folder: Path, port: int | None, browser: bool, more: Sequence[str]) -> int:
    """Run JupyterLab on the first page of a folder until it is stopped; where the system can, in place of this process.

    Args:
        folder: all that it shows.
        port: None takes 8888, or the next one that is free.
        browser: whether to open one.
        more: further options of JupyterLab's.
    """
    words = [sys.executable, "-P", "-m", "jupyterlab", "--Application.log_level=ERROR", *more]
    words.append(f"--LabApp.default_url=/lab/tree/{FIRST}")
    words += [f"--ServerApp.root_dir={folder.resolve()}", "--ServerApp.ip=127.0.0.1"]
    if port is not None:
        _check_free(port)
        words += [f"--ServerApp.port={port}", "--ServerApp.port_retries=0"]
    if not browser:
        words.append("--no-browser")
    environment = dict(os.environ) | {OPENED: str(folder.resolve())}
    for name in ("JUPYTER_PATH", "JUPYTER_CONFIG_PATH"):
        environment[name] = os.pathsep.join([str(JUPYTER), *filter(None, [os.environ.get(name)])])
    sys.stdout.flush()
    if os.name == "posix":
        os.execve(sys.executable, words, environment)
    return subprocess.call(words, env=environment)


def _check_free(port: int) -> None:
    with socket.socket() as probe:
        if os.name == "posix":  # as Jupyter's own: a port that was used a moment ago is free
            probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            probe.bind(("127.0.0.1", port))
        except (OSError, OverflowError) as error:
            reason = (getattr(error, "strerror", None) or str(error)).lower().rstrip(".")
            raise PageError(f"port {port} cannot be used: {reason}. Without --port, a free one is found.") from None
