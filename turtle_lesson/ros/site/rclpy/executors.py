"""Executors: they know nodes, wait until callbacks are ready, choose what is next, and run it.

One *cycle* takes everything that is ready at that moment and runs one callback of each: first actions, QoS events and
tasks that can go on, then node by node timers, subscriptions, guard conditions, clients and services, each kind in order
of creation. What becomes ready meanwhile waits for the next cycle. These are the rules of rclpy's executors.py; but where
the real one builds a wait set for every cycle, entities here signal their executor, so that nothing is ever polled.
"""

from __future__ import annotations

import inspect
import warnings
from collections import deque
from collections.abc import Callable
from contextlib import suppress
from operator import attrgetter
from typing import TYPE_CHECKING, Any

from greenlet import GreenletExit

from turtle_lesson.ros.distro import EXECUTOR_AS_CONTEXT, SHUTDOWN_WAITS_FOR_THREADS, TASKS_IN_ORDER
from turtle_lesson.ros.runtime.world import current_process, current_world
from turtle_lesson.ros.sim.errors import NeverWakes, print_error
from turtle_lesson.ros.sim.simulation import NANOSECONDS
from turtle_lesson.ros.sim.strand import Strand, running_strand
from turtle_lesson.ros.stdlib.deadlock import IDLE, look_after, wait_in_vain
from turtle_lesson.ros.stdlib.threads import number_of_pool

from ._blocking import drive, drives_the_simulation, spin_live
from ._deadlock import executor_of_worker, others_may_act, why_never_done
from ._entity import WAITABLE, Entity, trace_entity
from ._hints import explain_call, no_node, refuse_unbuilt
from ._state import RclpyState
from .context import Context
from .exceptions import not_valid, refuse_destroyed
from .task import Future, Task, at_once
from .utilities import get_default_context

if TYPE_CHECKING:
    from .node import Node

Job = Any  # an Entity, or a Task
Condition = Callable[[], bool] | None

LET_OTHERS_GO = 100_000
"""After how long, in ns, a coroutine goes on that only lets others go first, as with asyncio.sleep(0)."""


class TimeoutException(Exception):
    """Nothing became ready in time."""


class ShutdownException(Exception):
    """The executor was shut down."""


class ExternalShutdownException(Exception):
    """The context was shut down while the executor was waiting."""


class ConditionReachedException(Exception):
    """What was waited for has happened."""


class TimeoutObject:
    """A timeout (s) that can be changed while somebody has it."""

    timeout: float

    def __init__(self, timeout: float) -> None:
        self.timeout = timeout


