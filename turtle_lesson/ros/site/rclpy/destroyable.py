"""What can be held so that it is not destroyed meanwhile (a protocol for type hints; newer than Humble)."""

from __future__ import annotations

from types import TracebackType
from typing import Protocol

__all__ = ["DestroyableType"]


class DestroyableType(Protocol):
    """A handle."""

    def __enter__(self) -> None:
        """Hold it."""

    def __exit__(
        self, exc_type: type[BaseException] | None, exc_val: BaseException | None, exc_tb: TracebackType | None
    ) -> None:
        """Let it go."""

    def destroy_when_not_in_use(self) -> None:
        """Destroy it as soon as nobody holds it."""
