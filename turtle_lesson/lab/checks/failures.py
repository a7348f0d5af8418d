"""What went wrong in the learner's code: an error in a few lines, and callbacks that have not returned, by name and line."""

from __future__ import annotations

import traceback
from types import FrameType
from typing import Any

from ...ros.sim import errors
from ...ros.sim.errors import DriveTimeout, NeverReturns
from .results import BAD, STOPPED, Advice, Row

MOST_FRAMES = 4
"""Lines of a learner's code that are shown of one error: the innermost ones."""

LONGEST = 200
"""Characters of an error's own words that are shown."""

CELL = "a cell of this notebook"

ENDLESS = (NeverReturns, DriveTimeout)
"""The errors by which code is stopped that never returns: it computes on and on, or waits again and again."""


def in_words(error: BaseException) -> str:
    """The kind and the words of an error: "TypeError: unsupported operand …"."""
    text = shortened(" ".join(str(error).split()), LONGEST)
    return f"{type(error).__name__}: {text}" if text else type(error).__name__


def shortened(text: str, most: int) -> str:
    """The text, or as much of it as fits into so many characters, the last of which is an ellipsis."""
    return text if len(text) <= most else f"{text[: most - 1]}…"


def trace_of(error: BaseException) -> str:
    """The learner's lines that led to an error, outermost first, and the advice that the error carries."""
    if errors.before_showing is not None:
        errors.before_showing(error)
    entries = errors.learners_frames(error.__traceback__)[-MOST_FRAMES:]
    lines = [_place(entry.tb_frame, entry.tb_lineno) for entry in entries]
    return "\n".join([*lines, *(str(note) for note in getattr(error, "__notes__", ()))])


def _place(frame: FrameType, number: int) -> str:
    """Where a frame is: "line 9 in on_timer: self.x + None"."""
    code = frame.f_code
    file = errors.shown_path(code.co_filename)
    where = f"line {number}" if file == CELL else f"{file}, line {number}"
    inside = "" if code.co_name == "<module>" else f" in {code.co_name}"
    return f"{where}{inside}: {_line(frame, number)}"


def _line(frame: FrameType, number: int) -> str:
    [summary] = traceback.StackSummary.extract([(frame, number)])
    return (summary.line or "").strip().partition("\n")[0]


def never_returned(error: BaseException) -> str:
    """Which callback went on without end, and in which line it was stopped."""
    calls = [(each.tb_frame, each.tb_lineno) for each in errors.traceback_entries(error.__traceback__)]
    inside = _in_a_callback(calls) or _learners(calls)
    if not inside:
        return "something that was called has not returned, and was stopped"
    frame, number = inside[-1]
    return f"{_name(inside[0][0])} has not returned: stopped in line {number} (`{_line(frame, number)}`)"


def _name(frame: FrameType) -> str:
    name = frame.f_code.co_name
    return "the program" if name == "<module>" else name


def _in_a_callback(calls: list[tuple[FrameType, int]]) -> list[tuple[FrameType, int]]:
    """Of calls, outermost first, the learner's own ones within a callback that an executor runs; the callback first."""
    spinning = [index for index, (frame, _) in enumerate(calls) if _is_executor(frame)]
    return _learners(calls[spinning[-1] :]) if spinning else []


def _learners(calls: list[tuple[FrameType, int]]) -> list[tuple[FrameType, int]]:
    return [call for call in calls if errors.is_learners(call[0].f_code.co_filename)]


STOP_ADVICE = Advice(
    "It was stopped because it would have run forever, and nothing else could happen in its node.",
    "A callback does a little and returns; a timer calls it again. To wait, let a timer or another callback continue.",
)
READ = Advice(direction="Read the error first, then the line above it: what has each name in it at that moment?")


def row_of(error: BaseException, expected: str) -> Row:
    """The row about an error of the learner's code."""
    if isinstance(error, ENDLESS):
        return Row(STOPPED, expected, never_returned(error), STOP_ADVICE)
    return Row(BAD, expected, in_words(error), READ, trace_of(error))


# -- callbacks that wait -------------------------------------------------------------------------------------------------


def unreturned(strands: list[Any]) -> list[str]:
    """The callbacks that parked strands stand in, each as "on_request has not returned: it is in line 7 (`…`)"."""
    found = []
    for strand in strands:
        calls, frame = [], strand.gr_frame
        while frame is not None:
            calls.append((frame, frame.f_lineno))
            frame = frame.f_back
        if inside := _in_a_callback(calls[::-1]):
            last, line = inside[-1]
            found.append(f"{_name(inside[0][0])} has not returned: it is in line {line} (`{_line(last, line)}`)")
    return found


def _is_executor(frame: FrameType) -> bool:
    return str(frame.f_globals.get("__name__", "")).startswith(("rclpy._executor", "rclpy.executors"))
