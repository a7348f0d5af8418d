"""Commands among Python: which lines of a notebook's cell are meant for the terminal.

A statement that begins with `ros2`, `colcon`, `source`, `mkdir`, `cd` or their kin and is no Python is replaced by a call that
runs it, so that commands may stand anywhere: between Python statements, indented in an `if` or a loop, several in one cell.
What could be Python (`ros2 -h` is a subtraction) counts as Python if the name is a variable.
"""

from __future__ import annotations

import ast
import re
import textwrap
from collections.abc import Container, Iterator

from .words import is_unfinished

COMMANDS = ("ros2", "colcon", "source", "mkdir", "cd", "ls", "pwd", "cat", "touch", "jobs", "kill")
OWN_MAGICS = ("ros2", "colcon", "source")
"""Those that may also be written with a `%`, everywhere; `%cd`, `%ls` and others are IPython's own."""

MAGIC = "terminal"

_FIRST = re.compile(
    rf"(?P<indent>[ \t]*)(?:(?P<percent>%)(?:{'|'.join(OWN_MAGICS)})|(?P<word>{'|'.join(COMMANDS)}|\.(?= )))(?!\w)(?P<rest>.*)",
    re.DOTALL,
)
_PYTHON_NEXT = re.compile(r"[.(\[,:)\]}]|\s*(?:[-+*/%&|^@]|//|\*\*|<<|>>|[=!<>])?=|\s+(?:in|is|if|and|or|not|for)\b\s")
_STRING = re.compile(r"(?i)(?:[rbfut]{0,3})('''|\"\"\"|'|\")")


def translate(lines: list[str], variables: Container[str] = ()) -> list[str]:
    """Replace the commands among a cell's lines; the number of lines stays as it is.

    Args:
        lines: the cell's lines, with their line ends.
        variables: names that have a value, and so are Python wherever they could be.
    """
    if not any(_FIRST.match(line) for line in lines):
        return lines
    assigned = _assigned("".join(lines))
    translated: list[str] = []
    at = 0
    while at < len(lines):
        end = _command_end(lines, at, variables, assigned)
        if end is not None:
            translated += _call(lines[at:end])
        else:
            end = _statement_end(lines, at)
            translated += lines[at:end]
        at = end
    return translated


# -- commands ------------------------------------------------------------------------------------------------------------


def _command_end(lines: list[str], at: int, variables: Container[str], assigned: set[str]) -> int | None:
    """The line behind the command that begins here, or None if this is no command."""
    found = _FIRST.match(lines[at])
    if found is None:
        return None
    if not found["percent"]:
        if _PYTHON_NEXT.match(found["rest"]):
            return None
        taken = found["word"] in variables or found["word"] in assigned
        if taken and _is_python("".join(lines[at : _statement_end(lines, at)])):
            return None
    return _end_of_script(lines, at)


def _end_of_script(lines: list[str], at: int) -> int:
    """A command goes on while a quote is open or its line ends in a backslash."""
    for end in range(at + 1, len(lines) + 1):
        if not is_unfinished("".join(lines[at:end]).rstrip("\n")):
            return end
    return at + 1


def _is_python(statement: str) -> bool:
    try:
        ast.parse(textwrap.dedent(statement))
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return False
    return True


def _assigned(cell: str) -> set[str]:
    """The command words that a cell itself gives a value to."""
    return {
        word
        for word in COMMANDS
        if re.search(rf"(?m)(?:^|[\s,(*]){word}\s*(?:,[^=\n]*)?(?::[^=\n]+)?=(?!=)", cell)
        or re.search(rf"\b(?:for|import|as|def|class|global)\s+{word}\b", cell)
        or re.search(rf"\bdef\s+\w+\([^)]*\b{word}\b", cell)
    }


def _call(lines: list[str]) -> list[str]:
    """The Python that runs a command, as many lines long as the command."""
    found = _FIRST.match(lines[0])
    assert found is not None
    script = "".join([lines[0][len(found["indent"]) + len(found["percent"] or "") :], *lines[1:]]).rstrip("\n")
    call = f"{found['indent']}get_ipython().run_line_magic({MAGIC!r}, {script!r})"
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
    for kind, text in _pieces(line, string):
        if kind == "open string":
            return depth, text, True
        if kind == "bracket":
            depth = max(0, depth + (1 if text in "([{" else -1))
        elif kind == "backslash":
            return depth, "", True
    return depth, "", depth > 0


def _pieces(line: str, string: str) -> Iterator[tuple[str, str]]:
    at = 0
    while at < len(line):
        if string:
            end = _string_end(line, at, string)
            if end is None:
                if len(string) == 3 or line.rstrip("\n").endswith("\\"):
                    yield "open string", string
                return
            at, string = end, ""
            continue
        char = line[at]
        if char == "#":
            return
        opened = _STRING.match(line, at) if char in "'\"" else None
        if opened:
            string, at = opened[1], opened.end()
        elif char == "\\" and line[at + 1 :].strip() == "":
            yield "backslash", char
            return
        else:
            if char in "([{)]}":
                yield "bracket", char
            at += 1


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
