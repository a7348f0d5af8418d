"""Actions as programs use them: goals, feedback, results, cancelling, and what is behind them."""

from __future__ import annotations

import inspect
import random
import re
import time
from collections.abc import Callable
from typing import Any

import pytest
import rclpy
from action_msgs.msg import GoalInfo, GoalStatus, GoalStatusArray
from action_msgs.srv import CancelGoal
from builtin_interfaces.msg import Time
from example_interfaces.action import Fibonacci
from example_interfaces.msg import Int32
from example_interfaces.srv import AddTwoInts
from fibonacci_action import (
    Feedback,
    GetResult,
    Goal,
    Result,
    Run,
    SendGoal,
    count_up,
    outcome,
    send,
    server,
    serving,
    start,
    wait,
)
from rclpy.action import ActionClient, ActionServer, CancelResponse, GoalResponse
from rclpy.action import graph as action_graph
from rclpy.action.client import ClientGoalHandle
from rclpy.action.server import (
    GoalEvent,
    ServerGoalHandle,
    default_cancel_callback,
    default_goal_callback,
    default_handle_accepted_callback,
)
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor
from rclpy.qos import DurabilityPolicy, QoSProfile
from rclpy.task import Future
from unique_identifier_msgs.msg import UUID

from turtle_lesson.ros.runtime.world import World, open_world

ONE, TWO = UUID(uuid=[1] * 16), UUID(uuid=[2] * 16)
SECOND = 1_000_000_000


def accept(_: Any) -> CancelResponse:
    return CancelResponse.ACCEPT


def at_once(goal_handle: Any) -> Any:
    goal_handle.succeed()
    return Result(sequence=[goal_handle.request.order])


# ---------------------------------------------------------------- a goal


def test_a_goal_is_accepted_reached_and_its_result_fetched(run: Run) -> None:
    def program(found: list[Any]) -> None:
        node, client = start()
        goal = send(node, client, 3)
        found += [type(goal) is ClientGoalHandle, goal.accepted, goal.stamp.sec]
        found += [outcome(node, goal), goal.status]

    assert run(server, program) == [True, True, 1_800_000_000, (GoalStatus.STATUS_SUCCEEDED, [0, 1, 2]), 4]


def test_feedback_comes_as_it_is_published(run: Run) -> None:
    def program(found: list[Any]) -> None:
        node, client = start()
        began = time.time()

        def hear(message: Any) -> None:
            found.append((message.goal_id == goal_id, list(message.feedback.sequence), f"{time.time() - began:.0f} s"))

        goal_id = ONE
        goal = send(node, client, 2, feedback_callback=hear, goal_uuid=ONE)
        outcome(node, goal)

    assert run(server, program) == [(True, [0], "0 s"), (True, [0, 1], "1 s")]


def test_the_last_feedback_is_not_overtaken_by_the_result(run: Run) -> None:
    def execute(goal_handle: Any) -> Any:
        goal_handle.publish_feedback(Feedback(sequence=[7]))
        goal_handle.succeed()
        return Result()

    def program(found: list[Any]) -> None:
        node, client = start()
        goal = send(node, client, feedback_callback=lambda message: found.append(list(message.feedback.sequence)))
        found.append(outcome(node, goal))

    assert run(serving(execute), program) == [[7], (4, [])]


def test_only_the_own_goals_feedback_comes(run: Run) -> None:
    def program(found: list[Any]) -> None:
        node, client = start()
        futures = [client.send_goal_async(Goal(order=1), lambda message: found.append(message.goal_id), ONE)]
        futures.append(client.send_goal_async(Goal(order=1), goal_uuid=TWO))
        for future in futures:
            outcome(node, wait(node, future))

    assert run(server, program) == [ONE]


def test_a_rejected_goal(run: Run) -> None:
    def program(found: list[Any]) -> None:
        node, client = start()
        goal = send(node, client, feedback_callback=print)
        found += [goal.accepted, outcome(node, goal), repr(goal).endswith("accepted=False, status=0>")]

    refusing = serving(goal_callback=lambda goal: GoalResponse.REJECT)
    assert run(refusing, program) == [False, (GoalStatus.STATUS_UNKNOWN, []), True]


def test_the_goal_callback_sees_the_goal_and_must_answer(run: Run, capfd: pytest.CaptureFixture[str]) -> None:
    seen: list[Any] = []

    def program(found: list[Any]) -> None:
        node, client = start()
        found.append(send(node, client, 5).accepted)

    assert run(serving(goal_callback=seen.append), program) == [False]
    assert seen == [Goal(order=5)]
    text = "Goal request callback did not return a GoalResponse type. Rejecting goal."
    assert text in capfd.readouterr().err


