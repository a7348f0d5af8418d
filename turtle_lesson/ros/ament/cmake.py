"""Reads a CMakeLists.txt: which of its commands take effect, in their order and with their variables put in.

Understood is what an ament package of Python files needs: `set`, `list(APPEND)`, `project`, `if` and `file(GLOB)`. Loops,
functions and macros are refused. Nothing is compiled or run.
Facts: https://cmake.org/cmake/help/latest/manual/cmake-language.7.html and, for conditions, command/if.html there.
"""

from __future__ import annotations

import os
import re
from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from glob import glob
from itertools import takewhile
from pathlib import Path

from ..sim.errors import shown_path
from .package import BuildFailure, refused

_COMPILES = {"add_executable", "add_library", "add_subdirectory"}
_NOT_CARRIED_OUT = {"foreach", "while", "function", "macro", "ament_auto_package", "ament_python_install_module"}
_INSTALL_FOLDERS = {
    **{f"CMAKE_INSTALL_{folder.upper()}DIR": folder for folder in ("bin", "lib", "include")},
    **dict.fromkeys(("CMAKE_INSTALL_DATADIR", "CMAKE_INSTALL_DATAROOTDIR"), "share"),
}
"""The variables that include(GNUInstallDirs) sets."""


@dataclass(frozen=True)
class Command:
    """One command: its name in lower case, its arguments as written, its line; if it takes effect, its expanded arguments."""

    name: str
    tokens: tuple[Token, ...]
    line: int
    args: tuple[str, ...] = ()

    @property
    def where(self) -> str:
        """Its place, as CMake's messages name it."""
        return f"CMakeLists.txt:{self.line} ({self.name})"

    def after(self, word: str) -> str:
        """The argument behind a word such as PACKAGE_DIR; nothing where there is none."""
        return self.args[self.args.index(word) + 1] if word in self.args[:-1] else ""


def until(words: Collection[str], args: Iterable[str]) -> list[str]:
    """The arguments before the first of CMake's own words."""
    return list(takewhile(lambda argument: argument not in words, args))


def evaluate(text: str, folder: Path = Path()) -> list[Command]:
    """The commands of the text that take effect. Raises BuildFailure for what CMake would refuse, or is not understood here."""
    return list(_Evaluator(folder).run(read_calls(text)))


def compiled(commands: Iterable[Command]) -> dict[str, int]:
    """The programs, libraries and folders that the commands build in C++, each with its line."""
    found = {command.args[0]: command.line for command in commands if command.name in _COMPILES and command.args}
    for command in commands:
        if command.name.startswith("rclcpp_components_register_node") and command.after("EXECUTABLE"):
            found[command.after("EXECUTABLE")] = command.line
    return found


def compiled_programs(folder: Path) -> dict[str, int]:
    """What the CMakeLists.txt in a folder builds in C++, each with its line; nothing without a readable one."""
    try:
        return compiled(evaluate((folder / "CMakeLists.txt").read_text(encoding="utf-8"), folder))
    except (BuildFailure, OSError, UnicodeDecodeError):
        return {}


def _unreadable(words: str, where: str, line: int, reason: str) -> BuildFailure:
    """CMake's own words about a text, which name a place; `reason` says what is wrong in `line`."""
    return refused(words, where, f"CMakeLists.txt, line {line}: {reason}.", seconds=0.1)


# -- text to commands ----------------------------------------------------------------------------------------------------

_TOKEN = re.compile(
    r"""(?P<skipped>[ \t\r]+|\#\[(=*)\[.*?\]\2\]|\#(?!\[=*\[)[^\n]*)
    |\#\[=*\[(?P<unterminated_bracket>.*)
    |(?P<newline>\s)
    |(?P<left_paren>\()|(?P<right_paren>\))
    |\[(=*)\[\n?(?P<bracket_argument>.*?)\]\7\]
    |"(?P<quoted_argument>(?:[^"\\]|\\.)*)"
    |(?P<identifier>[A-Za-z_]\w*)(?=[\s()\#])
    |(?P<unquoted_argument>(?:[^\s()\#"\\]|\\.|(?<=[^\s()])"[^"]*")+)
    |["\\](?P<unterminated_string>.*)""",
    re.DOTALL | re.VERBOSE,
)
"""The kinds of tokens, named in CMake's own words."""

_OPEN = {
    "unterminated bracket": "this #[[ comment never ends; close it with ]]",
    "unterminated string": 'this quote is never closed; end the text with another "',
}


@dataclass(frozen=True)
class Token:
    """One token: its kind in CMake's words, its text without quotes, the lines in which it begins and ends."""

    kind: str
    text: str
    line: int
    end: int

    @property
    def quoted(self) -> bool:
        """Whether it stays one argument."""
        return self.kind in {"bracket argument", "quoted argument"}

    def refusal(self, words: str, line: int, reason: str) -> BuildFailure:
        """CMake's error that this token stands where another one must be; `reason` says it in plain words."""
        shown = self.text.replace("\n", "\n\n")  # every line a paragraph
        said = f'{words} {self.kind} with text "{shown}".'
        return _unreadable(said, f"CMakeLists.txt:{self.end}", line, _OPEN.get(self.kind, reason))


