"""The goals that an action server knows: those that go on, and for some time those that have ended."""

from __future__ import annotations

from collections.abc import Iterator
from heapq import heappop, heappush
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from turtle_lesson.ros.core import Simulation

    from ._goal_handle import ServerGoalHandle


def key_of(goal_id: Any) -> bytes:
    """A goal's number (a UUID message) as what can be looked up."""
    return bytes(goal_id.uuid)


class Goals:
    """By their numbers, in the order in which they were accepted.

    The real server forgets the ended ones with a timer (rcl_action's action_server.c). Here it looks whenever somebody
    asks: nobody can tell the difference, and nothing keeps a world awake in which nothing happens any more.
    """

    def __init__(self, simulation: Simulation, timeout: int, *, after_their_end: bool) -> None:
        self._simulation = simulation
        self._timeout = timeout
        self._after_their_end = after_their_end
        self._accepted: dict[bytes, int] = {}
        self._handles: dict[bytes, ServerGoalHandle] = {}
        self._results: dict[bytes, Any] = {}
        self._asked: dict[bytes, list[Any]] = {}
        self._executing: set[bytes] = set()
        self._ended: list[tuple[int, bytes]] = []  # when (ns) they expire: a heap

    def __iter__(self) -> Iterator[ServerGoalHandle]:
        return iter(list(self._handles.values()))

    def get(self, goal_id: Any) -> ServerGoalHandle | None:
        """The goal of this number."""
        return self._handles.get(key_of(goal_id))

    def add(self, handle: ServerGoalHandle) -> None:
        """A goal was accepted."""
        key = key_of(handle.goal_id)
        self._handles[key] = handle
        self._accepted[key] = self._simulation.now

    def begin(self, handle: ServerGoalHandle) -> None:
        """A goal's execute callback is to be called: it is not forgotten before that has returned."""
        self._executing.add(key_of(handle.goal_id))

    def end(self, handle: ServerGoalHandle) -> None:
        """A goal has come to its end, and will be forgotten."""
        key = key_of(handle.goal_id)
        began = self._accepted.pop(key, self._simulation.now)
        heappush(self._ended, ((self._simulation.now if self._after_their_end else began) + self._timeout, key))

    def ask(self, goal_id: Any, request: Any) -> Any | None:
        """The result of a goal; None if it is not known yet: then this request will be among those to be answered."""
        key = key_of(goal_id)
        if key in self._results:
            return self._results[key]
        self._asked.setdefault(key, []).append(request)
        return None

    def finish(self, handle: ServerGoalHandle, result: Any) -> list[Any]:
        """A goal's execute callback has returned. Returns the requests that are to be answered now."""
        key = key_of(handle.goal_id)
        self._executing.discard(key)
        if key in self._handles:
            self._results[key] = result
        return self._asked.pop(key, [])

    def forget_expired(self) -> None:
        """Let go of those that have ended and expired."""
        ended, now = self._ended, self._simulation.now
        while ended and ended[0][0] < now and ended[0][1] not in self._executing:
            key = heappop(ended)[1]
            self._results.pop(key, None)
            handle = self._handles.pop(key, None)
            if handle is not None:
                handle.destroy()

    def forget_all(self) -> None:
        """Let go of all of them."""
        for handle in self._handles.values():
            handle.destroy()
        self._handles.clear()
