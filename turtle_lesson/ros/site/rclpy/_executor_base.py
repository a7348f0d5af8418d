"""What all executors have in common: they know nodes, choose what is next, and run it.

One *cycle* takes everything that is ready at that moment and runs one callback of each: first actions, QoS events and
tasks that can go on, then node by node timers, subscriptions, guard conditions, clients and services, each kind in order
of creation. What becomes ready meanwhile waits for the next cycle. These are the rules of rclpy's executors.py; but where
the real one builds a wait set for every cycle, entities here signal their executor, so that nothing is ever polled.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from operator import attrgetter
from typing import TYPE_CHECKING, Any

from turtle_lesson.ros.distro import TASKS_IN_ORDER
from turtle_lesson.ros.runtime.world import current_process, current_world
from turtle_lesson.ros.sim.strand import Strand

from ._entity import NO_TURN, WAITABLE, Entity
from ._hints import explain_call, no_node
from ._tracing import begin_task, note_end, trace_entity
from .context import Context
from .exceptions import not_valid, refuse_destroyed
from .task import Future, Task
from .utilities import get_default_context

if TYPE_CHECKING:
    from .node import Node

Job = Any  # an Entity, or a Task
Condition = Callable[[], bool] | None


class TimeoutException(Exception):
    """Nothing became ready in time."""

    __module__ = "rclpy.executors"


class ShutdownException(Exception):
    """The executor was shut down."""

    __module__ = "rclpy.executors"


class ExternalShutdownException(Exception):
    """The context was shut down while the executor was waiting."""

    __module__ = "rclpy.executors"


class ConditionReachedException(Exception):
    """What was waited for has happened."""

    __module__ = "rclpy.executors"


class TimeoutObject:
    """A timeout (s) that can be changed while somebody has it."""

    __module__ = "rclpy.executors"
    timeout: float

    def __init__(self, timeout: float) -> None:
        self.timeout = timeout


class ExecutorBase:
    """Nodes, tasks, what is ready, and running it."""

    def __init__(self, *, context: Context | None = None) -> None:
        self._context = get_default_context() if context is None else context
        self._simulation = current_world().sim
        self._trace = current_world().trace
        self._process = current_process()
        self._nodes: list[Node] = []
        self._nodes_seen = 0
        self._signalled: deque[Entity] = deque()
        self._batch: list[Job] = []
        self._resumed: list[Task] = []
        self._polled: list[Task] = []  # whose coroutine only let others go first, as with asyncio.sleep(0)
        self._must_look = True  # there may be more to do than to run the callbacks of what has signalled
        self._has_polled = False  # nothing has happened since they last looked
        self._blocked: list[Entity] = []
        self._waiter: Strand | None = None  # the strand that a signal wakes: the last that began to wait
        self._waiters: list[Strand] = []
        self._make_ready = self._simulation.make_ready
        self._tasks_in_order = current_world().release.has(TASKS_IN_ORDER)
        self._tasks_made = 0
        self._spinning: list[Strand] = []
        self._spinning_forever: list[Strand] = []  # strands in `spin`, which do nothing else before the shutdown
        self._calls: list[Future] = []  # for what strands wait, without a timeout, in Client.call
        self._is_shutdown = False
        self._context.wake_on_shutdown(self.wake)

    @property
    def context(self) -> Context:
        """The context whose shutdown ends the spinning."""
        return self._context

    # -- nodes ---------------------------------------------------------------------------------------------------

    def add_node(self, node: Node) -> bool:
        """Run this node's callbacks from now on; False if it does so already. A node has one executor at a time."""
        if node in self._nodes:
            return False
        if not hasattr(node, "_ros_waiting_entities"):
            raise no_node(node)
        if node._ros_simulation.closed:
            refuse_destroyed(node._ros_simulation)
        if not self._context.initialized:
            raise not_valid("guard_condition")
        if node._ros_executor is not None:
            node._ros_executor.remove_node(node)
        self._nodes.append(node)
        node._ros_executor = self  # type: ignore[assignment]
        comes_again = node._ros_place == (self, self._nodes_seen)  # as it does with each rclpy.spin_once
        if not comes_again:
            self._nodes_seen += 1
            node._ros_place = (self, self._nodes_seen)
        assignment = node._ros_assignment
        assignment.executor = self  # type: ignore[assignment]
        if assignment.missed or not comes_again:
            looked_at = list(assignment.missed) if comes_again else list(node._ros_waiting_entities)
            assignment.missed.clear()
            for entity in looked_at:
                if comes_again and entity._turn is not NO_TURN:
                    entity._signal()
                else:
                    self._adopt(entity, node)
        return True

    def _adopt(self, entity: Entity, node: Node) -> None:
        entity._turn = (0 if entity._kind == WAITABLE else node._ros_place[1], entity._kind, entity._number)
        if self._trace is not None:
            trace_entity(entity, node, self._trace)
        if entity._has_work():
            entity._signal()

    def remove_node(self, node: Node) -> None:
        """No longer run this node's callbacks."""
        if node in self._nodes:
            self._nodes.remove(node)
            node._ros_executor = None
            node._ros_assignment.executor = None

    def get_nodes(self) -> list[Node]:
        """The nodes of this executor, in the order in which they were added."""
        return list(self._nodes)

    # -- tasks ---------------------------------------------------------------------------------------------------

    def create_task(self, callback: Any, *args: Any, **kwargs: Any) -> Task:
        """Have a function called, or a coroutine run, by this executor; the task is a future of its result."""
        task = self._number(Task(callback, args, kwargs, executor=self))  # type: ignore[arg-type]
        self._resume_task(task)
        return task

    def _number(self, task: Task) -> Task:
        self._tasks_made += 1
        task._number = self._tasks_made
        return task

    def create_future(self) -> Future:
        """A future whose callbacks this executor calls."""
        return Future(executor=self)  # type: ignore[arg-type]

    def _resume_task(self, task: Task) -> None:
        self._resumed.append(task)
        self.wake()

    def wake(self) -> None:
        """Have a waiting `spin_once` look again at what it waits for."""
        self._must_look = True
        if self._waiter is not None:
            self._simulation.wake(self._waiter)

    # -- choosing ------------------------------------------------------------------------------------------------

    def _next(self, strand: Strand, deadline: int | None, condition: Condition) -> Job | None:
        """The next thing to run, its callback group taken; None at the deadline (ns) or when the condition holds."""
        while True:
            batch = self._batch
            while batch:
                job = batch.pop()
                if job.__class__ is Task:
                    if not job._done:
                        return job
                elif job._assigned.executor is not self:
                    job._assigned.missed[job] = None
                elif job._has_work():
                    if job._begin(job):
                        return job
                    self._blocked.append(job)
            if condition is not None and condition():
                return None
            if self._signalled or self._resumed or (self._polled and not self._has_polled):
                self._begin_cycle()
                continue
            if self._is_shutdown or not self._context.ok():
                self._raise_shutdown()
            if deadline is not None and self._simulation.now >= deadline:
                if not self._polled:
                    return None
                self._begin_cycle()
                continue
            self._wait(strand, deadline)

    def _begin_cycle(self) -> None:
        """Take all that is ready now as the next batch; the one before is done."""
        self._must_look = True
        self._has_polled = not self._signalled and not self._resumed
        batch = self._batch
        batch += sorted(self._signalled, key=attrgetter("_turn"), reverse=True)
        for entity in batch:
            entity._listed_in = None
        self._signalled.clear()
        if self._resumed or self._polled:
            tasks = [*self._polled, *self._resumed]
            batch += reversed(tasks) if self._tasks_in_order else sorted(tasks, key=attrgetter("_number"))
            self._polled.clear()
            self._resumed.clear()

    def _raise_shutdown(self) -> None:
        raise ShutdownException if self._is_shutdown else ExternalShutdownException

    def _wait(self, strand: Strand, deadline: int | None) -> None:
        simulation = self._simulation
        if deadline is not None:
            simulation.at(deadline, simulation.wake, strand)
        waiters = self._waiters
        waiters.append(strand)
        self._waiter = strand
        try:
            simulation.park(strand)
        finally:
            waiters.remove(strand)
            self._waiter = waiters[-1] if waiters else None

    def _begin_waiting(self, strand: Strand) -> None:
        self._waiters.append(strand)
        self._waiter = strand

    def _end_waiting(self, strand: Strand) -> None:
        self._waiters.remove(strand)
        self._waiter = self._waiters[-1] if self._waiters else None

    # -- running -------------------------------------------------------------------------------------------------

    def _execute(self, job: Job) -> None:
        """Run a job, whose callback group has been taken, in this strand."""
        if job.__class__ is Task:
            self._run_task(job)
        elif job._is_async:
            self._run_task(self._as_task(job))
        else:
            job._run(self, True)

    def _retry_blocked(self) -> None:
        """Look again at the entities that waited for a callback group."""
        blocked, self._blocked = self._blocked, []
        for waiting in blocked:
            waiting._signal()

    def _as_task(self, entity: Any) -> Task:
        traced = entity._traced
        begun = None if traced is None else begin_task(entity, traced, self._simulation.now)
        task = self._number(Task(_call_and_await, (entity, entity._take()), executor=self))  # type: ignore[arg-type]
        task._entity, task._node = entity, entity._node

        def free() -> None:
            entity._end_run(entity)
            self._retry_blocked()

        task._finally = free
        if traced is not None and begun is not None:
            note_end(task, traced, begun, self._simulation)
        return task

    def _run_task(self, task: Task) -> None:
        task()
        if task._done and task._exception is not None:
            raise task._exception_fetched()


async def _call_and_await(entity: Any, arguments: tuple[Any, ...] | None) -> None:
    if arguments is not None:
        try:
            result = entity.callback(*arguments)
        except TypeError as error:
            explain_call(entity, arguments, error)
            raise
        if entity._is_async:
            result = await result
        if entity._answers:
            entity._done_with(arguments, result)
