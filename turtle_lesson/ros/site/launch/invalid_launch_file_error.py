"""What is said about a launch file that could not be loaded."""

from __future__ import annotations

from collections.abc import Sequence


class InvalidLaunchFileError(Exception):
    """A launch file could not be loaded; the text lists what each loader said."""

    def __init__(self, extension: str = "", *, likely_errors: Sequence[BaseException] | None = None) -> None:
        self.likely_errors = list(likely_errors or [])
        self.extension = extension
        super().__init__(self._text())

    def _text(self) -> str:
        if not self.likely_errors or not self.extension:
            return "The launch file may have a syntax error, or its format is unknown"
        if len(self.likely_errors) == 1:
            what = f"Caught exception when trying to load file of format [{self.extension}]"
            return f"{what}: {_text(self.likely_errors[0])}"
        lines = [f" - {type(error).__name__}: {_text(error)}" for error in self.likely_errors]
        what = f"Caught multiple exceptions when trying to load file of format [{self.extension}]:"
        return "\n".join([what, *lines])


class InvalidFrontendLaunchFileError(InvalidLaunchFileError):
    """A launch file that is neither XML nor YAML."""


def _text(error: BaseException) -> str:
    """What the real one prints, without the simulation's hint after it."""
    return KeyError.__str__(error) if isinstance(error, KeyError) else str(error)
