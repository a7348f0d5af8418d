"""How a log line is printed: `[INFO] [1800000012.300000000] [navigator]: text`, or as RCUTILS_CONSOLE_OUTPUT_FORMAT says.

Facts: https://docs.ros.org/en/humble/Concepts/Intermediate/About-Logging.html.
"""

from __future__ import annotations

import os
import re
import sys
from datetime import UTC, datetime
from types import FrameType
from typing import Any, NamedTuple

from turtle_lesson.ros.core import NANOSECONDS
from turtle_lesson.ros.core.tracebacks import shown_path
from turtle_lesson.ros.world import current_process

from .._notebook import is_notebook
from .logging_severity import LoggingSeverity

VARIABLE = "RCUTILS_CONSOLE_OUTPUT_FORMAT"
COLORIZED = "RCUTILS_COLORIZED_OUTPUT"
NORMAL = "\033[0m"
COLORS = {"DEBUG": "\033[32m", "WARN": "\033[33m", "ERROR": "\033[31m", "FATAL": "\033[31m"}
"""Of lines that are not printed in the normal colour (rcutils' logging.c)."""


class Line(NamedTuple):
    """What is to be printed."""

    message: str
    severity: LoggingSeverity
    name: str
    time: int
    """In ns since 1970."""
    frame: FrameType


def wanted_format() -> str | None:
    """The format that the environment asks for; None for the usual one. A process looks once, when it begins."""
    return os.environ.get(VARIABLE)


def is_colorized() -> bool:
    """Whether the environment asks for colours, which a real program also uses on a terminal. A process looks once."""
    return os.environ.get(COLORIZED) == "1"


def print_line(line: Line, wanted: str | None, *, colorized: bool = False) -> None:
    """Print a line where the running process's logs go."""
    stream = sys.stdout if is_notebook(current_process()) else sys.stderr
    if wanted is None:
        seconds, nanoseconds = divmod(line.time, NANOSECONDS)
        text = f"[{line.severity.name}] [{seconds}.{nanoseconds:09d}] [{line.name}]: {line.message}"
    else:
        text = formatted(line, wanted)
    if colorized:
        text = f"{COLORS.get(line.severity.name, NORMAL)}{text}{NORMAL}"
    print(text, file=stream)


def formatted(line: Line, wanted: str) -> str:
    """A line in a format such as `{severity} {name}: {message}`; what is no known word in braces stays as it is."""
    words = _words(line)
    text = re.sub(r"\{(\w+)\}", lambda found: str(words.get(found[1], found[0])), wanted)
    return text.replace("\\n", "\n").replace("\\t", "\t").replace("\\033", "\033")


def _words(line: Line) -> dict[str, Any]:
    seconds, nanoseconds = divmod(line.time, NANOSECONDS)
    code = line.frame.f_code
    moment = datetime.fromtimestamp(seconds, UTC)
    return {
        "severity": line.severity.name,
        "name": line.name,
        "message": line.message,
        "function_name": code.co_name,
        "file_name": shown_path(code.co_filename),
        "short_file_name": shown_path(code.co_filename).rpartition("/")[2],
        "line_number": line.frame.f_lineno,
        "time": f"{seconds}.{nanoseconds:09d}",
        "time_as_nanoseconds": line.time,
        "date_time_with_ms": f"{moment:%Y-%m-%d %H:%M:%S}.{nanoseconds // 1_000_000:03d}",
    }
