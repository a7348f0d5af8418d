"""`connect()` joins a real, running ROS 2, and a `Robot` shows it with the widgets and pictures of the lab."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING

from ..learner.story import HERE
from ..ros.idl.registry import uninstall_finder
from .views import Views, Widget

if TYPE_CHECKING:
    from ..lab.graph import GraphPicture
    from .robot_backend import RobotBackend

_newest: Robot | None = None


def real_ros() -> str:
    """Where the rclpy of a real ROS 2 is; "" where only the simulated one would be imported. Nothing is imported."""
    found = find_spec("rclpy")
    if found is None or found.origin is None:
        return "nowhere"
    return "" if Path(found.origin).resolve().is_relative_to(HERE) else found.origin


def connect() -> Robot:
    """Join the ROS 2 system that runs here with a hidden node, `/_lab`, and return the `Robot` that shows it.

    A cell can be run twice: what the `connect()` before has made is closed. ROS_DOMAIN_ID and similar variables count, as
    for any node. The node has a context of its own, so that the notebook's `rclpy.init()` and `rclpy.shutdown()` do not touch
    it.

    Raises RuntimeError where no real ROS 2 is sourced, and in a script, which has no event loop that goes on.
    """
    global _newest
    if real_ros() in ("", "nowhere"):
        raise RuntimeError(
            "there is no real ROS 2 here to connect to, only the simulated one. In a terminal: source "
            "/opt/ros/jazzy/setup.bash (or that of your release), and start Jupyter from there. In the simulated world "
            "you get the same widgets from: from turtle_lesson import start; lesson = start()"
        )
    try:
        asyncio.get_running_loop()
    except RuntimeError:
        raise RuntimeError(
            "connect() needs a notebook, whose event loop receives the messages; in a script use rclpy itself"
        ) from None
    uninstall_finder()  # or what is not installed on the real one would be imported from the simulated one, and not fit
    from .robot_backend import RobotBackend

    if _newest is not None:
        _newest.close()
    _newest = Robot(RobotBackend())
    return _newest


class Robot(Views):
    """A real system, seen from a notebook. Times are in seconds since `connect()`."""

    _backend: RobotBackend

    def __init__(self, backend: RobotBackend) -> None:
        self._backend = backend

    def __repr__(self) -> str:
        return f"<Robot: {self._backend.state}>"

    @property
    def now(self) -> float:
        """Seconds since `connect()`, on the clock of the node."""
        return self._backend.now

    def close(self) -> None:
        """Leave the system: the widgets end, what was heard stays. Nothing waits for it."""
        self._backend.close()

    def plot_graph(self) -> GraphPicture:
        """Which nodes there are, and by which topics and services they are joined."""
        self._check_connected()
        return super().plot_graph()

    def _widget(self, kind: Callable[..., Widget], *arguments: object) -> Widget:
        self._check_connected()
        return super()._widget(kind, *arguments)

    def _check_connected(self) -> None:
        if self._backend.ended:
            raise RuntimeError("this connection has ended: robot = connect() makes a new one")
