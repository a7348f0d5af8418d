"""Actions and executors: what runs beside what, blocking calls, and waits that could never end."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable
from typing import Any

import pytest
import rclpy
from action_msgs.msg import GoalStatus
from example_interfaces.action import Fibonacci
from fibonacci_action import Goal, Result, Run, count_up, outcome, send, server, serving, start, wait
from rclpy.action import ActionClient, ActionServer, CancelResponse, GoalResponse
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor, SingleThreadedExecutor
from rclpy.node import Node
from rclpy.task import Future
from turtlesim.action import RotateAbsolute

from turtle_lesson.lab.timeline import plot_timeline
from turtle_lesson.ros.runtime.world import World
from turtle_lesson.ros.sim.errors import NeverWakes

SECOND = 1_000_000_000


def ticks_beside(execute: Callable[[Any], Any], executor: Any, group: Any = None) -> Callable[[list[Any]], None]:
    """A server that also has a timer of 0.5 s in the default group."""

    def program(found: list[Any]) -> None:
        rclpy.init()
        node = rclpy.create_node("server")
        ActionServer(node, Fibonacci, "fibonacci", execute, callback_group=group and group())
        began = time.time()
        node.create_timer(0.5, lambda: found.append(round(time.time() - began, 1)))
        rclpy.spin(node, executor())

    return program


def one_goal(found: list[Any]) -> None:
    node, client = start()
    outcome(node, send(node, client, 2))


# ---------------------------------------------------------------- what runs beside what


def test_in_one_thread_an_execute_callback_holds_up_all_else(run: Run) -> None:
    assert run(ticks_beside(count_up, SingleThreadedExecutor), one_goal, seconds=3.6) == [2.0, 2.5, 3.0, 3.5]


def test_with_several_threads_it_holds_up_nothing_whatever_the_groups(run: Run) -> None:
    """For it belongs to none: the timer is in the very group in which goals are taken."""
    expected = [0.5, 1.0, 1.5, 2.0, 2.5]
    assert run(ticks_beside(count_up, MultiThreadedExecutor), one_goal, seconds=2.8) == expected


def test_goals_are_taken_in_their_group(run: Run) -> None:
    """So a callback of the same group that takes its time delays them, and another one does not."""

    def program(group: Any) -> Callable[[list[Any]], None]:
        def server(found: list[Any]) -> None:
            rclpy.init()
            node = rclpy.create_node("server")
            ActionServer(node, Fibonacci, "fibonacci", count_up, callback_group=group and group())
            timer = node.create_timer(0.1, lambda: (timer.cancel(), time.sleep(3.0)))
            rclpy.spin(node, MultiThreadedExecutor())

        return server

    def client(found: list[Any]) -> None:
        node, action = start()
        wait(node, Future(), 0.5)
        began = time.time()
        send(node, action, 1)
        found.append(round(time.time() - began, 1))

    assert run(program(None), client) == [2.6]
    assert run(program(MutuallyExclusiveCallbackGroup), client) == [0.0]


def test_in_one_thread_a_wish_to_cancel_waits_until_the_goal_is_reached(run: Run) -> None:
    def program(found: list[Any]) -> None:
        node, client = start()
        goal = send(node, client, 3)
        answer = wait(node, goal.cancel_goal_async())
        found += [answer.return_code, outcome(node, goal)[0]]

    cancelling = serving(cancel_callback=lambda goal_handle: CancelResponse.ACCEPT)
    assert run(cancelling, program) == [3, GoalStatus.STATUS_SUCCEEDED]  # ERROR_GOAL_TERMINATED


def test_a_server_keeps_its_group_while_an_async_callback_decides(run: Run) -> None:
    """But not while a goal is being reached."""
    decisions: list[Future] = []

    async def decide(goal: Any) -> Any:
        decisions.append(Future())
        return await decisions[-1]

    def program(found: list[Any]) -> None:
        node, client = start()
        futures = [client.send_goal_async(Goal(order=number)) for number in (1, 2)]
        wait(node, Future(), 0.5)
        found.append(len(decisions))
        for future in futures:
            decisions[-1].set_result(GoalResponse.ACCEPT)
            found.append(wait(node, future).accepted)
            wait(node, Future(), 0.5)
        found.append(len(decisions))

    def serve(found: list[Any]) -> None:
        rclpy.init()
        node = rclpy.create_node("server")
        ActionServer(node, Fibonacci, "fibonacci", lambda goal: goal.succeed() or Result(), goal_callback=decide)
        node.create_timer(0.01, lambda: None)
        rclpy.spin(node, MultiThreadedExecutor())

    assert run(serve, program) == [1, True, True, 2]


def test_a_busy_client_loses_feedback_when_the_result_is_there(run: Run) -> None:
    """The result's callbacks run before the next feedback is taken, as in rclpy: who has the result wants no more of it."""

    def execute(goal_handle: Any) -> Any:
        for number in range(4):
            goal_handle.publish_feedback(Fibonacci.Feedback(sequence=[number]))
        goal_handle.succeed()
        return Result(sequence=[9])

    def program(found: list[Any]) -> None:
        node, client = start()
        future = client.send_goal_async(Goal(), lambda message: found.append(list(message.feedback.sequence)))
        goal = wait(node, future)
        result = goal.get_result_async()
        time.sleep(0.5)  # meanwhile everything arrives
        found.append(list(wait(node, result).result.sequence))

    assert run(serving(execute), program) == [[0], [9]]


