"""`OnProcessStart`: what to do when a process has been started."""

from __future__ import annotations

from typing import Any

from ..events.process import ProcessStarted
from .on_action_event_base import OnActionEventBase, Reaction, Target


class OnProcessStart(OnActionEventBase):
    """Reacts to the start of a process."""

    def __init__(self, *, target_action: Target = None, on_start: Reaction = None, **kwargs: Any) -> None:
        super().__init__(action_matcher=target_action, on_event=on_start, target_event_cls=ProcessStarted, **kwargs)
