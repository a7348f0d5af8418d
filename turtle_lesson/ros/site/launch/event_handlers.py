"""Event handlers: what to do when something happens."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from ._context import Event, EventHandler, LaunchContext, Reaction
from ._entities import Action, SomeEntitiesType
from .events import ExecutionComplete, Shutdown
from .events.process import ProcessExited, ProcessIO, ProcessStarted

__all__ = [
    "EventHandler",
    "OnExecutionComplete",
    "OnProcessExit",
    "OnProcessIO",
    "OnProcessStart",
    "OnShutdown",
]


Target = Action | Callable[[Any], bool] | None


class _OnActionEvent(EventHandler):
    """Reacts to one kind of event of one action, of those that a function picks, or of all."""

    def __init__(self, target: Target, reaction: Reaction, event_class: type[Event], **kwargs: Any) -> None:
        if not (target is None or callable(target) or isinstance(target, Action)):
            what = f"{type(self).__name__} requires an 'Action' or a callable as its target"
            raise TypeError(f"{what}, got {target!r}; write target_action=the_node")
        super().__init__(matcher=self._is_for, entities=reaction, **kwargs)
        self._target = target
        self._event_class = event_class

    def _is_for(self, event: Event) -> bool:
        if not isinstance(event, self._event_class):
            return False
        action = getattr(event, "action", None)
        return self._target(action) if callable(self._target) else self._target in (None, action)


class OnExecutionComplete(_OnActionEvent):
    """Reacts to the end of any action."""

    def __init__(self, *, target_action: Target = None, on_completion: Reaction = None, **kwargs: Any) -> None:
        super().__init__(target_action, on_completion, ExecutionComplete, **kwargs)


class OnProcessStart(_OnActionEvent):
    """Reacts to the start of a process."""

    def __init__(self, *, target_action: Target = None, on_start: Reaction = None, **kwargs: Any) -> None:
        super().__init__(target_action, on_start, ProcessStarted, **kwargs)


class OnProcessExit(_OnActionEvent):
    """Reacts to the end of a process."""

    def __init__(self, *, target_action: Target = None, on_exit: Reaction = None, **kwargs: Any) -> None:
        super().__init__(target_action, on_exit, ProcessExited, **kwargs)


OnOutput = Callable[[ProcessIO], SomeEntitiesType | None]


class OnProcessIO(_OnActionEvent):
    """Calls a function with each piece of output of a process (`event.text`, bytes)."""

    def __init__(
        self,
        *,
        target_action: Target = None,
        on_stdout: OnOutput | None = None,
        on_stderr: OnOutput | None = None,
        **kwargs: Any,
    ) -> None:
        def react(event: ProcessIO, context: LaunchContext) -> SomeEntitiesType | None:
            function = on_stdout if event.from_stdout else on_stderr
            return function(event) if function is not None else None

        super().__init__(target_action, react, ProcessIO, **kwargs)


class OnShutdown(EventHandler):
    """Reacts to the end of the launch."""

    def __init__(self, *, on_shutdown: Reaction, **kwargs: Any) -> None:
        super().__init__(matcher=lambda event: isinstance(event, Shutdown), entities=on_shutdown, **kwargs)
