"""What `colcon build` makes of an `ament_cmake` package: CMake's three steps, configure, build and install, on paper.

Commands are looked at in the order in which CMake carries them out, so that the first fault found is the one that a real
build reports, at its line. Facts: CMake 3.25 and ament_cmake 1.3; only what a package of Python files meets.
"""

from __future__ import annotations

import os
from collections.abc import Iterator

from ..idl.names import did_you_mean
from ..idl.registry import Package
from ..sim.errors import shown_path
from .cmake import Command, compiled, evaluate
from .cmake_commands import InterfaceCheck, files_to_install, first_line, install_items, interface_items
from .index import CMAKE_COMMANDS, CMAKE_PACKAGES, COMMANDS_OF, PYTHON_PACKAGES, package_hint, why_not_here
from .install_tree import PYTHON_FOLDERS, Environment, Item, Outcome, check_targets, names_in, prefix_of, with_hint
from .manifest import Found, faults_in
from .package import SHARE, BuildFailure, cmake_message, filled, refused

_PACKAGE_XML = f"{SHARE}/ament_cmake_core/cmake/core/ament_package_xml.cmake"
_SITE = PYTHON_FOLDERS["cmake"]
_MODULES = {"CTest", "GNUInstallDirs", "CMakePackageConfigHelpers"}
"""The modules of CMake's own whose inclusion changes nothing for a package of Python files."""


def build_ament_cmake(found: Found, environment: Environment) -> Outcome:
    """Build one package: what it prints, and what is to be installed if nothing is refused."""
    again = (environment.build / found.name / "colcon_build.rc").is_file()
    build = _Build(found, environment)
    try:
        outcome = build.run()
    except BuildFailure as failure:
        text, code = "".join(build.warnings) + failure.text, failure.code
        configuring = text.startswith(("CMake Error at CMakeLists", "CMake Error at /opt", "Error parsing"))
        if again and code == 1 and configuring:
            text, code = f"{text}gmake: *** [Makefile:786: cmake_check_build_system] Error 1\n", 2
        return Outcome(code, with_hint(text, [failure.hint, *build.hints]), seconds=failure.seconds)
    outcome.seconds += 0.7 if again else 1.2
    return outcome


