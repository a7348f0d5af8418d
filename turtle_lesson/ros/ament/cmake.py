"""Reads a CMakeLists.txt: text to commands with their lines, and which of them take effect, with their variables put in.

Understood is what an ament package of Python files needs: `set`, `list(APPEND)`, `project`, `if` and `file(GLOB)`. Loops,
functions and macros are passed over with all that lies inside, and named (`CMakeFile.passed_over`). Nothing is built or run.
Facts: https://cmake.org/cmake/help/latest/manual/cmake-language.7.html and, for conditions, command/if.html there.
"""

from __future__ import annotations

import re
import warnings
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from glob import glob
from pathlib import Path

from ..sim.errors import shown_path
from .package import BuildFailure, refused

COMPILES = {"add_executable", "add_library", "ament_auto_add_executable", "ament_auto_add_library"}
"""The commands by which a package builds something in C++, which is left out here."""

_BLOCKS = ("foreach", "while", "function", "macro")
"""The commands whose bodies are passed over."""

_ENDS = {f"end{name}": name for name in ("if", *_BLOCKS)}
_INSTALL_FOLDERS = {
    **{f"CMAKE_INSTALL_{folder.upper()}DIR": folder for folder in ("bin", "lib", "include")},
    **dict.fromkeys(("CMAKE_INSTALL_DATADIR", "CMAKE_INSTALL_DATAROOTDIR"), "share"),
}
"""The variables that include(GNUInstallDirs) sets."""


def split_at(args: Sequence[str], words: Collection[str]) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """The arguments before the first of CMake's own words, and those from it on."""
    end = next((place for place, argument in enumerate(args) if argument in words), len(args))
    return tuple(args[:end]), tuple(args[end:])


def _unreadable(words: str, place: str | int, line: int, reason: str) -> BuildFailure:
    """CMake's own words about a text, which name `place`; `reason` says what is wrong in `line`."""
    return refused(words, f"CMakeLists.txt:{place}", f"CMakeLists.txt, line {line}: {reason}.", seconds=0.1)


# -- text to commands ----------------------------------------------------------------------------------------------------

_TOKEN = re.compile(
    r"""(?P<skipped>[ \t\r]+|\#\[(=*)\[.*?\]\2\]|\#(?!\[=*\[)[^\n]*)
    |\#\[=*\[(?P<open_comment>.*)
    |(?P<newline>\s)
    |(?P<left>\()|(?P<right>\))
    |\[(=*)\[\n?(?P<bracket>.*?)\]\7\]
    |"(?P<quoted>(?:[^"\\]|\\.)*)"
    |(?P<identifier>[A-Za-z_]\w*)(?=[\s()\#]|\Z)
    |(?P<unquoted>(?:[^\s()\#"\\]|\\.|(?<=[^\s()])"[^"]*")+)
    |["\\](?P<open_string>.*)""",
    re.DOTALL | re.VERBOSE,
)
_KINDS = {
    **{name: f"{name} paren" for name in ("left", "right")},
    **{name: f"{name} argument" for name in ("bracket", "quoted", "unquoted")},
    "open_comment": "unterminated bracket",
    "open_string": "unterminated string",
}
"""What CMake calls the tokens whose names in the pattern are others."""

_OPEN = {
    "unterminated bracket": "this #[[ comment never ends; close it with ]]",
    "unterminated string": 'this quote is never closed; end the text with another "',
}


@dataclass(frozen=True)
class Token:
    """One token: its kind in CMake's words, its text without quotes, its line, and the line at which CMake says so."""

    kind: str
    text: str
    line: int
    place: int

    @property
    def quoted(self) -> bool:
        """Whether it stays one argument."""
        return self.kind in {"bracket argument", "quoted argument"}

    def refusal(self, words: str, reason: str) -> BuildFailure:
        """The error of CMake's that this token is found where another one must be; `reason` says it for people."""
        cut = self.text if len(self.text) <= 400 else f"{self.text[:400]}…"
        shown = cut.replace("\n", "\n\n")  # every line a paragraph
        said = f'{words} {self.kind} with text "{shown}".'
        return _unreadable(said, self.place, self.line, _OPEN.get(self.kind, reason))


