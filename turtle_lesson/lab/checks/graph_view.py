"""What the graph shows of the others: their nodes, publishers, subscriptions and services."""

from __future__ import annotations

from collections import Counter
from typing import Any

from ..system import is_hidden
from ..typed_names import nearest


class GraphView:
    """The graph as `node` (an rclpy Node) sees it; its own ends are left out."""

    node: Any

    def nodes(self) -> Counter[str]:
        """How many visible nodes there are of each full name."""
        names = (f"{space.rstrip('/')}/{name}" for name, space in self.node.get_node_names_and_namespaces())
        return Counter(name for name in sorted(names) if not is_hidden(name))

    def publishers(self, topic: str) -> list[tuple[str, str]]:
        """Full name of the node and type of each publisher that others have on a topic."""
        return self._others(self.node.get_publishers_info_by_topic(topic))

    def subscriptions(self, topic: str) -> list[tuple[str, str]]:
        """Full name of the node and type of each subscription that others have on a topic."""
        return self._others(self.node.get_subscriptions_info_by_topic(topic))

    def servers(self, service: str) -> list[tuple[str, str]]:
        """Full name of the node and type of each service of a name."""
        from rclpy.node import NodeNameNonExistentError

        found: list[tuple[str, str]] = []
        for name, amount in self.nodes().items():
            namespace, _, base = name.rpartition("/")
            try:
                offers = self.node.get_service_names_and_types_by_node(base, namespace or "/")
            except NodeNameNonExistentError:
                continue
            # nodes of one name look the same from outside, so each may be one that offers it
            found += [(name, kind) for offered, kinds in offers if offered == service for kind in kinds] * amount
        return found

    def subscribed(self, owner: str) -> list[str]:
        """The names of the topics that a node listens to."""
        from rclpy.node import NodeNameNonExistentError

        namespace, _, base = owner.rpartition("/")
        try:
            found = self.node.get_subscriber_names_and_types_by_node(base, namespace or "/")
        except NodeNameNonExistentError:
            return []
        return [name for name, _ in found if not is_hidden(name)]

    def topics(self) -> list[str]:
        """The names of all topics that are published, hidden ones left out."""
        names = [name for name, _ in self.node.get_topic_names_and_types() if not is_hidden(name)]
        return [name for name in names if self.publishers(name)]

    def services(self) -> list[str]:
        """The names of all services."""
        return [name for name, _ in self.node.get_service_names_and_types() if not is_hidden(name)]

    def _others(self, ends: Any) -> list[tuple[str, str]]:
        me = (self.node.get_name(), self.node.get_namespace())
        return sorted(
            (f"{end.node_namespace.rstrip('/')}/{end.node_name}", end.topic_type)
            for end in ends
            if (end.node_name, end.node_namespace) != me
        )

    def like(self, name: str, known: list[str]) -> str:
        """ ", but there is /robot/staus": a known name that is nearly the one that was looked for; "" if there is none."""
        found = nearest(name, [each for each in known if each != name], cutoff=0.75)
        return f", but there is {found}" if found else ""
