"""`ros2 node`: which nodes there are, and what each one does. `ros2 lifecycle`: the states of managed nodes.

Formats are those of ros2node and ros2lifecycle.
"""

from __future__ import annotations

import sys
from argparse import Namespace
from typing import TYPE_CHECKING, Any

from ..idl.names import is_hidden
from .arguments import ALL_NODES, COUNT_NODES, HIDDEN_NODES, NODE, arg, flag
from .verb import CommandError, ask, direct_node, find_node, node_names, suggest, verb

if TYPE_CHECKING:
    from rclpy.node import Node


TWINS = "WARNING: Be aware that are nodes in the graph that share an exact name, this can have unintended side effects."


@verb("node list", *NODE, ALL_NODES, COUNT_NODES)
def list_nodes(args: Namespace) -> None:
    """The names of the nodes that are running."""
    with direct_node(args) as node:
        names = node_names(node, include_hidden=args.all)
    if len(set(names)) < len(names) and not args.count_nodes:
        print(TWINS, file=sys.stderr)
    _print_or_count(names, args)


def _print_or_count(names: list[str], args: Namespace) -> None:
    if args.count_nodes:
        print(len(names))
    elif names:
        print(*names, sep="\n")


@verb(
    "node info",
    *NODE,
    arg("node_name", "Full name of the node, such as /turtlesim"),
    flag("--include-hidden", "Also show topics and services with a hidden name"),
)
def info(args: Namespace) -> None:
    """What a node publishes, subscribes to and offers."""
    with direct_node(args) as node:
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


_MANAGED = arg("node_name", "Name of the node, such as /lc_talker")


def _managed(node: Node, include_hidden: bool) -> list[str]:
    """The full names of the managed nodes, sorted."""
    services = dict(node.get_service_names_and_types())
    names = node_names(node, include_hidden)
    return sorted({name for name in names if GET_STATE in services.get(f"{name}/get_state", [])})


def _ask(node: Node, node_name: str, kind: str, service: str, **request: Any) -> Any:
    """The answer of a managed node's service."""
    import lifecycle_msgs.srv

    not_there = f"{node_name} offers no {service}: it is not a managed node (`ros2 lifecycle nodes` lists those)"
    return ask(node, getattr(lifecycle_msgs.srv, kind), f"{node_name}/{service}", not_there, request)


@verb("lifecycle nodes", *NODE, ALL_NODES, COUNT_NODES)
def nodes(args: Namespace) -> None:
    """The names of the managed nodes."""
    with direct_node(args) as node:
        found = _managed(node, args.all)
    _print_or_count(found, args)


@verb(
    "lifecycle get",
    *NODE,
    arg("node_name", "Name of the node; without one, all managed nodes are asked", nargs="?"),
    HIDDEN_NODES,
)
def get(args: Namespace) -> None:
    """The state that a managed node is in."""
    with direct_node(args) as node:
        known = _managed(node, args.include_hidden_nodes)
        if args.node_name:
            state = _ask(node, find_node(node, args, known), "GetState", "get_state").current_state
            print(f"{state.label} [{state.id}]")
            return
        for name in known:
            try:
                state = _ask(node, name, "GetState", "get_state").current_state
            except CommandError as error:
                print(f"Exception while calling service of node '{name}': {error}", file=sys.stderr)
            else:
                print(f"{name}: {state.label} [{state.id}]")


@verb(
    "lifecycle list",
    *NODE,
    _MANAGED,
    HIDDEN_NODES,
    flag("-a --all", "All transitions, not only those that are possible now"),
)
def list_transitions(args: Namespace) -> None:
    """The transitions that are possible now."""
    with direct_node(args) as node:
        name = find_node(node, args, _managed(node, args.include_hidden_nodes))
        for each in _transitions(node, name, "get_transition_graph" if args.all else "get_available_transitions"):
            print(f"- {each.transition.label} [{each.transition.id}]")
            print(f"\tStart: {each.start_state.label}")
            print(f"\tGoal: {each.goal_state.label}")


def _transitions(node: Node, node_name: str, service: str) -> list[Any]:
    return _ask(node, node_name, "GetAvailableTransitions", service).available_transitions


@verb(
    "lifecycle set",
    *NODE,
    _MANAGED,
    HIDDEN_NODES,
    arg("transition", "Label or number of the transition, such as configure"),
)
def set_state(args: Namespace) -> None:
    """Trigger a transition of a managed node."""
    with direct_node(args) as node:
        name = find_node(node, args)
        possible = [each.transition for each in _transitions(node, name, "get_available_transitions")]
        chosen = [each for each in possible if each.label == args.transition]
        chosen += [each for each in possible if str(each.id) == args.transition]
        if not chosen:
            lines = "".join(f"\n- {each.label} [{each.id}]" for each in possible)
            raise CommandError(f"Unknown transition requested, available ones are:{lines}")
        if _ask(node, name, "ChangeState", "change_state", transition=chosen[0]).success:
            print("Transitioning successful")
        else:
            print("Transitioning failed", file=sys.stderr)
