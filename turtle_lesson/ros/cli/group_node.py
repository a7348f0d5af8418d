"""`ros2 node`: which nodes there are, and what each one does."""

from __future__ import annotations

import sys
from argparse import ArgumentParser, Namespace
from typing import TYPE_CHECKING

from ..idl.names import is_hidden
from .parser import Verb
from .verb import Command, CommandError, add_node_arguments, direct_node, flag, node_names, suggest

if TYPE_CHECKING:
    from rclpy.node import Node


NamesAndTypes = list[tuple[str, list[str]]]

TWINS = "WARNING: Be aware that are nodes in the graph that share an exact name, this can have unintended side effects."


def _list_arguments(parser: ArgumentParser) -> None:
    add_node_arguments(parser)
    flag(parser, "-a --all", "Also list nodes with a hidden name")
    flag(parser, "-c --count-nodes", "Print only how many there are")


def list_nodes(args: Namespace) -> None:
    """`ros2 node list`."""
    with direct_node(args) as node:
        names = node_names(node, include_hidden=args.all)
    if args.count_nodes:
        print(len(names))
    elif names:
        if len(set(names)) < len(names):
            print(TWINS, file=sys.stderr)
        print(*names, sep="\n")


def _info_arguments(parser: ArgumentParser) -> None:
    add_node_arguments(parser)
    parser.add_argument("node_name", help="Full name of the node, such as /turtlesim")
    flag(parser, "--include-hidden", "Also show topics and services with a hidden name")


def info(args: Namespace) -> None:
    """`ros2 node info`."""
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
        for title, found in _ends(node, name).items():
            print(f"  {title}:")
            shown = [(end, types) for end, types in found if args.include_hidden or not is_hidden(end)]
            print("\n".join(f"    {end}: {', '.join(types)}" for end, types in shown))


def _ends(node: Node, full_name: str) -> dict[str, NamesAndTypes]:
    namespace, _, name = full_name.rpartition("/")
    where = (name, namespace or "/")
    return {
        "Subscribers": node.get_subscriber_names_and_types_by_node(*where),
        "Publishers": node.get_publisher_names_and_types_by_node(*where),
        "Service Servers": node.get_service_names_and_types_by_node(*where),
        "Service Clients": node.get_client_names_and_types_by_node(*where),
        "Action Servers": node.get_action_server_names_and_types_by_node(*where),
        "Action Clients": node.get_action_client_names_and_types_by_node(*where),
    }


VERBS: dict[str, Verb] = {
    "info": Command("What a node publishes, subscribes to and offers", _info_arguments, info),
    "list": Command("The names of the nodes that are running", _list_arguments, list_nodes),
}
