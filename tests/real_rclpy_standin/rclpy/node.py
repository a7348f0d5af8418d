"""Nodes."""

from __future__ import annotations

import itertools
import time
from collections.abc import Callable, Iterator
from types import SimpleNamespace
from typing import Any

from rclpy import _network
from rclpy._rclpy_pybind11 import NodeNameNonExistentError
from rclpy.callback_groups import CallbackGroup
from rclpy.client import Client, Service
from rclpy.clock import Clock
from rclpy.context import Context, get_default_context
from rclpy.qos import DurabilityPolicy, QoSProfile, profile
from rclpy.subscription import Publisher, Subscription

__all__ = ["Node", "NodeNameNonExistentError"]
_gids = itertools.count(1)


class Timer:
    def __init__(self, period: float, callback: Callable[..., Any]) -> None:
        self._period, self._callback = period, callback
        self._due = time.monotonic() + period

    def _ready(self) -> Callable[[], Any] | None:
        now = time.monotonic()
        if now < self._due:
            return None
        self._due += self._period * max(1, round((now - self._due) / self._period))
        return self._callback


class Node:
    def __init__(
        self,
        node_name: str,
        *,
        context: Context | None = None,
        use_global_arguments: bool = True,
        enable_rosout: bool = True,
        start_parameter_services: bool = True,
    ) -> None:
        self.context = context or get_default_context()
        if not self.context.ok():
            raise RuntimeError("rclpy.init() has not been called: cannot create node")
        self.executor: Any = None
        self._name, self._born, self._gid = node_name, time.monotonic(), next(_gids)
        self._timers: list[Timer] = []
        self._entities: list[Any] = []
        self._gone = False
        with _network.lock:
            _network.nodes.append(self)
        from rcl_interfaces.msg import Log, ParameterEvent

        latched = QoSProfile(depth=1000, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self._events = self.create_publisher(ParameterEvent, "/parameter_events", 1000)
        self._rosout = self.create_publisher(Log, "/rosout", latched) if enable_rosout else None
        self._parameters: dict[str, float] = {}
        if start_parameter_services:
            from rclpy.parameter_service import ParameterService

            self._service = ParameterService(self)

    def get_name(self) -> str:
        return self._name

    def get_namespace(self) -> str:
        return "/"

    @property
    def subscriptions(self) -> Iterator[Subscription]:
        yield from (each for each in self._entities if isinstance(each, Subscription))

    @property
    def clients(self) -> Iterator[Client]:
        yield from (each for each in self._entities if isinstance(each, Client))

    @property
    def timers(self) -> Iterator[Timer]:
        yield from self._timers

    def get_clock(self) -> Clock:
        return Clock()

    def resolve_topic_name(self, topic: str) -> str:
        return topic if topic.startswith("/") else f"/{topic}"

    def warn(self, text: str) -> None:
        """Not in the real one, where the logger does it."""
        from rcl_interfaces.msg import Log

        self._rosout.publish(Log(stamp=Clock().now().to_msg(), level=30, name=self._name, msg=text))

    # -- what a node makes -------------------------------------------------------------------------------------------

    def create_publisher(self, msg_type: Any, topic: str, qos_profile: Any) -> Publisher:
        return self._kept(Publisher(self, msg_type, self._full(topic), profile(qos_profile)), False)

    def create_subscription(
        self,
        msg_type: Any,
        topic: str,
        callback: Any,
        qos_profile: Any,
        *,
        callback_group: CallbackGroup | None = None,
        raw: bool = False,
    ) -> Subscription:
        qos = profile(qos_profile)
        return self._kept(Subscription(self, msg_type, self._full(topic), callback, qos, raw, callback_group))

    def create_client(self, srv_type: Any, srv_name: str) -> Client:
        return self._kept(Client(self, srv_type, self._full(srv_name)))

    def create_service(self, srv_type: Any, srv_name: str, callback: Any) -> Service:
        return self._kept(Service(self, srv_type, self._full(srv_name), callback))

    def create_timer(self, timer_period_sec: float, callback: Callable[..., Any]) -> Timer:
        timer = Timer(timer_period_sec, callback)
        self._timers.append(timer)
        self._wake()
        return timer

    def destroy_timer(self, timer: Timer) -> bool:
        if timer not in self._timers:
            return False
        self._timers.remove(timer)
        self._tell_destroyed()
        return True

    def destroy_subscription(self, subscription: Any) -> bool:
        return self._destroy(subscription)

    def destroy_client(self, client: Any) -> bool:
        return self._destroy(client)

    def destroy_publisher(self, publisher: Any) -> bool:
        publisher._leave()
        return True

    def destroy_node(self) -> None:
        self._gone = True
        for timer in list(self._timers):
            self.destroy_timer(timer)
        for entity in list(self._entities):
            self._destroy(entity)
        with _network.lock:
            _network.nodes.remove(self)
            _network.ends[:] = [end for end in _network.ends if end._node is not self]

    def _full(self, name: str) -> str:
        self._check_alive()
        return self.resolve_topic_name(name)

    def _kept(self, entity: Any, waited_for: bool = True) -> Any:
        if waited_for:
            self._entities.append(entity)
            self._wake()
        return entity

    def _destroy(self, entity: Any) -> bool:
        if entity not in self._entities:
            return False
        self._entities.remove(entity)
        entity._leave()
        self._tell_destroyed()
        return True

    def _wake(self) -> None:
        if self.executor is not None:
            self.executor.wake()

    def _tell_destroyed(self) -> None:
        if self.executor is not None:
            self.executor._was_destroyed()

    def _check_alive(self) -> None:
        if self._gone:
            from rclpy._rclpy_pybind11 import InvalidHandle

            raise InvalidHandle("cannot use Destroyable because destruction was requested")

    # -- the graph ---------------------------------------------------------------------------------------------------

    def get_node_names_and_namespaces(self) -> list[tuple[str, str]]:
        self._check_alive()
        with _network.lock:
            return [(node._name, "/") for node in _network.nodes if _network.sees(self, node)]

    def count_publishers(self, topic: str) -> int:
        return len(self._at(topic, "pub"))

    def count_subscribers(self, topic: str) -> int:
        return len(self._at(topic, "sub"))

    def get_publishers_info_by_topic(self, topic: str) -> list[Any]:
        return [_info(end) for end in self._at(topic, "pub")]

    def get_subscriptions_info_by_topic(self, topic: str) -> list[Any]:
        return [_info(end) for end in self._at(topic, "sub")]

    def get_topic_names_and_types(self) -> list[tuple[str, list[str]]]:
        return self._named(_network.found(self, "pub", "sub"))

    def get_service_names_and_types(self) -> list[tuple[str, list[str]]]:
        return self._named(_network.found(self, "srv"))

    def get_publisher_names_and_types_by_node(self, name: str, namespace: str) -> list[tuple[str, list[str]]]:
        return self._of(name, "pub")

    def get_subscriber_names_and_types_by_node(self, name: str, namespace: str) -> list[tuple[str, list[str]]]:
        return self._of(name, "sub")

    def get_service_names_and_types_by_node(self, name: str, namespace: str) -> list[tuple[str, list[str]]]:
        return self._of(name, "srv")

    def get_client_names_and_types_by_node(self, name: str, namespace: str) -> list[tuple[str, list[str]]]:
        return self._of(name, "cli")

    def _at(self, topic: str, kind: str) -> list[Any]:
        self._check_alive()
        return [end for end in _network.found(self, kind) if end._full_name == self.resolve_topic_name(topic)]

    def _of(self, name: str, kind: str) -> list[tuple[str, list[str]]]:
        if (name, "/") not in self.get_node_names_and_namespaces():
            raise NodeNameNonExistentError(f"Cannot get names and types for nonexistent node: {name} /")
        return self._named([end for end in _network.found(self, kind) if end._node._name == name])

    def _named(self, ends: list[Any]) -> list[tuple[str, list[str]]]:
        self._check_alive()
        names = sorted({end._full_name for end in ends})
        return [(name, sorted({end._type_name for end in ends if end._full_name == name})) for name in names]


def _info(end: Any) -> Any:
    return SimpleNamespace(
        node_name=end._node._name,
        node_namespace="/",
        topic_type=end._type_name,
        qos_profile=end._qos,
        endpoint_gid=[end._node._gid, *divmod(id(end), 256)],
    )
