"""Where in a launch file something was written, so that an error that shows up later can name the line."""

from __future__ import annotations

import sys

from turtle_lesson.ros.core.tracebacks import is_ours

Place = tuple[str, int]
"""A file and a line in it, counted from 1."""


def written_at() -> Place | None:
    """The file and line of the innermost caller that is not part of the simulation's own code."""
    frame = sys._getframe(1)
    while frame is not None:
        if not is_ours(frame.f_code.co_filename):
            return frame.f_code.co_filename, frame.f_lineno
        frame = frame.f_back  # type: ignore[assignment]
    return None
