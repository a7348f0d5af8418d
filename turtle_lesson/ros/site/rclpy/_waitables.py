"""How an executor waits for a waitable of a program's own.

The real rclpy hands it a wait set of the C library (wait_set.cpp); the one here is Python's, and knows the timers and
guard conditions that were put into it. Whenever one of those has something to tell, the waitable is asked.
"""

from __future__ import annotations

from typing import Any

from turtle_lesson.ros.world import current_world

from ._entity import WAITABLE, Entity
from .callback_groups import begin_of, end_of
from .guard_condition import GuardCondition
from .timer import SHORTEST, Timer


class WaitSet:
    """What a waitable's `add_to_wait_set` and `is_ready` are given."""

    def __init__(self) -> None:
        self.entities: dict[str, list[Any]] = {"timer": [], "guard_condition": []}
        self.ready: dict[str, list[bool]] = {}

    def add_timer(self, timer: Any) -> int:
        """Wait for a timer; returns the index by which `is_ready` knows it."""
        return self._add("timer", timer, Timer)

    def add_guard_condition(self, gc: Any) -> int:
        """Wait for a guard condition; returns the index by which `is_ready` knows it."""
        return self._add("guard_condition", gc, GuardCondition)

    def _add(self, kind: str, entity: Any, expected: type) -> int:
        entity = getattr(entity, "_entity", entity)  # of a handle
        if not isinstance(entity, expected):
            raise TypeError(f"a {expected.__name__}, or its handle, is expected, got {entity!r}")
        self.entities[kind].append(entity)
        return len(self.entities[kind]) - 1

    def is_ready(self, entity_type: str, index: int) -> bool:
        """Whether the timer or guard condition that was added as number `index` is ready. Raises IndexError."""
        return self._ready_of(entity_type)[index]

    def get_ready_entities(self, entity_type: str) -> list[int]:
        """The `pointer`s of what is ready, of one kind."""
        ready = self._ready_of(entity_type)
        return [
            entity.handle.pointer
            for entity, is_ready in zip(self.entities[entity_type], ready, strict=True)
            if is_ready
        ]

    def _ready_of(self, entity_type: str) -> list[bool]:
        if entity_type not in self.entities:
            known = ", ".join(self.entities)
            raise RuntimeError(f"'{entity_type}' is not a known entity of a wait set here; known are {known}")
        return self.ready.get(entity_type, [False] * len(self.entities[entity_type]))

    def look(self) -> None:
        """Note what is ready now. A guard condition is ready once for each time that it was triggered."""
        self.ready = {kind: [each._has_work() for each in found] for kind, found in self.entities.items()}
        for guard in self.entities["guard_condition"]:
            guard._triggered = False

    def __getattr__(self, name: str) -> Any:
        if name in {"add_subscription", "add_client", "add_service", "add_event"}:
            raise NotImplementedError(
                f"a waitable here can wait for timers and guard conditions, and so has no {name}: give the node a "
                "subscription, client or service of its own, and trigger a guard condition in its callback"
            )
        raise AttributeError(name)


class WaitableEntity(Entity):
    """A waitable in a node: asked in the executor's cycles, before all else, as in rclpy's executors.py."""

    _kind = WAITABLE

    def __init__(self, waitable: Any) -> None:
        super().__init__(waitable.execute, None)
        self.waitable = waitable
        self.callback_group = waitable.callback_group
        self._begin, self._end_run = begin_of(waitable.callback_group), end_of(waitable.callback_group)
        self._is_async = True
        self._simulation = current_world().sim
        self._wait_set: WaitSet | None = None
        self._is_ready = False

    def __repr__(self) -> str:
        return f"<Waitable {type(self.waitable).__name__}>"

    def _has_work(self) -> bool:
        if not self._is_ready:
            with self.waitable:
                if self._wait_set is None:
                    self._wait_set = self._gather()
                self._wait_set.look()
                self._is_ready = bool(self.waitable.is_ready(self._wait_set))
        return self._is_ready

    def _gather(self) -> WaitSet:
        """Ask the waitable what it waits for, and hear of that from now on."""
        wait_set = WaitSet()
        self.waitable.get_num_entities()
        self.waitable.add_to_wait_set(wait_set)
        for entity in [*wait_set.entities["timer"], *wait_set.entities["guard_condition"]]:
            entity._signal = self._signal
        return wait_set

    def _take(self) -> tuple[Any, ...]:
        self._is_ready = False
        for future in self.waitable._futures:
            future._set_executor(self._executor)
        data = self.waitable.take_data()
        # It may be ready once more. Looking takes a moment, so that one that always is does not stop the time.
        self._simulation.at(self._simulation.now + SHORTEST, _look_again, self)
        return (data,)


def _look_again(entity: WaitableEntity) -> None:
    entity._signal()
