"""The graph itself: which nodes there are, and by which names they meet.

A message takes a moment to arrive, and arrives as a copy: `Writer` sends it, each `Reader` of the topic has a queue.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from typing import TYPE_CHECKING

from ..idl.names import is_hidden
from .endpoint import End, Quality
from .network import Conditions, Network
from .reader import Reader
from .service import ClientEnd, ServerEnd
from .transport import latency_of
from .writer import Writer

if TYPE_CHECKING:
    from ..sim.process import Process
    from ..sim.simulation import Simulation
    from .trace import Trace


class NodeEntry:
    """A node as the graph knows it."""

    def __init__(self, name: str, namespace: str, process: Process) -> None:
        self.name = name
        self.namespace = namespace
        self.process = process
        self.writers: list[Writer] = []
        self.readers: list[Reader] = []
        self.servers: list[ServerEnd] = []
        self.clients: list[ClientEnd] = []

    @property
    def full_name(self) -> str:
        """Namespace and name, such as `/robots/bob`."""
        return f"/{self.name}" if self.namespace == "/" else f"{self.namespace}/{self.name}"

    @property
    def hidden(self) -> bool:
        """Whether ROS's tools leave this node out of their lists: a part of its name starts with an underscore."""
        return is_hidden(self.full_name)


class Topic:
    """A name with a type, and the two ends that meet there."""

    def __init__(self, simulation: Simulation, name: str, network: Network) -> None:
        self.simulation = simulation
        self.name = name
        self.network = network
        self.latency = latency_of(name)
        self.conditions = network.of(name)
        self.writers: list[tuple[Writer, str]] = []
        self.readers: list[tuple[Reader, str]] = []
        self._types: Counter[str] = Counter()

    @property
    def soon(self) -> int:
        """When (ns) news that travels now arrives."""
        return self.simulation.now + self.latency

    @property
    def types(self) -> list[str]:
        """The type names in use here, sorted: more than one is a mistake that ROS allows between processes."""
        return sorted(self._types)

    def use(self, conditions: Conditions | None) -> None:
        """Have messages travel under these conditions from now on; None for the usual ones."""
        if conditions != self.conditions:
            self.conditions = conditions
            for writer, _ in self.writers:
                writer.arrange()

    def add_writer(self, writer: Writer, type_name: str) -> None:
        """Let a new publisher meet the readers that are there."""
        self.writers.append((writer, type_name))
        self._types[type_name] += 1
        for reader, reader_type in self.readers:
            _introduce(writer, reader, reader_type == type_name)

    def add_reader(self, reader: Reader, type_name: str) -> None:
        """Let a new subscription meet the writers that are there."""
        self.readers.append((reader, type_name))
        self._types[type_name] += 1
        for writer, writer_type in self.writers:
            _introduce(writer, reader, writer_type == type_name)

    def remove(self, end: End) -> None:
        """Take a publisher or subscription away; messages under way to it are lost."""
        self.writers = [entry for entry in self.writers if entry[0] is not end]
        self.readers = [entry for entry in self.readers if entry[0] is not end]
        self._types = Counter(type_name for _, type_name in (*self.writers, *self.readers))
        if isinstance(end, Writer):
            end.retire()
            for reader in end.readers:
                end.part(reader)
        else:
            for writer, _ in self.writers:
                if end in writer.readers:
                    writer.part(end)


def _introduce(writer: Writer, reader: Reader, same_type: bool) -> None:
    """Connect two ends, or tell both why that cannot be."""
    policy = writer.quality.refusal(reader.quality) if same_type else None
    if same_type and policy is None:
        writer.meet(reader)
        return
    for end in (writer, reader):
        end.is_refused(policy)


