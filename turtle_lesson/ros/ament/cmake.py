"""A small honest reader of a package's CMakeLists.txt: variables, `if`, and what ament packages are made of.

It understands what a Python package needs (set, list, project, if, file(GLOB), install, rosidl_generate_interfaces). Loops,
functions and macros are passed over with all that lies inside, and named (`CMakeFile.passed_over`). Nothing is built or run.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from glob import glob
from pathlib import Path

from ..sim.errors import shown_path
from .cmake_syntax import BLOCKS, Argument, Call, CMakeError, check_blocks, condition_holds, read_calls

__all__ = [
    "CMakeError",
    "CMakeFile",
    "Command",
    "Installed",
    "Program",
    "read_cmake",
]


_VARIABLE = re.compile(r"\\(.)|\$\{([^${}]*)\}", re.DOTALL)
_ESCAPES = {"n": "\n", "t": "\t", "r": "\r"}
_INSTALL_FOLDERS = {
    f"CMAKE_INSTALL_{name}DIR": folder
    for name, folder in {
        "BIN": "bin", "LIB": "lib", "LIBEXEC": "libexec", "INCLUDE": "include", "DATA": "share", "DATAROOT": "share",
        "DOC": "share/doc", "SYSCONF": "etc", "MAN": "share/man",
    }.items()
}  # fmt: skip
"""The variables that include(GNUInstallDirs) sets."""

_INSTALL_WORDS = {
    "DESTINATION", "RENAME", "PERMISSIONS", "FILE_PERMISSIONS", "DIRECTORY_PERMISSIONS", "CONFIGURATIONS",
    "COMPONENT", "OPTIONAL", "TYPE", "EXCLUDE_FROM_ALL", "USE_SOURCE_PERMISSIONS", "PATTERN", "REGEX",
    "EXCLUDE", "FILES_MATCHING", "MESSAGE_NEVER",
}  # fmt: skip
INTERFACE_WORDS = {
    "DEPENDENCIES", "LIBRARY_NAME", "SKIP_INSTALL", "SKIP_GROUP_MEMBERSHIP_CHECK", "ADD_LINTER_TESTS",
}  # fmt: skip


COMPILES = {"add_executable", "add_library", "ament_auto_add_executable", "ament_auto_add_library"}
"""The commands by which a package builds something in C++, which is left out here."""


@dataclass(frozen=True)
class Command:
    """One command that takes effect: its name in lower case, its expanded arguments, its line."""

    name: str
    args: tuple[str, ...]
    line: int


@dataclass(frozen=True)
class Program:
    """A file that `install(PROGRAMS …)` names: where it lies, the folder it goes to, its name there."""

    source: str
    destination: str
    name: str
    line: int


@dataclass(frozen=True)
class Installed:
    """A folder or file that `install(DIRECTORY …)` or `install(FILES …)` names, and the folder it goes to.

    A folder whose name ends in `/` gives its content instead of itself, as in CMake.
    """

    source: str
    destination: str
    line: int
    name: str | None = None
    options: tuple[str, ...] = field(default=(), compare=False)
    """The words behind the names, DESTINATION and all others."""


@dataclass
class CMakeFile:
    """The commands of a CMakeLists.txt in the order of their effect, and what they mean for a package."""

    commands: list[Command] = field(default_factory=list)
    file: str = "CMakeLists.txt"
    folders: dict[int, CMakeFile] = field(default_factory=dict)
    """The files of the folders that `add_subdirectory` names, by its line."""
    builds_cpp: bool = False
    """Whether a command of the text builds C++, even where it is passed over."""
    passed_over: list[tuple[str, int]] = field(default_factory=list)
    """The loops, functions and macros that would take effect, each with its line."""
    defined: set[str] = field(default_factory=set)
    """The names of the functions and macros that the text defines, in lower case."""

    def named(self, name: str) -> list[Command]:
        """All commands of a name."""
        return [command for command in self.commands if command.name == name]

    def project(self) -> Command:
        """The `project(name)` command; the name is its first argument."""
        for command in self.named("project"):
            if command.args:
                return command
            raise CMakeError("project() needs a name: project(robot_controller)", command.line, self.file)
        raise CMakeError("there is no project(…); write project(<the package's name>) first", 1, self.file)

    def found_packages(self) -> list[str]:
        """What `find_package` asks for."""
        return [command.args[0] for command in self.named("find_package") if command.args]

    def compiled(self) -> dict[str, int]:
        """The C++ programs and libraries that it builds, each with its line; those of inner folders with that of the folder."""
        found: dict[str, int] = {}
        for line, inner in self.folders.items():
            found |= dict.fromkeys(inner.compiled(), line)
        for command in self.commands:
            if command.name in COMPILES and command.args:
                found[command.args[0]] = command.line
            if "EXECUTABLE" in command.args[:-1] and command.name.startswith("rclcpp_components_register_node"):
                found[command.args[command.args.index("EXECUTABLE") + 1]] = command.line
        return found

    def interfaces(self) -> list[tuple[str, int]]:
        """The files in `rosidl_generate_interfaces`, such as `msg/TurtleStatus.msg`, each with its line."""
        files = []
        for command in self.named("rosidl_generate_interfaces"):
            names, _ = _until(command.args[1:], INTERFACE_WORDS)
            files += [(name, command.line) for name in names]
        return files

    def programs(self) -> list[Program]:
        """What `install(PROGRAMS …)` installs."""
        found = []
        for command in self._installs("PROGRAMS"):
            names, options = _until(command.args[1:], _INSTALL_WORDS)
            rename = options.get("RENAME")
            if rename and len(names) > 1:
                reason = "RENAME gives a single name, so install one program at a time: install(PROGRAMS a.py …)"
                words = "install PROGRAMS given RENAME option with more than one file."
                raise self._refused(command, reason, words)
            destination = self._destination(command, options)
            for name in names:
                found.append(Program(name, destination, rename or Path(name).name, command.line))
        return found

    def directories(self) -> list[Installed]:
        """What `install(DIRECTORY …)` installs, and `ament_auto_package(INSTALL_TO_SHARE …)`."""
        found = self._installed("DIRECTORY")
        for command in self.named("ament_auto_package"):
            place = f"share/{self.project().args[0]}"
            names = (
                command.args[command.args.index("INSTALL_TO_SHARE") + 1 :] if "INSTALL_TO_SHARE" in command.args else ()
            )
            found += [Installed(name, place, command.line) for name in names]
        return found

    def files(self) -> list[Installed]:
        """What `install(FILES …)` installs."""
        return self._installed("FILES")

    def _installed(self, kind: str) -> list[Installed]:
        found = []
        for command in self._installs(kind):
            names, options = _until(command.args[1:], _INSTALL_WORDS)
            destination = self._destination(command, options)
            rename, words = options.get("RENAME"), command.args[1 + len(names) :]
            found += [Installed(name, destination, command.line, rename, words) for name in names]
        return found

    def _installs(self, kind: str) -> list[Command]:
        return [command for command in self.named("install") if command.args[:1] == (kind,)]

    def _destination(self, command: Command, options: dict[str, str]) -> str:
        if not options.get("DESTINATION"):
            kind = command.args[0]
            reason = f"install({kind} …) needs a DESTINATION, such as lib/${{PROJECT_NAME}}"
            raise self._refused(command, reason, f"install {kind} given no DESTINATION!")
        return options["DESTINATION"].rstrip("/")

    def _refused(self, command: Command, reason: str, words: str) -> CMakeError:
        place = f"{command.line} ({command.name})"
        return CMakeError(reason, command.line, self.file, words=words, place=place)


def _until(args: tuple[str, ...], words: set[str]) -> tuple[list[str], dict[str, str]]:
    """The arguments before the first of CMake's own words, and for each of those words what follows it."""
    names: list[str] = []
    options: dict[str, str] = {}
    word = None
    for argument in args:
        if argument in words:
            word = argument
            options.setdefault(word, "")
        elif word is None:
            names.append(argument)
        else:
            options[word] = options[word] or argument
    return names, options


