"""A launch: it walks through a description and handles what happens; from a file to what a cell holds of its launch.

First the whole description is walked through, then the processes start, in order or as `World.start_order` draws them; so
a description with an error in it starts nothing. Events are handled one after the other, at the instant at which they happen.
"""

from __future__ import annotations

import math
import textwrap
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, redirect_stdout
from functools import cached_property
from itertools import count
from pathlib import Path
from types import SimpleNamespace
from typing import Any

from launch import Action, Event, LaunchContext, LaunchDescription, LaunchDescriptionEntity, LaunchDescriptionSource
from launch._context import as_entities
from launch._entities import described
from launch.actions import EmitEvent, ExecuteProcess, IncludeLaunchDescription
from launch.actions._processes import OUTPUT_OVERRIDE
from launch.events import IncludeLaunchDescription as Included
from launch.events import Shutdown
from launch.launch_description_sources import AnyLaunchDescriptionSource

from ..ament.index import LaunchedPackages, seeing
from ..ament.package import NotHereError
from ..idl.names import did_you_mean
from ..runtime.world import World, run_for
from ..sim.simulation import NANOSECONDS
from .errors import LaunchError, as_launch_error, learners_cause
from .processes import RosHelper, RunningProcess


class LaunchService:
    """Carries out one launch in a world."""

    def __init__(self, world: World) -> None:
        self.world = world
        self.context = LaunchContext()
        self.context._host = self
        self.processes: list[RunningProcess] = []
        """In the order of their start."""
        self.up_at = 0
        """The robot time, in ns, at which the last of the programs that have been started is up."""
        self.numbers = count(1)
        """What is after the dash in `navigator-1`."""
        self._waiting: list[ExecuteProcess] = []
        self._ending = False
        self._timers = 0
        self._warnings: set[str] = set()
        self._left_out: dict[LaunchDescriptionEntity, str] = {}
        self.failed = False
        """Whether an error has ended it."""

    @property
    def running(self) -> bool:
        """Whether a process runs, or something is still to come."""
        return any(process.alive for process in self.processes) or (self._timers > 0 and not self.context.is_shutdown)

    def start_process(self, action: ExecuteProcess) -> None:
        """Have an action's process started as soon as what is being walked through is done."""
        self._waiting.append(action)
        self.settle_soon()

    def ended(self, process: RunningProcess) -> None:
        """A process is dead: say how, and go on from there."""
        if not self._ending:
            process.report_end()
            self.call_later(0, process.after_end)  # leave the dying process first

    def _end_processes(self, *, said: bool) -> None:
        """Interrupt all processes, and see to it that they end. How they ended is said after all their output."""
        alive = [process for process in self.processes if process.alive]
        for process in reversed(alive) if said else ():
            process.announce("SIGINT")
        self._ending = True
        for process in alive:
            process.process.interrupt()
        self._ending = False
        for process in alive:
            if process.alive:
                process.terminate_later()
            else:
                process.report_end()
                process.after_end()

    def call_later(self, seconds: float, function: Callable[[], None]) -> None:
        """Have a function called after some robot time, within this launch. Raises ValueError if there is no such time."""
        if not 0 <= seconds < math.inf:
            raise ValueError(f"a launch can wait for a number of seconds from 0 up, not for {seconds}")

        def due() -> None:
            self._timers -= 1
            self.carry_on(function)

        self._timers += 1
        self.world.sim.call_later(round(seconds * NANOSECONDS), due)

    @cached_property
    def ros_helper(self) -> RosHelper:
        """The node of launch's own; it is made when it is first asked for."""
        return RosHelper(self)

    def settle_soon(self) -> None:
        """Have waiting starts and events handled at this instant."""
        self.world.sim.call_later(0, self.carry_on, lambda: None)

    def warn_once(self, text: str) -> None:
        """Print a warning of launch's own, unless this launch has printed it before."""
        if text not in self._warnings:
            self._warnings.add(text)
            self.say("WARNING", "launch", text)

    def line(self, text: str) -> None:
        """Print a line into the cell that is running, whichever process prints."""
        print(text, file=self.world.sim.cell_stdout)

    def say(self, level: str, name: str, text: str) -> None:
        """Print a line of launch's own, such as `[INFO] [launch]: …`."""
        self.line(f"[{level}] [{name}]: {text}")

    def begin(self, source: LaunchDescriptionSource, arguments: Mapping[str, object]) -> None:
        """Walk through a description and start its processes; warn of arguments that nothing takes.

        Raises LaunchError if something is wrong with it. If it is found while walking, nothing was started.
        """
        given = {  # as on a command line, where True is `true`
            name: str(value).lower() if isinstance(value, bool) else str(value) for name, value in arguments.items()
        }
        include = IncludeLaunchDescription(source, launch_arguments=given.items())
        include._written_at = None  # it stands in no launch file
        self.say("INFO", "launch", "Default logging verbosity is set to INFO")
        with self._inside():
            try:
                self.visit(include)
                # what waits for the end, say, of a program that is left out
                for handler in self.context._event_handlers:
                    target: Any = getattr(handler, "_target", None)
                    emits = all(isinstance(each, EmitEvent) for each in handler.entities)
                    if target in self._left_out and not emits:
                        what = f"{type(handler).__name__} of {self._left_out[target]}"
                        self.warn_once(f"{what} is left out, too, with what it starts")
                self._settle()
            except LaunchError as error:
                self.shut_down("an error in the launch file")
                raise error from learners_cause(error.__cause__)
        known = [argument.name for argument in source.get_launch_description(self.context).get_launch_arguments()]
        for name in given:  # the real tool says nothing
            if name not in known and name not in self.context._configurations_read:
                takes = f"It takes: {', '.join(known)}." if known else "It takes no arguments."
                what = f"nothing in this launch file takes the argument '{name}'"
                self.say("WARNING", "launch", f"{what}. {did_you_mean(name, known) or takes}")

    def carry_on(self, function: Callable[[], None]) -> None:
        """Do something that came later; an error in it ends the launch and is printed, as on a robot."""
        with self._inside():
            try:
                function()
                self._settle()
            except Exception as error:
                self.failed = True
                said = as_launch_error(error)
                for line in filter(None, (said.console, said.advice)):
                    self.line(line)
                self.shut_down("an error in the launch")

    def interrupt(self) -> None:
        """End it, as Ctrl-C in its terminal would."""
        self.say("WARNING", "launch", "user interrupted with ctrl-c (SIGINT)")
        self.shut_down("ctrl-c (SIGINT)", due_to_sigint=True)

    def shut_down(self, reason: str, *, due_to_sigint: bool = False) -> None:
        """End the whole launch."""
        self._waiting.clear()
        self.context._event_queue.append(Shutdown(reason=reason, due_to_sigint=due_to_sigint))
        self.carry_on(lambda: None)

    @contextmanager
    def _inside(self) -> Iterator[None]:
        """While something of this launch is done: its packages are seen, its prints go to the cell."""
        try:
            with seeing(LaunchedPackages(self.world.packages)), redirect_stdout(self.world.sim.cell_stdout):
                yield
        finally:
            if "ros_helper" in vars(self) and not self.running:
                self.ros_helper.close()

    def _settle(self) -> None:
        while self._waiting or self.context._event_queue:
            if self._waiting:
                drawn = self.world.start_order
                action = self._waiting.pop(0 if drawn is None else drawn.randrange(len(self._waiting)))
                self.processes.append(RunningProcess(self, action))
            else:
                self._handle(self.context._event_queue.popleft())

    def visit(self, entity: LaunchDescriptionEntity) -> None:
        """Carry out an entity and all that it gives, in order; what only a robot can start is named and left out.

        Raises LaunchError with the place in the launch file.
        """
        try:
            for inner in entity.visit(self.context) or []:
                self.visit(inner)
        except LaunchError:
            raise
        except NotHereError as error:
            self.warn_once(f"{error.what} is left out: {error.why}")
            self._left_out[entity] = error.what
        except Exception as error:
            place = entity._written_at if isinstance(entity, Action) else None
            raise as_launch_error(error, place) from error

    def _handle(self, event: Event) -> None:
        if isinstance(event, Shutdown):
            if self.context.is_shutdown:
                return
            self.context.is_shutdown = True
        if isinstance(event, Included):
            self.visit(event.launch_description)
        for handler in [known for known in self.context._event_handlers if known.matches(event)]:
            self.context._push("_locals")
            try:
                for entity in as_entities(handler.handle(event, self.context)):
                    self.visit(entity)
            finally:
                self.context._pop("_locals")
        if isinstance(event, Shutdown):
            self._end_processes(said=not event.due_to_sigint)


