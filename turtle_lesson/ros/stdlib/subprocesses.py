"""Programs that a program starts: `subprocess`, `os.system` and `os.popen` run further processes of the world.

What they can start in it is what a launch file's ExecuteProcess can: `ros2 …`, Python files, echo, sleep. All else is run by
the computer itself, and takes no robot time; so it is for code outside simulated processes, except for `ros2 …` in a cell or
a launch file. Other processes of the real computer would run beside virtual time, and the loops of windows would hold it up:
both are refused.
"""

from __future__ import annotations

import codecs
import io
import os
import subprocess
from collections.abc import Callable
from inspect import signature
from typing import Any

from .. import hooks
from ..sim.process import Process
from ..sim.simulation import NANOSECONDS, NEVER
from ..sim.strand import running_strand

_Real = subprocess.Popen
_SIGNATURE = signature(_Real)
_STEP = 1_000_000  # how far (ns) the world goes on between two looks at a child, as the real Popen.wait looks


class WorldPopen(_Real):
    """`subprocess.Popen`: in a simulated process a further one, which runs in robot time."""

    __module__ = "subprocess"
    __qualname__ = "Popen"
    _process: Process | None = None  # which runs the child in the world; None for one of the computer

    def __init__(self, args: Any, *positional: Any, **given: Any) -> None:
        everything = _SIGNATURE.bind(args, *positional, **given).arguments
        plan = hooks.plan_child(args, bool(everything.get("shell")))
        if plan is None:
            super().__init__(args, *positional, **given)
        else:
            self._begin(args, *plan, everything)

    def _begin(self, args: Any, target: Any, argv: list[str], given: dict[str, Any]) -> None:
        if given.get("stdin") not in (None, subprocess.DEVNULL):
            raise NotImplementedError("stdin= and input= are not available here: a program's child has no input")
        if (folder := given.get("cwd")) is not None and os.path.realpath(folder) != os.getcwd():
            raise NotImplementedError(
                "cwd= is not available here: a program's child works in the same folder as all programs"
            )
        text = any(given.get(name) for name in ("text", "universal_newlines", "encoding", "errors"))
        self.args, self.returncode, self.stdin = args, None, None
        self._child_created, self._sigint_wait_secs = False, 0.0  # what the real one's __del__ and __exit__ ask for
        parent = hooks.current_process()
        out, self.stdout = self._stream(given.get("stdout"), parent.stdout, text)
        both = given.get("stderr") == subprocess.STDOUT
        err, self.stderr = (out, None) if both else self._stream(given.get("stderr"), parent.stderr, text)
        self._process = hooks.current_world().spawn(
            target, name=os.path.basename(argv[0]) or "program", argv=argv, stdout=out, stderr=err, environ=given.get("env")
        )  # fmt: skip
        self.pid = self._process.pid
        if not any(given.get(name) for name in ("start_new_session", "preexec_fn", "process_group")):
            parent.followers.append(self._process)  # else Ctrl-C does not reach it (preexec_fn is os.setsid, as a rule)

    def _stream(self, wanted: Any, inherited: Any, text: bool) -> tuple[Any, Any]:
        """Where the child prints, and what its parent reads."""
        if wanted == subprocess.PIPE:
            pipe = _Pipe(text, lambda: self.poll() is not None)
            return pipe, pipe
        if wanted == subprocess.DEVNULL:
            return io.StringIO(), None
        if isinstance(wanted, int):
            raise NotImplementedError("a file descriptor cannot be used here: give the file itself, or PIPE")
        if "b" in getattr(wanted, "mode", ""):
            return codecs.getwriter("utf-8")(wanted), None
        return inherited if wanted is None else wanted, None

    def poll(self) -> int | None:
        """The exit code, None while it runs."""
        if self._process is None:
            return super().poll()
        if self.returncode is None and self._process.exit_code is not None:
            self.returncode = self._process.exit_code
        return self.returncode

    def wait(self, timeout: float | None = None) -> int:
        """Wait for its end, at most `timeout` s of robot time."""
        if self._process is None:
            return super().wait(timeout)
        if not _wait_until(lambda: self.poll() is not None, timeout):
            raise subprocess.TimeoutExpired(self.args, timeout or 0.0)
        return self.returncode

    def communicate(self, input: Any = None, timeout: float | None = None) -> tuple[Any, Any]:
        """Wait for its end; what it printed to the pipes."""
        if self._process is None:
            return super().communicate(input, timeout)
        self.wait(timeout)
        return (self.stdout and self.stdout.read(), self.stderr and self.stderr.read())

    def send_signal(self, sig: int) -> None:
        """Send it a signal; without a handler of its own SIGTERM and SIGKILL end it."""
        if self._process is None:
            super().send_signal(sig)
        elif self.poll() is None:
            self._process.send_signal(sig)


