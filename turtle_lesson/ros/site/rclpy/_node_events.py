"""The part of a node that tells everybody: what it logs, on /rosout, and what becomes of parameters, on /parameter_events."""

from __future__ import annotations

from types import FrameType
from typing import TYPE_CHECKING, Any

from turtle_lesson.ros.sim.errors import shown_path
from turtle_lesson.ros.sim.simulation import EPOCH, NANOSECONDS

from .impl.logging_severity import LoggingSeverity
from .impl.rcutils_logger import RcutilsLogger, is_on_rosout, publish_rosout
from .qos import QoSProfile, qos_profile_parameter_events

if TYPE_CHECKING:
    from turtle_lesson.ros.rmw.graph import Graph, NodeEntry
    from turtle_lesson.ros.sim.simulation import Simulation

    from .clock import ROSClock
    from .publisher import Publisher


class NodeNews:
    """Mixed into Node."""

    _ros_clock: ROSClock
    _ros_entry: NodeEntry
    _ros_event_publisher: Publisher
    _ros_graph: Graph
    _ros_logger: RcutilsLogger
    _ros_simulation: Simulation

    if TYPE_CHECKING:

        def create_publisher(self, msg_type: Any, topic: str, qos_profile: QoSProfile | int) -> Publisher: ...

    def _ros_publish_rosout(self, profile: QoSProfile | int) -> None:
        """Publish on /rosout what the logger prints."""
        from rcl_interfaces.msg import Log

        if is_on_rosout(self._ros_logger.name):
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

        publish_rosout(self._ros_logger.name, publish)

    def _ros_publish_parameter_events(self) -> Publisher:
        """Publish on /parameter_events what becomes of the parameters."""
        from rcl_interfaces.msg import ParameterEvent

        return self.create_publisher(ParameterEvent, "/parameter_events", qos_profile_parameter_events)

    def _ros_tell_parameter_events(self, news: dict[str, list[Any]]) -> None:
        event = self._ros_event_publisher.msg_type(node=self._ros_entry.full_name)
        event.stamp.sec, event.stamp.nanosec = divmod(self._ros_clock._now(), NANOSECONDS)
        for kind, parameters in news.items():
            setattr(event, f"{kind}_parameters", parameters)
        self._ros_event_publisher.publish(event)
