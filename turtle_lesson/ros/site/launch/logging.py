"""The lines that launch itself prints, such as `[INFO] [launch]: …`. There are no log files here."""

from __future__ import annotations

import logging
import os
from pathlib import Path


class LaunchConfig:
    """What holds for all of launch's lines: from which level on they are printed."""

    def __init__(self) -> None:
        self._log_dir: str | None = None
        self.level: int = logging.INFO

    @property
    def log_dir(self) -> str:
        """Where a real launch writes its log files; here nothing is written there."""
        if self._log_dir is None:
            home = os.environ.get("ROS_HOME") or str(Path.home() / ".ros")
            return os.environ.get("ROS_LOG_DIR") or str(Path(home) / "log")
        return self._log_dir

    @log_dir.setter
    def log_dir(self, folder: str) -> None:
        self._log_dir = folder

    def set_screen_format(self, screen_format: str, *, screen_style: str | None = None) -> None:
        """Accepted; lines have one format here."""

    def set_log_format(self, log_format: str, *, log_style: str | None = None) -> None:
        """Accepted; there are no log files."""

    def reset(self) -> None:
        """Make all as it was in the beginning."""
        self._log_dir = None
        self.level = logging.INFO


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
