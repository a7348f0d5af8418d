"""`ros2 doctor` and `ros2 daemon`: what is running in the simulation, and what looks wrong."""

from __future__ import annotations

import sys
from argparse import Namespace
from collections import Counter
from collections.abc import Sized
from dataclasses import dataclass
from typing import TYPE_CHECKING

from ..idl.names import is_hidden
from ..runtime.world import current_world
from .arguments import flag
from .jobs import jobs
from .verb import direct_node, node_names, services, topics, verb

if TYPE_CHECKING:
    from rclpy.node import Node


CHECKS = 2


@verb(
    "doctor",
    flag("-r --report", "also list nodes, topics, services and jobs"),
    flag("-rf --report-failed", "accepted: only failed checks are printed anyway"),
    flag("-iw --include-warnings", "count warnings as failures"),
)
def _doctor(args: Namespace) -> int:
    """Describe this simulation, what is running, and what looks wrong."""
    with direct_node() as node:
        _introduce(node)
        if args.report:
            _report(node)
        complaints = _complaints(node)
    for text in complaints:
        print(f"WARNING: {text}", file=sys.stderr)
    print()
    if complaints and args.include_warnings:
        print(f"{_counted(complaints, 'warning')} in {CHECKS} checks")
        return 1
    print(f"All {CHECKS} checks passed" + (f", with {_counted(complaints, 'warning')}" if complaints else ""))
    return 0


def _introduce(node: Node) -> None:
    world = current_world()
    print("This is Turtle Lesson's simulation of a robot's computer, with no ROS 2 installed.")
    print(f"It behaves as ROS 2 {world.release.title} does. Robot time {(world.now / 1e9):.1f} s, seed {world.seed}.")
    packages = world.packages.names()
    up = [_counted(node_names(node), "node"), _counted(topics(node), "topic"), _counted(services(node), "service")]
    print(f"Up: {', '.join(up)}. {_counted(packages, 'package')} with programs: {', '.join(packages) or 'none'}.")


def _counted(things: Sized, name: str) -> str:
    return f"{len(things)} {name}{'' if len(things) == 1 else 's'}"


def _report(node: Node) -> None:
    lists = {
        "NODES": node_names(node),
        "TOPICS": [f"{name} [{', '.join(types)}]" for name, types in topics(node).items()],
        "SERVICES": [f"{name} [{', '.join(types)}]" for name, types in services(node).items()],
        "JOBS": [f"%{job.number} {job.words}" for job in jobs(current_world()).running],
    }
    for title, lines in lists.items():
        print(f"\n   {title}")
        print("\n".join(lines) or "none")


def _complaints(node: Node) -> list[str]:
    """Names that several nodes have, and topics that only have one side, as the real doctor tells them."""
    counts = Counter(node_names(node))
    found = [f"{count} nodes share the name {name}" for name, count in counts.items() if count > 1]
    for name in topics(node):
        publishers, subscriptions = node.count_publishers(name), node.count_subscribers(name)
        if is_hidden(name) or name in {"/rosout", "/parameter_events"}:
            continue
        if publishers and not subscriptions:
            found.append(f"Publisher without subscriber detected on {name}.")
        if subscriptions and not publishers:
            found.append(f"Subscriber without publisher detected on {name}.")
    return found


# -- daemon ------------------------------------------------------------------------------------------------------------
# On a robot it remembers the graph for the other commands. No command needs it here; it only says that it is there.


@dataclass
class _Daemon:
    running: bool = True


def _add_daemon(name: str, help_text: str, up: str, down: str, after: bool | None = None) -> None:
    """Add a verb that says whether the daemon is up or down, and that may change it."""

    @verb(f"daemon {name}", help_text=help_text, in_cell=True)
    def work(args: Namespace) -> None:
        daemon = current_world().notebook.state(_Daemon)
        print(f"The daemon {up if daemon.running else down}")
        daemon.running = daemon.running if after is None else after


_add_daemon("start", "Start the daemon", "is already running", "has been started", True)
_add_daemon("status", "Show whether the daemon is running", "is running", "is not running")
_add_daemon("stop", "Stop the daemon", "has been stopped", "is not running", False)
