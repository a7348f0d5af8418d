"""Calls that can never be answered are found before they hang, and explained.

A real rclpy waits forever in these cases. Which they are was tried on one: a synchronous call in the only thread that
could take its answer, or in the mutually exclusive callback group in which the client (or the service, if it lives in
the same process) would have to be called.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import FrameType
from typing import TYPE_CHECKING, Any

from turtle_lesson.ros.sim.strand import running_strand
from turtle_lesson.ros.stdlib.deadlock import hints

from ._entity import Entity
from ._hints import did_you_mean
from ._state import RclpyState

if TYPE_CHECKING:
    from turtle_lesson.ros.rmw.service import ServerEnd
    from turtle_lesson.ros.sim.strand import Strand

    from .client import Client
    from .executors import Executor
    from .task import Future, Task


@dataclass(frozen=True)
class Words:
    """What a client and its server are called in these texts."""

    client: str = "client"
    server: str = "service"
    ask: str = "client.call_async(request)"
    make: str = "create_client"


def advice_for_await(words: Words) -> str:
    """What to do instead of a synchronous call in a callback."""
    return (
        f"Make the callback `async def` and write `await {words.ask}`, with the {words.client} in a callback group of "
        f"its own; or spin with a MultiThreadedExecutor, the {words.client} in a different callback group from this callback."
    )


def callbacks_around(frame: FrameType | None = None) -> list[Any]:
    """The entities whose callbacks the running code, or that of a frame, is inside, innermost first.

    They are found in the frames, so that calling a callback costs nothing for this.
    """
    from .task import Task

    places = (Entity._run.__code__, Task.__call__.__code__)  # copies of code are equal
    found: list[Any] = []
    frame = frame or sys._getframe(1)
    while frame is not None:
        if frame.f_code in places:
            job = frame.f_locals["self"]
            found.append(getattr(job, "_entity", job))
        frame = frame.f_back
    return found


def advice_for_callbacks(strand: Strand) -> str:
    """What to do if it is a callback that waits for another one that cannot run."""
    frame = sys._getframe(1) if strand is running_strand() else strand.frame
    if not callbacks_around(frame):
        return ""
    return (
        "While a callback waits, a single-threaded executor calls no other, and no executor calls another one of the same "
        "mutually exclusive callback group. Let what is to be waited for call what comes next; or spin with a "
        "MultiThreadedExecutor, the callbacks in groups of their own."
    )


hints.append(advice_for_callbacks)


def holds_group(group: Any) -> bool:
    """Whether the callback that is running here is what keeps a callback group taken."""
    holder = getattr(group, "_active_entity", None)
    return holder is not None and any(entity is holder for entity in callbacks_around())


def executor_of_worker(strand: Strand) -> Executor | None:
    """The executor that gives this strand its work; None for the main program."""
    return strand.process.state(RclpyState).workers.get(strand)


def others_may_act(strand: Strand) -> bool:
    """Whether another thread of the program may still do anything, such as spin once more, while this strand waits.

    The main program may if this is a worker whose executor is not in `spin`, but spun now and then. A thread may that
    is neither waiting forever itself nor is in `spin`, where it does nothing else.
    """
    executor = executor_of_worker(strand)
    if executor is not None and not executor._spinning_forever:
        return True
    spinning = strand.process.state(RclpyState).spinning
    others = (each for each in strand.process.strands if each is not strand and not each.dead)
    return any(each.waits_for is None and executor_of_worker(each) is None and each not in spinning for each in others)


def why_never_answered(client: Client, strand: Strand) -> str:
    """Why a synchronous call of a service from this strand would wait forever; '' if it need not."""
    servers = client._servers()
    if not servers:
        end = client._end
        return why_nobody_offers("service", end.name, end.type_name, client._node._ros_graph.services())
    drives = strand.process.is_notebook and not callbacks_around()
    if drives and client._end.cut_off:
        return (
            "lesson.network loses all transmissions of this service, and nothing can change that while this cell waits. "
            "Give a timeout, or let the network work again first."
        )
    return _why_not_taken(client, strand, drives) or _why_not_served(client, servers, strand, drives)


def why_nobody_offers(what: str, name: str, kind: str, offered: Mapping[str, list[str]]) -> str:
    """What is known about a service or action (`what`) that no node offers by this name and type."""
    if name in offered:
        return f"the {what} of this name is of type {offered[name][0]}, not {kind}."
    hint, wait = did_you_mean(name, offered) or ".", "wait_for_service" if what == "service" else "wait_for_server"
    return f"no node offers this {what} ({kind}){hint} Is its node running? {wait}(timeout_sec=…) waits for it."


def _why_not_taken(client: Client, strand: Strand, drives: bool) -> str:
    """Why nobody would take the answer."""
    words = client._words
    if holds_group(client.callback_group):
        return (
            f"this callback waits for it and so keeps its callback group, and the {words.client} that would take the "
            f"answer is in the same group. {advice_for_await(words)}"
        )
    if drives or client._taken_elsewhere(strand) or (client._executor is None and others_may_act(strand)):
        return ""
    if callbacks_around():
        return f"the thread that would take the answer is the one that waits here. {advice_for_await(words)}"
    return (
        f"no executor spins {client._node!r} meanwhile, so nothing takes the answer. Write instead: "
        f"future = {words.ask}, then rclpy.spin_until_future_complete(node, future)."
    )


def _why_not_served(client: Client, servers: list[ServerEnd], strand: Strand, drives: bool) -> str:
    """Why none of the services, if all live in this very process, would be called."""
    for server in servers:
        service = getattr(server.wake, "__self__", None)
        if server.node.process is not strand.process or service is None:
            return ""
        by_this_call = drives and (service._node is client._node or service._executor is client._executor is not None)
        executor = service._executor
        spun = by_this_call or (others_may_act(strand) if executor is None else executor._spun_by_another(strand))
        if spun and not holds_group(service.callback_group):
            return ""
    words, place = client._words, "notebook" if strand.process.is_notebook else "process"
    if drives or not callbacks_around():
        return (
            f"the {words.server}'s node is in this {place}, too, and no executor spins it meanwhile. Add both nodes to one "
            f"executor: executor.add_node(…), future = {words.ask}, executor.spin_until_future_complete(future)."
        )
    return (
        f"the {words.server} is offered by this same process, and cannot be called while this callback waits, because they "
        f"share a thread or a callback group. Give the {words.server} a callback group of its own, and use a "
        "MultiThreadedExecutor."
    )


def why_never_done(future: Future, executor: Executor, strand: Strand) -> str:
    """Why spinning inside a callback until a future is done would take forever; '' if it need not, or in doubt."""
    client = future._answered_by
    if client is None or future._done or not holds_group(client.callback_group):
        return ""
    if others_may_act(strand) or _somebody_may_complete(future, executor, holds_group):
        return ""
    return (
        f"this callback spins until {client.service_name} has answered, which can never happen: the callback keeps its "
        f"callback group meanwhile, and the {client._words.client} that would take the answer is in the same group. Make "
        f"the callback `async def` and await {client._words.ask}, with the {client._words.client} in a callback group of "
        "its own; or continue in future.add_done_callback(…)."
    )


def why_never_awaited(future: Future, task: Task, strand: Strand | None) -> str:
    """Why a coroutine would await a future forever; '' if it need not, or in doubt."""
    client, entity, executor = future._answered_by, task._entity, task._executor
    if client is None or entity is None or executor is None or client.callback_group is not entity.callback_group:
        return ""
    if client.callback_group.can_execute(client) or not executor._spinning_forever:
        return ""
    if _somebody_may_complete(future, executor, lambda group: group is entity.callback_group):
        return ""
    words = client._words
    return (
        f"this coroutine waits for an answer of {client.srv_name}, but can never get it: it keeps its callback "
        f"group taken while it waits, and the {words.client} is in the same group. Give the {words.client} a group of its "
        f"own: {words.make}(…, callback_group=MutuallyExclusiveCallbackGroup())"
    )


def _somebody_may_complete(future: Future, executor: Executor, taken: Callable[[Any], bool]) -> bool:
    """Whether some callback or task can run while these groups are taken, since it may set the result."""
    if executor._resumed or executor._delayed:
        return True
    nodes = future._answered_by._node.context._nodes
    return any(_may_act(entity, taken) for node in nodes for entity in node._ros_waiting_entities)


def _may_act(entity: Entity, taken: Callable[[Any], bool]) -> bool:
    """Whether a callback of the program's own may be called by an entity, although these groups are taken."""
    if entity._executor is None or taken(entity.callback_group):
        return False
    if hasattr(entity, "_waiting"):  # a client, of services or actions: the answers that it waits for
        return bool(entity._waiting)
    return not (getattr(entity.callback, "__module__", None) or "").startswith("rclpy.")