# ---------------------------------------------------------------- waiting for a server


def test_a_server_is_waited_for_in_quarters_of_a_second(run: Run) -> None:
    def program(found: list[Any]) -> None:
        rclpy.init()
        client = ActionClient(rclpy.create_node("client"), Fibonacci, "fibonacci")
        for timeout in (0.0, 0.1, 0.5):
            began = time.time()
            found.append((client.wait_for_server(timeout_sec=timeout), f"{time.time() - began:.2f}"))

    assert run(program) == [(False, "0.00"), (False, "0.25"), (False, "0.50")]


def test_a_server_that_comes_late_is_waited_for(run: Run) -> None:
    def late(found: list[Any]) -> None:
        time.sleep(1.1)
        server(found)

    def program(found: list[Any]) -> None:
        rclpy.init()
        client = ActionClient(rclpy.create_node("client"), Fibonacci, "fibonacci")
        found += [client.server_is_ready(), client.wait_for_server(float("inf")), f"{time.time() - 1_800_000_000:.2f}"]

    assert run(late, program) == [False, True, "1.25"]


def test_a_goal_without_a_server_is_never_answered(run: Run) -> None:
    def program(found: list[Any]) -> None:
        rclpy.init()
        node = rclpy.create_node("client")
        future = ActionClient(node, Fibonacci, "fibonacci").send_goal_async(Goal())
        found += [wait(node, future, 1.0), future.done()]

    assert run(program) == [None, False]


# ---------------------------------------------------------------- blocking calls


def in_a_callback(call: Callable[[Any, Any], Any], executor: Any, group: Any = None) -> Callable[[list[Any]], None]:
    """A client that calls `call(client, node)` in a timer's callback, and keeps what comes of it."""

    def program(found: list[Any]) -> None:
        rclpy.init()
        node = rclpy.create_node("client")
        client = ActionClient(node, Fibonacci, "fibonacci", callback_group=group and group())

        def tick() -> None:
            timer.cancel()
            try:
                found.append(call(client, node))
            except NeverWakes as error:
                found.append(str(error))

        timer = node.create_timer(0.5, tick)
        rclpy.spin(node, executor())

    return program


def send_and_wait(client: Any, node: Any) -> Any:
    answer = client.send_goal(Goal(order=1))
    return answer.status, list(answer.result.sequence)


AWAIT = (
    "Make the callback `async def` and write `await action_client.send_goal_async(goal)`, with the action client in a "
    "callback group of its own; or spin with a MultiThreadedExecutor, the action client in a different callback group from "
    "this callback."
)


def test_send_goal_waits_in_a_callback_if_another_thread_takes_the_answers(run: Run) -> None:
    for group in (ReentrantCallbackGroup, MutuallyExclusiveCallbackGroup):
        assert run(server, in_a_callback(send_and_wait, MultiThreadedExecutor, group)) == [(4, [0])]


def test_send_goal_in_the_group_of_its_client(run: Run) -> None:
    for executor in (SingleThreadedExecutor, MultiThreadedExecutor):
        assert run(server, in_a_callback(send_and_wait, executor)) == [
            "this send_goal of /fibonacci can never be answered: this callback waits for it and so keeps its callback "
            f"group, and the action client that would take the answer is in the same group. {AWAIT}"
        ]


