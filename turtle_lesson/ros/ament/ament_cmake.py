"""What `colcon build` makes of an `ament_cmake` package: CMake's three steps, configure, build and install, on paper.

Commands are looked at in the order in which CMake carries them out, so that the first fault found is the one that a real
build reports, at its line.
"""

from __future__ import annotations

import os
from difflib import get_close_matches
from pathlib import Path

from ..idl.names import did_you_mean
from ..idl.registry import Registry
from ..sim.errors import shown_path
from .catalog import CMAKE_COMMANDS, CMAKE_PACKAGES, COMMANDS_OF, brought_by, why_not_here
from .cmake import CMakeFile, Command, Program, evaluate
from .cmake_commands import (
    InterfaceCheck,
    asks_for_python,
    install_entries,
    install_items,
    not_found,
    refusal,
    refused,
    serves_cpp,
    unreadable,
)
from .cmake_syntax import SHARE, CMakeError, cmake_message
from .discover import Found
from .index import package_hint
from .install_tree import (
    PYTHON,
    BuildFailure,
    Environment,
    Item,
    Outcome,
    check_targets,
    definitions,
    interface_items,
    prefix_of,
    with_hint,
)
from .manifest import faults_in, hint_for

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
_PYTHON_PLACE = f"local/lib/{PYTHON}/dist-packages"


def build_ament_cmake(found: Found, environment: Environment) -> Outcome:
    """Build one package: what it prints, and what is to be installed if nothing is refused."""
    again = (environment.build / found.name / "colcon_build.rc").is_file()
    build = _Build(found, environment, again)
    try:
        return build.run()
    except BuildFailure as failure:
        text, code = "".join(build.warnings) + failure.text, failure.code
        if (
            again
            and code == 1
            and text.startswith(("CMake Error at CMakeLists", "CMake Error at /opt", "Error parsing"))
        ):
            text += "gmake: *** [Makefile:786: cmake_check_build_system] Error 1\n"
            code = 2
        text = with_hint(text, [failure.hint, *build.hints])
        return Outcome(code=code, stderr=text, seconds=failure.seconds)


