"""Releases of ROS 2, and what they do differently: the one table that decides it.

A world behaves as one release, `world.release`: Humble, unless `start(distro="jazzy")` or the environment variable
ROS_DISTRO says otherwise. Code that depends on the release asks `release.has(CHANGE)`. What a newer release only adds
(`is_addition`) works in every world, since it can mean nothing else there, but each use is noted: `lesson.export` says
which of them the release lacks.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from dataclasses import dataclass

from .sim.errors import is_library

RELEASES = ("humble", "iron", "jazzy", "kilted")
"""The releases that a world can behave as, the oldest first."""
VARIABLE = "ROS_DISTRO"
"""The environment variable that names the release, as the setup files of a real ROS 2 set it."""


@dataclass(frozen=True)
class Change:
    """What a release has changed since it appeared: what it is, what was before, and where that can be read.

    An addition is what earlier releases only lack, so that it works here in all of them.
    """

    since: str
    what: str
    before: str
    source: str
    is_addition: bool = False


UNCHECKED_FIELDS = Change(
    "iron",
    "a message's field takes any value, unless ROS_PYTHON_CHECK_FIELDS is 1; what cannot be sent is refused when it is sent",
    "a value of a wrong type is refused when it is assigned",
    "rosidl_python, pull request 194",
)
MESSAGE_INFO = Change(
    "iron",
    "a subscription's callback with two parameters gets the message's times, too",
    "the callback is called with the message alone, which is a TypeError",
    "rclpy, pull request 922",
    is_addition=True,
)
CHILD_LOGGERS_ON_ROSOUT = Change(
    "iron",
    "the lines of a logger that `get_child()` has made are published on /rosout",
    "they are only printed",
    "rclpy, pull request 1084",
)
EXECUTOR_AS_CONTEXT = Change(
    "jazzy",
    "`with` shuts an executor down",
    "an executor is no context manager, and `with` raises a TypeError or AttributeError",
    "rclpy, pull request 1118",
    is_addition=True,
)
GOALS_EXPIRE_AFTER_THEIR_END = Change(
    "jazzy",
    "the result of a goal is kept for `result_timeout` after its end",
    "it is kept for `result_timeout` after the goal was accepted",
    "rcl, pull request 1121",
)
TIMES_EQUAL_NO_OTHER_THING = Change(
    "jazzy",
    "`Time == 5` and `Duration == 5` are False",
    "they raise a TypeError",
    "rclpy's time.py and duration.py",
)
DURATION_ARITHMETIC = Change(
    "kilted",
    "durations can be added, subtracted and multiplied",
    "these are TypeErrors; write Duration(nanoseconds=a.nanoseconds + b.nanoseconds)",
    "rclpy, pull request 1387",
    is_addition=True,
)
TASKS_IN_ORDER = Change(
    "kilted",
    "an executor's tasks, and so done callbacks, run in the order in which they were made",
    "of those that are ready together, the newest runs first",
    "rclpy, pull request 1304",
)
FORBIDDEN_TRANSITIONS_ARE_LOGGED = Change(
    "kilted",
    "the service change_state answers success=False to a transition that is not possible, and the node logs an error",
    "an RCLError ends the node's spin, and the call is never answered",
    "rclpy, pull request 1319",
)
SHUTDOWN_WAITS_FOR_THREADS = Change(
    "kilted",
    "MultiThreadedExecutor.shutdown(wait_for_threads=True) waits for the callbacks that still run",
    "it returns at once, and has no such argument",
    "rclpy, pull request 1309",
)


def changes() -> Iterator[Change]:
    """All changes in this table, in the order of the releases."""
    return (value for value in globals().values() if isinstance(value, Change))


class Release:
    """A release of ROS 2, by its name such as "humble". Raises ValueError for another name."""

    def __init__(self, name: str) -> None:
        if name not in RELEASES:
            known = ", ".join(f'"{each}"' for each in RELEASES)
            raise ValueError(f"distro must be one of the releases {known}, got {name!r} (perhaps from {VARIABLE})")
        self.name = name
        self._changes = frozenset(each for each in changes() if RELEASES.index(each.since) <= RELEASES.index(name))
        self.lacked: dict[tuple[Change, str], int] = {}
        """What programs have used that this release lacks, and in which file; the line of the first use."""

    @property
    def title(self) -> str:
        """The name as it is written in a sentence."""
        return self.name.capitalize()

    def has(self, change: Change) -> bool:
        """Whether this release has a change."""
        return change in self._changes

    def note_use(self, change: Change) -> None:
        """A program uses an addition. If this release lacks it, remember where."""
        if change in self._changes:
            return
        frame = sys._getframe(1)
        while frame.f_back is not None and is_library(frame.f_code.co_filename):
            frame = frame.f_back
        self.lacked.setdefault((change, frame.f_code.co_filename), frame.f_lineno)


def chosen_release(distro: str | None) -> Release:
    """The release of this name; without one, that of the environment variable ROS_DISTRO, or Humble. Raises ValueError."""
    return Release(os.environ.get(VARIABLE) or RELEASES[0] if distro is None else distro)
