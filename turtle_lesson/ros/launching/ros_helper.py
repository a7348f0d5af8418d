"""`RosHelper`: the node that launch itself has, `/launch_ros_<pid>`, where managed nodes are launched.

It is a process of the world like any other, so that its calls take the time that calls take.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from ..core import Process
    from ..world import World

LOOKS_AGAIN = 0.01
"""How often, in s, it looks whether a node has its service by now."""


class RosHelper:
    """Listens to managed nodes and asks them for transitions; what it hears is told outside of its process."""

    def __init__(self, world: World, carry_on: Callable[[Callable[[], None]], None]) -> None:
        self._world = world
        self._carry_on = carry_on
        self._orders: list[Callable[[], None]] = []
        self._node: Any = None
        self._executor: Any = None
        self._clients: dict[str, Any] = {}
        self._ended = False
        self._process: Process = world.spawn(self._main, name="launch_ros", argv=["launch_ros"])

    def _main(self) -> None:
        import rclpy
        from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor

        rclpy.init(args=[])
        self._node = rclpy.create_node(f"launch_ros_{self._process.pid}", start_parameter_services=False)
        self._executor = SingleThreadedExecutor()
        self._executor.add_node(self._node)
        self._wakes = self._node.create_guard_condition(self._work)
        self._work()
        try:
            self._executor.spin()
        except (KeyboardInterrupt, ExternalShutdownException):
            pass
        finally:
            rclpy.try_shutdown()

    def _work(self) -> None:
        """Carry the orders out, in the helper's own process."""
        while self._orders:
            self._orders.pop(0)()

    def _order(self, order: Callable[[], None]) -> None:
        self._orders.append(order)
        if self._node is not None:
            self._wakes.trigger()

    def _tell(self, function: Callable[[], None]) -> None:
        """Call a function of the launch, outside of this process and at this instant."""
        if not self._ended:
            self._world.sim.call_later(0, self._carry_on, function)

    def watch(self, node_name: str, heard: Callable[[Any], None]) -> None:
        """Have a function called with each TransitionEvent of a node."""
        from lifecycle_msgs.msg import TransitionEvent

        def subscribe() -> None:
            topic = f"{node_name}/transition_event"
            self._node.create_subscription(TransitionEvent, topic, lambda msg: self._tell(lambda: heard(msg)), 10)

        self._order(subscribe)

    def change_state(self, node_name: str, transition_id: int, answered: Callable[[bool], None]) -> None:
        """Ask a node for a transition, as soon as it has the service; the function is called with the answer."""
        from lifecycle_msgs.srv import ChangeState

        def call() -> None:
            client = self._client(node_name, ChangeState)
            if not client.service_is_ready():  # wait without holding up what other nodes tell
                timer: Any = self._node.create_timer(LOOKS_AGAIN, lambda: again(timer))
                return
            request = ChangeState.Request()
            request.transition.id = transition_id
            future = client.call_async(request)
            future.add_done_callback(lambda done: self._tell(lambda: answered(done.result().success)))

        def again(timer: Any) -> None:
            self._node.destroy_timer(timer)
            call()

        self._order(call)

    def _client(self, node_name: str, kind: Any) -> Any:
        if node_name not in self._clients:
            self._clients[node_name] = self._node.create_client(kind, f"{node_name}/change_state")
        return self._clients[node_name]

    def close(self) -> None:
        """End it."""
        self._ended = True
        if self._process.exit_code is None:
            self._process.kill()
