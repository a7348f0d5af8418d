"""What a probe sees of the others: their nodes, publishers, subscriptions and services, and their messages' fields."""

from __future__ import annotations

import importlib
from collections import Counter
from typing import Any

from ...ros.idl.names import is_hidden, nearest
from .results import CannotLook


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
        found: list[tuple[str, str]] = []
        for name, amount in self.nodes().items():
            offers = self._of_node("get_service_names_and_types_by_node", name)
            # nodes of one name look the same from outside, so each may be one that offers it
            found += [(name, kind) for offered, kinds in offers if offered == service for kind in kinds] * amount
        return found

    def subscribed(self, owner: str) -> list[str]:
        """The names of the topics that a node listens to."""
        found = self._of_node("get_subscriber_names_and_types_by_node", owner)
        return [name for name, _ in found if not is_hidden(name)]

    def topics(self) -> list[str]:
        """The names of all topics that are published, hidden ones left out."""
        names = [name for name, _ in self.node.get_topic_names_and_types() if not is_hidden(name)]
        return [name for name in names if self.publishers(name)]

    def services(self) -> list[str]:
        """The names of all services."""
        return [name for name, _ in self.node.get_service_names_and_types() if not is_hidden(name)]

    def _of_node(self, query: str, owner: str) -> list[tuple[str, list[str]]]:
        """What a query of the graph says of a node; nothing where the node has just gone."""
        from rclpy.node import NodeNameNonExistentError

        namespace, _, base = owner.rpartition("/")
        try:
            return list(getattr(self.node, query)(base, namespace or "/"))
        except NodeNameNonExistentError:
            return []

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


def interface(type_name: str) -> Any:
    """The class of a type such as "std_msgs/msg/String". Raises CannotLook where it cannot be imported."""
    package, kind, name = type_name.split("/")
    try:
        return getattr(importlib.import_module(f"{package}.{kind}"), name)
    except Exception as error:  # a package that was built badly can raise anything
        reason = " ".join(str(error).split())[:160]
        raise CannotLook(f"the type {type_name} cannot be imported here ({reason})") from None


def filled(message: Any, fields: dict[str, Any], type_name: str) -> Any:
    """The message with its fields set. Raises CannotLook for a field that it does not have."""
    for path, value in fields.items():
        *way, last = path.split("__")
        target = message
        try:
            for part in way:
                target = getattr(target, part)
            setattr(target, last, value)
        except (AttributeError, AssertionError, TypeError) as error:
            reason = " ".join(str(error).split())[:120]
            raise CannotLook(f"{type_name} cannot hold {path.replace('__', '.')} = {value!r} ({reason})") from None
    return message


def field(message: Any, path: str) -> Any:
    """What a message has in a field such as "linear.x". Raises CannotLook where there is none."""
    value = message
    for part in path.split("."):
        try:
            value = getattr(value, part)
        except AttributeError:
            raise CannotLook(f"{type(message).__name__} has no field {path}") from None
    return value
