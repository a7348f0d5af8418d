"""The processes of a launch: starting, signalling and ending them, and what reaches the screen; launch's own node."""

from __future__ import annotations

import io
import signal
from collections.abc import Callable, Iterator
from pathlib import Path, PurePath
from typing import TYPE_CHECKING, Any

from launch import Event
from launch.events import Shutdown
from launch.events.process import ProcessExited, ProcessIO, ProcessStarted
from launch.utilities import perform_substitutions

from ..ament.package import PythonProgram
from ..sim.strand import running_strand

if TYPE_CHECKING:
    from launch.actions import ExecuteProcess

    from ..runtime.world import World
    from ..sim.process import Process
    from .service import LaunchService


class LineWriter(io.TextIOBase):
    """A text stream that hands on whole lines; what has no end yet waits until `finish`."""

    encoding = "utf-8"

    def __init__(self, on_line: Callable[[str], None], on_text: Callable[[str], None]) -> None:
        super().__init__()
        self._on_line = on_line
        self._on_text = on_text
        self._rest = ""
        self._unheard = ""

    def writable(self) -> bool:
        """Always."""
        return True

    def write(self, text: str) -> int:
        """Take text; whole lines are handed on at once."""
        if not isinstance(text, str):
            raise TypeError(f"write() argument must be str, not {type(text).__name__}")
        self._unheard += text
        if text.endswith("\n"):  # what one print() gives is heard as one piece
            self._tell()
        *lines, self._rest = (self._rest + text).split("\n")
        for line in lines:
            self._on_line(line.removesuffix("\r"))
        return len(text)

    def finish(self) -> None:
        """Hand on what has no line end."""
        self._tell()
        rest, self._rest = self._rest, ""
        if rest:
            self._on_line(rest)

    def _tell(self) -> None:
        unheard, self._unheard = self._unheard, ""
        if unheard:
            self._on_text(unheard)


TERMINATED = -15
"""The exit code of a process that was ended by SIGTERM, as launch prints it."""

START_UP = 300_000_000
"""How long, in ns, a Python program takes from its process's start to its first line. Those of a launch take turns."""

RESPAWN_PAUSE = 0.25
"""How long, in s, a program that is not Python stays away when it respawns without a delay, so that robot time passes."""


