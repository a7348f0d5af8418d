"""What `file(GLOB …)` finds, and the folders that `include(GNUInstallDirs)` names."""

from __future__ import annotations

from collections.abc import Sequence
from glob import glob
from pathlib import Path

INSTALL_FOLDERS = {
    f"CMAKE_INSTALL_{name}DIR": folder
    for name, folder in {
        "BIN": "bin", "LIB": "lib", "LIBEXEC": "libexec", "INCLUDE": "include", "DATA": "share", "DATAROOT": "share",
        "DOC": "share/doc", "SYSCONF": "etc", "MAN": "share/man",
    }.items()
}  # fmt: skip
"""The variables that include(GNUInstallDirs) sets."""


def globbed(args: Sequence[str], here: str) -> list[str] | None:
    """What `file(GLOB|GLOB_RECURSE variable [RELATIVE folder] pattern …)` puts into its variable, sorted.

    `here` is the folder of the CMakeLists.txt. None if there are words that are not understood.
    """
    patterns = [word for word in args[2:] if word != "CONFIGURE_DEPENDS"]
    beside = None
    if "RELATIVE" in patterns[:-1]:
        place = patterns.index("RELATIVE")
        beside = patterns[place + 1]
        del patterns[place : place + 2]
    if len(args) < 2 or "LIST_DIRECTORIES" in patterns or beside not in (None, here):
        return None
    found = {
        path.as_posix() for pattern in patterns for path in _matches(Path(here, pattern), args[0] == "GLOB_RECURSE")
    }
    start = "" if beside is None else f"{here}/"
    return [path.removeprefix(start) for path in sorted(found)]


def _matches(pattern: Path, below: bool) -> list[Path]:
    if not below:
        return [Path(path) for path in glob(str(pattern))]
    return [path for path in pattern.parent.rglob(pattern.name) if path.is_file()] if pattern.name else []
