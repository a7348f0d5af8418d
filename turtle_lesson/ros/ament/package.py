"""A ROS package as the index knows it, and what can be wrong with one, each said with what to try."""

from __future__ import annotations

import os
import re
import shutil
import sys
import textwrap
from collections.abc import Callable, Iterable, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from fnmatch import fnmatchcase
from functools import cache
from pathlib import Path

from ..runtime import files
from ..sim.errors import shown_path
from ..stdlib.program import run_program

Target = Path | Callable[[], object]
"""What an executable is: a Python file, or a callable that is its `main()`."""


@dataclass
class Package:
    """One package that can be found.

    Attributes:
        share: the folder in which its launch files and other data are found.
        executables: what `ros2 run` and `Node(executable=…)` find, by name.
        interfaces: its definitions relative to `share`, such as `msg/TurtleStatus.msg`.
        source: the folder in which it was written, or None.
        prefix: the folder that it is installed in; None for one that is used as it lies there.
        installed: what the share folder of such a one would contain after a build, by path; None for all under `share`.
        modules: the folders in which its Python modules lie.
    """

    name: str
    share: Path
    executables: dict[str, Target] = field(default_factory=dict)
    interfaces: list[str] = field(default_factory=list)
    source: Path | None = None
    prefix: Path | None = None
    installed: dict[str, Path] | None = None
    modules: list[Path] = field(default_factory=list)

    @property
    def libexec(self) -> Path:
        """The folder in which a real ROS 2 looks for the package's executables."""
        return (self.prefix or self.share) / "lib" / self.name

    def shared_files(self, file_name: str) -> list[Path]:
        """The installed files of this name, anywhere in the share folder."""
        if self.installed is None:
            return sorted(path for path in self.share.rglob(file_name) if path.is_file())
        found = {place for path, place in self.installed.items() if fnmatchcase(Path(path).name, file_name)}
        return sorted(found)


@dataclass(frozen=True)
class PythonProgram:
    """What runs a program: a file, read at each start, with the folders of its modules.

    A file that does not exist stands for `text`, such as an entry point that is used without a build.
    """

    path: Path
    folders: tuple[Path, ...]
    text: str | None = None

    def __call__(self) -> None:
        run_program(self.path, self.folders, self.text)


@cache
def sections(file: str) -> dict[str, str]:
    """The sections of a text file of this folder, each of which begins with a line `==== name`."""
    text = Path(__file__).with_name(file).read_text(encoding="utf-8")
    parts = re.split(r"^==== (.+)\n", text, flags=re.MULTILINE)
    return dict(zip(parts[1::2], parts[2::2], strict=True))


def filled(section: str, /, **values: str) -> str:
    """A section of `templates.txt`, in which `{word}` is replaced by the value of this name."""
    return re.sub(r"\{(\w+)\}", lambda found: values.get(found[1], found[0]), sections("templates.txt")[section])


def forget_below(folders: Iterable[Path]) -> None:
    """Have the modules in these folders be imported anew, from what the files say now.

    Compiled files in the learner's folder are deleted, too: Python takes them for good if the source has the same size and
    second.
    """
    folders = tuple(folders)
    below = tuple(os.path.join(folder, "") for folder in folders)  # as texts: thousands of modules are slow as paths
    # Python notes each folder where it has looked for modules. Where it was none of these, no module need be looked at.
    looked_in = [place for place in sys.path_importer_cache if os.path.join(place, "").startswith(below)]
    if looked_in or any(str(folder.parent) in sys.path_importer_cache for folder in folders):
        for place in looked_in:
            del sys.path_importer_cache[place]
        for name, module in list(sys.modules.items()):
            file = getattr(module, "__file__", None)
            if isinstance(file, str) and file.startswith(below):
                del sys.modules[name]
    for folder in folders:
        for place, inner, _ in os.walk(folder):
            if "__pycache__" in inner:
                inner.remove("__pycache__")
                with suppress(PermissionError):
                    shutil.rmtree(files.check(Path(place, "__pycache__"), removes=True), ignore_errors=True)


# -- what can be wrong with a package, or with a name that was asked for, each said with what to try ---------------------

SHARE = "/opt/ros/humble/share"
"""Where the real build's own files are; named in the call stacks of its messages."""


class PackageError(ValueError):
    """A package cannot be read as it lies there, for a reason, in a line (from 1) of a file; `hint` says what to try."""

    def __init__(self, reason: str, file: Path | None = None, line: int | None = None, hint: str = "") -> None:
        where = shown_path(str(file)) if file else ""
        if line is not None:
            where += f", line {line}"
        text = f"{where}: {reason}" if where else reason
        super().__init__(f"{text}. {hint}" if hint else text)


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


def cmake_message(text: str, where: str, stack: Sequence[str] = (), kind: str = "Error") -> str:
    """`CMake Error at <where>:` and the text; the paragraphs of the text are separated by empty lines.

    The wrapping is CMake's: lines of at most 77 columns, indented by two, two spaces after a full stop, and lines that
    begin with a space left as they are.
    """
    lines = [f"CMake {kind} at {where}:" if where else f"CMake {kind}:"]
    for line in text.split("\n"):
        words = re.sub(r"\. ", ".  ", " ".join(line.split()))
        wrapped = textwrap.wrap(words, 75, break_long_words=False, break_on_hyphens=False)
        lines += [f"  {part}" for part in ([line] if line.startswith(" ") else wrapped)] or [""]
    if stack:
        lines += ["Call Stack (most recent call first):", *(f"  {call}" for call in stack)]
    return "\n".join(lines) + "\n\n"


def refused(text: str, where: str, hint: str = "", stack: Sequence[str] = (), *, seconds: float = 0.9) -> BuildFailure:
    """An error of CMake's at a place such as `CMakeLists.txt:12 (install)`."""
    return BuildFailure(cmake_message(text, where, stack), hint, seconds=seconds)


class _NotFoundError(LookupError):
    """Something that was asked for is not there. `text` is the real tool's, `hint` ours."""

    def __init__(self, text: str, hint: str = "") -> None:
        super().__init__(text)
        self.text = text
        self.hint = hint

    def __str__(self) -> str:
        return f"{self.text}. {self.hint}" if self.hint else self.text


class PackageNotFoundError(_NotFoundError, KeyError):
    """No package of this name is in the index (`ament_index_python` raises it under the same name).

    The text is the real one, quotation marks included, followed by what was perhaps meant.
    """

    def __str__(self) -> str:
        return f"{self.text!r}. {self.hint}" if self.hint else repr(self.text)


class ExecutableNotFoundError(_NotFoundError):
    """A package has no executable of this name."""


class LaunchFileNotFoundError(_NotFoundError):
    """A package has installed no launch file of this name, or several."""


class NotHereError(NotImplementedError):
    """A robot would start this, and the simulation cannot. A launch names it, and goes on without it."""

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