WorldPopen.__name__ = "Popen"


def _wait_until(predicate: Callable[[], bool], seconds: float | None = None) -> bool:
    """Let robot time pass until the predicate holds, at most so many seconds; whether it does."""
    simulation = hooks.current_world().sim
    go_on = simulation.run_until if running_strand() is None else simulation.sleep_until
    deadline = NEVER if seconds is None else simulation.now + round(seconds * NANOSECONDS)
    while not predicate():
        if simulation.now >= deadline:
            return False
        go_on(min(simulation.now + _STEP, deadline))
    return True


class _Pipe(io.TextIOBase):
    """What a child prints, for its parent to read: lines as they come, and all when it has ended."""

    def __init__(self, text: bool, has_ended: Callable[[], bool]) -> None:
        self._text, self._has_ended = text, has_ended
        self._pending = ""

    def write(self, text: str) -> int:
        self._pending += text
        return len(text)

    def read(self, size: int | None = -1) -> Any:
        """All, once the child has ended."""
        _wait_until(self._has_ended)
        return self._taken(len(self._pending))

    def readline(self, size: int = -1) -> Any:  # type: ignore[override]
        """The next line, as soon as there is one."""
        _wait_until(lambda: "\n" in self._pending or self._has_ended())
        return self._taken((self._pending.find("\n") + 1) or len(self._pending))

    def _taken(self, count: int) -> str | bytes:
        taken, self._pending = self._pending[:count], self._pending[count:]
        return taken if self._text else taken.encode()


def system(real: Any, command: Any) -> int:
    """`os.system`: run a shell's line, and wait for its end."""
    if hooks.plan_child(command, True) is None:
        return real(command)
    code = WorldPopen(command, shell=True).wait()
    return code << 8 if code >= 0 else -code


# -- what a simulated process cannot have ------------------------------------------------------------------------------

WINDOWS = ("PyQt5", "PyQt6", "PySide2", "PySide6", "customtkinter", "kivy", "pygame", "wx")
"""The modules of window toolkits. (tkinter is imported by mistake so often, by editors, that only its window is refused.)"""

NO_WINDOW = "{} opens windows, and a program here has no screen for them: lesson.dashboard() may show the same"


def refuse_toolkit(name: str) -> None:
    """Refuse the import of a window toolkit by a program, installed or not, by ImportError."""
    raise ImportError(NO_WINDOW.format(name), name=name)


def first_window(real: Any, self: Any, *arguments: Any, **keywords: Any) -> None:
    """`tkinter.Tk.__init__`, which refuses a simulated process its first window."""
    if running_strand() is not None:
        raise RuntimeError(NO_WINDOW.format("tkinter"))
    real(self, *arguments, **keywords)


OF_THE_COMPUTER = {
    "_thread": "start_new_thread",
    "os": "fork forkpty",
    "signal": "alarm pause pthread_kill set_wakeup_fd setitimer sigtimedwait sigwait sigwaitinfo",
}
"""By module, the functions that are refused."""


def not_here(what: str) -> NotImplementedError:
    """Why a simulated process cannot have processes, threads and alarms of the computer."""
    return NotImplementedError(
        f"{what} is not possible here: what the computer itself runs knows nothing about the simulation and its time. "
        "Threads can be used (threading, concurrent.futures.ThreadPoolExecutor), further nodes by a launch file, timers, "
        "signal.signal and os.kill."
    )


def start(real: Any, self: Any) -> None:
    """`multiprocessing.Process.start`, which is what all of multiprocessing comes down to."""
    if running_strand() is not None:
        raise not_here("multiprocessing")
    real(self)
