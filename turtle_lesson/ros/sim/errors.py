"""What can go wrong with simulated time, and tracebacks that end at the learner's own line."""

from __future__ import annotations

import os
import re
import site
import sys
import tempfile
import traceback
from collections.abc import Callable
from pathlib import Path
from sysconfig import get_path
from types import TracebackType
from typing import TextIO

# -- errors -------------------------------------------------------------------------------------------------------
# What can go wrong with simulated time, each said in words that help.


class SimulationError(RuntimeError):
    """The simulation was used in a way that cannot work."""


class NeverWakes(SimulationError):
    """A call waits for something that can never happen."""


class DriveTimeout(SimulationError):
    """A notebook cell waited very long in robot time for something that did not happen."""


class NeverReturns(SimulationError):
    """A callback computes on and on and lets no time pass, so that nothing else can happen."""


class OutOfTime(BaseException):
    """The world has reached the end that was set for it; no `except Exception` has it go on."""


class WorldClosed(SimulationError):
    """Something of an earlier world was used after `start()` had made a fresh one."""


# -- tracebacks ---------------------------------------------------------------------------------------------------
# Tracebacks for learners: the frames of their own code, ending at their own line, with paths that say something.
# The frames of this package are left out (unless nothing else is there), and so are the little carets under the code,
# which differ between Python versions.

OUR_FOLDER = str(Path(__file__).resolve().parents[2]) + os.sep
FINISHED_FOLDER = os.path.join(OUR_FOLDER, "robot_controller", "")
PACKAGE_FOLDER = str(Path(__file__).resolve().parents[3]) + os.sep
LIBRARY_FOLDER = os.path.dirname(os.__file__) + os.sep
INSTALLED_FOLDERS = tuple(
    os.path.join(folder, "") for folder in (*site.getsitepackages(), site.getusersitepackages(), get_path("purelib"))
)

before_showing: Callable[[BaseException], None] | None = None
"""Called with each error before it is shown: it may add a note of what to try."""

_GUESS = re.compile(r"\. Did you (?:mean|forget)[^\n]*\?$")
_CELL = re.compile(r"ipykernel_\d+[/\\]|^<ipython-input-")


def is_ours(filename: str) -> bool:
    """Whether a file is part of this package, or of Python itself, and so no concern of a learner's."""
    if filename.startswith(LIBRARY_FOLDER):
        return "site-packages" not in filename
    if filename.startswith(OUR_FOLDER):
        return not filename.startswith(FINISHED_FOLDER)  # the finished nodes are there to be read
    return filename.startswith(("generated/", "<generated ", "<frozen "))


def is_library(filename: str) -> bool:
    """Whether a file is part of Python itself, of a package that was installed, or of this one."""
    return is_ours(filename) or filename.startswith(INSTALLED_FOLDERS)


def is_learners(filename: str) -> bool:
    """Whether a file, or a cell, is a learner's own code; what Python makes of a text, as for a dataclass, is not."""
    return not is_library(filename) and (not filename.startswith("<") or bool(_CELL.search(filename)))


def traceback_entries(trace: TracebackType | None) -> list[TracebackType]:
    """All entries of a traceback, outermost first."""
    entries = []
    while trace is not None:
        entries.append(trace)
        trace = trace.tb_next
    return entries


def learners_frames(trace: TracebackType | None) -> list[TracebackType]:
    """The entries of a traceback that belong to a learner's code, outermost first."""
    return [entry for entry in traceback_entries(trace) if not is_ours(entry.tb_frame.f_code.co_filename)]


def shorten(trace: TracebackType | None) -> TracebackType | None:
    """A traceback with only the learner's frames; the whole one if there are none."""
    shortened: TracebackType | None = None
    for entry in reversed(learners_frames(trace)):
        shortened = TracebackType(shortened, entry.tb_frame, entry.tb_lasti, entry.tb_lineno)
    return shortened or trace


def shown_path(filename: str) -> str:
    """A file's name as a learner knows it, the same on every machine where that is possible."""
    if _CELL.search(filename):
        return "a cell of this notebook"
    if filename.startswith(OUR_FOLDER):
        return filename[len(PACKAGE_FOLDER) :].replace(os.sep, "/")
    if not os.path.isabs(filename):
        return filename
    here, file = Path.cwd(), Path(filename)
    for steps, folder in enumerate((here, here.parent)):  # what is further up is clearer by its whole path
        everybodys = len(folder.parts) == 1 or (steps and folder == Path(tempfile.gettempdir()))
        if file.is_relative_to(folder) and not everybodys:
            return "../" * steps + file.relative_to(folder).as_posix()
    return filename


def format_error(error: BaseException) -> str:
    """The text of an error as Python prints it, cut to the learner's own frames."""
    if before_showing is not None:
        before_showing(error)
    text = ""
    if error.__cause__ is not None:
        cause = format_error(error.__cause__)
        text = f"{cause}\nThe above exception was the direct cause of the following exception:\n\n"
    text += "Traceback (most recent call last):\n"
    frames = learners_frames(error.__traceback__)
    if not frames and not isinstance(error, SyntaxError):  # which names its own file and line
        frames = traceback_entries(error.__traceback__)
    for entry in frames:
        code = entry.tb_frame.f_code
        text += f'  File "{shown_path(code.co_filename)}", line {entry.tb_lineno}, in {code.co_name}\n'
        if line := traceback.extract_tb(entry, limit=1)[0].line:
            text += f"    {line.strip()}\n"
    said = traceback.format_exception_only(type(error), error)
    if isinstance(error, (AttributeError, NameError, ImportError)) and not _GUESS.search(str(error)):
        said[0] = _GUESS.sub("", said[0].rstrip("\n")) + "\n"  # what newer Pythons guess, and the error itself does not
    return text + "".join(said)


def print_error(error: BaseException, stream: TextIO | None = None) -> None:
    """Print an error with the learner's frames."""
    print(format_error(error), end="", file=stream or sys.stderr)
