"""Programs that a program starts: `subprocess`, `os.system` and `os.popen` run further processes of the world.

What they can start in it is what a launch file's ExecuteProcess can: `ros2 …`, Python files, echo, sleep. All else is run by
the computer itself, and takes no robot time; so it is for code outside simulated processes, except for `ros2 …` in a cell or
a launch file.
"""

from __future__ import annotations

import os
import re
import signal
import subprocess
import sys
from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, Any

from .child_streams import News, Pipe, stream_for
from .core import Process, Strand
from .core.patches import replace, replace_function
from .core.stdlib.home import notebook_here
from .core.strand import getcurrent

if TYPE_CHECKING:
    from .core.process import Output

_Real = subprocess.Popen
Plan = tuple[Any, list[str]]
"""A program's file or function, and its arguments."""


def install() -> None:
    """Put them in the place of the real ones; a second call changes nothing."""
    if subprocess.Popen is _Real:
        replace(subprocess, "Popen", ClassroomPopen)
        replace_function(os, "system", _system)


class ClassroomPopen(_Real):
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
            self._begin(plan, args, everything)

    def _begin(self, plan: Plan, args: Any, given: dict[str, Any]) -> None:
        from .world import current_process

        text = any(given.get(name) for name in ("text", "universal_newlines", "encoding", "errors"))
        _check(given)
        self.args, self.returncode, self.stdin = args, None, None
        self._ended = News()
        self._child_created, self._sigint_wait_secs = False, 0.0  # what the real one's __del__ and __exit__ ask for
        parent = current_process()
        out, self.stdout = stream_for(given.get("stdout"), parent.stdout, text)
        both = given.get("stderr") == subprocess.STDOUT
        err, self.stderr = (out, None) if both else stream_for(given.get("stderr"), parent.stderr, text)
        self._process = _start(plan, out, err, self._has_ended, given.get("env"))
        self.pid = self._process.pid
        if not any(given.get(name) for name in _OWN_TERMINAL):
            parent.followers.append(self._process)

    def _has_ended(self, process: Process) -> None:
        for pipe in (self.stdout, self.stderr):
            if isinstance(pipe, Pipe):
                pipe.end()
        self._ended.tell()

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
        if not self._ended.wait_for(lambda: self.poll() is not None, timeout):
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


ClassroomPopen.__name__ = "Popen"

_POSITIONAL = (
    "bufsize", "executable", "stdin", "stdout", "stderr", "preexec_fn", "close_fds", "shell", "cwd", "env",
)  # fmt: skip
"""The names of `Popen`'s arguments after the first, when they are given by their place."""


_OWN_TERMINAL = ("start_new_session", "preexec_fn", "process_group")
"""With any of these a child is out of reach of its parent's Ctrl-C (preexec_fn is os.setsid, as a rule)."""


def _check(given: dict[str, Any]) -> None:
    """Refuse what no simulated process can have."""
    if given.get("stdin") not in (None, subprocess.DEVNULL):
        raise NotImplementedError("stdin= is not available here: a program's child has no input")
    folder = given.get("cwd")
    if folder is not None and os.path.realpath(folder) != os.getcwd():
        raise NotImplementedError(
            "cwd= is not available here: a program's child works in the same folder as all programs"
        )


def _plan(args: Any, shell: bool) -> Plan | None:
    """How the world runs a command; None if the computer is to run it.

    Raises:
        NotImplementedError: for a command that the computer could not run, and the world cannot.
    """
    from .launching import commands
    from .workspace.errors import PackageNotFoundError

    words = _words(args, shell)
    line = " ".join(words)
    if not line.strip() or (type(getcurrent()) is not Strand and not _of_a_cell(line)):
        return None
    if line.startswith("ros2 launch ") and not (shell and set(line) & set(";&|<>")):
        words = line.split() if shell else words
        return partial(_launch, words[2:]), words
    try:
        program = commands.program(words, shell=shell)
    except (commands.UnknownCommand, PackageNotFoundError) as error:
        if shell and (parts := _PIPED.fullmatch(line)) and not _OF_THE_WORLD.search(parts[3]):
            return partial(_piped, parts[1], parts[3] if parts[2] == "|" else f"cat {parts[2]} {parts[3]}"), words
        if line.startswith("ros2 run "):
            return _failing(f"{error}"), words
        if _OF_THE_WORLD.search(line):
            raise NotImplementedError(_refusal(line, error)) from None
        return None
    return program.target, program.argv


