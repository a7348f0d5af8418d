"""What `rosidl_generate_interfaces` refuses, in the words of the real build (rosidl_cmake 3.1 and rosidl_adapter)."""

from __future__ import annotations

import re
from pathlib import Path

from ..core.tracebacks import shown_path
from ..interfaces import names
from ..interfaces.errors import DuplicateName, InvalidDefinition, UnknownMessageType
from ..interfaces.model import Definition, MessageDefinition
from ..interfaces.registry import PARSERS, Registry
from .cmake import INTERFACE_WORDS, Command
from .cmake_text import SHARE, cmake_message
from .discover import Found
from .errors import did_you_mean
from .index import package_hint
from .known import PYTHON_PACKAGES
from .outcome import BuildFailure
from .package import GROUP

_GENERATE = f"{SHARE}/rosidl_cmake/cmake/rosidl_generate_interfaces.cmake"
_ADAPT = f"{SHARE}/rosidl_adapter/cmake/rosidl_adapt_interfaces.cmake:59 (message)"


def interface_files(command: Command) -> list[str]:
    """The files that a `rosidl_generate_interfaces` names."""
    names_given = command.args[1:]
    end = next((i for i, word in enumerate(names_given) if word in INTERFACE_WORDS), len(names_given))
    return list(names_given[:end])


def dependencies_of(command: Command) -> list[str]:
    """What stands after DEPENDENCIES."""
    if "DEPENDENCIES" not in command.args:
        return []
    after = command.args[command.args.index("DEPENDENCIES") + 1 :]
    end = next((i for i, word in enumerate(after) if word in INTERFACE_WORDS), len(after))
    return list(after[:end])


class InterfaceCheck:
    """Checks one `rosidl_generate_interfaces`, in the order in which the real one finds fault."""

    def __init__(self, found: Found, command: Command, finished: bool, seen: set[str]) -> None:
        self._found = found
        self._command = command
        self._finished = finished  # ament_package() was called before
        self._seen = seen  # what find_package has found
        self._own = f"CMakeLists.txt:{command.line} (rosidl_generate_interfaces)"
        self.files = interface_files(command)

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
        for name in dependencies_of(self._command):
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
        known = {self._found.name, *dependencies_of(self._command), "builtin_interfaces", "service_msgs"}
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
