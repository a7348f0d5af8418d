"""How serious a log line is."""

from enum import IntEnum


class LoggingSeverity(IntEnum):
    """rcutils' numbers."""

    UNSET = 0
    DEBUG = 10
    INFO = 20
    WARN = 30
    ERROR = 40
    FATAL = 50
