"""Grading copies: each is run by a process of its own, so that whatever it does, the others are graded, too."""

from __future__ import annotations

import contextlib
import json
import os
import signal
import subprocess
import sys
import tempfile
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor, as_completed
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from ..lab.checks.registry import Check, all_checks, checks_of
from ..lab.progress import VARIABLE

TIMEOUT = 60.0
"""Real time, s, that one copy may take unless told otherwise."""

GRACE = 15.0
"""Real time, s, that a copy's process has to start and to clean up; after that it is killed."""

PACKAGE = str(Path(__file__).resolve().parents[2])


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
        return next((f"{row['expected']}: {row['seen']}" for row in self.rows if row["mark"] != "✓"), "")


@dataclass
class Graded:
    """One copy."""

    path: Path
    page: str = ""
    scores: list[CheckScore] = field(default_factory=list)
    problem: str = ""
    """Why it could not be run, or not to its end."""
    errors: list[str] = field(default_factory=list)
    """Cells that raised something, in words."""

    @property
    def earned(self) -> int:
        """Points earned."""
        return sum(each.earned for each in self.scores)

    @property
    def points(self) -> int:
        """Points to be had."""
        return sum(each.points for each in self.scores)


Told = Callable[[int, int, str], object]


def grade(copies: Sequence[Path], timeout: float, jobs: int = 1, told: Told | None = None) -> list[Graded]:
    """Grade copies, some at once; the answers are in the order of the copies. `told` hears of each that is done."""
    with ThreadPoolExecutor(max_workers=jobs) as pool:
        futures = {pool.submit(grade_one, path, timeout): path for path in copies}
        try:
            for done, future in enumerate(as_completed(futures), start=1):
                if told is not None:
                    told(done, len(copies), futures[future].name)
        except KeyboardInterrupt:
            pool.shutdown(cancel_futures=True, wait=False)
            raise
        return [future.result() for future in futures]


def grade_one(path: Path, timeout: float) -> Graded:
    """Run one copy in a folder of its own that is thrown away, and collect what its checks have said."""
    with tempfile.TemporaryDirectory(prefix="turtle-lesson-", ignore_cleanup_errors=True) as folder:
        answer = Path(folder) / "answer.json"
        desk = Path(folder) / "desk"
        desk.mkdir()
        killed = _run(path.resolve(), answer, desk, timeout)
        try:
            said = json.loads(answer.read_text(encoding="utf-8"))
        except (OSError, ValueError):
            said = {
                "problem": f"it did not end within {timeout:g} s, and was killed" if killed else "it could not be run"
            }
    return _scored(path, said)


def _run(path: Path, answer: Path, desk: Path, timeout: float) -> bool:
    """Run the worker; whether it had to be killed."""
    words = [sys.executable, "-m", "turtle_lesson.teaching.worker", str(path), str(answer), str(desk), str(timeout)]
    paths = [PACKAGE, *filter(None, [os.environ.get("PYTHONPATH")])]
    environment = {**os.environ, VARIABLE: "off", "PYTHONPATH": os.pathsep.join(paths)}
    quiet: dict[str, Any] = {"stdin": subprocess.DEVNULL, "stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    process = subprocess.Popen(words, cwd=desk, env=environment, start_new_session=True, **quiet)
    try:
        process.wait(timeout + GRACE)
        return False
    except subprocess.TimeoutExpired:
        return True
    finally:
        _kill(process)


def _kill(process: subprocess.Popen[bytes]) -> None:
    """End a worker. Its kernel notices that its parent is gone, and ends by itself."""
    if process.poll() is None:
        with contextlib.suppress(OSError):
            if hasattr(os, "killpg"):
                os.killpg(process.pid, signal.SIGKILL)
            else:
                process.kill()
        process.wait()


def _scored(path: Path, said: dict[str, Any]) -> Graded:
    """What a worker has said, held against the checks that there are."""
    page = said.get("page", "")
    wanted = {each.name: each for each in checks_of(page)} if page else {}
    known = {each.name: each for each in all_checks()}
    wanted |= {name: known[name] for name in said.get("asked", []) if name in known}
    results = said.get("results", {})
    scores = [_score(each, results.get(each.name)) for each in wanted.values()]
    return Graded(path, page, scores, said.get("problem", ""), said.get("errors", []))


def _score(check: Check, result: dict[str, Any] | None) -> CheckScore:
    if result is None:
        return CheckScore(check.name, check.points, "not run")
    return CheckScore(check.name, check.points, "passed" if result["passed"] else "failed", result["rows"])
