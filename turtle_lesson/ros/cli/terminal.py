"""The terminal's own words, beside ros2, colcon and source; those for what goes on: jobs, kill, sleep."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from ..runtime.run_world import run_for
from .jobs import SIGNALS, Job, jobs, send
from .terminal_files import cd, chmod, cp, ls, mkdir, mv, pwd, rm, touch
from .terminal_io import Builtin, Terminal, export, printenv, unset
from .terminal_text import cat, echo, grep, head, printf, sort, tail, wc

if TYPE_CHECKING:
    from ..sim.process import Process


# -- terminal jobs ------------------------------------------------------------------------------------------------
# The terminal's words for what goes on: jobs, kill, sleep.


def list_jobs(terminal: Terminal, words: list[str]) -> int:
    """`jobs`: what goes on."""
    for job in jobs(terminal.world).running:
        terminal.say(f"[{job.number}]  Running                 {job.words} &")
    return 0


def sleep(terminal: Terminal, words: list[str]) -> int:
    """`sleep SECONDS`: let robot time pass, in which the programs go on."""
    if len(words) != 1 or not re.fullmatch(r"\d{1,6}(\.\d{1,9})?s?", words[0]):
        return terminal.fail("sleep: how long? Write it in seconds of robot time, as in sleep 0.5")
    run_for(terminal.world, float(words[0].rstrip("s")))
    return 0


def kill(terminal: Terminal, words: list[str]) -> int:
    """`kill [-INT] %1`, `kill [-INT] 1004`: end a job or a process."""
    name = "TERM"
    rest = list(words)
    while rest and rest[0].startswith("-"):
        name = rest.pop(0).lstrip("-").removeprefix("SIG")
        if name == "s" and rest:
            name = rest.pop(0).removeprefix("SIG")
        name = next((sign for sign, number in SIGNALS.items() if name == str(number)), name)
    if name not in SIGNALS:
        return terminal.fail(f"kill: {name}: invalid signal specification; there are {', '.join(SIGNALS)}")
    if not rest:
        return terminal.fail("kill: which one? `jobs` lists what is running; kill -INT %1 is Ctrl-C for the first")
    return max(_kill_one(terminal, word, name) for word in rest)


def _kill_one(terminal: Terminal, word: str, name: str) -> int:
    target: Job | Process | None = None
    if re.fullmatch(r"%\d{1,9}", word):
        target = jobs(terminal.world).get(int(word[1:]))
    elif re.fullmatch(r"\d{1,9}", word):
        target = next((each for each in terminal.world.processes if each.alive and each.pid == int(word)), None)
    else:
        return terminal.fail(f"kill: {word[:60]}: arguments must be process or job IDs, such as 1004 or %1")
    if target is None:
        what = "no such job" if word.startswith("%") else "No such process"
        return terminal.fail(f"kill: {word}: {what}. `jobs` lists what is running")
    if isinstance(target, Job):
        target.signal(name)
    else:
        send(target, name)
    terminal.world.sim.settle()
    return 0


# -- terminal -----------------------------------------------------------------------------------------------------
# The terminal's own words, beside ros2, colcon and source.

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
