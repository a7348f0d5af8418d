"""Where ROS time comes from: the topic /clock, if the node's parameter use_sim_time says so (rclpy's time_source.py)."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from turtle_lesson.ros.sim.errors import NeverWakes
from turtle_lesson.ros.sim.simulation import NANOSECONDS
from turtle_lesson.ros.sim.strand import Strand

from ._blocking import somebody_spins
from ._deadlock import holds_group
from .clock import ROSClock
from .clock_type import ClockType
from .parameter import Parameter
from .qos import QoSProfile, ReliabilityPolicy
from .time import Time

if TYPE_CHECKING:
    from .node import Node
    from .subscription import Subscription

CLOCK_TOPIC = "/clock"
USE_SIM_TIME_NAME = "use_sim_time"

PATIENCE = 5 * NANOSECONDS
"""How long /clock may be silent before the node logs a warning (a real one waits in silence)."""

SILENCE = (
    "The parameter use_sim_time is true, but nothing has been heard on /clock so far: time stands still for this node, "
    "and its timers wait. Does a node publish /clock? Without use_sim_time the node uses the system time."
)


class TimeSource:
    """Sets the clocks that are attached to it to what its node hears on /clock."""

    def __init__(self, *, node: Node | None = None) -> None:
        self._node: Node | None = None
        self._clocks: list[ROSClock] = []
        self._clock_sub: Subscription | None = None
        self._last_time_set = Time(clock_type=ClockType.ROS_TIME)
        self._is_active = False
        self._heard = False
        if node is not None:
            self.attach_node(node)

    @property
    def ros_time_is_active(self) -> bool:
        """Whether the clocks follow /clock."""
        return self._is_active

    @ros_time_is_active.setter
    def ros_time_is_active(self, enabled: bool) -> None:
        if self._is_active == enabled:
            return
        self._is_active = enabled
        for clock in self._clocks:
            clock._set_ros_time_is_active(enabled)
        if enabled:
            self._subscribe()
        else:
            self._stop_hearing()

    def _subscribe(self) -> None:
        node = self._node
        if self._clock_sub is not None or node is None:
            return
        from rosgraph_msgs.msg import Clock as Message

        latest = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)
        self._clock_sub = node.create_subscription(Message, CLOCK_TOPIC, self.clock_callback, latest)
        self._heard = False
        node._ros_simulation.call_later(PATIENCE, self._warn_of_silence)

    def _warn_of_silence(self) -> None:
        """Have the node say, when it is spun, that its time stands still."""
        node = self._node
        if node is None or node._ros_destroyed or self._heard or not self._is_active:
            return

        def say() -> None:
            node.get_logger().warning(SILENCE)
            node.destroy_guard_condition(guard)

        guard = node.create_guard_condition(say)
        guard.trigger()

    def attach_node(self, node: Node) -> None:
        """Hear /clock through a node, as soon as its parameter use_sim_time is true. Raises TypeError."""
        from .node import Node

        if not isinstance(node, Node):
            raise TypeError("Node must be of type rclpy.node.Node")
        if self._node is not None:
            self.detach_node()
        self._node = node
        if not node.has_parameter(USE_SIM_TIME_NAME):
            node.declare_parameter(USE_SIM_TIME_NAME, False)
        asked = node.get_parameter(USE_SIM_TIME_NAME)
        if asked.type_ == Parameter.Type.BOOL:
            self.ros_time_is_active = asked.value
        node.add_on_set_parameters_callback(self._on_parameter_event)

    def detach_node(self) -> None:
        """No longer hear through the node."""
        self._stop_hearing()
        self._node = None

    def _stop_hearing(self) -> None:
        if self._clock_sub is not None and self._node is not None:
            self._node.destroy_subscription(self._clock_sub)
        self._clock_sub = None

    def attach_clock(self, clock: ROSClock) -> None:
        """Set this clock, too. Raises ValueError for any but a ROSClock."""
        if not isinstance(clock, ROSClock):
            raise ValueError("Only clocks with type ROS_TIME can be attached.")
        clock.set_ros_time_override(self._last_time_set)
        clock._set_ros_time_is_active(self._is_active)
        clock._source = self
        self._clocks.append(clock)

    def clock_callback(self, msg: Any) -> None:
        """A message on /clock (rosgraph_msgs/msg/Clock) has been heard."""
        self._heard = True
        self._last_time_set = Time.from_msg(msg.clock)
        for clock in self._clocks:
            clock.set_ros_time_override(self._last_time_set)

    def _on_parameter_event(self, parameter_list: list[Parameter]) -> Any:
        from rcl_interfaces.msg import SetParametersResult

        for parameter in parameter_list:
            if parameter.name == USE_SIM_TIME_NAME and parameter.type_ == Parameter.Type.BOOL:
                self.ros_time_is_active = parameter.value
        return SetParametersResult(successful=True)

    def check_it_may_hear(self, strand: Strand) -> None:
        """Raise NeverWakes if nobody can hear /clock while this strand waits for the time to go on."""
        node, subscription = self._node, self._clock_sub
        if node is None or subscription is None:
            return
        if somebody_spins(node._ros_assignment.executor, strand) and not holds_group(subscription.callback_group):
            return
        raise NeverWakes(
            f"this sleep would never end: {node!r} follows {CLOCK_TOPIC} (use_sim_time is true), and cannot hear it "
            "meanwhile, so its time stands still. Use a timer; or a MultiThreadedExecutor, with this callback in a group "
            "of its own."
        )
