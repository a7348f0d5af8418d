"""A ROS package as the index knows it."""

from __future__ import annotations

import os
import shutil
import sys
from collections.abc import Callable, Iterable
from contextlib import suppress
from dataclasses import dataclass, field
from fnmatch import fnmatchcase
from pathlib import Path

from ..runtime import files
from ..stdlib.program import run_program

Target = Path | Callable[[], object]
"""What an executable is: a Python file, or a callable that is its `main()`."""


@dataclass
class Package:
    """One package that can be found.

    Attributes:
        name: its name.
        share: the folder in which its launch files and other data are found.
        executables: what `ros2 run` and `Node(executable=…)` find, by name.
        interfaces: its definitions relative to `share`, such as `msg/TurtleStatus.msg`.
        source: the folder in which it was written, or None.
        prefix: the folder that it is installed in; None for one that is used as it lies there.
        installed: for a package used as it lies there, what would be in its share folder after a build, by
            the path that it would have there; None means everything under `share`.
        modules: for an ament_python package used as it lies there, the folders in which its modules lie.
    """

    name: str
    share: Path
    executables: dict[str, Target] = field(default_factory=dict)
    interfaces: list[str] = field(default_factory=list)
    source: Path | None = None
    prefix: Path | None = None
    installed: dict[str, Path] | None = None
    modules: list[Path] = field(default_factory=list)

    @property
    def libexec(self) -> Path:
        """The folder in which a real ROS 2 looks for the package's executables."""
        return (self.prefix or self.share) / "lib" / self.name

    def shared_files(self, file_name: str) -> list[Path]:
        """The installed files of this name, anywhere in the share folder."""
        if self.installed is None:
            return sorted(path for path in self.share.rglob(file_name) if path.is_file())
        found = {place for path, place in self.installed.items() if fnmatchcase(Path(path).name, file_name)}
        return sorted(found)


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
    below = tuple(os.path.join(folder, "") for folder in folders)  # as texts: thousands of modules are slow as paths
    for name, module in list(sys.modules.items()):
        file = getattr(module, "__file__", None)
        if isinstance(file, str) and file.startswith(below):
            del sys.modules[name]
    for folder in folders:
        for cache in list(folder.rglob("__pycache__")):
            with suppress(PermissionError):
                shutil.rmtree(files.check(cache, removes=True), ignore_errors=True)
