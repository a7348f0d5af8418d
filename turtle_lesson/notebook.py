"""What is special in Jupyter: tracebacks that end at the learner's own line, and commands as in a terminal."""

from __future__ import annotations

from types import TracebackType
from typing import Any

from .ros.core import tracebacks
from .sourced import real_ros


def prepare(shell: Any) -> None:
    """Have errors in cells shown without the frames of the simulated ROS 2, and `ros2 …` understood in cells.

    Where a real ROS 2 is sourced, its own commands are to be used: `!ros2 …`.
    """
    shell.register_magic_function(solution, "cell")
    shell.set_custom_exc((Exception, KeyboardInterrupt), _show)
    if not real_ros():
        from .ros.command import magics

        magics.install(shell)


def solution(line: str, cell: str) -> None:
    """`%%solution NAME`: does nothing. To run a folded solution, delete this first line of its cell."""


def _show(
    shell: Any, kind: type[BaseException], error: BaseException, trace: TracebackType, tb_offset: Any = None
) -> None:
    from .ros.command.shell import CommandInterrupted

    if tracebacks.before_showing is not None:
        tracebacks.before_showing(error)
    error.__traceback__ = tracebacks.shorten(trace)
    if isinstance(error, CommandInterrupted):  # one line: for what never ends this is the usual way to end it
        shell._showtraceback(kind, error, [f"KeyboardInterrupt: {error}"])
        return
    shell.showtraceback((kind, error, error.__traceback__), tb_offset=0)
