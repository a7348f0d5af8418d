"""Grading copies: each is run by a process of its own, and what it earns is decided here, from the rows that its checks saw.

Whatever a copy does, the others are graded, too. Points, titles and what a check expects are those of this process, which has
read them before any copy ran.
"""

from __future__ import annotations

import contextlib
import hashlib
import json
import marshal
import os
import secrets
import shutil
import signal
import site
import socket
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor, as_completed
from dataclasses import dataclass, field
from pathlib import Path
from queue import Empty, Queue
from threading import Event, Thread
from typing import Any

import psutil

from ..lab.checks.registry import Check, all_checks, checks_of
from ..lab.checks.results import BAD, GOOD
from .pages import page_of
from .worker import LARGEST, real_time

TIMEOUT = 300.0
"""Computing time, s, that one copy may take unless told otherwise."""

MEMORY = 2.0
"""Memory, GB, that each process of a copy may take unless told otherwise."""

PASSED_ON = (
    *("PATH", "LANG", "LANGUAGE", "TZ", "PYTHONPATH", "LD_LIBRARY_PATH", "ROS_DISTRO"),
    *("SYSTEMROOT", "SYSTEMDRIVE", "WINDIR", "COMSPEC", "PATHEXT", "PROCESSOR_ARCHITECTURE", "NUMBER_OF_PROCESSORS"),
)
"""The variables of the teacher's shell that a copy sees, with those that begin with LC_; it sees no other."""

MARK = "TURTLE_LESSON_COPY"
"""The variable by which a copy's processes are known."""

MOST_BYTES, MOST_FILES = 1_000_000_000, 20_000
"""What a copy may have in its folder."""

GRACE = 15.0
"""Real time, s, that a copy's process has to start and to clean up; after that it is killed."""

HOME = Path(__file__).resolve().parents[1]
FRESH = ("lab/checks/*.py", "lab/troubles/*.py", "lab/words.py", "session/check_target.py")
"""The checking code in the package: what decides whether something that was seen is as it should be."""

OWN_CASE = "trouble"
"""The check whose expectations depend on the case that was opened."""


@dataclass
class CheckScore:
    """One check in one copy."""

    name: str
    points: int
    state: str
    """"passed", "failed" or "not run"."""
    rows: list[dict[str, str]] = field(default_factory=list)

    @property
    def earned(self) -> int:
        """All of the points, or none."""
        return self.points if self.state == "passed" else 0

    @property
    def first_miss(self) -> str:
        """What was not as expected, first of all."""
        return next((f"{row['expected']}: {row['seen']}" for row in self.rows if row["mark"] != GOOD), "")


@dataclass
class Graded:
    """One copy."""

    path: Path
    page: str = ""
    scores: list[CheckScore] = field(default_factory=list)
    problem: str = ""
    """Why it could not be run, or not to its end."""
    errors: list[str] = field(default_factory=list)
    """Cells that raised something, and what the copy has replaced in the lesson, in words."""

    @property
    def earned(self) -> int:
        """Points earned."""
        return sum(each.earned for each in self.scores)

    @property
    def points(self) -> int:
        """Points to be had."""
        return sum(each.points for each in self.scores)


Told = Callable[[int, int, Graded], object]


def grade(
    copies: Sequence[Path], timeout: float, jobs: int = 1, told: Told | None = None, memory: float = MEMORY
) -> list[Graded]:
    """Grade copies, some at once; the answers are in the order of the copies. `told` hears of each that is done.

    Args:
        copies: notebooks.
        timeout: computing time, s, that each may take.
        jobs: how many run at once.
        told: is given how many are done, how many there are, and the one that was done last.
        memory: GB that each process of a copy may take, where the system limits that.
    """
    grader = Grader(timeout, memory)
    done = 0
    with ThreadPoolExecutor(max_workers=jobs) as pool:
        futures = [pool.submit(grader.grade, path) for path in copies]
        try:
            for future in as_completed(futures):
                done += 1
                if told is not None:
                    told(done, len(copies), future.result())
        except BaseException:
            grader.stopped.set()
            pool.shutdown(cancel_futures=True, wait=False)
            raise
        return [future.result() for future in futures]


def checking_code() -> dict[str, Any]:
    """What is sent to a copy's kernel for each check: the observer and the checking code, compiled, and where the lesson is."""
    files = sorted(file for pattern in FRESH for file in HOME.glob(pattern))
    names = [".".join((HOME.name, *file.relative_to(HOME).with_suffix("").parts)) for file in files]
    modules = {
        name.removesuffix(".__init__"): (str(file), _compiled(file)) for name, file in zip(names, files, strict=True)
    }
    return {"observer": _compiled(Path(__file__).with_name("observer.py")), "modules": modules, "home": str(HOME)}


