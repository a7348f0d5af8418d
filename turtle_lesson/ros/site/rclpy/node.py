"""Nodes: what a program makes to take part in the graph."""

from __future__ import annotations

from collections.abc import Iterator
from types import FrameType
from typing import Any

from turtle_lesson.ros.rmw.graph import NodeEntry
from turtle_lesson.ros.rmw.names import Remap
from turtle_lesson.ros.runtime.world import current_process
from turtle_lesson.ros.sim.errors import shown_path
from turtle_lesson.ros.sim.simulation import EPOCH, NANOSECONDS

from ._entity import Handle
from ._hints import SetByInit, find_taken
from ._node_entities import NodeEntities
from ._node_graph import NodeGraph
from ._node_parameters import TOLERANCE, NodeParameters
from ._ros_args import Arguments, parse_arguments
from ._state import RclpyState
from .callback_groups import CallbackGroup
from .client import Client
from .clock import Clock
from .context import Context
from .exceptions import NotInitializedException
from .executors import Executor
from .guard_condition import GuardCondition
from .impl.logging_severity import LoggingSeverity
from .impl.rcutils_logger import RcutilsLogger
from .logging_service import LoggingService
from .parameter import PARAMETER_SEPARATOR_STRING as PARAMETER_SEPARATOR_STRING
from .parameter import Parameter
from .parameter_service import ParameterService
from .publisher import Publisher
from .qos import QoSProfile, qos_profile_parameter_events, qos_profile_rosout_default
from .service import Service
from .subscription import Subscription
from .time_source import TimeSource
from .timer import Timer
from .utilities import get_default_context
from .validate_namespace import validate_namespace
from .validate_node_name import validate_node_name

HIDDEN_NODE_PREFIX = "_"
"""What the name of a node begins with that tools leave out of their lists."""

TWO_OF_A_NAME = (
    "Publisher already registered for provided node name. If this is due to multiple nodes with the same name then all "
    "logs for that logger name will go out over the existing publisher. As soon as any node with that name is destructed "
    "it will unregister the publisher, preventing any further logs for that name from being published on the rosout topic."
)


