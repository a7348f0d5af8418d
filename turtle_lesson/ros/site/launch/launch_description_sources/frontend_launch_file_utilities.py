"""Loading an XML or YAML launch file."""

from __future__ import annotations

from ..frontend import Parser
from ..launch_description import LaunchDescription


def get_launch_description_from_frontend_launch_file(
    launch_file_path: str, *, parser: type[Parser] = Parser
) -> LaunchDescription:
    """The description in a launch file that is not Python.

    Raises:
        InvalidFrontendLaunchFileError: if no reader can read it; and whatever is wrong in it.
    """
    root, reader = parser.load(launch_file_path)
    return reader.parse_description(root)
