"""For all tests, those of the pages too: points are kept in no file, and each page begins in a fresh folder.

So no run depends on an earlier one, and no page sees what another one wrote.
"""

from __future__ import annotations

import os
import tempfile
from pathlib import Path

import pytest

os.environ["TURTLE_LESSON_PROGRESS"] = "off"
_folders: dict[Path, tempfile.TemporaryDirectory[str]] = {}


@pytest.hookimpl(tryfirst=True)
def pytest_runtest_setup(item: pytest.Item) -> None:
    """Name a fresh folder for the kernel of a page, before nbval starts it; kernels of other tests go where they are put."""
    if item.path.suffix != ".ipynb":
        os.environ.pop("TURTLE_LESSON_FOLDER", None)
    elif item.path not in _folders:
        _folders[item.path] = tempfile.TemporaryDirectory()
        os.environ["TURTLE_LESSON_FOLDER"] = _folders[item.path].name


def pytest_sessionfinish() -> None:
    """Remove them."""
    for folder in _folders.values():
        folder.cleanup()
