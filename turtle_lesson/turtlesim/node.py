"""The node ``/turtlesim``: shows the turtles' world to ROS as the turtlesim of ROS 2 Humble does.

Plain ``rclpy``: services ``/spawn``, ``/kill``, ``/clear`` and ``/reset``; for each turtle the topics
``cmd_vel``, ``pose`` and ``color_sensor``, the services ``set_pen``, ``teleport_absolute`` and
``teleport_relative``, and the action ``rotate_absolute``; the parameters of the background. A timer of 16 ms moves
the world on and publishes.

Where it differs from the real one:

- there is no window, so the background's parameters can be set, but nothing shows them;
- a turtle that pushes against a wall is reported when it gets there and then once a second, not 62.5 times a
  second;
- what ends the real program or leads its turtle to NaN is refused, with an error in the log; so is a heading to
  rotate to, with which the real turtle would turn forever;
- a service answers at once, not at the next tick (its effect on a moving turtle comes with that tick in
  both).
"""

from collections.abc import Callable
from functools import partial
from typing import Any, TypeVar

from geometry_msgs.msg import Twist
from rcl_interfaces.msg import IntegerRange, ParameterDescriptor, ParameterEvent
from rclpy.action import ActionServer, CancelResponse, GoalResponse
from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy
from rclpy.task import Future
from std_srvs.srv import Empty
from turtlesim.action import RotateAbsolute
from turtlesim.msg import Color, Pose
from turtlesim.srv import Kill, SetPen, Spawn, TeleportAbsolute, TeleportRelative

from turtle_lesson.ros.tools import spin
from turtle_lesson.turtlesim.turtle import (
    HEIGHT,
    LARGEST,
    QUEUE_DEPTH,
    TICK,
    TICK_MS,
    Rotation,
    Turtle,
    TurtleError,
    TurtleWorld,
    float32,
)

BACKGROUND = {"r": ("Red", 69), "g": ("Green", 86), "b": ("Blue", 255)}
TICKS_BETWEEN_WALL_WARNINGS = 1000 // TICK_MS + 1

T = TypeVar("T")


class TurtlesimNode(Node):
    """The simulator: a world of turtles, its clock, and what may be asked of the world as a whole."""

    def __init__(self) -> None:
        super().__init__("turtlesim")
        for letter, (colour, value) in BACKGROUND.items():
            descriptor = ParameterDescriptor(
                description=f"{colour} channel of the background color",
                integer_range=[IntegerRange(from_value=0, to_value=255, step=1)],
            )
            self.declare_parameter(f"background_{letter}", value, descriptor)
        # The real one repaints its window then.
        quality = QoSProfile(depth=100, reliability=ReliabilityPolicy.BEST_EFFORT)
        self.create_subscription(ParameterEvent, "/parameter_events", lambda _event: None, quality)
        self.create_service(Empty, "clear", self._on_clear)
        self.create_service(Empty, "reset", self._on_reset)
        self.create_service(Spawn, "spawn", self._on_spawn)
        self.create_service(Kill, "kill", self._on_kill)
        self.get_logger().info(f"Starting turtlesim with node name {self.get_fully_qualified_name()}")
        self._world = TurtleWorld()
        self._shown: dict[str, ShownTurtle] = {}
        self._pushing: dict[str, int] = {}  # turtles at a wall: for how many ticks they have pushed
        self._turning: list[RotateAction] = []  # the actions that have a goal
        for turtle in self._world.turtles.values():
            self._show(turtle, turtle.x, turtle.y)
        self.create_timer(TICK, self._on_tick)

    def _on_tick(self) -> None:
        for action in self._turning and list(self._turning):
            action.before_tick()
        hits = self._world.tick()
        if hits or self._pushing:
            self._report(hits)
        for action in self._turning and list(self._turning):
            action.after_tick()
        for shown in self._shown.values():
            shown.publish()

    def _report(self, hits: dict[str, tuple[float, float]]) -> None:
        """Warn of each turtle that has just come to a wall, or has pushed against it for another second."""
        self._pushing = {name: self._pushing.get(name, -1) + 1 for name in hits}
        for name, (x, flipped_y) in hits.items():
            if self._pushing[name] % TICKS_BETWEEN_WALL_WARNINGS == 0:
                self.get_logger().warning(f"Oh no! I hit the wall! (Clamping from [x={x:f}, y={flipped_y:f}])")

    def _on_spawn(self, request: Spawn.Request, response: Spawn.Response) -> Spawn.Response:
        turtle = attempt(self, self._world.spawn, request.x, request.y, request.theta, request.name)
        if turtle is not None:
            self._show(turtle, request.x, request.y)
            response.name = turtle.name
        return response

    def _on_kill(self, request: Kill.Request, response: Kill.Response) -> Kill.Response:
        turtle = attempt(self, self._world.kill, request.name)
        if turtle is not None:
            self._shown.pop(turtle.name).close()
        return response

    def _on_clear(self, _request: Empty.Request, response: Empty.Response) -> Empty.Response:
        self.get_logger().info("Clearing turtlesim.")
        self._world.cells.clear()
        return response

    def _on_reset(self, _request: Empty.Request, response: Empty.Response) -> Empty.Response:
        self.get_logger().info("Resetting turtlesim.")
        for shown in self._shown.values():
            shown.close()
        self._shown.clear()
        self._pushing.clear()
        turtle = self._world.reset()
        self._show(turtle, turtle.x, turtle.y)
        return response

    def _show(self, turtle: Turtle, x: float, y: float) -> None:
        """Give a turtle its topics and services; (x, y) is the place asked for, before y was flipped."""
        self._shown[turtle.name] = ShownTurtle(self, turtle, self._turning)
        theta = turtle.theta
        self.get_logger().info(f"Spawning turtle [{turtle.name}] at x=[{x:f}], y=[{y:f}], theta=[{theta:f}]")


