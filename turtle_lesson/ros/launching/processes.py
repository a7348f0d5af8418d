"""The processes of a launch: starting, signalling and ending one, and what reaches the screen; launch's own node."""

from __future__ import annotations

import io
import signal
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path, PurePath
from typing import TYPE_CHECKING, Any

import rclpy
from launch import Event
from launch.actions import ExecuteProcess
from launch.events.process import ProcessExited, ProcessIO, ProcessStarted
from launch.utilities import perform_substitutions
from lifecycle_msgs.msg import TransitionEvent
from lifecycle_msgs.srv import ChangeState
from rclpy.client import Client
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node

from ..ament.package import PythonProgram
from ..sim.process import Process

if TYPE_CHECKING:
    from .service import LaunchService

START_UP = 300_000_000
"""How long, in ns, a Python program takes from its process's start to its first line. Those of a launch take turns."""

RESPAWN_PAUSE = 0.25
"""How long, in s, a program that is not Python stays away when it respawns without a delay, so that robot time passes."""


class _Output(io.TextIOBase):
    """What a process prints to one of its streams: shown line by line, and told as events. `fd` is 1 or 2."""

    encoding = "utf-8"

    def __init__(self, process: RunningProcess, fd: int) -> None:
        self._process = process
        self._fd = fd
        self._shown = ("stdout" if fd == 1 else "stderr") in process.action._on_screen
        self._pending = ""

    def write(self, text: str) -> int:
        """Take text, and hand it on when it ends a line: what one print() gives is one piece."""
        self._pending += text
        if text.endswith("\n"):
            self.finish()
        return len(text)

    def finish(self) -> None:
        """Hand on what has been printed since the last time."""
        text, self._pending = self._pending, ""
        if text:
            self._process.emit(ProcessIO, text=text.encode(), fd=self._fd)
        for line in text.removesuffix("\n").split("\n") if text and self._shown else ():
            whole = line.removesuffix("\r")
            self._process.service.line(f"[{self._process.name}] {whole}")


class RunningProcess:
    """What launch knows about the process of one action."""

    def __init__(self, service: LaunchService, action: ExecuteProcess) -> None:
        self.service = service
        self.action = action
        self.name = action.name
        self.process: Process
        self._retries = 0
        self.start()

    @property
    def alive(self) -> bool:
        """Whether it runs."""
        return self.process.alive

    @property
    def _is_python(self) -> bool:
        """Whether a robot starts Python for it: a node of a package, a Python file, a `ros2` command."""
        program = self.action._program
        return isinstance(program.target, (Path, PythonProgram)) or PurePath(program.argv[0]).name == "ros2"

    def start(self) -> None:
        """Start it at this instant, unless the launch is ending; Python programs come up one after the other."""
        if self.service.context.is_shutdown:
            return
        program = self.action._program
        now = up_at = self.service.world.sim.now
        if self._is_python:
            up_at = self.service.up_at = max(self.service.up_at, now) + START_UP
        stdout, stderr = _Output(self, 1), _Output(self, 2)

        def on_exit(process: Process) -> None:
            stdout.finish()
            stderr.finish()
            self.service.ended(self)

        self.process = self.service.world.spawn(
            program.target,
            name=self.name.rpartition("-")[0],
            argv=program.argv,
            stdout=stdout,
            stderr=stderr,
            on_exit=on_exit,
            environ=self.action.process_details["env"],
            start_up=up_at - now,
        )
        self.action.process_details["pid"] = self.process.pid
        self.service.say("INFO", self.name, f"process started with pid [{self.process.pid}]")
        self.emit(ProcessStarted)

    def emit(self, kind: type[Event], **more: Any) -> None:
        """Let an event about it happen, if a handler waits for it."""
        context = self.service.context
        if context._event_handlers:
            event = kind(**self.action.process_details, **more)
            if context.would_handle_event(event):
                context.emit_event_sync(event)

    def report_end(self) -> None:
        """Print how it ended."""
        code = self.process.exit_code
        self.action.return_code = code
        if code == 0:
            self.service.say("INFO", self.name, f"process has finished cleanly [pid {self.process.pid}]")
        else:
            how = f"[pid {self.process.pid}, exit code {code}, cmd '{self.action._program.shown}']"
            self.service.say("ERROR", self.name, f"process has died {how}.")

    def after_end(self) -> None:
        """Inform the handlers that wait for its end; start it again if it respawns."""
        self.emit(ProcessExited, returncode=self.action.return_code or 0)
        self.action._complete(self.service.context)
        limit = self.action.respawn_max_retries
        if self.action._respawns and (limit < 0 or self._retries < limit) and not self.service.context.is_shutdown:
            self._retries += 1
            pause = self.action.respawn_delay or (0.0 if self._is_python else RESPAWN_PAUSE)
            self.service.call_later(pause, self.start)

    def announce(self, signal_name: str) -> None:
        """Say that a signal is sent to it."""
        self.service.say("INFO", self.name, f"sending signal '{signal_name}' to process[{self.name}]")

    def terminate_later(self) -> None:
        """Send SIGTERM, which a program may handle, if it is still alive some seconds after SIGINT."""
        patience = perform_substitutions(self.service.context, self.action.sigterm_timeout)

        def terminate() -> None:
            if not self.alive:
                return
            how = f"'{patience}' seconds after receiving 'SIGINT', escalating to 'SIGTERM'"
            self.service.say("ERROR", self.name, f"process[{self.name}] failed to terminate {how}")
            self.announce("SIGTERM")
            self.process.send_signal(signal.SIGTERM)

        self.service.call_later(float(patience), terminate)


