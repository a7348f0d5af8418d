"""Executors: they wait until callbacks are ready, and run them.

One *cycle* takes everything that is ready at that moment and runs one callback of each: first tasks that can go on,
then node by node timers, subscriptions, guard conditions, clients and services, each kind in order of creation. What
becomes ready meanwhile waits for the next cycle. These are the rules of rclpy's executors.py; but where the real one
builds a wait set for every cycle, entities here signal their executor, so that nothing is ever polled.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from turtle_lesson.ros.core import NANOSECONDS, NeverWakes, Strand, getcurrent, running_strand
from turtle_lesson.ros.world import current_process, current_world

from ._blocking import drive, drives_the_simulation, in_a_plain_cell, spin_live
from ._deadlock import main_may_go_on, why_never_done
from ._entity import SERVICE, WAITABLE, Entity
from ._executor_errors import (
    ConditionReachedException,
    ExternalShutdownException,
    ShutdownException,
    TimeoutException,
)
from ._mistakes import explain_call, no_node
from ._tracing import trace_entity
from .context import Context
from .exceptions import refuse_destroyed
from .task import Future, Task, at_once
from .utilities import get_default_context

if TYPE_CHECKING:
    from .node import Node

Job = Any  # an Entity, or a Task
Condition = Callable[[], bool] | None


class Executor:
    """Base class: waits, chooses and runs. Subclasses may override `spin_once`, which `spin` calls."""

    __module__ = "rclpy.executors"
    _runs_in = "_execute"
    """The method that runs a callback: a world that keeps a trace puts another in its place."""

    def __init__(self, *, context: Context | None = None) -> None:
        self._context = get_default_context() if context is None else context
        self._simulation = current_world().sim
        self._trace = current_world().trace
        self._process = current_process()
        self._nodes: list[Node] = []
        self._nodes_seen = 0
        self._signalled: list[Entity] = []
        self._batch: list[Job] = []
        self._resumed: list[Task] = []
        self._polled: list[Task] = []
        self._held_up: list[Entity] = []
        self._waiter: Strand | None = None
        self._make_ready = self._simulation.make_ready
        self._spinning: list[Strand] = []
        self._spins_to_the_end = 0  # how many strands are in `spin`: those do nothing else before the shutdown
        self._calls: list[Future] = []  # for what strands wait, without a timeout, in Client.call
        self._is_shutdown = False
        self._context.on_shutdown(self.wake)

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
        if node.executor is not None:
            node.executor.remove_node(node)
        self._nodes.append(node)
        self._nodes_seen += 1
        node._ros_executor, node._ros_place = self, self._nodes_seen
        for entity in node._ros_entities():
            self._adopt(entity, node)
        return True

    def _adopt(self, entity: Entity, node: Node) -> None:
        entity._executor = self
        entity._turn = (0 if entity._kind == WAITABLE else node._ros_place, entity._kind, entity._number)
        if self._trace is not None:
            trace_entity(entity, node, self, self._trace)
        if entity._has_work():
            entity._signal()

    def remove_node(self, node: Node) -> None:
        """No longer run this node's callbacks."""
        if node in self._nodes:
            self._nodes.remove(node)
            node._ros_executor = None
            for entity in node._ros_entities():
                entity._executor = None

    def get_nodes(self) -> list[Node]:
        """The nodes of this executor, in the order in which they were added."""
        return list(self._nodes)

    # -- tasks ---------------------------------------------------------------------------------------------------

    def create_task(self, callback: Any, *args: Any, **kwargs: Any) -> Task:
        """Have a function called, or a coroutine run, by this executor; the task is a future of its result."""
        task = Task(callback, args, kwargs, executor=self)
        self._resume_task(task)
        return task

    def _resume_task(self, task: Task) -> None:
        self._resumed.append(task)
        self.wake()

    def _poll_task(self, task: Task) -> None:
        self._polled.append(task)

    def wake(self) -> None:
        """Have a waiting `spin_once` look again at what it waits for."""
        if self._waiter is not None:
            self._simulation.wake(self._waiter)

    # -- spinning ------------------------------------------------------------------------------------------------

    def spin(self) -> None:
        """Run callbacks until shutdown. From a plain notebook cell: live, until the cell is interrupted."""
        if in_a_plain_cell():
            spin_live(self._spin)
        else:
            self._spin()

    def _spin(self) -> None:
        strand = running_strand()
        assert strand is not None
        self._spins_to_the_end += 1
        try:
            if type(self).spin_once is Executor.spin_once and type(self)._execute is Executor._execute:
                self._spin_fast(strand)
            else:
                while self._context.ok() and not self._is_shutdown:
                    self.spin_once()
        finally:
            self._spins_to_the_end -= 1

    def _spin_fast(self, strand: Strand) -> None:
        """What a loop over `spin_once` does, written out: half of what the simulation costs is spent here.

        The common case is that one callback became ready while the strand was waiting; it is run without a batch.
        """
        simulation, context, signalled = self._simulation, self._context, self._signalled
        self._spinning.append(strand)
        self._waiter, before = strand, self._waiter
        try:
            while not context.ended and not self._is_shutdown:
                if len(signalled) == 1 and not self._batch and not self._resumed and not self._polled:
                    entity = signalled.pop()
                    entity._listed_in = None
                    if entity._executor is self and entity._has_work():
                        if entity.callback_group.beginning_execution(entity):
                            self._execute(entity)
                        else:
                            self._held_up.append(entity)
                elif signalled or self._batch or self._resumed:
                    try:
                        job = self._next(strand, None, None)
                    except ShutdownException:
                        return
                    self._execute(job)
                else:
                    simulation.park(strand)
                    if context.ended and not self._is_shutdown:
                        raise ExternalShutdownException
        finally:
            self._waiter = before
            self._spinning.remove(strand)

    def spin_once(self, timeout_sec: float | None = None) -> None:
        """Run one callback, waiting at most `timeout_sec` (s; None waits for ever) for one to become ready.

        An executor that is shut down runs none, and says nothing.
        """
        strand = getcurrent()
        if type(strand) is Strand:
            self._spin_once(strand, None if timeout_sec is None else self._deadline(timeout_sec), None)
        else:
            drive(self.spin_once, timeout_sec)

    @drives_the_simulation
    def spin_until_future_complete(self, future: Future, timeout_sec: float | None = None) -> None:
        """Run callbacks until the future is done, or the timeout (s) is over."""
        strand = running_strand()
        assert strand is not None
        strand.activity = "spin_until_future_complete"
        self._watch(future)
        deadline = self._deadline(timeout_sec)
        if deadline is None and (problem := why_never_done(future, self, strand)):
            raise NeverWakes(problem)
        while self._context.ok() and not future.done() and not future.cancelled() and not self._is_shutdown:
            if deadline is not None and self._simulation.now >= deadline:
                return
            left = None if deadline is None else (deadline - self._simulation.now) / NANOSECONDS
            self.spin_once_until_future_complete(future, left)

    @drives_the_simulation
    def spin_once_until_future_complete(self, future: Future, timeout_sec: float | None = None) -> None:
        """Run one callback, unless the future is done before one becomes ready."""
        self._watch(future)
        strand = running_strand()
        assert strand is not None
        self._spin_once(strand, self._deadline(timeout_sec), future.done)

    def _watch(self, future: Future) -> None:
        """Look again when the future is done. It is asked for once, however often it is spun for."""
        if self._on_done not in future._callbacks:
            future.add_done_callback(self._on_done)

    @at_once
    def _on_done(self, _: Future) -> None:
        self.wake()

    def _spin_once(self, strand: Strand, deadline: int | None, condition: Condition) -> None:
        self._spinning.append(strand)
        try:
            try:
                job = self._next(strand, deadline, condition)
            except ShutdownException:
                return
            if job is not None:
                self._execute(job)
        finally:
            self._spinning.remove(strand)

    def wait_for_ready_callbacks(
        self,
        timeout_sec: float | None = None,
        nodes: list[Node] | None = None,
        condition: Callable[[], bool] = lambda: False,
    ) -> tuple[Task, Entity | None, Node | None]:
        """What an executor of one's own builds on: the next ready callback as a task to be called, with its entity.

        Raises TimeoutException, ConditionReachedException, ShutdownException or ExternalShutdownException.
        """
        strand = running_strand()
        assert strand is not None
        job = self._next(strand, self._deadline(timeout_sec), condition)
        if job is None:
            raise ConditionReachedException if condition() else TimeoutException
        if isinstance(job, Task):
            return job, job._entity, job._node
        return self._as_task(job), job, job._node

    def _deadline(self, timeout_sec: float | None) -> int | None:
        if timeout_sec is None or timeout_sec < 0:
            return None
        return self._simulation.now + int(timeout_sec * NANOSECONDS)

    def _spun_by_another(self, strand: Strand) -> bool:
        """Whether some other strand than this one is there, or may come, to take what arrives."""
        return any(spinner is not strand for spinner in self._spinning) or main_may_go_on(strand)

    def _is_worker(self, strand: Strand) -> bool:
        """Whether this strand is a thread of this executor, which takes nothing while it waits."""
        return False

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
                elif job._executor is self and job._has_work():
                    if job.callback_group.beginning_execution(job):
                        return job
                    self._held_up.append(job)
            if condition is not None and condition():
                return None
            if self._signalled or self._resumed:
                self._begin_cycle()
                continue
            if self._is_shutdown or not self._context.ok():
                self._say_it_is_shut_down()
            if deadline is not None and self._simulation.now >= deadline:
                return None
            self._wait(strand, deadline)

    def _begin_cycle(self) -> None:
        """Take all that is ready now as the next batch."""
        batch: list[Job] = sorted(self._signalled, key=_turn, reverse=True)  # taken from the end
        for entity in batch:
            entity._listed_in = None
        self._signalled.clear()
        if self._resumed or self._polled:
            batch += reversed([*self._polled, *self._resumed])
            self._polled, self._resumed = [], []
        self._batch = batch

    def _say_it_is_shut_down(self) -> None:
        raise ShutdownException if self._is_shutdown else ExternalShutdownException

    def _wait(self, strand: Strand, deadline: int | None) -> None:
        simulation = self._simulation
        before, self._waiter = self._waiter, strand
        if deadline is not None:
            simulation.at(deadline, simulation.wake, strand)
        try:
            simulation.park(strand)
        finally:
            self._waiter = before

    # -- running -------------------------------------------------------------------------------------------------

    def _execute(self, job: Job) -> None:
        """Run a job, whose callback group has been taken, in this strand."""
        if job.__class__ is Task:
            self._run_task(job)
        elif job._is_async:
            self._run_task(self._as_task(job))
        else:
            try:
                arguments = job._take()
                if arguments is not None:
                    result = job.callback(*arguments)
                    if job._kind == SERVICE:
                        job._done_with(arguments, result)
            except TypeError as error:
                explain_call(job, arguments, error)
                raise
            finally:
                job.callback_group.ending_execution(job)
                if self._held_up:
                    self._release_held_up()

    def _release_held_up(self) -> None:
        """Let those look again who waited for a callback group."""
        held_up, self._held_up = self._held_up, []
        for waiting in held_up:
            waiting._signal()

    def _free(self, entity: Any) -> None:
        entity.callback_group.ending_execution(entity)
        self._release_held_up()

    def _as_task(self, entity: Any) -> Task:
        task = Task(_call_and_await, (entity, entity._take()), executor=self)
        task._entity, task._node = entity, entity._node
        task._finally = lambda: self._free(entity)
        return task

    def _run_task(self, task: Task) -> None:
        task()
        if task._done and task._exception is not None:
            raise task._exception

    def shutdown(self, timeout_sec: float | None = None) -> bool:
        """Stop: no more callbacks are run."""
        self._is_shutdown = True
        for node in list(self._nodes):
            self.remove_node(node)
        self.wake()
        return True

    def __enter__(self) -> Executor:
        return self

    def __exit__(self, *error: object) -> None:
        self.shutdown()


async def _call_and_await(entity: Any, arguments: tuple[Any, ...] | None) -> None:
    if arguments is not None:
        try:
            result = entity.callback(*arguments)
        except TypeError as error:
            explain_call(entity, arguments, error)
            raise
        if entity._is_async:
            result = await result
        if entity._kind == SERVICE:
            entity._done_with(arguments, result)


def _turn(entity: Entity) -> tuple[int, int, int]:
    return entity._turn