class RunningProcess:
    """What launch knows about the process of one action."""

    def __init__(self, launch: Processes, action: ExecuteProcess) -> None:
        self._launch = launch
        self._service = launch.service
        self.action = action
        self.name = action.name
        self.process: Process | None = None
        self._retries = 0
        self._terminated = False

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

    @property
    def _is_python(self) -> bool:
        """Whether a robot starts Python for it: a node of a package, a Python file, a `ros2` command."""
        program = self.action._program
        assert program is not None
        return isinstance(program.target, (Path, PythonProgram)) or PurePath(program.argv[0]).name == "ros2"

    def say(self, level: str, text: str) -> None:
        """Print a line of launch's own about it."""
        self._service.say(level, self.name, text)

    def start(self) -> None:
        """Start it at this instant, unless the launch is ending; Python programs come up one after the other."""
        if self._service.context.is_shutdown:
            return
        program = self.action._program
        assert program is not None and self.action.process_details is not None
        streams = {"stdout": self._writer("stdout", 1), "stderr": self._writer("stderr", 2)}

        def on_exit(process: Process) -> None:
            for stream in streams.values():
                stream.finish()
            self._launch.ended(self)

        self.process = self._service.world.spawn(
            program.target,
            name=self.name.rpartition("-")[0],
            argv=program.argv,
            **streams,
            on_exit=on_exit,
            environ=self.action.process_details["env"],
            start_up=self._launch.next_start_up() if self._is_python else 0,
        )
        self.action.process_details["pid"] = self.process.pid
        self.say("INFO", f"process started with pid [{self.process.pid}]")
        self._emit(ProcessStarted)

    def _writer(self, stream: str, fd: int) -> LineWriter:
        shown = stream in self.action._on_screen

        def on_line(line: str) -> None:
            if shown:
                self._service.line(self.action.output_format.format(line=line, this=self.action))

        return LineWriter(on_line, lambda text: self._emit(ProcessIO, text=text.encode(), fd=fd))

    def _emit(self, kind: type[Event], **more: Any) -> None:
        """Let an event about it happen, if a handler waits for it."""
        context = self._service.context
        if context._event_handlers:
            event = kind(**(self.action.process_details or {}), **more)
            if context.would_handle_event(event):
                context.emit_event_sync(event)

    def last_words(self) -> None:
        """Print how it ended."""
        assert self.process is not None and self.action._program is not None
        self.action.return_code = self.exit_code
        pid = f"pid {self.process.pid}"
        if self.exit_code == 0:
            self.say("INFO", f"process has finished cleanly [{pid}]")
        else:
            how = f"[{pid}, exit code {self.exit_code}, cmd '{self.action._program.shown}']"
            self.say("ERROR", f"process has died {how}.")

    def after_end(self) -> None:
        """Inform the handlers that wait for its end; start it again if it respawns."""
        self._emit(ProcessExited, returncode=self.exit_code or 0)
        self.action._complete(self._service.context)
        limit = self.action.respawn_max_retries
        if self.action._respawns and (limit < 0 or self._retries < limit) and not self._service.context.is_shutdown:
            self._retries += 1
            pause = self.action.respawn_delay or (0.0 if self._is_python else RESPAWN_PAUSE)
            self._service.call_later(pause, self.start)

    def signal(self, name: str) -> None:
        """Send SIGINT or SIGTERM, which a program may handle, or SIGKILL, which none survives."""
        if name not in {"SIGINT", "SIGTERM", "SIGKILL"}:
            raise NotImplementedError(f"{name} is not available here; SIGINT, SIGTERM and SIGKILL are")
        if self.process is None or not self.alive:
            return
        if name == "SIGINT":
            self.process.interrupt()
        elif self.process.handles(signal.Signals[name]):
            self.process.send_signal(signal.Signals[name])
        else:
            self._terminated = name == "SIGTERM"
            self.process.kill()

    def announce(self, signal_name: str) -> None:
        """Say that a signal is sent to it."""
        self.say("INFO", f"sending signal '{signal_name}' to process[{self.name}]")

    def escalate_later(self) -> None:
        """Send SIGTERM if it is still alive some seconds after SIGINT."""
        patience = perform_substitutions(self._service.context, self.action.sigterm_timeout)

        def escalate() -> None:
            if self.alive:
                how = f"'{patience}' seconds after receiving 'SIGINT', escalating to 'SIGTERM'"
                self.say("ERROR", f"process[{self.name}] failed to terminate {how}")
                self.announce("SIGTERM")
                self.signal("SIGTERM")

        self._service.call_later(float(patience), escalate)


class Processes:
    """All processes of one launch, in the order of their start."""

    def __init__(self, service: LaunchService) -> None:
        self.service = service
        self._all: list[RunningProcess] = []
        self._ending: list[RunningProcess] | None = None
        self.up_at = 0
        """The robot time, in ns, at which the last of the programs that have been started is up."""

    def __iter__(self) -> Iterator[RunningProcess]:
        return iter(self._all)

    @property
    def alive(self) -> list[RunningProcess]:
        """Those that run."""
        return [process for process in self._all if process.alive]

    def add(self, action: ExecuteProcess) -> None:
        """Start an action's process."""
        if self.service.context.is_shutdown:
            return
        if action.cwd:
            self.service.warn_once("here all programs work in the notebook's folder, whatever cwd= says")
        if action.prefix_left_out:
            self.service.warn_once(f"{action.prefix_left_out} is left out: programs run here without a prefix")
        process = RunningProcess(self, action)
        self._all.append(process)
        process.start()

    def next_start_up(self) -> int:
        """How long the next Python program takes until it begins (ns), as they come up one after the other."""
        now = self.service.world.sim.now
        self.up_at = max(self.up_at, now) + START_UP
        return self.up_at - now

    def ended(self, process: RunningProcess) -> None:
        """A process is dead: say how, and go on from there."""
        if self._ending is not None:
            self._ending.append(process)
            return
        process.last_words()
        if running_strand() is None:
            self.service.carry_on(process.after_end)
        else:  # still within the dying process: leave it first
            self.service.world.sim.call_later(0, self.service.carry_on, process.after_end)

    def react(self, event: Event) -> None:
        """What launch itself does about an event."""
        if isinstance(event, Shutdown):
            self._end(self.alive, said=not event.due_to_sigint)

    def _end(self, processes: list[RunningProcess], *, said: bool) -> None:
        """Interrupt processes, and see to it that they end. Their last words come after all their output."""
        for process in reversed(processes) if said else ():
            process.announce("SIGINT")
        self._ending = []
        for process in processes:
            process.signal("SIGINT")
        ended, self._ending = self._ending, None
        for process in ended:
            process.last_words()
            process.after_end()
        for process in processes:
            if process.alive:
                process.escalate_later()


