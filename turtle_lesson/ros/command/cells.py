"""Commands among Python: which lines of a notebook's cell are meant for the terminal.

A statement that begins with `ros2`, `colcon`, `source`, `mkdir`, `cd` or their kin and is no Python is replaced by a call that
runs it, so that commands may stand anywhere: between Python statements, indented in an `if` or a loop, behind `if x:` or `;`,
several in one cell. What could be Python (`ros2 -h` is a subtraction) counts as Python if the name is a variable. Words that
are less plainly a command (`echo`, `git`, `python3`) are taken for one only where Python could make nothing of the statement.
"""

from __future__ import annotations

import ast
import difflib
import re
import shutil
import textwrap
from collections.abc import Container, Iterator
from dataclasses import dataclass

from .elsewhere import ELSEWHERE, NEVER_PYTHON
from .words import is_unfinished

COMMANDS = ("ros2", "colcon", "source", "mkdir", "cd", "ls", "pwd", "cat", "touch", "jobs", "kill")
"""Words that are a command unless they are a variable."""

UNSURE = ELSEWHERE | {
    "chmod",
    "cp",
    "echo",
    "export",
    "grep",
    "head",
    "mv",
    "printenv",
    "printf",
    "rm",
    "sleep",
    "sort",
    "tail",
    "unset",
    "wc",
}
"""Words that are a command where the statement is no Python."""

OWN_MAGICS = ("ros2", "colcon", "source")
"""Those that may also be written with a `%`, everywhere; `%cd`, `%ls` and others are IPython's own."""

MAGIC = "terminal"

LONGEST = 1000
"""How far into a line a command behind other statements is looked for."""

_FIRST = re.compile(
    r"(?P<indent>[ \t]*)(?P<sign>%|!\s*|\$\s+)?(?P<word>[A-Za-z][\w-]*|\.(?=[ \t])|\.{1,2}/[\w./-]+)"
    r"(?![\w(\[.,?:\])}])(?P<rest>.*)",
    re.DOTALL,
)
_PYTHON_NEXT = re.compile(r"\s*(?:[-+*/%&|^@]|//|\*\*|<<|>>|[=!<>]|:)?=|\s+(?:in|is|if|and|or|not|for)\b\s")
_VARIABLE = re.compile(r"[A-Za-z_]\w*=\S*[ \t]+(?:\S+[ \t]+)*?(?:ros2|colcon|python3)[ \t]")
_DEEPER = {"(": 1, "[": 1, "{": 1, ")": -1, "]": -1, "}": -1}
_STRING = re.compile(r"(?i)(?:[rbfut]{0,3})('''|\"\"\"|'|\")")


@dataclass(frozen=True)
class _Python:
    """What is known of the Python around a line: which command words are variables."""

    variables: Container[str]
    cell: str

    def has(self, word: str) -> bool:
        """Whether a word is a variable, of the notebook or of this cell."""
        return word in self.variables or _is_assigned(word, self.cell)


def translate(lines: list[str], variables: Container[str] = ()) -> list[str]:
    """Replace the commands among a cell's lines; the number of lines stays as it is.

    Args:
        lines: the cell's lines, with their line ends.
        variables: names that have a value, and so are Python wherever they could be.
    """
    python = _Python(variables, "".join(lines))
    translated: list[str] = []
    at = 0
    while at < len(lines):
        column = _command_column(lines, at, python)
        if column is not None:
            end = _end_of_script(lines, at, column)
            translated += _call(lines[at:end], column)
        else:
            end = _statement_end(lines, at)
            translated += lines[at:end]
        at = end
    return translated


# -- commands ------------------------------------------------------------------------------------------------------------


def _command_column(lines: list[str], at: int, python: _Python) -> int | None:
    """Where in the statement's first line a command begins; None if there is none."""
    if _is_command(lines, at, 0, python):
        return 0
    if lines[at].lstrip().startswith(("%", "!")):
        return None
    return next((column for column in inner_places(lines[at]) if _is_command(lines, at, column, python)), None)


def _is_command(lines: list[str], at: int, column: int, python: _Python) -> bool:
    """Whether what begins at this column of a line is meant for the terminal."""
    found = _FIRST.match(lines[at], column)
    if found is None:
        return False
    sign, word, rest = (found["sign"] or "").strip(), found["word"], found["rest"]
    if sign == "$" or (not sign and "/" in word):  # no statement of Python begins with ./
        return True
    if sign == "%":
        return word in OWN_MAGICS
    if sign == "!":
        return word in OWN_MAGICS and shutil.which(word) is None
    if _VARIABLE.match(word + rest):
        return not _is_python(_statement(lines, at, column))
    if _PYTHON_NEXT.match(rest):
        return False
    if word in COMMANDS or word == ".":
        return not python.has(word) or not _is_python(_statement(lines, at, column))
    if not rest.strip():
        return word in NEVER_PYTHON and not python.has(word)
    known = word in UNSURE or bool(difflib.get_close_matches(word, ("ros2", "colcon"), 1, 0.75))
    return known and not _is_python(_statement(lines, at, column))