@dataclass(frozen=True)
class Call:
    """One command as written: its name in lower case, its arguments, the line where it begins."""

    name: str
    args: tuple[Token, ...]
    line: int


def _tokens(text: str) -> Iterator[Token]:
    """The tokens of a text, without spaces and comments."""
    line, last = 1, text.count("\n") + 1
    for match in _TOKEN.finditer(text):
        name = match.lastgroup or ""
        kind = _KINDS.get(name, name)
        if name != "skipped":
            place = last if kind in _OPEN else line + (name == "newline")
            yield Token(kind, match[name].replace("\\\n", "") if name == "quoted" else match[name], line, place)
        line += match[0].count("\n")


def read_calls(text: str) -> list[Call]:
    """All commands of the text, in order. Raises BuildFailure where it is no CMake, or its blocks are not nested."""
    tokens = _tokens(text)
    calls = []
    for token in tokens:
        if token.kind == "newline":
            continue
        if token.kind != "identifier":
            reason = f"expected a command such as find_package(…), found {token.text[:20]!r}"
            raise token.refusal("Parse error. Expected a command name, got", reason)
        calls.append(Call(token.text.lower(), tuple(_arguments(tokens, token)), token.line))
    _check_blocks(calls)
    return calls


def _arguments(tokens: Iterator[Token], name: Token) -> Iterator[Token]:
    """The arguments up to the parenthesis that ends the command; inner ones are arguments of their own."""
    reason = f"expected '(' after {name.text!r}: a command looks like {name.text}(…)"
    opening = next(tokens, None)
    if opening is None:
        words = 'Unexpected end of file.\nParse error. Function missing opening "(".'
        raise _unreadable(words, name.line, name.line, reason)
    if opening.kind != "left paren":
        raise replace(opening, line=name.line).refusal('Parse error. Expected "(", got', reason)
    depth = 1
    for token in tokens:
        if token.kind in _OPEN:
            raise token.refusal('Parse error. Function missing ending ")". Instead found', "")
        depth += {"left paren": 1, "right paren": -1}.get(token.kind, 0)
        if depth == 0:
            return
        if token.kind != "newline":
            yield token
    reason = f"the '(' of {name.text} is never closed; put a ')' where its arguments end"
    raise _unreadable('Parse error. Function missing ending ")". End of file reached.', name.line, name.line, reason)


def _check_blocks(calls: Sequence[Call]) -> None:
    """Every `if` and every loop is closed, in the right order."""
    words = "Flow control statements are not properly nested."
    opened: list[Call] = []
    for call in calls:
        if call.name in _ENDS.values():
            opened.append(call)
        elif call.name in {*_ENDS, "else", "elseif"}:
            start = _ENDS.get(call.name, "if")
            if not opened or opened[-1].name != start:
                article = "an" if start == "if" else "a"
                reason = f"{call.name}() without {article} {start}() before it"
                raise _unreadable(words, f"{call.line} ({call.name})", call.line, reason)
            if call.name in _ENDS:
                opened.pop()
    if opened:
        line, name = opened[-1].line, opened[-1].name
        raise _unreadable(words, f"{line} ({name})", line, f"this {name}() has no end{name}()")


# -- conditions ----------------------------------------------------------------------------------------------------------

