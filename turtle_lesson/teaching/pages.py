"""Pages as files: finding them, clearing outputs, stripping solutions, and putting pages back as they were published."""

from __future__ import annotations

import shutil
import subprocess
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import nbformat

from ..learner.story import PAGES, PUBLISHED

CHECKOUT = PUBLISHED.parent
"""Where the project lies, if it was installed from its checkout (as README says)."""
SOLUTION = "solution"
"""Tag of the cells that hold a solution."""


class PageError(Exception):
    """Something that cannot be done with a page, and what to try."""


def find(paths: Iterable[Path]) -> list[Path]:
    """The files that are named, and the notebooks in the folders that are; each once, in order."""
    found: list[Path] = []
    for path in paths:
        if path.is_dir():
            inside = sorted(path.rglob("*.ipynb"))
            found += [each for each in inside if not any(part[0] == "." for part in each.relative_to(path).parts)]
        else:
            found.append(path)
    return list(dict.fromkeys(found))


def read(path: Path) -> Any:
    """The notebook in a file. Raises PageError, which says why it cannot be read."""
    try:
        text = path.read_text(encoding="utf-8-sig")
    except FileNotFoundError:
        raise PageError(f"{path} does not exist") from None
    except IsADirectoryError:
        raise PageError(f"{path} is a folder; name the notebook in it") from None
    except OSError as error:
        raise PageError(f"{path} cannot be read: {error.strerror}") from None
    except UnicodeDecodeError:
        raise PageError(f"{path} is not a notebook: it holds no text") from None
    return parse(text, path)


def parse(text: str | bytes, path: Path) -> Any:
    """The notebook in a text. Raises PageError, which says why the text is not a notebook."""
    try:
        notebook = nbformat.reads(text, as_version=4)
        nbformat.validate(notebook)
    except Exception as error:  # nbformat raises many kinds
        reason = " ".join(str(error).split())[:120]
        raise PageError(f"{path} is not a notebook: {reason or type(error).__name__}") from None
    return notebook


def clear(notebook: Any) -> Any:
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


# -- reset -------------------------------------------------------------------------------------------------------------


def reset(path: Path, published: str | bytes) -> Path | None:
    """Put a page back into its published state; returns where the learner's copy is kept, None if nothing had changed."""
    content = published.encode() if isinstance(published, str) else published
    if path.is_file() and path.read_bytes() == content:
        return None
    kept = None
    if path.exists():
        kept = unused(path, "mine")
        shutil.copy2(path, kept)
    elif not path.parent.is_dir():
        raise PageError(f"{path.parent} does not exist")
    path.write_bytes(content)
    return kept


def unused(path: Path, word: str) -> Path:
    """NAME.word-1.ipynb, or the first number that is free."""
    number = 1
    while (found := path.with_name(f"{path.stem}.{word}-{number}.ipynb")).exists():
        number += 1
    return found


def published(path: Path, source: Path | None = None) -> bytes:
    """The published page that a copy is of.

    Published is what lies in `source`; without one, what the checkout's version control holds, or else what was installed.
    Raises PageError where it is found in neither.
    """
    if path.suffix != ".ipynb":
        raise PageError(f"{path} is not a notebook: its name should end in .ipynb")
    name = _published_name(path)
    content = find_published(name, source)
    if content is None and source is not None:
        raise PageError(f"there is no {name} in {source}")
    if content is None:
        raise PageError(
            f"the published {name} is not here (it would be in {PUBLISHED}). Name a folder of published pages: "
            "--from FOLDER"
        )
    if source is None and (PUBLISHED / name).resolve() == path.resolve() and _from_git(name) is None:
        raise PageError(
            f"{name} is the published page itself, and the checkout has no version control that could restore it. "
            "Download the lesson again, and name its folder of notebooks: --from FOLDER"
        )
    return content


def find_published(name: str, source: Path | None = None) -> bytes | None:
    """The published page of a name; None if there is none."""
    committed = _from_git(name) if source is None else None
    if committed is not None:
        return committed
    file = (source or PUBLISHED) / name
    return file.read_bytes() if file.is_file() else None


def _published_name(path: Path) -> str:
    """The page's own file name: that of the copy, or of the page whose name is a part of it."""
    if (PUBLISHED / path.name).is_file():
        return path.name
    try:
        page = page_of(path, read(path).metadata)
    except PageError:  # damaged: all the more reason to reset it
        page = page_of(path)
    return f"{page}.ipynb" if page else path.name


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


# -- student -----------------------------------------------------------------------------------------------------------


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
    except OSError as error:
        raise PageError(f"{target} cannot be written: {error.strerror}") from None
    return target, removed
