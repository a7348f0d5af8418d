"""Runs copies, each by a process of its own, and notes what its checks saw. What that is worth is decided in `grade`.

Whatever a copy does, the others are run, too. The checking code is read before any copy runs.
"""

from __future__ import annotations

import contextlib
import hashlib
import json
import marshal
import os
import secrets
import socket
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Generator, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor, as_completed
from dataclasses import dataclass, field
from pathlib import Path
from queue import Empty, Queue
from threading import Event, Thread
from typing import Any

from ..lab.checks.results import BAD, GOOD
from .copies import LARGEST, Copy, end_all, environment, is_too_full, real_time
from .pages import PageError

GRACE = 15.0
"""Real time, s, that a copy's process has to start and to clean up; after that it is killed."""

HOME = Path(__file__).resolve().parents[1]
FRESH = ("lab/checks/*.py", "lab/troubles/*.py", "lab/words.py", "session/check_target.py")
"""The checking code in the package: what decides whether something that was seen is as it should be."""


@dataclass
class Seen:
    """What was seen of one copy while it ran: raw rows, and no verdict."""

    problem: str = "what ran it was ended from inside, before it was done"
    """Why it could not be run, or not to its end."""
    metadata: Any = None
    """The notebook's."""
    asked: list[str] = field(default_factory=list)
    """The checks that its cells ask for."""
    rows: dict[str, list[dict[str, str]]] = field(default_factory=dict)
    """What each check saw, by its name."""
    errors: list[str] = field(default_factory=list)
    """Cells that raised something, in words."""
    replaced: list[str] = field(default_factory=list)
    """What the copy has replaced in the lesson."""
    changed: list[str] = field(default_factory=list)
    """Files of the installed lesson that are not as they were before."""


Run = Callable[[bytes, Callable[[], bool]], Seen]
"""Runs a notebook, until its end or until the function says that it is to be stopped."""


def run_all(copies: Sequence[Copy], run: Run, jobs: int) -> Generator[tuple[int, Seen]]:
    """Run copies, `jobs` at once; gives the number of each that is done, and what was seen of it."""
    stopped = Event()

    def run_one(copy: Copy) -> Seen:
        try:
            return run(copy.content(), stopped.is_set)
        except PageError as error:
            return Seen(str(error))

    with ThreadPoolExecutor(max_workers=jobs) as pool:
        numbers = {pool.submit(run_one, copy): number for number, copy in enumerate(copies)}
        try:
            for future in as_completed(numbers):
                yield numbers[future], future.result()
        except BaseException:
            stopped.set()
            pool.shutdown(cancel_futures=True, wait=False)
            raise


def checking_code() -> dict[str, Any]:
    """What is sent to a copy's kernel for each check: the observer and the checking code, compiled, and where the lesson is."""
    modules = {}
    for file in sorted(file for pattern in FRESH for file in HOME.glob(pattern)):
        name = ".".join(file.relative_to(HOME.parent).with_suffix("").parts)
        modules[name.removesuffix(".__init__")] = (str(file), _compiled(file))
    return {"observer": _compiled(Path(__file__).with_name("observer.py")), "modules": modules, "home": str(HOME)}


def _compiled(file: Path) -> Any:
    return compile(file.read_bytes(), str(file), "exec", dont_inherit=True)


def installed() -> dict[str, bytes]:
    """A digest of each file of the lesson, as it is on the disk now."""
    files = {file.relative_to(HOME).as_posix(): file for file in HOME.rglob("*.py")}
    return {name: hashlib.sha256(file.read_bytes()).digest() for name, file in files.items()}


