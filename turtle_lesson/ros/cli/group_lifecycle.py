"""`ros2 lifecycle`: managed nodes, the states they are in, and moving them on. Formats are those of ros2lifecycle."""

from __future__ import annotations

import sys
from argparse import ArgumentParser, Namespace
from typing import TYPE_CHECKING, Any

from .parser import Verb
from .verb import (
    Command,
    CommandError,
    absolute,
    add_node_arguments,
    ask,
    direct_node,
    flag,
    node_names,
    suggest,
)

if TYPE_CHECKING:
    from rclpy.node import Node


GET_STATE = "lifecycle_msgs/srv/GetState"


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


def _find(node: Node, args: Namespace, known: list[str]) -> str:
    name = absolute(args.node_name)
    if name not in known:
        every_node = node_names(node, args.include_hidden_nodes)
        hint = f"{name} is not a managed node." if name in every_node else suggest(name, known)
        raise CommandError("Node not found", hint)
    return name


# -- nodes ---------------------------------------------------------------------------------------------------------------


def _nodes_arguments(parser: ArgumentParser) -> None:
    add_node_arguments(parser)
    flag(parser, "-a --all", "Also list nodes with a hidden name")
    flag(parser, "-c --count-nodes", "Print only how many there are")


def nodes(args: Namespace) -> None:
    """`ros2 lifecycle nodes`."""
    with direct_node(args) as node:
        found = _managed(node, args.all)
    if args.count_nodes:
        print(len(found))
    elif found:
        print(*found, sep="\n")


# -- get -----------------------------------------------------------------------------------------------------------------


def _include_hidden(parser: ArgumentParser) -> None:
    flag(parser, "--include-hidden-nodes", "Also use nodes with a hidden name")


def _get_arguments(parser: ArgumentParser) -> None:
    add_node_arguments(parser)
    parser.add_argument("node_name", nargs="?", help="Name of the node; without one, all managed nodes are asked")
    _include_hidden(parser)


def get(args: Namespace) -> None:
    """`ros2 lifecycle get`."""
    with direct_node(args) as node:
        known = _managed(node, args.include_hidden_nodes)
        if args.node_name:
            state = _ask(node, _find(node, args, known), "GetState", "get_state").current_state
            print(f"{state.label} [{state.id}]")
            return
        for name in known:
            try:
                state = _ask(node, name, "GetState", "get_state").current_state
            except CommandError as error:
                print(f"Exception while calling service of node '{name}': {error}", file=sys.stderr)
            else:
                print(f"{name}: {state.label} [{state.id}]")


# -- list ----------------------------------------------------------------------------------------------------------------


def _list_arguments(parser: ArgumentParser) -> None:
    add_node_arguments(parser)
    parser.add_argument("node_name", help="Name of the node, such as /lc_talker")
    _include_hidden(parser)
    flag(parser, "-a --all", "All transitions, not only those that are possible now")


def list_transitions(args: Namespace) -> None:
    """`ros2 lifecycle list`."""
    with direct_node(args) as node:
        name = _find(node, args, _managed(node, args.include_hidden_nodes))
        for each in _transitions(node, name, "get_transition_graph" if args.all else "get_available_transitions"):
            print(f"- {each.transition.label} [{each.transition.id}]")
            print(f"\tStart: {each.start_state.label}")
            print(f"\tGoal: {each.goal_state.label}")


def _transitions(node: Node, node_name: str, service: str) -> list[Any]:
    return _ask(node, node_name, "GetAvailableTransitions", service).available_transitions


# -- set -----------------------------------------------------------------------------------------------------------------


def _set_arguments(parser: ArgumentParser) -> None:
    add_node_arguments(parser)
    parser.add_argument("node_name", help="Name of the node, such as /lc_talker")
    _include_hidden(parser)
    parser.add_argument("transition", help="Label or number of the transition, such as configure")


def set_state(args: Namespace) -> None:
    """`ros2 lifecycle set`."""
    with direct_node(args) as node:
        name = _find(node, args, node_names(node, args.include_hidden_nodes))
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


VERBS: dict[str, Verb] = {
    "get": Command("The state that a managed node is in", _get_arguments, get),
    "list": Command("The transitions that are possible now", _list_arguments, list_transitions),
    "nodes": Command("The names of the managed nodes", _nodes_arguments, nodes),
    "set": Command("Trigger a transition of a managed node", _set_arguments, set_state),
}
