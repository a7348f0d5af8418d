"""The learner's files: which of them a command may change, how they are written, and streams that print into them.

A command of the terminal (also a redirection, `ros2 bag record`, `ros2 pkg create`, `colcon build`) changes files in the
learner's folder only, through no `cd`, path or symbolic link, and leaves the lesson's pages in it alone. `check` decides that,
before each change. It is not asked where a call names the place (`lesson.export(to=…)`) or where the learner's own Python code
writes; what Python keeps in a `__pycache__` beside an imported module does not count.
"""

from __future__ import annotations

import errno
import itertools
import os
import shutil
from collections.abc import Callable
from contextlib import suppress
from io import TextIOBase
from pathlib import Path
from typing import TextIO

from .. import hooks
from ..sim.simulation import Simulation

OPENED = "TURTLE_LESSON_OPENED"
"""The environment variable in which `turtle-lesson open` names the folder that it opens JupyterLab on."""

in_use: set[Path] = set()
"""Folders in which a bag is being recorded: they stay where they are until it is complete."""

_opened = os.environ.get(OPENED)  # read once: `export` in the terminal does not widen the learner's folder
_home: Path | None = None
_of_notebook = False

last_cd: Path | None = None
"""Where the terminal's last `cd` went, or None."""


def here() -> Path:
    """The current folder; the computer's home where somebody has deleted the current one."""
    try:
        return Path.cwd()
    except FileNotFoundError:
        return Path.home()


def home() -> Path:
    """What `~` is: the folder in which the notebook began; in a Python program, the one that was current at `start()`."""
    if _home is None:
        begin()
    return _home or here()


def begin(*, notebook: bool = False) -> None:
    """A notebook begins in the current folder, or a Python program begins a world in it; a notebook keeps its folder."""
    global _home, _of_notebook
    if notebook or not _of_notebook:
        _home, _of_notebook = Path(os.path.realpath(here())), notebook


def begin_terminal() -> None:
    """A new terminal begins where the notebook began: undo what `cd` did."""
    global last_cd
    if last_cd is not None and here() == last_cd and home().is_dir():
        os.chdir(home())
    last_cd = None
    begin()


def places() -> tuple[Path | None, bool, Path | None]:
    """Where the notebook and its terminal are, for `set_places` to put back."""
    return _home, _of_notebook, last_cd


def set_places(there: tuple[Path | None, bool, Path | None]) -> None:
    """Put back what `places()` has told; (None, False, None) is a program that has not begun."""
    global _home, _of_notebook, last_cd
    _home, _of_notebook, last_cd = there


def begin_notebook() -> None:
    """The notebook begins: its folder is what `~` is from now on."""
    if last_cd is None:
        begin(notebook=True)


def folder() -> Path:
    """The learner's folder: the one that `turtle-lesson open` was given, if the notebook is in it, or else `home()`."""
    return Path(_opened) if _opened and home().is_relative_to(_opened) else home()


def check(path: str | os.PathLike[str], *, follow: bool = True, removes: bool = False) -> Path:
    """The file or folder that a path leads to, if a command may write, make or remove it.

    Without `follow` the change is one of the link at the path's end, as it always is where something `removes` it.
    Raises PermissionError with a sentence for the learner if the command may not, OSError for a name that no file can have.
    """
    path = Path(path)
    itself = (removes or not follow) and path.name not in {"", ".."}
    try:
        place = Path(os.path.realpath(path.parent), path.name) if itself else Path(os.path.realpath(path))
        os.fsencode(place)
    except UnicodeEncodeError as error:
        why = f"no file can have this name where Python encodes names as {error.encoding}: set PYTHONUTF8=1 and start it again"
        raise OSError(errno.EILSEQ, why, str(path)) from None
    mine = folder()
    if removes and any(each.is_relative_to(place) for each in (mine, home(), here())):
        why = "the current folder or the notebook's is in it"
    elif removes and any(each.is_relative_to(place) for each in in_use):
        why = "a bag is being recorded in it; stop that first (jobs lists it)"
    elif not place.is_relative_to(mine):
        why = f"it is outside your folder ({mine}). To change it on purpose, use Python or !command in a cell"
    elif place.parent in {mine, home()} and hooks.is_page(place) and os.path.lexists(place):
        why = "it is a page of the lesson. Change a copy of another name, or use JupyterLab's list of files on purpose"
    else:
        return place
    raise PermissionError(errno.EPERM, why, str(path))


def save(path: Path, text: str) -> None:
    """Write a command's text; folders are made as needed. Raises OSError, also where `check` refuses."""
    place = check(path)
    place.parent.mkdir(parents=True, exist_ok=True)
    place.write_text(text, encoding="utf-8")


def copy(source: Path, target: Path) -> None:
    """Copy a file, or a folder with all that is in it; links in it stay links. Raises OSError, also where `check` refuses."""
    if source.is_symlink():
        place = check(target, follow=False)
        place.unlink(missing_ok=True)
        place.symlink_to(os.readlink(source))
    elif source.is_dir():
        place = check(target)
        if target.is_symlink():  # through which a folder could be copied into itself, for ever
            why = "a link has its name, and no folder takes the place of a link"
            raise FileExistsError(errno.EEXIST, why, str(target))
        place.mkdir(parents=True, exist_ok=True)
        for name in sorted(os.listdir(source)):
            copy(source / name, target / name)
    else:
        shutil.copy(source, check(target))


def unused(numbered: Callable[[int], Path]) -> Path:
    """The first of `numbered(1)`, `numbered(2)`, … that is not there yet."""
    return next(path for path in map(numbered, itertools.count(1)) if not path.exists())


def write(file: Path, text: str) -> None:
    """Write a text file of the lesson's own in one step, also where an interrupt or a full disk comes between.

    Folders are made as needed. The file keeps its permissions, and a link keeps pointing to it. Raises OSError, with the old
    text still in place.
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


# -- streams that print into others ------------------------------------------------------------------------------------


class BorrowedStream(TextIOBase):
    """A text stream that prints into another one, which lives on when nobody holds this one any more."""

    def writable(self) -> bool:
        """It can be written to."""
        return True

    def __del__(self) -> None:
        """Python would flush it, wherever the running code stands: in Jupyter that waits, and swallows an interrupt."""


class CellOutput(BorrowedStream):
    """A text stream that prints in the running cell's ordinary output, also what a process says on its stderr."""

    def __init__(self, simulation: Simulation) -> None:
        self._simulation = simulation

    def write(self, text: str) -> int:
        """Print a text, as it is."""
        return self._simulation.cell_stdout.write(text)

    def flush(self) -> None:
        """Show what was written."""
        self._simulation.cell_stdout.flush()


class FileOutput(BorrowedStream):
    """A text stream that appends to a file as long as anybody prints: behind `>`, a program may outlast its command.

    No file stays open. What is printed after its folder was removed is lost, as on Linux. `instead_of` is the stream that
    it stands for: a command's note that its program goes on belongs there.
    """

    def __init__(self, path: Path, instead_of: TextIO) -> None:
        self._path = path.absolute()
        self._file = self._identity()
        self.instead_of = instead_of

    def write(self, text: str) -> int:
        """Append a text, as it is."""
        if self._identity() != self._file:  # somebody has put another in its place, or a link
            check(self._path)
        with suppress(FileNotFoundError), self._path.open("a", encoding="utf-8", errors="surrogateescape") as file:
            file.write(text)
        return len(text)

    def _identity(self) -> tuple[int, int] | None:
        with suppress(OSError):
            about = self._path.stat()
            return about.st_dev, about.st_ino
        return None