def test_two_goals_of_one_number_are_one(run: Run) -> None:
    def program(found: list[Any]) -> None:
        node, client = start()
        futures = [client.send_goal_async(Goal(), goal_uuid=ONE) for _ in range(2)]
        found += [wait(node, future).accepted for future in futures]

    assert run(server, program) == [True, False]


def test_numbers_of_goals_look_random_and_are_the_same_in_every_run() -> None:
    def numbers() -> tuple[list[str], float]:
        def program() -> None:
            rclpy.init()
            client = ActionClient(rclpy.create_node("client"), Fibonacci, "fibonacci")
            client.send_goal_async(Goal())
            found.extend(bytes(goal_id.uuid).hex() for goal_id in client._goal_ids.values())
            found.append(random.random())

        found: list[Any] = []
        world = open_world(seed=3)
        world.spawn(program, name="program")
        world.sim.run_until(SECOND)
        world.close()
        return found[:-1], found[-1]

    (first, drawn), (second, drawn_again) = numbers(), numbers()
    assert first == second and drawn == drawn_again
    assert re.fullmatch("[0-9a-f]{12}4[0-9a-f]{3}[89ab][0-9a-f]{15}", first[0])

    def without() -> None:
        drawn_without.append(random.random())

    drawn_without: list[float] = []
    world = open_world(seed=3)
    world.spawn(without, name="program")
    world.sim.run_until(SECOND)
    world.close()
    assert drawn_without == [drawn]  # a goal's number takes none of the program's own


# ---------------------------------------------------------------- ends


def failing(_: Any) -> Any:
    raise ValueError("boom")


def test_a_callback_that_raises_aborts_its_goal(run: Run, capfd: pytest.CaptureFixture[str]) -> None:
    def program(found: list[Any]) -> None:
        node, client = start()
        found += [outcome(node, send(node, client)), outcome(node, send(node, client))]

    assert run(serving(failing), program) == [(GoalStatus.STATUS_ABORTED, [])] * 2  # and the server goes on
    err = capfd.readouterr().err
    assert "[ERROR]" in err and "[server]: Error raised in execute callback: boom\n" in err
    assert re.search(r"Traceback.*\n.*test_rclpy_actions.py\", line \d+, in failing\n.*\nValueError: boom\n", err)
    assert "Goal state not set, assuming aborted. Goal ID: [" in err


def test_a_callback_that_ends_nothing_aborts_its_goal(run: Run, capfd: pytest.CaptureFixture[str]) -> None:
    def program(found: list[Any]) -> None:
        node, client = start()
        found.append(outcome(node, send(node, client, goal_uuid=ONE)))

    assert run(serving(lambda goal_handle: Result(sequence=[8])), program) == [(GoalStatus.STATUS_ABORTED, [8])]
    text = "[server]: Goal state not set, assuming aborted. Goal ID: [1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1]"
    assert text in capfd.readouterr().err


def test_abort_gives_up(run: Run, capfd: pytest.CaptureFixture[str]) -> None:
    def execute(goal_handle: Any) -> Any:
        goal_handle.abort()
        return Result(sequence=[1])

    def program(found: list[Any]) -> None:
        node, client = start()
        found.append(outcome(node, send(node, client)))

    assert run(serving(execute), program) == [(GoalStatus.STATUS_ABORTED, [1])]
    assert capfd.readouterr().err == ""


def test_a_callback_that_returns_no_result_ends_the_server_and_is_told_why(world: World) -> None:
    def execute(goal_handle: Any) -> None:
        goal_handle.succeed()

    def program() -> None:
        node, client = start()
        wait(node, send(node, client).get_result_async(), 1.0)

    process = world.spawn(lambda: serving(execute)([]), name="server")
    world.spawn(program, name="client")
    world.sim.run_until(3 * SECOND)
    assert isinstance(process.error, AssertionError)  # as it is on a robot
    assert str(process.error).startswith("The 'result' field must be a sub message of type 'Fibonacci_Result'")
    assert process.error.__notes__[-1] == (
        "The execute callback of /fibonacci returned None, where a Fibonacci.Result is expected: end it with "
        "`return Fibonacci.Result(…)`, on every way out."
    )