class Graph:
    """All nodes, topics and services of a world. `on_change` callbacks hear of every change."""

    def __init__(self, simulation: Simulation, seed: object = 0) -> None:
        self.simulation = simulation
        self.network = Network(seed)
        self.nodes: list[NodeEntry] = []
        self.trace: Trace | None = None
        self._topics: dict[str, Topic] = {}
        self._servers: dict[str, list[ServerEnd]] = {}
        self._clients: dict[str, list[ClientEnd]] = {}
        self.on_change: list[Callable[[], object]] = []

    def _changed(self) -> None:
        for tell in list(self.on_change):
            tell()

    # -- nodes ---------------------------------------------------------------------------------------------------

    def add_node(self, node: NodeEntry) -> None:
        """A node joins. A second one of the same name may join too, as in ROS."""
        self.nodes.append(node)
        self._changed()

    def remove_node(self, node: NodeEntry) -> None:
        """A node leaves, and with it all its ends."""
        topic_ends: list[Writer | Reader] = [*node.writers, *node.readers]
        for topic_end in topic_ends:
            self.remove_topic_end(topic_end)
        service_ends: list[ServerEnd | ClientEnd] = [*node.servers, *node.clients]
        for service_end in service_ends:
            self.remove_service_end(service_end)
        if node in self.nodes:
            self.nodes.remove(node)
        self._changed()

    # -- topics --------------------------------------------------------------------------------------------------

    def topic(self, name: str) -> Topic:
        """The topic of a full name, made if nobody has used it yet."""
        if name not in self._topics:
            self._topics[name] = Topic(self.simulation, name, self.network)
        return self._topics[name]

    def add_writer(self, node: NodeEntry, name: str, type_name: str, quality: Quality) -> Writer:
        """A node's new publisher."""
        note = None if self.trace is None else self.trace.publisher(node, name)
        writer = Writer(node, self.topic(name), quality, note)
        node.writers.append(writer)
        writer.topic.add_writer(writer, type_name)
        self._changed()
        return writer

    def add_reader(self, node: NodeEntry, name: str, type_name: str, quality: Quality) -> Reader:
        """A node's new subscription."""
        reader = Reader(node, self.topic(name), quality)
        node.readers.append(reader)
        reader.topic.add_reader(reader, type_name)
        self._changed()
        return reader

    def remove_topic_end(self, end: Writer | Reader) -> None:
        """A publisher or subscription goes."""
        end.topic.remove(end)
        if isinstance(end, Writer):
            end.node.writers.remove(end)
        else:
            end.node.readers.remove(end)
        self._changed()

    def topics(self) -> dict[str, Topic]:
        """The topics that somebody publishes or subscribes to now, by full name, sorted."""
        return {name: topic for name, topic in sorted(self._topics.items()) if topic.writers or topic.readers}

    def set_network(self, name: str | None, conditions: Conditions | None) -> None:
        """Have the messages of a topic, or the calls of a service, travel under these conditions from now on.

        `name` may be a pattern. Without conditions it is forgotten; without a name everything is.
        """
        if name is None:
            self.network.clear()
        else:
            self.network.set(name, conditions)
        for topic in self._topics.values():
            topic.use(self.network.of(topic.name))
        for clients in self._clients.values():
            for client in clients:
                client.use(self.network.of(client.name))

    # -- services ------------------------------------------------------------------------------------------------

    def add_server(self, node: NodeEntry, name: str, type_name: str) -> ServerEnd:
        """A node's new service."""
        server = ServerEnd(node, name, type_name)
        node.servers.append(server)
        self._servers.setdefault(name, []).append(server)
        self._changed()
        return server

    def add_client(self, node: NodeEntry, name: str, type_name: str) -> ClientEnd:
        """A node's new client."""
        offered = self._servers.setdefault(name, [])
        client = ClientEnd(node, name, type_name, offered, self.simulation, self.network)
        client.trace = self.trace
        node.clients.append(client)
        self._clients.setdefault(name, []).append(client)
        self._changed()
        return client

    def remove_service_end(self, end: ServerEnd | ClientEnd) -> None:
        """A service or client goes; requests that a service has not answered stay unanswered."""
        if isinstance(end, ServerEnd):
            end.node.servers.remove(end)
            self._servers[end.name].remove(end)
        else:
            end.node.clients.remove(end)
            self._clients[end.name].remove(end)
        self._changed()

    def servers(self, name: str, type_name: str | None = None) -> list[ServerEnd]:
        """The services of a full name (and type) that are there now."""
        found = self._servers.get(name, [])
        return found if type_name is None else [server for server in found if server.type_name == type_name]

    def clients(self, name: str) -> list[ClientEnd]:
        """The clients of a full name that are there now."""
        return list(self._clients.get(name, []))

    def services(self) -> dict[str, list[str]]:
        """The names of all services that are offered now, with their types, sorted."""
        return {
            name: sorted({server.type_name for server in servers})
            for name, servers in sorted(self._servers.items())
            if servers
        }
