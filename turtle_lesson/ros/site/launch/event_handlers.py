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
    "OnActionEventBase",
    "OnExecutionComplete",
    "OnProcessExit",
    "OnProcessIO",
    "OnProcessStart",
    "OnShutdown",
]


Target = Action | Callable[[Any], bool] | None


class OnActionEventBase(EventHandler):
    """Reacts to one kind of event of one action, of those that a function picks, or of all."""

    def __init__(
        self, *, action_matcher: Target, on_event: Reaction, target_event_cls: type[Event], **kwargs: Any
    ) -> None:
        if not (action_matcher is None or callable(action_matcher) or isinstance(action_matcher, Action)):
            what = f"{type(self).__name__} requires an 'Action' or a callable as its target"
            raise TypeError(f"{what}, got {action_matcher!r}; write target_action=the_node")
        super().__init__(matcher=self._is_for, entities=on_event, **kwargs)
        self._target = action_matcher
        self._event_class = target_event_cls

    def _is_for(self, event: Event) -> bool:
        if not isinstance(event, self._event_class):
            return False
        action = getattr(event, "action", None)
        if self._target is None or isinstance(self._target, Action):
            return self._target in (None, action)
        return self._target(action)


class OnExecutionComplete(OnActionEventBase):
    """Reacts to the end of any action."""

    def __init__(self, *, target_action: Target = None, on_completion: Reaction = None, **kwargs: Any) -> None:
        super().__init__(
            action_matcher=target_action, on_event=on_completion, target_event_cls=ExecutionComplete, **kwargs
        )


class OnProcessExit(OnActionEventBase):
    """Reacts to the end of a process."""

    def __init__(self, *, target_action: Target = None, on_exit: Reaction = None, **kwargs: Any) -> None:
        super().__init__(action_matcher=target_action, on_event=on_exit, target_event_cls=ProcessExited, **kwargs)


OnOutput = Callable[[ProcessIO], SomeEntitiesType | None]


class OnProcessIO(OnActionEventBase):
    """Calls a function with each piece of output of a process (`event.text`, bytes)."""

    def __init__(
        self,
        *,
        target_action: Target = None,
        on_stdin: OnOutput | None = None,
        on_stdout: OnOutput | None = None,
        on_stderr: OnOutput | None = None,
        **kwargs: Any,
    ) -> None:
        def react(event: ProcessIO, context: LaunchContext) -> SomeEntitiesType | None:
            function = on_stdout if event.from_stdout else on_stderr
            return function(event) if function is not None else None

        super().__init__(action_matcher=target_action, on_event=react, target_event_cls=ProcessIO, **kwargs)


class OnProcessStart(OnActionEventBase):
    """Reacts to the start of a process."""

    def __init__(self, *, target_action: Target = None, on_start: Reaction = None, **kwargs: Any) -> None:
        super().__init__(action_matcher=target_action, on_event=on_start, target_event_cls=ProcessStarted, **kwargs)


class OnShutdown(EventHandler):
    """Reacts to the end of the launch."""

    def __init__(self, *, on_shutdown: Reaction, **kwargs: Any) -> None:
        super().__init__(matcher=lambda event: isinstance(event, Shutdown), entities=on_shutdown, **kwargs)
