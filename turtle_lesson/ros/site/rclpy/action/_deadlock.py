"""Calls of an action that can never be answered are found before they hang, and explained."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

from turtle_lesson.ros.rmw.trace import Callback
from turtle_lesson.ros.sim.errors import NeverWakes

from .._deadlock import Words, why_never_answered
from .._hints import did_you_mean
from .._tracing import name_of

if TYPE_CHECKING:
    from turtle_lesson.ros.sim.strand import Strand

    from ..client import Client
    from .client import ActionClient
    from .server import ActionServer


WORDS = {
    part: Words("action client", "action server", ask, "ActionClient")
    for part, ask in {
        "send_goal": "action_client.send_goal_async(goal)",
        "cancel_goal": "goal_handle.cancel_goal_async()",
        "get_result": "goal_handle.get_result_async()",
    }.items()
}
"""What the clients behind an action client are called in such explanations."""


SUFFIX = "/_action/send_goal"


def refuse_hopeless(action_client: ActionClient, client: Client, what: str, strand: Strand) -> None:
    """Raise NeverWakes if a synchronous call from this strand, such as send_goal (`what`), would wait forever."""
    ready = action_client.server_is_ready()
    problem = why_never_answered(client, strand) if ready else _why_nobody_offers(action_client)
    if problem:
        raise NeverWakes(f"this {what} of {action_client._name} can never be answered: {problem}")


def _why_nobody_offers(action_client: ActionClient) -> str:
    """What is known about an action that nobody offers by this name and type."""
    name, own = action_client._name, action_client._action_type._TYPE_NAME
    services = action_client._node._ros_graph.services().items()
    offered = {each.removesuffix(SUFFIX): types for each, types in services if each.endswith(SUFFIX)}
    if name in offered:
        return f"the action of this name is of type {offered[name][0].removesuffix('_SendGoal')}, not {own}."
    return (
        f"no node offers this action ({own}){did_you_mean(name, offered) or '.'} Is its node running? "
        "wait_for_server(timeout_sec=…) waits for it."
    )


# -- tracing ------------------------------------------------------------------------------------------------------
# How execute callbacks get into the world's trace, if it keeps one: a lane of their own in a timeline.


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
