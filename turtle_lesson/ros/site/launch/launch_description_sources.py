"""Where launch descriptions come from: mostly files in Python, XML or YAML."""

from __future__ import annotations

import os
from pathlib import Path
from types import ModuleType

from turtle_lesson.ros.ament.errors import PackageNotFoundError
from turtle_lesson.ros.sim.errors import shown_path

from ._context import LaunchContext
from ._entities import LaunchDescription, SomeSubstitutionsType
from ._package import explain_missing
from .frontend import InvalidFrontendLaunchFileError, InvalidLaunchFileError, Parser
from .utilities import normalize_to_list_of_substitutions, perform_substitutions

__all__ = ["AnyLaunchDescriptionSource", "FrontendLaunchDescriptionSource", "PythonLaunchDescriptionSource"]


class LaunchDescriptionSource:
    """A launch description, or a location from which a subclass gets one when it is needed."""

    def __init__(
        self,
        launch_description: LaunchDescription | None = None,
        location: SomeSubstitutionsType = "",
        method: str = "unspecified mechanism from a script",
    ) -> None:
        self.__launch_description = launch_description
        self.__location = normalize_to_list_of_substitutions(location)
        self.__expanded_location: str | None = None
        self.__method = method

    @property
    def location(self) -> str:
        """Where it comes from, as far as that is known yet."""
        if self.__expanded_location is not None:
            return self.__expanded_location
        return " + ".join(part.describe() for part in self.__location)

    @property
    def method(self) -> str:
        """How it is got, in words."""
        return self.__method

    def get_launch_description(self, context: LaunchContext) -> LaunchDescription:
        """The description; the file is read when it is first asked for."""
        if self.__expanded_location is None:
            self.__expanded_location = perform_substitutions(context, self.__location)
        if self.__launch_description is None:
            self.__launch_description = self._get_launch_description(self.__expanded_location)
        return self.__launch_description

    def try_get_launch_description_without_context(self) -> LaunchDescription | None:
        """The description if it can be had before the launch runs, otherwise None."""
        if self.__launch_description is not None:
            return self.__launch_description
        try:
            return self.get_launch_description(LaunchContext())
        except Exception:
            self.__expanded_location = None
            return None

    def _get_launch_description(self, location: str) -> LaunchDescription:
        raise NotImplementedError(f"{type(self).__name__} does not say how to get a launch description")


class InvalidPythonLaunchFileError(Exception):
    """A Python launch file lacks what every launch file must have."""

    def __init__(self, message: str, hint: str = "") -> None:
        super().__init__(message)
        self.hint = hint


def load_python_launch_file_as_module(python_launch_file_path: str) -> ModuleType:
    """Run the file in a fresh module, each time anew."""
    path = Path(python_launch_file_path)
    module = ModuleType("python_launch_file")
    module.__file__ = str(path)
    code = compile(path.read_bytes(), str(path), "exec")
    exec(code, module.__dict__)
    return module


def get_launch_description_from_python_launch_file(python_launch_file_path: str) -> LaunchDescription:
    """What the file's `generate_launch_description()` returns.

    Raises:
        InvalidPythonLaunchFileError: if it has no such function; and whatever the file itself raises.
    """
    module = load_python_launch_file_as_module(python_launch_file_path)
    generate = getattr(module, "generate_launch_description", None)
    if generate is None:
        raise InvalidPythonLaunchFileError(
            f"launch file at '{shown_path(python_launch_file_path)}' does not contain the required function "
            "'generate_launch_description()'",
            _hint(module),
        )
    description: LaunchDescription = generate()
    return description


def _hint(module: ModuleType) -> str:
    import difflib

    functions = [name for name, value in vars(module).items() if callable(value)]
    close = difflib.get_close_matches("generate_launch_description", functions, n=1)
    if close:
        return f"Rename {close[0]}() to generate_launch_description()."
    return "Write: def generate_launch_description(): return LaunchDescription([…])"


def why_no_python(path: str) -> Exception:
    """What the real tool says besides of an XML or YAML file that is wrong, since it tries it as Python, too."""
    try:
        compile(Path(path).read_bytes(), path, "exec")
    except (SyntaxError, ValueError) as error:
        return error
    missing = "does not contain the required function 'generate_launch_description()'"
    return InvalidPythonLaunchFileError(f"launch file at '{shown_path(path)}' {missing}")


class PythonLaunchDescriptionSource(LaunchDescriptionSource):
    """Gets the description from a Python launch file."""

    def __init__(self, launch_file_path: SomeSubstitutionsType) -> None:
        super().__init__(None, launch_file_path, "interpreted python launch file")

    def _get_launch_description(self, location: str) -> LaunchDescription:
        return get_launch_description_from_python_launch_file(location)


def get_launch_description_from_frontend_launch_file(
    launch_file_path: str, *, parser: type[Parser] = Parser
) -> LaunchDescription:
    """The description in a launch file that is not Python.

    Raises:
        InvalidFrontendLaunchFileError: if no reader can read it; and whatever is wrong in it.
    """
    root, reader = parser.load(launch_file_path)
    return reader.parse_description(root)


class FrontendLaunchDescriptionSource(LaunchDescriptionSource):
    """Gets the description from an XML or YAML launch file."""

    def __init__(
        self,
        launch_file_path: SomeSubstitutionsType,
        *,
        method: str = "interpreted frontend launch file",
        parser: type[Parser] = Parser,
    ) -> None:
        super().__init__(None, launch_file_path, method)
        self._parser = parser

    def _get_launch_description(self, location: str) -> LaunchDescription:
        return get_launch_description_from_frontend_launch_file(location, parser=self._parser)


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


__getattr__ = explain_missing(
    __name__,
    {
        "XMLLaunchDescriptionSource": "it is in launch_xml.launch_description_sources",
        "YAMLLaunchDescriptionSource": "it is in launch_yaml.launch_description_sources",
    },
)
