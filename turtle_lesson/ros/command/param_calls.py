"""Asking a node about its parameters: what the verbs of `ros2 param` share."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace
from typing import TYPE_CHECKING, Any

from .common import PATIENCE, CommandError, absolute, add_node_arguments, answer_of, node_names, suggest

if TYPE_CHECKING:
    from rclpy.node import Node


def arguments_of_all(parser: ArgumentParser, *, optional_node: bool = False) -> None:
    """The arguments of every verb of `ros2 param`."""
    add_node_arguments(parser)
    parser.add_argument("node_name", nargs="?" if optional_node else None, help="Name of the node, such as /turtlesim")
    parser.add_argument("--include-hidden-nodes", action="store_true", help="Also use nodes with a hidden name")


def find_node(node: Node, args: Namespace) -> str:
    """The full name of the node that was named. Raises CommandError if it is not there."""
    name, known = absolute(args.node_name), node_names(node, args.include_hidden_nodes)
    if name not in known:
        raise CommandError("Node not found", suggest(name, known))
    return name


def ask(node: Node, node_name: str, service: str, **request: Any) -> Any:
    """The answer of a node's parameter service, such as GetParameters.

    Raises CommandError if there is none: the real tool waits forever for a node that is busy.
    """
    import rcl_interfaces.srv

    kind = getattr(rcl_interfaces.srv, service)
    words = "".join(f"_{letter.lower()}" if letter.isupper() else letter for letter in service).lstrip("_")
    client = node.create_client(kind, f"{node_name}/{words}")
    if not client.wait_for_service(timeout_sec=PATIENCE):
        raise CommandError(f"Wait for service timed out: {node_name} offers no {words}")
    response = answer_of(node, client.call_async(kind.Request(**request)), PATIENCE)
    if response is None:
        raise CommandError(
            f"No answer from {node_name} in {PATIENCE:g} s of robot time: is it busy in a callback, or not spinning?"
        )
    return response


def listed(node: Node, name: str, prefixes: list[str] | None = None) -> list[str]:
    """The names of a node's parameters, sorted."""
    return sorted(ask(node, name, "ListParameters", prefixes=prefixes or []).result.names)


def set_values(node: Node, node_name: str, names_and_values: list[tuple[str, Any]]) -> Any:
    """Ask a node to set parameters; how each went, as rcl_interfaces/msg/SetParametersResult."""
    from rcl_interfaces.msg import Parameter

    parameters = [Parameter(name=name, value=value) for name, value in names_and_values]
    return ask(node, node_name, "SetParameters", parameters=parameters).results


def with_reason(text: str, result: Any) -> str:
    """A text, and the reason that the node gave, if any."""
    return f"{text}: {result.reason}" if result.reason else text
