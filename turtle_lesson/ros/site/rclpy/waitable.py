"""Waitables: things of one's own that an executor waits for, made of timers and guard conditions."""

from __future__ import annotations

from types import GenericAlias
from typing import Any

from .callback_groups import CallbackGroup
from .task import Future

__all__ = ["NumberOfEntities", "Waitable"]

_COUNTS = ("subscriptions", "guard_conditions", "timers", "clients", "services", "events")


class NumberOfEntities:
    """How many entities of each kind a waitable is made of. Two of these can be added."""

    __slots__ = tuple(f"num_{kind}" for kind in _COUNTS)

    num_subscriptions: int
    num_guard_conditions: int
    num_timers: int
    num_clients: int
    num_services: int
    num_events: int

    def __init__(
        self,
        num_subs: int = 0,
        num_gcs: int = 0,
        num_timers: int = 0,
        num_clients: int = 0,
        num_services: int = 0,
        num_events: int = 0,
    ) -> None:
        numbers = (num_subs, num_gcs, num_timers, num_clients, num_services, num_events)
        for name, number in zip(self.__slots__, numbers, strict=True):
            setattr(self, name, number)

    def _numbers(self) -> list[int]:
        return [getattr(self, name) for name in self.__slots__]

    def __add__(self, other: NumberOfEntities) -> NumberOfEntities:
        return type(self)(*map(sum, zip(self._numbers(), other._numbers(), strict=True)))

    def __iadd__(self, other: NumberOfEntities) -> NumberOfEntities:
        for name in self.__slots__:
            setattr(self, name, getattr(self, name) + getattr(other, name))
        return self

    def __repr__(self) -> str:
        return f"<{type(self).__name__}({', '.join(map(str, self._numbers()))})>"


class Waitable:
    """Base class. A subclass says what to wait for, when it is ready, and what is done then; all methods must be given.

    An executor enters it as a context manager, asks `get_num_entities`, hands `add_to_wait_set` what to put timers and
    guard conditions into, asks `is_ready` whenever one of those is, then calls `take_data` and awaits `execute`.
    `Node.add_waitable` hands it to a node (rclpy's waitable.py).
    """

    __class_getitem__: Any = classmethod(GenericAlias)  # newer releases: ActionClient[Goal, Result, Feedback] in a hint

    def __init__(self, callback_group: CallbackGroup) -> None:
        self.callback_group = callback_group
        self.callback_group.add_entity(self)
        self._futures: list[Future] = []

    def __enter__(self) -> Any:
        raise _missing(self, "__enter__")

    def __exit__(self, *error: object) -> None:
        raise _missing(self, "__exit__")

    def add_future(self, future: Future) -> None:
        """Have the executor that runs this call a future's callbacks."""
        self._futures.append(future)

    def remove_future(self, future: Future) -> None:
        """No longer care for a future. Raises ValueError if it was never added."""
        self._futures.remove(future)

    def is_ready(self, wait_set: Any) -> bool:
        """Whether there is something to do."""
        raise _missing(self, "is_ready")

    def take_data(self) -> Any:
        """Take what `execute` is to have, so that it is not ready any more."""
        raise _missing(self, "take_data")

    async def execute(self, taken_data: Any) -> None:
        """Do the work with what was taken."""
        raise _missing(self, "execute")

    def get_num_entities(self) -> NumberOfEntities:
        """How many entities it waits for."""
        raise _missing(self, "get_num_entities")

    def add_to_wait_set(self, wait_set: Any) -> None:
        """Put what it waits for into a wait set, with `add_timer` and `add_guard_condition`."""
        raise _missing(self, "add_to_wait_set")


def _missing(waitable: Waitable, name: str) -> NotImplementedError:
    error = NotImplementedError("Must be implemented by subclass")
    error.add_note(f"{type(waitable).__name__} needs a method {name} of its own.")
    return error