class Node(NodeParameters):
    """A node of a name. Subclass it, or make one with `rclpy.create_node`.

    What it has for itself is called `_ros_…`, so that a subclass may call its own things whatever it likes.

    Raises NotInitializedException before `rclpy.init()`, and InvalidNodeNameException or InvalidNamespaceException.
    """

    PARAM_REL_TOL = TOLERANCE
    """How far, relatively, a floating-point value may be off an end or a step of its range."""

    def __init__(
        self,
        node_name: str,
        *,
        context: Context | None = None,
        cli_args: list[str] | None = None,
        namespace: str | None = None,
        use_global_arguments: bool = True,
        enable_rosout: bool = True,
        rosout_qos_profile: QoSProfile | int = qos_profile_rosout_default,
        start_parameter_services: bool = True,
        parameter_overrides: list[Parameter] | None = None,
        allow_undeclared_parameters: bool = False,
        automatically_declare_parameters_from_overrides: bool = False,
        enable_logger_service: bool = False,
    ) -> None:
        from rcl_interfaces.msg import ParameterEvent

        context = get_default_context() if context is None else context
        if not context.ok():
            raise NotInitializedException("cannot create node")
        own = parse_arguments([] if cli_args is None else cli_args)
        common = context.arguments if use_global_arguments else Arguments()
        remaps = own.remaps + common.remaps
        entry = NodeEntry(*_names(node_name, namespace, remaps), current_process())
        self._ros_setup_graph(entry, remaps)
        self._ros_setup_entities(context)
        self._ros_place: tuple[Any, int] = (None, 0)
        self._ros_logs_on_rosout = False  # an interrupted __init__ leaves a node that is destroyed all the same
        self._ros_logger = RcutilsLogger(entry.full_name.strip("/").replace("/", "."))
        self._ros_graph.add_node(entry)
        context.track_node(self)
        given = [*common.parameters_of(entry.full_name), *own.parameters_of(entry.full_name)]
        self._ros_setup_parameters([*given, *(parameter_overrides or [])], allow_undeclared_parameters)
        self._ros_logs_on_rosout = enable_rosout
        if enable_rosout:
            self._ros_publish_rosout(rosout_qos_profile)
        self._ros_event_publisher = self.create_publisher(
            ParameterEvent, "/parameter_events", qos_profile_parameter_events
        )
        if automatically_declare_parameters_from_overrides:
            self._ros_declare_overrides()
        self._ros_time_source = TimeSource(node=self)
        self._ros_time_source.attach_clock(self._ros_clock)
        if start_parameter_services:
            ParameterService(self)
        if enable_logger_service:
            LoggingService(self)

    def __repr__(self) -> str:
        entry = vars(self).get("_ros_entry")
        return f"<{type(self).__name__} {entry.full_name if entry else 'without a name yet'}>"

    def __enter__(self) -> Node:
        return self

    def __exit__(self, *error: object) -> None:
        self.destroy_node()

    def get_name(self) -> str:
        """The node's name."""
        self._ros_check_alive()
        return self._ros_entry.name

    def get_namespace(self) -> str:
        """The node's namespace."""
        self._ros_check_alive()
        return self._ros_entry.namespace

    def get_fully_qualified_name(self) -> str:
        """Namespace and name."""
        self._ros_check_alive()
        return self._ros_entry.full_name

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
    def context(self) -> Context:
        """The context that the node lives in."""
        return self._ros_context

    @property
    def default_callback_group(self) -> CallbackGroup:
        """The group of callbacks that name none: one at a time."""
        return self._ros_default_callback_group

    @property
    def executor(self) -> Executor | None:
        """The executor that runs the node's callbacks, or was the last to do so, if any."""
        return self._ros_assignment.executor or self._ros_place[0]

    @executor.setter
    def executor(self, new_executor: Executor | None) -> None:
        if self.executor is new_executor:
            return
        if self.executor is not None:
            self.executor.remove_node(self)
        self._ros_place = (None, 0)
        if new_executor is not None:
            new_executor.add_node(self)

    @property
    def handle(self) -> Handle:
        """What stands for the C object of the real one."""
        return Handle(self)

    def get_logger(self) -> RcutilsLogger:
        """The node's logger."""
        return self._ros_logger

    def get_clock(self) -> Clock:
        """The node's clock, which shows ROS time."""
        return self._ros_clock

    def _ros_publish_rosout(self, profile: QoSProfile | int) -> None:
        """Publish on /rosout what the logger prints."""
        from rcl_interfaces.msg import Log

        own = current_process().state(RclpyState)
        if self._ros_logger.name in own.rosout:
            RcutilsLogger("rcl.logging_rosout").warning(TWO_OF_A_NAME)
            return
        publisher = self.create_publisher(Log, "/rosout", profile)
        trace = self._ros_graph.trace

        def publish(name: str, message: str, severity: LoggingSeverity, frame: FrameType) -> None:
            log = Log(level=int(severity), name=name, msg=message)
            log.stamp.sec, log.stamp.nanosec = divmod(EPOCH + self._ros_simulation.now, NANOSECONDS)
            log.file = shown_path(frame.f_code.co_filename)  # the whole path would differ between machines
            log.function, log.line = frame.f_code.co_name, frame.f_lineno
            publisher.publish(log)
            if trace is not None:
                trace.log.append((self._ros_simulation.now, int(severity), log.name, message))

        own.rosout[self._ros_logger.name] = publish

    def destroy_node(self) -> None:
        """Leave the graph, with everything that the node has made."""
        self._ros_shut_down = False
        self._ros_leave()

    def _ros_shut(self) -> None:
        """The context ends: leave the graph, but stay what it is, with what it has made."""
        self._ros_leave()
        self._ros_shut_down = True

    def _ros_leave(self) -> None:
        """What `destroy_node` does, also where a subclass has a `destroy_node` of its own."""
        if self._ros_destroyed:
            return
        if self._ros_assignment.executor is not None:
            self._ros_assignment.executor.remove_node(self)
        for publisher in list(self._ros_publishers):
            self.destroy_publisher(publisher)
        for entity in list(self._ros_waiting_entities):
            self._ros_destroy(entity)
        if self._ros_logs_on_rosout:
            self._ros_entry.process.state(RclpyState).rosout.pop(self._ros_logger.name, None)
        self._ros_destroyed = True
        self._ros_context.untrack_node(self)
        self._ros_graph.remove_node(self._ros_entry)


for _name in ("clock", "destroyed", "entry", "graph", "logger", "overrides", "parameters"):
    setattr(Node, f"_ros_{_name}", SetByInit())

for _part in (NodeEntities, NodeGraph, NodeParameters):
    for _name, _method in vars(_part).items():
        if not _name.startswith("_"):
            _method.__qualname__ = f"Node.{_name}"  # Python's own errors name it: nobody knows of parts


def _names(node_name: str, namespace: str | None, remaps: list[Remap]) -> tuple[str, str]:
    """A node's name and namespace, remapped. Raises InvalidNodeNameException or InvalidNamespaceException."""
    namespace = namespace or "/"
    for what, given in (("name", node_name), ("namespace", namespace)):
        if not isinstance(given, str):
            raise TypeError(f"a node's {what} must be a str, got {given!r}")
    namespace = namespace if namespace.startswith("/") else f"/{namespace}"
    validate_node_name(node_name)
    original = node_name
    for rule in remaps:
        if rule.node not in (None, original):
            continue
        if rule.match == "__node":
            node_name = rule.replacement
        elif rule.match == "__ns":
            namespace = rule.replacement
    validate_node_name(node_name)
    validate_namespace(namespace)
    return node_name, namespace


__getattr__ = find_taken(__name__)
