"""Copies of pages as they were handed in: found in folders and zip files, with the learner's name where the place tells it.

Three layouts are understood: nbgrader's `submitted/STUDENT/ASSIGNMENT/`; Moodle's `NAME_NUMBER_assignsubmission_file/`, or the
same before each file's name; GitHub Classroom's `ASSIGNMENT-submissions/ASSIGNMENT-USER/`, or such clones side by side.
"""

from __future__ import annotations

import os
import re
import zipfile
import zlib
from collections import defaultdict
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from functools import lru_cache
from itertools import takewhile
from pathlib import Path

from .limits import LARGEST
from .pages import PageError

MOODLE = re.compile(r"([^_]+)(?:_(\d+))?_assignsubmission_file(?:_.*)?")
"""A folder that Moodle makes for a learner or a group (in some releases with a `_` at its end), or how it names a file."""

SUBMITTED = "submitted"
"""nbgrader's folder of what it has collected."""

OF_A_COURSE = ("nbgrader_config.py", "gradebook.db")
"""What shows that a folder above the one that is named is nbgrader's folder of a course."""

CLONED = "-submissions"
"""How the folder's name ends that `gh classroom clone student-repos` makes for an assignment."""


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
        except FileNotFoundError:
            raise PageError("does not exist") from None
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
            inside = sorted(path.rglob("*.ipynb"))
            found |= dict.fromkeys((Copy(each) for each in inside if not _is_hidden(each.relative_to(path))), path)
        elif path.suffix.lower() == ".zip" and path.exists():
            try:
                with zipfile.ZipFile(path) as archive:
                    names = [name for name in sorted(archive.namelist()) if name.lower().endswith(".ipynb")]
            except zipfile.BadZipFile:
                raise PageError(f"{path} is not a zip file") from None
            found |= dict.fromkeys(
                (Copy(path / name, member=name) for name in names if not _is_hidden(Path(name))), path
            )
        else:
            found[Copy(path)] = path
    copies = _named(found)
    first: dict[str, int] = {}
    for number, copy in enumerate(copies):
        first.setdefault(copy.learner or str(copy.path), number)
    return sorted(copies, key=lambda copy: first[copy.learner or str(copy.path)])


def _is_hidden(path: Path) -> bool:
    return any(part.startswith(".") or part == "__MACOSX" for part in path.parts)


def _named(copies: Mapping[Copy, Path]) -> list[Copy]:
    """The same copies, with their learners' names. Those of one name in one place get Moodle's numbers, too.

    Args:
        copies: and in which of the paths that are named each was found.
    """
    owners = [_owner(Path(os.path.abspath(copy.path)), Path(os.path.abspath(root))) for copy, root in copies.items()]
    numbers: dict[tuple[Path, str], set[str]] = defaultdict(set)
    for place, name, number in owners:
        numbers[place, name].add(number)
    return [
        replace(copy, learner=f"{name} ({number})" if number and len(numbers[place, name]) > 1 else name)
        for copy, (place, name, number) in zip(copies, owners, strict=True)
    ]


def _owner(path: Path, root: Path) -> tuple[Path, str, str]:
    """Where copies were collected, whose this one is, and Moodle's number of the learner; no name in an unknown layout."""
    parts = path.parts
    for index, part in enumerate(parts):
        if found := MOODLE.fullmatch(part):
            return Path(*parts[:index]), found[1].strip(), found[2] or ""
    for index, part in enumerate(parts[:-3]):
        is_course = any(Path(*parts[:index], name).exists() for name in OF_A_COURSE)
        if part == SUBMITTED and (index >= len(root.parts) - 1 or is_course):
            return Path(*parts[: index + 1]), parts[index + 1], ""
    for index, part in enumerate(parts[:-2]):
        assignment = part.removesuffix(CLONED)
        if assignment != part and parts[index + 1].startswith(f"{assignment}-"):
            return Path(*parts[: index + 1]), parts[index + 1].removeprefix(f"{assignment}-"), ""
    for clone in path.parents[: len(parts) - len(root.parts) - 1]:
        if (clone / ".git").exists() and (assignment := _assignment(clone.parent)):
            return clone.parent, clone.name.removeprefix(f"{assignment}-"), ""
    return path, "", ""


@lru_cache(maxsize=64)
def _assignment(place: Path) -> str:
    """What the names of all clones in a folder have in common before a hyphen; "" if there are not several, or nothing."""
    words = [each.name.split("-") for each in place.iterdir() if (each / ".git").exists()]
    same = takewhile(lambda each: len(set(each)) == 1, zip(*(each[:-1] for each in words), strict=False))
    return "-".join(each[0] for each in same) if len(words) > 1 else ""
