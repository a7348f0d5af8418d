"""A ROS package as the index knows it, and how to take one as it lies in its source folder."""

from __future__ import annotations

import os
import shutil
import sys
from collections.abc import Callable, Iterable
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path

from ..runtime import files
from ..sim.errors import shown_path
from ..stdlib.program import run_program
from .cmake import CMakeFile, Program, read_cmake
from .errors import PackageError
from .manifest import Manifest, read_manifest

Target = Path | Callable[[], object]
"""What an executable is: a Python file, or a callable that is its `main()`."""

GROUP = "rosidl_interface_packages"
GENERATORS = "rosidl_default_generators"


@dataclass
class Package:
    """One package that can be found.

    Attributes:
        name: its name.
        share: the folder in which its launch files and other data are found.
        executables: what `ros2 run` and `Node(executable=…)` find, by name.
        interfaces: its definitions relative to `share`, such as `msg/TurtleStatus.msg`.
        source: the folder in which it was written, or None.
        prefix: the folder that it is installed in; None for one that is used as it lies there.
        installed: for a package used as it lies there, what would be in its share folder after a build, by
            the path that it would have there; None means everything under `share`.
        warnings: what would go wrong with it on a robot although it can be used here.
        modules: for an ament_python package used as it lies there, the folders in which its modules lie.
    """

    name: str
    share: Path
    executables: dict[str, Target] = field(default_factory=dict)
    interfaces: list[str] = field(default_factory=list)
    source: Path | None = None
    prefix: Path | None = None
    installed: dict[str, Path] | None = None
    warnings: list[str] = field(default_factory=list)
    modules: list[Path] = field(default_factory=list)

    @property
    def libexec(self) -> Path:
        """The folder in which a real ROS 2 looks for the package's executables."""
        return (self.prefix or self.share) / "lib" / self.name

    def shared_files(self, file_name: str) -> list[Path]:
        """The installed files of this name, anywhere in the share folder."""
        if self.installed is None:
            return sorted(path for path in self.share.rglob(file_name) if path.is_file())
        found = []
        for path, place in self.installed.items():
            if place.is_dir():
                found += [inner for inner in place.rglob(file_name) if inner.is_file()]
            elif Path(path).name == file_name:
                found.append(place)
        return sorted(set(found))


def read_source_package(folder: Path | str) -> Package:
    """Take a package as it lies in its source folder, as if it had just been built and sourced.

    Raises:
        PackageError, CMakeError: what a build would refuse, with the file, the line and what to try.
    """
    folder = Path(folder).resolve()
    if not folder.is_dir():
        raise PackageError(f"there is no folder {shown_path(str(folder))}")
    manifest = read_manifest(folder / "package.xml")
    if manifest.build_type == "ament_python":
        return _read_ament_python(folder, manifest)
    if manifest.build_type != "ament_cmake":
        reason = f"build_type {manifest.build_type} cannot be used here; use ament_cmake or ament_python"
        raise PackageError(reason, manifest.file)
    return _read_ament_cmake(folder, manifest)


def _read_ament_python(folder: Path, manifest: Manifest) -> Package:
    """What a build would install, used where it lies."""
    from .ament_python import SITE, build_ament_python  # not for each start of a lesson
    from .discover import read_found
    from .install_tree import Environment

    outcome = build_ament_python(
        read_found(folder, folder), Environment(folder / "install", folder / "build", symlink=True)
    )
    if outcome.code:
        raise PackageError(f"a build would refuse it:\n{outcome.stderr.strip()}", folder / "setup.py")
    share, libexec = f"share/{manifest.name}/", f"lib/{manifest.name}/"
    modules = {item.source.parent for item in outcome.items if item.source and item.target.startswith(f"{SITE}/")}
    programs = [item for item in outcome.items if item.program and item.target.startswith(libexec)]
    return Package(
        name=manifest.name,
        share=folder,
        executables={
            item.target.removeprefix(libexec): PythonProgram(
                item.source or folder / item.target, tuple(sorted(modules)), None if item.source else item.text
            )
            for item in programs
        },
        source=folder,
        installed={
            item.target.removeprefix(share): item.source
            for item in outcome.items
            if item.source and item.target.startswith(share)
        },
        modules=sorted(modules),
        warnings=[line.removeprefix("Hint: ") for line in outcome.stderr.splitlines() if line.startswith("Hint: ")],
    )


def _read_ament_cmake(folder: Path, manifest: Manifest) -> Package:
    file = folder / "CMakeLists.txt"
    if not file.is_file():
        reason = "it is missing: an ament_cmake package is built from its CMakeLists.txt"
        raise PackageError(reason, file, hint="Or is this an ament_python package?")
    cmake = read_cmake(file)
    _check_project(cmake, manifest, file)
    _check_interfaces(cmake, manifest, folder, file)
    programs = [program for program in cmake.programs() if program.destination == f"lib/{manifest.name}"]
    return Package(
        name=manifest.name,
        share=folder,
        executables={program.name: _program_file(program, folder, file) for program in programs},
        interfaces=[name for name, _ in cmake.interfaces()],
        source=folder,
        installed=_installed(cmake, manifest, folder, file),
        warnings=_warnings(cmake, programs, folder, file),
    )