LOOKS_AGAIN = 0.01
"""How often, in s, it looks whether a node has its service by now."""


class RosHelper:
    """Listens to managed nodes and asks them for transitions; what it hears is told outside of its process."""

    def __init__(self, service: LaunchService) -> None:
        self._service = service
        self._orders: list[Callable[[Node], object]] = []
        self._wake: Callable[[], None] = lambda: None
        self._clients: dict[str, Client] = {}
        self._process = service.world.spawn(self._main, name="launch_ros", argv=["launch_ros"])

    def _main(self) -> None:
        rclpy.init(args=[])
        node = rclpy.create_node(f"launch_ros_{self._process.pid}", start_parameter_services=False)

        def work() -> None:
            while self._orders:
                self._orders.pop(0)(node)

        self._wake = node.create_guard_condition(work).trigger
        work()
        with suppress(KeyboardInterrupt, ExternalShutdownException):
            rclpy.spin(node)

    def _order(self, order: Callable[[Node], object]) -> None:
        """Have something done in the helper's own process."""
        self._orders.append(order)
        self._wake()

    def watch(self, node_name: str, heard: Callable[[TransitionEvent], None]) -> None:
        """Have a function called with each TransitionEvent of a node."""

        def hear(event: TransitionEvent) -> None:
            self._service.call_later(0, lambda: heard(event))

        self._order(lambda node: node.create_subscription(TransitionEvent, f"{node_name}/transition_event", hear, 10))

    def change_state(self, node_name: str, transition_id: int, answered: Callable[[bool], None]) -> None:
        """Ask a node for a transition, as soon as it has the service; the function is called with the answer."""
        later = self._service.call_later

        def call(node: Node) -> None:
            if node_name not in self._clients:
                self._clients[node_name] = node.create_client(ChangeState, f"{node_name}/change_state")
            client = self._clients[node_name]
            request = ChangeState.Request()
            request.transition.id = transition_id

            def try_it() -> None:
                if client.service_is_ready():
                    node.destroy_timer(timer)
                    future = client.call_async(request)
                    future.add_done_callback(lambda done: later(0, lambda: answered(done.result().success)))

            timer = node.create_timer(LOOKS_AGAIN, try_it)  # waits without holding up what other nodes tell
            try_it()

        self._order(call)

    def close(self) -> None:
        """End it."""
        if self._process.alive:
            self._process.kill()
