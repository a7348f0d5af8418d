"""What a copy that is graded gets of the machine: variables, a home, time, memory, files and processes; and its end."""

from __future__ import annotations

import contextlib
import os
import shutil
import signal
import site
from collections.abc import Iterable
from pathlib import Path
from threading import Thread

import psutil

TIMEOUT = 300.0
"""Computing time, s, that one copy may take unless told otherwise."""

MEMORY = 2.0
"""Memory, GB, that each process of a copy may take unless told otherwise."""

PATIENCE, LEAST = 4, 240.0
"""How many seconds of real time count as one of computing, for a cell that waits; and the least real time, s, for a copy: it
may have to share the machine with many others."""

LARGEST = 50_000_000
"""Bytes of a notebook, and of an answer, that are read at most."""

PROCESSES = 300
"""How many processes and threads a copy may add to those of the user, where the system limits that."""

LARGEST_FILE = 200_000_000
"""Bytes of one file, where the system limits that."""

PASSED_ON = (
    *("PATH", "LANG", "LANGUAGE", "TZ", "PYTHONPATH", "LD_LIBRARY_PATH", "ROS_DISTRO"),
    *("SYSTEMROOT", "SYSTEMDRIVE", "WINDIR", "COMSPEC", "PATHEXT", "PROCESSOR_ARCHITECTURE", "NUMBER_OF_PROCESSORS"),
)
"""The variables of the teacher's shell that a copy sees, with those that begin with LC_; it sees no other."""

MARK = "TURTLE_LESSON_COPY"
"""The variable by which a copy's processes are known."""

MOST_BYTES, MOST_FILES = 1_000_000_000, 20_000
"""What a copy may have in its folder."""


def real_time(seconds: float) -> float:
    """Real time, s, that a copy may take which may compute for so many seconds."""
    return max(PATIENCE * seconds, LEAST)


def limit(memory: float) -> None:
    """Limit this process and its children, where the system can: memory (GB), files, and how many processes there are."""
    try:
        import resource
    except ImportError:  # Windows
        return
    most = {
        "RLIMIT_AS": round(memory * 1e9),
        "RLIMIT_FSIZE": LARGEST_FILE,
        "RLIMIT_CORE": 0,
        "RLIMIT_NOFILE": 2048,
        "RLIMIT_NPROC": _threads_of_this_user() + PROCESSES,
    }
    for name, value in most.items():
        with contextlib.suppress(AttributeError, OSError, ValueError):  # macOS refuses some
            kind = getattr(resource, name)
            _, hard = resource.getrlimit(kind)
            limit = value if hard == resource.RLIM_INFINITY else min(value, hard)
            resource.setrlimit(kind, (limit, hard))
            try:
                Thread(target=bool).start()
            except RuntimeError:  # in a container: the user has more processes than are seen from within
                resource.setrlimit(kind, (hard, hard))
            else:
                resource.setrlimit(kind, (limit, limit))


def _threads_of_this_user() -> int:
    found = 0
    for each in psutil.process_iter():
        with contextlib.suppress(psutil.Error):
            found += each.num_threads() if each.uids().real == os.getuid() else 0
    return found


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