class Executor:
    """Waits, chooses and runs. Subclasses may override `spin_once`, which `spin` calls."""

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
        self._delayed = 0  # tasks whose coroutine only let others go first, as with asyncio.sleep(0)
        self._has_room = True  # another callback may begin now
        self._must_look = True  # there may be more to do than to run the callbacks of what has signalled
        self._blocked: list[Entity] = []
        self._waiter: Strand | None = None  # the strand that a signal wakes: the last that began to wait
        self._waiters: list[Strand] = []
        self._make_ready = self._simulation.make_ready
        self._tasks_in_order = current_world().release.has(TASKS_IN_ORDER)
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
        assignment = node._ros_assignment
        if assignment.executor is not None:
            assignment.executor.remove_node(node)
        assignment.executor = self
        self._nodes.append(node)
        comes_again = node._ros_place == (self, self._nodes_seen)  # as it does with each rclpy.spin_once
        if not comes_again:
            self._nodes_seen += 1
            node._ros_place = (self, self._nodes_seen)
        if assignment.missed or not comes_again:
            looked_at = list(assignment.missed if comes_again else node._ros_waiting_entities)
            assignment.missed.clear()
            for entity in looked_at:
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
            node._ros_assignment.executor = None

    def get_nodes(self) -> list[Node]:
        """The nodes of this executor, in the order in which they were added."""
        return list(self._nodes)

    # -- tasks ---------------------------------------------------------------------------------------------------

    def create_task(self, callback: Any, *args: Any, **kwargs: Any) -> Task:
        """Have a function called, or a coroutine run, by this executor; the task is a future of its result."""
        task = Task(callback, args, kwargs, executor=self)
        self._resume_task(task)
        return task

    def create_future(self) -> Future:
        """A future whose callbacks this executor calls."""
        return Future(executor=self)

    def _resume_task(self, task: Task) -> None:
        self._resumed.append(task)
        self.wake()

    def _resume_later(self, task: Task) -> None:
        self._delayed += 1
        self._simulation.at(self._simulation.now + LET_OTHERS_GO, self._resume_delayed, task)

    def _resume_delayed(self, task: Task) -> None:
        self._delayed -= 1
        self._resume_task(task)

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
            while batch and self._has_room:
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
            if self._has_room and (self._signalled or self._resumed):
                self._begin_cycle()
                continue
            if self._is_shutdown or not self._context.ok():
                raise ShutdownException if self._is_shutdown else ExternalShutdownException
            if deadline is not None and self._simulation.now >= deadline:
                return None
            self._wait(strand, deadline)

    def _begin_cycle(self) -> None:
        """Take all that is ready now as the next batch; the one before is done."""
        self._must_look = True
        batch = self._batch
        batch += sorted(self._signalled, key=attrgetter("_turn"), reverse=True)
        for entity in batch:
            entity._listed_in = None
        self._signalled.clear()
        tasks = self._resumed
        batch += reversed(tasks) if self._tasks_in_order else sorted(tasks, key=attrgetter("_number"))
        tasks.clear()

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

    def _as_task(self, entity: Entity) -> Task:
        traced, begun = entity._traced, None
        if traced is not None:  # as in `Entity._run`
            began, arrivals = self._simulation.now, traced.arrivals
            begun = (entity._next if arrivals is None else arrivals.popleft() if arrivals else began, began)
            traced.open.append(begun)
        task = Task(_call_and_await, (entity, entity._take()), executor=self)
        task._entity, task._node = entity, entity._node

        def free() -> None:
            if traced is not None and begun is not None:
                traced.end_run(begun, self._simulation.now)
            entity._end_run(entity)
            self._retry_blocked()

        task._finally = free
        return task

    def _run_task(self, task: Task) -> None:
        task()
        if task._done and task._exception is not None:
            raise task._exception_fetched()

    # -- spinning ------------------------------------------------------------------------------------------------

    def spin(self) -> None:
        """Run callbacks until shutdown. From a plain notebook cell: live, until the cell is interrupted."""
        if running_strand() is None:
            spin_live(self._spin)
        else:
            self._spin()

    def _spin(self) -> None:
        strand = running_strand()
        assert strand is not None
        self._spinning_forever.append(strand)
        spinning = self._process.state(RclpyState).spinning
        spinning.append(strand)
        strand.may_act, before = self._may_run_anything, strand.may_act
        try:
            if type(self).spin_once is Executor.spin_once and type(self)._execute is Executor._execute:
                self._spin_in_turns(strand)
            else:
                while self._context.ok() and not self._is_shutdown:
                    self.spin_once()
        finally:
            strand.may_act = before
            self._spinning_forever.remove(strand)
            spinning.remove(strand)

    def _spin_in_turns(self, strand: Strand) -> None:
        """What a loop over `spin_once` does, written out: much of what the simulation costs is spent here.

        The common case is that one callback became ready while the strand was waiting; it is run without a cycle.
        """
        signalled, waited = self._signalled, False

        def turn() -> bool:
            """Run what is ready; whether to wait for more."""
            woken = waited
            while True:
                if len(signalled) == 1 and not self._must_look:
                    signalled.pop()._run(self, False)
                elif self._context.ended or self._is_shutdown:
                    if woken and not self._is_shutdown:
                        raise ExternalShutdownException
                    return False
                elif signalled or self._batch or self._resumed:
                    try:
                        job = self._next(strand, None, None)
                    except ShutdownException:
                        return False
                    self._execute(job)
                else:
                    self._must_look = len(self._spinning) > 1
                    return True
                if not (signalled or self._must_look):
                    return True
                woken = False

        self._spinning.append(strand)
        self._begin_waiting(strand)
        self._must_look = True
        try:
            if turn():
                waited = True
                self._simulation.take_turns(strand, turn)
        finally:
            self._end_waiting(strand)
            self._spinning.remove(strand)
            self._wake_another_spinner()

    def spin_once(self, timeout_sec: float | None = None) -> None:
        """Run one callback, waiting at most `timeout_sec` (s; None waits forever) for one to become ready.

        An executor that is shut down runs none, and says nothing.
        """
        strand = running_strand()
        if strand is not None:
            self._spin_once(strand, None if timeout_sec is None else self._deadline(timeout_sec), None)
        else:
            drive(self.spin_once, timeout_sec)

    def spin_until_future_complete(self, future: Future, timeout_sec: float | None = None) -> None:
        """Run callbacks until the future is done, or the timeout (s) is over."""
        strand = running_strand()
        if strand is None:
            drive(self.spin_until_future_complete, future, timeout_sec)
            return
        strand.activity = "spin_until_future_complete"
        self._watch(future)
        deadline = None if timeout_sec is None else self._deadline(timeout_sec)
        if deadline is None and future._answered_by is not None and (problem := why_never_done(future, self, strand)):
            raise NeverWakes(problem)
        if deadline is None and type(self) is SingleThreadedExecutor and self._context.ok():
            self._spin_until(strand, future)
            return
        while self._context.ok() and not future._is_done() and not future.cancelled() and not self._is_shutdown:
            if deadline is not None and self._simulation.now >= deadline:
                return
            left = None if deadline is None else (deadline - self._simulation.now) / NANOSECONDS
            self.spin_once_until_future_complete(future, left)

    def _spin_until(self, strand: Strand, future: Future) -> None:
        """What a loop over `spin_once_until_future_complete` without a timeout does, written out as that of `spin`."""
        context, signalled = self._context, self._signalled
        self._spinning.append(strand)
        try:
            while not (future._done or future._cancelled or context.ended or self._is_shutdown):
                if not (signalled or self._batch or self._resumed):
                    self._wait(strand, None)
                    if context.ended and not self._is_shutdown:
                        raise ExternalShutdownException
                elif len(signalled) == 1 and not (self._batch or self._resumed):
                    signalled.pop()._run(self, False)
                else:
                    job = self._next(strand, None, future._is_done)
                    if job is not None:
                        self._execute(job)
        except ShutdownException:
            return
        finally:
            self._spinning.remove(strand)
            if self._waiter is not None:
                self._wake_another_spinner()

    @drives_the_simulation
    def spin_once_until_future_complete(self, future: Future, timeout_sec: float | TimeoutObject | None = None) -> None:
        """Run one callback, unless the future is done before one becomes ready."""
        self._watch(future)
        strand = running_strand()
        assert strand is not None
        self._spin_once(strand, self._deadline(timeout_sec), future._is_done)

    def _watch(self, future: Future) -> None:
        """Look again when the future is done. It is asked for once, however often it is spun for."""
        if self._on_done not in future._callbacks:
            future.add_done_callback(self._on_done)

    @at_once
    def _on_done(self, _: Future) -> None:
        if self._waiter is not None:
            self._simulation.wake(self._waiter)

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
            self._wake_another_spinner()

    def _wake_another_spinner(self) -> None:
        """What this strand leaves is taken by another one that spins the same executor, if there is one."""
        if self._waiter is not None and (self._batch or self._signalled or self._resumed):
            self._simulation.wake(self._waiter)

    @drives_the_simulation
    def wait_for_ready_callbacks(
        self,
        timeout_sec: float | TimeoutObject | None = None,
        nodes: list[Node] | None = None,
        condition: Callable[[], bool] = lambda: False,
    ) -> tuple[Task, Entity | None, Node | None]:
        """What a program's own executor builds on: the next ready callback as a task to be called, with its entity.

        Raises TimeoutException, ConditionReachedException, ShutdownException or ExternalShutdownException, and
        NotImplementedError where only some `nodes` are wanted.
        """
        refuse_unbuilt(nodes=nodes)
        strand = running_strand()
        assert strand is not None
        job = self._next(strand, self._deadline(timeout_sec), condition)
        if job is None:
            raise ConditionReachedException if condition() else TimeoutException
        if isinstance(job, Task):
            return job, job._entity, job._node
        return self._as_task(job), job, job._node

    def can_execute(self, entity: Entity) -> bool:
        """Whether an entity's callback group lets its callback run now."""
        return entity.callback_group.can_execute(entity)

    def _deadline(self, timeout_sec: float | TimeoutObject | None) -> int | None:
        if isinstance(timeout_sec, TimeoutObject):
            timeout_sec = timeout_sec.timeout
        if timeout_sec is None or timeout_sec < 0:
            return None
        return self._simulation.now + int(timeout_sec * NANOSECONDS)

    def _spun_by_another(self, strand: Strand) -> bool:
        """Whether some other strand than this one is there, or may come, to take what arrives."""
        if any(spinner is not strand for spinner in self._spinning):
            return True
        return strand not in self._spinning_forever and others_may_act(strand)

    def _may_run_anything(self) -> bool:
        """Whether there is a callback that could be run, or whether all are held up by callbacks that wait."""
        if self._batch or self._resumed or self._delayed:
            return True
        entities = [entity for node in self._nodes for entity in node._ros_waiting_entities]
        return not entities or any(entity.callback_group.can_execute(entity) for entity in entities)

    def _is_worker(self, strand: Strand) -> bool:
        """Whether this strand is a thread of this executor, which takes nothing while it waits."""
        return False

    def shutdown(self, timeout_sec: float | None = None) -> bool:
        """Stop: no more callbacks are run."""
        self._is_shutdown = True
        for node in list(self._nodes):
            self.remove_node(node)
        self.wake()
        return True

    def __enter__(self) -> Executor:
        current_world().release.note_use(EXECUTOR_AS_CONTEXT)
        return self

    def __exit__(self, *error: object) -> None:
        self.shutdown()


