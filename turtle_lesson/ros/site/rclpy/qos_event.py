"""Humble's name for what is `rclpy.event_handler` since Iron. Both work, here as on a robot of those in between."""

from .event_handler import *  # noqa: F403
