"""The part of a node that looks at the graph: nodes, topics and services, with their names and types."""

from __future__ import annotations

import zlib
from collections.abc import Iterable
from typing import Any

from turtle_lesson.ros.rmw.graph import NodeEntry, Topic
from turtle_lesson.ros.rmw.names import Remap, remap
from turtle_lesson.ros.rmw.reader import Reader
from turtle_lesson.ros.rmw.writer import Writer
from turtle_lesson.ros.runtime.world import current_world
from turtle_lesson.ros.stdlib.deadlock import looked_in_vain

from ._blocking import wait_until
from .context import Context
from .exceptions import NameValidationException, NodeNameNonExistentError, RCLError, refuse_destroyed, refuse_ended
from .expand_topic_name import expand_topic_name
from .topic_endpoint_info import TopicEndpointInfo, TopicEndpointTypeEnum
from .validate_full_topic_name import validate_full_topic_name
from .validate_topic_name import validate_topic_name

LOOK_AGAIN = 100_000_000
"""How often, in ns, `wait_for_node` looks."""

NamesAndTypes = list[tuple[str, list[str]]]
FEEDBACK = "/_action/feedback"
NODE_S = "rcl node's"
"""How the real one's complaints begin that go on with "context is invalid"."""


class NodeGraph:
    """Mixed into Node."""

    _ros_context: Context

    def _ros_setup_graph(self, entry: NodeEntry, remaps: list[Remap]) -> None:
        self._ros_entry = entry
        self._ros_remaps = remaps
        self._ros_graph = current_world().graph
        self._ros_simulation = current_world().sim
        self._ros_destroyed = self._ros_shut_down = False

    def _ros_check_alive(self, doing: str = "") -> None:
        """Raise InvalidHandle if the node was destroyed, and after rclpy.shutdown() RCLError for `doing` something."""
        if self._ros_destroyed:
            self._ros_refuse(doing)

    def _ros_refuse(self, doing: str) -> None:
        """Raise the error for the use of the node, or of what it made, when that is destroyed."""
        if not self._ros_shut_down:
            refuse_destroyed(self._ros_simulation)
        if doing:
            refuse_ended(doing)

    def _ros_full_name_of(self, name: Any, *, only_expand: bool = False, is_service: bool = False) -> str:
        """From what a program calls a topic or service to its full name, remapped unless told otherwise."""
        _check_text(name, is_service)
        validate_topic_name(name, is_service=is_service)
        full_name = self._ros_expanded(name, is_service=is_service)
        return full_name if only_expand else self._ros_remapped(full_name, is_service=is_service)

    def _ros_remapped(self, full_name: str, *, is_service: bool = False) -> str:
        entry = self._ros_entry
        return remap(full_name, entry.name, entry.namespace, self._ros_remaps, is_service=is_service)

    def _ros_expanded(self, name: Any, *, is_service: bool = False) -> str:
        """The full name, not remapped. Raises ValueError for a bad name, or what a full name can raise."""
        _check_text(name, is_service)
        full_name = expand_topic_name(name, self._ros_entry.name, self._ros_entry.namespace)
        validate_full_topic_name(full_name, is_service=is_service)
        return full_name

    def resolve_topic_name(self, topic: str, *, only_expand: bool = False) -> str:
        """The full name of a topic, after remapping. Raises RCLError for what can be none."""
        return self._ros_resolve(topic, only_expand, is_service=False)

    def resolve_service_name(self, service: str, *, only_expand: bool = False) -> str:
        """The full name of a service, after remapping. Raises RCLError for what can be none."""
        return self._ros_resolve(service, only_expand, is_service=True)

    def _ros_resolve(self, name: str, only_expand: bool, *, is_service: bool) -> str:
        self._ros_check_alive()
        try:
            return self._ros_full_name_of(name, only_expand=only_expand, is_service=is_service)
        except (NameValidationException, ValueError) as error:
            reason = str(error).partition(": ")[2].partition(":\n")[0]  # the first line, without the name
            raise RCLError(f"failed to resolve name: {reason}") from None

    def get_topic_names_and_types(self, no_demangle: bool = False) -> NamesAndTypes:
        """All topics, with their types."""
        self._ros_check_alive(f"failed to get topic names and types: {NODE_S}")
        return [(name, topic.types) for name, topic in self._ros_graph.topics().items()]

    def get_service_names_and_types(self) -> NamesAndTypes:
        """All services, with their types."""
        self._ros_check_alive(f"failed to get service names and types: {NODE_S}")
        return list(self._ros_graph.services().items())

    def get_node_names(self) -> list[str]:
        """The names of all nodes, without their namespaces."""
        return [entry.name for entry in self._ros_known_nodes()]

    def get_fully_qualified_node_names(self) -> list[str]:
        """The full names of all nodes."""
        return [entry.full_name for entry in self._ros_known_nodes()]

    def get_node_names_and_namespaces(self) -> list[tuple[str, str]]:
        """Name and namespace of all nodes."""
        return [(entry.name, entry.namespace) for entry in self._ros_known_nodes()]

    def get_node_names_and_namespaces_with_enclaves(self) -> list[tuple[str, str, str]]:
        """Name, namespace and security enclave of all nodes."""
        return [(entry.name, entry.namespace, "/") for entry in self._ros_known_nodes()]

    def _ros_known_nodes(self) -> list[NodeEntry]:
        """All nodes. The lesson's own recorder, which no robot has, is shown to hidden nodes only, as commands have them."""
        self._ros_check_alive(f"Failed to get node names: {NODE_S}")
        if self._ros_entry.hidden:
            return self._ros_graph.nodes
        return [entry for entry in self._ros_graph.nodes if (entry.name, entry.process.name) != ("_lab", "lab")]

    def _ros_entry_of(self, what: str, node_name: str, node_namespace: str) -> NodeEntry:
        self._ros_check_alive(f"failed to get {what} names and types: {NODE_S}")
        for entry in self._ros_graph.nodes:
            if (entry.name, entry.namespace) == (node_name, node_namespace):
                return entry
        raise NodeNameNonExistentError(
            f"Cannot get information of the node, node name not existing: {node_namespace.rstrip('/')}/{node_name}"
        )

    def get_publisher_names_and_types_by_node(
        self, node_name: str, node_namespace: str, no_demangle: bool = False
    ) -> NamesAndTypes:
        """The topics that a node publishes. Raises NodeNameNonExistentError."""
        return _types_by_topic(self._ros_entry_of("publisher", node_name, node_namespace).writers)

    def get_subscriber_names_and_types_by_node(
        self, node_name: str, node_namespace: str, no_demangle: bool = False
    ) -> NamesAndTypes:
        """The topics that a node subscribes to. Raises NodeNameNonExistentError."""
        return _types_by_topic(self._ros_entry_of("subscriber", node_name, node_namespace).readers)

    def get_service_names_and_types_by_node(self, node_name: str, node_namespace: str) -> NamesAndTypes:
        """The services that a node offers. Raises NodeNameNonExistentError."""
        ends = self._ros_entry_of("service", node_name, node_namespace).servers
        return _types_by_name((end.name, end.type_name) for end in ends)

    def get_client_names_and_types_by_node(self, node_name: str, node_namespace: str) -> NamesAndTypes:
        """The services that a node is a client of. Raises NodeNameNonExistentError."""
        ends = self._ros_entry_of("client", node_name, node_namespace).clients
        return _types_by_name((end.name, end.type_name) for end in ends)

    def get_action_names_and_types(self) -> NamesAndTypes:
        """All actions, with their types (newer releases)."""
        return _actions(self.get_topic_names_and_types())

    def get_action_client_names_and_types_by_node(self, node_name: str, node_namespace: str) -> NamesAndTypes:
        """The actions that a node is a client of (newer releases). Raises NodeNameNonExistentError."""
        return _actions(self.get_subscriber_names_and_types_by_node(node_name, node_namespace))

    def get_action_server_names_and_types_by_node(self, node_name: str, node_namespace: str) -> NamesAndTypes:
        """The actions that a node offers (newer releases). Raises NodeNameNonExistentError."""
        return _actions(self.get_publisher_names_and_types_by_node(node_name, node_namespace))

    def wait_for_node(self, fully_qualified_node_name: str, timeout: float) -> bool:
        """Wait until there is a node of this full name; False if there is none within the timeout (s; negative: none).

        Newer than Humble.
        """
        name = f"/{fully_qualified_node_name.lstrip('/')}"
        limit = None if timeout < 0 else timeout
        what = f"wait_for_node {name}"
        return wait_until(
            lambda: name in self.get_fully_qualified_node_names(), limit, LOOK_AGAIN, self._ros_context, what
        )

    def count_publishers(self, topic_name: str) -> int:
        """How many publishers a topic has. The name is not remapped, nor in the next three."""
        self._ros_check_alive(f"Error in rcl_count_publishers: {NODE_S}")
        return len(self._ros_graph.topic(self._ros_expanded(topic_name)).writers) or int(looked_in_vain())

    def count_subscribers(self, topic_name: str) -> int:
        """How many subscriptions a topic has."""
        self._ros_check_alive(f"Error in rcl_count_subscribers: {NODE_S}")
        return len(self._ros_graph.topic(self._ros_expanded(topic_name)).readers) or int(looked_in_vain())

    def count_services(self, service_name: str) -> int:
        """How many servers a service has."""
        self._ros_check_alive(f"Error in rcl_count_services: {NODE_S}")
        return len(self._ros_graph.servers(self._ros_expanded(service_name, is_service=True))) or int(looked_in_vain())

    def count_clients(self, service_name: str) -> int:
        """How many clients a service has."""
        self._ros_check_alive(f"Error in rcl_count_clients: {NODE_S}")
        return len(self._ros_graph.clients(self._ros_expanded(service_name, is_service=True))) or int(looked_in_vain())

    def get_publishers_info_by_topic(self, topic_name: str, no_mangle: bool = False) -> list[TopicEndpointInfo]:
        """The publishers of a topic, one by one."""
        kind = TopicEndpointTypeEnum.PUBLISHER
        return [_info(*end, kind) for end in self._ros_named(topic_name, "publishers").writers]

    def get_subscriptions_info_by_topic(self, topic_name: str, no_mangle: bool = False) -> list[TopicEndpointInfo]:
        """The subscriptions of a topic, one by one."""
        kind = TopicEndpointTypeEnum.SUBSCRIPTION
        return [_info(*end, kind) for end in self._ros_named(topic_name, "subscriptions").readers]

    def _ros_named(self, topic_name: str, what: str) -> Topic:
        self._ros_check_alive(f"Failed to get information by topic for {what}: {NODE_S}")
        return self._ros_graph.topic(self._ros_remapped(self._ros_expanded(topic_name)))


