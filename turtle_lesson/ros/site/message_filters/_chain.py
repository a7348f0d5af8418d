"""Filters in a row, seen as one."""

from __future__ import annotations

from typing import Any

from ._filters import SimpleFilter


class Chain(SimpleFilter):
    """What comes in runs through all filters that were added; what leaves the last one comes out."""

    def __init__(self, message_filter: SimpleFilter | None = None) -> None:
        super().__init__()
        self.incoming_connection: int | None = None
        self._filters: list[Any] = []
        self._outlets: list[int] = []
        if message_filter is not None:
            self.connectInput(message_filter)

    def connectInput(self, message_filter: SimpleFilter) -> None:
        """Take messages from another filter. Raises RuntimeError the second time."""
        if self.incoming_connection is not None:
            raise RuntimeError("Already connected")
        self.incoming_connection = message_filter.registerCallback(self.add)

    def add(self, message: Any) -> None:
        """Have a message run through."""
        if self._filters:
            self._filters[0].add(message)
        else:
            self.signalMessage(message)

    def addFilter(self, message_filter: Any) -> None:
        """Put a filter behind those that are there."""
        if self._filters:
            last = self._filters[-1]
            last.callbacks.pop(self._outlets[-1])
            self._outlets[-1] = last.registerCallback(message_filter.add)
        self._filters.append(message_filter)
        self._outlets.append(message_filter.registerCallback(self.signalMessage))

    def getFilter(self, index: int) -> Any:
        """The filter with this number, from 0 on."""
        return self._filters[index]
