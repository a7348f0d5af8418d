"""How callbacks get into the world's trace: when they were ready, began and ended.

The executor of a node that is traced has methods of its own in place of two of its class's. One in a world without a
trace has not, and so pays nothing.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from turtle_lesson.ros.trace import Callback, Trace
from turtle_lesson.ros.trace.trace import PLUMBING

from ._entity import SERVICE, SUBSCRIPTION, TIMER
from .time_source import TimeSource
from .timer import Rate

if TYPE_CHECKING:
    from .executors import Executor
    from .node import Node
    from .task import Task

KINDS = {TIMER: "timer", SUBSCRIPTION: "subscription", SERVICE: "service"}


def trace_entity(entity: Any, node: Node, executor: Executor, trace: Trace) -> None:
    """Give what a node waits for its place in the trace, unless it is ROS's own."""
    kind, source, name = KINDS.get(entity._kind), _source(entity), name_of(entity.callback)
    if kind is None or node._ros_entry.hidden or source in PLUMBING or _is_ours(entity.callback):
        return
    if executor._runs_in not in vars(executor):
        _begin_to_trace(executor)
    if entity._traced is not None:
        return  # it has been traced in another executor
    if type(getattr(entity.callback, "__self__", None)).__module__.startswith("rclpy."):
        name = source.rpartition("/")[2]  # a service of rclpy's own, such as get_parameters
    entry = node._ros_entry
    period = entity._period if kind == "timer" else 0
    entity._traced = Callback(entry.full_name, name, kind, source, period, entry.process.pid, entity._is_async)
    trace.callbacks.append(entity._traced)
    if kind != "timer":
        _note_arrivals(entity, trace)


def _begin_to_trace(executor: Executor) -> None:
    """Note from now on when this executor's callbacks run. Short, for it is done for each of them."""
    simulation = executor._simulation
    run_job, make_task = getattr(executor, executor._runs_in), executor._as_task

    def run(job: Any) -> None:
        traced = job._traced
        if traced is None or traced.awaits:
            run_job(job)
            return
        began = simulation.now
        arrivals = traced.arrivals
        ready = job._next if arrivals is None else arrivals.popleft() if arrivals else began
        begun = (ready, began)
        traced.open.append(begun)
        try:
            run_job(job)
        finally:
            traced.open.remove(begun)
            traced.ended.append((ready, began, simulation.now))

    def as_task(entity: Any) -> Task:
        traced = entity._traced
        if traced is None:
            return make_task(entity)
        begun = (_ready_since(entity, traced), simulation.now)
        task = make_task(entity)
        traced.open.append(begun)
        free = task._finally

        def end() -> None:
            traced.open.remove(begun)
            traced.ended.append((*begun, simulation.now))
            if free is not None:
                free()

        task._finally = end
        return task

    setattr(executor, executor._runs_in, run)
    executor._as_task = as_task  # type: ignore[method-assign]


def _ready_since(entity: Any, traced: Callback) -> int:
    if traced.arrivals is None:
        return entity._next
    return traced.arrivals.popleft() if traced.arrivals else entity._executor._simulation.now


def _source(entity: Any) -> str:
    if entity._kind == SUBSCRIPTION:
        return entity._reader.topic.name
    return entity._server.name if entity._kind == SERVICE else ""


def _note_arrivals(entity: Any, trace: Trace) -> None:
    """Keep beside each message or request that waits when it came."""
    end = entity._reader if entity._kind == SUBSCRIPTION else entity._server
    simulation, signal, queue = trace.simulation, entity._signal, end.queue
    arrivals = entity._traced.arrivals = deque([simulation.now] * len(queue), maxlen=queue.maxlen)
    getattr(end, "beside", []).append(arrivals)  # or what expires in the queue would leave its time behind
    note = arrivals.append

    def arrive() -> None:
        note(simulation.now)
        signal()

    end.wake = arrive


def _is_ours(callback: Any) -> bool:
    """Whether this is no callback of the program's: none at all, or that of a rate or of the node's time source."""
    return callback is None or isinstance(getattr(callback, "__self__", None), (Rate, TimeSource))


def name_of(function: Callable[..., Any] | None) -> str:
    """What a learner calls a callback."""
    function = getattr(function, "func", function)  # of a functools.partial
    name = getattr(function, "__name__", type(function).__name__)
    return "lambda" if name == "<lambda>" else name