@pytest.mark.parametrize(
    ("misdeed", "state", "event", "advice"),
    [
        ("canceled", "EXECUTING", "CANCELED", "canceled() ends one whose goal_handle.is_cancel_requested is true"),
        ("execute", "EXECUTING", "EXECUTE", "execute() begins a goal, once"),
        ("succeed twice", "SUCCEEDED", "SUCCEED", "End a goal once, and return the result right after."),
        ("abort after it", "SUCCEEDED", "ABORT", "This goal has already ended (SUCCEEDED)"),
    ],
)
def test_a_step_that_is_not_allowed_says_what_to_do(
    run: Run, misdeed: str, state: str, event: str, advice: str
) -> None:
    def execute(goal_handle: Any) -> Any:
        if misdeed in ("succeed twice", "abort after it"):
            goal_handle.succeed()
        with pytest.raises(rclpy.action.server.RCLError) as caught:
            getattr(goal_handle, misdeed.split()[0])()
        errors.append(caught.value)
        return Result()

    def program(found: list[Any]) -> None:
        node, client = start()
        outcome(node, send(node, client))

    errors: list[Any] = []
    run(serving(execute), program)
    assert str(errors[0]) == (
        f"Failed to update goal state: goal_handle attempted invalid transition from state {state} with event {event}"
    )
    assert advice in errors[0].__notes__[0]


def test_a_goal_that_is_not_begun_cannot_be_reached(run: Run) -> None:
    def accepted(goal_handle: Any) -> None:
        with pytest.raises(RuntimeError) as caught:
            goal_handle.succeed()
        notes.extend(caught.value.__notes__)

    def program(found: list[Any]) -> None:
        node, client = start()
        found.append(send(node, client).accepted)

    notes: list[str] = []
    assert run(serving(handle_accepted_callback=accepted), program) == [True]
    assert "succeed() and abort() end a goal that has begun" in notes[0]


# ---------------------------------------------------------------- the server's goal handle


def test_what_a_goal_handle_of_the_server_tells(run: Run) -> None:
    def execute(goal_handle: Any) -> Any:
        looks.append((goal_handle.status, goal_handle.is_active, goal_handle.is_cancel_requested))
        looks.append((goal_handle.request, goal_handle.goal_id, goal_handle == goal_handle, goal_handle != ONE))
        with pytest.raises(TypeError) as caught:
            goal_handle.publish_feedback(Result())
        looks.append(str(caught.value))
        goal_handle.succeed()
        looks.append((goal_handle.status, goal_handle.is_active, repr(goal_handle)))
        goal_handle.destroy()
        looks.append((goal_handle.status, goal_handle.is_active))
        goal_handle.abort()  # of no effect any more
        goal_handle.publish_feedback(Feedback())
        return Result()

    def program(found: list[Any]) -> None:
        node, client = start()
        outcome(node, send(node, client, 2, goal_uuid=ONE))

    looks: list[Any] = []
    run(serving(execute), program)
    assert looks == [
        (GoalStatus.STATUS_EXECUTING, True, False),
        (Goal(order=2), ONE, True, True),
        "feedback is of type Fibonacci.Feedback, got example_interfaces.action.Fibonacci_Result(sequence=[]): try "
        "Fibonacci.Feedback(…)",
        (GoalStatus.STATUS_SUCCEEDED, False, f"<ServerGoalHandle {'01' * 16}, succeeded>"),
        (GoalStatus.STATUS_UNKNOWN, False),
    ]


def test_a_deferred_goal_waits_in_the_state_accepted(run: Run) -> None:
    def program(found: list[Any]) -> None:
        handles: list[Any] = []
        rclpy.init()
        node = rclpy.create_node("both")
        ActionServer(node, Fibonacci, "fibonacci", at_once, handle_accepted_callback=handles.append)
        client = ActionClient(node, Fibonacci, "fibonacci")
        goal = send(node, client, 9)
        wait(node, Future(), 1.0)
        found += [handles[0].status, goal.status]
        rclpy.get_global_executor().add_node(node)
        handles[0].execute(
            lambda goal_handle: count_up(goal_handle) if goal_handle.request.order < 9 else at_once(goal_handle)
        )
        found += [handles[0].status, outcome(node, goal)]

    assert run(program) == [GoalStatus.STATUS_ACCEPTED] * 2 + [GoalStatus.STATUS_EXECUTING, (4, [9])]


def test_a_goal_put_off_is_executed_between_two_spins(run: Run) -> None:
    def program(found: list[Any]) -> None:
        handles: list[Any] = []
        rclpy.init()
        node = rclpy.create_node("both")
        ActionServer(node, Fibonacci, "fibonacci", at_once, handle_accepted_callback=handles.append)
        goal = send(node, ActionClient(node, Fibonacci, "fibonacci"))
        found.append(node.executor is rclpy.get_global_executor())
        handles[0].execute()
        found += [handles[0].status, outcome(node, goal)]

    assert run(program) == [True, GoalStatus.STATUS_EXECUTING, (4, [0])]


