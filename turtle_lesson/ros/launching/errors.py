"""What is wrong with a launch, in the real tool's words, with the place and what to try."""

from __future__ import annotations

import inspect
import linecache
import re
import sys
from collections.abc import Callable
from pathlib import Path

from ..ament import index
from ..ament.package import PackageNotFoundError
from ..idl.names import did_you_mean
from ..runtime.world import World
from ..sim.errors import is_ours, learners_frames, shorten, shown_path

Place = tuple[str, int]


class LaunchError(Exception):
    """A launch file or description could not be carried out, for a reason in the real tool's words; `hint` says what to try."""

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


def find_launch_file(world: World, package: str, file_name: str) -> Path:
    """The launch file of this name of a package. Raises LaunchError in `ros2 launch`'s words, with what to try."""
    try:
        return index.find_launch_file(world.packages, package, file_name)
    except (PackageNotFoundError, index.LaunchFileNotFoundError) as error:
        has_package = isinstance(error, index.LaunchFileNotFoundError)
        reason = error.text if has_package else f"Package '{package}' not found: {error.text!r}"
        raise LaunchError(reason, None, error.hint) from None


def _place_of(error: BaseException, written_at: Place | None) -> Place | None:
    """The line to look at.

    It is the one that the reader of an XML or YAML file names, or a syntax error's; else the learner's innermost one;
    else the action's own.
    """
    linecache.checkcache()
    causes = _causes(error)[::-1]
    for place in filter(None, (getattr(cause, "place", None) for cause in causes)):
        return place
    for cause in causes:
        if isinstance(cause, SyntaxError) and cause.filename and cause.lineno and not is_ours(cause.filename):
            return cause.filename, cause.lineno
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
    return [] if error is None else [error, *_causes(error.__cause__)]


def as_launch_error(error: BaseException, written_at: Place | None = None) -> LaunchError:
    """The error as a learner should read it, with a hint of its own or of an error that it came from.

    `written_at` is where the action stands that went wrong.
    """
    if isinstance(error, LaunchError):
        return error
    reason = repr(error.text) if isinstance(error, PackageNotFoundError) else str(error)
    hints = map(_hint, _causes(error))
    return LaunchError(reason, _place_of(error, written_at), next(filter(None, hints), ""))


def _hint(error: BaseException) -> str:
    if own := " ".join(filter(None, [*getattr(error, "__notes__", []), getattr(error, "hint", "")])):
        return own
    if isinstance(error, FileNotFoundError | IsADirectoryError) and isinstance(error.filename, str):
        return _missing_file(Path(error.filename))
    if isinstance(error, ModuleNotFoundError) and (why := index.why_not_here(str(error.name).partition(".")[0])):
        return f"{error.name} is not available here: {why}."
    if isinstance(error, SyntaxError):
        return "Look at this line and at the end of the one before: is a comma, a bracket or a quote missing?"
    for pattern, hint in _BY_TEXT.items():
        if match := re.search(pattern, str(error)):
            return match.expand(hint) if isinstance(hint, str) else hint(match[1])
    return ""


def _missing_file(path: Path) -> str:
    """What there is instead of a file that is not there."""
    if package := index.package_of(path):
        return f"{package} is not available here: {index.why_not_here(package)}."
    if path.is_dir():
        return "That is a folder; name the launch file in it."
    if not path.parent.is_dir():
        return f"There is no folder {shown_path(str(path.parent))}."
    return did_you_mean(path.name, [other.name for other in path.parent.iterdir()])


def _undefined(name: str) -> str:
    """Where launch files import a name from; of several modules it is one of actions, or the one with the shortest path."""
    import launch_ros  # noqa: F401  (may not have been imported yet)

    ours = [path for path in sys.modules if re.fullmatch(r"(launch|launch_ros)(\.[a-z]\w*)*", path)]
    ours.sort(key=lambda path: ("actions" in path, -len(path)))  # a later one replaces what was found before
    homes = {public: path for path in ours for public in getattr(sys.modules[path], "__all__", ())}
    homes |= dict.fromkeys(("get_package_share_directory", "get_package_prefix"), "ament_index_python.packages")
    if name in homes:
        return f"Add at the top of the file: from {homes[name]} import {name}"
    return did_you_mean(name, homes)


def _unexpected_keyword(name: str) -> str:
    from launch.actions import ExecuteProcess
    from launch_ros.actions import Node

    return did_you_mean(name, {*inspect.signature(Node).parameters, *inspect.signature(ExecuteProcess).parameters})


_BY_TEXT: dict[str, str | Callable[[str], str]] = {
    r"name '(\w+)' is not defined": _undefined,
    r"unexpected keyword argument '(\w+)'": _unexpected_keyword,
    r"missing \d+ required keyword-only arguments?: '(\w+)'": r"Write \1='…' in it.",
    r"Failed to normalize given item of type '<class '(\w+)'>'": (
        r"Launch needs text here, but got a value of type \1; a number is put in quotes, as in '5.0'."
    ),
    r"object has no attribute 'get_launch_arguments": (
        "generate_launch_description() must end with: return LaunchDescription([…])"
    ),
    r"object has no attribute '(?:visit|describe_sub_entities)'": (
        "Only actions such as Node(…) can be in a launch description."
    ),
    r"^Invalid node name: ": "Letters, digits and '_' are allowed, with no digit first.",
    r"is not a valid standard output config": "The usual value is output='screen'.",
}
"""What to try, by the text of an error."""
