"""The ROS graph as ROS's own tools show it: the visible nodes, and what each of them does there."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass, field
from typing import Any

EVERYWHERE = frozenset({"/rosout", "/parameter_events"})
"""Topics that every node has: they say nothing about how a system is built."""

PARAMETER_SERVICES = frozenset(
    {
        "describe_parameters",
        "get_parameter_types",
        "get_parameters",
        "list_parameters",
        "set_parameters",
        "set_parameters_atomically",
        "get_type_description",
    }
)
"""Services that every node offers below its own name; the last one since ROS 2 Iron."""

Ends = dict[str, list[str]]
"""Names of topics or services, with the types that are in use there."""


@dataclass
class NodeView:
    """One node, and the topics and services that it uses. `copies` nodes have this very name."""

    name: str
    copies: int = 1
    publishes: Ends = field(default_factory=dict)
    hears: Ends = field(default_factory=dict)
    offers: Ends = field(default_factory=dict)
    calls: Ends = field(default_factory=dict)


def is_hidden(name: str) -> bool:
    """Whether ROS's tools leave a name out of their lists: a part of it starts with an underscore."""
    return any(part.startswith("_") for part in name.split("/"))


def read_system(node: Any) -> list[NodeView]:
    """Return the visible nodes that `node` (an rclpy Node) sees in the graph, sorted by name."""
    from rclpy.node import NodeNameNonExistentError

    found: dict[str, NodeView] = {}
    for name, namespace in sorted(node.get_node_names_and_namespaces()):
        full_name = f"{namespace.rstrip('/')}/{name}"
        if is_hidden(full_name):
            continue
        if full_name in found:
            found[full_name].copies += 1
            continue
        with suppress(NodeNameNonExistentError):  # gone since the list was made
            found[full_name] = _view(node, name, namespace, full_name)
    return [found[name] for name in sorted(found)]


def _view(node: Any, name: str, namespace: str, full_name: str) -> NodeView:
    return NodeView(
        full_name,
        publishes=_visible(node.get_publisher_names_and_types_by_node(name, namespace)),
        hears=_visible(node.get_subscriber_names_and_types_by_node(name, namespace)),
        offers=_visible(node.get_service_names_and_types_by_node(name, namespace)),
        calls=_visible(node.get_client_names_and_types_by_node(name, namespace)),
    )


def topics_of(nodes: list[NodeView]) -> Ends:
    """All topics of these nodes, sorted, with all types in use there."""
    return _merged([ends for node in nodes for ends in (node.publishes, node.hears)])


def services_of(nodes: list[NodeView]) -> Ends:
    """All services of these nodes, sorted, with all types in use there."""
    return _merged([ends for node in nodes for ends in (node.offers, node.calls)])


def _visible(names_and_types: list[tuple[str, list[str]]]) -> Ends:
    return {
        name: sorted(types)
        for name, types in sorted(names_and_types)
        if name not in EVERYWHERE and not is_hidden(name) and name.split("/")[-1] not in PARAMETER_SERVICES
    }


def _merged(several: list[Ends]) -> Ends:
    names = sorted({name for ends in several for name in ends})
    return {name: sorted({kind for ends in several for kind in ends.get(name, ())}) for name in names}