def attempt(node: Node, ask: Callable[..., T], *arguments: Any) -> T | None:
    """What the world answers when it is asked for something; None, with an error in the log, if it cannot do it."""
    try:
        return ask(*arguments)
    except TurtleError as error:
        node.get_logger().error(str(error))
        return None


class ShownTurtle:
    """What ROS sees of one turtle: its topics, its services and its action."""

    def __init__(self, node: Node, turtle: Turtle, turning: list["RotateAction"]) -> None:
        self._node, self._turtle = node, turtle
        name = turtle.name
        self._subscription = node.create_subscription(Twist, f"{name}/cmd_vel", self._on_command, QUEUE_DEPTH)
        self._pose_publisher = node.create_publisher(Pose, f"{name}/pose", QUEUE_DEPTH)
        self._colour_publisher = node.create_publisher(Color, f"{name}/color_sensor", QUEUE_DEPTH)
        self._services = [
            node.create_service(SetPen, f"{name}/set_pen", self._on_set_pen),
            node.create_service(TeleportRelative, f"{name}/teleport_relative", self._on_teleport_relative),
            node.create_service(TeleportAbsolute, f"{name}/teleport_absolute", self._on_teleport_absolute),
        ]
        self._action = RotateAction(node, turtle, turning)
        # One message each, filled anew and published 62.5 times a second: publish() keeps no hold of it.
        self._pose, self._colour = Pose(), Color()
        self._publish_pose, self._publish_colour = self._pose_publisher.publish, self._colour_publisher.publish
        self._colour_in_message = (0, 0, 0)

    def publish(self) -> None:
        """Publish the pose and the colour after a tick."""
        turtle = self._turtle
        if not turtle.at_rest:  # at rest, the message from before says it all
            pose = self._pose
            pose.x = turtle.x
            pose.y = HEIGHT - turtle.flipped_y
            pose.theta = turtle.theta
            pose.linear_velocity = turtle.speed
            pose.angular_velocity = turtle.angular
        self._publish_pose(self._pose)
        if turtle.colour != self._colour_in_message:
            self._colour_in_message = turtle.colour
            self._colour.r, self._colour.g, self._colour.b = turtle.colour
        self._publish_colour(self._colour)

    def close(self) -> None:
        """Take the turtle's topics, services and action out of the graph."""
        self._action.close()
        self._node.destroy_subscription(self._subscription)
        self._node.destroy_publisher(self._pose_publisher)
        self._node.destroy_publisher(self._colour_publisher)
        for service in self._services:
            self._node.destroy_service(service)

    def _on_command(self, message: Twist) -> None:
        try:
            self._turtle.command(message.linear.x, message.linear.y, message.angular.z)
        except TurtleError as error:
            self._node.get_logger().error(str(error), throttle_duration_sec=1.0)

    def _on_set_pen(self, request: SetPen.Request, response: SetPen.Response) -> SetPen.Response:
        self._turtle.set_pen((request.r, request.g, request.b), off=bool(request.off))
        return response

    def _on_teleport_relative(
        self, request: TeleportRelative.Request, response: TeleportRelative.Response
    ) -> TeleportRelative.Response:
        attempt(self._node, self._turtle.teleport_relative, request.linear, request.angular)
        return response

    def _on_teleport_absolute(
        self, request: TeleportAbsolute.Request, response: TeleportAbsolute.Response
    ) -> TeleportAbsolute.Response:
        attempt(self._node, self._turtle.teleport_absolute, request.x, request.y, request.theta)
        return response


