"""Pages as files: clearing outputs, stripping solutions, putting them back as published; the learner's folder.

What a learner has worked on is never overwritten. A small hidden file in the learner's folder remembers from which published
version each copy was made.
"""

from __future__ import annotations

import hashlib
import json
import shutil
import subprocess
from contextlib import suppress
from pathlib import Path
from typing import Any

import nbformat

from ..learner.story import PAGES, PUBLISHED
from ..ros.runtime import files

CHECKOUT = PUBLISHED.parent
"""Where the project lies, if it was installed from its checkout (as README says)."""

FOLDER = "my-lesson"
MEMORY = ".turtle_lesson_pages.json"
NAMES = tuple(f"{page}.ipynb" for page in (*PAGES, "lab"))
"""The files that a learner gets."""


class PageError(Exception):
    """Something that cannot be done with a page, and what to try."""


def read(path: Path) -> nbformat.NotebookNode:
    """The notebook in a file. Raises OSError, or PageError, which says why that is not a notebook."""
    return parse(path.read_bytes(), path)


def parse(content: bytes, path: Path) -> nbformat.NotebookNode:
    """The notebook in a file's content. Raises PageError, which says why that is not a notebook."""
    try:
        notebook = nbformat.reads(content, as_version=4)
        nbformat.validate(notebook)
    except Exception as error:  # nbformat raises many kinds
        reason = " ".join(str(error).split())[:120]
        raise PageError(f"{path} is not a notebook: {reason or type(error).__name__}") from None
    return notebook


def clear(notebook: nbformat.NotebookNode) -> nbformat.NotebookNode:
    """Take the outputs and execution counts out of a notebook, and return it. Ids, tags and all else stay."""
    for cell in notebook.cells:
        if cell.cell_type == "code":
            cell.outputs, cell.execution_count = [], None
    notebook.metadata.pop("widgets", None)  # what widgets showed
    return notebook


def page_of(path: Path, metadata: Any = None) -> str:
    """The lesson's page that a copy is of: what its metadata say, or else its name; "" if neither does."""
    said = metadata.get("turtle_lesson") if isinstance(metadata, dict) else None
    page = said.get("page", "") if isinstance(said, dict) else ""
    if page in PAGES:
        return page
    return next((each for each in PAGES if each in path.stem), "")


def reset(path: Path) -> Path | None:
    """Put a page back as it was published, in a learner's folder without outputs.

    Returns where the learner's copy is kept, None if nothing had changed.
    """
    content = published(path)
    if is_learners(path.parent):
        content = LearnersFolder(path.parent).fresh(path.name, content)
    kept = None
    if path.is_file():
        if path.read_bytes() == content:
            return None
        kept = unused(path, "mine")
        shutil.copy2(path, kept)
    path.write_bytes(content)
    return kept


def unused(path: Path, word: str) -> Path:
    """NAME.word-1.ipynb, or the first number that is free."""
    return files.unused(lambda number: path.with_name(f"{path.stem}.{word}-{number}.ipynb"))


def published(path: Path) -> bytes:
    """The published page of this name. Raises PageError where there is none, or none but this file itself."""
    name, content = path.name, find_published(path.name)
    if content is None:
        raise PageError(f"{name} cannot be found in {PUBLISHED}: what is reset has the name of a page")
    if (PUBLISHED / name).resolve() == path.resolve() and _from_git(name) is None:
        raise PageError(
            f"{name} is the published page itself, and the checkout has no version control that could restore it. "
            "Download the lesson again."
        )
    return content


def find_published(name: str) -> bytes | None:
    """The published page of a name, if there is one: from the checkout's version control, or else as it was installed."""
    file = PUBLISHED / name
    return _from_git(name) or (file.read_bytes() if file.is_file() else None)


def _from_git(name: str) -> bytes | None:
    """A page as the checkout's version control has it; None where there is no checkout, no git or no such page."""
    if not (CHECKOUT / ".git").exists():
        return None
    command = ["git", "-C", str(CHECKOUT), "show", f"HEAD:notebooks/{name}"]
    try:
        done = subprocess.run(command, capture_output=True, timeout=30, check=False)
    except (OSError, subprocess.TimeoutExpired):
        return None
    return done.stdout if done.returncode == 0 else None


