"""Which ROS 2 there is in this Python: a real one that was sourced, or the simulated one of this package alone."""

from __future__ import annotations

import importlib.util
from pathlib import Path

HERE = Path(__file__).resolve().parent


def real_ros() -> str:
    """Where the rclpy of a real ROS 2 is; "" where only the simulated one would be imported. Nothing is imported."""
    found = importlib.util.find_spec("rclpy")
    if found is None or found.origin is None:
        return "nowhere"
    return "" if Path(found.origin).resolve().is_relative_to(HERE) else found.origin
