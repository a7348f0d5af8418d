"""What rclpy calls experimental: the events executor (newer than Humble)."""

from __future__ import annotations

from .events_executor import EventsExecutor

__all__ = ["EventsExecutor"]