class RotateAction:
    """The action ``rotate_absolute`` of one turtle: it turns to a heading, with feedback at every tick.

    As in the real turtlesim every goal is accepted, and so is every wish to cancel; a new goal aborts the one before.
    ``turning`` holds the action while it has a goal; its node calls it at every tick.
    """

    def __init__(self, node: Node, turtle: Turtle, turning: list["RotateAction"]) -> None:
        self._node, self._turtle, self._turning = node, turtle, turning
        self._goal: Any = None
        self._rotation: Rotation
        self._results: dict[bytes, Future] = {}
        self._server = ActionServer(
            node,
            RotateAbsolute,
            f"{turtle.name}/rotate_absolute",
            self._execute,
            goal_callback=self._on_goal,
            handle_accepted_callback=self._on_accepted,
            cancel_callback=lambda _goal: CancelResponse.ACCEPT,
        )

    def close(self) -> None:
        """Take the action out of the graph."""
        self._server.destroy()
        if self in self._turning:
            self._turning.remove(self)

    def before_tick(self) -> None:
        """Stop turning if that is asked for."""
        if self._goal.is_cancel_requested:
            self._node.get_logger().info("Rotation goal canceled")
            self._turtle.stop_rotating()
            self._goal.canceled()
            self._finish()

    def after_tick(self) -> None:
        """Tell how much is left; end the goal if it is reached."""
        self._goal.publish_feedback(RotateAbsolute.Feedback(remaining=float32(self._rotation.remaining)))
        if self._rotation.reached:
            self._node.get_logger().info("Rotation goal completed successfully")
            self._goal.succeed()
            self._finish()

    def _on_goal(self, goal: RotateAbsolute.Goal) -> GoalResponse:
        if abs(goal.theta) <= LARGEST:
            return GoalResponse.ACCEPT
        self._node.get_logger().error(
            f"Turtle [{self._turtle.name}] cannot rotate to theta={goal.theta}: it must be a finite number"
        )
        return GoalResponse.REJECT

    def _on_accepted(self, goal: Any) -> None:
        if self._goal is not None:
            self._node.get_logger().warning(
                "Rotation goal received before a previous goal finished. Aborting previous goal"
            )
            self._goal.abort()
            self._finish()
        self._goal = goal
        self._results[_key(goal)] = Future()
        self._rotation = self._turtle.rotate_to(goal.request.theta)
        self._turning.append(self)
        goal.execute()

    async def _execute(self, goal: Any) -> RotateAbsolute.Result:
        """Wait for the goal's end, which a tick brings about."""
        result = await self._results[_key(goal)]
        del self._results[_key(goal)]
        return result

    def _finish(self) -> None:
        goal, self._goal = self._goal, None
        self._turning.remove(self)
        self._results[_key(goal)].set_result(RotateAbsolute.Result(delta=float32(self._rotation.delta)))


def _key(goal: Any) -> bytes:
    return bytes(goal.goal_id.uuid)


main = partial(spin, TurtlesimNode)
