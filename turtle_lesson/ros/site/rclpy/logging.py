"""Loggers without a node, and levels by name."""

from __future__ import annotations

from .impl.logging_severity import LoggingSeverity
from .impl.rcutils_logger import RcutilsLogger, _levels, as_severity

__all__ = [
    "LoggingSeverity",
    "get_logger",
    "get_logger_effective_level",
    "get_logger_level",
    "get_logging_severity_from_string",
    "set_logger_level",
]


def get_logger(name: str) -> RcutilsLogger:
    """A logger of this name."""
    if not name:
        raise ValueError("Logger name must not be empty.")
    return RcutilsLogger(name)


def set_logger_level(name: str, level: int, detailed_error: bool = False) -> None:
    """Have the logger of this name print only what is at least this severe."""
    _levels()[name] = as_severity(level)


def get_logger_level(name: str) -> LoggingSeverity:
    """The level that was set for a name."""
    return _levels().get(name, LoggingSeverity.UNSET)


def get_logger_effective_level(name: str) -> LoggingSeverity:
    """The level in force for a name."""
    return RcutilsLogger(name).get_effective_level()


def get_logging_severity_from_string(log_severity: str) -> LoggingSeverity:
    """The severity of a word such as "warn"; RuntimeError for any other word."""
    try:
        return LoggingSeverity[log_severity.upper()]
    except KeyError:
        known = ", ".join(severity.name for severity in LoggingSeverity)
        raise RuntimeError(f"'{log_severity}' is no log level; levels are {known}") from None