def test_executing_needs_somebody_who_spins(run: Run) -> None:
    def program(found: list[Any]) -> None:
        handles: list[Any] = []
        rclpy.init()
        node = rclpy.create_node("both")
        ActionServer(node, Fibonacci, "fibonacci", at_once, handle_accepted_callback=handles.append)
        send(node, ActionClient(node, Fibonacci, "fibonacci"))
        node.executor = None
        with pytest.raises(RuntimeError, match=r"no executor spins <Node /both>, .*executor.add_node\(node\)"):
            handles[0].execute()

    run(program)


def test_a_goal_of_the_same_number_is_rejected_even_while_the_first_is_thought_about(run: Run) -> None:
    def program(found: list[Any]) -> None:
        rclpy.init()
        node, executor = rclpy.create_node("both"), MultiThreadedExecutor(3)
        group = ReentrantCallbackGroup()

        def think(_: Any) -> GoalResponse:
            time.sleep(0.5)
            return GoalResponse.ACCEPT

        ActionServer(node, Fibonacci, "fibonacci", at_once, goal_callback=think, callback_group=group)
        client = ActionClient(node, Fibonacci, "fibonacci", callback_group=group)
        number = UUID(uuid=[7] * 16)
        first = client.send_goal_async(Goal(order=1), goal_uuid=number)
        again = node.create_client(SendGoal, "fibonacci/_action/send_goal", callback_group=group)
        second = again.call_async(SendGoal.Request(goal_id=number, goal=Goal(order=2)))
        for answer in (first, second):
            rclpy.spin_until_future_complete(node, answer, executor)
            found.append(answer.result().accepted)

    assert sorted(run(program)) == [False, True]


def test_callbacks_can_be_exchanged(run: Run) -> None:
    def program(found: list[Any]) -> None:
        rclpy.init()
        node = rclpy.create_node("both")
        server = ActionServer(node, Fibonacci, "fibonacci", at_once)
        client = ActionClient(node, Fibonacci, "fibonacci")
        server.register_goal_callback(lambda goal: GoalResponse.REJECT)
        found.append(send(node, client).accepted)
        server.register_goal_callback(None)
        server.register_execute_callback(lambda goal_handle: goal_handle.abort() or Result())
        found.append(outcome(node, send(node, client))[0])
        server.register_handle_accepted_callback(lambda goal_handle: found.append("taken"))
        goal = send(node, client)
        found.append(len(wait(node, goal.cancel_goal_async()).goals_canceling))
        server.register_cancel_callback(accept)
        found.append(len(wait(node, goal.cancel_goal_async()).goals_canceling))
        with pytest.raises(TypeError, match=r"^Failed to register goal execution callback: not callable"):
            server.register_execute_callback(Result())

    assert run(program) == [False, GoalStatus.STATUS_ABORTED, "taken", 0, 1]


def test_every_callback_may_be_async(run: Run) -> None:
    async def accept_goal(goal: Any) -> GoalResponse:
        return GoalResponse.ACCEPT

    async def begin(goal_handle: Any) -> None:
        goal_handle.execute()

    async def agree(goal_handle: Any) -> CancelResponse:
        return CancelResponse.ACCEPT

    async def execute(goal_handle: Any) -> Any:
        while not goal_handle.is_cancel_requested:
            await pause(goal_handle)
        goal_handle.canceled()
        return Result(sequence=[5])

    async def pause(goal_handle: Any) -> None:
        future = Future()
        node = goal_handle._action_server._node
        timer = node.create_timer(0.5, lambda: (timer.cancel(), future.set_result(None)))
        await future

    def program(found: list[Any]) -> None:
        node, client = start()

        async def hear(message: Any) -> None:
            found.append("feedback")

        goal = send(node, client, feedback_callback=hear)
        found.append(len(wait(node, goal.cancel_goal_async()).goals_canceling))
        found.append(outcome(node, goal))

    keywords = {"goal_callback": accept_goal, "handle_accepted_callback": begin, "cancel_callback": agree}
    assert run(serving(execute, **keywords), program) == [1, (GoalStatus.STATUS_CANCELED, [5])]


