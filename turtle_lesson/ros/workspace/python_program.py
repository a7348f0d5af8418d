"""A program of a package with Python modules of its own."""

from __future__ import annotations

import shutil
import sys
from collections.abc import Iterable
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from ... import files
from ..core.program import run_program


@dataclass(frozen=True)
class PythonProgram:
    """What runs such a program.

    Attributes:
        path: the file, which is read at each start; one that does not exist stands for `text`.
        folders: the folders of its modules.
        text: the code of a program that no file holds, as an entry point used without a build.
    """

    path: Path
    folders: tuple[Path, ...]
    text: str | None = None

    def __call__(self) -> None:
        run_program(self.path, self.folders, self.text)


def forget_below(folders: Iterable[Path]) -> None:
    """Have the modules in these folders be imported anew, from what the files say now.

    Compiled files in the learner's folder are deleted, too: Python takes them for good if the source has the same size and
    second.
    """
    folders = tuple(folders)
    for name, module in list(sys.modules.items()):
        file = getattr(module, "__file__", None)
        if isinstance(file, str) and any(Path(file).is_relative_to(folder) for folder in folders):
            del sys.modules[name]
    for folder in folders:
        for cache in list(folder.rglob("__pycache__")):
            with suppress(PermissionError):
                shutil.rmtree(files.check(cache, removes=True), ignore_errors=True)
