"""The kernel of `turtle-lesson open`: Jupyter's own, which also says which cell to run first after a restart.

It imports nothing of the lesson before there is a command to understand, and `%load_ext turtle_lesson` replaces what it does.
"""

from __future__ import annotations

import re
import sys
from types import TracebackType
from typing import Any

from ipykernel.kernelapp import IPKernelApp
from IPython.core.error import UsageError

HINT = (
    "Run the set-up cell first: it is the first code cell of the page, and begins with %load_ext turtle_lesson. "
    "A kernel that was just started knows nothing of what cells did before."
)
SET_UP = re.compile(r"(?m)^[ \t]*%load_ext[ \t]+turtle_lesson\b")
COMMAND = re.compile(r"(?m)^[ \t]*%?(?:ros2|colcon|source)\b")
"""Begins a line that is surely meant for the lesson's terminal."""

NAMES = ("lesson", "start", "rclpy")
"""What a set-up cell makes known."""


class LessonKernelApp(IPKernelApp):
    """Starts the kernel that Jupyter starts, and watches its cells."""

    def init_extensions(self) -> None:
        """Load extensions, and then watch."""
        super().init_extensions()
        watch(self.shell)


def watch(shell: Any) -> None:
    """Have a shell answer commands and names of the lesson with a hint, until the extension is loaded."""

    def transform(lines: list[str]) -> list[str]:
        cell = "".join(lines)
        if "turtle_lesson" in shell.extension_manager.loaded or not (SET_UP.search(cell) or COMMAND.search(cell)):
            return lines
        from turtle_lesson.ros.command.cells import translate

        return translate(lines, shell.user_ns)  # behind %load_ext in the same cell the commands work

    transform.is_turtle_lesson = True  # type: ignore[attr-defined]  # the extension puts its own in place of this one
    shell.input_transformer_manager.line_transforms.append(transform)
    shell.register_magic_function(terminal, "line_cell")
    shell.set_custom_exc((NameError, ModuleNotFoundError), explain)


def terminal(line: str, cell: str = "") -> None:
    """Stand for the lesson's terminal, which is not there yet."""
    raise UsageError(HINT)


def explain(
    shell: Any,
    kind: type[BaseException],
    error: NameError | ModuleNotFoundError,
    trace: TracebackType,
    tb_offset: int | None = None,
) -> None:
    """Show an error as ever, with the hint below it if it is about something of the lesson."""
    if error.name in NAMES:
        error.add_note(HINT)
    shell.showtraceback((kind, error, trace), tb_offset=tb_offset)


if __name__ == "__main__":
    del sys.path[0]  # this file's folder
    LessonKernelApp.launch_instance()
