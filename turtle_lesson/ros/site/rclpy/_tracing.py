"""How callbacks get into the world's trace. When each was ready, began and ended is noted where it runs."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from turtle_lesson.ros.rmw.trace import PLUMBING, Callback, Trace

from ._entity import SERVICE, SUBSCRIPTION, TIMER
from .time_source import TimeSource
from .timer import Rate

if TYPE_CHECKING:
    from .node import Node

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


def name_of(function: Callable[..., Any] | None) -> str:
    """What a learner calls a callback."""
    function = getattr(function, "func", function)  # of a functools.partial
    name = getattr(function, "__name__", type(function).__name__)
    return "lambda" if name == "<lambda>" else name