_TRUE = {"1", "ON", "YES", "TRUE", "Y"}
_FALSE = {"", "0", "OFF", "NO", "FALSE", "N", "IGNORE", "NOTFOUND"}
_BINARY = (
    "STREQUAL", "EQUAL", "MATCHES", "IN_LIST", "LESS", "GREATER", "LESS_EQUAL", "GREATER_EQUAL", "STRLESS",
    "STRGREATER", "VERSION_LESS", "VERSION_GREATER", "VERSION_EQUAL", "VERSION_LESS_EQUAL",
    "VERSION_GREATER_EQUAL", "IS_NEWER_THAN",
)  # fmt: skip
_UNARY = ("DEFINED", "TARGET", "EXISTS", "COMMAND", "POLICY", "TEST", "IS_DIRECTORY", "IS_ABSOLUTE")


class _Condition:
    """The condition of an `if(…)`: takes the words, each with whether it was quoted, the operator that binds weakest first.

    Names, NOT, AND, OR, DEFINED, STREQUAL, EQUAL, IN_LIST, MATCHES and parentheses are understood; other tests count as
    false, as they mostly are for a package of Python files. What CMake does not know raises ValueError.
    """

    def __init__(self, words: list[tuple[str, bool]], variables: Mapping[str, str]) -> None:
        self.words = list(words)
        self.variables = variables

    def holds(self) -> bool:
        value = bool(self.words) and self._either()
        if self.words:
            raise ValueError
        return value

    def _accept(self, *expected: str) -> str:
        if self.words and not self.words[0][1] and self.words[0][0] in expected:
            return self.words.pop(0)[0]
        return ""

    def _next(self) -> tuple[str, bool]:
        if not self.words:
            raise ValueError
        return self.words.pop(0)

    def _either(self) -> bool:
        value = self._both()
        while self._accept("OR"):
            value = self._both() or value
        return value

    def _both(self) -> bool:
        value = self._single()
        while self._accept("AND"):
            value = self._single() and value
        return value

    def _single(self) -> bool:
        if self._accept("NOT"):
            return not self._single()
        if self._accept("("):
            value = self._either()
            if not self._accept(")"):
                raise ValueError
            return value
        if test := self._accept(*_UNARY):
            operand = self.words.pop(0)[0] if self.words else ""
            return test == "DEFINED" and operand in self.variables
        left = self._next()
        operator = self._accept(*_BINARY)
        if not operator:
            return self._truth(*left)
        one, other = (text if quoted else self.variables.get(text, text) for text, quoted in (left, self._next()))
        if operator in {"STREQUAL", "EQUAL"}:
            return one == other
        if operator == "IN_LIST":
            return one in other.split(";")
        # Python warns where brackets hold what may mean more one day: `[[a-z]`
        with warnings.catch_warnings(action="ignore", category=FutureWarning):
            return operator == "MATCHES" and re.search(other, one) is not None

    def _truth(self, text: str, quoted: bool) -> bool:
        if text.upper() in _TRUE:
            return True
        value = "" if quoted or text.upper() in _FALSE else self.variables.get(text, "").upper()
        return value not in _FALSE and not value.endswith("-NOTFOUND")


# -- commands that take effect -------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Command:
    """One command that takes effect: its name in lower case, its expanded arguments, its line."""

    name: str
    args: tuple[str, ...]
    line: int

    def after(self, word: str) -> str:
        """The argument behind a word such as PACKAGE_DIR; nothing where there is none."""
        return self.args[self.args.index(word) + 1] if word in self.args[:-1] else ""


@dataclass
class CMakeFile:
    """The commands of a CMakeLists.txt in the order of their effect, and what they mean for a package."""

    commands: list[Command] = field(default_factory=list)
    compiled: dict[str, int] = field(default_factory=dict)
    """The C++ programs and libraries, each with its line; those of inner folders with the line that names the folder."""
    builds_cpp: bool = False
    """Whether a command of the text builds C++, even where it is passed over."""
    passed_over: list[tuple[str, int]] = field(default_factory=list)
    """The loops, functions and macros that would take effect, each with its line."""
    defined: set[str] = field(default_factory=set)
    """The names of the functions and macros that the text defines, in lower case."""