@pytest.mark.parametrize("role", ["goal_callback", "cancel_callback", "handle_accepted_callback"])
def test_a_callback_with_the_wrong_arguments_ends_the_server_and_is_told(world: World, role: str) -> None:
    def program() -> None:
        node, client = start()
        goal = wait(node, client.send_goal_async(Goal(order=5)), 1.0)
        if goal is not None:
            wait(node, goal.cancel_goal_async(), 1.0)

    process = world.spawn(lambda: serving(executor=MultiThreadedExecutor, **{role: lambda: None})([]), name="server")
    world.spawn(program, name="client")
    world.sim.run_until(5 * SECOND)
    assert isinstance(process.error, TypeError)
    expected = f"The {role} of an action is called with one argument: def {role}(self, argument)."
    assert process.error.__notes__ == [expected]


# ---------------------------------------------------------------- cancelling


def test_a_goal_is_cancelled(run: Run) -> None:
    def program(found: list[Any]) -> None:
        node, client = start()
        goal = send(node, client, 5)
        wait(node, Future(), 1.5)
        answer = wait(node, goal.cancel_goal_async())
        found += [answer.return_code, [each.goal_id for each in answer.goals_canceling] == [goal.goal_id], goal.status]
        found += [outcome(node, goal), goal.status]

    cancelling = serving(executor=MultiThreadedExecutor, cancel_callback=accept)
    assert run(cancelling, program) == [0, True, GoalStatus.STATUS_CANCELING, (GoalStatus.STATUS_CANCELED, [0, 1]), 5]


def test_nothing_is_cancelled_unless_the_server_wants_it(run: Run, capfd: pytest.CaptureFixture[str]) -> None:
    def program(found: list[Any]) -> None:
        node, client = start()
        goal = send(node, client, 1)
        answer = wait(node, goal.cancel_goal_async())
        found += [answer.return_code, answer.goals_canceling, outcome(node, goal)]

    for callback in ({}, {"cancel_callback": lambda goal_handle: True}):
        found = run(serving(executor=MultiThreadedExecutor, **callback), program)
        assert found == [CancelGoal.Response.ERROR_NONE, [], (4, [0])]
    assert "Cancel callback did not return a CancelResponse type. Rejecting" in capfd.readouterr().err


def test_a_goal_that_ends_while_its_cancelling_is_decided_is_not_cancelled(run: Run) -> None:
    def too_late(goal_handle: Any) -> CancelResponse:
        goal_handle.succeed()
        return CancelResponse.ACCEPT

    def program(found: list[Any]) -> None:
        node, client = start()
        goal = send(node, client, 3)
        found.append(wait(node, goal.cancel_goal_async()).goals_canceling)

    def execute(goal_handle: Any) -> Any:
        time.sleep(2)
        return Result()

    assert run(serving(execute, MultiThreadedExecutor, cancel_callback=too_late), program) == [[]]


def cancelled_by(info: Any) -> Callable[[list[Any]], None]:
    """A program that has three goals, the last of them ended, and cancels what a GoalInfo is about."""

    def program(found: list[Any]) -> None:
        rclpy.init()
        node = rclpy.create_node("both")
        ActionServer(
            node, Fibonacci, "fibonacci", at_once, handle_accepted_callback=lambda handle: None, cancel_callback=accept
        )
        client = ActionClient(node, Fibonacci, "fibonacci")
        ids = [UUID(uuid=[number] * 16) for number in (1, 2, 3)]
        for number, goal_id in enumerate(ids):
            goal = send(node, client, goal_uuid=goal_id)
            if number == 2:
                wait(node, goal.cancel_goal_async())
            wait(node, Future(), 1.0)
        service = node.create_client(CancelGoal, "/fibonacci/_action/cancel_goal")
        answer = wait(node, service.call_async(CancelGoal.Request(goal_info=info)))
        found += [answer.return_code, [int(each.goal_id.uuid[0]) for each in answer.goals_canceling]]

    return program


T0 = 1_800_000_000


@pytest.mark.parametrize(
    ("info", "code", "goals"),
    [
        (GoalInfo(), CancelGoal.Response.ERROR_NONE, [1, 2]),
        (GoalInfo(goal_id=TWO), CancelGoal.Response.ERROR_NONE, [2]),
        (GoalInfo(stamp=Time(sec=T0, nanosec=900_000_000)), CancelGoal.Response.ERROR_NONE, [1]),
        (GoalInfo(goal_id=TWO, stamp=Time(sec=T0, nanosec=900_000_000)), CancelGoal.Response.ERROR_NONE, [1, 2]),
        (GoalInfo(stamp=Time(sec=5)), CancelGoal.Response.ERROR_NONE, []),
        (GoalInfo(goal_id=UUID(uuid=[9] * 16)), CancelGoal.Response.ERROR_UNKNOWN_GOAL_ID, []),
        (GoalInfo(goal_id=UUID(uuid=[3] * 16)), CancelGoal.Response.ERROR_NONE, []),
    ],
    ids=["all", "one", "until then", "one and until then", "before all", "unknown", "canceling already"],
)
def test_what_a_cancel_request_may_ask_for(run: Run, info: Any, code: int, goals: list[int]) -> None:
    found = run(cancelled_by(info))
    if info.goal_id.uuid[0] == 3:
        code = CancelGoal.Response.ERROR_GOAL_TERMINATED
    assert found == [code, goals]


