"""What `install` and `rosidl_generate_interfaces` refuse, in their own words, and what a build installs for them.

Facts: CMake 3.25, rosidl_cmake 3.1 and rosidl_adapter.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from itertools import dropwhile
from pathlib import Path

from ..idl.model import InvalidDefinition
from ..idl.names import did_you_mean, module_name
from ..idl.registry import FOLDERS, Package, Registry
from ..sim.errors import shown_path
from .cmake import Command, until
from .install_tree import PYTHON_FOLDERS, Item, names_in
from .manifest import Found
from .package import SHARE, BuildFailure, filled, refused

_INSTALLS = ("PROGRAMS", "DIRECTORY", "FILES", "TARGETS", "SCRIPT", "CODE", "EXPORT")
_INSTALL_WORDS = {
    "DESTINATION", "RENAME", "PERMISSIONS", "FILE_PERMISSIONS", "DIRECTORY_PERMISSIONS", "CONFIGURATIONS",
    "COMPONENT", "OPTIONAL", "TYPE", "EXCLUDE_FROM_ALL", "USE_SOURCE_PERMISSIONS", "PATTERN", "REGEX",
    "EXCLUDE", "FILES_MATCHING", "MESSAGE_NEVER",
}  # fmt: skip


def files_to_install(found: Found, command: Command, *, cpp: bool) -> list[str]:
    """The files or folders that one `install(…)` names, none for targets of a package that builds C++.

    Raises BuildFailure where CMake would refuse it.
    """
    kind, *given = command.args or ("",)
    files = until(_INSTALL_WORDS, given)
    if kind not in _INSTALLS:
        hint = did_you_mean(kind, _INSTALLS) or f"Known are {', '.join(_INSTALLS[:3])}."
        raise refused(f"install does not recognize sub-command {kind}", command.where, hint)
    if kind == "TARGETS" and not cpp:
        text = f'install TARGETS given target "{" ".join(files[:1])}" which does not exist.'
        raise refused(text, command.where, "A Python program is installed with install(PROGRAMS …).")
    if kind in _INSTALLS[3:]:
        return []
    for name in files if kind != "DIRECTORY" else ():
        if (found.path / name).is_dir():
            hint = f"Write install(DIRECTORY {name} …)."
            raise refused(f'install {kind} given directory "{name}" to install.', command.where, hint)
    if command.after("RENAME") and len(files) > 1:
        hint = "RENAME gives a single name, so install one program at a time: install(PROGRAMS a.py …)."
        raise refused(f"install {kind} given RENAME option with more than one file.", command.where, hint)
    if not command.after("DESTINATION"):
        hint = f"install({kind} …) needs a DESTINATION, such as lib/${{PROJECT_NAME}}."
        raise refused(f"install {kind} given no DESTINATION!", command.where, hint)
    return files


def install_items(found: Found, command: Command, name: str, hints: list[str]) -> Iterator[Item]:
    """Where a file goes that an `install(…)` names, or a folder, file by file; its content alone if its name ends in `/`.

    What would be wrong on a robot although it builds is added to `hints`.
    """
    source, is_program, at = found.path / name, command.args[0] == "PROGRAMS", f"CMakeLists.txt, line {command.line}"
    destination, shown = command.after("DESTINATION").rstrip("/"), os.path.relpath(source, found.path)
    if not source.resolve().is_relative_to(found.path.resolve()):
        text = f"{shown} lies outside the package's folder"
        raise refused(text, command.where, "Put the files into the package.")
    if not source.exists():
        text = f'file INSTALL cannot find "{shown_path(str(source))}": No such file or directory.'
        close = did_you_mean(shown, names_in(found.path, ".py" if is_program else ""))
        hint = f"{at}, names '{shown}', which does not exist. {close}".strip()
        raise refused(text, "cmake_install.cmake:46 (file)", hint, seconds=1.2)
    own_name = "" if source.is_dir() and name.endswith("/") else command.after("RENAME") or Path(name).name
    target = "/".join(filter(None, (destination, own_name)))
    # Without USE_SOURCE_PERMISSIONS a copy cannot be run, whatever the file itself can. Patterns have no effect.
    options = until({"PATTERN", "REGEX"}, command.args)
    runs = is_program or "OWNER_EXECUTE" in options
    if not source.is_dir():
        if is_program and destination != f"lib/{found.name}":
            hints.append(f"{at}: {shown} goes to {destination}; ros2 run looks only in lib/${{PROJECT_NAME}}.")
        elif is_program and not first_line(source).startswith("#!"):
            hints.append(
                f"{shown} does not begin with '#!/usr/bin/env python3': a real ROS 2 could not start it (Exec format error)."
            )
        yield Item(target, source, program=runs)
        return
    items = []
    for inner in names_in(source):
        can_run = runs or ("USE_SOURCE_PERMISSIONS" in options and os.access(source / inner, os.X_OK))
        items.append(Item("/".join(filter(None, (target, inner))), source / inner, program=can_run))
    if destination == f"lib/{found.name}" and items and not any(item.program for item in items):
        hints.append(
            f"{at}: what install(DIRECTORY …) installs cannot be run. Write "
            "install(PROGRAMS <file>.py … DESTINATION lib/${PROJECT_NAME}), or add USE_SOURCE_PERMISSIONS."
        )
    yield from items


def first_line(file: Path) -> str:
    """The first line of a program; nothing where there is no file."""
    if not file.is_file():
        return ""
    with file.open(encoding="utf-8", errors="replace") as lines:
        return lines.readline()


# -- rosidl_generate_interfaces ----------------------------------------------------------------------------------------

_GROUP = "rosidl_interface_packages"
_WORDS = {"DEPENDENCIES", "LIBRARY_NAME", "SKIP_INSTALL", "SKIP_GROUP_MEMBERSHIP_CHECK", "ADD_LINTER_TESTS"}
_GENERATE = f"{SHARE}/rosidl_cmake/cmake/rosidl_generate_interfaces.cmake"
_ADAPT = f"{SHARE}/rosidl_adapter/cmake/rosidl_adapt_interfaces.cmake:59 (message)"


class InterfaceCheck:
    """Checks one `rosidl_generate_interfaces`, in the order in which the real one finds fault."""

    def __init__(self, found: Found, command: Command) -> None:
        self._found = found
        self._command = command
        self.files = until(_WORDS, command.args[1:])
        self._dependencies = until(_WORDS, list(dropwhile(lambda word: word != "DEPENDENCIES", command.args))[1:])

    def configure(self, finished: bool, seen: set[str]) -> None:
        """What is refused while CMake configures; `finished`: ament_package() was called before, `seen`: what was found."""
        if not self.files:
            raise self._refused(59, "rosidl_generate_interfaces() called without any interface files")
        if finished:
            hint = f"Move ament_package() to the end of CMakeLists.txt, below line {self._command.line}."
            raise self._refused(64, "rosidl_generate_interfaces() must be called before ament_package()", hint)
        folder = self._found.path
        for name in self.files:
            if not (folder / name).is_file():
                text = (
                    f"rosidl_generate_interfaces() the passed file '{name}' doesn't exist relative to the "
                    f"CMAKE_CURRENT_SOURCE_DIR '{shown_path(str(folder))}'"
                )
                there = list(names_in(folder, Path(name).suffix or ".msg"))
                listed = f"There are: {', '.join(there)}." if there else "Write that file first."
                hint = did_you_mean(name, there) or listed
                if name.endswith(","):
                    hint = "CMake separates names by spaces or new lines: leave the commas out."
                raise self._refused(93, text, hint)
        own = Package(self._found.name, folder)
        for name in self.files:
            kind, _, file = name.rpartition("/")
            try:
                if kind not in FOLDERS or not file.endswith(f".{kind}"):
                    reason = "an interface is named as msg/Name.msg, srv/Name.srv or action/Name.action"
                    raise InvalidDefinition(reason).locate(interface=name, file=str(folder / name))
                own.definition(name.removesuffix(f".{kind}"))
            except InvalidDefinition as error:
                raise self._unreadable(error) from None
        for name in self._dependencies:
            if name not in seen:
                reason = f"rosidl_generate_interfaces() the passed dependency '{name}' has not been found before"
                hint = f"Write find_package({name} REQUIRED) above line {self._command.line}."
                raise self._refused(164, f"{reason} using find_package()", hint)

    def check_group(self) -> None:
        """Whether package.xml says that there are interfaces."""
        if _GROUP not in self._found.texts("member_of_group"):
            line = f"<member_of_group>{_GROUP}</member_of_group>"
            text = f"Packages installing interfaces must include '{line}' in their package.xml"
            raise self._refused(229, text, f"Add that line to {self._found.shown}/package.xml, before <export>.")

    def resolve(self, types: Registry) -> None:
        """Whether the fields' types exist: what the C compiler finds out in a real build."""
        known = {self._found.name, *self._dependencies, "builtin_interfaces", "service_msgs"}
        for name in self.files:
            interface = name.rpartition(".")[0]
            file = shown_path(str(self._found.path / name))
            try:
                types.module(self._found.name, interface)
            except InvalidDefinition as error:
                if error.ros_error != "UnknownMessageType":
                    raise self._unreadable(error) from None
                raise self._uncompiled(
                    shown_path(error.file or ""), error.line, error.reason, _located(error)
                ) from None
            definition = types.definition(f"{self._found.name}/{interface}")
            fields = [field for part in (definition, *definition.parts) for field in reversed(part.fields)]
            lines = {field.type.package: field.line for field in fields if field.type.package}
            for package in sorted(lines.keys() - known):
                hint = (
                    f"{file}, line {lines[package]}, uses messages of {package}: in CMakeLists.txt write "
                    f"find_package({package} REQUIRED), and DEPENDENCIES {package} as the last words in "
                    f"rosidl_generate_interfaces(…); in package.xml <depend>{package}</depend>."
                )
                raise self._uncompiled(file, lines[package], f"{package}/msg/…: No such file or directory", hint)

    def _refused(self, line: int, text: str, hint: str = "") -> BuildFailure:
        return refused(text, f"{_GENERATE}:{line} (message)", hint, [self._command.where])

    def _uncompiled(self, file: str, line: int | None, reason: str, hint: str) -> BuildFailure:
        place = file if line is None else f"{file}:{line}"
        text = (
            f"{place}: fatal error: {reason}\ncompilation terminated.\ngmake[1]: *** "
            f"[CMakeFiles/Makefile2:173: CMakeFiles/{self._found.name}__rosidl_generator_c.dir/all] Error 2\n"
            "gmake: *** [Makefile:146: all] Error 2\n"
        )
        return BuildFailure(text, hint, code=2, seconds=1.5)

    def _unreadable(self, error: InvalidDefinition) -> BuildFailure:
        lines = [*filter(None, [error.printed]), f"{error.qualified_ros_error}: {error.reason}"]
        text = "\n\n".join(["execute_process(/usr/bin/python3 -m rosidl_adapter) returned error code 1:", *lines])
        stack = [f"{_GENERATE}:130 (rosidl_adapt_interfaces)", self._command.where]
        return refused(f"{text}\n", _ADAPT, _located(error), stack, seconds=0.3)


