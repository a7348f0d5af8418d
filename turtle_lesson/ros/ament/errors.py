"""What can be wrong with a package or with a name that was asked for, each said with what to try."""

from __future__ import annotations

from pathlib import Path

from ..sim.errors import shown_path


class PackageError(ValueError):
    """A package cannot be read as it lies there.

    Attributes:
        reason: what is wrong.
        file: the file that says so, or None.
        line: the line in it, counted from 1, or None.
        hint: what to try, or an empty string.
    """

    def __init__(self, reason: str, file: Path | None = None, line: int | None = None, hint: str = "") -> None:
        super().__init__(reason, file, line, hint)
        self.reason = reason
        self.file = file
        self.line = line
        self.hint = hint

    def __str__(self) -> str:
        where = shown_path(str(self.file)) if self.file else ""
        if self.line is not None:
            where += f", line {self.line}"
        text = f"{where}: {self.reason}" if where else self.reason
        return f"{text}. {self.hint}" if self.hint else text


class ColconError(Exception):
    """Why colcon builds nothing at all; the text is what stands after `ERROR:colcon:colcon build: `."""


class BuildFailure(Exception):
    """A package cannot be built: the text that the real tool prints, the exit code, and what to try."""

    def __init__(self, text: str, hint: str = "", *, code: int = 1, seconds: float = 0.9) -> None:
        super().__init__(text)
        self.text = text
        self.hint = hint
        self.code = code
        self.seconds = seconds


class PackageNotFoundError(KeyError):
    """No package of this name is in the index (`ament_index_python` raises it under the same name).

    The text is the real one, quotation marks included, followed by what was perhaps meant.
    """

    def __init__(self, text: str, hint: str = "") -> None:
        super().__init__(text)
        self.text = text
        self.hint = hint

    def __str__(self) -> str:
        return f"{self.text!r}. {self.hint}" if self.hint else repr(self.text)


class _NotInPackageError(LookupError):
    """A package has not what was asked for. `text` is the real tool's, `hint` ours."""

    def __init__(self, text: str, hint: str = "") -> None:
        super().__init__(text)
        self.text = text
        self.hint = hint

    def __str__(self) -> str:
        return f"{self.text}. {self.hint}" if self.hint else self.text


class ExecutableNotFoundError(_NotInPackageError):
    """A package has no executable of this name."""


class LaunchFileNotFoundError(_NotInPackageError):
    """A package has installed no launch file of this name, or several."""


class NotHereError(NotImplementedError):
    """A robot would start this, and the simulation cannot. A launch names it, and goes on without it.

    Attributes:
        what: what it is.
        why: why it cannot be started.
        hint: what to do instead, or an empty string.
    """

    def __init__(self, what: str, why: str, hint: str = "") -> None:
        super().__init__(f"{what} cannot be started: {why}")
        self.what = what
        self.why = why
        self.hint = hint


class CompiledProgramError(ExecutableNotFoundError):
    """A package's executable is a C++ program, which is not built here. `why` says so in half a sentence."""

    def __init__(self, text: str, executable: str, line: int) -> None:
        self.why = f"a C++ program (CMakeLists.txt, line {line}), and only Python programs run here"
        super().__init__(text, f"{executable} is {self.why}.")
