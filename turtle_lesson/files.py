"""Writing the learner's files: whole or not at all."""

from __future__ import annotations

import os
import shutil
from pathlib import Path


def write(file: Path, text: str) -> None:
    """Write a text file in one step, also where an interrupt or a full disk comes between. Folders are made as needed.

    The file keeps its permissions, and a link keeps pointing to it. Raises OSError, with the old text still in place.
    """
    file = Path(os.path.realpath(file))
    file.parent.mkdir(parents=True, exist_ok=True)
    beside = file.with_name(f".{file.name}.{os.getpid()}")
    try:
        beside.write_text(text, encoding="utf-8")
        if file.exists():
            shutil.copymode(file, beside)
        beside.replace(file)
    finally:
        beside.unlink(missing_ok=True)