# ---------------------------------------------------------------- results


def test_a_result_can_be_fetched_later_and_again_until_it_is_forgotten(run: Run) -> None:
    def program(found: list[Any]) -> None:
        node, client = start()
        goal = send(node, client, 4)
        for pause in (3.0, 6.0, 2.0):
            wait(node, Future(), pause)
            found.append(outcome(node, goal))

    assert run(serving(at_once, result_timeout=10), program, seconds=15) == [(4, [4]), (4, [4]), (0, [])]


def test_a_goal_is_only_forgotten_after_its_callback_has_returned(run: Run) -> None:
    def execute(goal_handle: Any) -> Any:
        goal_handle.succeed()
        time.sleep(3)
        return Result(sequence=[6])

    def program(found: list[Any]) -> None:
        node, client = start()
        found.append(outcome(node, send(node, client)))
        wait(node, Future(), 1.5)
        found.append(outcome(node, send(node, client)))

    assert run(serving(execute, result_timeout=1), program) == [(4, [6])] * 2


def test_a_forgotten_goals_number_is_free_again(run: Run) -> None:
    def program(found: list[Any]) -> None:
        node, client = start()
        for pause in (0.5, 0.8, 0.0):
            found.append(send(node, client, goal_uuid=ONE).accepted)
            wait(node, Future(), pause)

    assert run(serving(at_once, result_timeout=1), program) == [True, False, True]


def test_a_busy_server_answers_requests_about_goals_that_it_forgets_meanwhile(run: Run) -> None:
    def serve(found: list[Any]) -> None:
        rclpy.init()
        node = rclpy.create_node("server")
        ActionServer(node, Fibonacci, "fibonacci", at_once, cancel_callback=accept, result_timeout=2)
        node.create_timer(1.5, lambda: time.sleep(1.4))
        rclpy.spin(node)

    def program(found: list[Any]) -> None:
        node, client = start()
        goals = [send(node, client) for _ in range(2)]
        time.sleep(1.7)
        found.append(wait(node, goals[0]._action_client._cancel_client.call_async(CancelGoal.Request())).return_code)

    assert run(serve, program, seconds=10) == [CancelGoal.Response.ERROR_NONE]


# ---------------------------------------------------------------- what is behind it


def test_the_three_services_and_two_topics(run: Run) -> None:
    def program(found: list[Any]) -> None:
        node, _ = start()
        name = "/fibonacci/_action/"
        found.append(
            [
                (each.removeprefix(name), *types)
                for each, types in [*node.get_service_names_and_types(), *node.get_topic_names_and_types()]
                if each.startswith(name)
            ]
        )
        (status,) = node.get_publishers_info_by_topic(f"{name}status")
        found.append((status.qos_profile.depth, status.qos_profile.durability is DurabilityPolicy.TRANSIENT_LOCAL))
        (feedback,) = node.get_publishers_info_by_topic(f"{name}feedback")
        found.append((feedback.qos_profile.depth, feedback.qos_profile.durability is DurabilityPolicy.VOLATILE))

    kind = "example_interfaces/action/Fibonacci"
    assert run(server, program) == [
        [
            ("cancel_goal", "action_msgs/srv/CancelGoal"),
            ("get_result", f"{kind}_GetResult"),
            ("send_goal", f"{kind}_SendGoal"),
            ("feedback", f"{kind}_FeedbackMessage"),
            ("status", "action_msgs/msg/GoalStatusArray"),
        ],
        (1, True),
        (10, True),
    ]


