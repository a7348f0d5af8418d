"""Turtle Lesson: learn to build a ROS 2 robot controller in notebooks, without installing ROS.

Importing this package makes `rclpy`, `launch` and the message packages importable. They come last on `sys.path`, so
that a real ROS 2 which is sourced is never hidden. `start()` makes a simulated world to work in, and `connect()` shows
a real robot.
"""

from __future__ import annotations

import sys
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .ros.sim.defer_sigint import defer_sigint

with defer_sigint():
    from .ros import hooks
    from .ros.stdlib import patches

if TYPE_CHECKING:
    from .session.lesson import Lesson, start
    from .session.robot import Robot, connect

__version__ = "0.2.0"
__all__ = ["Lesson", "Robot", "connect", "load_ipython_extension", "start"]

SITE = str(Path(__file__).resolve().parent / "ros" / "site")


def _is_page(place: Path) -> bool:
    from .learner.story import PAGES

    return place.suffix.lower() == ".ipynb" and place.stem.lower() in {*PAGES, "lab"}


def load_ipython_extension(shell: Any) -> None:
    """What `%load_ext turtle_lesson` does: errors are shown from the learner's point of view, commands are understood."""
    with defer_sigint():
        from .notebook import prepare

        prepare(shell)


def __getattr__(name: str) -> Any:
    room = {"Lesson": "lesson", "start": "lesson", "Robot": "robot", "connect": "robot"}.get(name)
    if room is None:
        raise AttributeError(f"module 'turtle_lesson' has no attribute {name!r}")
    with defer_sigint():
        return getattr(import_module(f"turtle_lesson.session.{room}"), name)


with defer_sigint():
    if SITE not in sys.path:  # what a learner imports comes last, the way sourcing a setup file adds to the path
        sys.path.append(SITE)
    patches.install_early()
    hooks.is_page = _is_page
