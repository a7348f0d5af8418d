"""How callbacks get into the world's trace: when they were ready, began and ended.

Those that run at once, as nearly all do, note themselves (`Entity._run`): a call for each would cost more than all that
is noted.
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
    """Give a callback of the program's its place in the trace, unless it has one from another executor."""
    kind, callback, entry = KINDS.get(entity._kind), entity.callback, node._ros_entry
    owner = getattr(callback, "__self__", None)
    if kind is None or callback is None or entry.hidden or isinstance(owner, (Rate, TimeSource)):
        return
    end = entity._reader if kind == "subscription" else entity._server if kind == "service" else None
    source = "" if end is None else end.topic.name if kind == "subscription" else end.name
    if source in PLUMBING or entity._traced is not None:
        return
    name = name_of(callback)
    if type(owner).__module__.startswith("rclpy."):
        name = source.rpartition("/")[2]  # a service of rclpy's own, such as get_parameters
    period = entity._period if kind == "timer" else 0
    entity._traced = Callback(entry.full_name, name, kind, source, period, entry.process.pid, entity._is_async)
    trace.callbacks.append(entity._traced)
    if end is not None:  # note beside each message or request that waits when it came
        arrivals = deque([trace.simulation.now] * len(end.queue), maxlen=getattr(end.queue, "maxlen", None))
        end.arrivals = entity._traced.arrivals = arrivals
        getattr(end, "beside", []).append(arrivals)  # or what expires in the queue would leave its time behind
    elif entity._time is not trace.simulation:
        entity._traced.arrivals = deque()  # a timer whose ticks are in another time is ready when it begins


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
        traced.end_run(begun, simulation.now)
        if free is not None:
            free()

    task._finally = end


def name_of(function: Callable[..., Any] | None) -> str:
    """What a learner calls a callback."""
    function = getattr(function, "func", function)  # of a functools.partial
    name = getattr(function, "__name__", type(function).__name__)
    return "lambda" if name == "<lambda>" else name
