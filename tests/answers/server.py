"""Runs a page, and each answer to an exercise in a fork of the process.

The page's cells are run in an IPython shell up to the exercise, earlier exercises by their solutions. An answer is then run
in a child: in place of the exercise's cell, with the cells between that and the check, and the check itself. So the page
before it is run once for all answers. What a child has done to files is undone.
"""

from __future__ import annotations

import contextlib
import gc
import importlib
import io
import json
import os
import resource
import shutil
import sys
import tempfile
import traceback
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import IO, Any

from IPython.core.history import HistoryManager
from IPython.core.interactiveshell import InteractiveShell

from turtle_lesson.ros.sim import interrupts

from . import code_cells

MOST_WORK = 300
"""CPU time, s, after which a child is ended that nothing else has stopped."""


class PageError(Exception):
    """A cell of the page itself raised something."""


def the_shell() -> Any:
    """The shell of this process, which keeps no history of it in a file."""
    HistoryManager.enabled = False  # type: ignore[assignment]  # a trait, which may be replaced by its value
    shell: Any = InteractiveShell.instance()
    shell.display_formatter.active_types = ["text/plain"]  # nobody sees the pictures
    shell.InteractiveTB.set_mode("Minimal")  # nor the stacks, each of which takes up to half a second to be written
    return shell


class Page:
    """A page that is run up to some cell."""

    def __init__(self, name: str, folder: Path) -> None:
        self.cells = code_cells(name)
        self.folder = folder
        self.next = 0
        """The index of the first cell that was not run."""
        self.shell = the_shell()
        self.solutions = {
            cell["exercise"]: cell["source"].partition("\n")[2] for cell in self.cells if "solution" in cell["tags"]
        }

    def run(self, source: str) -> Any:
        """Run a source as a cell: IPython's result."""
        return self.shell.run_cell(source, store_history=True)

    def run_as_solved(self, index: int) -> None:
        """Run a cell of the page, an exercise by its solution. Raises PageError if it fails, and is not meant to."""
        cell = self.cells[index]
        source = self.solutions[cell["exercise"]] if "exercise" in cell["tags"] else cell["source"]
        done = self.run(source)
        error = done.error_before_exec or done.error_in_exec
        if error is not None and "raises-exception" not in cell["tags"]:
            raise PageError(f"code cell {index + 1} raised {type(error).__name__}: {error}\n{source}")

    def place(self, exercise: str, tag: str) -> int:
        """The index of an exercise's cell, or of its check."""
        found = [index for index, cell in enumerate(self.cells) if "exercise" in cell["tags"]]
        at = next(index for index in found if self.cells[index]["exercise"] == exercise)
        if tag == "exercise":
            return at
        return next(i for i, cell in enumerate(self.cells) if i > at and "check" in cell["tags"])

    def go_to(self, exercise: str) -> None:
        """Run all cells before an exercise."""
        while self.next < self.place(exercise, "exercise"):
            self.run_as_solved(self.next)
            self.next += 1

    def verdict(self, exercise: str, sources: list[str], replaced: dict[str, str]) -> dict[str, Any]:
        """Run an answer and the check, here and now: what the check says."""
        at, check = self.place(exercise, "exercise"), self.place(exercise, "check")
        for index in range(self._first_of(replaced, at), at):
            source = self.cells[index]["source"]
            new = next((new for text, new in replaced.items() if text in source), None)
            if new is None:
                self.run_as_solved(index)
            else:
                self.run(new)
        errors = []
        for source in [*sources, *(cell["source"] for cell in self.cells[at + 1 : check])]:
            done = self.run(source)
            if (error := done.error_before_exec or done.error_in_exec) is not None:
                errors.append(f"{type(error).__name__}: {error}")
        done = self.run(self.cells[check]["source"])
        if done.result is None:
            raise PageError(f"the check's cell gave no result: {done.error_before_exec or done.error_in_exec!r}")
        result = done.result
        rows = [
            {
                "mark": row.mark,
                "says": "\n".join((row.expected, row.seen, row.trace, row.advice.symptom, row.advice.direction)),
            }
            for row in result.rows
        ]
        return {"passed": result.passed, "rows": rows, "text": repr(result), "errors": errors}

    def _first_of(self, replaced: dict[str, str], at: int) -> int:
        """The first cell that an answer replaces; `at` if it replaces none. Raises PageError for a text that is ambiguous."""
        first = at
        for text in replaced:
            found = [index for index, cell in enumerate(self.cells[:at]) if text in cell["source"]]
            if len(found) != 1:
                raise PageError(f"{text!r} is in {len(found)} cells before the exercise; it should be in one")
            first = min(first, found[0])
        return first


