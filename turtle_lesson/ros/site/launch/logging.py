"""The lines that launch itself prints, such as `[INFO] [launch]: …`. There are no log files here."""

from __future__ import annotations

from ._missing import explain_missing


class Logger:
    """Prints lines under a name; debug lines are dropped, as at launch's default verbosity."""

    def __init__(self, name: str) -> None:
        self.name = name

    def debug(self, message: object, *args: object) -> None:
        """Dropped."""

    def info(self, message: object, *args: object) -> None:
        """Print an [INFO] line."""
        self._print("INFO", message, args)

    def warning(self, message: object, *args: object) -> None:
        """Print a [WARNING] line."""
        self._print("WARNING", message, args)

    warn = warning

    def error(self, message: object, *args: object) -> None:
        """Print an [ERROR] line."""
        self._print("ERROR", message, args)

    def critical(self, message: object, *args: object) -> None:
        """Print a [CRITICAL] line."""
        self._print("CRITICAL", message, args)

    def _print(self, level: str, message: object, args: tuple[object, ...]) -> None:
        text = str(message) % args if args else str(message)
        print(f"[{level}] [{self.name}]: {text}")


def get_logger(name: str | None = None) -> Logger:
    """The logger of a name; without one, launch's own."""
    return Logger(name or "launch")


__getattr__ = explain_missing(
    __name__, {"launch_config": "there are no log files", "get_output_loggers": "there are no log files"}
)