def read_cmake(path: Path) -> CMakeFile:
    """Read a CMakeLists.txt.

    Raises:
        CMakeError: where it is not understood, with the file and the line.
    """
    return evaluate(path.read_text(encoding="utf-8"), str(path), path.parent)


def compiled_programs(folder: Path) -> dict[str, int]:
    """What the CMakeLists.txt in a folder builds in C++, each with its line; nothing without a readable one."""
    try:
        return read_cmake(folder / "CMakeLists.txt").compiled()
    except (CMakeError, OSError, UnicodeDecodeError):
        return {}


def evaluate(
    text: str, file: str = "CMakeLists.txt", folder: Path | None = None, variables: dict[str, str] | None = None
) -> CMakeFile:
    """The commands of the text that take effect, with their variables put in, and those of its inner folders.

    Where a file builds C++, what is not understood in it is passed over: most of it serves the C++.
    """
    where = (folder or Path(".")).as_posix()
    known = variables or dict.fromkeys(("CMAKE_SOURCE_DIR", "PROJECT_SOURCE_DIR"), where)
    known |= {"CMAKE_CURRENT_SOURCE_DIR": where, "CMAKE_CURRENT_LIST_DIR": where, "BUILD_TESTING": "ON", "UNIX": "1"}
    calls = read_calls(text, file)
    check_blocks(calls, file)
    cpp = any(call.name in COMPILES for call in calls)
    evaluator = _Evaluator(known, file, lenient=cpp)
    read = CMakeFile(list(evaluator.run(calls)), file, builds_cpp=cpp, passed_over=evaluator.passed_over)
    read.defined = {call.args[0].text.lower() for call in calls if call.name in {"function", "macro"} and call.args}
    for command in read.named("add_subdirectory"):
        inner = Path(where, "".join(command.args[:1])).resolve()
        if Path(where).resolve() in inner.parents:
            list_file = inner / "CMakeLists.txt"
            try:
                text = list_file.read_text(encoding="utf-8")
                read.folders[command.line] = evaluate(text, str(list_file), inner, dict(known))
            except (CMakeError, OSError, UnicodeDecodeError):
                read.folders[command.line] = CMakeFile(file=str(list_file))  # nothing is known of it
    return read


