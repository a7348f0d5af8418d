"""`OnProcessIO`: what to do when a process has printed something."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from ..events.process import ProcessIO
from ..launch_context import LaunchContext
from ..some_types import SomeEntitiesType
from .on_action_event_base import OnActionEventBase, Target

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
