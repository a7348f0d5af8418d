"""Loading a Python launch file."""

from __future__ import annotations

from pathlib import Path
from types import ModuleType

from turtle_lesson.ros.core.tracebacks import shown_path

from ..launch_description import LaunchDescription


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