def _of_a_cell(line: str) -> bool:
    """Whether a cell, or a launch file that it loads, runs a `ros2` command, which only the world has."""
    notebook = notebook_here()
    return notebook is not None and not notebook.simulation.running and line.split()[:1] == ["ros2"]


def _words(args: Any, shell: bool) -> list[str]:
    """A command's words; for a shell its text, without a setup file, as what it sets up is there already."""
    one = isinstance(args, (str, bytes, os.PathLike))
    words = [os.fsdecode(args)] if one else [os.fsdecode(word) for word in args][: 1 if shell else None]
    return [_SETUP.sub("", words[0])] if shell and words else words


_SETUP = re.compile(r"^\s*(?:(?:source|\.)\s+\S*setup\.\w+\s*(?:&&|;)\s*)+")
_PIPED = re.compile(r"(ros2 [^|<>;&]+)(\||>>?)([^|<>;&].*)", re.DOTALL)
_OF_THE_WORLD = re.compile(r"(?:^|[\s;&|('\"])(?:ros2|colcon|killall|pkill)\b")


def _start(
    plan: Plan, out: Output | None, err: Output | None, ended: Callable[[Process], None], environ: Any
) -> Process:
    from .world import current_world

    target, argv = plan
    name = os.path.basename(argv[0]) or "program"
    return current_world().spawn(target, name=name, argv=argv, stdout=out, stderr=err, on_exit=ended, environ=environ)


def _piped(first: str, rest: str) -> None:
    """A `ros2` command in the world, whose output the computer's commands read when it has ended."""
    said = ClassroomPopen(first, shell=True, stdout=subprocess.PIPE, text=True).communicate()[0]
    with _Real(rest, shell=True, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as reader:
        print(reader.communicate(said)[0], end="")
    sys.exit(reader.returncode)


def _refusal(line: str, error: Exception) -> str:
    hint = getattr(error, "hint", "")
    said = f"{error}" if not str(error).startswith("ExecuteProcess(") else "it is a program of the operating system"
    said = getattr(error, "why", said)
    return (
        f"{line!r} cannot be started by a program here ({said}): ros2 commands, Python files, echo and "
        f"sleep can. {hint}".strip()
    )


def _launch(words: list[str]) -> None:
    """`ros2 launch` as a program of its own, which goes on until its programs have ended."""
    from launch import LaunchDescription, LaunchService
    from launch.actions import IncludeLaunchDescription
    from launch.launch_description_sources import AnyLaunchDescriptionSource

    from .launching import find_launch_file
    from .launching.errors import LaunchError
    from .world import current_world

    given = [word.partition(":=") for word in words if ":=" in word]
    names = [word for word in words if ":=" not in word and not word.startswith("-")]
    try:
        path = find_launch_file(current_world(), *names) if len(names) == 2 else "".join(names)
    except LaunchError as error:
        print(error.console, file=sys.stderr)
        sys.exit(1)
    source = AnyLaunchDescriptionSource(str(path))
    service = LaunchService(argv=words)
    included = IncludeLaunchDescription(source, launch_arguments=[(name, value) for name, _, value in given])
    service.include_launch_description(LaunchDescription([included]))
    sys.exit(service.run())


def _failing(sentence: str) -> Callable[[], None]:
    """A command that only complains, as `ros2 run` does of a package that is not there."""

    def complain() -> None:
        print(sentence, file=sys.stderr)
        sys.exit(1)

    return complain


def _system(real: Any, command: Any) -> int:
    """`os.system`: run a shell's line, and wait for its end."""
    if _plan(command, shell=True) is None:
        return real(command)
    code = ClassroomPopen(command, shell=True).wait()
    return code << 8 if code >= 0 else -code


__all__ = ["ClassroomPopen", "install"]
