"""What single commands of a CMakeLists.txt come to, and what CMake and ament refuse about them, in their own words.

First what CMake's own commands refuse (CMake 3.25; only what a package of Python files meets), then `install`, then
`rosidl_generate_interfaces` (rosidl_cmake 3.1 and rosidl_adapter), then `find_package`.
"""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from fnmatch import fnmatchcase
from pathlib import Path, PurePosixPath

from ..idl import names
from ..idl.model import Definition, DuplicateName, InvalidDefinition, MessageDefinition, UnknownMessageType
from ..idl.names import did_you_mean
from ..idl.registry import PARSERS, Registry
from ..sim.errors import shown_path
from .catalog import PYTHON_PACKAGES
from .cmake import INTERFACE_WORDS, CMakeFile, Command, Installed, Program
from .cmake_syntax import SHARE, CMakeError, cmake_message
from .discover import Found
from .index import package_hint
from .install_tree import BuildFailure, Item
from .package import GROUP

Entry = Program | Installed
"""Something that `install(…)` names."""

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

_RUNS = "OWNER_EXECUTE"
_FILTERS = ("PATTERN", "REGEX")

_GENERATE = f"{SHARE}/rosidl_cmake/cmake/rosidl_generate_interfaces.cmake"
_ADAPT = f"{SHARE}/rosidl_adapter/cmake/rosidl_adapt_interfaces.cmake:59 (message)"


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
        return [replace(item, program=_RUNS in entry.options)]
    items = _directory_items(item.target, item.source, entry.options)
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


@dataclass(frozen=True)
class _Filter:
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


def _directory_items(target: str, folder: Path, options: Sequence[str]) -> list[Item]:
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
            runs = _RUNS in modes[0] if modes else _runs(options, file)
            items.append(
                Item("/".join(filter(None, (target, file.relative_to(folder).as_posix()))), file, program=runs)
            )
    return items


def _runs(options: Sequence[str], file: Path) -> bool:
    general = options[: next((place for place, word in enumerate(options) if word in _FILTERS), len(options))]
    if "FILE_PERMISSIONS" in general:
        return _RUNS in general[general.index("FILE_PERMISSIONS") :]
    return "USE_SOURCE_PERMISSIONS" in general and os.access(file, os.X_OK)


def _filters(options: Sequence[str]) -> list[_Filter]:
    starts = [place for place, word in enumerate(options[:-1]) if word in _FILTERS]
    ends = [*starts[1:], len(options)][: len(starts)]
    return [
        _Filter(options[start], options[start + 1], frozenset(options[start + 2 : end]))
        for start, end in zip(starts, ends, strict=True)
    ]


def _any(filters: Sequence[_Filter], path: Path) -> bool:
    return any(each.fits(path) for each in filters)


def _up_to_a_word(words: Sequence[str]) -> list[str]:
    """The words before the next one of `rosidl_generate_interfaces`'s own, such as DEPENDENCIES."""
    end = next((place for place, word in enumerate(words) if word in INTERFACE_WORDS), len(words))
    return list(words[:end])


