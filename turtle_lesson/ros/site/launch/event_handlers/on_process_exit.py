"""`OnProcessExit`: what to do when a process has ended."""

from __future__ import annotations

from typing import Any

from ..events.process import ProcessExited
from .on_action_event_base import OnActionEventBase, Reaction, Target


class OnProcessExit(OnActionEventBase):
    """Reacts to the end of a process."""

    def __init__(self, *, target_action: Target = None, on_exit: Reaction = None, **kwargs: Any) -> None:
        super().__init__(action_matcher=target_action, on_event=on_exit, target_event_cls=ProcessExited, **kwargs)