def compiled_programs(folder: Path, variables: dict[str, str] | None = None) -> dict[str, int]:
    """What the CMakeLists.txt in a folder builds in C++, each with its line; nothing without a readable one."""
    try:
        return evaluate((folder / "CMakeLists.txt").read_text(encoding="utf-8"), folder, variables).compiled
    except (BuildFailure, OSError, UnicodeDecodeError):
        return {}


def evaluate(text: str, folder: Path = Path(), variables: dict[str, str] | None = None) -> CMakeFile:
    """The commands of the text that take effect, with their variables put in, and the C++ of its inner folders.

    Where a file builds C++, what is not understood in it is passed over: most of it serves the C++. Raises BuildFailure
    where CMake would refuse the text, or it needs more of CMake than is understood here.
    """
    where = folder.as_posix()
    known = variables or dict.fromkeys(("CMAKE_SOURCE_DIR", "PROJECT_SOURCE_DIR"), where)
    known |= {"CMAKE_CURRENT_SOURCE_DIR": where, "CMAKE_CURRENT_LIST_DIR": where, "BUILD_TESTING": "ON", "UNIX": "1"}
    calls = read_calls(text)
    evaluator = _Evaluator(known, lenient=any(call.name in COMPILES for call in calls))
    read = CMakeFile(list(evaluator.run(calls)), builds_cpp=evaluator.lenient, passed_over=evaluator.passed_over)
    read.defined = {call.args[0].text.lower() for call in calls if call.name in {"function", "macro"} and call.args}
    for command in read.commands:
        if command.name in COMPILES and command.args:
            read.compiled[command.args[0]] = command.line
        elif command.name.startswith("rclcpp_components_register_node") and command.after("EXECUTABLE"):
            read.compiled[command.after("EXECUTABLE")] = command.line
        elif command.name == "add_subdirectory":
            inner = folder.joinpath(*command.args[:1]).resolve()
            if folder.resolve() in inner.parents:
                read.compiled |= dict.fromkeys(compiled_programs(inner, dict(known)), command.line)
    return read


_VARIABLE = re.compile(r"\\(.)|\$\{([^${}]*)\}", re.DOTALL)
_ESCAPES = {"n": "\n", "t": "\t", "r": "\r", ";": "\\;"}  # \; is still to be seen when lists are split


