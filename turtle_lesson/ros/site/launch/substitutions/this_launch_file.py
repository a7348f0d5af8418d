"""`ThisLaunchFile` and `ThisLaunchFileDir`: where the launch file that is being run lies."""

from __future__ import annotations

from typing import Any

from ..frontend.expose import expose_substitution
from ..launch_context import LaunchContext
from ..substitution import Substitution
from ._parsing import arguments
from .substitution_failure import SubstitutionFailure


@expose_substitution("filename")
class ThisLaunchFile(Substitution):
    """The path of the launch file."""

    @classmethod
    def parse(cls, data: Any) -> tuple[type, dict[str, Any]]:
        """Its arguments as they stand behind `$(filename `."""
        return cls, arguments("filename", data, [], 0)

    def describe(self) -> str:
        """Its name."""
        return "ThisLaunchFile()"

    def perform(self, context: LaunchContext) -> str:
        """The path.

        Raises:
            SubstitutionFailure: outside of a launch file.
        """
        return _local(context, "current_launch_file_path", "ThisLaunchFile")


@expose_substitution("dirname")
class ThisLaunchFileDir(Substitution):
    """The folder of the launch file."""

    @classmethod
    def parse(cls, data: Any) -> tuple[type, dict[str, Any]]:
        """Its arguments as they stand behind `$(dirname `."""
        return cls, arguments("dirname", data, [], 0)

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
