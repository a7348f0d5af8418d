"""`MANIFEST.in`: which files besides modules belong to a Python package that says `include_package_data=True`.

Facts: setuptools' documentation of MANIFEST.in. What takes files away again (`exclude`, `prune`) is not read.
"""

from __future__ import annotations

from glob import glob
from pathlib import Path


def files_in_manifest(folder: Path) -> list[str]:
    """The paths of the files that a folder's MANIFEST.in names; none without one."""
    manifest = folder / "MANIFEST.in"
    if not manifest.is_file():
        return []
    lines = manifest.read_text(encoding="utf-8", errors="replace").splitlines()
    return [path for line in lines for path in _named(folder, line.partition("#")[0].split())]


def _named(folder: Path, words: list[str]) -> list[str]:
    match words:
        case ["include", *patterns]:
            places = [folder / pattern for pattern in patterns]
        case ["recursive-include", below, *patterns]:
            places = [folder / below / "**" / pattern for pattern in patterns]
        case ["graft", below]:
            places = [folder / below / "**"]
        case ["global-include", *patterns]:
            places = [folder / "**" / pattern for pattern in patterns]
        case _:
            places = []
    return [path for place in places for path in glob(str(place), recursive=True)]
