"""`UnlessCondition`: carried out if a text says false."""

from __future__ import annotations

from ..launch_context import LaunchContext
from .if_condition import IfCondition


class UnlessCondition(IfCondition):
    """Holds for `false` and `0`."""

    def _holds(self, context: LaunchContext) -> bool:
        return not super()._holds(context)
