"""What is wrong with a launch, in the real tool's words, with the place and what to try."""

from __future__ import annotations

import linecache

from ..core.tracebacks import is_ours, learners_frames, shorten, shown_path

Place = tuple[str, int]


class LaunchError(Exception):
    """A launch file or description could not be carried out.

    Attributes:
        reason: the real tool's own words.
        file: the launch file to look at, or None.
        line: the line in it, counted from 1, or None.
        hint: what to try, or an empty text.
    """

    def __init__(self, reason: str, place: Place | None = None, hint: str = "") -> None:
        super().__init__(reason, place, hint)
        self.reason = reason
        self.file = place[0] if place else None
        self.line = place[1] if place else None
        self.hint = hint

    @property
    def console(self) -> str:
        """The line that `ros2 launch` prints on a robot."""
        return f"[ERROR] [launch]: Caught exception in launch (see debug for traceback): {self.reason}"

    @property
    def advice(self) -> str:
        """Where to look and what to try, which the real tool does not say."""
        lines = []
        if self.file is not None and self.line is not None:
            source = linecache.getline(self.file, self.line).strip()
            lines.append(f"  in {shown_path(self.file)}, line {self.line}{f': {source}' if source else ''}")
        if self.hint:
            lines.append(f"  {self.hint}")
        return "\n".join(lines)

    def __str__(self) -> str:
        return "\n".join(filter(None, (self.reason, self.advice)))


def place_of(error: BaseException, written_at: Place | None = None) -> Place | None:
    """The line to look at.

    It is the one that the reader of an XML or YAML file names, or a syntax error's; else the learner's innermost one;
    else the action's own.
    """
    linecache.checkcache()
    causes = _causes(error)
    for cause in reversed(causes):
        place: Place | None = getattr(cause, "place", None)
        if place is not None:
            return place
    for cause in causes:
        if isinstance(cause, SyntaxError) and cause.filename and cause.lineno and not is_ours(cause.filename):
            return cause.filename, cause.lineno
    for cause in reversed(causes):
        if frames := learners_frames(cause.__traceback__):
            return frames[-1].tb_frame.f_code.co_filename, frames[-1].tb_lineno
    return written_at


def learners_cause(error: BaseException | None) -> BaseException | None:
    """The error in the learner's own code that all came from, if its traceback has several lines."""
    for cause in reversed(_causes(error)):
        if len(learners_frames(cause.__traceback__)) > 1:
            cause.__traceback__ = shorten(cause.__traceback__)
            return cause
    return None


def _causes(error: BaseException | None) -> list[BaseException]:
    """The error and what it came from, the outermost first."""
    found = []
    cause = error
    while cause is not None:
        found.append(cause)
        cause = cause.__cause__
    return found


def reason_of(error: BaseException) -> str:
    """What the real tool would print of an error."""
    from ..workspace.errors import PackageNotFoundError

    if isinstance(error, PackageNotFoundError):
        return repr(error.text)
    return str(error)
