"""`OpaqueCoroutine`: run a Python coroutine while the launch runs."""

from __future__ import annotations

from collections.abc import Callable, Coroutine, Iterable
from typing import Any

from ..action import Action
from ..launch_context import LaunchContext
from ..launch_description_entity import LaunchDescriptionEntity


class OpaqueCoroutine(Action):
    """Runs `coroutine(context, *args, **kwargs)` beside the rest of the launch.

    Here it may await other coroutines and `asyncio.sleep`, which takes robot time; there is no asyncio loop for more.
    """

    _completes_later = True

    def __init__(
        self,
        *,
        coroutine: Callable[..., Coroutine[Any, Any, Any]],
        args: Iterable[Any] | None = None,
        kwargs: dict[str, Any] | None = None,
        ignore_context: bool = False,
        **left_over_kwargs: Any,
    ) -> None:
        import inspect

        super().__init__(**left_over_kwargs)
        if not inspect.iscoroutinefunction(coroutine):
            raise TypeError(f"OpaqueCoroutine expected a coroutine function for 'coroutine', got '{type(coroutine)}'")
        self.__coroutine = coroutine
        self.__args = list(args or [])
        self.__kwargs = dict(kwargs or {})
        self.__ignore_context = ignore_context

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity] | None:
        """Begin it."""
        if context._host is not None:
            args = self.__args if self.__ignore_context else [context, *self.__args]
            context._host.run_coroutine(self.__coroutine(*args, **self.__kwargs), lambda: self._complete(context))
        return None
