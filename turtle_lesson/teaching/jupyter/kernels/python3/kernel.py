"""The kernel of `turtle-lesson open`: Jupyter's own, which also says which cell to run first after a restart.

It imports nothing of the lesson before the set-up cell does, and `%load_ext turtle_lesson` replaces what it does.
"""

from __future__ import annotations

import os
import re
import sys
from types import TracebackType
from typing import Any

from ipykernel.kernelapp import IPKernelApp
from IPython.core.error import UsageError

HINT = (
    "Run the set-up cell first: it is the page's first code cell, with %load_ext turtle_lesson, and no commands.\n"
    "A kernel that has just started knows nothing about cells that ran before."
)
COMMAND = re.compile(r"[ \t]*(?:ros2|colcon|source|cd|mkdir|ls|cat|touch)[ \t]+[\w~./$\"'-]")
"""A line that is not Python, and surely meant for the lesson's terminal."""

NAMES = ("lesson", "start", "rclpy", "ros2", "colcon")
"""What a set-up cell makes known."""


class LessonKernelApp(IPKernelApp):
    """Starts the kernel that Jupyter starts, and watches its cells."""

    def init_extensions(self) -> None:
        """Load extensions, and then watch."""
        super().init_extensions()
        watch(self.shell)


def watch(shell: Any) -> None:
    """Have a shell answer commands and names of the lesson with a hint, until the extension is loaded."""
    for word in ("ros2", "colcon", "source"):
        shell.register_magic_function(not_yet, magic_name=word)
    shell.set_custom_exc((NameError, ModuleNotFoundError, SyntaxError), explain)


def not_yet(line: str) -> None:
    """Stand for a command of the lesson's terminal, which is not there yet."""
    raise UsageError(HINT)


def explain(
    shell: Any,
    kind: type[BaseException],
    error: NameError | ModuleNotFoundError | SyntaxError,
    trace: TracebackType,
    tb_offset: int | None = None,
) -> None:
    """Show an error as usual, with the hint if it is about something of the lesson."""
    if isinstance(error, SyntaxError):
        if COMMAND.match(error.text or ""):
            shell._showtraceback(kind, error, [HINT])
            return
    elif error.name in NAMES:
        error.add_note(HINT)
    shell.showtraceback((kind, error, trace), tb_offset=tb_offset)


if __name__ == "__main__":
    if sys.path[0] == os.path.dirname(os.path.realpath(__file__)):
        del sys.path[0]  # Jupyter puts the notebook's own folder there
    LessonKernelApp.launch_instance()