class _Build:
    """The build of one package."""

    def __init__(self, found: Found, environment: Environment, again: bool) -> None:
        self.found = found
        self.environment = environment
        self.again = again
        self.seen: set[str] = set()
        self.commands: set[str] = set(CMAKE_COMMANDS)
        self.finished = False
        self.modern = False
        self.checks: list[InterfaceCheck] = []
        self.warnings: list[str] = []
        self.hints: list[str] = []
        self.python: list[tuple[str, str]] = []
        self.modules: list[Item] = []
        self.compiled = False
        self.left_out: list[str] = []
        self.lacking: list[str] = []
        self.project, self.project_line = "Project", 1  # as CMake pretends where there is no project()

    def run(self) -> Outcome:
        cmake = self._read()
        self.compiled = cmake.builds_cpp or bool(cmake.compiled())
        self.commands |= cmake.defined
        self._warn_of_catkin()
        self._warn_of_blocks(cmake)
        for command in cmake.commands:
            self._configure(command)
        if not self.finished:
            self.hints.append(
                "There is no ament_package() in CMakeLists.txt: without it ROS 2 does not find the package. Write it last."
            )
        for check in self.checks:
            check.resolve(self._types())
        items = self._items(cmake)
        self._warn_of_definitions()
        self._warn_of_setup_py(cmake)
        return self._outcome(items)

    # -- configure -------------------------------------------------------------------------------------------------

    def _read(self) -> CMakeFile:
        file = self.found.path / "CMakeLists.txt"
        if not file.is_file():
            where = shown_path(str(self.found.path))
            text = f'CMake Error: The source directory "{where}" does not appear to contain CMakeLists.txt.\n'
            hint = "An ament_cmake package is built from its CMakeLists.txt. Or is this an ament_python package?"
            if (self.found.path / "setup.py").is_file():
                hint = (
                    "There is a setup.py: if this is to be an ament_python package, say so in package.xml: "
                    "<build_type>ament_python</build_type>."
                )
            raise BuildFailure(text, hint, seconds=0.1)
        try:
            source = file.read_text(encoding="utf-8")
            cmake = evaluate(source, "CMakeLists.txt", self.found.path)
            if not cmake.named("project"):
                self._warn_of_project()
                cmake = evaluate(f"project(Project) {source}", "CMakeLists.txt", self.found.path)
            cmake.programs(), cmake.directories(), cmake.files()
        except CMakeError as error:
            raise unreadable(error) from None
        except (OSError, UnicodeDecodeError) as error:
            raise BuildFailure(f"CMake Error: CMakeLists.txt cannot be read: {error}\n", seconds=0.1) from None
        return cmake

    def _configure(self, command: Command) -> None:
        where = f"CMakeLists.txt:{command.line} ({command.name})"
        if command.name not in self.commands:
            if self.lacking and not get_close_matches(command.name, self.commands, cutoff=0.85):
                return  # a command of a package that is not here, and no slip of the pen
            raise self._unknown(command, where)
        if self.compiled and serves_cpp(command):
            return
        if wrong := refusal(command, self.found.path):
            raise refused(wrong[0], where, wrong[1])
        special = getattr(self, f"_on_{command.name}", None)
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

    def _on_project(self, command: Command, where: str) -> None:
        self.project_line = command.line
        self.project = command.args[0] if command.args else self.project

    def _on_find_package(self, command: Command, where: str) -> None:
        if not command.args:
            raise refused("find_package called with incorrect number of arguments", where)
        name, required = command.args[0], "REQUIRED" in command.args
        known = {*CMAKE_PACKAGES, *self.environment.findable, *self.environment.types.packages()}
        if name in (known - {self.found.name}) | self.environment.findable:
            self.seen.add(name)
            self.commands |= COMMANDS_OF.get(name, frozenset())
            return
        if "QUIET" in command.args and not required:
            return
        if why_not_here(name) or (self.compiled and not package_hint(name, known)):
            self.lacking.append(name)
            self.commands |= COMMANDS_OF.get(name, frozenset())
            return
        text, hint = not_found(name, command.line, required, known)
        if required:
            raise BuildFailure(text, hint)
        self.warnings.append(text)
        self.hints.append(hint)

    def _on_rosidl_generate_interfaces(self, command: Command, where: str) -> None:
        check = InterfaceCheck(self.found, command, self.finished, self.seen)
        check.configure()
        self._check_xml(where, [f"{SHARE}/rosidl_cmake/cmake/rosidl_generate_interfaces.cmake:226 (ament_package_xml)"])
        check.check_group()
        if any(name == self.found.name for _, name in self.python):
            raise self._two_python_packages(where)
        self.checks.append(check)

    def _on_cmake_minimum_required(self, command: Command, where: str) -> None:
        self.modern = True

    def _on_message(self, command: Command, where: str) -> None:
        kind, text = (command.args or ("",))[0], "".join(command.args[1:])
        if kind in {"FATAL_ERROR", "SEND_ERROR"}:  # CMake would go on after SEND_ERROR, and fail in the end
            raise refused(text, where)
        if kind in {"WARNING", "AUTHOR_WARNING", "DEPRECATION"}:
            self.warnings.append(cmake_message(text, where, kind="Warning"))
        elif kind not in _QUIET:
            self.warnings.append("".join(command.args[kind == "NOTICE" :]) + "\n")

    def _on_ament_package(self, command: Command, where: str) -> None:
        if self.finished:
            raise refused(_TWICE, _HOOKS[0], f"Delete line {command.line}.", (*_HOOKS[1:], where))
        self._check_xml(where, [f"{SHARE}/ament_cmake_core/cmake/core/ament_package.cmake:63 (ament_package_xml)"])
        if not self.modern:
            hint = "Write cmake_minimum_required(VERSION 3.8) as the first line of CMakeLists.txt."
            raise refused(_OLD, f"{_EXTENSIONS}:41 (if)", hint, (_HOOKS[3], where))
        self.finished = True

    _on_ament_auto_package = _on_ament_package

    def _on_ament_auto_find_build_dependencies(self, command: Command, where: str) -> None:
        for name in self.found.dependencies:
            if name in self.environment.findable or name in self.environment.types.packages() or name in CMAKE_PACKAGES:
                self.seen.add(name)
                self.commands |= COMMANDS_OF.get(name, frozenset())

    def _on_ament_python_install_package(self, command: Command, where: str) -> None:
        name = command.args[0] if command.args else ""
        folder = self._option(command, "PACKAGE_DIR") or name
        if self.checks and name == self.found.name:
            raise self._two_python_packages(f"CMakeLists.txt:{command.line} (ament_python_install_package)")
        if not (self.found.path / folder / "__init__.py").is_file():
            text = f"ament_python_install_package() the Python package folder '{folder}' doesn't exist"
            raise refused(text, where, f"Make {folder}/__init__.py, which may be empty.")
        self.python.append((folder, name))
        self.commands |= COMMANDS_OF["ament_cmake_core"]  # which it finds (ament_cmake_python-extras.cmake)

    def _two_python_packages(self, where: str) -> BuildFailure:
        """The refusal of a package that generates interfaces and installs a Python package of the same name.

        In whichever order: rosidl_generator_py calls ament_python_install_package(), too, and CMake refuses the second
        target of one name (ros2/rosidl_python, issue 141).
        """
        name = self.found.name
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
        return refused(text, place, hint, (where,))

    def _on_ament_python_install_module(self, command: Command, where: str) -> None:
        name = command.args[0] if command.args else ""
        if not name.endswith(".py") or not (self.found.path / name).is_file():
            text = f"ament_python_install_module() the Python module file '{self.found.path / name}' doesn't exist"
            raise refused(text, where, "Name a file that is there, as seen from CMakeLists.txt.")
        place = "/".join(filter(None, (_PYTHON_PLACE, self._option(command, "DESTINATION_SUFFIX"))))
        self.modules.append(Item(f"{place}/{Path(name).name}", self.found.path / name))

    def _option(self, command: Command, word: str) -> str:
        args = command.args
        return args[args.index(word) + 1] if word in args[:-1] else ""

    def _check_xml(self, where: str, stack: list[str]) -> None:
        faults = [f"The manifest contains invalid XML:\n{self.found.xml_error}"] if self.found.xml_error else []
        if self.found.root is not None:
            faults = faults_in(self.found.root)
        if faults:
            raise self._refused_xml(faults, [*stack, where])
        project = self.project
        if project != self.found.name:
            text = (
                f"ament_package_xml() package name '{self.found.name}' in '/package.xml' does not match current "
                f"PROJECT_NAME '{project}'. You must call project() with the same package name before."
            )
            hint = f"Write project({self.found.name}) in line {self.project_line} of CMakeLists.txt."
            hint = "" if self.hints else hint  # there is none at all, and that is said already
            raise refused(text, f"{_PACKAGE_XML}:53 (message)", hint, (*stack, where))

    def _refused_xml(self, faults: list[str], stack: list[str]) -> BuildFailure:
        file = shown_path(str(self.found.path / "package.xml"))
        said = "\n".join(faults)
        text = f"Error parsing '{file}':\ncatkin_pkg.package.InvalidPackage: Error(s) in package '{file}':\n{said}\n"
        what = f"{SHARE}/ament_cmake_core/cmake/core/package_xml_2_cmake.py"
        process = f"execute_process(/usr/bin/python3 {what} {file}) returned error code 1"
        text += cmake_message(
            process, f"{_PACKAGE_XML}:95 (message)", [f"{_PACKAGE_XML}:49 (_ament_package_xml)", *stack]
        )
        hints = [hint_for(fault) for fault in faults]
        if self.found.xml_error:
            hints = ["Is every <tag> closed by a </tag>, and is every < in a text written as &lt;?"]
        return BuildFailure(text, " ".join(filter(None, hints)))

    def _types(self) -> Registry:
        """All types that exist in this build; of the package's own those alone that CMakeLists.txt names."""
        types = self.environment.types
        if self.found.name in types.packages():
            types.remove(self.found.name)
        types.add(self.found.name, self.found.path, tuple(file for check in self.checks for file in check.files))
        return types

    # -- install ---------------------------------------------------------------------------------------------------

    def _items(self, cmake: CMakeFile) -> list[Item]:
        entries = install_entries(cmake)
        foreign = [entry for entry in entries if isinstance(entry, Program) and not asks_for_python(self.found, entry)]
        self.left_out = [*cmake.compiled(), *(entry.name for entry in foreign)]
        wanted = [entry for entry in entries if entry not in foreign]
        items = [item for entry in wanted for item in install_items(self.found, entry, self.hints)]
        for folder, name in self.python:
            items.append(Item(f"{_PYTHON_PLACE}/{name}", self.found.path / folder))
        items += self.modules
        for check in self.checks:
            items += interface_items(self.found, check.files)
        check_targets(items)
        if self.environment.symlink:
            self._warn_of_mode(items)
        return items

    def _warn_of_mode(self, items: list[Item]) -> None:
        """A link has the mode of the file that it leads to; a copy gets one that can be run."""
        files = [item.source for item in items if item.program and item.source is not None]
        if left := [shown_path(str(file)) for file in files if not os.access(file, os.X_OK)]:
            self.hints.append(
                f"--symlink-install links to {', '.join(left)}, which cannot be run (ros2 run: No executable found): "
                f"!chmod +x {' '.join(left)}"
            )

    # -- what is worth a word --------------------------------------------------------------------------------------

    def _warn_of_project(self) -> None:
        text = (
            "No project() command is present. The top-level CMakeLists.txt file must contain a literal, direct call to the "
            "project() command. Add a line of code such as\n\n  project(ProjectName)\n\nnear the top of the file, but after "
            'cmake_minimum_required().\n\nCMake is pretending there is a "project(Project)" command on the first line.'
        )
        message = cmake_message(text, "", kind="Warning (dev) in CMakeLists.txt").rstrip("\n")
        self.warnings.append(f"{message}\nThis warning is for project developers.  Use -Wno-dev to suppress it.\n\n")
        self.hints.append(f"Write project({self.found.name}) below cmake_minimum_required(…).")

    def _warn_of_catkin(self) -> None:
        if self.found.root is not None and not self.found.build_type:
            text = "Manually-specified variables were not used by the project:\n\n  CATKIN_INSTALL_INTO_PREFIX_ROOT\n"
            self.warnings.append(cmake_message(text.rstrip(), "", kind="Warning"))
            self.hints.append(
                "package.xml does not say how to build, so colcon takes it for a package of ROS 1. Add "
                "<export><build_type>ament_cmake</build_type></export>."
            )

    def _warn_of_blocks(self, cmake: CMakeFile) -> None:
        """Loops, functions and macros are not carried out, and neither is what stands in them."""
        if cmake.passed_over:
            blocks = " and ".join(f"{name}() in line {line}" for name, line in cmake.passed_over)
            self.warnings.append(
                f"Warning: CMakeLists.txt: {blocks} cannot be carried out here: what lies inside is passed over. All else "
                "is built; write out what is missing.\n"
            )

    def _warn_of_definitions(self) -> None:
        """Definitions that lie there and that nobody asks for: nothing is made of them, and importing them fails."""
        named = {file for check in self.checks for file in check.files}
        there = [path.relative_to(self.found.path).as_posix() for path in definitions(self.found.path)]
        if left := [file for file in there if file not in named]:
            names = " ".join(f'"{file}"' for file in left)
            self.hints.append(
                f"nothing is generated from {', '.join(left)}, which CMakeLists.txt does not name: write {names} in "
                "rosidl_generate_interfaces(${PROJECT_NAME} …)."
            )

    def _warn_of_setup_py(self, cmake: CMakeFile) -> None:
        file = self.found.path / "setup.py"
        text = file.read_text(encoding="utf-8", errors="replace") if file.is_file() else ""
        if "entry_points" not in text:
            return
        installed = [program for program in cmake.programs() if program.destination == f"lib/{self.found.name}"]
        line = text[: text.index("entry_points")].count("\n") + 1
        hint = "" if installed else (
            f" Install each program in CMakeLists.txt: install(PROGRAMS {self.found.name}/<file>.py DESTINATION "
            "lib/${PROJECT_NAME} RENAME <name>)."
        )  # fmt: skip
        self.hints.append(
            f"setup.py, line {line}, lists entry_points, but package.xml says ament_cmake: CMake does not read setup.py, and "
            f"nothing will be installed from them.{hint}"
        )

    def _outcome(self, items: list[Item]) -> Outcome:
        files = [file for check in self.checks for file in check.files]
        share = prefix_of(self.environment.install, self.found.name) / "share" / self.found.name
        pairs = [(share / file, self.found.path / file) for file in files]
        changed = [new for old, new in pairs if not old.is_file() or old.read_bytes() != new.read_bytes()]
        seconds = (0.7 if self.again else 1.2) + 2.0 * len(changed)
        stdout = [f"-- Found {name}" for name in sorted(self.seen)]
        stdout += ["-- Configuring done", "-- Generating done"]
        text = with_hint("".join(self.warnings), self.hints)
        paths = [_PYTHON_PLACE] if self.python or self.modules else []
        outcome = Outcome(0, text, stdout, seconds, items, self.found.runtime_dependencies(), paths)
        outcome.left_out, outcome.lacking = self.left_out, self.lacking
        return outcome