def read_calls(text: str) -> list[Command]:
    """All commands of the text, in order. Raises BuildFailure where it is no CMake."""
    tokens = _tokens(text if text.endswith("\n") else f"{text}\n")
    calls = []
    for token in tokens:
        if token.kind == "newline":
            continue
        if token.kind != "identifier":
            reason = f"expected a command such as find_package(…), found {token.text[:20]!r}"
            raise token.refusal("Parse error. Expected a command name, got", token.line, reason)
        calls.append(Command(token.text.lower(), tuple(_arguments(tokens, token)), token.line))
    return calls


def _tokens(text: str) -> Iterator[Token]:
    """The tokens of a text, without spaces and comments."""
    line = 1
    for match in _TOKEN.finditer(text):
        kind, end = match.lastgroup or "", line + match[0].count("\n")
        if kind != "skipped":
            yield Token(kind.replace("_", " "), match[kind], line, end)
        line = end


def _arguments(tokens: Iterator[Token], name: Token) -> Iterator[Token]:
    """The arguments up to the parenthesis that ends the command; inner ones are arguments of their own."""
    opening = next(tokens)
    if opening.kind != "left paren":
        reason = f"expected '(' after {name.text!r}: a command looks like {name.text}(…)"
        raise opening.refusal('Parse error. Expected "(", got', name.line, reason)
    depth = 1
    for token in tokens:
        if token.kind in _OPEN:
            raise token.refusal('Parse error. Function missing ending ")". Instead found', token.line, "")
        depth += {"left paren": 1, "right paren": -1}.get(token.kind, 0)
        if depth == 0:
            return
        if token.kind != "newline":
            yield token
    reason = f"the '(' of {name.text} is never closed; put a ')' where its arguments end"
    said = 'Parse error. Function missing ending ")". End of file reached.'
    raise _unreadable(said, f"CMakeLists.txt:{name.line}", name.line, reason)


# -- conditions ----------------------------------------------------------------------------------------------------------

_TRUE = {"1", "ON", "YES", "TRUE", "Y"}
_FALSE = {"", "0", "OFF", "NO", "FALSE", "N", "IGNORE", "NOTFOUND"}
_BINARY = re.compile(r"MATCHES|IN_LIST|IS_NEWER_THAN|(VERSION_|STR)?(EQUAL|(LESS|GREATER)(_EQUAL)?)")
MOST_WORDS = 150
"""How long the condition of an `if(…)` may be."""
_UNARY = {"DEFINED", "TARGET", "EXISTS", "COMMAND", "POLICY", "TEST", "IS_DIRECTORY", "IS_ABSOLUTE"}


def _holds(words: list[tuple[str, bool]], variables: Mapping[str, str]) -> bool:
    """Whether the condition of an `if(…)` holds, given its words and whether each was quoted.

    Each test is replaced by its value, and what is left is an expression of Python's: CMake binds NOT, AND and OR alike. Tests
    that are not understood count as false, as they mostly are for a package of Python files.
    Raises SyntaxError or TypeError for what is no condition, or has more words than Python can nest.
    """
    if len(words) > MOST_WORDS:
        raise SyntaxError
    parts = []
    waiting = words[::-1]
    while waiting:
        text, quoted = waiting.pop()
        if not quoted and text in {"NOT", "AND", "OR", "(", ")"}:
            parts.append(text.lower())
            continue
        if not quoted and text in _UNARY and waiting:
            holds = waiting.pop()[0] in variables and text == "DEFINED"
        elif len(waiting) > 1 and not waiting[-1][1] and _BINARY.fullmatch(waiting[-1][0]):
            operator, right = waiting.pop()[0], waiting.pop()
            one, other = (word if whole else variables.get(word, word) for word, whole in ((text, quoted), right))
            holds = operator in {"STREQUAL", "EQUAL"} and one == other
        else:
            value = text if quoted or text.upper() in _TRUE else variables.get(text, "")
            holds = value.upper() in _TRUE or not (quoted or value.upper() in _FALSE)
        parts.append("yes" if holds else "no")
    return bool(parts) and bool(eval(" ".join(parts), {"yes": True, "no": False}))


# -- commands that take effect -------------------------------------------------------------------------------------------

_VARIABLE = re.compile(r"\\(.)|\$\{([^${}]*)\}", re.DOTALL)
_ESCAPES = {"n": "\n", "t": "\t", ";": "\\;"}  # \; is still to be seen when lists are split
_NESTED = "Flow control statements are not properly nested."


