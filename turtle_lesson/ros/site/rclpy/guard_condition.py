"""Guard conditions: a callback that a program triggers by itself."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from ._entity import GUARD, Entity
from .callback_groups import CallbackGroup


class GuardCondition(Entity):
    """Made by `Node.create_guard_condition`."""

    _kind = GUARD

    def __init__(self, callback: Callable[..., Any] | None, callback_group: CallbackGroup) -> None:
        super().__init__(callback, callback_group)
        self._triggered = False

    def trigger(self) -> None:
        """Have the callback called once, soon."""
        self._check_alive()
        self._triggered = True
        self._signal()

    def _has_work(self) -> bool:
        return self._triggered

    def _take(self) -> tuple[Any, ...]:
        self._triggered = False
        return ()