async def _call_and_await(entity: Entity, arguments: tuple[Any, ...] | None) -> None:
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


async def await_or_execute(callback: Callable[..., Any], *args: Any) -> Any:
    """Call a function, and if it is a coroutine's wait for its end."""
    return await callback(*args) if inspect.iscoroutinefunction(callback) else callback(*args)


class SingleThreadedExecutor(Executor):
    """Runs one callback after the other, in the thread that spins: a callback that sleeps holds up all others."""


class MultiThreadedExecutor(Executor):
    """Runs callbacks side by side in up to `num_threads` threads (4 unless told), as their groups allow.

    The threads are strands: while one waits or sleeps, another runs; none runs at the same instant of real time.
    """

    def __init__(self, num_threads: int | None = None, *, context: Context | None = None) -> None:
        super().__init__(context=context)
        self._num_threads = 4 if num_threads is None else num_threads
        if self._num_threads < 1:
            raise ValueError(f"num_threads must be at least 1, got {num_threads}")
        if self._num_threads == 1:
            warnings.warn(
                "MultiThreadedExecutor is used with a single thread.\nUse the SingleThreadedExecutor instead.",
                stacklevel=2,
            )
        self._threads = 0
        self._idle: list[Strand] = []
        self._given: dict[Strand, Job] = {}
        self._failures: list[BaseException] = []

    def _spun_by_another(self, strand: Strand) -> bool:
        free = self._num_threads - sum(not answer.done() for answer in self._calls) - self._is_worker(strand)
        return super()._spun_by_another(strand) and free > 0

    def _is_worker(self, strand: Strand) -> bool:
        return executor_of_worker(strand) is self

    def _next(self, strand: Strand, deadline: int | None, condition: Condition) -> Job | None:
        def interesting() -> bool:
            return bool(self._failures) or (condition is not None and condition())

        job = None if self._failures else super()._next(strand, deadline, interesting)
        if job is None and self._failures:
            raise self._failures.pop(0)
        return job

    def _spin_once(self, strand: Strand, deadline: int | None, condition: Condition) -> None:
        with suppress(ExternalShutdownException):  # as rclpy's executors.py does; a single-threaded one raises it
            super()._spin_once(strand, deadline, condition)
        if strand.process.is_notebook:
            # When a cell's call returns, time stands still: what is ready must run before, or it would not be seen.
            self._simulation.at(self._simulation.now, self._simulation.wake, strand)
            self._simulation.park(strand)
            if self._failures:
                raise self._failures.pop(0)

    def _execute(self, job: Job) -> None:
        thread = self._idle.pop() if self._idle else self._new_thread()
        self._given[thread] = job
        self._has_room = bool(self._idle) or self._threads < self._num_threads
        self._simulation.wake(thread)

    def _new_thread(self) -> Strand:
        if not self._threads:
            self._pool = number_of_pool(self._process)
            self._process.before_exit.append(self._wait_for_callbacks)
        thread = self._process.add_strand(self._work)
        thread.name, thread.parked = f"ThreadPoolExecutor-{self._pool}_{self._threads}", True
        self._threads += 1
        self._process.state(RclpyState).workers[thread] = self
        return thread

    def _work(self) -> None:
        """What each thread does: run the jobs that it is given."""
        thread = running_strand()
        assert thread is not None
        while True:
            while thread not in self._given:
                thread.waits_for = IDLE
                if self._waiter is None:
                    look_after(thread)  # nobody spins: look for a deadlock
                thread.park()
            thread.waits_for = None
            try:
                super()._execute(self._given.pop(thread))
            except GreenletExit:
                raise
            except BaseException as error:  # also sys.exit(): it ends the program where the executor is spun
                self._failures.append(error)
            self._idle.append(thread)
            self._has_room = True
            self.wake()

    def shutdown(self, timeout_sec: float | None = None, *, wait_for_threads: bool = True) -> bool:
        """Stop: no more callbacks are run. Since Kilted, wait until those that have begun are done, unless told not to."""
        done = super().shutdown(timeout_sec)
        strand = running_strand()
        own = strand is not None and self._is_worker(strand)  # a callback cannot wait for its own end
        if wait_for_threads and not own and current_world().release.has(SHUTDOWN_WAITS_FOR_THREADS):
            drive(self._wait_for_callbacks) if strand is None else self._wait_for_callbacks()
        return done

    def _wait_for_callbacks(self) -> None:
        """The program ends, or the executor: callbacks that are in their middle go on to their end, as in Python's pools."""
        strand = running_strand()
        assert strand is not None
        self._begin_waiting(strand)
        try:
            while len(self._idle) < self._threads:
                wait_in_vain(strand, "the callbacks that still run")
                strand.park()
        finally:
            strand.waits_for = None
            self._end_waiting(strand)
        for error in self._failures:
            if isinstance(error, NeverWakes):  # a real program would hang
                print_error(error)