def test_send_goal_in_the_only_thread(run: Run) -> None:
    assert run(server, in_a_callback(send_and_wait, SingleThreadedExecutor, ReentrantCallbackGroup)) == [
        "this send_goal of /fibonacci can never be answered: the thread that would take the answer is the one that waits "
        f"here. {AWAIT}"
    ]


def test_spinning_in_a_callback_for_the_answer(run: Run) -> None:
    (text,) = run(server, in_a_callback(lambda client, node: send(node, client), SingleThreadedExecutor))
    assert text.startswith(
        "this callback spins until /fibonacci/_action/send_goal has answered, which can never happen"
    )
    assert "await action_client.send_goal_async(goal), with the action client in a callback group of its own" in text


def test_awaiting_in_the_group_of_the_client(run: Run) -> None:
    def program(found: list[Any]) -> None:
        rclpy.init()
        node = rclpy.create_node("client")
        client = ActionClient(node, Fibonacci, "fibonacci")

        async def tick() -> None:
            timer.cancel()
            try:
                await client.send_goal_async(Goal())
            except NeverWakes as error:
                found.append(str(error))

        timer = node.create_timer(0.5, tick)
        rclpy.spin(node)

    (text,) = run(server, program)
    assert text.endswith("own: ActionClient(…, callback_group=MutuallyExclusiveCallbackGroup())")


def test_a_coroutine_awaits_goal_and_result_with_the_client_in_another_group(run: Run) -> None:
    def program(found: list[Any]) -> None:
        rclpy.init()
        node = rclpy.create_node("client")
        client = ActionClient(node, Fibonacci, "fibonacci", callback_group=MutuallyExclusiveCallbackGroup())

        async def tick() -> None:
            timer.cancel()
            goal = await client.send_goal_async(Goal(order=1))
            found.append((await goal.get_result_async()).status)

        timer = node.create_timer(0.5, tick)
        rclpy.spin(node)

    assert run(server, program) == [4]


def test_send_goal_when_nobody_spins(run: Run) -> None:
    def program(found: list[Any]) -> None:
        _, client = start()
        with pytest.raises(NeverWakes) as caught:
            client.send_goal(Goal())
        found.append(str(caught.value))

    assert run(server, program) == [
        "this send_goal of /fibonacci can never be answered: no executor spins <Node /client> meanwhile, so nothing takes the "
        "answer. Write instead: future = action_client.send_goal_async(goal), then "
        "rclpy.spin_until_future_complete(node, future)."
    ]


def test_the_other_blocking_calls_say_the_like(run: Run) -> None:
    def program(found: list[Any]) -> None:
        node, client = start()
        goal = send(node, client)
        for call in (goal.get_result, goal.cancel_goal):
            with pytest.raises(NeverWakes) as caught:
                call()
            found.append(str(caught.value).partition(":")[0])
            assert "future = goal_handle." in str(caught.value)

    assert run(server, program) == [
        "this get_result of /fibonacci can never be answered",
        "this cancel_goal of /fibonacci can never be answered",
    ]


def test_send_goal_to_a_server_in_the_same_callback_group(run: Run) -> None:
    def program(found: list[Any]) -> None:
        rclpy.init()
        node = rclpy.create_node("both")
        ActionServer(node, Fibonacci, "fibonacci", count_up)
        client = ActionClient(node, Fibonacci, "fibonacci", callback_group=ReentrantCallbackGroup())

        def tick() -> None:
            timer.cancel()
            try:
                client.send_goal(Goal())
            except NeverWakes as error:
                found.append(str(error))

        timer = node.create_timer(0.5, tick)
        rclpy.spin(node, MultiThreadedExecutor())

    (text,) = run(program)
    assert "the action server is offered by this same process" in text
    assert "Give the action server a callback group of its own" in text


@pytest.mark.parametrize(
    ("kind", "name", "text"),
    [
        (
            Fibonacci,
            "fibonaci",
            "no node offers this action (example_interfaces/action/Fibonacci); did you mean '/fibonacci'?",
        ),
        (
            RotateAbsolute,
            "fibonacci",
            "the action of this name is of type example_interfaces/action/Fibonacci, not turtlesim/",
        ),
    ],
)
def test_send_goal_to_nobody(run: Run, kind: Any, name: str, text: str) -> None:
    def program(found: list[Any]) -> None:
        rclpy.init()
        time.sleep(0.1)
        client = ActionClient(rclpy.create_node("client"), kind, name)
        with pytest.raises(NeverWakes) as caught:
            client.send_goal(kind.Goal())
        found.append(str(caught.value))

    (found,) = run(server, program)
    assert text in found


