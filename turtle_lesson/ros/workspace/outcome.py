"""What building one package comes to: what it prints, how long it takes, and the files that it installs."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from pathlib import Path, PurePosixPath

from ..interfaces.registry import Registry

PYTHON = "python3.10"
"""The Python of ROS 2 Humble, which is in the names of installed folders, whatever Python runs here."""


@dataclass(frozen=True)
class Item:
    """One file or folder to install.

    Attributes:
        target: its place below the package's install prefix, with `/`.
        source: the file or folder that is copied; None where `text` is written.
        text: the content of a file that the build makes.
        program: whether it can be run.
        copied: whether it is copied even by `--symlink-install`.
    """

    target: str
    source: Path | None = None
    text: str = ""
    program: bool = False
    copied: bool = False


@dataclass
class Outcome:
    """How a build went.

    Attributes:
        code: the exit code, 0 if it went well.
        stderr: what colcon shows between `--- stderr: name` and `---`.
        stdout: what CMake or setuptools say meanwhile.
        seconds: how long it takes, in robot time.
        items: what is installed if it went well.
        dependencies: the packages that are needed when it runs.
        paths: folders below the prefix that hold Python packages of the learner's.
        colcon_error: what colcon itself says where it does not even begin.
        left_out: the C++ programs and libraries that are not built here, and scripts that are not Python.
        lacking: the packages that these need and that are not here.
    """

    code: int = 0
    stderr: str = ""
    stdout: list[str] = field(default_factory=list)
    seconds: float = 1.0
    items: list[Item] = field(default_factory=list)
    dependencies: list[str] = field(default_factory=list)
    paths: list[str] = field(default_factory=list)
    colcon_error: str = ""
    left_out: list[str] = field(default_factory=list)
    lacking: list[str] = field(default_factory=list)


@dataclass
class Environment:
    """Where a package is built, and what it finds there."""

    install: Path
    build: Path
    findable: frozenset[str] = frozenset()
    types: Registry = field(default_factory=Registry)
    symlink: bool = False


class BuildFailure(Exception):
    """A package cannot be built: the text that the real tool prints, the exit code, and what to try."""

    def __init__(self, text: str, hint: str = "", *, code: int = 1, seconds: float = 0.9) -> None:
        super().__init__(text)
        self.text = text
        self.hint = hint
        self.code = code
        self.seconds = seconds


def with_hint(text: str, hints: Iterable[str]) -> str:
    """The real tool's text, and below it what to try."""
    lines = "".join(f"Hint: {hint}\n" for hint in hints if hint)
    return f"{text}{lines}" if lines else text


def check_targets(items: Iterable[Item]) -> None:
    """Nothing is installed outside of the package's own folder.

    Raises:
        BuildFailure: something would be.
    """
    for item in items:
        place = PurePosixPath(item.target)
        if place.is_absolute() or ".." in place.parts or "\0" in item.target:
            raise BuildFailure(f"error: '{item.target}' lies outside the package's install folder\n")
