"""The launch itself: walks through a description and handles what happens.

First the whole description is walked through, then the processes start, in order; so a description with an
error in it starts nothing. Events are handled one after the other, at the instant at which they happen.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager, redirect_stdout
from itertools import count
from typing import TYPE_CHECKING

from launch import Action, Event, LaunchContext, LaunchDescriptionEntity
from launch._context import as_entities
from launch.actions import EmitEvent
from launch.event_handlers import OnActionEventBase
from launch.events import IncludeLaunchDescription, Shutdown

from ..workspace.errors import NotHereError
from ..workspace.index import LaunchedPackages, seeing
from .errors import LaunchError, place_of, reason_of
from .hints import hint_for
from .output import Screen
from .processes import Processes
from .ros_helper import RosHelper

if TYPE_CHECKING:
    from launch.actions import ExecuteLocal

    from ..world import World

NANOSECONDS = 1_000_000_000


class LaunchService:
    """Carries out one launch in a world."""

    def __init__(self, world: World, given: dict[str, str]) -> None:
        self.world = world
        self.given = given
        self.screen = Screen(world)
        self.context = LaunchContext()
        self.context._host = self
        self.processes = Processes(self)
        self._numbers = count(1)
        self._waiting: list[ExecuteLocal] = []
        self._timers = 0
        self._settling = False
        self._helper: RosHelper | None = None
        self._said_level = False
        self._warnings: set[str] = set()
        self._left_out: dict[LaunchDescriptionEntity, str] = {}
        self.failed = False
        """Whether an error has ended it."""

    @property
    def running(self) -> bool:
        """Whether a process runs, or something is still to come."""
        return bool(self.processes.alive) or (self._timers > 0 and not self.context.is_shutdown)

    # -- what actions ask for (launch._host.Host) ---------------------------------------------------------

    def next_process_number(self) -> int:
        """The number after the dash in `navigator-1`."""
        return next(self._numbers)

    def start_process(self, action: ExecuteLocal) -> None:
        """Have an action's process started as soon as what is being walked through is done."""
        self._waiting.append(action)
        self.settle_soon()

    def call_later(self, seconds: float, function: Callable[[], None]) -> None:
        """Have a function called after some robot time, within this launch."""

        def due() -> None:
            self._timers -= 1
            self.carry_on(function)

        self._timers += 1
        self.world.sim.call_later(round(seconds * NANOSECONDS), due)

    def ros_helper(self) -> RosHelper:
        """The node of launch's own; it is made when it is first asked for."""
        if self._helper is None:
            self._helper = RosHelper(self.world, self.carry_on)
        return self._helper

    def settle_soon(self) -> None:
        """Have waiting starts and events handled at this instant, unless that is being done already."""
        if not self._settling:
            self.world.sim.call_later(0, self.carry_on, lambda: None)

    def warn_once(self, text: str) -> None:
        """Print a warning of launch's own, unless this launch has printed it before."""
        if text not in self._warnings:
            self._warnings.add(text)
            self.screen.say("WARNING", "launch", text)

    # -- running ------------------------------------------------------------------------------------------

    def begin(self, entity: LaunchDescriptionEntity) -> None:
        """Walk through a description and start its processes.

        Raises:
            LaunchError: if something is wrong with it. If it is found while walking, nothing was started.
        """
        if not self._said_level:
            self.screen.say("INFO", "launch", "Default logging verbosity is set to INFO")
            self._said_level = True
        with self._inside():
            try:
                self.visit(entity)
                self._warn_of_what_follows()
                self._settle()
            except LaunchError:
                self.shut_down("an error in the launch file")
                raise

    def _warn_of_what_follows(self) -> None:
        """Name what waits for the end, say, of a program that is left out, unless all that it does is to emit events."""
        for handler in self.context._event_handlers:
            target = handler._target_action if isinstance(handler, OnActionEventBase) else None
            if target in self._left_out and not all(isinstance(each, EmitEvent) for each in handler.describe()[1]):
                self.warn_once(
                    f"{type(handler).__name__} of {self._left_out[target]} is left out, too, with what it starts"
                )

    def carry_on(self, function: Callable[[], None]) -> None:
        """Do something that came later; an error in it ends the launch and is printed, as on a robot."""
        if self._settling:
            function()
            return
        with self._inside():
            try:
                function()
                self._settle()
            except Exception as error:
                self._fail(as_launch_error(error, None, self.given))

    def shut_down(self, reason: str, *, due_to_sigint: bool = False) -> None:
        """End the whole launch."""
        self._waiting.clear()
        self._settling = False
        self.context._event_queue.append(Shutdown(reason=reason, due_to_sigint=due_to_sigint))
        self.carry_on(lambda: None)

    @contextmanager
    def _inside(self) -> Iterator[None]:
        """While something of this launch is done: its packages are seen, its prints go to the cell."""
        self._settling = True
        try:
            with seeing(LaunchedPackages(self.world.packages)), redirect_stdout(self.world.sim.cell_stdout):
                yield
        finally:
            self._settling = False
            if self._helper is not None and not self.running:
                self._helper.close()

    def _fail(self, error: LaunchError) -> None:
        self.failed = True
        for line in filter(None, (error.console, error.advice)):
            self.screen.line(line)
        self.shut_down("an error in the launch")

    def _settle(self) -> None:
        while self._waiting or self.context._event_queue:
            if self._waiting:
                self.processes.add(self._waiting.pop(0))
            else:
                self._handle(self.context._event_queue.popleft())

    def visit(self, entity: LaunchDescriptionEntity) -> None:
        """Carry out an entity and all that it gives, in order; what only a robot can start is named and left out.

        Raises:
            LaunchError: with the place in the launch file.
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
            raise as_launch_error(error, place, self.given) from error

    def _handle(self, event: Event) -> None:
        if isinstance(event, Shutdown):
            if self.context.is_shutdown:
                return
            self.context._set_is_shutdown(True)
        if isinstance(event, IncludeLaunchDescription):
            self.visit(event.launch_description)
        for handler in [known for known in self.context._event_handlers if known.matches(event)]:
            self.context._push_locals()
            try:
                for entity in as_entities(handler.handle(event, self.context)):
                    self.visit(entity)
            finally:
                self.context._pop_locals()
        self.processes.react(event)


def as_launch_error(error: BaseException, written_at: tuple[str, int] | None, given: dict[str, str]) -> LaunchError:
    """The error as a learner should read it."""
    if isinstance(error, LaunchError):
        return error
    return LaunchError(reason_of(error), place_of(error, written_at), hint_for(error, given))