def _check_text(name: object, is_service: bool) -> None:
    """Raise RCLError or TypeError for what is no text."""
    if not isinstance(name, str):
        what = "service" if is_service else "topic"
        complaint = f"a {what} name must be a str, got {name!r}: is the order of the arguments (type, name, …)?"
        raise (RCLError if name is None else TypeError)(complaint)


def _types_by_topic(ends: list[Any]) -> NamesAndTypes:
    """The topics of some publishers or subscriptions, of which the topics know the types."""
    topics = {end.topic: None for end in ends}
    pairs = [pair for topic in topics for pair in (*topic.writers, *topic.readers)]
    return _types_by_name((end.topic.name, type_name) for end, type_name in pairs if end in ends)


def _types_by_name(pairs: Iterable[tuple[str, str]]) -> NamesAndTypes:
    found: dict[str, set[str]] = {}
    for name, type_name in pairs:
        found.setdefault(name, set()).add(type_name)
    return [(name, sorted(types)) for name, types in sorted(found.items())]


def _actions(topics: NamesAndTypes) -> NamesAndTypes:
    """The actions whose feedback is published on some of these topics (rcl_action's graph.c)."""
    return [
        (name.removesuffix(FEEDBACK), [each.removesuffix("_FeedbackMessage") for each in types])
        for name, types in topics
        if name.endswith(FEEDBACK)
    ]


def _info(end: Writer | Reader, type_name: str, kind: TopicEndpointTypeEnum) -> TopicEndpointInfo:
    node = end.node
    ends: list[Any] = [*node.writers, *node.readers]
    tag = f"{node.process.pid}/{node.full_name}/{end.topic.name}/{ends.index(end)}"
    gid = [*zlib.crc32(tag.encode()).to_bytes(4, "big"), *node.process.pid.to_bytes(4, "big"), *([0] * 16)]
    return TopicEndpointInfo(
        node_name=node.name,
        node_namespace=node.namespace,
        topic_type=type_name,
        endpoint_type=kind,
        endpoint_gid=gid,
        qos_profile=end.profile._as_used(),
    )
