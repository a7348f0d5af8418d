"""The terminal's words that change files and folders: rm, cp, mv."""

from __future__ import annotations

import os
import shutil
from pathlib import Path

from ... import files
from .terminal_io import Terminal, options


def rm(terminal: Terminal, words: list[str]) -> int:
    """`rm [-r] [-f] name…`: delete files, and with -r folders."""
    letters, names = options(words)
    if not names and "f" not in letters:
        return terminal.fail("rm: missing operand: name the files to delete, as in rm -r build install log")
    return max((_delete(terminal, name, letters) for name in names), default=0)


def _delete(terminal: Terminal, name: str, letters: set[str]) -> int:
    path = Path(name)
    if not path.exists() and not path.is_symlink():
        return 0 if "f" in letters else terminal.fail(f"rm: cannot remove '{name}': No such file or directory")
    try:
        files.check(path, removes=True)
    except PermissionError as refusal:
        return terminal.fail(f"rm: '{name}' stays where it is: {refusal.strerror}")
    if path.is_symlink() or not path.is_dir():
        path.unlink()
    elif letters & {"r", "R"}:
        shutil.rmtree(path)
    else:
        return terminal.fail(f"rm: cannot remove '{name}': Is a directory. rm -r deletes a folder and everything in it")
    return 0


def cp(terminal: Terminal, words: list[str]) -> int:
    """`cp [-r] from… to`: copy files, and with -r folders."""
    letters, names = options(words)
    if len(names) < 2:
        return terminal.fail("cp: name what to copy, and where to: cp old.py new.py")
    return max(_copy(terminal, name, _target(name, names[-1]), letters) for name in names[:-1])


def _copy(terminal: Terminal, name: str, target: Path, letters: set[str]) -> int:
    source = Path(name)
    if not source.exists():
        return terminal.fail(f"cp: cannot stat '{name}': No such file or directory")
    if not source.is_dir():
        files.check(target)
        shutil.copy(source, target)
    elif not letters & {"r", "R", "a"}:
        return terminal.fail(f"cp: -r not specified; omitting directory '{name}'")
    elif Path(os.path.realpath(target)).is_relative_to(source.resolve()):
        return terminal.fail(f"cp: cannot copy a directory, '{name}', into itself, '{target}'")
    else:
        files.copy(source.resolve(), target)
    return 0


def mv(terminal: Terminal, words: list[str]) -> int:
    """`mv from… to`: rename or move files and folders."""
    _, names = options(words)
    if len(names) < 2:
        return terminal.fail("mv: name what to move, and where to: mv old.py new.py")
    return max(_move(terminal, name, _target(name, names[-1])) for name in names[:-1])


def _move(terminal: Terminal, name: str, target: Path) -> int:
    source = Path(name)
    if not source.exists():
        return terminal.fail(f"mv: cannot stat '{name}': No such file or directory")
    try:
        files.check(source, removes=True)
    except PermissionError as refusal:
        return terminal.fail(f"mv: '{name}' stays where it is: {refusal.strerror}")
    files.check(target, follow=False)
    os.replace(source, target)
    return 0


def _target(name: str, to: str) -> Path:
    """Where a file goes: into a folder that is there, or else to the name itself."""
    place = Path(to)
    return place / os.path.basename(os.path.realpath(name)) if place.is_dir() else place
