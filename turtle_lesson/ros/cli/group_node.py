"""`ros2 node`, `lifecycle`, `doctor` and `daemon`: which nodes there are, what each one does, and what looks wrong."""

from __future__ import annotations

import sys
from argparse import Namespace
from collections import Counter
from collections.abc import Sized
from dataclasses import dataclass
from typing import Any

from rclpy.node import Node

from ..idl.names import is_hidden
from ..runtime.world import current_world
from .arguments import ALL_NODES, COUNT_NODES, HIDDEN_NODES, NODE, OF_NODE, arg, flag
from .verb import CommandError, ask, find_node, graph_verb, node_names, print_names, services, suggest, topics, verb

TWINS = "WARNING: Be aware that are nodes in the graph that share an exact name, this can have unintended side effects."


@graph_verb("node list", *NODE, ALL_NODES, COUNT_NODES)
def list_nodes(args: Namespace, node: Node) -> None:
    """The names of the nodes that are running."""
    names = node_names(node, include_hidden=args.all)
    if len(set(names)) < len(names) and not args.count_nodes:
        print(TWINS, file=sys.stderr)
    print_names(names, count=args.count_nodes)


@graph_verb(
    "node info",
    *NODE,
    arg("node_name", "Full name of the node, such as /turtlesim"),
    flag("--include-hidden", "Also show topics and services with a hidden name"),
)
def info(args: Namespace, node: Node) -> None:
    """What a node publishes, subscribes to and offers."""
    names = node_names(node, include_hidden=True)
    name, count = args.node_name, names.count(args.node_name)
    if not count:
        raise CommandError(f"Unable to find node '{name}'", suggest(name, names))
    if count > 1:
        print(
            f'There are {count} nodes in the graph with the exact name "{name}". '
            "You are seeing information about only one of them.",
            file=sys.stderr,
        )
    print(name)
    namespace, _, base = name.rpartition("/")
    for title, find in (
        ("Subscribers", node.get_subscriber_names_and_types_by_node),
        ("Publishers", node.get_publisher_names_and_types_by_node),
        ("Service Servers", node.get_service_names_and_types_by_node),
        ("Service Clients", node.get_client_names_and_types_by_node),
        ("Action Servers", node.get_action_server_names_and_types_by_node),
        ("Action Clients", node.get_action_client_names_and_types_by_node),
    ):
        found = find(base, namespace or "/")
        shown = [(end, types) for end, types in found if args.include_hidden or not is_hidden(end)]
        print(f"  {title}:")
        print("\n".join(f"    {end}: {', '.join(types)}" for end, types in shown))


# -- lifecycle ---------------------------------------------------------------------------------------------------------

GET_STATE = "lifecycle_msgs/srv/GetState"


def _managed(node: Node, include_hidden: bool) -> list[str]:
    """The full names of the managed nodes, sorted."""
    services = dict(node.get_service_names_and_types())
    names = node_names(node, include_hidden)
    return sorted({name for name in names if GET_STATE in services.get(f"{name}/get_state", [])})


@graph_verb("lifecycle nodes", *NODE, ALL_NODES, COUNT_NODES)
def nodes(args: Namespace, node: Node) -> None:
    """The names of the managed nodes."""
    print_names(_managed(node, args.all), count=args.count_nodes)


@graph_verb("lifecycle get", *NODE, arg("node_name", "Name of the node (all managed nodes)", nargs="?"), HIDDEN_NODES)
def get(args: Namespace, node: Node) -> None:
    """The state that a managed node is in."""
    known = _managed(node, args.include_hidden_nodes)
    if args.node_name:
        state = ask(node, find_node(node, args, known), GET_STATE).current_state
        print(f"{state.label} [{state.id}]")
        return
    for name in known:
        try:
            state = ask(node, name, GET_STATE).current_state
        except CommandError as error:
            print(f"Exception while calling service of node '{name}': {error}", file=sys.stderr)
        else:
            print(f"{name}: {state.label} [{state.id}]")


@graph_verb("lifecycle list", *OF_NODE, flag("-a --all", "All transitions, not only those that are possible now"))
def list_transitions(args: Namespace, node: Node) -> None:
    """The transitions that are possible now."""
    name = find_node(node, args, _managed(node, args.include_hidden_nodes))
    for each in _transitions(node, name, "get_transition_graph" if args.all else "get_available_transitions"):
        print(f"- {each.transition.label} [{each.transition.id}]")
        print(f"\tStart: {each.start_state.label}")
        print(f"\tGoal: {each.goal_state.label}")


def _transitions(node: Node, node_name: str, service: str) -> list[Any]:
    return ask(node, node_name, "lifecycle_msgs/srv/GetAvailableTransitions", service).available_transitions


@graph_verb("lifecycle set", *OF_NODE, arg("transition", "Label or number of the transition, such as configure"))
def set_state(args: Namespace, node: Node) -> None:
    """Trigger a transition of a managed node."""
    name = find_node(node, args, _managed(node, args.include_hidden_nodes))
    possible = [each.transition for each in _transitions(node, name, "get_available_transitions")]
    chosen = [each for each in possible if each.label == args.transition]
    chosen += [each for each in possible if str(each.id) == args.transition]
    if not chosen:
        lines = "".join(f"\n- {each.label} [{each.id}]" for each in possible)
        raise CommandError(f"Unknown transition requested, available ones are:{lines}")
    if ask(node, name, "lifecycle_msgs/srv/ChangeState", transition=chosen[0]).success:
        print("Transitioning successful")
    else:
        print("Transitioning failed", file=sys.stderr)


# -- doctor ------------------------------------------------------------------------------------------------------------


@graph_verb("doctor")
def _doctor(args: Namespace, node: Node) -> None:
    """Describe this simulation, what is running, and what looks wrong."""
    world, names, known = current_world(), node_names(node), topics(node)
    up = {"node": names, "topic": known, "service": services(node)}
    packages = world.packages.names()
    print("This is Turtle Lesson's simulation of a robot's computer, with no ROS 2 installed.")
    print(f"It behaves as ROS 2 {world.release.title} does. Robot time {(world.now / 1e9):.1f} s, seed {world.seed}.")
    print(f"Up: {', '.join(_counted(found, what) for what, found in up.items())}.", end=" ")
    print(f"{_counted(packages, 'package')} with programs: {', '.join(packages) or 'none'}.")
    # names that several nodes have, and topics that only have one side, as the real doctor tells them
    found = [f"{count} nodes share the name {name}" for name, count in Counter(names).items() if count > 1]
    for name in sorted(known.keys() - {"/rosout", "/parameter_events"}):
        if not node.count_subscribers(name):
            found.append(f"Publisher without subscriber detected on {name}.")
        if not node.count_publishers(name):
            found.append(f"Subscriber without publisher detected on {name}.")
    for text in found:
        print(f"WARNING: {text}", file=sys.stderr)
    print("\nAll 2 checks passed" + (f", with {_counted(found, 'warning')}" if found else ""))


def _counted(things: Sized, name: str) -> str:
    return f"{len(things)} {name}{'' if len(things) == 1 else 's'}"


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
