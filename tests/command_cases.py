"""Commands and what the real tools print for them, from `tests/data/command/`, compared with what ours print.

The files hold cases as they were recorded on a real ROS 2 Humble: `$ command`, then what went to stdout and stderr, and the
exit code. Times and numbers that depend on the machine are compared by their shape alone. A line of stderr that begins
with `+ ` is our own addition; where a case was shortened or ours answers otherwise on purpose, a `#` line says why.
"""

from __future__ import annotations

import io
import re
import shlex
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

from turtle_lesson.ros.cli.run_command import run
from turtle_lesson.ros.runtime.world import World

FOLDER = Path(__file__).with_name("data") / "command"


@dataclass
class Case:
    """A command and what it is expected to answer."""

    command: str
    stdout: list[str] = field(default_factory=list)
    stderr: list[str] = field(default_factory=list)
    code: int = 0


@dataclass
class Answer:
    """What a command answered, and how much robot time (s) it took."""

    stdout: str
    stderr: str
    code: int
    seconds: float


def cases(name: str) -> Iterator[Case]:
    """The cases of a file."""
    case, stream = Case(""), list[str]()
    for line in (FOLDER / name).read_text(encoding="utf-8").splitlines():
        if line.startswith("$ "):
            case = Case(line[2:])
        elif line.startswith("--- exit "):
            case.code = int(line.split()[2])
            yield case
            case = Case("")
        elif line == "--- stdout":
            stream = case.stdout
        elif line == "--- stderr":
            stream = case.stderr
        elif case.command and not line.startswith("# "):
            stream.append(line.removeprefix("+ ") if stream is case.stderr else line)


def type_in(world: World, command: str) -> Answer:
    """Carry a command out in a world."""
    out, error, begun = io.StringIO(), io.StringIO(), world.now
    code = run(world, shlex.split(command), stdout=out, stderr=error)
    return Answer(out.getvalue(), error.getvalue(), code, (world.now - begun) / 1e9)


def check(world: World, name: str, *, figures: bool = True) -> None:
    """Carry out all cases of a file, one after the other, and compare. Without `figures` any number is like any other."""
    for case in cases(name):
        answer = type_in(world, case.command)
        assert shape(answer.stderr.splitlines(), figures) == shape(case.stderr, figures), case.command
        assert shape(answer.stdout.splitlines(), figures) == shape(case.stdout, figures), case.command
        assert answer.code == case.code, case.command


def shape(lines: list[str], figures: bool) -> list[str]:
    """Lines without what depends on the machine; without figures also without what is repeated."""
    found = [_without_times(line) for line in lines]
    if figures:
        return found
    return list(dict.fromkeys(re.sub(r"\d+(\.\d+)?", "#", line) for line in found))


def _without_times(line: str) -> str:
    line = re.sub(r"\[\d{10}\.\d{9}\]", "[TIME]", line)
    line = re.sub(r"^( *(?:sec|nanosec): )\d+$", r"\1#", line)
    line = re.sub(r"(GID: )[0-9a-f.]+", r"\1#", line)
    line = re.sub(r"(_ros2cli)_\d+", r"\1_#", line)
    # since Python 3.13.1, argparse leaves out the value behind an option that it does not know
    line = re.sub(r"(error: unrecognized arguments: \S+).*", r"\1", line)
    return re.sub(r"(time_taken=)[-0-9.e]+", r"\1#", line)
