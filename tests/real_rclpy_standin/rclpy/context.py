"""Contexts: each a life of its own in one program."""

from __future__ import annotations

from rclpy import _network


class Context:
    def __init__(self) -> None:
        self._begun = self._ended = False
        self.executors: list = []

    def init(
        self, args: list[str] | None = None, *, initialize_logging: bool = True, domain_id: int | None = None
    ) -> None:
        if self._begun:
            raise RuntimeError("Context.init() must only be called once")
        self._begun = True
        _network.contexts.append(self)

    def ok(self) -> bool:
        return self._begun and not self._ended

    def shutdown(self) -> None:
        if not self._begun:
            raise RuntimeError("Context must be initialized before it can be shutdown")
        self._ended = True
        if self in _network.contexts:
            _network.contexts.remove(self)
        for executor in self.executors:
            executor.wake()

    def try_shutdown(self) -> None:
        if self.ok():
            self.shutdown()


_default = Context()


def get_default_context() -> Context:
    return _default
