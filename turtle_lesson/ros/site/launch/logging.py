"""The lines that launch itself prints, such as `[INFO] [launch]: …`. There are no log files here."""

from __future__ import annotations

import logging


class LaunchConfig:
    """What holds for all of launch's lines: from which level on they are printed."""

    level: int = logging.INFO


launch_config = LaunchConfig()


class Logger(logging.Logger):
    """Prints lines under a name, from launch's level on, which leaves debug lines out unless it is changed."""

    warn = logging.Logger.warning

    def setLevel(self, level: int | str) -> None:
        """Print lines from another level on."""
        launch_config.level = logging.getLevelNamesMapping()[level] if isinstance(level, str) else level

    def handle(self, record: logging.LogRecord) -> None:
        """Print a line, if its level is high enough."""
        if record.levelno >= launch_config.level:
            print(f"[{record.levelname}] [{self.name}]: {record.getMessage()}")


def get_logger(name: str | None = None) -> Logger:
    """The logger of a name; without one, launch's own."""
    return Logger(name or "launch")
