"""What `install(…)` in a CMakeLists.txt comes to, and what is wrong with it."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path, PurePosixPath

from ..core.tracebacks import shown_path
from .cmake import CMakeError, CMakeFile, Installed, Program
from .cmake_directory import RUNS, directory_items
from .cmake_text import cmake_message
from .discover import Found
from .errors import did_you_mean
from .outcome import BuildFailure, Item

Entry = Program | Installed


def refused(text: str, where: str, hint: str = "", stack: tuple[str, ...] = ()) -> BuildFailure:
    """An error of CMake's at a place such as `CMakeLists.txt:12 (install)`."""
    return BuildFailure(cmake_message(text, where, stack), hint)


def install_entries(cmake: CMakeFile) -> list[Entry]:
    """All that the file installs, in the order of its lines."""
    entries: list[Entry] = [*cmake.programs(), *cmake.directories(), *cmake.files()]
    return sorted(entries, key=lambda entry: entry.line)


def install_item(found: Found, entry: Entry, hints: list[str]) -> Item:
    """Where one entry goes. What would be wrong on a robot although it builds is added to `hints`."""
    where = f"CMakeLists.txt:{entry.line} (install)"
    place = PurePosixPath(entry.destination)
    if place.is_absolute() or ".." in place.parts or ":" in entry.destination:
        text = f"DESTINATION {entry.destination} lies outside the package's install folder"
        hint = f"Use lib/${{PROJECT_NAME}} for programs and share/${{PROJECT_NAME}} for everything else: share/{found.name}."
        raise refused(text, where, hint)
    source = found.path / entry.source
    if not source.resolve().is_relative_to(found.path.resolve()):
        raise refused(f"{entry.source} lies outside the package's folder", where, "Put the files into the package.")
    if not source.exists() or (isinstance(entry, Program) and not source.is_file()):
        text = f'file INSTALL cannot find "{shown_path(str(source))}": No such file or directory.'
        raise BuildFailure(cmake_message(text, "cmake_install.cmake:46 (file)"), _lacking(found, entry), seconds=1.2)
    if isinstance(entry, Program):
        _check_program(found, entry, source, hints)
    inside = isinstance(entry, Installed) and entry.source.endswith("/")
    name = "" if inside else entry.name or Path(entry.source).name
    target = "/".join(filter(None, (entry.destination, name)))
    return Item(target, source, program=isinstance(entry, Program))


def install_items(found: Found, entry: Entry, hints: list[str]) -> list[Item]:
    """The same, a folder file by file."""
    item = install_item(found, entry, hints)
    if isinstance(entry, Program) or item.source is None:
        return [item]
    if not item.source.is_dir():
        return [replace(item, program=RUNS in entry.options)]
    items = directory_items(item.target, item.source, entry.options)
    if entry.destination == f"lib/{found.name}" and not any(each.program for each in items) and items:
        hints.append(
            f"CMakeLists.txt, line {entry.line}: what install(DIRECTORY …) installs cannot be run. Write install(PROGRAMS "
            "<file>.py … DESTINATION lib/${PROJECT_NAME}), or add USE_SOURCE_PERMISSIONS."
        )
    return items


def _lacking(found: Found, entry: Entry) -> str:
    paths = sorted(found.path.rglob("*.py" if isinstance(entry, Program) else "*"))
    there = [path.relative_to(found.path).as_posix() for path in paths if "__pycache__" not in path.parts]
    close = did_you_mean(entry.source.rstrip("/"), there)
    return f"CMakeLists.txt, line {entry.line}, names '{entry.source}', which does not exist. {close}".strip()


def asks_for_python(found: Found, entry: Program) -> bool:
    """Whether a program can run here: its first line names no other interpreter. Of a file that is not there it is true."""
    source = found.path / entry.source
    first = source.read_bytes().split(b"\n", 1)[0] if source.is_file() else b""
    return not first.startswith(b"#!") or b"python" in first


def _check_program(found: Found, entry: Program, source: Path, hints: list[str]) -> None:
    first = source.read_bytes().split(b"\n", 1)[0].decode("utf-8", "replace")
    if entry.destination != f"lib/{found.name}":
        hints.append(
            f"CMakeLists.txt, line {entry.line}: {entry.source} goes to {entry.destination}; ros2 run looks only in "
            "lib/${PROJECT_NAME}."
        )
    elif not first.startswith("#!"):
        hints.append(
            f"{entry.source} does not begin with '#!/usr/bin/env python3': a real ROS 2 could not start it (Exec format "
            "error)."
        )


def unreadable(error: CMakeError) -> BuildFailure:
    """Text that is no CMake, or needs more of it than is understood here."""
    hint = f"CMakeLists.txt, line {error.line}: {error.reason}." if error.words else ""
    failure = refused(error.words or error.reason, f"CMakeLists.txt:{error.place}", hint)
    failure.seconds = 0.1
    return failure
