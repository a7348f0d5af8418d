"""How callbacks get into the world's trace: when they were ready, began and ended.

Those that run at once, as nearly all do, the executor notes itself (`ExecutorBase._execute`): a call for each would cost
more than all that is noted.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from turtle_lesson.ros.rmw.trace import PLUMBING, Callback, Trace

from ._entity import SERVICE, SUBSCRIPTION, TIMER
from .time_source import TimeSource
from .timer import Rate

if TYPE_CHECKING:
    from turtle_lesson.ros.sim.simulation import Simulation

    from .node import Node
    from .task import Task

KINDS = {TIMER: "timer", SUBSCRIPTION: "subscription", SERVICE: "service"}


def trace_entity(entity: Any, node: Node, trace: Trace) -> None:
    """Give what a node waits for its place in the trace, unless it is ROS's own."""
    kind, source, name = KINDS.get(entity._kind), _source(entity), name_of(entity.callback)
    if kind is None or node._ros_entry.hidden or source in PLUMBING or _is_ours(entity.callback):
        return
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


def begin_task(entity: Any, traced: Callback, now: int) -> tuple[int, int]:
    """Note that a callback begins as a task: when it was ready, and `now` (ns)."""
    arrivals = traced.arrivals
    begun = (entity._next if arrivals is None else arrivals.popleft() if arrivals else now, now)
    traced.open.append(begun)
    return begun


def note_end(task: Task, traced: Callback, begun: tuple[int, int], simulation: Simulation) -> None:
    """Have it noted when a task is over that is a callback."""
    free = task._finally

    def end() -> None:
        traced.open.remove(begun)
        traced.ended.append((*begun, simulation.now))
        if free is not None:
            free()

    task._finally = end


def _source(entity: Any) -> str:
    if entity._kind == SUBSCRIPTION:
        return entity._reader.topic.name
    return entity._server.name if entity._kind == SERVICE else ""


def _note_arrivals(entity: Any, trace: Trace) -> None:
    """Keep beside each message or request that waits when it came."""
    end = entity._reader if entity._kind == SUBSCRIPTION else entity._server
    queue = end.queue
    end.arrivals = entity._traced.arrivals = deque([trace.simulation.now] * len(queue), maxlen=queue.maxlen)
    getattr(end, "beside", []).append(end.arrivals)  # or what expires in the queue would leave its time behind


def _is_ours(callback: Any) -> bool:
    """Whether this is no callback of the program's: none at all, or that of a rate or of the node's time source."""
    return callback is None or isinstance(getattr(callback, "__self__", None), (Rate, TimeSource))


def name_of(function: Callable[..., Any] | None) -> str:
    """What a learner calls a callback."""
    function = getattr(function, "func", function)  # of a functools.partial
    name = getattr(function, "__name__", type(function).__name__)
    return "lambda" if name == "<lambda>" else name