class InterfaceCheck:
    """Checks one `rosidl_generate_interfaces`, in the order in which the real one finds fault."""

    def __init__(self, found: Found, command: Command, finished: bool, seen: set[str]) -> None:
        self._found = found
        self._command = command
        self._finished = finished  # ament_package() was called before
        self._seen = seen  # what find_package has found
        self._own = f"CMakeLists.txt:{command.line} (rosidl_generate_interfaces)"
        self.files = _up_to_a_word(command.args[1:])
        after = command.args.index("DEPENDENCIES") + 1 if "DEPENDENCIES" in command.args else len(command.args)
        self._dependencies = _up_to_a_word(command.args[after:])

    def configure(self) -> None:
        """What is refused while CMake configures."""
        if not self.files:
            raise self._refused(59, "rosidl_generate_interfaces() called without any interface files")
        if self._finished:
            hint = f"Move ament_package() to the end of CMakeLists.txt, below line {self._command.line}."
            raise self._refused(64, "rosidl_generate_interfaces() must be called before ament_package()", hint)
        for name in self.files:
            self._exists(name)
        for name in self.files:
            self._parses(name)
        for name in self._dependencies:
            if name not in self._seen:
                reason = f"rosidl_generate_interfaces() the passed dependency '{name}' has not been found before"
                hint = f"Write find_package({name} REQUIRED) above line {self._command.line}."
                raise self._refused(164, f"{reason} using find_package()", hint)

    def check_group(self) -> None:
        """Whether package.xml says that there are interfaces."""
        if not self._found.member_of(GROUP):
            line = f"<member_of_group>{GROUP}</member_of_group>"
            text = f"Packages installing interfaces must include '{line}' in their package.xml"
            raise self._refused(229, text, f"Add that line to {self._found.shown}/package.xml, before <export>.")

    def resolve(self, types: Registry) -> None:
        """Whether the fields' types exist: what the C compiler finds out in a real build."""
        known = {self._found.name, *self._dependencies, "builtin_interfaces", "service_msgs"}
        for name in self.files:
            interface = name.rpartition(".")[0]
            try:
                types.module(self._found.name, interface)
            except UnknownMessageType as error:
                raise self._no_type(name, error) from None
            except InvalidDefinition as error:
                raise self._adapter(error) from None
            self._declared(name, known, types)

    def _refused(self, line: int, text: str, hint: str = "") -> BuildFailure:
        return BuildFailure(cmake_message(text, f"{_GENERATE}:{line} (message)", [self._own]), hint)

    def _exists(self, name: str) -> None:
        if (self._found.path / name).is_file():
            return
        text = (
            f"rosidl_generate_interfaces() the passed file '{name}' doesn't exist relative to the "
            f"CMAKE_CURRENT_SOURCE_DIR '{shown_path(str(self._found.path))}'"
        )
        folder = self._found.path
        there = sorted(path.relative_to(folder).as_posix() for path in folder.rglob(f"*{Path(name).suffix or '.msg'}"))
        hint = did_you_mean(name, there) or (f"There are: {', '.join(there)}." if there else "Write that file first.")
        if name.endswith(","):
            hint = "CMake separates names by spaces or new lines: leave the commas out."
        raise self._refused(93, text, hint)

    def _parses(self, name: str) -> None:
        path = self._found.path / name
        suffix = path.suffix[1:]
        if suffix not in PARSERS:
            text = f"AssertionError: Unsupported interface type '{path.suffix}'"
            raise self._adapter_text(text, "An interface file ends in .msg, .srv or .action.")
        if path.parent.name != suffix:
            where = f"{suffix}/{path.name}"
            text = f"{name} does not lie in a folder {suffix}/"
            hint = f'Put it in {suffix}/ and write "{where}": Python\'s `import` expects it there.'
            raise self._adapter_text(text, hint)
        try:
            names.check_package(self._found.name)
            PARSERS[suffix](self._found.name, path.stem, path.read_text(encoding="utf-8"), str(path))
        except InvalidDefinition as error:
            raise self._adapter(error) from None
        except (OSError, UnicodeDecodeError) as error:
            raise self._adapter_text(f"{type(error).__name__}: {error}", f"{name} must be plain text.") from None

    def _adapter(self, error: InvalidDefinition) -> BuildFailure:
        lines = []
        if error.printed:
            lines.append(error.printed)
        elif error.line_text is not None and error.interface and not isinstance(error, DuplicateName):
            package, _, kind = error.interface.split("/")
            lines.append(f"Error processing '{error.line_text}' of '{package}/{kind}': '{error.reason}'")
        lines.append(f"{error.qualified_ros_error}: {error.reason}")
        where, hint = "", error.hint
        if error.file is not None:
            where = shown_path(error.file) + ("" if error.line is None else f", line {error.line}")
            if error.line is None and error.ros_error == "InvalidResourceName":
                hint = f"Name the file {_capital(Path(error.file))}, beginning with a capital letter and without '_'"
        return self._adapter_text("\n\n".join(lines), _located(where, hint))

    def _adapter_text(self, text: str, hint: str) -> BuildFailure:
        whole = f"execute_process(/usr/bin/python3 -m rosidl_adapter) returned error code 1:\n\n{text}\n"
        stack = [f"{_GENERATE}:130 (rosidl_adapt_interfaces)", self._own]
        return BuildFailure(cmake_message(whole, _ADAPT, stack), hint, seconds=0.3)

    def _no_type(self, name: str, error: UnknownMessageType) -> BuildFailure:
        file = shown_path(str(self._found.path / name))
        place = file if error.line is None else f"{file}:{error.line}"
        text = (
            f"{place}: fatal error: {error.reason}\ncompilation terminated.\ngmake[1]: *** "
            f"[CMakeFiles/Makefile2:173: CMakeFiles/{self._found.name}__rosidl_generator_c.dir/all] Error 2\n"
            "gmake: *** [Makefile:146: all] Error 2\n"
        )
        where = file if error.line is None else f"{file}, line {error.line}"
        return BuildFailure(text, _located(where, error.hint), code=2, seconds=1.5)

    def _declared(self, name: str, known: set[str], types: Registry) -> None:
        """Types of another package need that package in DEPENDENCIES."""
        lines = _packages_in(types.definition(f"{self._found.name}/{name.rpartition('.')[0]}"))
        for package in sorted(lines.keys() - known):
            file = shown_path(str(self._found.path / name))
            text = (
                f"{file}:{lines[package]}: fatal error: {package}/msg/…: No such file or directory\n"
                "compilation terminated.\ngmake: *** [Makefile:146: all] Error 2\n"
            )
            hint = (
                f"{file}, line {lines[package]}, uses messages of {package}: in CMakeLists.txt write find_package({package} "
                f"REQUIRED), and DEPENDENCIES {package} as the last words in rosidl_generate_interfaces(…); in package.xml "
                f"<depend>{package}</depend>."
            )
            raise BuildFailure(text, hint, code=2, seconds=1.5)


