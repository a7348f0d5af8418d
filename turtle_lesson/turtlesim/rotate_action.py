"""The action ``<turtle>/rotate_absolute``: turns a turtle to a heading, with feedback at every tick.

Plain ``rclpy``. As in the real turtlesim every goal is accepted, and so is every wish to cancel; a new goal aborts
the one before. Where it differs: a heading that is NaN or infinite, with which the real turtle would turn forever,
is rejected.
"""

from typing import Any

from rclpy.action import ActionServer, CancelResponse, GoalResponse
from rclpy.node import Node
from rclpy.task import Future
from turtlesim.action import RotateAbsolute

from turtle_lesson.turtlesim.turtle import LARGEST, Rotation, Turtle, float32


class RotateAction:
    """The action of one turtle. ``turning`` holds it while it has a goal; its node calls it at every tick."""

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
