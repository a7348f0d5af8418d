"""What is special in Jupyter: tracebacks that end at the learner's own line, and commands as in a terminal.

Where a real ROS 2 is sourced, its own commands are to be used: `!ros2 …`. So nothing of the simulated ones is imported then.
"""

from __future__ import annotations

import _imp
import os
from contextlib import suppress
from pathlib import Path
from types import TracebackType
from typing import Any

from IPython.core.magic import no_var_expand

from .ros.sim import errors
from .session.robot import real_ros


def prepare(shell: Any) -> None:
    """Have errors in cells shown without the frames of the simulated ROS 2, and `ros2 …` understood in cells."""
    if folder := os.environ.get("TURTLE_LESSON_FOLDER"):  # tests give each page a fresh folder
        os.chdir(folder)
    shell.register_magic_function(solution, "cell")
    _guard_the_workspace(shell)
    shell.events.register("post_run_cell", give_import_lock_back)
    shell.set_custom_exc((Exception, KeyboardInterrupt), _show)
    if not real_ros():
        _understand_commands(shell)


def give_import_lock_back(*_: object) -> None:
    """After a cell: an interrupt just when Python has taken its lock of imports leaves that taken, and Jupyter mute."""
    with suppress(RuntimeError):  # it is another thread's
        while _imp.lock_held():
            _imp.release_lock()


def solution(line: str, cell: str) -> None:
    """`%%solution NAME`: does nothing. To run a folded solution, delete this first line of its cell."""


def _guard_the_workspace(shell: Any) -> None:
    """Have `%%writefile` ask before it replaces what a learner wrote in the package. Elsewhere it is IPython's own."""
    original = shell.find_cell_magic("writefile")
    if getattr(original, "is_turtle_lesson", False):
        return

    def writefile(line: str, cell: str) -> None:
        from .learner.workspace import workspace

        words = line.split()
        file = Path(words[-1].strip("'\"")).expanduser().absolute() if words else Path()
        mine = workspace()
        if words[:-1] in ([], ["-a"], ["--append"]) and file.is_relative_to(mine.package):
            print(mine.write(file, cell, append=len(words) == 2))
        else:
            original(line, cell)

    writefile.is_turtle_lesson = True  # type: ignore[attr-defined]
    writefile.__doc__ = original.__doc__
    shell.register_magic_function(writefile, "cell")


def _show(
    shell: Any, kind: type[BaseException], error: BaseException, trace: TracebackType, tb_offset: Any = None
) -> None:
    from .ros.cli.shell import CommandInterrupted

    if errors.before_showing is not None:
        errors.before_showing(error)
    error.__traceback__ = errors.shorten(trace)
    if isinstance(error, CommandInterrupted):  # one line: for what never ends this is the usual way to end it
        shell._showtraceback(kind, error, [f"KeyboardInterrupt: {error}"])
        return
    shell.showtraceback((kind, error, error.__traceback__), tb_offset=0)


def _understand_commands(shell: Any) -> None:
    """Make an IPython shell understand commands; doing it twice changes nothing."""
    from .ros.cli import cells, completion
    from .ros.runtime import files

    @no_var_expand
    def terminal(line: str, cell: str | None = None) -> None:
        """Run commands as in a terminal: `%terminal ros2 topic list && ros2 node list`, or a whole cell of them.

        Nothing in its lines is expanded: `{…}` and `$…` are YAML, and not Python.
        """
        from .ros.cli.shell import run_line, shell_of
        from .ros.runtime.world import current_world

        try:
            run_line(current_world(), line if cell is None else f"{line}\n{cell}")
        finally:
            shell.user_ns["_exit_code"] = shell_of(current_world()).exit_code

    files.begin_notebook()
    shell.register_magic_function(terminal, "line_cell", cells.MAGIC)
    transformers = shell.input_transformer_manager.line_transforms  # before IPython takes the cell for Python
    transformers[:] = [each for each in transformers if not getattr(each, "is_turtle_lesson", False)]

    def transform(lines: list[str]) -> list[str]:
        return cells.translate(lines, shell.user_ns)

    transform.is_turtle_lesson = True  # type: ignore[attr-defined]
    transformers.append(transform)
    completion.install(shell)
