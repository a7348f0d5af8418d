"""The panel with the log: what the nodes say on /rosout."""

from __future__ import annotations

from operator import itemgetter
from typing import Any

import traitlets

from ..recording import NANOSECONDS
from .live_widget import LiveWidget
from .pace import Pace

KEPT = 500
"""Lines that are kept, about."""
BLOCK = 50
"""New lines are sent again with each newer one until there are so many; the older ones only once a block."""
LEVELS = ("DEBUG", "INFO", "WARN", "ERROR", "FATAL")

Line = list[Any]
"""Number, robot time (s), level, name of the logger, text."""


class LogPanel(LiveWidget):
    """Keeps the newest lines of the log. It is sent in two pieces, so that a new line does not cost the whole log."""

    log_old: Any = traitlets.List().tag(sync=True)
    log_new: Any = traitlets.List().tag(sync=True)
    log_least = traitlets.Unicode("INFO").tag(sync=True)
    """Lines below this level are not shown."""

    def __init__(self, *arguments: Any, **traits: Any) -> None:
        self._log_pace = Pace(5)
        self._log_waiting: list[tuple[int, str, str, str]] = []
        self._log_count = 0
        self._log_newest = self._log_read_until = 0
        self._rosout: Any = None
        super().__init__(*arguments, **traits)

    def opened(self) -> None:
        """Listen to /rosout. What nodes said before comes first: /rosout keeps it for late listeners."""
        super().opened()
        from rcl_interfaces.msg import Log
        from rclpy.qos import DurabilityPolicy, QoSProfile

        self._log_read_until = self._log_newest
        latched = QoSProfile(depth=1000, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        hear = self._hear_log
        loop = self.station.loop
        self._rosout = self.station.node.create_subscription(
            Log, "/rosout", lambda message: loop.now_or_soon(hear, message), latched
        )

    def closed(self) -> None:
        """Listen no more."""
        super().closed()
        if self._rosout is not None:
            self.station.node.destroy_subscription(self._rosout)
            self._rosout = None

    def tick(self) -> None:
        """Take over the lines that have come."""
        super().tick()
        if self._log_waiting and self._log_pace.due():
            waiting, self._log_waiting = self._log_waiting, []
            self._add_lines(sorted(waiting, key=itemgetter(0)))

    def do_log_least(self, level: str) -> None:
        """Show only lines of this level and above."""
        if level not in LEVELS:
            raise ValueError(f"There is no level {level!r}; there are {', '.join(LEVELS)}.")
        self.log_least = level

    def _hear_log(self, message: Any) -> None:
        stamp = message.stamp.sec * NANOSECONDS + message.stamp.nanosec
        if stamp <= self._log_read_until:
            return  # heard before the panel was last closed
        self._log_newest = max(self._log_newest, stamp)
        self._log_waiting.append((stamp, level_name(message.level), message.name, message.msg))
        del self._log_waiting[:-KEPT]

    def _add_lines(self, heard: list[tuple[int, str, str, str]]) -> None:
        lines: list[Line] = []
        for stamp, *what in heard:
            self._log_count += 1
            lines.append([self._log_count, round(float(self.station.recorder.seconds(stamp)), 3), *what])
        new = [*self.log_new, *lines]
        if len(new) > BLOCK:
            self.log_old = [*self.log_old, *new][-KEPT:]
            new = []
        self.log_new = new


def level_name(level: Any) -> str:
    """The name of a level of rcl_interfaces/msg/Log: 20 is "INFO", and so is what lies between 20 and 30."""
    number = level[0] if isinstance(level, bytes) else int(level)
    return LEVELS[min(max(number // 10 - 1, 0), len(LEVELS) - 1)]