class _Build:
    """The build of one package."""

    def __init__(self, found: Found, environment: Environment) -> None:
        self.found = found
        self.environment = environment
        self.seen: set[str] = set()
        self.commands: set[str] = set(CMAKE_COMMANDS)
        self.called: dict[str, Command] = {}
        self.checks: list[InterfaceCheck] = []
        self.warnings: list[str] = []
        self.hints: list[str] = []
        self.installs: list[tuple[Command, str]] = []
        self.python: list[Item] = []
        self.cpp: dict[str, int] = {}
        self.lacking: list[str] = []

    @property
    def interfaces(self) -> list[str]:
        return [file for check in self.checks for file in check.files]

    def run(self) -> Outcome:
        commands = evaluate(self._text(), self.found.path)
        self.cpp = compiled(commands)
        for command in commands:
            self._configure(command)
            self.called[command.name] = command
        if "ament_package" not in self.called:
            self.hints.append(
                "There is no ament_package() in CMakeLists.txt: without it ROS 2 does not find the package. Write it last."
            )
        if self.environment.compiles:
            types = self.environment.types  # of the package's own, only those that CMakeLists.txt names
            types.add(self.found.name, self.found.path, tuple(self.interfaces))
            for check in self.checks:
                check.resolve(types)
        items, left_out = list[Item](), list(self.cpp)
        for command, name in self.installs:
            first = first_line(self.found.path / name) if command.args[0] == "PROGRAMS" else ""
            if first.startswith("#!") and "python" not in first:
                left_out.append(command.after("RENAME") or os.path.basename(name))
            else:
                items += install_items(self.found, command, name, self.hints)
        items += [*self.python, *interface_items(self.found, self.interfaces)] if self.checks else self.python
        check_targets(items, self.found.name)
        self.hints += self._advice(items)
        stdout = [f"-- Found {name}" for name in sorted(self.seen)]
        share = prefix_of(self.environment.install, self.found.name) / "share" / self.found.name
        pairs = [(share / file, self.found.path / file) for file in self.interfaces]
        changed = sum(not old.is_file() or old.read_bytes() != new.read_bytes() for old, new in pairs)
        return Outcome(
            stderr=with_hint("".join(self.warnings), self.hints),
            stdout=[*stdout, "-- Configuring done", "-- Generating done"],
            seconds=2.0 * changed,
            items=items,
            left_out=left_out,
            lacking=self.lacking,
        )

    def _text(self) -> str:
        """What CMakeLists.txt says."""
        try:
            return (self.found.path / "CMakeLists.txt").read_text(encoding="utf-8")
        except FileNotFoundError:
            place = shown_path(str(self.found.path))
            text = f'CMake Error: The source directory "{place}" does not appear to contain CMakeLists.txt.\n'
            hint = (
                "A package that is built from a setup.py says <build_type>ament_python</build_type> in its package.xml."
            )
        except (OSError, UnicodeDecodeError) as error:
            text, hint = f"CMake Error: CMakeLists.txt cannot be read: {error}\n", ""
        raise BuildFailure(text, hint, seconds=0.1)

    # -- configure -------------------------------------------------------------------------------------------------

    def _configure(self, command: Command) -> None:
        name, args, first = command.name, command.args, "".join(command.args[:1])
        if name not in self.commands:
            if self.lacking and not did_you_mean(name, self.commands):
                return  # a command of a package that is not here, and no slip of the pen
            packages = [package for package, commands in COMMANDS_OF.items() if name in commands]
            hint = did_you_mean(name, self.commands | {"rosidl_generate_interfaces"})
            if packages:
                likely = "rosidl_default_generators" if name.startswith("rosidl") else packages[0]
                hint = f"Write find_package({likely} REQUIRED) above line {command.line}."
            raise refused(f'Unknown CMake command "{name}".', command.where, hint)
        if name in {"find_package", "project", "set"} and not args:
            raise refused(f"{name} called with incorrect number of arguments", command.where)
        match name:
            case "find_package":
                self._find_package(command)
            case "include" if (self.found.path / first).is_file() and not self.cpp:
                hint = "Only CMakeLists.txt itself is read here: write the lines of that file into it."
                raise refused(f"include({first}) is not carried out in this simulation.", command.where, hint)
            case "include" if first not in _MODULES and not self.cpp:
                raise refused(f"include could not find requested file:\n\n  {first}", command.where)
            case "add_subdirectory" if args and not (self.found.path / first).is_dir():
                text = f'add_subdirectory given source "{first}" which is not an existing directory.'
                raise refused(text, command.where)
            case "message":
                self._message(command)
            case "install":
                names = files_to_install(self.found, command, cpp=bool(self.cpp))
                self.installs += [(command, name) for name in names]
            case "rosidl_generate_interfaces":
                check = InterfaceCheck(self.found, command)
                check.configure("ament_package" in self.called, self.seen)
                place = f"{SHARE}/rosidl_cmake/cmake/rosidl_generate_interfaces.cmake:226 (ament_package_xml)"
                self._check_xml(command, place)
                check.check_group()
                self.checks.append(check)
                self._check_python_packages(command)
            case "ament_python_install_package":
                self._install_python_package(command)
            case "ament_package":
                self._package(command)

    def _find_package(self, command: Command) -> None:
        name, required = command.args[0], "REQUIRED" in command.args
        known = {*CMAKE_PACKAGES, *self.environment.findable, *self.environment.types.packages()}
        if name in (known - {self.found.name}) | self.environment.findable:
            self.seen.add(name)
            self.commands |= COMMANDS_OF.get(name, frozenset())
        elif "QUIET" in command.args and not required:
            return
        elif why_not_here(name) or (self.cpp and not package_hint(name, known)):
            self.lacking.append(name)
        else:
            said = filled("CMake: package not found", name=name, lower=name.lower()).removesuffix("\n")
            text = cmake_message(said, command.where, kind="Error" if required else "Warning")
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

    def _message(self, command: Command) -> None:
        kind, text = (command.args or ("",))[0], "".join(command.args[1:])
        if kind in {"FATAL_ERROR", "SEND_ERROR"}:  # CMake would go on after SEND_ERROR, and fail in the end
            raise refused(text, command.where)
        if kind == "WARNING":
            self.warnings.append(cmake_message(text, command.where, kind="Warning"))
        elif kind not in {"STATUS", "VERBOSE", "DEBUG"}:
            self.warnings.append("".join(command.args[kind == "NOTICE" :]) + "\n")

    def _install_python_package(self, command: Command) -> None:
        name = "".join(command.args[:1])
        shown = command.after("PACKAGE_DIR") or name
        folder = self.found.path / shown
        if not (folder / "__init__.py").is_file():
            text = f"ament_python_install_package() the Python package folder '{shown}' doesn't exist"
            raise refused(text, command.where, f"Make {shown}/__init__.py, which may be empty.")
        self.python += [Item(f"{_SITE}/{name}/{file}", folder / file) for file in names_in(folder)]
        self._check_python_packages(command)
        self.commands |= COMMANDS_OF["ament_cmake_core"]  # which it finds (ament_cmake_python-extras.cmake)

    def _check_python_packages(self, command: Command) -> None:
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
        raise refused(text, place, hint, [command.where])

    def _package(self, command: Command) -> None:
        if "ament_package" in self.called:
            raise refused("ament_package() is called twice.", command.where, f"Delete line {command.line}.")
        for name, args in (("cmake_minimum_required", "VERSION 3.8"), ("project", self.found.name)):
            if name not in self.called:
                hint = f"Write {name}({args}) at the beginning of CMakeLists.txt."
                raise refused(f"No {name}() command is present.", command.where, hint)
        self._check_xml(command, f"{SHARE}/ament_cmake_core/cmake/core/ament_package.cmake:63 (ament_package_xml)")

    def _check_xml(self, command: Command, caller: str) -> None:
        """What package.xml must not say, and the name that project() must."""
        closed = "Is every <tag> closed by a </tag>, and is every < in a text written as &lt;?"
        faults = {f"The manifest contains invalid XML:\n{self.found.xml_error}": closed}
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
            stack = [f"{_PACKAGE_XML}:49 (_ament_package_xml)", caller, command.where]
            message = cmake_message(process, f"{_PACKAGE_XML}:95 (message)", stack)
            raise BuildFailure(text + message, " ".join(filter(None, faults.values())))
        project = self.called.get("project")
        if project is not None and project.args[0] != self.found.name:
            text = (
                f"ament_package_xml() package name '{self.found.name}' in '/package.xml' does not match current "
                f"PROJECT_NAME '{project.args[0]}'. You must call project() with the same package name before."
            )
            hint = f"Write project({self.found.name}) in line {project.line} of CMakeLists.txt."
            raise refused(text, f"{_PACKAGE_XML}:53 (message)", hint, [caller, command.where])

    # -- what would be wrong on a robot, although it builds -----------------------------------------------------------

    def _advice(self, items: list[Item]) -> Iterator[str]:
        files = [item.source for item in items if item.program and item.source is not None]
        # A link has the mode of the file that it leads to; a copy gets one that can be run.
        left = [shown_path(str(file)) for file in files if not os.access(file, os.X_OK)]
        if self.environment.symlink and left:
            yield (
                f"--symlink-install links to {', '.join(left)}, which cannot be run (ros2 run: No executable found): "
                f"!chmod +x {' '.join(left)}"
            )
        if self.found.root is not None and not self.found.build_type:
            yield (
                "package.xml does not say how to build, so colcon takes it for a package of ROS 1. Add "
                "<export><build_type>ament_cmake</build_type></export>."
            )
        # Nothing is made of a definition that is not named, and importing it fails.
        own = Package(self.found.name, self.found.path)
        lying = [own.path(each).relative_to(own.directory).as_posix() for each in own.interface_names()]
        if unnamed := [file for file in lying if file not in self.interfaces]:
            names = " ".join(f'"{file}"' for file in unnamed)
            yield (
                f"nothing is generated from {', '.join(unnamed)}, which CMakeLists.txt does not name: write {names} in "
                "rosidl_generate_interfaces(${PROJECT_NAME} …)."
            )
        setup = self.found.path / "setup.py"
        before, named, _ = (setup.read_text("utf-8", "replace") if setup.is_file() else "").partition("entry_points")
        if named:
            line = before.count("\n") + 1
            yield (
                f"setup.py, line {line}, lists entry_points, but package.xml says ament_cmake: CMake does not read setup.py, "
                "and nothing will be installed from them. In CMakeLists.txt a program is installed by "
                f"install(PROGRAMS {self.found.name}/<file>.py DESTINATION lib/${{PROJECT_NAME}} RENAME <name>)."
            )
