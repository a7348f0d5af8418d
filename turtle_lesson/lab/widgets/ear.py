"""An ear at a topic that the recorder does not hear: it only notes when messages were sent."""

from __future__ import annotations

import importlib
from collections import deque
from collections.abc import Mapping
from typing import Any

import numpy as np

from ..channel import with_time
from .station import Station

KEPT = 1000
"""Times that are kept: five seconds of a topic with 200 messages a second."""


class Ear:
    """Listens to one topic until it is closed. `trouble` says why it cannot, if it cannot."""

    def __init__(self, station: Station, topic: str, type_name: str) -> None:
        self._station = station
        self._stamps: deque[int] = deque(maxlen=KEPT)
        self._subscription: Any = None
        self.trouble = ""
        try:
            self._subscription = self._subscribe(topic, type_name)
        except Exception as error:  # a type that is not built here, or that is another one in this very program
            self.trouble = f"{type_name} cannot be heard here: {error}"

    @property
    def stamps(self) -> np.ndarray:
        """When the newest messages were sent, ns."""
        return np.fromiter(self._stamps, np.int64)

    def close(self) -> None:
        """Listen no more."""
        if self._subscription is not None:
            self._station.node.destroy_subscription(self._subscription)
            self._subscription = None

    def _subscribe(self, topic: str, type_name: str) -> Any:
        from rclpy.qos import QoSProfile, ReliabilityPolicy

        package, kind, name = type_name.split("/")
        message_type = getattr(importlib.import_module(f"{package}.{kind}"), name)
        loop, add = self._station.loop, self._stamps.append

        def hear(message: Any, info: Mapping[str, Any]) -> None:
            loop.now_or_soon(add, info["source_timestamp"])

        node = self._station.node
        quality = QoSProfile(depth=KEPT, reliability=ReliabilityPolicy.BEST_EFFORT)
        bare = self._station.clock is None  # on a robot, where it may be images: never made into Python objects
        return node.create_subscription(message_type, topic, with_time(node, hear), quality, raw=bare)
