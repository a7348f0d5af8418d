"""`AnyLaunchDescriptionSource`: a launch file of any kind, of which Python ones can be read here."""

from __future__ import annotations

import os

from ..invalid_launch_file_error import InvalidFrontendLaunchFileError, InvalidLaunchFileError
from ..launch_description import LaunchDescription
from ..launch_description_source import LaunchDescriptionSource
from ..some_types import SomeSubstitutionsType
from .python_launch_file_utilities import get_launch_description_from_python_launch_file


class AnyLaunchDescriptionSource(LaunchDescriptionSource):
    """Gets the description from a launch file, whatever its format; this is what `ros2 launch` uses."""

    def __init__(self, launch_file_path: SomeSubstitutionsType) -> None:
        super().__init__(None, launch_file_path, "interpreted launch file")

    def _get_launch_description(self, location: str) -> LaunchDescription:
        return get_launch_description_from_any_launch_file(location)


def get_launch_description_from_any_launch_file(launch_file_path: str) -> LaunchDescription:
    """The description in a launch file.

    Raises:
        InvalidLaunchFileError: caused by what went wrong in the file; its text is the real one.
    """
    extension = os.path.splitext(launch_file_path)[1].lstrip(".")
    if extension in {"xml", "yaml", "yml"}:
        what = f"{extension.upper()} launch files cannot be read in this classroom yet, Python ones can"
        raise InvalidLaunchFileError(extension, likely_errors=[NotImplementedError(what)])
    try:
        return get_launch_description_from_python_launch_file(launch_file_path)
    except FileNotFoundError as error:
        if error.filename == launch_file_path:
            raise
        raise _invalid(extension, error) from error
    except Exception as error:
        raise _invalid(extension, error) from error


def _invalid(extension: str, error: Exception) -> InvalidLaunchFileError:
    no_frontend = InvalidFrontendLaunchFileError(str(InvalidLaunchFileError()))
    return InvalidLaunchFileError(extension, likely_errors=[error, no_frontend])
