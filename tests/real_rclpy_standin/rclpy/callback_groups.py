"""Callback groups: who of an executor's entities may be called."""

from __future__ import annotations


class CallbackGroup:
    def can_execute(self, entity: object) -> bool:
        raise NotImplementedError

    def beginning_execution(self, entity: object) -> bool:
        raise NotImplementedError

    def ending_execution(self, entity: object) -> None:
        raise NotImplementedError


class ReentrantCallbackGroup(CallbackGroup):
    def can_execute(self, entity: object) -> bool:
        return True

    def beginning_execution(self, entity: object) -> bool:
        return True

    def ending_execution(self, entity: object) -> None:
        pass