def _compiled(file: Path) -> Any:
    return compile(file.read_bytes(), str(file), "exec", dont_inherit=True)


def _installed() -> dict[str, bytes]:
    """A digest of each file of the lesson, as it is on the disk now."""
    files = {file.relative_to(HOME).as_posix(): file for file in HOME.rglob("*.py")}
    return {name: hashlib.sha256(file.read_bytes()).digest() for name, file in files.items()}


class Grader:
    """Grades copies, one by one or some at once, by the checking code and the points that there were when it was made."""

    def __init__(self, timeout: float, memory: float) -> None:
        self.stopped = Event()
        """Set, it ends all copies that still run."""
        self._timeout, self._memory = timeout, memory
        all_checks()
        self._sent = marshal.dumps(checking_code())
        self._installed = _installed()

    def grade(self, path: Path) -> Graded:
        """Run one copy in a folder of its own that is thrown away, and judge what its checks have seen."""
        said: dict[str, Any] = {"problem": "what ran it was ended from inside, before it was done"}
        rows: dict[str, list[dict[str, str]]] = {}
        errors, replaced = list[str](), list[str]()
        try:
            with tempfile.TemporaryDirectory(prefix="turtle-lesson-", ignore_cleanup_errors=True) as folder:
                for found in self._run(path.resolve(), Path(folder)):
                    if found.get("end"):
                        said["problem"] = ""
                    if "check" in found:
                        replaced += [each for each in found["replaced"] if each not in replaced]
                        _keep_the_best(rows, found, replaced)
                    elif "error" in found:
                        errors.append(found["error"])
                    said |= found
        except OSError as error:  # no more processes, a full disk
            said["problem"] = f"it could not be run: {error.strerror}"
        changed = sorted({name for name, _ in self._installed.items() ^ _installed().items()})
        if any(name.startswith("teaching/") for name in changed):
            said["problem"], rows = "it cannot be graded by a grader that was changed meanwhile", {}
        page = page_of(path, said.get("metadata"))
        errors = [*_remarks(path, page, replaced, changed), *errors]
        return Graded(path, page, _scored(page, said.get("asked", []), rows), said["problem"], errors)

    def _run(self, path: Path, folder: Path) -> Iterator[dict[str, Any]]:
        """What the worker says while it runs a copy. Afterwards nothing that the copy has started runs any longer."""
        home, desk, mark = folder / "home", folder / "desk", secrets.token_hex(8)
        home.mkdir()
        desk.mkdir()
        take_fonts(home)
        words = [
            sys.executable,
            "-m",
            "turtle_lesson.teaching.worker",
            *map(str, (path, desk, self._timeout, self._memory)),
        ]
        # A socket, where there is one: a pipe could be opened by the copy, too, through /proc.
        ours, theirs = socket.socketpair() if os.name == "posix" else (None, None)
        process = subprocess.Popen(
            words,
            cwd=desk,
            env=environment(home, mark, str(HOME.parent)),
            stdin=subprocess.PIPE,
            stdout=theirs.fileno() if theirs is not None else subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            start_new_session=True,
        )
        groups = [process.pid]
        lines: Queue[bytes] = Queue()
        with contextlib.ExitStack() as open_files:
            if theirs is not None and ours is not None:
                theirs.close()
                open_files.enter_context(ours)
            file = open_files.enter_context(ours.makefile("rb") if ours is not None else process.stdout)  # type: ignore[arg-type]
            reader = Thread(target=_read, args=(file, lines), daemon=True)
            reader.start()
            try:
                with contextlib.suppress(BrokenPipeError):
                    process.stdin.write(self._sent)  # type: ignore[union-attr]
                    process.stdin.close()  # type: ignore[union-attr]
                for found in self._heard(lines, folder):
                    groups += [found["kernel"]] if isinstance(found.get("kernel"), int) else []
                    yield found
            finally:
                end_all(groups, mark)
                process.wait()
                reader.join()

    def _heard(self, lines: Queue[bytes], folder: Path) -> Iterator[dict[str, Any]]:
        """What comes, until the end, or until too much time is over or too much is written."""
        seconds = real_time(self._timeout) + GRACE
        end = time.monotonic() + seconds
        while time.monotonic() < end and not self.stopped.is_set():
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