LOOKS_AGAIN = 0.01
"""How often, in s, it looks whether a node has its service by now."""


class RosHelper:
    """Listens to managed nodes and asks them for transitions; what it hears is told outside of its process."""

    def __init__(self, world: World, carry_on: Callable[[Callable[[], None]], None]) -> None:
        self._world = world
        self._carry_on = carry_on
        self._orders: list[Callable[[], None]] = []
        self._node: Any = None
        self._clients: dict[str, Any] = {}
        self._ended = False
        self._process: Process = world.spawn(self._main, name="launch_ros", argv=["launch_ros"])

    def _main(self) -> None:
        import rclpy
        from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor

        rclpy.init(args=[])
        self._node = rclpy.create_node(f"launch_ros_{self._process.pid}", start_parameter_services=False)
        executor = SingleThreadedExecutor()
        executor.add_node(self._node)
        self._wakes = self._node.create_guard_condition(self._work)
        self._work()
        try:
            executor.spin()
        except (KeyboardInterrupt, ExternalShutdownException):
            pass
        finally:
            rclpy.try_shutdown()

    def _work(self) -> None:
        """Carry the orders out, in the helper's own process."""
        while self._orders:
            self._orders.pop(0)()

    def _order(self, order: Callable[[], None]) -> None:
        self._orders.append(order)
        if self._node is not None:
            self._wakes.trigger()

    def _tell(self, function: Callable[[], None]) -> None:
        """Call a function of the launch, outside of this process and at this instant."""
        if not self._ended:
            self._world.sim.call_later(0, self._carry_on, function)

    def watch(self, node_name: str, heard: Callable[[Any], None]) -> None:
        """Have a function called with each TransitionEvent of a node."""
        from lifecycle_msgs.msg import TransitionEvent

        def subscribe() -> None:
            topic = f"{node_name}/transition_event"
            self._node.create_subscription(TransitionEvent, topic, lambda msg: self._tell(lambda: heard(msg)), 10)

        self._order(subscribe)

    def change_state(self, node_name: str, transition_id: int, answered: Callable[[bool], None]) -> None:
        """Ask a node for a transition, as soon as it has the service; the function is called with the answer."""
        from lifecycle_msgs.srv import ChangeState

        def call() -> None:
            if node_name not in self._clients:
                self._clients[node_name] = self._node.create_client(ChangeState, f"{node_name}/change_state")
            client = self._clients[node_name]
            if not client.service_is_ready():  # wait without holding up what other nodes tell
                timer: Any = self._node.create_timer(LOOKS_AGAIN, lambda: again(timer))
                return
            request = ChangeState.Request()
            request.transition.id = transition_id
            future = client.call_async(request)
            future.add_done_callback(lambda done: self._tell(lambda: answered(done.result().success)))

        def again(timer: Any) -> None:
            self._node.destroy_timer(timer)
            call()

        self._order(call)

    def close(self) -> None:
        """End it."""
        self._ended = True
        if self._process.exit_code is None:
            self._process.kill()
