"""The notebook is a process of its world, too, but one that no program runs in: its cells drive the simulation."""

from __future__ import annotations

from turtle_lesson.ros.core import Process


def is_notebook(process: Process) -> bool:
    """Whether this process is its world's notebook, whatever a program may be called."""
    return process is process.locals["world"].notebook