class _Evaluator:
    """Goes through the calls once, keeping the variables and which `if` branch is taken."""

    def __init__(self, variables: dict[str, str], file: str, *, lenient: bool = False) -> None:
        self.variables = variables
        self.file = file
        self._lenient = lenient
        self._branches: list[str] = []  # one per open if: "taken", "waiting" for its branch, or "done"
        self.passed_over: list[tuple[str, int]] = []

    def run(self, calls: list[Call]) -> Iterator[Command]:
        """The commands that take effect."""
        depth = 0  # of the loops, functions and macros that the call stands in
        for call in calls:
            if call.name in BLOCKS and self._active:
                if not depth:
                    self.passed_over.append((call.name, call.line))
                depth += 1
            elif depth:
                depth -= call.name.startswith("end") and call.name[3:] in BLOCKS
            elif not self._conditional(call) and self._active:
                if call.name == "return":
                    return
                yield from self._effect(call)

    @property
    def _active(self) -> bool:
        return all(branch == "taken" for branch in self._branches)

    def _conditional(self, call: Call) -> bool:
        if call.name == "if":
            taken = self._active and self._holds(call)
            self._branches.append("taken" if taken else "waiting" if self._active else "done")
        elif call.name in {"elseif", "else", "endif"}:
            self._next_branch(call)
        else:
            return False
        return True

    def _next_branch(self, call: Call) -> None:
        state = self._branches.pop()
        if call.name == "endif":
            return
        if state == "waiting" and (call.name == "else" or self._holds(call)):
            self._branches.append("taken")
        else:
            self._branches.append("waiting" if state == "waiting" else "done")

    def _holds(self, call: Call) -> bool:
        words = [(self.expand(argument, call), argument.quoted) for argument in call.args]
        return condition_holds(words, self.variables, call.line, self.file)

    def _effect(self, call: Call) -> Iterator[Command]:
        args = self._arguments(call)
        if call.name == "set" and args:
            self.variables[args[0]] = ";".join(_until(args[1:], {"CACHE", "PARENT_SCOPE"})[0])
        elif call.name == "unset" and args:
            self.variables.pop(args[0], None)
        elif call.name == "list" and args[:1] == ("APPEND",) and len(args) > 1:
            self.variables[args[1]] = ";".join(filter(None, [self.variables.get(args[1], ""), *args[2:]]))
        elif call.name == "project" and args:
            self.variables["PROJECT_NAME"] = self.variables["CMAKE_PROJECT_NAME"] = args[0]
        elif call.name == "include" and args[:1] == ("GNUInstallDirs",):
            self.variables |= _INSTALL_FOLDERS
        elif call.name == "file" and args[:1] in {("GLOB",), ("GLOB_RECURSE",)}:
            found = _globbed(args, self.variables["CMAKE_CURRENT_SOURCE_DIR"])
            if found is None and not self._lenient:
                reason = f"file({args[0]} …) with these arguments is not understood here; name the files one by one"
                raise CMakeError(reason, call.line, self.file)
            if len(args) > 1:
                self.variables[args[1]] = ";".join(found or ())
        yield Command(call.name, args, call.line)

    def _arguments(self, call: Call) -> tuple[str, ...]:
        values: list[str] = []
        for argument in call.args:
            text = self.expand(argument, call)
            if argument.quoted:
                values.append(text)
            else:  # a list, whose elements are arguments of their own
                values += [part.replace("\\;", ";") for part in re.split(r"(?<!\\);", text) if part]
        return tuple(values)

    def expand(self, argument: Argument, call: Call) -> str:
        """The argument with its variables and escapes put in; an unset variable is empty, as in CMake."""
        text = argument.text
        if argument.raw:
            return text
        if text.count("${") > text.count("}"):
            reason = f"'{text}': a ${{ is not closed by }}"
            file = shown_path(str(Path(self.variables.get("CMAKE_CURRENT_SOURCE_DIR", ".")) / Path(self.file).name))
            words = (
                f"Syntax error in cmake code at\n\n  {file}:{argument.line}\n\nwhen parsing string\n\n  {text}\n\n"
                "There is an unterminated variable reference."
            )
            raise CMakeError(reason, argument.line, self.file, words=words, place=f"{call.line} ({call.name})")
        for _ in range(10):  # ${a_${b}} needs a round for each level
            expanded = _VARIABLE.sub(self._replace, text)
            if expanded == text or "${" not in expanded:
                return expanded
            text = expanded
        return text

    def _replace(self, match: re.Match[str]) -> str:
        escaped, name = match.groups()
        if escaped is None:
            return self.variables.get(name, "")
        if escaped == ";":
            return "\\;"  # still to be seen when lists are split
        return _ESCAPES.get(escaped, escaped)


def _globbed(args: Sequence[str], here: str) -> list[str] | None:
    """What `file(GLOB|GLOB_RECURSE variable [RELATIVE folder] pattern …)` puts into its variable, sorted.

    `here` is the folder of the CMakeLists.txt. None if there are words that are not understood.
    """
    patterns = [word for word in args[2:] if word != "CONFIGURE_DEPENDS"]
    beside = None
    if "RELATIVE" in patterns[:-1]:
        place = patterns.index("RELATIVE")
        beside = patterns[place + 1]
        del patterns[place : place + 2]
    if len(args) < 2 or "LIST_DIRECTORIES" in patterns or beside not in (None, here):
        return None
    found = {
        path.as_posix() for pattern in patterns for path in _matches(Path(here, pattern), args[0] == "GLOB_RECURSE")
    }
    start = "" if beside is None else f"{here}/"
    return [path.removeprefix(start) for path in sorted(found)]


def _matches(pattern: Path, below: bool) -> list[Path]:
    if not below:
        return [Path(path) for path in glob(str(pattern))]
    return [path for path in pattern.parent.rglob(pattern.name) if path.is_file()] if pattern.name else []