def test_the_status_topic_tells_of_every_step_also_those_who_come_late(run: Run) -> None:
    def ear(name: str) -> Any:
        def listen(found: list[Any]) -> None:
            rclpy.init()
            node = rclpy.create_node(name)
            quality = QoSProfile(depth=10, durability=DurabilityPolicy.TRANSIENT_LOCAL)

            def hear(message: Any) -> None:
                found.append(
                    (name, [(int(each.goal_info.goal_id.uuid[0]), each.status) for each in message.status_list])
                )

            node.create_subscription(GoalStatusArray, "/fibonacci/_action/status", hear, quality)
            rclpy.spin(node)

        return listen

    def late(found: list[Any]) -> None:
        time.sleep(8)
        ear("late")(found)

    def program(found: list[Any]) -> None:
        node, client = start()
        wait(node, Future(), 0.1)
        outcome(node, send(node, client, 1, goal_uuid=ONE))
        outcome(node, send(node, client, 1, goal_uuid=TWO))

    found = run(server, ear("early"), program, late)
    last = [(1, 4), (2, 4)]
    assert [each for name, each in found if name == "early"] == [
        [(1, 1)], [(1, 2)], [(1, 4)], [(1, 4), (2, 1)], [(1, 4), (2, 2)], last,
    ]  # fmt: skip
    assert [each for name, each in found if name == "late"] == [last]


def test_the_services_can_be_called_by_hand(run: Run) -> None:
    def program(found: list[Any]) -> None:
        rclpy.init()
        node = rclpy.create_node("by_hand")
        goal = node.create_client(SendGoal, "fibonacci/_action/send_goal")
        result = node.create_client(GetResult, "fibonacci/_action/get_result")
        goal.wait_for_service()
        found.append(wait(node, goal.call_async(SendGoal.Request(goal_id=ONE, goal=Goal(order=1)))).accepted)
        found.append(wait(node, result.call_async(GetResult.Request(goal_id=ONE))).status)

    assert run(server, program) == [True, 4]


def test_two_servers_of_one_name_are_noticed(run: Run, capfd: pytest.CaptureFixture[str]) -> None:
    def program(found: list[Any]) -> None:
        node, client = start()
        found.append(send(node, client).accepted)
        wait(node, Future(), 1.0)

    assert run(serving(at_once), serving(at_once), program) == [True]
    text = "Ignoring unexpected goal response. There may be more than one action server for the action 'fibonacci'"
    assert text in capfd.readouterr().err


def test_what_the_graph_says_of_actions(run: Run) -> None:
    def program(found: list[Any]) -> None:
        node, _ = start()
        found.append(action_graph.get_action_names_and_types(node))
        found.append(action_graph.get_action_server_names_and_types_by_node(node, "server", "/"))
        found.append(rclpy.action.get_action_client_names_and_types_by_node(node, "server", "/"))
        found.append(node.get_action_client_names_and_types_by_node("client", "/"))

    one = [("/fibonacci", ["example_interfaces/action/Fibonacci"])]
    assert run(server, program) == [one, one, [], one]


def test_names_are_expanded_and_remapped_as_a_whole_or_in_part(run: Run) -> None:
    def program(found: list[Any]) -> None:
        rclpy.init(args=["--ros-args", "-r", "fibonacci:=count", "-r", "/team/other/_action/status:=/how_it_goes"])
        node = rclpy.create_node("bob", namespace="/team")
        for name in ("fibonacci", "~/own", "/absolute", "other"):
            ActionServer(node, Fibonacci, name, count_up)
        found += [name for name, _ in node.get_action_names_and_types()]
        found.append("/how_it_goes" in dict(node.get_topic_names_and_types()))

    assert run(program) == ["/absolute", "/team/bob/own", "/team/count", "/team/other", True]


def test_an_action_is_one_thing_of_its_node_and_goes_with_it(run: Run) -> None:
    def program(found: list[Any]) -> None:
        rclpy.init()
        node = rclpy.create_node("both")
        server = ActionServer(node, Fibonacci, "fibonacci", at_once)
        client = ActionClient(node, Fibonacci, "fibonacci")
        found.append([len(list(each)) for each in (node.clients, node.subscriptions)])
        found.append([repr(server), repr(client), server.action_type is Fibonacci])
        server.destroy()
        server.destroy()
        found.append((client.server_is_ready(), client in node._ros_waiting_entities, len(list(node.services))))
        node.destroy_node()
        other = rclpy.create_node("other")
        found.append(other.get_action_names_and_types())
        with pytest.raises(rclpy.exceptions.InvalidHandle):
            client.server_is_ready()
        with pytest.raises(rclpy.exceptions.InvalidHandle):
            client.send_goal_async(Goal())

    assert run(program) == [
        [0, 0],
        ["<ActionServer of /fibonacci>", "<ActionClient of /fibonacci>", True],
        (False, True, 6),
        [],
    ]


