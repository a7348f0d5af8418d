"""Numbers for goals. They look random and are the same in every run, as everything in a simulated world."""

from __future__ import annotations

from random import Random
from typing import Any
from uuid import UUID as Number

from unique_identifier_msgs.msg import UUID

from turtle_lesson.ros.world import current_process


def new_goal_id() -> Any:
    """A number that no other goal has, from a source of its own, so that a program's random numbers do not shift."""
    process = current_process()
    source = process.locals.get("rclpy.action.ids")
    if source is None:
        source = process.locals["rclpy.action.ids"] = Random(f"{process.seed}/goal ids")
    return UUID(uuid=list(Number(int=source.getrandbits(128), version=4).bytes))
