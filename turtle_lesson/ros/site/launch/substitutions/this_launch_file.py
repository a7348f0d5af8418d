"""`ThisLaunchFile` and `ThisLaunchFileDir`: where the launch file that is being run lies."""

from __future__ import annotations

from typing import Any

from ..launch_context import LaunchContext
from ..substitution import Substitution
from .substitution_failure import SubstitutionFailure


class ThisLaunchFile(Substitution):
    """The path of the launch file."""

    def describe(self) -> str:
        """Its name."""
        return "ThisLaunchFile()"

    def perform(self, context: LaunchContext) -> str:
        """The path.

        Raises:
            SubstitutionFailure: outside of a launch file.
        """
        return _local(context, "current_launch_file_path", "ThisLaunchFile")


class ThisLaunchFileDir(Substitution):
    """The folder of the launch file."""

    def describe(self) -> str:
        """Its name."""
        return "ThisLaunchFileDir()"

    def perform(self, context: LaunchContext) -> str:
        """The folder.

        Raises:
            SubstitutionFailure: outside of a launch file.
        """
        return _local(context, "current_launch_file_directory", "ThisLaunchFileDir")


def _local(context: LaunchContext, name: str, who: str) -> str:
    values: dict[str, Any] = context.get_locals_as_dict()
    if name not in values:
        raise SubstitutionFailure(f"{who} used outside of a launch file (in a script)")
    return str(values[name])
