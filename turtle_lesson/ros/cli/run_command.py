"""The `ros2` command line: each command runs as a simulated process, and answers as the real tool does.

code = run(world, ["ros2", "topic", "list"])        # prints into the cell; returns the exit code

What commands in launch files need of the terminal (`turtle_lesson/ros/launching/commands.py`) is here, too.
"""

from __future__ import annotations

import contextlib
import sys
from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..launching.commands import ForeignCommand, UnknownCommand
from ..runtime.run_world import Waiter
from ..runtime.world import current_process
from .arguments import Stop
from .jobs import Errors, Job, cell_streams, jobs, lasting
from .parser import Call, parse
from .script import ShellSyntaxError, UnfinishedError, expand, pipelines, tokens
from .verb import INTERRUPTED, Invocation

if TYPE_CHECKING:
    from ..runtime.world import World
    from ..sim.process import Output


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
            return stop.print(out_to, error_to)
        if call.verb.in_cell:
            call.arguments.stdin = stdin
            with contextlib.redirect_stdout(out_to), contextlib.redirect_stderr(error_to):
                return call.verb.main(call.arguments)
        if background:
            out, error = lasting(out_to, world.sim), lasting(error_to, world.sim)
            process = world.spawn(partial(_main, call), name="ros2", argv=words, stdout=out, stderr=error)
            process.state(Invocation).background = True
            job = jobs(world).add(Job(" ".join(words), process))
            print(f"[{job.number}] {process.pid}")
            world.sim.settle()
            return 0
        waiter = Waiter(world, call.verb.prog)
        process = world.spawn(
            partial(_main, call), name="ros2", argv=words, stdout=out_to, stderr=error_to, on_exit=waiter.ended
        )  # fmt: skip
        process.state(Invocation).shown = out_to is sys.stdout
        reason = waiter.wait(process)
        if reason:
            print(f"{call.verb.prog}: {reason}", file=error_to)
        return process.exit_code or 0


def _main(call: Call) -> None:
    """The main program of the process that a verb runs as."""
    try:
        code = call.verb.main(call.arguments)
    except KeyboardInterrupt:
        code = INTERRUPTED
    sys.exit(code)


# -- commands in launch files --------------------------------------------------------------------------------------------


def run_here(words: Sequence[str]) -> int:
    """Run one command as part of the running process, as a launch file does; what has no end goes on until Ctrl-C."""
    try:
        call = parse(words[1:])
    except Stop as stop:
        return stop.print(sys.stdout, sys.stderr)
    current_process().state(Invocation).background = True
    try:
        return call.verb.main(call.arguments)
    except KeyboardInterrupt:
        return INTERRUPTED


def commands_of_text(text: str) -> list[tuple[str, list[str]]]:
    """The commands of a shell's text, each with the sign before it.

    Raises:
        UnknownCommand: if there is none, or one that uses more of a shell than `&&`, `||` and `;`.
    """
    try:
        plan = list(pipelines(list(tokens(text))))
    except (UnfinishedError, ShellSyntaxError) as mistake:
        raise UnknownCommand(f"syntax error in the command {text!r}: {mistake}") from None
    found = []
    for sign, pipeline in plan:
        command = pipeline[0]
        if len(pipeline) > 1 or command.stdout or command.stderr or command.given or command.background:
            raise ForeignCommand(
                f"the command {text!r}",
                "it uses '|', '>' or '&', which launched commands cannot use here",
                "Only one command, or several with '&&' or ';' between them, can be run.",
            )
        found.append((sign, [part for word in command.words for part in expand(word, home=Path.home(), exit_code=0)]))
    if not found:
        raise UnknownCommand("there is no command in cmd=[…]")
    return found


def run_arguments(words: list[str]) -> Any:
    """The arguments of `ros2 run …`. UnknownCommand if it would complain about them."""
    try:
        return parse(words).arguments
    except Stop as stop:
        raise UnknownCommand(stop.text) from None