def _check_project(cmake: CMakeFile, manifest: Manifest, file: Path) -> None:
    project = cmake.project()
    if project.args[0] != manifest.name:
        both = f"project({project.args[0]}) and <name>{manifest.name}</name> in package.xml"
        reason = f"{both} must be the same name"
        raise PackageError(reason, file, project.line)
    for command in cmake.named("add_executable") + cmake.named("add_library"):
        what = f"{command.name}({' '.join(command.args[:1])} …)"
        reason = f"{what} builds a C++ program; only Python is run here"
        raise PackageError(reason, file, command.line)
    if not cmake.named("ament_package"):
        reason = "there is no ament_package(): without it the package is not found; write it last"
        raise PackageError(reason, file)


def _check_interfaces(cmake: CMakeFile, manifest: Manifest, folder: Path, file: Path) -> None:
    generated = cmake.named("rosidl_generate_interfaces")
    if not generated:
        return
    line = generated[0].line
    if GENERATORS not in cmake.found_packages():
        reason = 'Unknown CMake command "rosidl_generate_interfaces"'
        raise PackageError(reason, file, line, hint=f"Write find_package({GENERATORS} REQUIRED) before it.")
    if GROUP not in manifest.groups:
        line_of_xml = f"<member_of_group>{GROUP}</member_of_group>"
        reason = f"Packages installing interfaces must include '{line_of_xml}' in their package.xml"
        raise PackageError(reason, file, line, hint="Add that line to package.xml, before <export>.")
    for name, line in cmake.interfaces():
        if Path(name).suffix not in {".msg", ".srv", ".action"}:
            raise PackageError(f"'{name}' is not an interface file: it must end in .msg, .srv or .action", file, line)
        if not (folder / name).is_file():
            hint = _others(folder, f"*{Path(name).suffix}")
            reason = f"rosidl_generate_interfaces names '{name}', which does not exist"
            raise PackageError(reason, file, line, hint)


def _program_file(program: Program, folder: Path, file: Path) -> Path:
    path = folder / program.source
    if not path.is_file():
        reason = f"install(PROGRAMS {program.source} …) names a file that does not exist"
        raise PackageError(reason, file, program.line, hint=_others(folder, "*.py"))
    first = path.read_bytes().split(b"\n", 1)[0].decode("utf-8", "replace")
    if first.startswith("#!") and "python" not in first:
        reason = f"install(PROGRAMS {program.source} …): its first line, {first!r}, does not ask for Python"
        raise PackageError(reason, file, program.line)
    return path


def _others(folder: Path, pattern: str) -> str:
    """A hint that lists the files of this kind which do exist."""
    names = sorted(path.relative_to(folder).as_posix() for path in folder.rglob(pattern))
    return f"There are: {', '.join(names[:10])}." if names else f"There is no {pattern} in the package yet."


def _installed(cmake: CMakeFile, manifest: Manifest, folder: Path, file: Path) -> dict[str, Path]:
    """What a build would put into the package's share folder, by its path there."""
    share = f"share/{manifest.name}"
    found = {"package.xml": folder / "package.xml"}
    for entry in [*cmake.directories(), *cmake.files()]:
        path = folder / entry.source
        if not path.exists():
            reason = f"install() names '{entry.source}', which does not exist"
            raise PackageError(reason, file, entry.line, hint=f"Create it, or remove it from {file.name}.")
        if f"{entry.destination}/".startswith(f"{share}/"):
            place = entry.destination[len(share) :].strip("/")
            name = "" if entry.source.endswith("/") else entry.name or path.name
            found["/".join(filter(None, (place, name)))] = path
    return found


def _warnings(cmake: CMakeFile, programs: list[Program], folder: Path, file: Path) -> list[str]:
    found = []
    for program in programs:
        if not (folder / program.source).read_bytes().startswith(b"#!"):
            found.append(
                f"{program.source} does not begin with '#!/usr/bin/env python3': a real ROS 2 could not "
                "start it (Exec format error)"
            )
    for program in cmake.programs():
        if program not in programs:
            found.append(
                f"{file.name}, line {program.line}: {program.source} goes to {program.destination}; ros2 run "
                "looks only in lib/${PROJECT_NAME}"
            )
    return found


@dataclass(frozen=True)
class PythonProgram:
    """What runs such a program.

    Attributes:
        path: the file, which is read at each start; one that does not exist stands for `text`.
        folders: the folders of its modules.
        text: the code of a program that no file holds, as an entry point used without a build.
    """

    path: Path
    folders: tuple[Path, ...]
    text: str | None = None

    def __call__(self) -> None:
        run_program(self.path, self.folders, self.text)


def forget_below(folders: Iterable[Path]) -> None:
    """Have the modules in these folders be imported anew, from what the files say now.

    Compiled files in the learner's folder are deleted, too: Python takes them for good if the source has the same size and
    second.
    """
    folders = tuple(folders)
    below = tuple(os.path.join(folder, "") for folder in folders)  # as texts: thousands of modules are slow as paths
    for name, module in list(sys.modules.items()):
        file = getattr(module, "__file__", None)
        if isinstance(file, str) and file.startswith(below):
            del sys.modules[name]
    for folder in folders:
        for cache in list(folder.rglob("__pycache__")):
            with suppress(PermissionError):
                shutil.rmtree(files.check(cache, removes=True), ignore_errors=True)