def _packages_in(definition: Definition) -> dict[str, int]:
    """The packages whose messages a definition's own fields are, each with the line that says so."""
    if isinstance(definition, MessageDefinition):
        return {field.type.package: field.line for field in reversed(definition.fields) if field.type.package}
    parts = [getattr(definition, part, None) for part in ("request", "response", "goal", "result", "feedback")]
    return {package: line for part in parts if part is not None for package, line in _packages_in(part).items()}


def _capital(file: Path) -> str:
    """The name that a definition file should have."""
    return "".join(word[:1].upper() + word[1:] for word in re.split(r"[^A-Za-z0-9]+", file.stem)) + file.suffix


def _located(where: str, hint: str) -> str:
    """A hint that begins with the place of the fault."""
    if not where:
        return hint
    return f"{where}: {hint}" if hint else f"It is in {where}."


def not_found(name: str, line: int, required: bool, known: set[str]) -> tuple[str, str]:
    """CMake's words for a package that `find_package` does not find, and what to try."""
    text = (
        f'By not providing "Find{name}.cmake" in CMAKE_MODULE_PATH this project has asked CMake to find a package '
        f'configuration file provided by "{name}", but CMake did not find one.\n\nCould not find a package '
        f'configuration file provided by "{name}" with any of the following names:\n\n  {name}Config.cmake\n'
        f'  {name.lower()}-config.cmake\n\nAdd the installation prefix of "{name}" to CMAKE_PREFIX_PATH or set '
        f'"{name}_DIR" to a directory containing one of the above files. If "{name}" provides a separate development '
        "package or SDK, be sure it has been installed.\n"
    )
    kind = "Error" if required else "Warning"
    message = cmake_message(text.rstrip("\n"), f"CMakeLists.txt:{line} (find_package)", kind=kind)
    if name in PYTHON_PACKAGES:
        return message, f"{name} is a Python package, which CMake cannot find: name it only in package.xml."
    return message, package_hint(name, known) or (
        f"Is {name} the right name? If it is a package of this workspace, write <depend>{name}</depend> in package.xml, "
        "so that it is built first."
    )
