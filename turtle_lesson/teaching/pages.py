"""Pages as files: clearing outputs, stripping solutions, putting them back as published; the learner's folder.

What a learner has worked on is never overwritten. A small hidden file in the learner's folder remembers from which published
version each copy was made.
"""

from __future__ import annotations

import hashlib
import json
import shutil
from contextlib import suppress
from pathlib import Path
from typing import Any

import nbformat

from ..learner.story import PAGES, PUBLISHED
from ..ros.runtime import files

SOLUTION = "solution"
"""Tag of the cells that hold a solution."""


FOLDER = "my-lesson"
MEMORY = ".turtle_lesson_pages.json"
NAMES = tuple(f"{page}.ipynb" for page in (*PAGES, "lab"))
"""The files that a learner gets."""


class PageError(Exception):
    """Something that cannot be done with a page, and what to try."""


def read(path: Path) -> nbformat.NotebookNode:
    """The notebook in a file. Raises PageError, which says why it cannot be read."""
    try:
        text = path.read_text(encoding="utf-8-sig")
    except OSError as error:
        raise PageError(f"{path} cannot be read: {error.strerror}") from None
    except UnicodeDecodeError:
        raise PageError(f"{path} is not a notebook: it holds no text") from None
    return parse(text, path)


def parse(text: str | bytes, path: Path) -> nbformat.NotebookNode:
    """The notebook in a text. Raises PageError, which says why the text is not a notebook."""
    try:
        notebook = nbformat.reads(text, as_version=4)
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


def reset(path: Path, published: str | bytes) -> Path | None:
    """Put a page back into its published state; returns where the learner's copy is kept, None if nothing had changed."""
    content = published.encode() if isinstance(published, str) else published
    if path.is_file() and path.read_bytes() == content:
        return None
    kept = None
    if path.exists():
        kept = unused(path, "mine")
        shutil.copy2(path, kept)
    path.write_bytes(content)
    return kept


def unused(path: Path, word: str) -> Path:
    """NAME.word-1.ipynb, or the first number that is free."""
    return files.unused(lambda number: path.with_name(f"{path.stem}.{word}-{number}.ipynb"))


def published(path: Path, source: Path | None = None) -> bytes:
    """The published page that a copy is of: what lies in `source`, or else what was installed. Raises PageError."""
    if path.suffix != ".ipynb":
        raise PageError(f"{path} is not a notebook: its name should end in .ipynb")
    name = path.name
    if not (PUBLISHED / name).is_file():  # it was renamed
        metadata = None
        with suppress(PageError):  # damaged: all the more reason to reset it
            metadata = read(path).metadata
        page = page_of(path, metadata)
        name = f"{page}.ipynb" if page else name
    file = (source or PUBLISHED) / name
    if not file.is_file() or file.resolve() == path.resolve():
        what = "is the published page itself" if file.is_file() else f"is not here (it would be in {file.parent})"
        raise PageError(f"the published {name} {what}. Name a folder of published pages: --from FOLDER")
    return file.read_bytes()


def without_solutions(path: Path, to: Path | None = None) -> tuple[Path, int]:
    """Write a page without outputs and the cells tagged "solution"; returns where, and how many cells that were."""
    notebook = clear(read(path))
    target = path.with_name(f"{path.stem}.student.ipynb") if to is None else to / path.name if to.is_dir() else to
    cells = [cell for cell in notebook.cells if SOLUTION not in cell.metadata.get("tags", [])]
    removed = len(notebook.cells) - len(cells)
    notebook.cells = cells
    try:
        with target.open("x", encoding="utf-8") as file:
            nbformat.write(notebook, file)
    except FileExistsError:
        raise PageError(
            f"{target} already exists, and nothing is ever overwritten: choose another name with --to"
        ) from None
    return target, removed


# -- the learner's folder ----------------------------------------------------------------------------------------------


class LearnersFolder:
    """A folder of a learner's pages, made if it is not there. Raises PageError where that cannot be."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self._memory = path / MEMORY
        elsewhere = f"Name another folder: turtle-lesson open {Path.home() / FOLDER}"
        if path.exists() and not path.is_dir():
            raise PageError(f"{path} is a file, but a folder is needed. {elsewhere}")
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

    def update(self, source: Path | None = None) -> list[str]:
        """Fill in pages that are missing and bring untouched ones up to date.

        A page that was worked on stays, and a newer version is put beside it, once. Returns sentences about that.
        """
        said = []
        for name in NAMES:
            file = (source or PUBLISHED) / name
            if not file.is_file():
                continue
            newer = clear(read(file))
            newest, mine, made_from = version(newer), version_of(self.path / name), self._versions.get(name)
            if mine in (newest, made_from) or not (self.path / name).exists():
                if mine != newest:
                    nbformat.write(newer, self.path / name)
                self._versions[name] = newest
            elif made_from != newest:
                beside = unused(self.path / name, "new")
                nbformat.write(newer, beside)
                self._versions[name] = newest
                said.append(
                    f"{name} holds your work, and the lesson has a newer version of the page: it is beside yours, "
                    f"as {beside.name}."
                )
        self._remember()
        if not any((self.path / name).is_file() for name in NAMES):
            raise PageError(
                f"the lesson's pages are not here (they would be in {source or PUBLISHED}). Name a folder of "
                "published pages: --from FOLDER"
            )
        return said

    def reset(self, path: Path, published: bytes) -> Path | None:
        """Put a page back as it was published, without outputs; returns where the learner's copy is kept, if it differs."""
        page = clear(parse(published, path))
        self._versions[path.name] = version(page)
        self._remember()
        return reset(path, nbformat.writes(page) + "\n")


def is_learners(path: Path) -> bool:
    """Whether this is a learner's folder already."""
    return (path / MEMORY).is_file()


def version(notebook: nbformat.NotebookNode) -> str:
    """A short hash of a notebook's cells: a copy with outputs or changes has another one."""
    cells = [[cell.cell_type, cell.source, cell.get("outputs", [])] for cell in notebook.cells]
    return hashlib.sha256(json.dumps(cells).encode()).hexdigest()[:16]


def version_of(path: Path) -> str:
    """The version of a file; "" if there is no such file, or no notebook in it."""
    try:
        return version(read(path))
    except PageError:
        return ""
