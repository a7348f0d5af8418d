"""`ros2 action`: which actions there are, and which nodes offer and use them."""

from __future__ import annotations

import sys
from argparse import ArgumentParser, Namespace
from typing import TYPE_CHECKING

from .action_send_goal import add_arguments as _send_goal_arguments
from .action_send_goal import send_goal
from .common import Command, Verb, direct_node, expanded, suggest
from .named import print_names, print_types

if TYPE_CHECKING:
    from rclpy.node import Node


def actions(node: Node) -> dict[str, list[str]]:
    """The actions that are there, with their types."""
    return dict(node.get_action_names_and_types())


def _list_arguments(parser: ArgumentParser) -> None:
    parser.add_argument("-t", "--show-types", action="store_true", help="Show each action's type beside it")
    parser.add_argument("-c", "--count-actions", action="store_true", help="Print only how many there are")


def list_actions(args: Namespace) -> None:
    """`ros2 action list`."""
    with direct_node(args) as node:
        found = actions(node)
    if args.count_actions:
        print(len(found))
        return
    for name, types in found.items():
        print(f"{name} [{', '.join(types)}]" if args.show_types else name)


def _info_arguments(parser: ArgumentParser) -> None:
    parser.add_argument("action_name", help="Name of the action, such as /turtle1/rotate_absolute")
    parser.add_argument("-t", "--show-types", action="store_true", help="Also show each node's type of the action")
    parser.add_argument("-c", "--count", action="store_true", help="Print only how many clients and servers there are")


def info(args: Namespace) -> None:
    """`ros2 action info`. Of an action that does not exist the real one says that nobody offers or uses it."""
    with direct_node(args) as node:
        name = expanded(node, args.action_name)
        known = actions(node)
        clients, servers = _ends(node, name, "client"), _ends(node, name, "server")
    print(f"Action: {args.action_name}")
    for title, ends in (("clients", clients), ("servers", servers)):
        print(f"Action {title}: {len(ends)}")
        for node_name, types in ends if not args.count else ():
            print(f"    {node_name} [{', '.join(types)}]" if args.show_types else f"    {node_name}")
    if name not in known and (hint := suggest(name, known)):
        print(hint, file=sys.stderr)


def _ends(node: Node, action: str, role: str) -> list[tuple[str, list[str]]]:
    """The nodes that are this for an action: "client" or "server"."""
    look = getattr(node, f"get_action_{role}_names_and_types_by_node")
    found = []
    for name, namespace in node.get_node_names_and_namespaces():
        types = dict(look(name, namespace)).get(action)
        if types is not None:
            found.append((f"{namespace.rstrip('/')}/{name}", types))
    return found


def _type_arguments(parser: ArgumentParser) -> None:
    parser.add_argument("action_name", help="Full name of the action, such as /turtle1/rotate_absolute")


def type_of(args: Namespace) -> None:
    """`ros2 action type`, which Humble lacks and newer releases have."""
    with direct_node(args) as node:
        known = actions(node)
    print_types("action", args.action_name, known)


def _find_arguments(parser: ArgumentParser) -> None:
    parser.add_argument("action_type", help="Name of the type, such as turtlesim/action/RotateAbsolute")
    parser.add_argument("-c", "--count-actions", action="store_true", help="Print only how many there are")


def find(args: Namespace) -> None:
    """`ros2 action find`, which Humble lacks and newer releases have."""
    with direct_node(args) as node:
        known = actions(node)
    print_names(args.action_type, "action", known, count=args.count_actions)


VERBS: dict[str, Verb] = {
    "find": Command("The actions of a type", _find_arguments, find),
    "info": Command("Which nodes offer and use an action", _info_arguments, info),
    "list": Command("The names of the actions that nodes offer or use", _list_arguments, list_actions),
    "send_goal": Command("Send a goal and print its outcome", _send_goal_arguments, send_goal),
    "type": Command("An action's type", _type_arguments, type_of),
}
