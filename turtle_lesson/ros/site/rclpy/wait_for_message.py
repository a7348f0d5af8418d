"""`wait_for_message`: the next message of a topic, without a callback."""

from __future__ import annotations

from typing import Any

from turtle_lesson.ros.sim.simulation import NANOSECONDS
from turtle_lesson.ros.sim.strand import running_strand

from ._blocking import WakeUp, drives_the_simulation
from ._entity import Assignment
from .node import Node
from .qos import QoSProfile


@drives_the_simulation
def wait_for_message(
    msg_type: Any, node: Node, topic: str, time_to_wait: float = -1, *, qos_profile: QoSProfile | int = 1
) -> tuple[bool, Any]:
    """(True, message) for the next message that comes, or (False, None) after `time_to_wait` (s; -1 waits forever).

    Also (False, None) if ROS is shut down meanwhile. The node need not be spun, and none of its callbacks is called.
    """
    strand = running_strand()
    assert strand is not None
    strand.activity = f"wait_for_message on {topic}"
    simulation = strand.simulation
    subscription = node.create_subscription(msg_type, topic, None, qos_profile)  # type: ignore[arg-type]
    subscription._assign(Assignment())  # nobody else is to take what comes
    wake_up = WakeUp(node.context)
    subscription._reader.wake = wake_up.wake
    try:
        deadline = None if time_to_wait < 0 else simulation.now + int(time_to_wait * NANOSECONDS)
        wake_up.wait(deadline, only_from_within=False)
        return (True, subscription._take()[0]) if subscription._has_work() else (False, None)
    finally:
        node.destroy_subscription(subscription)
