"""Copies of pages as they were handed in: found in folders and zip files, with the learner's name where the place tells it;
and what a copy that is graded gets of the machine.

Three layouts are understood: nbgrader's `submitted/STUDENT/ASSIGNMENT/`; Moodle's `NAME_NUMBER_assignsubmission_file/`, or the
same before each file's name; GitHub Classroom's `ASSIGNMENT-submissions/ASSIGNMENT-USER/`.
"""

from __future__ import annotations

import contextlib
import os
import re
import signal
import site
import zipfile
import zlib
from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass, replace
from pathlib import Path
from threading import Thread

import psutil

from .pages import PageError

MOODLE = re.compile(r"([^_]+)(?:_(\d+))?_assignsubmission_file(?:_.*)?")
"""A folder that Moodle makes for a learner or a group (in some releases with a `_` at its end), or how it names a file."""


@dataclass(frozen=True)
class Copy:
    """A notebook that was handed in."""

    path: Path
    """Where it lies; if that is in a zip file, below the zip file's own path."""
    learner: str = ""
    member: str = ""
    """Its name in the zip file."""

    def content(self) -> bytes:
        """What is in it. Raises PageError, which says why it cannot be read."""
        try:
            if self.member:
                archive_path = self.path.parents[len(Path(self.member).parts) - 1]
                with zipfile.ZipFile(archive_path) as archive, archive.open(self.member) as file:
                    found = file.read(LARGEST + 1)
            else:
                with self.path.open("rb") as file:
                    found = file.read(LARGEST + 1)
        except OSError as error:
            raise PageError(f"cannot be read: {error.strerror or error}") from None
        except (zipfile.BadZipFile, RuntimeError, NotImplementedError, zlib.error, EOFError) as error:
            raise PageError(f"cannot be read from the zip file: {error}") from None
        if len(found) > LARGEST:
            raise PageError(f"is larger than {LARGEST // 1_000_000} MB")
        return found


def find(paths: Iterable[Path]) -> list[Copy]:
    """The notebooks that are named, and those in the folders and zip files that are named: each once, in order, but what one
    learner has handed in stands together."""
    found: dict[Copy, Path] = {}
    for path in paths:
        if path.is_dir():
            inside = [each for each in sorted(path.rglob("*.ipynb")) if not _is_hidden(each.relative_to(path))]
            found |= {Copy(each): path for each in inside}
        elif path.suffix.lower() == ".zip" and path.exists():
            try:
                with zipfile.ZipFile(path) as archive:
                    names = sorted(archive.namelist())
            except zipfile.BadZipFile:
                raise PageError(f"{path} is not a zip file") from None
            names = [name for name in names if name.lower().endswith(".ipynb") and not _is_hidden(Path(name))]
            found |= {Copy(path / name, member=name): path for name in names}
        else:
            found[Copy(path)] = path
    owners = [(copy, *_owner(copy.path, root)) for copy, root in found.items()]
    namesakes = Counter(who for who, _ in {(who, number) for _, who, number in owners})
    named = [replace(copy, learner=who.name + (number if namesakes[who] > 1 else "")) for copy, who, number in owners]
    order: dict[str, int] = {}
    return sorted(named, key=lambda copy: order.setdefault(copy.learner or str(copy.path), len(order)))


def _is_hidden(path: Path) -> bool:
    return any(part.startswith(".") or part == "__MACOSX" for part in path.parts)


def _owner(path: Path, root: Path) -> tuple[Path, str]:
    """Whose a copy is that was found in `root`, one of the paths that are named: the learner's name, in the place where names
    were collected, and Moodle's number of the learner. No name in an unknown layout."""
    path, root = Path(os.path.abspath(path)), Path(os.path.abspath(root))
    way = [*reversed(path.parents), path]
    for here in way:
        if found := MOODLE.fullmatch(here.name):
            return here.parent / found[1].strip(), f" ({found[2]})" if found[2] else ""
    for here in way[:-1]:
        place, assignment = here.parent, here.parent.name.removesuffix("-submissions")
        if place.name == "submitted" and place.is_relative_to(root) and here != path.parent:
            return here, ""
        if assignment != place.name and here.name.startswith(f"{assignment}-"):  # made by `gh classroom`
            return place / here.name.removeprefix(f"{assignment}-"), ""
    return Path(), ""


# -- what a copy gets of the machine -----------------------------------------------------------------------------------


TIMEOUT = 300.0
"""Computing time, s, that one copy may take unless told otherwise."""

MEMORY = 2.0
"""Memory, GB, that each process of a copy may take unless told otherwise."""

PATIENCE, LEAST = 4, 240.0
"""How many seconds of real time count as one of computing, for a cell that waits; and the least real time, s, for a copy: it
may have to share the machine with many others."""

LARGEST = 50_000_000
"""Bytes of a notebook, and of an answer, that are read at most."""

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
    seen = [each.info for each in psutil.process_iter(["num_threads", "uids"])]
    threads = sum(each["num_threads"] or 0 for each in seen if each["uids"] and each["uids"].real == os.getuid())
    most = {
        "RLIMIT_AS": round(memory * 1e9),
        "RLIMIT_FSIZE": 200_000_000,  # bytes of one file
        "RLIMIT_CORE": 0,
        "RLIMIT_NOFILE": 2048,
        "RLIMIT_NPROC": threads + 300,  # processes and threads, on top of what the user has already
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


def environment(folder: Path, mark: str, package: str) -> dict[str, str]:
    """The variables of a copy whose home is `folder`; `package` is where the installed lesson is found."""
    kept = {name: value for name, value in os.environ.items() if name in PASSED_ON or name.startswith("LC_")}
    home = dict.fromkeys(("HOME", "USERPROFILE", "TMPDIR", "TEMP", "TMP"), str(folder))
    paths = os.pathsep.join([package, *filter(None, [kept.get("PYTHONPATH")])])
    one_thread = dict.fromkeys(("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS"), "1")
    user = {"PYTHONUSERBASE": site.getuserbase()} if site.ENABLE_USER_SITE else {}
    off = dict.fromkeys(("TURTLE_LESSON_PROGRESS", "TURTLE_LESSON_CACHE"), "off")
    return {**kept, **home, **one_thread, **user, **off, "PYTHONPATH": paths, MARK: mark}


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