# ---------------------------------------------------------------- in a notebook's cell


@pytest.fixture
def node(world: World) -> Node:
    """A node of a notebook, in a world with a server."""
    world.spawn(lambda: server([]), name="server")
    rclpy.init()
    return rclpy.create_node("cell")


def test_in_a_cell_blocking_calls_run_the_simulation(world: World, node: Node) -> None:
    client = ActionClient(node, Fibonacci, "fibonacci")
    assert client.wait_for_server()
    heard: list[Any] = []
    began = world.now
    answer = client.send_goal(
        Goal(order=3), feedback_callback=lambda message: heard.append(len(message.feedback.sequence))
    )
    assert (answer.status, list(answer.result.sequence), heard) == (4, [0, 1, 2], [1, 2, 3])
    assert world.now - began == pytest.approx(3.0 * SECOND, rel=0.001)


def test_in_a_cell_goal_handles_wait_as_well(world: World, node: Node) -> None:
    client = ActionClient(node, Fibonacci, "fibonacci")
    client.wait_for_server()
    future = client.send_goal_async(Goal(order=2))
    rclpy.spin_until_future_complete(node, future)
    goal = future.result()
    assert goal.cancel_goal().goals_canceling == []
    assert goal.get_result().status == 4


def test_in_a_cell_a_server_and_its_client(world: World) -> None:
    rclpy.init()
    one, other = rclpy.create_node("one"), rclpy.create_node("other")
    ActionServer(one, Fibonacci, "fibonacci", lambda goal_handle: goal_handle.succeed() or Result(sequence=[1]))
    client = ActionClient(other, Fibonacci, "fibonacci")
    executor = SingleThreadedExecutor()
    executor.add_node(one)
    with pytest.raises(NeverWakes, match="the action server's node is in this notebook, too, and no executor spins it"):
        client.send_goal(Goal())
    executor.add_node(other)
    assert list(client.send_goal(Goal()).result.sequence) == [1]


# ---------------------------------------------------------------- in a timeline


def test_a_timeline_shows_execute_callbacks(world: World) -> None:
    world.keep_trace()

    def program() -> None:
        node, client = start()
        outcome(node, send(node, client, 2))

    world.spawn(lambda: server([]), name="server")
    world.spawn(program, name="client")
    world.sim.run_until(4 * SECOND)
    rclpy.init()
    node = rclpy.create_node("looker")
    picture = plot_timeline(world.trace, node)
    assert repr(picture) == (
        "Timeline from 0.00 s to 4.00 s of robot time. /server.count_up (/fibonacci): 1 call; it lasted 2.00 s."
    )
    picture = plot_timeline(world.trace, node, "/fibonacci/_action/feedback")
    assert "/fibonacci/_action/feedback: 2 messages" in repr(picture)
    with pytest.raises(ValueError, match=r"and the topics none\.|nor a node") as caught:
        plot_timeline(world.trace, node, "/nope")
    assert "_action" not in str(caught.value)


# ---------------------------------------------------------------- in asyncio's loop


def test_a_future_is_awaited_in_a_loop_of_asyncio_and_can_be_given_up(run: Run) -> None:
    async def steps(node: Node, client: ActionClient, found: list[Any]) -> None:
        async def spin() -> None:
            while True:
                rclpy.spin_once(node, timeout_sec=0.01)
                await asyncio.sleep(0.001)

        spinning = asyncio.get_running_loop().create_task(spin())
        goal = await client.send_goal_async(Goal(order=2))
        future = goal.get_result_async()
        with pytest.raises(asyncio.TimeoutError):
            await asyncio.wait_for(future, 0.5)
        found.append((future.cancelled(), (await future).status, future.done()))
        spinning.cancel()

    def program(found: list[Any]) -> None:
        node, client = start()
        asyncio.run(steps(node, client, found))

    assert run(server, program) == [(False, 4, True)]


def test_in_a_cells_own_loop_it_is_explained() -> None:
    async def cell() -> None:
        await Future()

    with pytest.raises(RuntimeError, match="cannot be awaited in a cell: no robot time would pass meanwhile"):
        asyncio.run(cell())
