"""One process of a launch: its start, its output, its end, and whether it is started again."""

from __future__ import annotations

import signal
from pathlib import Path, PurePath
from typing import TYPE_CHECKING, Any

from ..workspace.package import PythonProgram
from .output import LineWriter, Screen

if TYPE_CHECKING:
    from launch.actions import ExecuteLocal

    from ..core import Process
    from ..world import World
    from .processes import Processes

TERMINATED = -15
"""The exit code of a process that was ended by SIGTERM, as launch prints it."""


class RunningProcess:
    """What launch knows about the process of one action."""

    def __init__(self, owner: Processes, screen: Screen, action: ExecuteLocal) -> None:
        self._owner = owner
        self._screen = screen
        self.action = action
        self.name = action.process_description.final_name
        self.process: Process | None = None
        self.retries = 0
        self._terminated = False
        self._writers: list[LineWriter] = []

    def __repr__(self) -> str:
        return f"<RunningProcess {self.name}, {'alive' if self.alive else 'ended'}>"

    @property
    def alive(self) -> bool:
        """Whether it runs."""
        return self.process is not None and self.process.exit_code is None

    @property
    def exit_code(self) -> int | None:
        """Its exit code, None while it runs."""
        if self.process is None or self.process.exit_code is None:
            return None
        return TERMINATED if self._terminated else self.process.exit_code

    def details(self) -> dict[str, Any]:
        """What its events carry."""
        return dict(self.action.process_details or {})

    @property
    def is_python(self) -> bool:
        """Whether a robot starts Python for it: a node of a package, a Python file, a `ros2` command."""
        program = self.action._program
        assert program is not None
        return isinstance(program.target, (Path, PythonProgram)) or PurePath(program.argv[0]).name == "ros2"

    def start(self, world: World, start_up: int) -> None:
        """Start it at this instant; its main program begins `start_up` ns later."""
        program = self.action._program
        assert program is not None and self.action.process_details is not None
        out, err = self._writer("stdout"), self._writer("stderr")
        self._writers = [out, err]
        self.process = world.spawn(
            program.target,
            name=self.name.rpartition("-")[0],
            argv=program.argv,
            stdout=out,
            stderr=err,
            on_exit=self._ended,
            environ=self.action.process_details["env"],
            start_up=start_up,
        )
        self.action.process_details["pid"] = self.process.pid
        self._screen.say("INFO", self.name, f"process started with pid [{self.process.pid}]")

    def _writer(self, stream: str) -> LineWriter:
        shown = stream in self.action._on_screen

        def on_line(line: str) -> None:
            if shown:
                self._screen.line(self.action.output_format.format(line=line, this=self.action))

        return LineWriter(on_line, lambda text: self._owner.printed(self, stream, text))

    def _ended(self, process: Process) -> None:
        for writer in self._writers:
            writer.finish()
        self._owner.ended(self)

    def last_words(self) -> None:
        """Print how it ended."""
        assert self.process is not None and self.action._program is not None
        self.action.return_code = self.exit_code
        pid = f"pid {self.process.pid}"
        if self.exit_code == 0:
            self._screen.say("INFO", self.name, f"process has finished cleanly [{pid}]")
        else:
            how = f"[{pid}, exit code {self.exit_code}, cmd '{self.action._program.shown}']"
            self._screen.say("ERROR", self.name, f"process has died {how}.")

    def wants_respawn(self) -> bool:
        """Whether it is to be started once more."""
        limit = self.action.respawn_max_retries
        return self.action._respawns and (limit < 0 or self.retries < limit)

    def signal(self, name: str) -> None:
        """Send SIGINT or SIGTERM, which a program may handle, or SIGKILL, which none survives."""
        if name not in {"SIGINT", "SIGTERM", "SIGKILL"}:
            raise NotImplementedError(f"{name} is not available here; SIGINT, SIGTERM and SIGKILL are")
        if self.process is None or not self.alive:
            return
        number = signal.Signals[name]
        if name == "SIGINT":
            self.process.interrupt()
        elif self.process.handles(number):
            self.process.send_signal(number)
        else:
            self._terminated = name == "SIGTERM"
            self.process.kill()