class _Evaluator:
    """Goes through the calls once, keeping the variables and which `if` branch is taken."""

    def __init__(self, folder: Path) -> None:
        names = ("CMAKE_SOURCE_DIR", "PROJECT_SOURCE_DIR", "CMAKE_CURRENT_SOURCE_DIR", "CMAKE_CURRENT_LIST_DIR")
        self.folder = folder
        self.variables = dict.fromkeys(names, folder.as_posix()) | {"BUILD_TESTING": "ON", "UNIX": "1"}

    def run(self, calls: Iterable[Command]) -> Iterator[Command]:
        """The commands that take effect."""
        # each open if, and whether it is "waiting" for its branch, "taken" or "done"
        opened: list[tuple[Command, str]] = []
        for call in calls:
            active = all(state == "taken" for _, state in opened)
            if call.name == "if":
                opened.append((call, self._state(call, "waiting" if active else "done")))
            elif call.name in {"elseif", "else", "endif"}:
                if not opened:
                    reason = f"{call.name}() without an if() before it"
                    raise _unreadable(_NESTED, call.where, call.line, reason)
                begin, state = opened.pop()
                if call.name != "endif":
                    opened.append((begin, self._state(call, state)))
            elif active:
                if call.name in _NOT_CARRIED_OUT:
                    hint = "Write the commands that it stands for in its place."
                    raise refused(
                        f"{call.name}() is not carried out in this simulation.", call.where, hint, seconds=0.1
                    )
                if call.name == "return":
                    return
                command = replace(call, args=tuple(self._arguments(call)))
                self._effect(command)
                yield command
        if opened:
            call, _ = opened[-1]
            raise _unreadable(_NESTED, call.where, call.line, "this if() has no endif()")

    def _state(self, call: Command, state: str) -> str:
        """The state of an `if` after this `if`, `elseif` or `else` of it."""
        if state != "waiting":
            return "done"
        words = [(self._expanded(argument, call), argument.quoted) for argument in call.tokens]
        try:
            return "taken" if call.name == "else" or _holds(words, self.variables) else "waiting"
        except (SyntaxError, TypeError):
            given = " ".join(f'"{word}"' for word, _ in words)
            said = f"if given arguments:\n\n  {given}\n\nUnknown arguments specified"
            reason = f"if({' '.join(word for word, _ in words)}) is not a condition that CMake knows"
            raise _unreadable(said, f"CMakeLists.txt:{call.line} (if)", call.line, reason) from None

    def _effect(self, command: Command) -> None:
        variables = self.variables
        match command.name, *command.args:
            case ["set", name, *values]:
                variables[name] = ";".join(until({"CACHE", "PARENT_SCOPE"}, values))
            case ["list", "APPEND", name, *values]:
                variables[name] = ";".join(filter(None, [variables.get(name, ""), *values]))
            case ["project", name, *_]:
                variables["PROJECT_NAME"] = variables["CMAKE_PROJECT_NAME"] = name
            case ["include", "GNUInstallDirs", *_]:
                variables |= _INSTALL_FOLDERS
            case ["file", "GLOB", name, *words]:
                # Names as seen from the package's folder, with or without RELATIVE: both mean the same files.
                here = self.folder.as_posix()
                patterns = [word.removeprefix(f"{here}/") for word in words if word != here]
                found = {file for pattern in patterns for file in glob(pattern, root_dir=here)}
                variables[name] = ";".join(sorted(file.replace(os.sep, "/") for file in found))

    def _arguments(self, call: Command) -> Iterator[str]:
        for argument in call.tokens:
            text = self._expanded(argument, call)
            if argument.quoted:
                yield text
            else:  # a list, whose elements are arguments of their own
                yield from (part.replace("\\;", ";") for part in re.split(r"(?<!\\);", text) if part)

    def _expanded(self, argument: Token, call: Command) -> str:
        """The argument with its variables and escapes put in; an unset variable is empty, as in CMake."""
        text = argument.text
        if argument.kind == "bracket argument":  # in `[[…]]` nothing is replaced
            return text
        if text.count("${") > text.count("}"):
            file = shown_path(f"{self.folder.as_posix()}/CMakeLists.txt")
            words = (
                f"Syntax error in cmake code at\n\n  {file}:{argument.line}\n\nwhen parsing string\n\n  {text}\n\n"
                "There is an unterminated variable reference."
            )
            reason = f"'{text}': a ${{ is not closed by }}"
            raise _unreadable(words, call.where, argument.line, reason)
        for _ in range(max(1, text.count("${"))):  # ${a_${b}} needs a round for each level
            text = _VARIABLE.sub(self._replaced, text)
        return text

    def _replaced(self, match: re.Match[str]) -> str:
        escaped, name = match.groups()
        return self.variables.get(name, "") if escaped is None else _ESCAPES.get(escaped, escaped)