class Runner:
    """Runs copies, one by one or some at once, with the checking code that there was when it was made."""

    def __init__(self, timeout: float, memory: float) -> None:
        self.installed = installed()
        self._timeout, self._memory = timeout, memory
        self._sent = marshal.dumps(checking_code())

    def run(self, content: bytes, stopped: Callable[[], bool]) -> Seen:
        """Run a notebook in a folder of its own that is thrown away, until its end or until it is to be stopped."""
        seen = Seen()
        try:
            with tempfile.TemporaryDirectory(prefix="turtle-lesson-", ignore_cleanup_errors=True) as folder:
                for found in self._run(content, Path(folder), stopped):
                    _note(seen, found)
        except OSError as error:  # no more processes, a full disk
            seen.problem = f"it could not be run: {error.strerror}"
        seen.changed = sorted({name for name, _ in self.installed.items() ^ installed().items()})
        return seen

    def _run(self, content: bytes, folder: Path, stopped: Callable[[], bool]) -> Iterator[dict[str, Any]]:
        """What the worker says while it runs a copy. Afterwards nothing that the copy has started runs any longer."""
        home, desk, mark = folder / "home", folder / "desk", secrets.token_hex(8)
        home.mkdir()
        desk.mkdir()
        # A socket, where there is one: a pipe could be opened by the copy, too, through /proc.
        ours, theirs = socket.socketpair() if os.name == "posix" else (None, None)
        process = subprocess.Popen(
            [sys.executable, "-m", "turtle_lesson.teaching.worker", str(desk), str(self._timeout), str(self._memory)],
            cwd=desk,
            env=environment(home, mark, str(HOME.parent)),
            stdin=subprocess.PIPE,
            stdout=theirs.fileno() if theirs is not None else subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            start_new_session=True,
        )
        said: Any = process.stdout
        if ours is not None and theirs is not None:
            theirs.close()
            said = ours.makefile("rb")
            ours.close()  # in truth when that file is closed
        groups = [process.pid]
        lines: Queue[bytes] = Queue()
        with said:
            reader = Thread(target=_read, args=(said, lines), daemon=True)
            reader.start()
            try:
                with contextlib.suppress(BrokenPipeError):
                    process.stdin.write(self._sent + content)  # type: ignore[union-attr]
                    process.stdin.close()  # type: ignore[union-attr]
                for found in self._heard(lines, folder, stopped):
                    groups += [found["kernel"]] if isinstance(found.get("kernel"), int) else []
                    yield found
            finally:
                end_all(groups, mark)
                process.wait()
                reader.join()

    def _heard(self, lines: Queue[bytes], folder: Path, stopped: Callable[[], bool]) -> Iterator[dict[str, Any]]:
        """What comes, until the end, or until too much time is over or too much is written."""
        seconds = real_time(self._timeout) + GRACE
        end = time.monotonic() + seconds
        while time.monotonic() < end and not stopped():
            try:
                line = lines.get(timeout=0.5)
            except Empty:
                if is_too_full(folder):
                    yield {"problem": "it wrote too many files, or too large ones, and was stopped"}
                    return
                continue
            try:
                found = json.loads(line)
            except ValueError:  # the end, or half a line
                return
            yield found
        yield {"problem": f"it did not end within {seconds:g} s of real time, and was killed"}


def _read(file: Any, lines: Queue[bytes]) -> None:
    """Put each line into the queue, and an empty one at the end."""
    with contextlib.suppress(OSError, ValueError):
        while line := file.readline(LARGEST):
            lines.put(line)
    lines.put(b"")


def _note(seen: Seen, found: dict[str, Any]) -> None:
    """Add what the worker has found.

    The rows of a check take the place of earlier ones that were not all good; nothing is good in a copy that has replaced
    checking code.
    """
    seen.problem = found.get("problem", "" if found.get("end") else seen.problem)
    seen.metadata = found.get("metadata", seen.metadata)
    seen.asked = found.get("asked", seen.asked)
    if "check" in found:
        seen.replaced += [each for each in found["replaced"] if each not in seen.replaced]
        name, rows = str(found["check"]), [{key: str(value) for key, value in row.items()} for row in found["rows"]]
        miss = ("a lesson to look at, and an end of the check", "there was none")
        if seen.replaced:
            miss = ("the lesson's own code, as it was installed", f"this copy replaced {', '.join(seen.replaced)}")
        if seen.replaced or not rows:
            rows.insert(0, {"mark": BAD, "expected": miss[0], "seen": miss[1], "next": ""})
        if name not in seen.rows or any(row["mark"] != GOOD for row in seen.rows[name]):
            seen.rows[name] = rows
    elif "error" in found:
        seen.errors.append(found["error"])
