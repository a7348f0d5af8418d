"""Where launch descriptions come from: mostly files in Python, XML or YAML."""

from __future__ import annotations

import os
from pathlib import Path
from types import ModuleType
from typing import ClassVar

from turtle_lesson.ros.ament.package import PackageNotFoundError
from turtle_lesson.ros.sim.errors import shown_path

from ._context import LaunchContext
from ._entities import LaunchDescription, SomeSubstitutionsType, described, explained
from .frontend import description_of, read_launch_file
from .utilities import normalize_to_list_of_substitutions, perform_substitutions

__all__ = ["AnyLaunchDescriptionSource", "FrontendLaunchDescriptionSource", "PythonLaunchDescriptionSource"]


class InvalidLaunchFileError(Exception):
    """A launch file could not be loaded. The text has no hint of the simulation's in it.

    Of a file that is read as Python it is the real text: a real launch reads such a file as XML or YAML, too, and says so
    (`tried_both`). Of an XML or YAML file it has only what the reader of that format says.
    """

    def __init__(self, extension: str, error: Exception, *, tried_both: bool) -> None:
        said = KeyError.__str__(error) if isinstance(error, KeyError) else str(error)
        text = f"Caught exception when trying to load file of format [{extension}]: {said}"
        if tried_both:
            text = (
                f"Caught multiple exceptions when trying to load file of format [{extension}]:\n"
                f" - {type(error).__name__}: {said}\n"
                " - InvalidFrontendLaunchFileError: The launch file may have a syntax error, or its format is unknown"
            )
        super().__init__(text)


class LaunchDescriptionSource:
    """A launch description, or a location from which a subclass gets one when it is needed."""

    def __init__(
        self, launch_description: LaunchDescription | None = None, location: SomeSubstitutionsType = ""
    ) -> None:
        self.__launch_description = launch_description
        self.__location = normalize_to_list_of_substitutions(location)
        self.location = described(self.__location)
        """Where it comes from, as far as that is known yet."""

    def get_launch_description(self, context: LaunchContext) -> LaunchDescription:
        """The description; the file is read when it is first asked for."""
        if self.__launch_description is None:
            self.location = perform_substitutions(context, self.__location)
            self.__launch_description = self._get_launch_description(self.location)
        return self.__launch_description

    def try_get_launch_description_without_context(self) -> LaunchDescription | None:
        """The description if it can be had before the launch runs, otherwise None."""
        try:
            return self.get_launch_description(LaunchContext())
        except Exception:
            self.location = described(self.__location)
            return None

    def _get_launch_description(self, location: str) -> LaunchDescription:
        raise NotImplementedError(f"{type(self).__name__} does not say how to get a launch description")


class _LaunchFile(LaunchDescriptionSource):
    """Gets the description from a file, in a way that a subclass knows."""

    def __init__(self, launch_file_path: SomeSubstitutionsType) -> None:
        super().__init__(location=launch_file_path)


class InvalidPythonLaunchFileError(Exception):
    """A Python launch file lacks what every launch file must have."""


class PythonLaunchDescriptionSource(_LaunchFile):
    """Gets the description from a Python launch file."""

    def _get_launch_description(self, location: str) -> LaunchDescription:
        """What the file's `generate_launch_description()` returns; the file is run in a fresh module, each time anew.

        Raises InvalidPythonLaunchFileError if it has no such function; and whatever the file itself raises.
        """
        module = ModuleType("python_launch_file")
        module.__file__ = location
        exec(compile(Path(location).read_bytes(), location, "exec"), vars(module))
        generate = getattr(module, "generate_launch_description", None)
        if generate is None:
            missing = "does not contain the required function 'generate_launch_description()'"
            error = InvalidPythonLaunchFileError(f"launch file at '{shown_path(location)}' {missing}")
            raise explained(error, "Write: def generate_launch_description(): return LaunchDescription([…])")
        description: LaunchDescription = generate()
        return description


class FrontendLaunchDescriptionSource(_LaunchFile):
    """Gets the description from an XML or YAML launch file."""

    _read: ClassVar = staticmethod(read_launch_file)

    def _get_launch_description(self, location: str) -> LaunchDescription:
        return description_of(self._read(location))


class AnyLaunchDescriptionSource(_LaunchFile):
    """Gets the description from a launch file, whatever its format."""

    def _get_launch_description(self, location: str) -> LaunchDescription:
        """The description. Raises InvalidLaunchFileError caused by what went wrong in the file."""
        extension = os.path.splitext(location)[1].lstrip(".")
        is_python = extension not in {"xml", "yaml", "yml"}
        source = PythonLaunchDescriptionSource if is_python else FrontendLaunchDescriptionSource
        try:
            return source(location)._get_launch_description(location)
        except Exception as error:
            if isinstance(error, FileNotFoundError) and error.filename == location:
                raise
            tried_both = is_python and not isinstance(error, PackageNotFoundError)
            raise InvalidLaunchFileError(extension, error, tried_both=tried_both) from error
