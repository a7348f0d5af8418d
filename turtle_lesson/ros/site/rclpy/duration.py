"""Durations: a span of time in whole nanoseconds."""

from __future__ import annotations

from functools import total_ordering
from typing import Any

from turtle_lesson.ros.distro import DURATION_ARITHMETIC, TIMES_EQUAL_NO_OTHER_THING
from turtle_lesson.ros.runtime.world import current_world

from .constants import S_TO_NS

LIMIT = 2**63
"""So many ns are too many for ROS."""


@total_ordering
class Duration:
    """`Duration(seconds=…, nanoseconds=…)`; raises OverflowError beyond 63 bits, as ROS does.

    Durations can be added, subtracted and multiplied since Kilted.
    """

    def __init__(self, *, seconds: float = 0, nanoseconds: int = 0) -> None:
        total = int(seconds * S_TO_NS) + int(nanoseconds)
        if not -LIMIT <= total < LIMIT:
            raise OverflowError("Total nanoseconds value is too large to store in C duration.")
        self._nanoseconds = total

    @property
    def nanoseconds(self) -> int:
        """The span in ns."""
        return self._nanoseconds

    def to_msg(self) -> Any:
        """As builtin_interfaces/msg/Duration."""
        from builtin_interfaces.msg import Duration as Message

        seconds, nanoseconds = divmod(self._nanoseconds, S_TO_NS)
        return Message(sec=seconds, nanosec=nanoseconds)

    @classmethod
    def from_msg(cls, msg: Any) -> Duration:
        """From builtin_interfaces/msg/Duration."""
        from builtin_interfaces.msg import Duration as Message

        if not isinstance(msg, Message):
            raise TypeError(f"Must pass a builtin_interfaces.msg.Duration object, got {msg!r}")
        return cls(seconds=msg.sec, nanoseconds=msg.nanosec)

    def __repr__(self) -> str:
        return f"Duration(nanoseconds={self._nanoseconds})"

    def __str__(self) -> str:
        return f"{self._nanoseconds} nanoseconds" if self._nanoseconds < LIMIT - 1 else "Infinite"

    def __eq__(self, other: object) -> bool:
        """Whether it is as long. Raises TypeError until Iron for what is no duration."""
        if isinstance(other, Duration):
            return self._nanoseconds == other._nanoseconds
        return equals_no_other_thing("duration", other)

    __hash__ = None  # type: ignore[assignment]

    def __lt__(self, other: object) -> bool:
        return self._nanoseconds < other._nanoseconds if isinstance(other, Duration) else NotImplemented

    def __add__(self, other: object) -> Duration:
        if not isinstance(other, Duration):
            return NotImplemented  # a Time knows how to add a duration
        current_world().release.note_use(DURATION_ARITHMETIC)
        return Duration(nanoseconds=self._nanoseconds + other._nanoseconds)

    def __sub__(self, other: object) -> Duration:
        return self + Duration(nanoseconds=-other._nanoseconds) if isinstance(other, Duration) else NotImplemented

    def __mul__(self, factor: object) -> Duration:
        if not isinstance(factor, (int, float)):
            return NotImplemented
        current_world().release.note_use(DURATION_ARITHMETIC)
        return Duration(nanoseconds=int(self._nanoseconds * factor))


def equals_no_other_thing(what: str, other: object) -> Any:
    """What `==` of a time or duration says to anything else: the same as rclpy's time.py of the world's release."""
    if current_world().release.has(TIMES_EQUAL_NO_OTHER_THING):
        return NotImplemented
    error = TypeError(f"Can't compare {what} with object of type: ", type(other))
    error.add_note(
        "Compare like with like, such as time.nanoseconds == 5. To ask whether there is one, write `is None`."
    )
    raise error


Infinite = Duration(nanoseconds=LIMIT - 1)
