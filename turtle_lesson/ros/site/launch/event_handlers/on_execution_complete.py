"""`OnExecutionComplete`: what to do when an action is done."""

from __future__ import annotations

from typing import Any

from ..events import ExecutionComplete
from .on_action_event_base import OnActionEventBase, Reaction, Target


class OnExecutionComplete(OnActionEventBase):
    """Reacts to the end of any action."""

    def __init__(self, *, target_action: Target = None, on_completion: Reaction = None, **kwargs: Any) -> None:
        super().__init__(
            action_matcher=target_action, on_event=on_completion, target_event_cls=ExecutionComplete, **kwargs
        )
