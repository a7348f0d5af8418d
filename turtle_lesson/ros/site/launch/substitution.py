"""`Substitution`: a piece of text that is known only when the launch runs."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .launch_context import LaunchContext


class Substitution:
    """Base of everything that stands for text in a launch description."""

    def perform(self, context: LaunchContext) -> str:
        """The text, in this context."""
        raise NotImplementedError(f"{type(self).__name__} must define perform(self, context)")

    def __repr__(self) -> str:
        return self.describe()

    def describe(self) -> str:
        """How `--show-args` shows it."""
        return f"{type(self).__name__}()"
