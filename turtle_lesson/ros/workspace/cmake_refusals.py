"""What CMake's own commands refuse, in the words of CMake 3.25: each function looks at one command of a CMakeLists.txt.

Only what a package of Python files runs into is here. In one that also builds C++, which is left out, the commands that
serve C++ (`serves_cpp`) are not looked at.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from .cmake import Command
from .errors import did_you_mean

Refusal = tuple[str, str]
"""CMake's words, and what to try."""

_INSTALLS = ("PROGRAMS", "DIRECTORY", "FILES", "TARGETS", "SCRIPT", "CODE", "EXPORT")
_MODULES = {
    "CTest",
    "GNUInstallDirs",
    "CMakePackageConfigHelpers",
    "FetchContent",
    "ExternalProject",
    "CheckCXXCompilerFlag",
}
_ELSEWHERE = "Only CMakeLists.txt itself is read here: write the lines of that file into it"


def refusal(command: Command, folder: Path) -> Refusal | None:
    """What is wrong with a command, or None."""
    look = _LOOKS.get(command.name)
    return look(command, folder) if look else None


def serves_cpp(command: Command) -> bool:
    """Whether a command of a package with C++ in it is about that C++, and about nothing that is built here."""
    about_targets = command.name == "install" and command.args[:1] in {
        ("TARGETS",),
        ("EXPORT",),
        ("CODE",),
        ("SCRIPT",),
    }
    return about_targets or command.name in {"add_subdirectory", "include"}


def _install(command: Command, folder: Path) -> Refusal | None:
    if not command.args:
        return None
    kind, names = command.args[0], command.args[1:]
    if kind not in _INSTALLS:
        hint = did_you_mean(kind, _INSTALLS) or f"Known are {', '.join(_INSTALLS[:3])}."
        return f"install does not recognize sub-command {kind}", hint
    if kind == "TARGETS":
        hint = "A Python program is installed with install(PROGRAMS …)."
        return f'install TARGETS given target "{" ".join(names[:1])}" which does not exist.', hint
    if kind in {"FILES", "PROGRAMS"}:
        end = names.index("DESTINATION") if "DESTINATION" in names else len(names)
        for name in names[:end]:
            if (folder / name).is_dir():
                return f'install {kind} given directory "{name}" to install.', f"Write install(DIRECTORY {name} …)."
    return None


def _include(command: Command, folder: Path) -> Refusal | None:
    name = command.args[0] if command.args else ""
    if name in _MODULES or "OPTIONAL" in command.args:
        return None
    if name and (folder / name).is_file():
        return f"include({name}) is not understood here.", f"{_ELSEWHERE}."
    return f"include could not find requested file:\n\n  {name}", ""


def _add_subdirectory(command: Command, folder: Path) -> Refusal | None:
    name = command.args[0] if command.args else ""
    if name and (folder / name).is_dir():
        return f"add_subdirectory({name}) is not understood here.", f"{_ELSEWHERE}."
    return f'add_subdirectory given source "{name}" which is not an existing directory.', ""


def _set(command: Command, folder: Path) -> Refusal | None:
    return None if command.args else ("set called with incorrect number of arguments", "It looks like set(NAME value).")


def _project(command: Command, folder: Path) -> Refusal | None:
    hint = "Write the package's name in it, as in package.xml."
    return None if command.args else ("project PROJECT called with incorrect number of arguments", hint)


_LOOKS: dict[str, Callable[[Command, Path], Refusal | None]] = {
    "add_subdirectory": _add_subdirectory,
    "include": _include,
    "install": _install,
    "project": _project,
    "set": _set,
}
