"""`install(DIRECTORY …)`: which files of a folder are installed, and which of them can be run. Facts: CMake's documentation."""

from __future__ import annotations

import os
import re
from collections.abc import Sequence
from dataclasses import dataclass
from fnmatch import fnmatchcase
from pathlib import Path

from .outcome import Item

RUNS = "OWNER_EXECUTE"
_FILTERS = ("PATTERN", "REGEX")


@dataclass(frozen=True)
class Filter:
    """A `PATTERN` or `REGEX` with the words behind it."""

    kind: str
    text: str
    words: frozenset[str]

    def fits(self, path: Path) -> bool:
        """Whether it is about this file or folder: a pattern looks at the last names of the path, a regex at all of it."""
        if self.kind == "REGEX":
            return re.search(self.text, path.as_posix()) is not None
        parts = self.text.strip("/").split("/")
        last = path.parts[-len(parts) :]
        return len(last) == len(parts) and all(map(fnmatchcase, last, parts))


def directory_items(target: str, folder: Path, options: Sequence[str]) -> list[Item]:
    """The files of a folder, as an `install(DIRECTORY …)` with these options installs them below `target`.

    Without USE_SOURCE_PERMISSIONS a copy cannot be run, whatever the file itself can.
    """
    filters = _filters(options)
    excluding = [each for each in filters if "EXCLUDE" in each.words]
    wanted = [each for each in filters if "EXCLUDE" not in each.words]
    items = []
    for place, folders, files in os.walk(folder):
        here = Path(place)
        folders[:] = [name for name in sorted(folders) if name != "__pycache__" and not _any(excluding, here / name)]
        for file in (here / name for name in sorted(files) if not name.endswith(".pyc")):
            if _any(excluding, file) or ("FILES_MATCHING" in options and not _any(wanted, file)):
                continue
            modes = [each.words for each in wanted if each.fits(file) and "PERMISSIONS" in each.words]
            runs = RUNS in modes[0] if modes else _runs(options, file)
            items.append(
                Item("/".join(filter(None, (target, file.relative_to(folder).as_posix()))), file, program=runs)
            )
    return items


def _runs(options: Sequence[str], file: Path) -> bool:
    general = options[: _first_filter(options)]
    if "FILE_PERMISSIONS" in general:
        return RUNS in general[general.index("FILE_PERMISSIONS") :]
    return "USE_SOURCE_PERMISSIONS" in general and os.access(file, os.X_OK)


def _first_filter(options: Sequence[str]) -> int:
    return next((place for place, word in enumerate(options) if word in _FILTERS), len(options))


def _filters(options: Sequence[str]) -> list[Filter]:
    starts = [place for place, word in enumerate(options[:-1]) if word in _FILTERS]
    ends = [*starts[1:], len(options)][: len(starts)]
    return [
        Filter(options[start], options[start + 1], frozenset(options[start + 2 : end]))
        for start, end in zip(starts, ends, strict=True)
    ]


def _any(filters: Sequence[Filter], path: Path) -> bool:
    return any(each.fits(path) for each in filters)
