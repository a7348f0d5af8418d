"""When a message was made: by its header, or by the clock for those that have none."""

from __future__ import annotations

from typing import Any

from rclpy.clock import ROSClock
from rclpy.logging import LoggingSeverity, get_logger
from rclpy.time import Time


def stamp_of(msg: Any, allow_headerless: bool, logger: str) -> Time | None:
    """A message's time; None, with a warning, for a message without header where that is not allowed."""
    if hasattr(msg, "header") and hasattr(msg.header, "stamp"):
        stamp = msg.header.stamp
        return stamp if hasattr(stamp, "nanoseconds") else Time.from_msg(stamp)
    if allow_headerless:
        return ROSClock().now()
    _warn(logger, type(msg).__name__)
    return None


def _warn(name: str, kind: str) -> None:
    logger = get_logger(name)
    logger.set_level(LoggingSeverity.INFO)
    logger.warning(
        f"a {kind} has no header with a stamp, so it is left out; with allow_headerless=True it is given the time "
        "at which it comes"
    )