def results(cells: list[tuple[str, bool]]) -> dict[str, Any]:
    """Run cells, each with whether an error is wanted: the texts of their results, or the first error, as "broken"."""
    shell, said, printed = the_shell(), list[str](), io.StringIO()
    with contextlib.redirect_stdout(printed), contextlib.redirect_stderr(printed):
        for source, wanted in cells:
            done = shell.run_cell(source, store_history=True)
            error = done.error_before_exec or done.error_in_exec
            if error is not None and not wanted:
                return {"broken": f"{type(error).__name__}: {error}\nin:\n{source}\n{printed.getvalue()[-4000:]}"}
            said.append(repr(done.result))
    return {"said": said}


# -- a child for each answer ---------------------------------------------------------------------------------------------


class Kept:
    """A copy of a folder, which is made anew only when the folder has changed since."""

    def __init__(self, folder: Path, place: Path) -> None:
        self.folder, self.place = folder, place
        self.state: dict[str, tuple[int, int]] | None = None

    def keep(self) -> None:
        """Have the copy hold what the folder holds."""
        state = _state(self.folder)
        if state != self.state:
            shutil.rmtree(self.place, ignore_errors=True)
            shutil.copytree(self.folder, self.place, symlinks=True)
            self.state = state

    def put_back(self) -> None:
        """Have the folder hold what its copy holds; the folder itself stays, since it is the current one of this process."""
        if _state(self.folder) == self.state:
            return
        for each in self.folder.iterdir():
            if each.is_dir() and not each.is_symlink():
                shutil.rmtree(each)
            else:
                each.unlink()
        shutil.copytree(self.place, self.folder, symlinks=True, dirs_exist_ok=True)


def in_a_child(page: Page, kept: Kept, exercise: str, sources: list[str], replaced: dict[str, str]) -> dict[str, Any]:
    """The verdict on an answer, from a fork of this process, whose files are put back afterwards."""
    kept.keep()
    said, status = forked(lambda: _reply(page, exercise, sources, replaced))
    kept.put_back()
    if not said:
        return {"broken": f"the child ended with status {status} and said nothing"}
    found: dict[str, Any] = json.loads(said)
    return found


def _reply(page: Page, exercise: str, sources: list[str], replaced: dict[str, str]) -> str:
    """The verdict on an answer, or why there is none, as JSON."""
    resource.setrlimit(resource.RLIMIT_CPU, (MOST_WORK, MOST_WORK + 5))
    printed = io.StringIO()
    try:
        with contextlib.redirect_stdout(printed), contextlib.redirect_stderr(printed):
            reply = page.verdict(exercise, sources, replaced)
    except BaseException:
        reply = {"broken": traceback.format_exc()}
    return json.dumps({**reply, "printed": printed.getvalue()[-4000:]})


def forked(job: Callable[[], str]) -> tuple[str, int]:
    """What a function returns in a fork of this process ("" if it raises), and the status with which the fork ended."""
    reading, writing = os.pipe()
    child = os.fork()
    if child == 0:
        try:
            os.close(reading)
            interrupts.watchdog = interrupts.Watchdog()  # the thread of the old one is not in this process
            said = job()
            with os.fdopen(writing, "w", encoding="utf-8") as stream:
                stream.write(said)
        except BaseException:
            traceback.print_exc()
            os._exit(1)
        os._exit(0)
    os.close(writing)
    with os.fdopen(reading, encoding="utf-8") as stream:
        said = stream.read()
    _, status = os.waitpid(child, 0)
    return said, status


def import_what_these_import(cells: Sequence[str]) -> None:
    """Import here what cells import in a fork of this process, so that no later fork has to."""
    before = set(sys.modules)

    def names() -> str:
        shell = the_shell()
        with tempfile.TemporaryDirectory() as folder:
            os.environ["TURTLE_LESSON_FOLDER"] = folder
            os.chdir(folder)
            with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
                for cell in cells:
                    shell.run_cell(cell)
            os.chdir("/")
        return "\n".join(
            name for name in sys.modules if name not in before and name.partition(".")[0] != "robot_controller"
        )

    said, status = forked(names)
    assert status == 0, said
    for name in said.splitlines():
        with contextlib.suppress(ImportError):  # a program's own
            importlib.import_module(name)


def _state(folder: Path) -> dict[str, tuple[int, int]]:
    """Each file of a folder, with its size and the time of its last change."""
    found = {}
    for here, folders, files in os.walk(folder):
        for name in (*folders, *files):
            status = os.lstat(os.path.join(here, name))
            found[os.path.join(here, name)] = (status.st_size, status.st_mtime_ns)
    return found


# -- requests ------------------------------------------------------------------------------------------------------------


def serve(page: Page, kept: Kept, requests: IO[str], replies: IO[str]) -> None:
    """Answer requests until there are no more. A request for an exercise that is behind is refused."""
    printed = io.StringIO()
    for line in requests:
        request = json.loads(line)
        try:
            with contextlib.redirect_stdout(printed), contextlib.redirect_stderr(printed):
                page.go_to(request["exercise"])
            gc.freeze()
            reply = in_a_child(page, kept, request["exercise"], request["sources"], request["cells"])
        except PageError as error:
            reply = {"broken": str(error)}
        replies.write(json.dumps(reply) + "\n")
        replies.flush()
