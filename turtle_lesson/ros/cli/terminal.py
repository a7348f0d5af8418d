"""The terminal's own words, beside ros2, colcon and source: those for texts (cat, echo, grep, …) and for jobs."""

from __future__ import annotations

import re
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..runtime.run_world import run_for
from .jobs import SIGNALS, Job, jobs, send
from .terminal_files import cd, chmod, cp, ls, mkdir, mv, pwd, rm, touch
from .terminal_io import Builtin, Terminal, export, options, printenv, unset

if TYPE_CHECKING:
    from ..sim.process import Process


# -- texts, and what a pipe leads to ---------------------------------------------------------------------------------


def _texts(terminal: Terminal, names: Iterable[str]) -> list[str]:
    """The files of these names, or else what a pipe gives."""
    found = [Path(name).read_text(encoding="utf-8", errors="replace") for name in names]
    return found or [terminal.given or ""]


def _lines(terminal: Terminal, names: Iterable[str]) -> list[str]:
    return [line for text in _texts(terminal, names) for line in text.splitlines()]


def cat(terminal: Terminal, words: list[str]) -> int:
    """`cat file…`: print files."""
    if not words and terminal.given is None:
        return terminal.fail("cat: name the files to print")
    terminal.stdout.write("".join(_texts(terminal, words)))
    return 0


def echo(terminal: Terminal, words: list[str]) -> int:
    """`echo [-n] [-e] words`: print words; -n without a line end, -e with `\\n` and its kin as what they stand for."""
    signs = ""
    while words and re.fullmatch("-[neE]+", words[0]):
        signs, words = signs + words[0], words[1:]
    text = " ".join(words)
    terminal.stdout.write((_unescaped(text) if "e" in signs else text) + ("" if "n" in signs else "\n"))
    return 0


def printf(terminal: Terminal, words: list[str]) -> int:
    """`printf FORMAT words`: print a text in which `\\n` is a line end and %s a word; further words use it once more."""
    if not words:
        return terminal.fail("printf: usage: printf format [arguments]", 2)
    shape, rest = _unescaped(words[0]), iter(words[1:])
    places = len(re.findall("%[sdi]", shape.replace("%%", "")))
    left = max(1, -(-len(words[1:]) // places)) if places else 1
    for _ in range(left):
        filled = re.sub("%([sdi%])", lambda found: "%" if found[1] == "%" else next(rest, ""), shape)
        terminal.stdout.write(filled)
    return 0


def _unescaped(text: str) -> str:
    return re.sub(r"\\([ntr\\])", lambda found: {"n": "\n", "t": "\t", "r": "\r"}.get(found[1], found[1]), text)


def grep(terminal: Terminal, words: list[str]) -> int:
    """`… | grep [-i] [-v] [-c] pattern`: the lines with a pattern in them."""
    letters, rest = options(words)
    if unknown := sorted(set(letters) - set("civqE")):
        return terminal.fail(
            f"grep: this terminal's knows -i, -v, -c, -q and -E, but no -{unknown[0]}: leave it out", 2
        )
    if not rest:
        return terminal.fail("grep: name the pattern to look for", 2)
    pattern = re.compile(rest[0] if "E" in letters else re.escape(rest[0]), re.IGNORECASE if "i" in letters else 0)
    lines = _lines(terminal, rest[1:])
    found = [line for line in lines if bool(pattern.search(line)) != ("v" in letters)]
    if "c" in letters:
        terminal.say(len(found))
    elif "q" not in letters:
        terminal.say(*found)
    return 0 if found else 1


def head(terminal: Terminal, words: list[str]) -> int:
    """`… | head [-n number]`: the first lines."""
    count, rest = _count(words)
    return terminal.say(*_lines(terminal, rest)[:count])


def tail(terminal: Terminal, words: list[str]) -> int:
    """`… | tail [-n number]`: the last lines."""
    count, rest = _count(words)
    lines = _lines(terminal, rest)
    return terminal.say(*lines[max(0, len(lines) - count) :])


def _count(words: list[str]) -> tuple[int, list[str]]:
    """The number behind `-n` or `-`, and the other words."""
    count, rest = 10, []
    waiting = iter(words)
    for word in waiting:
        found = re.fullmatch(r"-n?(\d+)", word)
        if word == "-n" or found:
            count = int(found[1] if found else next(waiting, 0))
        else:
            rest.append(word)
    return count, rest


def sort(terminal: Terminal, words: list[str]) -> int:
    """`… | sort [-r] [-u]`: the lines in order."""
    letters, rest = options(words)
    lines = _lines(terminal, rest)
    return terminal.say(*sorted(set(lines) if "u" in letters else lines, reverse="r" in letters))


def wc(terminal: Terminal, words: list[str]) -> int:
    """`… | wc -l`: how many lines."""
    _, rest = options(words)
    return terminal.say(sum(text.count("\n") for text in _texts(terminal, rest)))


# -- jobs, kill, sleep -----------------------------------------------------------------------------------------------


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


_NAMED: tuple[Any, ...] = (
    cat, cd, chmod, cp, echo, export, grep, head, kill, ls, mkdir, mv, printenv, printf, pwd, rm, sleep, sort, tail, touch,
    unset, wc,
)  # fmt: skip
BUILTINS: dict[str, Builtin] = {"jobs": list_jobs, **{each.__name__: each for each in _NAMED}}
