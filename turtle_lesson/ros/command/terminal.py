"""The terminal's own words, beside ros2, colcon and source."""

from __future__ import annotations

from .terminal_changes import cp, mv, rm
from .terminal_files import cd, chmod, ls, mkdir, pwd, touch
from .terminal_io import Builtin
from .terminal_jobs import kill, list_jobs, sleep
from .terminal_text import cat, echo, grep, head, printf, sort, tail, wc
from .terminal_variables import export, printenv, unset

BUILTINS: dict[str, Builtin] = {
    "cat": cat,
    "cd": cd,
    "chmod": chmod,
    "cp": cp,
    "echo": echo,
    "export": export,
    "grep": grep,
    "head": head,
    "jobs": list_jobs,
    "kill": kill,
    "ls": ls,
    "mkdir": mkdir,
    "mv": mv,
    "printenv": printenv,
    "printf": printf,
    "pwd": pwd,
    "rm": rm,
    "sleep": sleep,
    "sort": sort,
    "tail": tail,
    "touch": touch,
    "unset": unset,
    "wc": wc,
}