def _statement(lines: list[str], at: int, column: int) -> str:
    return "".join([lines[at][column:], *lines[at + 1 : _statement_end(lines, at)]])


def inner_places(line: str) -> Iterator[int]:
    """Where in a line another statement may begin: behind `;`, and behind the `:` of `if x:`."""
    depth = 0
    for kind, sign, place in _pieces(line, ""):
        depth += _DEEPER.get(sign, 0) if kind == "bracket" else 0
        if kind != "end" or depth != 0 or place > LONGEST:
            continue
        found = _FIRST.match(line, place)
        known = found is not None and (found["sign"] or found["word"] in UNSURE or found["word"] in (*COMMANDS, "."))
        if known and _opens(line[:place], " pass" if sign == ":" else ""):
            yield place


def _opens(head: str, body: str) -> bool:
    """Whether a statement can follow this beginning of a line. An `else` or an `except` has more before it."""
    return any(_is_python(f"{before}{head.strip()}{body}") for before in ("", "if 1: pass\n", "try: pass\n"))


def _end_of_script(lines: list[str], at: int, column: int) -> int:
    """A command goes on while a quote is open or its line ends in a backslash."""
    script = lines[at][column:]
    for end in range(at + 1, len(lines) + 1):
        if not is_unfinished(script.rstrip("\n")):
            return end
        script += "".join(lines[end : end + 1])
    return at + 1


def _is_python(statement: str) -> bool:
    try:
        ast.parse(textwrap.dedent(statement).lstrip(" \t"))
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return False
    return True


def _is_assigned(word: str, cell: str) -> bool:
    """Whether a cell itself gives a value to a word."""
    word = re.escape(word)
    return bool(
        re.search(rf"(?m)(?:^|[\s,(*]){word}\s*(?:,[^=\n]*)?(?::[^=\n]*)?=(?!=)", cell)
        or re.search(rf"\b(?:for|import|as|def|class|global)\s+{word}\b", cell)
        or re.search(rf"\bdef\s+\w+\([^)]*\b{word}\b", cell)
    )


def _call(lines: list[str], column: int) -> list[str]:
    """The Python that runs a command, as many lines long as the command."""
    found = _FIRST.match(lines[0], column)
    assert found is not None
    sign = "!" if (found["sign"] or "").startswith("!") else ""
    script = "".join([sign, lines[0][found.start("word") :], *lines[1:]]).rstrip("\n")
    call = f"{lines[0][:column]}{found['indent']}get_ipython().run_line_magic({MAGIC!r}, {script!r})"
    return [f"{call}\n", *["\n"] * (len(lines) - 1)]


# -- Python --------------------------------------------------------------------------------------------------------------


def _statement_end(lines: list[str], at: int) -> int:
    """The line behind the Python statement that begins here: brackets and long strings hold it together."""
    first = lines[at].lstrip()
    depth, string = 0, ""
    for end in range(at, len(lines)):
        line = lines[end]
        if first.startswith(("%", "!")):
            going_on = line.rstrip("\n").endswith("\\")
        else:
            depth, string, going_on = _scan(line, depth, string)
        if not going_on:
            return end + 1
    return at + 1 if depth or string else len(lines)


def _scan(line: str, depth: int, string: str) -> tuple[int, str, bool]:
    """Read one line: the brackets and the string that are open behind it, and whether the statement goes on."""
    for kind, text, _ in _pieces(line, string):
        if kind == "open string":
            return depth, text, True
        if kind == "bracket":
            depth = max(0, depth + _DEEPER[text])
        elif kind == "backslash":
            return depth, "", True
    return depth, "", depth > 0


def _pieces(line: str, string: str) -> Iterator[tuple[str, str, int]]:
    """What holds a line's statement together or ends it: kind, text, and the place behind it."""
    at = 0
    while at < len(line):
        if string:
            end = _string_end(line, at, string)
            if end is None:
                if len(string) == 3 or line.rstrip("\n").endswith("\\"):
                    yield "open string", string, len(line)
                return
            at, string = end, ""
            continue
        char = line[at]
        if char == "#":
            return
        opened = _STRING.match(line, at) if char in "'\"" else None
        if opened:
            string, at = opened[1], opened.end()
            continue
        at += 1
        if char == "\\" and line[at:].strip() == "":
            yield "backslash", char, at
            return
        if char in _DEEPER:
            yield "bracket", char, at
        elif char in ";:":
            yield "end", char, at


def _string_end(line: str, at: int, quote: str) -> int | None:
    """The place behind the string that is open, or None if it does not end in this line."""
    while at < len(line):
        if line[at] == "\\":
            at += 2
        elif line.startswith(quote, at):
            return at + len(quote)
        else:
            at += 1
    return None
