"""The `ros2` command line: each command runs as a simulated process, and answers as the real tool does.

code = run(world, ["ros2", "topic", "list"])        # prints into the cell; returns the exit code
"""

from __future__ import annotations

import contextlib
import sys
from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..runtime.run_world import Waiter
from .jobs import Errors, cell_streams, lasting
from .parser import Call, Invocation, Stop, cut, parse

if TYPE_CHECKING:
    from ..runtime.world import World
    from ..sim.process import Output, Process

INTERRUPTED = 2
"""The exit code of a `ros2` command that was ended by Ctrl-C."""


def run(
    world: World,
    words: Sequence[str],
    *,
    stdin: str | None = None,
    stdout: Output | None = None,
    stderr: Output | None = None,
    cwd: Path | None = None,
    background: bool = False,
) -> int:
    """Run one command, such as `["ros2", "topic", "list"]`, and return its exit code.

    Args:
        world: where it runs.
        words: the program's name and its arguments.
        stdin: what a program of `ros2 run` reads as its input; the keyboard if not given.
        stdout, stderr: where it prints to; the running cell if not given.
        cwd: the folder that it works in; the current one if not given.
        background: whether to return at once and let it go on while the world runs (`&`).

    Raises:
        KeyboardInterrupt: if the user stops it.
    """
    out_to: Any = sys.stdout if stdout is None else stdout
    error_to: Any = Errors(cell_streams()[1] if stderr is None else stderr)
    folder = contextlib.chdir(cwd) if cwd is not None else contextlib.nullcontext()
    with folder:
        try:
            call = parse(words[1:])
        except Stop as stop:
            print(stop.text, file=error_to if stop.code else out_to)
            return stop.code
        if getattr(call.verb, "in_cell", False):
            call.arguments.stdin = stdin
            return _run_in_cell(call, out_to, error_to)
        if background:
            return _start_in_background(world, call, words, out_to, error_to)
        shown = stdout is None or stdout is sys.stdout
        return _run_as_process(world, call, words, out_to, error_to, shown)


def run_here(words: Sequence[str]) -> int:
    """Run one command as part of the running process, as a launch file does; what has no end goes on until Ctrl-C."""
    from ..runtime.world import current_process

    try:
        call = parse(words[1:])
    except Stop as stop:
        print(stop.text, file=sys.stderr if stop.code else sys.stdout)
        return stop.code
    current_process().state(Invocation).background = True
    try:
        return _guarded(call)
    except KeyboardInterrupt:
        return INTERRUPTED


def _run_in_cell(call: Call, stdout: Any, stderr: Any) -> int:
    with contextlib.redirect_stdout(stdout), contextlib.redirect_stderr(stderr):
        return _guarded(call)


def _guarded(call: Call) -> int:
    """Run a verb; whatever goes wrong in it becomes one line and an exit code."""
    try:
        return call.verb.main(call.arguments) or 0
    except Exception as error:
        print(f"{call.prog}: {type(error).__name__}: {cut(str(error))}", file=sys.stderr)
        return 1


def _main(call: Call) -> None:
    """The main program of the process that a verb runs as."""
    try:
        code = _guarded(call)
    except KeyboardInterrupt:
        code = INTERRUPTED
    sys.exit(code)


def _run_as_process(world: World, call: Call, words: Sequence[str], stdout: Any, stderr: Any, shown: bool) -> int:
    waiter = Waiter(world, call.prog)
    process = world.spawn(
        partial(_main, call), name="ros2", argv=words, stdout=stdout, stderr=stderr, on_exit=waiter.ended
    )  # fmt: skip
    process.state(Invocation).shown = shown
    reason = waiter.wait(process)
    if reason:
        print(f"{call.prog}: {reason}", file=stderr)
    return process.exit_code or 0


def _start_in_background(world: World, call: Call, words: Sequence[str], stdout: Any, stderr: Any) -> int:
    from .jobs import Job, jobs

    out, error = lasting(stdout, world.sim), lasting(stderr, world.sim)
    process: Process = world.spawn(partial(_main, call), name="ros2", argv=words, stdout=out, stderr=error)
    process.state(Invocation).background = True
    job = jobs(world).add(Job(" ".join(words), process))
    print(f"[{job.number}] {process.pid}")
    world.sim.settle()
    return 0