def _remarks(path: Path, page: str, replaced: list[str], changed: list[str]) -> Iterator[str]:
    """What a teacher should know of a copy: what it has replaced, brings along, or claims, and which files were changed."""
    if replaced:
        yield f"from then on its checks earned nothing, because it replaced {', '.join(replaced)}"
    if changed:
        yield f"the installed lesson was changed before this copy was done: {', '.join(changed[:3])}"
    for name in ("turtle_lesson", "rclpy"):
        beside = path.with_name(name)
        if beside.resolve() != HOME and (beside.exists() or beside.with_suffix(".py").exists()):
            yield f"a package {name} lies beside it; the installed one was used"
    named = page_of(path)
    if named and page != named:
        yield f"its metadata say that it is {page}, and its name that it is {named}"


# -- what a copy gets, and its end -------------------------------------------------------------------------------------


def environment(folder: Path, mark: str, package: str) -> dict[str, str]:
    """The variables of a copy whose home is `folder`; `package` is where the installed lesson is found."""
    kept = {name: value for name, value in os.environ.items() if name in PASSED_ON or name.startswith("LC_")}
    home = dict.fromkeys(("HOME", "USERPROFILE", "TMPDIR", "TEMP", "TMP"), str(folder))
    paths = os.pathsep.join([package, *filter(None, [kept.get("PYTHONPATH")])])
    one_thread = dict.fromkeys(("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS"), "1")
    user = {"PYTHONUSERBASE": site.getuserbase()} if site.ENABLE_USER_SITE else {}
    off = dict.fromkeys(("TURTLE_LESSON_PROGRESS", "TURTLE_LESSON_CACHE"), "off")
    return {**kept, **home, **one_thread, **user, **off, "PYTHONPATH": paths, MARK: mark}


def take_fonts(folder: Path) -> None:
    """Copy matplotlib's list of fonts into a copy's home: without it, the first picture takes seconds longer."""
    theirs = folder / ".cache" / "matplotlib"
    for each in (Path.home() / ".cache" / "matplotlib").glob("fontlist-*.json"):
        theirs.mkdir(parents=True, exist_ok=True)
        with contextlib.suppress(OSError):
            shutil.copy(each, theirs)


def is_too_full(folder: Path) -> bool:
    """Whether a copy has more in its folder than it may have."""
    size = files = 0
    for place, _, names in os.walk(folder):
        for name in names:
            files += 1
            with contextlib.suppress(OSError):
                size += os.lstat(os.path.join(place, name)).st_size
        if size > MOST_BYTES or files > MOST_FILES:
            return True
    return False


def end_all(groups: Iterable[int], mark: str) -> None:
    """End process groups as a whole, and every process that still has the mark among its variables."""
    for group in groups:
        with contextlib.suppress(OSError, AttributeError):  # Windows has no groups
            os.killpg(group, signal.SIGKILL)
    for _ in range(50):  # those that start others meanwhile
        found = False
        for each in psutil.process_iter():
            with contextlib.suppress(psutil.Error, OSError):
                if each.environ().get(MARK) == mark and each.status() != psutil.STATUS_ZOMBIE:
                    found = True
                    each.kill()
        if not found:
            return


# -- verdicts -----------------------------------------------------------------------------------------------------------


def _keep_the_best(rows: dict[str, list[dict[str, str]]], found: dict[str, Any], replaced: list[str]) -> None:
    """Note the rows of a check, unless they were good before. Nothing is good in a copy that has replaced checking code."""
    name, seen = str(found["check"]), [{key: str(value) for key, value in row.items()} for row in found["rows"]]
    if replaced:
        seen.insert(
            0, _row(BAD, "the lesson's own code, as it was installed", f"this copy replaced {', '.join(replaced)}")
        )
    elif not seen:
        seen = [_row(BAD, "a lesson to look at, and an end of the check", "there was none")]
    if not all(row["mark"] == GOOD for row in rows.get(name, [_row(BAD, "", "")])):
        rows[name] = seen


def _row(mark: str, expected: str, seen: str) -> dict[str, str]:
    return {"mark": mark, "expected": expected, "seen": seen, "next": ""}


def _scored(page: str, asked: list[str], rows: dict[str, list[dict[str, str]]]) -> list[CheckScore]:
    """What was seen, held against the checks that there are."""
    known = {each.name: each for each in all_checks()}
    wanted = {each.name: each for each in checks_of(page)} if page else {}
    wanted |= {name: known[name] for name in asked if name in known}
    return [_score(each, rows.get(each.name)) for each in wanted.values()]


def _score(check: Check, rows: list[dict[str, str]] | None) -> CheckScore:
    """The verdict: everything that the check expects was looked at, and all that was seen is as expected."""
    if rows is None:
        return CheckScore(check.name, check.points, "not run")
    wanted = set() if check.name == OWN_CASE else {each.expected for each in check.expectations}
    passed = all(row["mark"] == GOOD for row in rows) and wanted <= {row["expected"] for row in rows}
    return CheckScore(check.name, check.points, "passed" if passed else "failed", rows)
