"""What `colcon build` makes of an `ament_cmake` package: CMake's three steps, configure, build and install, on paper.

Commands are looked at in the order in which CMake carries them out, so that the first fault found is the one that a real
build reports, at its line. Facts: CMake 3.25 and ament_cmake 1.3; only what a package of Python files meets.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from difflib import get_close_matches
from pathlib import Path, PurePosixPath

from ..idl.names import did_you_mean
from ..sim.errors import shown_path
from .cmake import CMakeFile, Command, evaluate, split_at
from .cmake_commands import (
    Entry,
    InterfaceCheck,
    asks_for_python,
    definitions,
    install_entries,
    install_items,
    interface_items,
)
from .index import CMAKE_COMMANDS, CMAKE_PACKAGES, COMMANDS_OF, PYTHON_PACKAGES, brought_by, package_hint, why_not_here
from .install_tree import PYTHON_FOLDERS, Environment, Item, Outcome, check_targets, files_in, prefix_of, with_hint
from .manifest import Found, faults_in, hint_for
from .package import SHARE, BuildFailure, cmake_message, filled, refused

_PACKAGE_XML = f"{SHARE}/ament_cmake_core/cmake/core/ament_package_xml.cmake"
_EXTENSIONS = f"{SHARE}/ament_cmake_core/cmake/core/ament_execute_extensions.cmake"
_HOOKS = (
    f"{SHARE}/ament_cmake_core/cmake/environment_hooks/ament_environment_hooks.cmake:29 (message)",
    f"{SHARE}/ament_cmake_core/cmake/environment_hooks/ament_cmake_environment_hooks_package_hook.cmake:20 "
    "(ament_environment_hooks)",
    f"{_EXTENSIONS}:48 (include)",
    f"{SHARE}/ament_cmake_core/cmake/core/ament_package.cmake:73 (ament_execute_extensions)",
)
_TWICE = (
    "ament_environment_hooks() must be called before ament_generate_package_environment() (which is invoked by "
    "ament_package())"
)
_OLD = 'if given arguments:\n\n  "ament_cmake_core" "IN_LIST" "_ARG_EXCLUDE"\n\nUnknown arguments specified'
_QUIET = {"STATUS", "VERBOSE", "DEBUG", "TRACE", "CHECK_START", "CHECK_PASS", "CHECK_FAIL", "CONFIGURE_LOG"}
_SITE = PYTHON_FOLDERS["cmake"]
_MODULES = (
    "CTest", "GNUInstallDirs", "CMakePackageConfigHelpers", "FetchContent", "ExternalProject", "CheckCXXCompilerFlag",
)  # fmt: skip


def build_ament_cmake(found: Found, environment: Environment) -> Outcome:
    """Build one package: what it prints, and what is to be installed if nothing is refused."""
    again = (environment.build / found.name / "colcon_build.rc").is_file()
    build = _Build(found, environment)
    try:
        outcome = build.run()
    except BuildFailure as failure:
        text, code = "".join(build.warnings) + failure.text, failure.code
        if (
            again
            and code == 1
            and text.startswith(("CMake Error at CMakeLists", "CMake Error at /opt", "Error parsing"))
        ):
            text += "gmake: *** [Makefile:786: cmake_check_build_system] Error 1\n"
            code = 2
        return Outcome(code, with_hint(text, [failure.hint, *build.hints]), seconds=failure.seconds)
    outcome.seconds = (0.7 if again else 1.2) + 2.0 * build.changed_interfaces()
    return outcome


class _Build:
    """The build of one package."""

    def __init__(self, found: Found, environment: Environment) -> None:
        self.found = found
        self.environment = environment
        self.seen: set[str] = set()
        self.commands: set[str] = set(CMAKE_COMMANDS)
        self.finished = False
        self.modern = False
        self.checks: list[InterfaceCheck] = []
        self.warnings: list[str] = []
        self.hints: list[str] = []
        self.entries: list[Entry] = []
        self.python: list[Item] = []
        self.cpp = False
        self.lacking: list[str] = []
        self.project, self.project_line = "Project", 1  # as CMake pretends where there is no project()

    @property
    def interfaces(self) -> tuple[str, ...]:
        return tuple(file for check in self.checks for file in check.files)

    def run(self) -> Outcome:
        cmake = self._read()
        self.cpp = cmake.builds_cpp or bool(cmake.compiled)
        self.commands |= cmake.defined
        self._warn_of_catkin()
        if cmake.passed_over:
            blocks = " and ".join(f"{name}() in line {line}" for name, line in cmake.passed_over)
            self.warnings.append(
                f"Warning: CMakeLists.txt: {blocks} cannot be carried out here: what lies inside is passed over. All else "
                "is built; write out what is missing.\n"
            )
        for command in cmake.commands:
            self._configure(command)
        if not self.finished:
            self.hints.append(
                "There is no ament_package() in CMakeLists.txt: without it ROS 2 does not find the package. Write it last."
            )
        if self.environment.compiles:
            types = self.environment.types  # of the package's own, only those that CMakeLists.txt names
            if self.found.name in types.packages():
                types.remove(self.found.name)
            types.add(self.found.name, self.found.path, self.interfaces)
            for check in self.checks:
                check.resolve(types)
        foreign = [entry for entry in self.entries if not asks_for_python(self.found, entry)]
        wanted = [entry for entry in self.entries if entry not in foreign]
        items = [item for entry in wanted for item in install_items(self.found, entry, self.hints)]
        items += [*self.python, *interface_items(self.found, self.interfaces)] if self.checks else self.python
        check_targets(items)
        self._warn_of_mode(items)
        self._warn_of_definitions()
        self._warn_of_setup_py()
        stdout = [f"-- Found {name}" for name in sorted(self.seen)]
        stdout += ["-- Configuring done", "-- Generating done"]
        return Outcome(
            stderr=with_hint("".join(self.warnings), self.hints),
            stdout=stdout,
            items=items,
            dependencies=self.found.runtime_dependencies,
            left_out=[*cmake.compiled, *(entry.name for entry in foreign)],
            lacking=self.lacking,
        )

    def changed_interfaces(self) -> int:
        """How many interfaces are others than the last build has installed."""
        share = prefix_of(self.environment.install, self.found.name) / "share" / self.found.name
        pairs = [(share / file, self.found.path / file) for file in self.interfaces]
        return sum(not old.is_file() or old.read_bytes() != new.read_bytes() for old, new in pairs)

    def _read(self) -> CMakeFile:
        folder = self.found.path
        file = folder / "CMakeLists.txt"
        if not file.is_file():
            text = f'CMake Error: The source directory "{shown_path(str(folder))}" does not appear to contain CMakeLists.txt.\n'
            hint = "An ament_cmake package is built from its CMakeLists.txt. Or is this an ament_python package?"
            if (folder / "setup.py").is_file():
                hint = (
                    "There is a setup.py: if this is to be an ament_python package, say so in package.xml: "
                    "<build_type>ament_python</build_type>."
                )
            raise BuildFailure(text, hint, seconds=0.1)
        try:
            source = file.read_text(encoding="utf-8")
        except (OSError, UnicodeDecodeError) as error:
            raise BuildFailure(f"CMake Error: CMakeLists.txt cannot be read: {error}\n", seconds=0.1) from None
        cmake = evaluate(source, folder)
        if any(command.name == "project" for command in cmake.commands):
            return cmake
        self.warnings.append(_NO_PROJECT)
        self.hints.append(f"Write project({self.found.name}) below cmake_minimum_required(…).")
        return evaluate(f"project(Project) {source}", folder)

    # -- configure -------------------------------------------------------------------------------------------------

    def _configure(self, command: Command) -> None:
        where = f"CMakeLists.txt:{command.line} ({command.name})"
        if command.name not in self.commands:
            if self.lacking and not get_close_matches(command.name, self.commands, cutoff=0.85):
                return  # a command of a package that is not here, and no slip of the pen
            raise self._unknown(command, where)
        about_targets = command.name == "install" and command.args[:1] in {
            ("TARGETS",),
            ("EXPORT",),
            ("CODE",),
            ("SCRIPT",),
        }
        if self.cpp and (about_targets or command.name in {"add_subdirectory", "include"}):
            return
        if command.name in _EMPTY and not command.args:
            name, hint = _EMPTY[command.name]
            raise refused(f"{name} called with incorrect number of arguments", where, hint)
        special: Callable[[Command, str], None] | None = getattr(self, f"_on_{command.name}", None)
        if special is not None:
            special(command, where)

    def _unknown(self, command: Command, where: str) -> BuildFailure:
        packages = brought_by(command.name)
        if "rosidl_default_generators" in packages and command.name.startswith("rosidl"):
            packages = ["rosidl_default_generators"]
        hint = (
            f"Write find_package({packages[0]} REQUIRED) above line {command.line}."
            if packages
            else did_you_mean(command.name, self.commands | {"rosidl_generate_interfaces"})
        )
        return refused(f'Unknown CMake command "{command.name}".', where, hint)

    def _on_cmake_minimum_required(self, command: Command, where: str) -> None:
        self.modern = True

    def _on_project(self, command: Command, where: str) -> None:
        self.project, self.project_line = command.args[0], command.line

    def _on_include(self, command: Command, where: str) -> None:
        name = "".join(command.args[:1])
        if name in _MODULES or "OPTIONAL" in command.args:
            return
        if name and (self.found.path / name).is_file():
            raise refused(f"include({name}) is not understood here.", where, _ELSEWHERE)
        raise refused(f"include could not find requested file:\n\n  {name}", where)

    def _on_add_subdirectory(self, command: Command, where: str) -> None:
        name = "".join(command.args[:1])
        if name and (self.found.path / name).is_dir():
            raise refused(f"add_subdirectory({name}) is not understood here.", where, _ELSEWHERE)
        raise refused(f'add_subdirectory given source "{name}" which is not an existing directory.', where)

    def _on_message(self, command: Command, where: str) -> None:
        kind, text = (command.args or ("",))[0], "".join(command.args[1:])
        if kind in {"FATAL_ERROR", "SEND_ERROR"}:  # CMake would go on after SEND_ERROR, and fail in the end
            raise refused(text, where)
        if kind in {"WARNING", "AUTHOR_WARNING", "DEPRECATION"}:
            self.warnings.append(cmake_message(text, where, kind="Warning"))
        elif kind not in _QUIET:
            self.warnings.append("".join(command.args[kind == "NOTICE" :]) + "\n")

    def _on_find_package(self, command: Command, where: str) -> None:
        name, required = command.args[0], "REQUIRED" in command.args
        known = {*CMAKE_PACKAGES, *self.environment.findable, *self.environment.types.packages()}
        if name in (known - {self.found.name}) | self.environment.findable:
            self._has_found(name)
        elif "QUIET" in command.args and not required:
            return
        elif why_not_here(name) or (self.cpp and not package_hint(name, known)):
            self.lacking.append(name)
            self.commands |= COMMANDS_OF.get(name, frozenset())
        else:
            said = filled("CMake: package not found", name=name, lower=name.lower()).removesuffix("\n")
            text = cmake_message(said, where, kind="Error" if required else "Warning")
            hint = package_hint(name, known) or (
                f"Is {name} the right name? If it is a package of this workspace, write <depend>{name}</depend> in "
                "package.xml, so that it is built first."
            )
            if name in PYTHON_PACKAGES:
                hint = f"{name} is a Python package, which CMake cannot find: name it only in package.xml."
            if required:
                raise BuildFailure(text, hint)
            self.warnings.append(text)
            self.hints.append(hint)

    def _has_found(self, name: str) -> None:
        self.seen.add(name)
        self.commands |= COMMANDS_OF.get(name, frozenset())

    def _on_ament_auto_find_build_dependencies(self, command: Command, where: str) -> None:
        known = {*CMAKE_PACKAGES, *self.environment.findable, *self.environment.types.packages()}
        for name in known.intersection(self.found.dependencies):
            self._has_found(name)

    def _on_rosidl_generate_interfaces(self, command: Command, where: str) -> None:
        check = InterfaceCheck(self.found, command)
        check.configure(self.finished, self.seen)
        self._check_xml(where, f"{SHARE}/rosidl_cmake/cmake/rosidl_generate_interfaces.cmake:226 (ament_package_xml)")
        check.check_group()
        self.checks.append(check)
        self._check_python_packages(where)

    def _on_ament_python_install_package(self, command: Command, where: str) -> None:
        name = "".join(command.args[:1])
        shown = command.after("PACKAGE_DIR") or name
        folder = self.found.path / shown
        if not (folder / "__init__.py").is_file():
            text = f"ament_python_install_package() the Python package folder '{shown}' doesn't exist"
            raise refused(text, where, f"Make {shown}/__init__.py, which may be empty.")
        self.python += [
            Item(f"{_SITE}/{name}/{file.relative_to(folder).as_posix()}", file) for file in files_in(folder)
        ]
        self._check_python_packages(where)
        self.commands |= COMMANDS_OF["ament_cmake_core"]  # which it finds (ament_cmake_python-extras.cmake)

    def _check_python_packages(self, where: str) -> None:
        """A package that generates interfaces must not install a Python package of the same name.

        In whichever order: rosidl_generator_py calls ament_python_install_package(), too, and CMake refuses the second
        target of one name (ros2/rosidl_python, issue 141).
        """
        name = self.found.name
        if not self.checks or all(item.target != f"{_SITE}/{name}/__init__.py" for item in self.python):
            return
        text = (
            f'add_custom_target cannot create target "ament_cmake_python_copy_{name}" because another target with the '
            "same name already exists. The existing target is a custom target created in source directory "
            f'"{shown_path(str(self.found.path))}". See documentation for policy CMP0002 for more details.'
        )
        place = f"{SHARE}/ament_cmake_python/cmake/ament_python_install_package.cmake:114 (add_custom_target)"
        hint = (
            f"The interfaces already make a Python package {name}: install the nodes as programs instead, "
            f"install(PROGRAMS {name}/<file>.py DESTINATION lib/${{PROJECT_NAME}} RENAME <name>)."
        )
        raise refused(text, place, hint, [where])

    def _on_ament_python_install_module(self, command: Command, where: str) -> None:
        file = self.found.path / "".join(command.args[:1])
        if file.suffix != ".py" or not file.is_file():
            text = f"ament_python_install_module() the Python module file '{file}' doesn't exist"
            raise refused(text, where, "Name a file that is there, as seen from CMakeLists.txt.")
        self.python.append(
            Item((PurePosixPath(_SITE) / command.after("DESTINATION_SUFFIX") / file.name).as_posix(), file)
        )

    def _on_ament_package(self, command: Command, where: str) -> None:
        if self.finished:
            raise refused(_TWICE, _HOOKS[0], f"Delete line {command.line}.", (*_HOOKS[1:], where))
        self._check_xml(where, f"{SHARE}/ament_cmake_core/cmake/core/ament_package.cmake:63 (ament_package_xml)")
        if not self.modern:
            hint = "Write cmake_minimum_required(VERSION 3.8) as the first line of CMakeLists.txt."
            raise refused(_OLD, f"{_EXTENSIONS}:41 (if)", hint, (_HOOKS[3], where))
        self.finished = True

    def _on_ament_auto_package(self, command: Command, where: str) -> None:
        self._on_ament_package(command, where)
        _, names = split_at(command.args, {"INSTALL_TO_SHARE"})
        for name in names[1:]:
            self.entries.append(Entry("DIRECTORY", name, f"share/{self.project}", Path(name).name, command.line))

    def _check_xml(self, where: str, caller: str) -> None:
        faults = [f"The manifest contains invalid XML:\n{self.found.xml_error}"] if self.found.xml_error else []
        if self.found.root is not None:
            faults = faults_in(self.found.root)
        if faults:
            file = shown_path(str(self.found.path / "package.xml"))
            said = "\n".join(faults)
            text = (
                f"Error parsing '{file}':\ncatkin_pkg.package.InvalidPackage: Error(s) in package '{file}':\n{said}\n"
            )
            what = f"{SHARE}/ament_cmake_core/cmake/core/package_xml_2_cmake.py"
            process = f"execute_process(/usr/bin/python3 {what} {file}) returned error code 1"
            hints = [hint_for(fault) for fault in faults]
            if self.found.xml_error:
                hints = ["Is every <tag> closed by a </tag>, and is every < in a text written as &lt;?"]
            stack = [f"{_PACKAGE_XML}:49 (_ament_package_xml)", caller, where]
            message = cmake_message(process, f"{_PACKAGE_XML}:95 (message)", stack)
            raise BuildFailure(text + message, " ".join(filter(None, hints)))
        if self.project != self.found.name:
            text = (
                f"ament_package_xml() package name '{self.found.name}' in '/package.xml' does not match current "
                f"PROJECT_NAME '{self.project}'. You must call project() with the same package name before."
            )
            hint = f"Write project({self.found.name}) in line {self.project_line} of CMakeLists.txt."
            hint = "" if self.hints else hint  # there is none at all, and that is said already
            raise refused(text, f"{_PACKAGE_XML}:53 (message)", hint, [caller, where])

    def _on_install(self, command: Command, where: str) -> None:
        self.entries += install_entries(self.found, command)

    # -- what would be wrong on a robot, although it builds -----------------------------------------------------------

    def _warn_of_mode(self, items: list[Item]) -> None:
        """A link has the mode of the file that it leads to; a copy gets one that can be run."""
        files = [item.source for item in items if item.program and item.source is not None]
        left = [shown_path(str(file)) for file in files if not os.access(file, os.X_OK)]
        if self.environment.symlink and left:
            self.hints.append(
                f"--symlink-install links to {', '.join(left)}, which cannot be run (ros2 run: No executable found): "
                f"!chmod +x {' '.join(left)}"
            )

    def _warn_of_catkin(self) -> None:
        if self.found.root is not None and not self.found.build_type:
            text = "Manually-specified variables were not used by the project:\n\n  CATKIN_INSTALL_INTO_PREFIX_ROOT"
            self.warnings.append(cmake_message(text, "", kind="Warning"))
            self.hints.append(
                "package.xml does not say how to build, so colcon takes it for a package of ROS 1. Add "
                "<export><build_type>ament_cmake</build_type></export>."
            )

    def _warn_of_definitions(self) -> None:
        """Definitions that lie there and that nobody asks for: nothing is made of them, and importing them fails."""
        if left := [file for file in definitions(self.found.path) if file not in self.interfaces]:
            names = " ".join(f'"{file}"' for file in left)
            self.hints.append(
                f"nothing is generated from {', '.join(left)}, which CMakeLists.txt does not name: write {names} in "
                "rosidl_generate_interfaces(${PROJECT_NAME} …)."
            )

    def _warn_of_setup_py(self) -> None:
        file = self.found.path / "setup.py"
        text = file.read_text(encoding="utf-8", errors="replace") if file.is_file() else ""
        if "entry_points" not in text:
            return
        place = f"lib/{self.found.name}"
        hint = f" Install each program in CMakeLists.txt: install(PROGRAMS {self.found.name}/<file>.py DESTINATION "
        hint += "lib/${PROJECT_NAME} RENAME <name>)."
        installed = any(entry.kind == "PROGRAMS" and entry.destination == place for entry in self.entries)
        line = text[: text.index("entry_points")].count("\n") + 1
        self.hints.append(
            f"setup.py, line {line}, lists entry_points, but package.xml says ament_cmake: CMake does not read setup.py, and "
            f"nothing will be installed from them.{'' if installed else hint}"
        )


_EMPTY = {
    "find_package": ("find_package", "It looks like find_package(rclpy REQUIRED)."),
    "project": ("project PROJECT", "Write the package's name in it, as in package.xml."),
    "set": ("set", "It looks like set(NAME value)."),
}
"""What CMake calls the commands that need arguments, and what to try."""

_ELSEWHERE = "Only CMakeLists.txt itself is read here: write the lines of that file into it."
_NO_PROJECT = (
    cmake_message(
        "No project() command is present. The top-level CMakeLists.txt file must contain a literal, direct call to the "
        "project() command. Add a line of code such as\n\n  project(ProjectName)\n\nnear the top of the file, but after "
        'cmake_minimum_required().\n\nCMake is pretending there is a "project(Project)" command on the first line.',
        "",
        kind="Warning (dev) in CMakeLists.txt",
    ).removesuffix("\n")
    + "This warning is for project developers.  Use -Wno-dev to suppress it.\n\n"
)
