"""What is wrong with a launch, in the real tool's words, with the place and what to try."""

from __future__ import annotations

import importlib
import inspect
import linecache
import re
from collections.abc import Callable, Iterable
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING

from ..ament import catalog, index
from ..ament.package import PackageNotFoundError
from ..idl.names import did_you_mean
from ..sim.errors import is_ours, learners_frames, shorten, shown_path

if TYPE_CHECKING:
    from ..runtime.world import World

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


def find_launch_file(world: World, package: str, file_name: str) -> Path:
    """The launch file of this name that a package has installed.

    Raises:
        LaunchError: with the words of `ros2 launch`, and what to try.
    """
    try:
        return index.find_launch_file(world.packages, package, file_name)
    except PackageNotFoundError as error:
        reason = f"Package '{package}' not found: {error.text!r}"
        raise LaunchError(reason, None, error.hint) from None
    except index.LaunchFileNotFoundError as error:
        raise LaunchError(error.text, None, error.hint) from None


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
    if isinstance(error, PackageNotFoundError):
        return repr(error.text)
    return str(error)


Hint = Callable[[re.Match[str]], str]


def hint_for(error: BaseException, given: Iterable[str] = ()) -> str:
    """A sentence on what to try, or nothing.

    Args:
        error: what went wrong; the errors that it came from are looked at, too.
        given: the names of the launch arguments that were given.
    """
    cause: BaseException | None = error
    while cause is not None:
        if hint := _own_hint(cause) or _known(cause, list(given)):
            return hint
        cause = cause.__cause__
    return ""


def _own_hint(error: BaseException) -> str:
    notes = " ".join(getattr(error, "__notes__", []))
    return str(getattr(error, "hint", "") or notes)


def _known(error: BaseException, given: list[str]) -> str:
    from launch.actions._groups import MissingLaunchArgumentError

    if isinstance(error, MissingLaunchArgumentError):
        return _missing_argument(error.argument, given)
    if isinstance(error, FileNotFoundError | IsADirectoryError) and isinstance(error.filename, str):
        return _missing_file(Path(error.filename))
    if (
        isinstance(error, ModuleNotFoundError)
        and error.name
        and (why := catalog.why_not_here(error.name.partition(".")[0]))
    ):
        return f"{error.name} is not available here: {why}."
    if isinstance(error, SyntaxError):
        return "Look at this line and at the end of the one before: is a comma, a bracket or a quote missing?"
    if type(error).__name__ == "InvalidNodeNameException":
        return "Letters, digits and '_' are allowed, with no digit first."
    for pattern, hint in _BY_TEXT:
        if match := re.search(pattern, str(error)):
            return hint(match)
    return ""


def _missing_file(path: Path) -> str:
    """What there is instead of a file that is not there."""
    if package := catalog.package_of(path):
        return f"{package} is not available here: {catalog.why_not_here(package)}."
    if path.is_dir():
        return "That is a folder; name the launch file in it."
    if not path.parent.is_dir():
        return f"There is no folder {shown_path(str(path.parent))}."
    if close := did_you_mean(path.name, sorted(other.name for other in path.parent.iterdir())):
        return close
    if "launch" not in path.name:
        return ""
    names = sorted(other.name for other in path.parent.iterdir() if index.is_launch_file(other.name))
    if not path.is_absolute() and not names:
        return "A launch file is given by its full path: PathJoinSubstitution([FindPackageShare(…), 'launch', …])."
    return f"There are: {', '.join(names)}." if names else ""


def _missing_argument(name: str, given: list[str]) -> str:
    close = did_you_mean(name, given)
    if close:
        wrong = close.split("'")[1]
        return f"You gave '{wrong}'; did you mean '{name}'?"
    return f"Give it a value: {name}:=… (in a notebook lesson.launch(…, {name}='…'))."


def _undefined(match: re.Match[str]) -> str:
    name = match[1]
    for module, names in _importable().items():
        if name in names:
            return f"Add at the top of the file: from {module} import {name}"
    everything = {known: module for module, names in _importable().items() for known in names}
    return did_you_mean(name, everything)


def _importable() -> dict[str, list[str]]:
    """The public names of the modules that launch files import from."""
    names = (
        "launch_ros.actions", "launch.actions", "launch.substitutions", "launch.conditions", "launch.event_handlers",
        "launch.launch_description_sources", "launch_ros.substitutions", "ament_index_python.packages", "launch",
        "launch_ros.parameter_descriptions", "launch_ros.descriptions", "launch_ros.event_handlers", "launch.events",
        "launch_ros.events.lifecycle", "launch_xml.launch_description_sources", "launch_yaml.launch_description_sources",
    )  # fmt: skip
    return {name: _public_names(importlib.import_module(name)) for name in names}


def _public_names(module: ModuleType) -> list[str]:
    """What a module says that it exports, or else what was made in its package."""
    package = f"{module.__name__.partition('.')[0]}."
    made = [name for name, value in vars(module).items() if f"{getattr(value, '__module__', '')}.".startswith(package)]
    return getattr(module, "__all__", [name for name in made if not name.startswith("_")])


def _unexpected_keyword(match: re.Match[str]) -> str:
    import launch.actions
    import launch_ros.actions

    classes = [launch_ros.actions.Node, launch.actions.ExecuteProcess, launch.actions.ExecuteLocal]
    known = {name for kind in classes for name in inspect.signature(kind).parameters}
    return did_you_mean(match[1], sorted(known - {"kwargs", "cmd"}))


def _text_wanted(match: re.Match[str]) -> str:
    if match[1] == "NoneType":
        return "Launch needs text here, but got None: is a variable or a return value empty?"
    return f"Launch needs text here, but got a value of type {match[1]}: put it in quotes, as in '5.0'."


_BY_TEXT: list[tuple[str, Hint]] = [
    (r"name '(\w+)' is not defined", _undefined),
    (r"unexpected keyword argument '(\w+)'", _unexpected_keyword),
    (r"missing \d+ required keyword-only arguments?: '(\w+)'", lambda match: f"Write {match[1]}='…' in it."),
    (r"expected 'parameters' to be one of .*'dict'", lambda _: "Put it into a list: parameters=[{…}]"),
    (r"Failed to normalize given item of type '<class '(\w+)'>'", _text_wanted),
    (
        r"'NoneType' object has no attribute 'get_launch_arguments",
        lambda _: "generate_launch_description() must end with: return LaunchDescription([…])",
    ),
    (
        r"'(?:list|tuple)' object has no attribute 'get_launch_arguments",
        lambda _: "Wrap the list: return LaunchDescription([…])",
    ),
    (
        r"object has no attribute '(?:visit|describe_sub_entities)'",
        lambda _: "Only actions such as Node(…) can be in a launch description.",
    ),
    (r"is not a valid standard output config", lambda _: "The usual value is output='screen'."),
]
