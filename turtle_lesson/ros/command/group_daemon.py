"""`ros2 daemon`: on a robot a helper that remembers the graph. No command needs it here; it only says that it is there."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace

from ..world import current_world
from .in_cell import CellCommand

STATE = "ros2 daemon"


def _nothing(parser: ArgumentParser) -> None:
    """No arguments."""


def _running() -> bool:
    return bool(current_world().notebook.locals.get(STATE, True))


def _start(args: Namespace) -> None:
    print("The daemon is already running" if _running() else "The daemon has been started")
    current_world().notebook.locals[STATE] = True


def _status(args: Namespace) -> None:
    print("The daemon is running" if _running() else "The daemon is not running")


def _stop(args: Namespace) -> None:
    print("The daemon has been stopped" if _running() else "The daemon is not running")
    current_world().notebook.locals[STATE] = False


VERBS = {
    "start": CellCommand("Start the daemon", _nothing, _start),
    "status": CellCommand("Show whether the daemon is running", _nothing, _status),
    "stop": CellCommand("Stop the daemon", _nothing, _stop),
}