def test_names_and_defaults_are_those_of_rclpy() -> None:
    def defaults(function: Any) -> dict[str, Any]:
        parameters = inspect.signature(function).parameters.values()
        return {each.name: each.default for each in parameters if each.default is not each.empty}

    server_defaults = defaults(ActionServer.__init__)
    assert list(server_defaults) == [
        "callback_group", "goal_callback", "handle_accepted_callback", "cancel_callback", "goal_service_qos_profile",
        "result_service_qos_profile", "cancel_service_qos_profile", "feedback_pub_qos_profile",
        "status_pub_qos_profile", "result_timeout",
    ]  # fmt: skip
    assert server_defaults["result_timeout"] == 900
    assert server_defaults["goal_callback"] is default_goal_callback
    assert default_goal_callback(Goal()) is GoalResponse.ACCEPT
    assert default_cancel_callback(None) is CancelResponse.REJECT
    assert server_defaults["handle_accepted_callback"] is default_handle_accepted_callback
    assert list(defaults(ActionClient.__init__)) == [
        "callback_group", "goal_service_qos_profile", "result_service_qos_profile", "cancel_service_qos_profile",
        "feedback_sub_qos_profile", "status_sub_qos_profile",
    ]  # fmt: skip
    assert defaults(ActionClient.send_goal_async) == {"feedback_callback": None, "goal_uuid": None}
    assert defaults(ActionClient.wait_for_server) == {"timeout_sec": None}
    assert [each.name for each in GoalEvent] == ["EXECUTE", "CANCEL_GOAL", "SUCCEED", "ABORT", "CANCELED"]
    assert (ServerGoalHandle.__module__, ClientGoalHandle.__module__) == ("rclpy.action.server", "rclpy.action.client")
    assert [(each.name, each.value) for each in GoalResponse] == [("REJECT", 1), ("ACCEPT", 2)]


# ---------------------------------------------------------------- mistakes


def refused(make: Callable[[Any], Any], kind: type[Exception]) -> Any:
    """The error that making something with a node ends in."""

    def program() -> None:
        rclpy.init()
        with pytest.raises(kind) as caught:
            make(rclpy.create_node("node"))
        errors.append(caught.value)

    errors: list[Exception] = []
    world = open_world()
    process = world.spawn(program, name="program")
    world.sim.run_until(SECOND)
    world.close()
    assert process.error is None
    return errors[0]


@pytest.mark.parametrize("name", ["", "two words", "1st", "a//b", "x" * 250])
def test_names_that_are_not_allowed(name: str) -> None:
    for role, kind in (("client", ActionClient), ("server", lambda *rest: ActionServer(*rest, count_up))):
        error = refused(lambda node, kind=kind: kind(node, Fibonacci, name), ValueError)
        assert str(error).startswith(f"Failed to create action {role} due to invalid topic name '{name}': Invalid ")


@pytest.mark.parametrize(
    ("make", "kind", "text"),
    [
        (lambda node: ActionClient(node, Goal, "x"), RuntimeError, "The action type provided is not valid (<class"),
        (lambda node: ActionClient(node, Int32, "x"), RuntimeError, "this might be a message or service"),
        (lambda node: ActionClient(node, AddTwoInts, "x"), RuntimeError, "this might be a message or service"),
        (lambda node: ActionClient(node, "x", Fibonacci), AttributeError, "has no attribute '_TYPE_SUPPORT'"),
        (lambda node: ActionClient(Fibonacci, node, "x"), TypeError, "a node is expected, got the class Fibonacci"),
        (lambda node: ActionClient(node, Fibonacci, 3), TypeError, "name must be a str, got 3"),
        (lambda node: ActionServer(node, Fibonacci, "x", 3), TypeError, "Failed to register goal execution callback"),
    ],
)
def test_wrong_arguments(make: Any, kind: type[Exception], text: str) -> None:
    assert text in str(refused(make, kind))


def test_wrong_arguments_are_explained() -> None:
    error = refused(lambda node: ActionClient(node, Fibonacci.Goal, "x"), RuntimeError)
    assert error.__notes__ == ["Fibonacci.Goal is only a part of Fibonacci."]
    error = refused(lambda node: ActionServer(node, "x", Fibonacci, count_up), AttributeError)
    assert "The order is ActionServer(node, action_type, action_name, execute_callback)." in error.__notes__[0]


@pytest.mark.parametrize("goal", [3, Goal, Result()])
def test_only_goals_can_be_sent(run: Run, goal: Any) -> None:
    def program(found: list[Any]) -> None:
        _, client = start()
        for send_it in (client.send_goal, client.send_goal_async):
            with pytest.raises(TypeError, match=r"^a goal of fibonacci is of type Fibonacci.Goal, got .*: try"):
                send_it(goal)

    run(server, program)
