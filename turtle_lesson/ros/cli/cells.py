"""Commands among Python: which lines of a notebook's cell are meant for the terminal.

A statement that begins with `ros2`, `colcon`, `source`, `mkdir`, `cd` or their kin and is no Python is replaced by a call that
runs it, so that commands may stand on any line: between Python statements, indented in an `if` or a loop, several in one cell.
What could be Python (`ros2 -h` is a subtraction) counts as Python if the name is a variable. Words that
are less plainly a command (`echo`, `git`, `python3`) are taken for one only where Python could make nothing of the statement.
"""

from __future__ import annotations

import codeop
import difflib
import re
import shutil
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
    "type commands into the cell, as in a terminal; files of commands are not run here": "bash sh",
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
    "sort", "ssh", "tail", "tar", "tee", "top", "tree", "unzip", "wget", "which", "whoami",
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
    "chmod", "cp", "echo", "export", "grep", "head", "mv", "printenv", "rm", "sleep", "unset", "wc",
}  # fmt: skip
"""Words that are a command where the statement is no Python."""

OWN_MAGICS = ("ros2", "colcon", "source")
"""Those that may also be written with a `%`, everywhere; `%cd`, `%ls` and others are IPython's own."""

MAGIC = "terminal"

_FIRST = re.compile(
    r"(?P<indent>[ \t]*)(?P<sign>%|!\s*|\$\s+)?(?P<word>[A-Za-z][\w-]*|\.(?=[ \t])|\.{1,2}/[\w./-]+)"
    r"(?![\w(\[.,?:\])}])(?P<rest>.*)",
    re.DOTALL,
)
_PYTHON_NEXT = re.compile(r"\s*(?:[-+*/%&|^@]|//|\*\*|<<|>>|[=!<>]|:)?=|\s+(?:in|is|if|and|or|not|for)\b\s")
_VARIABLE = re.compile(r"[A-Za-z_]\w*=\S*[ \t]+(?:\S+[ \t]+)*?(?:ros2|colcon|python3)[ \t]")
_DEEPER = {"(": 1, "[": 1, "{": 1, ")": -1, "]": -1, "}": -1}
_PIECE = re.compile(r"""#|(?P<bracket>[()\[\]{}])|(?P<backslash>\\)\s*\Z|(?P<string>\'{3}|"{3}|'|")""")
_STRING_ENDS = {quote: re.compile(rf"(?:\\.|[^\\])*?{quote}", re.DOTALL) for quote in ("'''", '"""', "'", '"')}


def translate(lines: list[str], variables: Container[str] = ()) -> list[str]:
    """Replace the commands among a cell's lines; the number of lines stays as it is.

    `variables` are names that have a value, and so are Python wherever they could be.
    """
    cell = _Cell(lines, variables)
    translated: list[str] = []
    at = 0
    while at < len(lines):
        found = _command(cell, at)
        end = cell.statement_end(at) if found is None else cell.script_end(at)
        translated += lines[at:end] if found is None else _call(lines[at:end], found)
        at = end
    return translated


def _command(cell: _Cell, at: int) -> re.Match[str] | None:
    """What a line begins with, if it is meant for the terminal."""
    found = _FIRST.match(cell.lines[at])
    if found is None:
        return None
    sign, word, rest = (found["sign"] or "").strip(), found["word"], found["rest"]
    if sign == "%" or sign == "!":
        is_command = word in OWN_MAGICS and (sign == "%" or shutil.which(word) is None)
    elif sign == "$" or "/" in word:  # no statement of Python begins with ./
        is_command = True
    elif _VARIABLE.match(word + rest):
        is_command = not _is_python(word + rest)
    elif _PYTHON_NEXT.match(rest):
        is_command = False
    elif word in COMMANDS or word == ".":
        is_command = not cell.has(word) or not _is_python(word + rest)
    elif not rest.strip():
        is_command = word in NEVER_PYTHON and not cell.has(word)
    else:
        known = word in UNSURE or difflib.get_close_matches(word, ("ros2", "colcon"), 1, 0.75)
        is_command = bool(known) and not _is_python(word + rest)
    return found if is_command else None


def _is_python(line: str) -> bool:
    """Whether a line is a statement of Python, or begins one."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            codeop.compile_command(line.rstrip("\\ \t\r\n"))
    except (SyntaxError, ValueError, OverflowError, RecursionError, MemoryError):
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

    def script_end(self, at: int) -> int:
        """The line behind a command, which goes on while a quote is open or its line ends in a backslash."""
        try:
            end = command_end(self._text, self._begins[at])
        except UnfinishedError:
            return at + 1
        return bisect_left(self._begins, end)

    def statement_end(self, at: int) -> int:
        """The line behind the Python statement that begins here: brackets, long strings and backslashes hold it together."""
        if self.lines[at].lstrip().startswith(("%", "!")):
            ends = range(at + 1, len(self.lines))
            return next((end for end in ends if not self.lines[end - 1].rstrip("\n").endswith("\\")), len(self.lines))
        depth, string = 0, ""
        for line in range(at, len(self.lines)):
            pieces = [("", ""), *_pieces(self.lines[line], string)]
            for _, text in pieces:
                depth = max(0, depth + _DEEPER.get(text, 0))
            kind, text = pieces[-1]
            string = text if kind == "open string" else ""
            if not depth and kind not in ("open string", "backslash"):
                return line + 1
        return len(self.lines)


def _pieces(line: str, string: str) -> Iterator[tuple[str, str]]:
    """What holds a line's statement together, as kind and text; `string` is open already."""
    at = 0
    while True:
        if string:
            closed = _STRING_ENDS[string].match(line, at)
            if closed is None:
                if len(string) == 3 or line.rstrip("\n").endswith("\\"):
                    yield "open string", string
                return
            at = closed.end()
        found = _PIECE.search(line, at)
        if found is None or found[0] == "#":
            return
        at, string = found.end(), found["string"] or ""
        if not string and found.lastgroup:
            yield found.lastgroup, found[found.lastgroup]
