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
import warnings
from bisect import bisect_left
from collections.abc import Container, Iterator, Sequence
from itertools import accumulate

from .script import UnfinishedError, command_end

# -- words of other terminals, of a robot or of ROS 1, and what to do here instead -------------------------------------


_ROS_1 = {
    "catkin_create_pkg": "ros2 pkg create", "catkin_make": "colcon build", "catkin": "colcon build",
    "rosmsg": "ros2 interface", "rospack": "ros2 pkg", "rossrv": "ros2 interface",
    **{f"ros{name}": f"ros2 {name}" for name in ("bag", "launch", "node", "param", "run", "service", "topic")},
}  # fmt: skip

_BY_ADVICE = {
    "nothing needs to be installed here: ROS 2 is simulated": "apt apt-get rosdep sudo",
    "type commands into the cell, as in a terminal; bash FILE runs the commands in a file that is here": "bash sh",
    "JupyterLab's menu Edit clears the outputs of cells": "clear",
    "colcon build does that, from a package's CMakeLists.txt": "cmake make",
    "no editor here: open the file in JupyterLab's list at the left, or begin a cell with %%writefile FILE": (
        "code emacs gedit nano vi vim"
    ),
    "the simulated world is there already: turtlesim, which start() starts": "gazebo",
    "launch_testing is not available here; write tests with pytest instead": "launch_test",
    "%pip install NAME installs into this notebook's Python": "pip3",
    "python3 FILE runs a file, ros2 run a package's program, and !python3 your computer's Python": "python python3",
    "ROS 2 needs none: its nodes find one another": "roscore",
    "there are no windows here; lesson.plot_graph(), plot_path(), plot_status() and plot_scan() draw into the page": (
        "rqt rqt_console rqt_graph rqt_plot rviz rviz2"
    ),
}
_HERE = {word: advice for advice, words in _BY_ADVICE.items() for word in words.split()}
"""What to do here instead, by the first word of a command."""

_ON_THE_COMPUTER = frozenset((
    "awk", "curl", "date", "df", "diff", "docker", "du", "find", "git", "htop", "less", "man", "more", "ping", "ps", "sed",
    "ssh", "tar", "tee", "top", "tree", "unzip", "wget", "which", "whoami",
))  # fmt: skip

ELSEWHERE = frozenset({*_ROS_1, *_HERE, *_ON_THE_COMPUTER})
"""All these words."""

NEVER_PYTHON = frozenset({*_ROS_1, *_HERE} - {"bash", "catkin", "code", "make", "python", "sudo", "vi"})
"""Those that no program would use as a variable, so that one alone on a line is meant for a terminal."""


def advice(words: Sequence[str]) -> str:
    """A sentence on what to do instead of a command; nothing for a word that is none of these."""
    name = words[0]
    if name.startswith("!"):
        return f"the ! runs the command on your computer, which has no {name[1:]}; without the ! it runs here"
    if name == "sudo" and words[1:2] in (["ros2"], ["colcon"]):
        return f"{words[1]} needs no sudo, neither here nor on a robot"
    if name in _ROS_1:
        return f"that is ROS 1; in ROS 2 it is {' '.join([_ROS_1[name], *words[1:]])}"
    if name in _ON_THE_COMPUTER:
        return f"not available in this simulated terminal; !{' '.join(words)} runs it on your computer"
    return _HERE.get(name, "").replace("FILE", words[-1] if len(words) == 2 else "FILE")


COMMANDS = ("ros2", "colcon", "source", "mkdir", "cd", "ls", "pwd", "cat", "touch", "jobs", "kill")
"""Words that are a command unless they are a variable."""

UNSURE = ELSEWHERE | {
    "chmod", "cp", "echo", "export", "grep", "head", "mv", "printenv", "rm", "sleep", "sort", "tail", "unset", "wc",
}  # fmt: skip
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
_PIECE = re.compile(r"""#|(?P<bracket>[()\[\]{}])|(?P<end>[;:])|(?P<backslash>\\)\s*\Z|(?P<string>\'{3}|"{3}|'|")""")
_STRING_ENDS = {quote: re.compile(rf"(?:\\.|[^\\])*?{quote}", re.DOTALL) for quote in ("'''", '"""', "'", '"')}


def translate(lines: list[str], variables: Container[str] = ()) -> list[str]:
    """Replace the commands among a cell's lines; the number of lines stays as it is.

    `variables` are names that have a value, and so are Python wherever they could be.
    """
    cell = _Cell(lines, variables)
    translated: list[str] = []
    at = 0
    while at < len(lines):
        columns = [0] if lines[at].lstrip().startswith(("%", "!")) else [0, *inner_places(lines[at])]
        found = next(filter(None, (_command(cell, at, each) for each in columns)), None)
        end = cell.statement_end(at) if found is None else cell.script_end(at, found.start())
        translated += lines[at:end] if found is None else _call(lines[at:end], found)
        at = end
    return translated


def _command(cell: _Cell, at: int, column: int) -> re.Match[str] | None:
    """What begins at this column of a line, if it is meant for the terminal."""
    found = _FIRST.match(cell.lines[at], column)
    if found is None:
        return None
    sign, word, rest = (found["sign"] or "").strip(), found["word"], found["rest"]
    if sign == "%" or sign == "!":
        is_command = word in OWN_MAGICS and (sign == "%" or shutil.which(word) is None)
    elif sign == "$" or "/" in word:  # no statement of Python begins with ./
        is_command = True
    elif _VARIABLE.match(word + rest):
        is_command = not _is_python(cell.statement(at, column))
    elif _PYTHON_NEXT.match(rest):
        is_command = False
    elif word in COMMANDS or word == ".":
        is_command = not cell.has(word) or not _is_python(cell.statement(at, column))
    elif not rest.strip():
        is_command = word in NEVER_PYTHON and not cell.has(word)
    else:
        known = word in UNSURE or difflib.get_close_matches(word, ("ros2", "colcon"), 1, 0.75)
        is_command = bool(known) and not _is_python(cell.statement(at, column))
    return found if is_command else None


