"""`AnyLaunchDescriptionSource`: a launch file of any kind; this is what `ros2 launch` uses."""

from __future__ import annotations

import os

from turtle_lesson.ros.workspace.errors import PackageNotFoundError

from ..frontend import Parser
from ..invalid_launch_file_error import InvalidFrontendLaunchFileError, InvalidLaunchFileError
from ..launch_description import LaunchDescription
from ..launch_description_source import LaunchDescriptionSource
from ..some_types import SomeSubstitutionsType
from .frontend_launch_file_utilities import get_launch_description_from_frontend_launch_file
from .python_launch_file_utilities import get_launch_description_from_python_launch_file, why_no_python

ENDINGS = ("launch.xml", "launch.yaml", "launch.yml")
"""How the names of XML and YAML launch files end, with a dot or an underscore before."""


class AnyLaunchDescriptionSource(LaunchDescriptionSource):
    """Gets the description from a launch file, whatever its format."""

    def __init__(self, launch_file_path: SomeSubstitutionsType) -> None:
        super().__init__(None, launch_file_path, "interpreted launch file")

    def _get_launch_description(self, location: str) -> LaunchDescription:
        return get_launch_description_from_any_launch_file(location)


def get_launch_description_from_any_launch_file(
    launch_file_path: str, *, parser: type[Parser] = Parser
) -> LaunchDescription:
    """The description in a launch file.

    Raises:
        InvalidLaunchFileError: caused by what went wrong in the file; its text is the real one.
    """
    extension = os.path.splitext(launch_file_path)[1].lstrip(".")
    if extension not in {"xml", "yaml", "yml"}:
        return _from_python(launch_file_path, extension)
    try:
        return get_launch_description_from_frontend_launch_file(launch_file_path, parser=parser)
    except FileNotFoundError as error:
        if error.filename == launch_file_path:
            raise
        wrong: Exception = error
    except Exception as error:
        wrong = error
    python = why_no_python(launch_file_path)
    known = extension if os.path.basename(launch_file_path).endswith(ENDINGS) else ""
    raise InvalidLaunchFileError(known, likely_errors=[wrong, python] if known else []) from wrong


def _from_python(path: str, extension: str) -> LaunchDescription:
    try:
        return get_launch_description_from_python_launch_file(path)
    except FileNotFoundError as error:
        if error.filename == path:
            raise
        raise _invalid(extension, error) from error
    except Exception as error:
        raise _invalid(extension, error) from error


def _invalid(extension: str, error: Exception) -> InvalidLaunchFileError:
    """The error about a Python file. The real one goes on to say that the file may have a syntax error, which misleads
    where a package is missing, so that this is said alone."""
    if isinstance(error, PackageNotFoundError):
        return InvalidLaunchFileError(extension, likely_errors=[error])
    no_frontend = InvalidFrontendLaunchFileError()
    return InvalidLaunchFileError(extension, likely_errors=[error, no_frontend])
