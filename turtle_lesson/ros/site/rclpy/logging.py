"""Loggers without a node, and levels by name."""

from __future__ import annotations

import os
from pathlib import Path

from .impl.logging_severity import LoggingSeverity
from .impl.rcutils_logger import RcutilsLogger, levels


def get_logger(name: str) -> RcutilsLogger:
    """A logger of this name."""
    if not name:
        raise ValueError("Logger name must not be empty.")
    return RcutilsLogger(name)


def initialize() -> None:
    """Make the logging ready; here it always is."""


def shutdown() -> None:
    """Forget all levels."""
    levels().clear()


clear_config = shutdown


def set_logger_level(name: str, level: int, detailed_error: bool = False) -> None:
    """Have the logger of this name, or by default all (''), print only what is at least this severe.

    Raises ValueError for what is no level. `detailed_error` makes no difference here.
    """
    RcutilsLogger(name).set_level(level)


def get_logger_level(name: str) -> LoggingSeverity:
    """The level that was set for a name."""
    return levels().get(name, LoggingSeverity.UNSET if name else LoggingSeverity.INFO)


def get_logger_effective_level(name: str) -> LoggingSeverity:
    """The level in force for a name."""
    return RcutilsLogger(name).get_effective_level()


def get_logging_severity_from_string(log_severity: str) -> LoggingSeverity:
    """The severity of a word such as "warn"; RuntimeError for any other word."""
    try:
        return LoggingSeverity[log_severity.upper()]
    except KeyError:
        raise RuntimeError(f"Failed to get severity name: '{log_severity}' is not a log level") from None


def get_logging_directory() -> Path:
    """Where a real ROS 2 would write log files: $ROS_LOG_DIR, or `log` in $ROS_HOME or ~/.ros. None are written here."""
    given = os.environ.get("ROS_LOG_DIR")
    home = os.environ.get("ROS_HOME") or "~/.ros"
    return Path(given or f"{home}/log").expanduser()
