"""Programs that a program starts: `subprocess`, `os.system` and `os.popen` run further processes of the world.

What they can start in it is what a launch file's ExecuteProcess can: `ros2 …`, Python files, echo, sleep. All else is run by
the computer itself, and takes no robot time; so it is for code outside simulated processes, except for `ros2 …` in a cell or
a launch file.
"""

from __future__ import annotations

import io
import os
import re
import signal
import subprocess
import sys
from collections.abc import Callable
from functools import partial
from typing import Any, NoReturn

from greenlet import getcurrent

from ..sim.process import Process
from ..sim.simulation import NANOSECONDS
from ..sim.strand import Strand, running_strand
from .ownership import notebook_here

_Real = subprocess.Popen
_STEP = 10_000_000  # how far (ns) the world is run between two looks, for a cell that waits


class WorldPopen(_Real):
    """`subprocess.Popen`: in a simulated process a further one, which runs in robot time."""

    __module__ = "subprocess"
    __qualname__ = "Popen"
    _simulated = _terminated = False

    def __init__(self, args: Any, *positional: Any, **given: Any) -> None:
        everything = {**dict(zip(_POSITIONAL, positional, strict=False)), **given}
        plan = _plan(args, bool(everything.get("shell")))
        if plan is None:
            super().__init__(args, *positional, **given)
        else:
            self._simulated = True
            self._begin(args, *plan, everything)

    def _begin(self, args: Any, target: Any, argv: list[str], given: dict[str, Any]) -> None:
        from ..runtime.world import current_process, current_world

        if given.get("stdin") not in (None, subprocess.DEVNULL):
            raise NotImplementedError("stdin= is not available here: a program's child has no input")
        if (folder := given.get("cwd")) is not None and os.path.realpath(folder) != os.getcwd():
            raise NotImplementedError(
                "cwd= is not available here: a program's child works in the same folder as all programs"
            )
        text = any(given.get(name) for name in ("text", "universal_newlines", "encoding", "errors"))
        self.args, self.returncode, self.stdin = args, None, None
        self._child_created, self._sigint_wait_secs = False, 0.0  # what the real one's __del__ and __exit__ ask for
        self._news = _Condition()
        parent = current_process()
        out, self.stdout = self._stream(given.get("stdout"), parent.stdout, text)
        both = given.get("stderr") == subprocess.STDOUT
        err, self.stderr = (out, None) if both else self._stream(given.get("stderr"), parent.stderr, text)
        self._process: Process = current_world().spawn(
            target, name=os.path.basename(argv[0]) or "program", argv=argv, stdout=out, stderr=err,
            on_exit=lambda process: self._news.notify_all(), environ=given.get("env"),
        )  # fmt: skip
        self.pid = self._process.pid
        if not any(given.get(name) for name in _OWN_TERMINAL):
            parent.followers.append(self._process)

    def _stream(self, wanted: Any, inherited: Any, text: bool) -> tuple[Any, Any]:
        """Where the child prints, and what its parent reads."""
        if wanted == subprocess.PIPE:
            pipe = _Pipe(text, self._news, lambda: self._process.exit_code is not None)
            return pipe, pipe
        if wanted == subprocess.DEVNULL:
            return _Writer(lambda text: None), None
        if isinstance(wanted, int):
            raise NotImplementedError("a file descriptor cannot be used here: give the file itself, or PIPE")
        if "b" in getattr(wanted, "mode", ""):
            return _Writer(lambda text: (wanted.write(text.encode()), wanted.flush())), None
        return inherited if wanted is None else wanted, None

    def poll(self) -> int | None:
        """The exit code, None while it runs."""
        if not self._simulated:
            return super().poll()
        if self.returncode is None and self._process.exit_code is not None:
            self.returncode = -signal.SIGTERM if self._terminated else self._process.exit_code
        return self.returncode

    def wait(self, timeout: float | None = None) -> int:
        """Wait for its end, at most `timeout` s of robot time."""
        if not self._simulated:
            return super().wait(timeout)
        if not self._news.wait_for(lambda: self.poll() is not None, timeout):
            raise subprocess.TimeoutExpired(self.args, timeout or 0.0)
        return self.returncode

    def communicate(self, input: Any = None, timeout: float | None = None) -> tuple[Any, Any]:
        """Wait for its end; what it printed to the pipes."""
        if not self._simulated:
            return super().communicate(input, timeout)
        if input:
            raise NotImplementedError("input= is not available here: a program's child has no input")
        self.wait(timeout)
        return (self.stdout and self.stdout.read(), self.stderr and self.stderr.read())

    def send_signal(self, sig: int) -> None:
        """Send it a signal; without a handler of its own SIGTERM and SIGKILL end it."""
        if not self._simulated:
            super().send_signal(sig)
        elif self.poll() is None:
            self._terminated = sig == signal.SIGTERM and not self._process.handles(sig)
            self._process.send_signal(sig)


WorldPopen.__name__ = "Popen"

_POSITIONAL = (
    "bufsize", "executable", "stdin", "stdout", "stderr", "preexec_fn", "close_fds", "shell", "cwd", "env",
)  # fmt: skip
"""The names of `Popen`'s arguments after the first, when they are given by their place."""

_OWN_TERMINAL = ("start_new_session", "preexec_fn", "process_group")
"""With any of these a child is out of reach of its parent's Ctrl-C (preexec_fn is os.setsid, as a rule)."""


