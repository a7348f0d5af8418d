"""`LaunchLogDir`: where a real launch keeps its log files."""

from __future__ import annotations

from typing import Any

from ..frontend.expose import expose_substitution
from ..launch_context import LaunchContext
from ..substitution import Substitution
from ._parsing import arguments


@expose_substitution("log_dir")
@expose_substitution("launch_log_dir")
class LaunchLogDir(Substitution):
    """Stands for the folder of log files; here nothing is written there, so the folder may not exist."""

    @classmethod
    def parse(cls, data: Any) -> tuple[type, dict[str, Any]]:
        """It takes no arguments."""
        return cls, arguments("launch_log_dir", data, [], 0)

    def describe(self) -> str:
        """Its name."""
        return "LaunchLogDir()"

    def perform(self, context: LaunchContext) -> str:
        """The folder that the environment names, or ROS's usual one."""
        from .. import logging

        return logging.launch_config.log_dir
