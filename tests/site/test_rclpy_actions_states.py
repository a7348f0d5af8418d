"""The life of a goal, whatever is asked of it in whatever order, against a model written from the design article.

https://design.ros2.org/articles/actions.html has the states and the transitions between them.
"""

from __future__ import annotations

from typing import Any

import rclpy
from action_msgs.msg import GoalStatus
from example_interfaces.action import Fibonacci
from fibonacci_action import Feedback, Goal, Result, outcome, send, wait
from hypothesis import given
from hypothesis import strategies as st
from rclpy.action import ActionClient, ActionServer, CancelResponse
from rclpy.exceptions import RCLError
from rclpy.task import Future
from unique_identifier_msgs.msg import UUID

from turtle_lesson.ros.runtime.world import World, open_world

ACCEPTED, EXECUTING, CANCELING = 1, 2, 3
STEPS = {
    "execute": {ACCEPTED: EXECUTING},
    "cancel": {ACCEPTED: CANCELING, EXECUTING: CANCELING},
    "succeed": {EXECUTING: 4, CANCELING: 4},
    "canceled": {CANCELING: 5},
    "abort": {EXECUTING: 6, CANCELING: 6},
}
MORE = ("feedback", "look")


def live(program: Any) -> Any:
    """Run a program in a world of its own, and return what it returns."""
    found: list[Any] = []
    world: World = open_world()
    process = world.spawn(lambda: found.append(program()), name="program")
    world.sim.run_until(60_000_000_000)
    world.close()
    assert process.error is None, process.error
    return found[0]


@given(st.lists(st.sampled_from([*STEPS, *MORE]), max_size=10))
def test_a_goal_is_always_in_the_state_of_the_model(steps: list[str]) -> None:
    def program() -> None:
        rclpy.init()
        node = rclpy.create_node("both")
        handles: list[Any] = []
        heard: list[int] = []
        ActionServer(
            node,
            Fibonacci,
            "fibonacci",
            lambda goal_handle: Result(),
            handle_accepted_callback=handles.append,
            cancel_callback=lambda goal_handle: CancelResponse.ACCEPT,
        )
        client = ActionClient(node, Fibonacci, "fibonacci")
        goal = send(node, client, feedback_callback=lambda message: heard.append(len(message.feedback.sequence)))
        (handle,), state, published = handles, ACCEPTED, []
        executor = rclpy.get_global_executor()
        executor.add_node(node)
        handle._action_server.notify_execute = lambda *_: None  # only the states are looked at here
        for number, step in enumerate(steps):
            if step == "feedback":
                handle.publish_feedback(Feedback(sequence=range(number)))
                published.append(number)
            elif step == "cancel":
                canceling = wait(node, goal.cancel_goal_async()).goals_canceling
                assert bool(canceling) == (state in STEPS[step])
                state = STEPS[step].get(state, state)
            elif step in STEPS:
                state = take(handle, step, state)
            wait(node, Future(), 0.01)
            assert (handle.status, goal.status) == (state, state)
            assert handle.is_active == (state in (ACCEPTED, EXECUTING, CANCELING))
            assert handle.is_cancel_requested == (state == CANCELING)
        assert heard == published

    live(program)


def take(handle: Any, step: str, state: int) -> int:
    """Take a step with a goal; returns the state that follows, which is the old one if the step is not allowed."""
    allowed = state in STEPS[step] or (step == "execute" and state == CANCELING)
    try:
        getattr(handle, step)()
    except RCLError:
        assert not allowed
    else:
        assert allowed
    return STEPS[step].get(state, state)


@given(
    st.lists(
        st.tuples(st.integers(0, 3), st.sampled_from(["succeed", "abort", "nothing", "raise"]), st.booleans()),
        min_size=1,
        max_size=6,
    )
)
def test_every_goal_gets_its_own_result(goals: list[tuple[int, str, bool]]) -> None:
    """Whatever their ends are, in whatever order they come, and whether the result is asked for before or after."""

    def execute(goal_handle: Any) -> Any:
        number = goal_handle.request.order
        order, end, _ = goals[number]
        if end == "raise":
            raise ValueError(f"goal {number}")
        if end != "nothing":
            getattr(goal_handle, end)()
        return Result(sequence=[number] * order)

    def program() -> list[Any]:
        rclpy.init()
        node = rclpy.create_node("both")
        ActionServer(node, Fibonacci, "fibonacci", execute)
        client = ActionClient(node, Fibonacci, "fibonacci")
        futures = [client.send_goal_async(Goal(order=number)) for number in range(len(goals))]
        handles = [wait(node, future) for future in futures]
        early = {number: handles[number].get_result_async() for number, goal in enumerate(goals) if goal[2]}
        wait(node, Future(), 1.0)
        answers = []
        for number, handle in enumerate(handles):
            if number in early:
                answer = early[number].result()
                answers.append((answer.status, list(answer.result.sequence)))
            else:
                answers.append(outcome(node, handle))
        return answers

    expected = [
        (
            GoalStatus.STATUS_SUCCEEDED if end == "succeed" else GoalStatus.STATUS_ABORTED,
            [] if end == "raise" else [number] * order,
        )
        for number, (order, end, _) in enumerate(goals)
    ]
    assert live(program) == expected


@given(st.binary(min_size=16, max_size=16))
def test_any_number_is_a_goals_number(number: bytes) -> None:
    def program() -> Any:
        rclpy.init()
        node = rclpy.create_node("both")
        ActionServer(node, Fibonacci, "fibonacci", lambda goal_handle: goal_handle.succeed() or Result())
        client = ActionClient(node, Fibonacci, "fibonacci")
        goal = send(node, client, goal_uuid=UUID(uuid=list(number)))
        return bytes(goal.goal_id.uuid), outcome(node, goal)[0]

    assert live(program) == (number, 4)