def inner_places(line: str) -> Iterator[int]:
    """Where in a line another statement may begin: behind `;`, and behind the `:` of `if x:`."""
    depth = 0
    for kind, sign, place in _pieces(line, ""):
        depth += _DEEPER.get(sign, 0) if kind == "bracket" else 0
        if kind != "end" or depth != 0 or place > LONGEST:
            continue
        found = _FIRST.match(line, place)
        known = found is not None and (found["sign"] or found["word"] in UNSURE or found["word"] in (*COMMANDS, "."))
        head = line[:place].strip() + (" pass" if sign == ":" else "")
        # An `else` or an `except` has more before it.
        if known and any(_is_python(before + head) for before in ("", "if 1: pass\n", "try: pass\n")):
            yield place


def _is_python(statement: str) -> bool:
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            ast.parse(textwrap.dedent(statement).lstrip(" \t"))
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return False
    return True


def _call(lines: list[str], found: re.Match[str]) -> list[str]:
    """The Python that runs a command, as many lines long as the command."""
    sign = "!" if (found["sign"] or "").startswith("!") else ""
    script = "".join([sign, lines[0][found.start("word") :], *lines[1:]]).rstrip("\n")
    call = f"{lines[0][: found.end('indent')]}get_ipython().run_line_magic({MAGIC!r}, {script!r})"
    return [f"{call}\n", *["\n"] * (len(lines) - 1)]


class _Cell:
    """A cell's lines, and where their statements and commands end."""

    def __init__(self, lines: list[str], variables: Container[str]) -> None:
        self.lines = lines
        self._text = "".join(lines)
        self._begins = [0, *accumulate(map(len, lines))]
        self._variables = variables
        self._known: dict[str, bool] = {}
        self._ends: dict[int, int] = {}
        # The line at whose end a string is open that is never closed, by its quote.
        self._endless: dict[str, int] = {}

    def has(self, word: str) -> bool:
        """Whether a word is a variable, of the notebook or of this cell."""
        if word not in self._known:
            name = re.escape(word)
            self._known[word] = word in self._variables or bool(
                re.search(rf"(?m)(?:^|[\s,(*]){name}\s*(?:[,:][^=\n]*)?=(?!=)", self._text)
                or re.search(rf"\b(?:for|import|as|def|class|global)\s+{name}\b", self._text)
                or re.search(rf"\bdef\s+\w+\([^)]{{0,1000}}\b{name}\b", self._text)
            )
        return self._known[word]

    def script_end(self, at: int, column: int) -> int:
        """The line behind a command, which goes on while a quote is open or its line ends in a backslash."""
        try:
            end = command_end(self._text, self._begins[at] + column)
        except UnfinishedError:
            return at + 1
        return bisect_left(self._begins, end)

    def statement(self, at: int, column: int) -> str:
        """The Python statement that begins here."""
        return "".join([self.lines[at][column:], *self.lines[at + 1 : self.statement_end(at)]])

    def statement_end(self, at: int) -> int:
        """The line behind the Python statement that begins here: brackets and long strings hold it together.

        One with a bracket or a string that is never closed ends with its first line.
        """
        if self.lines[at].lstrip().startswith(("%", "!")):
            ends = range(at + 1, len(self.lines))
            return next((end for end in ends if not self.lines[end - 1].rstrip("\n").endswith("\\")), len(self.lines))
        if at not in self._ends:
            self._read_statement(at)
        return self._ends[at]

    def _read_statement(self, at: int) -> None:
        """Read to the end of a statement, or of the cell; note where those end that begin in the lines on the way."""
        begun: list[int] = []  # the line of each statement whose end is not known yet
        opened: list[int] = []  # the line of each bracket that is open
        string, since = "", at
        for line in range(at, len(self.lines)):
            begun += [] if string else [line]
            kind = text = ""
            for kind, text, _ in _pieces(self.lines[line], string):
                if kind == "bracket" and _DEEPER[text] > 0:
                    opened.append(line)
                elif kind == "bracket" and opened:
                    opened.pop()
            before, string = string, text if kind == "open string" else ""
            since = since if string == before else line
            # A statement ends here if all brackets that are still open were opened before it.
            while begun and not (opened and opened[-1] >= begun[-1]) and kind not in ("open string", "backslash"):
                self._ends[begun.pop()] = line + 1
            if not begun or line >= self._endless.get(string, len(self.lines)):
                break
        if string:
            self._endless[string] = min(since, self._endless.get(string, since))
        for line in begun:
            closed = not string and not (opened and opened[-1] >= line)
            self._ends[line] = len(self.lines) if closed else line + 1


def _pieces(line: str, string: str) -> Iterator[tuple[str, str, int]]:
    """What holds a line's statement together or ends it: kind, text, and the place behind it; `string` is open already."""
    at = 0
    while True:
        if string:
            closed = _STRING_ENDS[string].match(line, at)
            if closed is None:
                if len(string) == 3 or line.rstrip("\n").endswith("\\"):
                    yield "open string", string, len(line)
                return
            at = closed.end()
        found = _PIECE.search(line, at)
        if found is None or found[0] == "#":
            return
        at, string = found.end(), found["string"] or ""
        if not string and found.lastgroup:
            yield found.lastgroup, found[found.lastgroup], at