class _Evaluator:
    """Goes through the calls once, keeping the variables and which `if` branch is taken."""

    def __init__(self, variables: dict[str, str], *, lenient: bool) -> None:
        self.variables = variables
        self.lenient = lenient
        self.passed_over: list[tuple[str, int]] = []
        self._branches: list[str] = []  # one per open if: "taken", "waiting" for its branch, or "done"

    def run(self, calls: list[Call]) -> Iterator[Command]:
        """The commands that take effect."""
        depth = 0  # of the loops, functions and macros that the call stands in
        for call in calls:
            if call.name in _BLOCKS and self._active:
                if not depth:
                    self.passed_over.append((call.name, call.line))
                depth += 1
            elif depth:
                depth -= _ENDS.get(call.name) in _BLOCKS
            elif call.name in {"if", "elseif", "else", "endif"}:
                self._branch(call)
            elif self._active:
                if call.name == "return":
                    return
                command = Command(call.name, tuple(self._arguments(call)), call.line)
                self._effect(command)
                yield command

    @property
    def _active(self) -> bool:
        return all(branch == "taken" for branch in self._branches)

    def _branch(self, call: Call) -> None:
        if call.name == "if":
            state = "waiting" if self._active else "done"
        else:
            state = self._branches.pop()
            if call.name == "endif":
                return
        if state == "waiting" and (call.name == "else" or self._holds(call)):
            self._branches.append("taken")
        else:
            self._branches.append("waiting" if state == "waiting" else "done")

    def _holds(self, call: Call) -> bool:
        words = [(self._expanded(argument, call), argument.quoted) for argument in call.args]
        try:
            return _Condition(words, self.variables).holds()
        except (ValueError, re.error, RecursionError):  # no regular expression, or thousands of parentheses
            given = " ".join(f'"{word}"' for word, _ in words)
            said = f"if given arguments:\n\n  {given}\n\nUnknown arguments specified"
            text = " ".join(word for word, _ in words)
            reason = f"if({text}) is not a condition that CMake knows"
            raise _unreadable(said, f"{call.line} (if)", call.line, reason) from None

    def _effect(self, command: Command) -> None:
        variables, args = self.variables, command.args
        match command.name, *args:
            case ["set", name, *values]:
                variables[name] = ";".join(split_at(values, {"CACHE", "PARENT_SCOPE"})[0])
            case ["unset", name, *_]:
                variables.pop(name, None)
            case ["list", "APPEND", name, *values]:
                variables[name] = ";".join(filter(None, [variables.get(name, ""), *values]))
            case ["project", name, *_]:
                variables["PROJECT_NAME"] = variables["CMAKE_PROJECT_NAME"] = name
            case ["include", "GNUInstallDirs", *_]:
                variables |= _INSTALL_FOLDERS
            case ["file", "GLOB" | "GLOB_RECURSE" as kind, name, *words]:
                found = _globbed(words, variables["CMAKE_CURRENT_SOURCE_DIR"], below=kind == "GLOB_RECURSE")
                if found is None and not self.lenient:
                    reason = f"file({kind} …) with these arguments is not understood here; name the files one by one"
                    raise refused(reason, f"CMakeLists.txt:{command.line}", seconds=0.1)
                variables[name] = ";".join(found or ())

    def _arguments(self, call: Call) -> Iterator[str]:
        for argument in call.args:
            text = self._expanded(argument, call)
            if argument.quoted:
                yield text
            else:  # a list, whose elements are arguments of their own
                yield from (part.replace("\\;", ";") for part in re.split(r"(?<!\\);", text) if part)

    def _expanded(self, argument: Token, call: Call) -> str:
        """The argument with its variables and escapes put in; an unset variable is empty, as in CMake."""
        text = argument.text
        if argument.kind == "bracket argument":  # in `[[…]]` nothing is replaced
            return text
        if text.count("${") > text.count("}"):
            file = shown_path(f"{self.variables['CMAKE_CURRENT_SOURCE_DIR']}/CMakeLists.txt")
            words = (
                f"Syntax error in cmake code at\n\n  {file}:{argument.line}\n\nwhen parsing string\n\n  {text}\n\n"
                "There is an unterminated variable reference."
            )
            raise _unreadable(
                words, f"{call.line} ({call.name})", argument.line, f"'{text}': a ${{ is not closed by }}"
            )
        for _ in range(10):  # ${a_${b}} needs a round for each level
            expanded = _VARIABLE.sub(self._replaced, text)
            if expanded == text or "${" not in expanded:
                return expanded
            text = expanded
        return text

    def _replaced(self, match: re.Match[str]) -> str:
        escaped, name = match.groups()
        return self.variables.get(name, "") if escaped is None else _ESCAPES.get(escaped, escaped)


def _globbed(words: Sequence[str], here: str, *, below: bool) -> list[str] | None:
    """What `file(GLOB variable [RELATIVE folder] pattern …)` finds from the folder `here` on, sorted.

    None if there are words that are not understood.
    """
    patterns = [word for word in words if word != "CONFIGURE_DEPENDS"]
    start = ""
    if patterns[:2] == ["RELATIVE", here]:
        del patterns[:2]
        start = f"{here}/"
    if {"RELATIVE", "LIST_DIRECTORIES"} & set(patterns):
        return None
    found: set[Path] = set()
    for pattern in (Path(here, each) for each in patterns if each):
        found |= set(
            filter(Path.is_file, pattern.parent.rglob(pattern.name)) if below else map(Path, glob(str(pattern)))
        )
    return [path.removeprefix(start) for path in sorted(path.as_posix() for path in found)]