class LaunchHandle:
    """A running launch, and how to stop it. It is shown with the names of the programs that run, such as `navigator-1`."""

    def __init__(self, service: LaunchService, name: str) -> None:
        self._service: LaunchService | Any = service
        self.name = name
        service.world.at_close.append(self._let_go)

    def _let_go(self) -> None:
        """Keep nothing of the world that is closed: Jupyter's `Out` may keep this handle for long."""
        self._service = SimpleNamespace(processes=[], running=False)

    @property
    def running(self) -> bool:
        """Whether a process of it runs, or something in it is still to come."""
        return self._service.running

    def wait_until_up(self) -> None:
        """Let robot time pass until the programs that have been started so far are up, one after the other."""
        world = self._service.world
        run_for(world, max(0, self._service.up_at - world.now) / NANOSECONDS)
        world.sim.settle()

    def stop(self) -> None:
        """End it, as Ctrl-C in its terminal would. Does nothing if it has ended already."""
        if self.running:
            self._service.interrupt()

    def __repr__(self) -> str:
        alive = [entry.name for entry in self._service.processes if entry.alive]
        state = f"running: {', '.join(alive)}" if alive else "running" if self.running else "ended"
        return f"<Launch of {self.name}, {state}>"


def launch_file(
    world: World, path: Path | str, arguments: Mapping[str, object] | None = None, *, show_all_output: bool = False
) -> LaunchHandle:
    """Carry out a launch file, with its arguments as `name:=value` on a command line; values become text.

    Raises LaunchError if the file cannot be carried out; nothing was started then.
    """
    service = LaunchService(world)
    if show_all_output:
        service.context.environment[OUTPUT_OVERRIDE] = "both"
    source = AnyLaunchDescriptionSource(str(Path(path).resolve()))
    service.begin(source, arguments or {})
    return LaunchHandle(service, Path(path).name)


def launch_description(world: World, description: LaunchDescription) -> LaunchHandle:
    """Carry out a description that was made in a notebook cell. As `launch_file` otherwise."""
    service = LaunchService(world)
    service.begin(LaunchDescriptionSource(description), {})
    return LaunchHandle(service, "a description")


def show_arguments(world: World, path: Path | str) -> str:
    """What `ros2 launch … --show-args` prints. Raises LaunchError if the file cannot be loaded."""
    source = AnyLaunchDescriptionSource(str(path))
    try:
        with seeing(LaunchedPackages(world.packages)):
            arguments = source._get_launch_description(str(path)).get_launch_arguments()
    except Exception as error:
        raise as_launch_error(error) from learners_cause(error)
    parts = ["Arguments (pass arguments as '<name>:=<value>'):"]
    for argument in arguments:
        part = f"    '{argument.name}':\n{textwrap.indent(str(argument.description), '        ')}"
        default = argument.default_value
        parts.append(part + ("" if default is None else f"\n        (default: {described(default)})"))
    return "\n\n".join(parts if len(parts) > 1 else [*parts, "  No arguments."])