class _Condition:
    """A condition variable of robot time: a program's thread waits; for a cell the world is run meanwhile."""

    def __init__(self) -> None:
        self._waiting: list[Strand] = []

    def notify_all(self) -> None:
        """Have all that wait look again."""
        for strand in self._waiting:
            strand.simulation.wake(strand)

    def wait_for(self, predicate: Callable[[], bool], seconds: float | None = None) -> bool:
        """Wait until the predicate holds, at most some seconds of robot time; whether it does."""
        from ..runtime.world import current_world

        strand, simulation = running_strand(), current_world().sim
        deadline = None if seconds is None else simulation.now + round(seconds * NANOSECONDS)
        if strand is not None:
            self._waiting.append(strand)
            if deadline is not None:
                simulation.at(deadline, simulation.wake, strand)
        try:
            while not predicate():
                if deadline is not None and simulation.now >= deadline:
                    return False
                if strand is None:
                    simulation.run_until(simulation.now + _STEP)
                else:
                    simulation.park(strand)
            return True
        finally:
            if strand is not None:
                self._waiting.remove(strand)


class _Writer(io.TextIOBase):
    """Hands on what a child prints."""

    def __init__(self, take: Callable[[str], object]) -> None:
        self._take = take

    def write(self, text: str) -> int:
        self._take(text)
        return len(text)


class _Pipe(io.TextIOBase):
    """What a child prints, for its parent to read: lines as they come, and all when it has ended."""

    def __init__(self, text: bool, news: _Condition, has_ended: Callable[[], bool]) -> None:
        self._text, self._news, self._has_ended = text, news, has_ended
        self._pending = ""

    def write(self, text: str) -> int:
        self._pending += text
        self._news.notify_all()
        return len(text)

    def read(self, size: int | None = -1) -> Any:
        """All, once the child has ended."""
        self._news.wait_for(self._has_ended)
        return self._taken(len(self._pending))

    def readline(self, size: int = -1) -> Any:  # type: ignore[override]
        """The next line, as soon as there is one."""
        self._news.wait_for(lambda: self._has_ended() or "\n" in self._pending)
        return self._taken((self._pending.find("\n") + 1) or len(self._pending))

    def _taken(self, count: int) -> str | bytes:
        taken, self._pending = self._pending[:count], self._pending[count:]
        return taken if self._text else taken.encode()

    def __next__(self) -> Any:
        if line := self.readline():
            return line
        raise StopIteration


_SETUP = re.compile(r"^\s*(?:(?:source|\.)\s+\S*setup\.\w+\s*(?:&&|;)\s*)+")
_OF_THE_WORLD = re.compile(r"(?:^|[\s;&|('\"])(?:ros2|colcon|killall|pkill)\b")


def _plan(args: Any, shell: bool) -> tuple[Any, list[str]] | None:
    """The program's file or function, by which the world runs a command, and its arguments; None if the computer is to.

    Raises:
        NotImplementedError: for a command that the computer could not run, and the world cannot.
    """
    from ..ament.errors import PackageNotFoundError
    from ..launching import commands

    one = isinstance(args, (str, bytes, os.PathLike))
    words = [os.fsdecode(args)] if one else [os.fsdecode(word) for word in args][: 1 if shell else None]
    if shell and words:
        words[0] = _SETUP.sub("", words[0])  # what a setup file sets up is there already
    line = " ".join(words)
    if not line.strip() or (type(getcurrent()) is not Strand and not _of_a_cell(line)):
        return None
    if line.startswith("ros2 launch ") and not (shell and set(line) & set(";&|<>")):
        words = line.split() if shell else words
        return partial(_launch, words[2:]), words
    try:
        program = commands.program(words, shell=shell)
    except (commands.UnknownCommand, PackageNotFoundError) as error:
        if line.startswith("ros2 run "):  # which only complains
            return partial(_fail, f"{error}"), words
        if _OF_THE_WORLD.search(line):
            raise NotImplementedError(_refusal(line, error)) from None
        return None
    return program.target, program.argv


def _of_a_cell(line: str) -> bool:
    """Whether a cell, or a launch file that it loads, runs a `ros2` command, which only the world has."""
    notebook = notebook_here()
    return notebook is not None and not notebook.simulation.running and line.split()[:1] == ["ros2"]


def _refusal(line: str, error: Exception) -> str:
    said = f"{error}" if not str(error).startswith("ExecuteProcess(") else "it is a program of the operating system"
    why = f"{line!r} cannot be started by a program here ({getattr(error, 'why', said)})"
    return f"{why}: ros2 commands, Python files, echo and sleep can. {getattr(error, 'hint', '')}".strip()


def _launch(words: list[str]) -> None:
    """`ros2 launch` as a program of its own, which goes on until its programs have ended."""
    from launch import LaunchDescription, LaunchService
    from launch.actions import IncludeLaunchDescription
    from launch.launch_description_sources import AnyLaunchDescriptionSource

    from ..launching import find_launch_file
    from ..launching.errors import LaunchError
    from ..runtime.world import current_world

    given = [(name, value) for name, sign, value in (word.partition(":=") for word in words) if sign]
    names = [word for word in words if ":=" not in word and not word.startswith("-")]
    try:
        path = find_launch_file(current_world(), *names) if len(names) == 2 else "".join(names)
    except LaunchError as error:
        _fail(error.console)
    source = AnyLaunchDescriptionSource(str(path))
    service = LaunchService(argv=words)
    service.include_launch_description(LaunchDescription([IncludeLaunchDescription(source, launch_arguments=given)]))
    sys.exit(service.run())


def _fail(sentence: str) -> NoReturn:
    """End the program with a complaint."""
    print(sentence, file=sys.stderr)
    sys.exit(1)


def system(real: Any, command: Any) -> int:
    """`os.system`: run a shell's line, and wait for its end."""
    if _plan(command, shell=True) is None:
        return real(command)
    code = WorldPopen(command, shell=True).wait()
    return code << 8 if code >= 0 else -code


__all__ = ["WorldPopen", "system"]
