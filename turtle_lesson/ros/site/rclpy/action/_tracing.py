"""How execute callbacks get into the world's trace, if it keeps one: a lane of their own in a timeline."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

from turtle_lesson.ros.trace import Callback

from .._tracing import name_of

if TYPE_CHECKING:
    from .server import ActionServer


@contextmanager
def noted(server: ActionServer, callback: Callable[..., Any], ready: int) -> Iterator[None]:
    """Note when an execute callback, which could have begun when it was `ready` (ns), begins and ends."""
    node = server._node
    trace = node._ros_graph.trace
    if trace is None or node._ros_entry.hidden:
        yield
        return
    record = _record(server, callback)
    begun = (ready, trace.now)
    record.open.append(begun)
    try:
        yield
    finally:
        record.open.remove(begun)
        record.ended.append((*begun, trace.now))


def _record(server: ActionServer, callback: Callable[..., Any]) -> Callback:
    """Where the runs of this callback are kept."""
    name, entry = name_of(callback), server._node._ros_entry
    if name not in server._traced:
        awaits = inspect.iscoroutinefunction(callback)
        record = Callback(entry.full_name, name, "action", server._name, 0, entry.process.pid, awaits)
        server._traced[name] = record
        server._node._ros_graph.trace.callbacks.append(record)  # type: ignore[union-attr]
    return server._traced[name]
