"""Event handlers: what to do when something happens."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from ._context import BaseEventHandler, Event, EventHandler, LaunchContext, as_entities
from ._entities import Action, LaunchDescriptionEntity, SomeEntitiesType
from ._package import explain_missing
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


Reaction = SomeEntitiesType | Callable[[Any, LaunchContext], SomeEntitiesType | None] | None
Target = Action | Callable[[Any], bool] | None


class OnActionEventBase(BaseEventHandler):
    """Reacts to one kind of event of one action, of those that a function picks, or of all."""

    def __init__(
        self, *, action_matcher: Target, on_event: Reaction, target_event_cls: type[Event], **kwargs: Any
    ) -> None:
        if not (action_matcher is None or callable(action_matcher) or isinstance(action_matcher, Action)):
            what = f"{type(self).__name__} requires an 'Action' or a callable as its target"
            raise TypeError(f"{what}, got {action_matcher!r}; write target_action=the_node")
        super().__init__(matcher=self._is_for, **kwargs)
        self.__target = action_matcher
        self.__event_class = target_event_cls
        self.__reaction = on_event
        self.__entities = [] if callable(on_event) else as_entities(on_event)

    @property
    def _target_action(self) -> Action | None:
        """The only action that it reacts to, if it was given one."""
        return self.__target if isinstance(self.__target, Action) else None

    def _is_for(self, event: Event) -> bool:
        if not isinstance(event, self.__event_class):
            return False
        action = getattr(event, "action", None)
        if self.__target is None or isinstance(self.__target, Action):
            return self.__target in (None, action)
        return self.__target(action)

    def describe(self) -> tuple[str, list[LaunchDescriptionEntity]]:
        """In words, and the entities as far as they are known."""
        return f"{type(self).__name__}()", self.__entities

    def handle(self, event: Event, context: LaunchContext) -> SomeEntitiesType | None:
        """Call the function, or give the entities."""
        super().handle(event, context)
        if callable(self.__reaction):
            return self.__reaction(event, context)
        return self.__entities


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


class OnShutdown(BaseEventHandler):
    """Reacts to the end of the launch."""

    def __init__(self, *, on_shutdown: Reaction, **kwargs: Any) -> None:
        super().__init__(matcher=lambda event: isinstance(event, Shutdown), **kwargs)
        self.__reaction = on_shutdown
        self.__entities = [] if callable(on_shutdown) else as_entities(on_shutdown)

    def describe(self) -> tuple[str, list[LaunchDescriptionEntity]]:
        """In words, and the entities as far as they are known."""
        return "OnShutdown()", self.__entities

    def handle(self, event: Event, context: LaunchContext) -> SomeEntitiesType | None:
        """Call the function, or give the entities."""
        super().handle(event, context)
        if callable(self.__reaction):
            return self.__reaction(event, context)
        return self.__entities


__getattr__ = explain_missing(
    __name__, {"OnIncludeLaunchDescription": "launch itself carries an included description out"}
)