def without_solutions(path: Path, to: Path | None = None) -> tuple[Path, int]:
    """Write a page without outputs and the cells tagged "solution"; returns where, and how many cells that were."""
    notebook = clear(read(path))
    target = path.with_name(f"{path.stem}.student.ipynb") if to is None else to / path.name if to.is_dir() else to
    cells = [cell for cell in notebook.cells if "solution" not in cell.metadata.get("tags", [])]
    removed = len(notebook.cells) - len(cells)
    notebook.cells = cells
    with target.open("x", encoding="utf-8") as file:
        nbformat.write(notebook, file)
    return target, removed


# -- the learner's folder ----------------------------------------------------------------------------------------------


class LearnersFolder:
    """A folder of a learner's pages, made if it is not there. Raises PageError where that cannot be."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self._memory = path / MEMORY
        elsewhere = f"Name another folder: turtle-lesson open {Path.home() / FOLDER}"
        try:
            if not is_learners(path) and path.is_dir() and any(path.glob("[!.]*")):
                raise PageError(f"{path} already holds other files, and they are left alone. {elsewhere}")
            path.mkdir(parents=True, exist_ok=True)
            self._versions: dict[str, str] = {}
            with suppress(FileNotFoundError, TypeError, ValueError):
                self._versions |= json.loads(self._memory.read_text(encoding="utf-8"))
            self._remember()
        except OSError as error:
            raise PageError(f"pages cannot be kept in {path}: {error.strerror}. {elsewhere}") from None

    def _remember(self) -> None:
        files.write(self._memory, json.dumps(self._versions, indent=1) + "\n")

    def update(self) -> list[str]:
        """Fill in pages that are missing and bring untouched ones up to date.

        A page that was worked on stays, and a newer version is put beside it, once. Returns sentences about that.
        """
        said = []
        for name in NAMES:
            content = find_published(name)
            if content is None:
                continue
            newer = clear(parse(content, Path(name)))
            newest = version(newer)
            if not self._put(name, newer, newest) and self._versions.get(name) != newest:
                beside = unused(self.path / name, "new")
                nbformat.write(newer, beside)
                self._versions[name] = newest
                said.append(
                    f"{name} holds your work, and the lesson has a newer version of the page: it is beside yours, "
                    f"as {beside.name}."
                )
        self._remember()
        if not any((self.path / name).is_file() for name in NAMES):
            raise PageError(f"the lesson's pages cannot be found in {PUBLISHED}")
        return said

    def _put(self, name: str, page: nbformat.NotebookNode, made_from: str) -> bool:
        """Write a page, unless the learner's copy was worked on and differs; whether the page is there now."""
        path, mine = self.path / name, ""
        with suppress(PageError, OSError):  # there is none, or no notebook
            mine = version(read(path))
        if mine != version(page):
            if path.exists() and mine != self._versions.get(name):
                return False
            nbformat.write(page, path)
        self._versions[name] = made_from
        return True

    def fresh(self, name: str, published: bytes) -> bytes:
        """A published page without outputs; from now on, the copy of this name is made from it."""
        page = clear(parse(published, Path(name)))
        self._versions[name] = version(page)
        self._remember()
        return f"{nbformat.writes(page)}\n".encode()

    def take_along(self) -> list[str]:
        """Take along the pages that were begun in the checkout's `notebooks`; those that are here already stay.

        Returns sentences about what was done.
        """
        said = []
        for name in begun():
            page, path = clear(read(PUBLISHED / name)), self.path / name
            if not self._put(name, page, self._versions.get(name, "")):
                path = unused(path, "mine")
                nbformat.write(page, path)
            said.append(f"{name} was copied" + (f", as {path.name}." if path.name != name else "."))
        self._remember()
        return said or [f"No page was begun in {PUBLISHED}."]


def is_learners(path: Path) -> bool:
    """Whether this is a learner's folder already."""
    return (path / MEMORY).is_file()


def begun() -> list[str]:
    """The pages in the checkout's `notebooks` that differ from what its version control holds."""
    found = []
    for name in NAMES:
        committed, mine = find_published(name), PUBLISHED / name
        if committed is None or not mine.is_file() or mine.read_bytes() == committed:
            continue
        if version(clear(read(mine))) != version(clear(parse(committed, mine))):
            found.append(name)
    return found


def version(notebook: nbformat.NotebookNode) -> str:
    """A short hash of a notebook's cells: a copy with outputs or changes has another one."""
    cells = [[cell.cell_type, cell.source, cell.get("outputs", [])] for cell in notebook.cells]
    return hashlib.sha256(json.dumps(cells).encode()).hexdigest()[:16]
