"""The launch itself: walks through a description and handles what happens.

First the whole description is walked through, then the processes start, in order; so a description with an
error in it starts nothing. Events are handled one after the other, at the instant at which they happen.
"""

from __future__ import annotations

import asyncio
import time
from collections import deque
from collections.abc import Callable, Iterator
from contextlib import contextmanager, redirect_stdout
from itertools import count
from typing import TYPE_CHECKING, Any

from launch import Action, Event, LaunchContext, LaunchDescriptionEntity
from launch._context import as_entities
from launch.actions import EmitEvent
from launch.event_handlers import OnActionEventBase
from launch.events import IncludeLaunchDescription, Shutdown

from ..ament.errors import NotHereError
from ..ament.index import LaunchedPackages, seeing
from ..runtime.world import current_world
from ..sim.strand import running_strand
from .errors import LaunchError, hint_for, place_of, reason_of
from .processes import Processes, Screen

if TYPE_CHECKING:
    from launch.actions import ExecuteLocal

    from ..runtime.world import World
    from ..sim.process import Process


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


LOOKS_AGAIN = 0.01
"""How often, in s, it looks whether a node has its service by now."""


class RosHelper:
    """Listens to managed nodes and asks them for transitions; what it hears is told outside of its process."""

    def __init__(self, world: World, carry_on: Callable[[Callable[[], None]], None]) -> None:
        self._world = world
        self._carry_on = carry_on
        self._orders: list[Callable[[], None]] = []
        self._node: Any = None
        self._executor: Any = None
        self._clients: dict[str, Any] = {}
        self._ended = False
        self._process: Process = world.spawn(self._main, name="launch_ros", argv=["launch_ros"])

    def _main(self) -> None:
        import rclpy
        from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor

        rclpy.init(args=[])
        self._node = rclpy.create_node(f"launch_ros_{self._process.pid}", start_parameter_services=False)
        self._executor = SingleThreadedExecutor()
        self._executor.add_node(self._node)
        self._wakes = self._node.create_guard_condition(self._work)
        self._work()
        try:
            self._executor.spin()
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
            client = self._client(node_name, ChangeState)
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

    def _client(self, node_name: str, kind: Any) -> Any:
        if node_name not in self._clients:
            self._clients[node_name] = self._node.create_client(kind, f"{node_name}/change_state")
        return self._clients[node_name]

    def close(self) -> None:
        """End it."""
        self._ended = True
        if self._process.exit_code is None:
            self._process.kill()


LOOKS = 0.01
"""How often, in s of robot time, it looks whether the launch has ended."""


class LaunchByHand:
    """One launch in the world that the running code lives in."""

    def __init__(self, argv: list[str], noninteractive: bool) -> None:
        self._service = LaunchService(current_world(), {})
        self.context: LaunchContext = self._service.context
        self.context.argv = argv
        self.context.noninteractive = noninteractive
        self._early: deque[Event] = deque()
        self._began = False
        self._failed = False

    def emit(self, event: Event) -> None:
        """Emit an event; before the launch has begun, it waits."""
        if self._began:
            self.context.emit_event_sync(event)
        else:
            self._early.append(event)

    def run(self, shutdown_when_idle: bool) -> int:
        """Carry all out and wait for the end; the exit code."""
        if running_strand() is not None:
            return self._run(shutdown_when_idle)
        from rclpy._blocking import spin_live

        codes: list[int] = []
        spin_live(lambda: codes.append(self._run(shutdown_when_idle)))
        return codes[0] if codes else 0

    def _run(self, shutdown_when_idle: bool) -> int:
        self._begin()
        while self._goes_on(shutdown_when_idle):
            try:
                time.sleep(LOOKS)
            except KeyboardInterrupt:
                self._interrupted()
        return self._code()

    async def run_async(self, shutdown_when_idle: bool) -> int:
        """The same as a coroutine."""
        self._begin()
        while self._goes_on(shutdown_when_idle):
            await asyncio.sleep(LOOKS)
        return self._code()

    def _begin(self) -> None:
        self._began = True
        while self._early and not self._failed:
            try:
                self._service.begin(EmitEvent(event=self._early.popleft()))
            except LaunchError as error:
                self._failed = True
                for line in filter(None, (error.console, error.advice)):
                    self._service.screen.line(line)

    def _goes_on(self, shutdown_when_idle: bool) -> bool:
        service = self._service
        return service.running or not (shutdown_when_idle or self.context.is_shutdown)

    def _code(self) -> int:
        if not self.context.is_shutdown:
            self._service.shut_down("idle")
        self._began = False
        return 1 if self._failed or self._service.failed else 0

    def _interrupted(self) -> None:
        if not self.context.is_shutdown:
            self._service.screen.say("WARNING", "launch", "user interrupted with ctrl-c (SIGINT)")
            self._service.shut_down("ctrl-c (SIGINT)", due_to_sigint=True)

    def shut_down(self) -> None:
        """End it, if it runs."""
        if self._began and not self.context.is_shutdown:
            self._service.shut_down("LaunchService.shutdown() called")