def _located(error: InvalidDefinition) -> str:
    """The hint of a fault, after its place."""
    where = shown_path(error.file or "") + ("" if error.line is None else f", line {error.line}")
    return f"{where}: {error.hint}" if error.hint else f"It is in {where}."


def interface_items(found: Found, files: list[str]) -> Iterator[Item]:
    """What is installed for the interface files of a package: definitions, the index, and a Python package.

    Definitions are copied, as the classes are made from these: with --symlink-install, too, a new field counts after a build.
    """
    name = found.name
    yield from (Item(f"share/{name}/{file}", found.path / file, copied=True) for file in files)
    yield Item(f"share/ament_index/resource_index/rosidl_interfaces/{name}", text="\n".join(sorted(files)))
    folder = f"{PYTHON_FOLDERS['cmake']}/{name}"
    yield Item(f"{folder}/__init__.py")
    for kind in FOLDERS:
        modules = {Path(file).stem: module_name(Path(file).stem) for file in files if file.startswith(f"{kind}/")}
        if modules:
            lines = [f"from {name}.{kind}.{module} import {each}  # noqa: F401\n" for each, module in modules.items()]
            yield Item(f"{folder}/{kind}/__init__.py", text="".join(lines))
        for each, module in modules.items():
            text = filled("interface module", package=name, kind=kind, name=each)
            yield Item(f"{folder}/{kind}/{module}.py", text=text)
