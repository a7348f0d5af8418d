"""Which actions there are, and which nodes offer and use them. Newer releases have the same as methods of the node."""

from __future__ import annotations

from .._node_graph import NamesAndTypes
from ..node import Node


def get_action_client_names_and_types_by_node(
    node: Node, remote_node_name: str, remote_node_namespace: str
) -> NamesAndTypes:
    """The actions that a node is a client of. Raises NodeNameNonExistentError."""
    return node.get_action_client_names_and_types_by_node(remote_node_name, remote_node_namespace)


def get_action_server_names_and_types_by_node(
    node: Node, remote_node_name: str, remote_node_namespace: str
) -> NamesAndTypes:
    """The actions that a node offers. Raises NodeNameNonExistentError."""
    return node.get_action_server_names_and_types_by_node(remote_node_name, remote_node_namespace)


def get_action_names_and_types(node: Node) -> NamesAndTypes:
    """All actions, with their types."""
    return node.get_action_names_and_types()
