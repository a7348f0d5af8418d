"""Nodes: what a program makes to take part in the graph."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from types import FrameType
from typing import TYPE_CHECKING, Any

from turtle_lesson.ros.core import EPOCH, NANOSECONDS
from turtle_lesson.ros.core.tracebacks import shown_path
from turtle_lesson.ros.graph import NodeEntry
from turtle_lesson.ros.world import current_process, current_world

from . import type_support
from ._arguments import Arguments, parse_arguments
from ._entity import Entity
from ._missing import refuse_unbuilt
from ._mistakes import set_by_init
from ._node_graph import NodeGraph
from ._node_parameters import NodeParameters
from ._qos_events import SIM_TIME, QoSEvents, mismatch_text, unenforced_text
from .callback_groups import CallbackGroup, MutuallyExclusiveCallbackGroup
from .client import Client
from .clock import Clock, ROSClock
from .context import Context
from .exceptions import NodeNameNonExistentError, NotInitializedException, RCLError, refuse_destroyed
from .guard_condition import GuardCondition
from .impl.logging_severity import LoggingSeverity
from .impl.rcutils_logger import RcutilsLogger, publish_rosout
from .parameter import Parameter
from .parameter_service import ParameterService
from .publisher import Publisher
from .qos import (
    DurabilityPolicy,
    QoSProfile,
    checked_profile,
    qos_profile_parameter_events,
    qos_profile_services_default,
)
from .service import Service
from .subscription import Subscription
from .timer import Rate, Timer, period_ns
from .utilities import get_default_context
from .validate_namespace import validate_namespace
from .validate_node_name import validate_node_name

if TYPE_CHECKING:
    from .executors import Executor

__all__ = ["Node", "NodeNameNonExistentError"]

ROSOUT = QoSProfile(depth=1000, durability=DurabilityPolicy.TRANSIENT_LOCAL)


class Node(NodeGraph, NodeParameters):
    """A node of a name. Subclass it, or make one with `rclpy.create_node`.

    What it has for itself is called `_ros_…`, so that a subclass may call its own things whatever it likes.

    Raises NotInitializedException before `rclpy.init()`, and InvalidNodeNameException or InvalidNamespaceException.
    """

    def __init__(
        self,
        node_name: str,
        *,
        context: Context | None = None,
        cli_args: list[str] | None = None,
        namespace: str | None = None,
        use_global_arguments: bool = True,
        enable_rosout: bool = True,
        start_parameter_services: bool = True,
        parameter_overrides: list[Parameter] | None = None,
        allow_undeclared_parameters: bool = False,
        automatically_declare_parameters_from_overrides: bool = False,
        enable_logger_service: bool = False,
    ) -> None:
        self._ros_context = get_default_context() if context is None else context
        if not self._ros_context.ok():
            raise NotInitializedException("cannot create node")
        refuse_unbuilt(enable_logger_service=enable_logger_service)
        arguments = self._ros_arguments_of(cli_args, use_global_arguments)
        self._ros_remaps = arguments.remaps
        name, full_namespace = self._ros_names(node_name, namespace)
        world = current_world()
        self._ros_graph = world.graph
        self._ros_simulation = world.sim
        self._ros_entry = NodeEntry(name, full_namespace, current_process())
        self._ros_executor: Executor | None = None
        self._ros_place = 0
        self._ros_made = 0
        self._ros_publishers: list[Publisher] = []
        self._ros_waiting_entities: list[Entity] = []
        self._ros_events: QoSEvents | None = None
        self._ros_destroyed = False
        self._ros_default_callback_group = MutuallyExclusiveCallbackGroup()
        self._ros_rate_group: CallbackGroup | None = None
        self._ros_clock = ROSClock()
        self._ros_logger = RcutilsLogger(self._ros_entry.full_name.strip("/").replace("/", "."))
        self._ros_graph.add_node(self._ros_entry)
        self._ros_context.track_node(self)
        overrides = [*arguments.parameters_of(self._ros_entry.full_name), *(parameter_overrides or [])]
        self._ros_setup_parameters(overrides, allow_undeclared_parameters)
        self._ros_rosout = self._ros_publish_rosout() if enable_rosout else None
        self._ros_event_publisher = self._ros_publish_parameter_events()
        self.declare_parameter("use_sim_time", False)
        if automatically_declare_parameters_from_overrides:
            for override in self._ros_overrides.values():
                if not self.has_parameter(override.name):
                    self.declare_parameter(override.name, override.value)
        if start_parameter_services:
            self._ros_parameter_service = ParameterService(self)

    def __repr__(self) -> str:
        entry = vars(self).get("_ros_entry")
        return f"<{type(self).__name__} {entry.full_name if entry else 'without a name yet'}>"

    def __enter__(self) -> Node:
        return self

    def __exit__(self, *error: object) -> None:
        self.destroy_node()

    # -- names -----------------------------------------------------------------------------------------------------

    def _ros_arguments_of(self, cli_args: list[str] | None, use_global_arguments: bool) -> Arguments:
        """This node's own ROS arguments, which go before those of the process."""
        own = parse_arguments(cli_args or [])
        common = self._ros_context.arguments if use_global_arguments else Arguments()
        return Arguments(own.remaps + common.remaps, common.parameters + own.parameters)

    def _ros_names(self, node_name: str, namespace: str | None) -> tuple[str, str]:
        if node_name is None:
            raise RCLError("error creating node: its name is None; a node needs a name, such as Node('talker')")
        for what, given in (("name", node_name), ("namespace", namespace or "/")):
            if not isinstance(given, str):
                raise TypeError(f"a node's {what} must be a str, got {given!r}")
        namespace = namespace or "/"
        namespace = namespace if namespace.startswith("/") else f"/{namespace}"
        validate_node_name(node_name)
        original = node_name
        for rule in self._ros_remaps:
            if rule.node not in (None, original):
                continue
            if rule.match in {"__node", "__name"}:
                node_name = rule.replacement
            elif rule.match == "__ns":
                namespace = rule.replacement
        validate_node_name(node_name)
        validate_namespace(namespace)
        return node_name, namespace

    def get_name(self) -> str:
        """The node's name."""
        return self._ros_entry.name

    def get_namespace(self) -> str:
        """The node's namespace."""
        return self._ros_entry.namespace

    def get_fully_qualified_name(self) -> str:
        """Namespace and name."""
        return self._ros_entry.full_name

    # -- what it has -----------------------------------------------------------------------------------------------

    def _ros_entities(self) -> Iterator[Entity]:
        return iter(list(self._ros_waiting_entities))

    def _ros_of_kind(self, kind: type) -> Iterator[Any]:
        return (entity for entity in list(self._ros_waiting_entities) if isinstance(entity, kind))

    @property
    def publishers(self) -> Iterator[Publisher]:
        """The node's publishers."""
        return iter(list(self._ros_publishers))

    @property
    def subscriptions(self) -> Iterator[Subscription]:
        """The node's subscriptions."""
        return self._ros_of_kind(Subscription)

    @property
    def clients(self) -> Iterator[Client]:
        """The node's clients."""
        return self._ros_of_kind(Client)

    @property
    def services(self) -> Iterator[Service]:
        """The node's services."""
        return self._ros_of_kind(Service)

    @property
    def timers(self) -> Iterator[Timer]:
        """The node's timers."""
        return self._ros_of_kind(Timer)

    @property
    def guards(self) -> Iterator[GuardCondition]:
        """The node's guard conditions."""
        return self._ros_of_kind(GuardCondition)

    @property
    def waitables(self) -> Iterator[Any]:
        """Other things that an executor waits for: none here."""
        return iter(())

    @property
    def context(self) -> Context:  # type: ignore[override]
        """The context that the node lives in."""
        return self._ros_context

    @property
    def default_callback_group(self) -> CallbackGroup:
        """The group of callbacks that name none: one at a time."""
        return self._ros_default_callback_group

    @property
    def executor(self) -> Executor | None:
        """The executor that runs the node's callbacks, if any."""
        return self._ros_executor

    @executor.setter
    def executor(self, new_executor: Executor | None) -> None:
        if self._ros_executor is new_executor:
            return
        if self._ros_executor is not None:
            self._ros_executor.remove_node(self)
        if new_executor is not None:
            new_executor.add_node(self)

    @property
    def handle(self) -> Any:
        """The node stands for itself: there is no C object beneath it."""
        return self

    def get_logger(self) -> RcutilsLogger:
        """The node's logger."""
        return self._ros_logger

    def get_clock(self) -> Clock:
        """The node's clock, which shows ROS time."""
        return self._ros_clock

    # -- making things ---------------------------------------------------------------------------------------------

    def _ros_check_alive(self) -> None:
        if self._ros_destroyed:
            refuse_destroyed(self._ros_simulation)

    def _ros_keep(self, entity: Any) -> Any:
        self._ros_made += 1
        entity._number, entity._node = self._ros_made, self
        self._ros_waiting_entities.append(entity)
        if self._ros_executor is not None:
            self._ros_executor._adopt(entity, self)
        return entity

    def create_publisher(
        self,
        msg_type: Any,
        topic: str,
        qos_profile: QoSProfile | int,
        *,
        callback_group: CallbackGroup | None = None,
        event_callbacks: Any = None,
        qos_overriding_options: Any = None,
        publisher_class: type[Publisher] = Publisher,
    ) -> Publisher:
        """Publish messages of a type on a topic. `qos_profile`: a QoSProfile, or how many to keep for late takers.

        Raises InvalidTopicNameException, AttributeError or RuntimeError (no message type), TypeError, ValueError.
        """
        self._ros_check_alive()
        refuse_unbuilt(event_callbacks=event_callbacks, qos_overriding_options=qos_overriding_options)
        profile = checked_profile(qos_profile)
        full_name = self._ros_full_name_of(topic)
        type_support.check_is_valid_msg_type(msg_type)
        self._ros_check_one_type("publisher", full_name, msg_type)
        kind = msg_type if isinstance(msg_type, type) else type(msg_type)
        writer = self._ros_graph.add_writer(self._ros_entry, full_name, kind._TYPE_NAME, profile.quality())  # type: ignore[attr-defined]
        writer.profile = profile  # type: ignore[attr-defined]
        writer.on_mismatch = lambda policy: self._ros_warn(mismatch_text(topic, policy, publishes=True))
        publisher = publisher_class(writer, kind, topic, profile, self._ros_logger.name)
        self._ros_publishers.append(publisher)
        self._ros_say_unenforced("publisher", topic, profile)
        return publisher

    def create_subscription(
        self,
        msg_type: Any,
        topic: str,
        callback: Callable[..., Any],
        qos_profile: QoSProfile | int,
        *,
        callback_group: CallbackGroup | None = None,
        event_callbacks: Any = None,
        qos_overriding_options: Any = None,
        raw: bool = False,
    ) -> Subscription:
        """Have `callback(message)` called for each message of a topic; the queue keeps `qos_profile` of them.

        Raises InvalidTopicNameException, AttributeError or RuntimeError (no message type), TypeError, ValueError.
        """
        self._ros_check_alive()
        refuse_unbuilt(event_callbacks=event_callbacks, qos_overriding_options=qos_overriding_options)
        profile = checked_profile(qos_profile)
        full_name = self._ros_full_name_of(topic)
        type_support.check_is_valid_msg_type(msg_type)
        self._ros_check_one_type("subscription", full_name, msg_type)
        reader = self._ros_graph.add_reader(self._ros_entry, full_name, msg_type._TYPE_NAME, profile.quality())
        reader.profile = profile  # type: ignore[attr-defined]
        reader.on_mismatch = lambda policy: self._ros_warn(mismatch_text(topic, policy, publishes=False))
        group = callback_group or self._ros_default_callback_group
        self._ros_say_unenforced("subscription", topic, profile)
        return self._ros_keep(
            Subscription(reader, msg_type, topic, callback, group, profile, raw, self._ros_logger.name)
        )

    def _ros_check_one_type(self, what: str, full_name: str, msg_type: Any) -> None:
        """Within one process ROS refuses a second type on a topic; between processes it only never connects."""
        topic = self._ros_graph.topic(full_name)
        ends: list[tuple[Any, str]] = [*topic.writers, *topic.readers]
        for end, type_name in ends:
            if end.node.process is self._ros_entry.process and type_name != msg_type._TYPE_NAME:
                raise RCLError(
                    f"Failed to create {what}: failed to create topic [rt{full_name}] because it's already in use in this "
                    f"context with a different message type: it is {type_name}, asked for was {msg_type._TYPE_NAME}"
                )

    def _ros_say_unenforced(self, what: str, topic: str, profile: QoSProfile) -> None:
        if text := unenforced_text(what, topic, profile):
            self._ros_logger.warning(text)

    def _ros_warn(self, text: str) -> None:
        """Log a warning when the node is spun."""
        if self._ros_destroyed:
            return
        if self._ros_events is None:
            self._ros_events = self._ros_keep(QoSEvents(self._ros_logger, self._ros_default_callback_group))
        self._ros_events.add(text)

    def create_timer(
        self,
        timer_period_sec: float,
        callback: Callable[..., Any],
        callback_group: CallbackGroup | None = None,
        clock: Clock | None = None,
        autostart: bool = True,
    ) -> Timer:
        """Have `callback()` called every `timer_period_sec` seconds, for the first time after one period."""
        self._ros_check_alive()
        period = period_ns(timer_period_sec)
        group = callback_group or self._ros_default_callback_group
        return self._ros_keep(Timer(callback, group, period, clock or self._ros_clock, autostart=autostart))

    def create_service(
        self,
        srv_type: Any,
        srv_name: str,
        callback: Callable[[Any, Any], Any],
        *,
        qos_profile: QoSProfile = qos_profile_services_default,
        callback_group: CallbackGroup | None = None,
    ) -> Service:
        """Offer a service: `callback(request, response)` fills the response in and returns it.

        Raises InvalidServiceNameException, AttributeError or RuntimeError (no service type).
        """
        self._ros_check_alive()
        full_name = self._ros_full_name_of(srv_name, is_service=True)
        type_support.check_is_valid_srv_type(srv_type)
        server = self._ros_graph.add_server(self._ros_entry, full_name, srv_type._TYPE_NAME)
        group = callback_group or self._ros_default_callback_group
        return self._ros_keep(Service(server, srv_type, srv_name, callback, group, qos_profile))

    def create_client(
        self,
        srv_type: Any,
        srv_name: str,
        *,
        qos_profile: QoSProfile = qos_profile_services_default,
        callback_group: CallbackGroup | None = None,
    ) -> Client:
        """Make a client of a service. Raises InvalidServiceNameException, AttributeError or RuntimeError."""
        self._ros_check_alive()
        full_name = self._ros_full_name_of(srv_name, is_service=True)
        type_support.check_is_valid_srv_type(srv_type)
        end = self._ros_graph.add_client(self._ros_entry, full_name, srv_type._TYPE_NAME)
        group = callback_group or self._ros_default_callback_group
        return self._ros_keep(Client(self, end, srv_type, srv_name, qos_profile, group))

    def create_guard_condition(
        self, callback: Callable[[], Any], callback_group: CallbackGroup | None = None
    ) -> GuardCondition:
        """Have `callback()` called whenever the guard condition is triggered."""
        self._ros_check_alive()
        group = callback_group or self._ros_default_callback_group
        return self._ros_keep(GuardCondition(callback, group, context=self._ros_context))

    def create_rate(self, frequency: float, clock: Clock | None = None) -> Rate:
        """Something to sleep by, `frequency` times a second."""
        if frequency <= 0:
            raise ValueError("frequency must be > 0")
        if self._ros_rate_group is None:
            from .callback_groups import ReentrantCallbackGroup

            self._ros_rate_group = ReentrantCallbackGroup()
        timer = self.create_timer(1.0 / frequency, _nothing, self._ros_rate_group, clock)
        return Rate(timer, context=self._ros_context)

    # -- taking things away ----------------------------------------------------------------------------------------

    def _ros_destroy(self, entity: Any) -> bool:
        if entity not in self._ros_waiting_entities:
            return False
        self._ros_waiting_entities.remove(entity)
        entity.destroy()
        return True

    def destroy_publisher(self, publisher: Publisher) -> bool:
        """Stop publishing; False if it is not this node's."""
        if publisher not in self._ros_publishers:
            return False
        self._ros_publishers.remove(publisher)
        publisher.destroy()
        return True

    def destroy_subscription(self, subscription: Subscription) -> bool:
        """Stop hearing; False if it is not this node's."""
        return self._ros_destroy(subscription)

    def destroy_client(self, client: Client) -> bool:
        """Take a client away; False if it is not this node's."""
        return self._ros_destroy(client)

    def destroy_service(self, service: Service) -> bool:
        """Take a service away; False if it is not this node's."""
        return self._ros_destroy(service)

    def destroy_timer(self, timer: Timer) -> bool:
        """Take a timer away; False if it is not this node's."""
        return self._ros_destroy(timer)

    def destroy_guard_condition(self, guard: GuardCondition) -> bool:
        """Take a guard condition away; False if it is not this node's."""
        return self._ros_destroy(guard)

    def destroy_rate(self, rate: Rate) -> bool:
        """Take a rate away; False if it is not this node's."""
        return self._ros_destroy(rate._timer)

    def destroy_node(self) -> None:
        """Leave the graph, with everything that the node has made."""
        self._ros_leave()

    def _ros_leave(self) -> None:
        """What `destroy_node` does, also where a subclass has a `destroy_node` of its own."""
        if self._ros_destroyed:
            return
        if self._ros_executor is not None:
            self._ros_executor.remove_node(self)
        for publisher in list(self._ros_publishers):
            self.destroy_publisher(publisher)
        for entity in list(self._ros_waiting_entities):
            self._ros_destroy(entity)
        if self._ros_rosout is not None:
            publish_rosout(self._ros_logger.name, None)
        self._ros_destroyed = True
        self._ros_context.untrack_node(self)
        self._ros_graph.remove_node(self._ros_entry)

    # -- what every node has ---------------------------------------------------------------------------------------

    def _ros_publish_rosout(self) -> Publisher:
        """Publish on /rosout what the logger prints."""
        from rcl_interfaces.msg import Log

        publisher = self.create_publisher(Log, "/rosout", ROSOUT)
        trace = self._ros_graph.trace

        def publish(message: str, severity: LoggingSeverity, frame: FrameType) -> None:
            log = Log(level=int(severity), name=self._ros_logger.name, msg=message)
            log.stamp.sec, log.stamp.nanosec = divmod(EPOCH + self._ros_simulation.now, NANOSECONDS)
            log.file = shown_path(frame.f_code.co_filename)  # the whole path would differ between machines
            log.function, log.line = frame.f_code.co_name, frame.f_lineno
            publisher.publish(log)
            if trace is not None:
                trace.log.append((self._ros_simulation.now, int(severity), log.name, message))

        publish_rosout(self._ros_logger.name, publish)
        return publisher

    def _ros_publish_parameter_events(self) -> Publisher:
        """Publish on /parameter_events what becomes of the parameters."""
        from rcl_interfaces.msg import ParameterEvent

        return self.create_publisher(ParameterEvent, "/parameter_events", qos_profile_parameter_events)

    def _ros_tell_parameter_events(self, news: dict[str, list[Any]]) -> None:
        if any(each.name == "use_sim_time" and each.value.bool_value for kind in news.values() for each in kind):
            self._ros_logger.warning(SIM_TIME)
        event = self._ros_event_publisher.msg_type(node=self._ros_entry.full_name)
        event.stamp.sec, event.stamp.nanosec = divmod(EPOCH + self._ros_simulation.now, NANOSECONDS)
        for kind, parameters in news.items():
            setattr(event, f"{kind}_parameters", parameters)
        self._ros_event_publisher.publish(event)


def _nothing() -> None:
    """The callback of a rate's timer."""


set_by_init(
    Node, "_ros_clock", "_ros_destroyed", "_ros_entry", "_ros_graph", "_ros_logger", "_ros_overrides", "_ros_parameters"
)
