"""Service introspection: what is asked and answered is there to be heard on the service's event topic."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from typing import Any

import pytest
import rclpy
from action_msgs.srv import CancelGoal
from example_interfaces.action import Fibonacci
from example_interfaces.srv import AddTwoInts
from program_terminal import Terminal, having
from rclpy.action import ActionClient, ActionServer
from rclpy.qos import qos_profile_system_default
from rclpy.service_introspection import ServiceIntrospectionState

Run = Callable[..., list[Any]]
State = ServiceIntrospectionState
SENT, RECEIVED, ANSWERED, GOT_ANSWER = range(4)
TOPIC = "/add/_service_event"


def add(request: Any, response: Any) -> Any:
    time.sleep(0.2)
    response.sum = request.a + request.b
    return response


def watch(node: Any, found: list[Any], *events: tuple[Any, str]) -> None:
    for kind, topic in events:
        node.create_subscription(kind, topic, found.append, 10)


def sum_of(node: Any, client: Any, a: int, b: int) -> int:
    future = client.call_async(AddTwoInts.Request(a=a, b=b))
    rclpy.spin_until_future_complete(node, future)
    return int(future.result().sum)


def server_with(state: State) -> Callable[[list[Any]], None]:
    def server(found: list[Any]) -> None:
        rclpy.init()
        node = rclpy.create_node("server")
        service = node.create_service(AddTwoInts, "add", add)
        service.configure_introspection(node.get_clock(), qos_profile_system_default, state)
        watch(node, found, (AddTwoInts.Event, TOPIC))
        rclpy.spin(node)

    return server


def asks(state: State, *calls: tuple[int, int]) -> Callable[[list[Any]], None]:
    def client(_: list[Any]) -> None:
        rclpy.init()
        node = rclpy.create_node("asks")
        client = node.create_client(AddTwoInts, "add")
        client.configure_introspection(node.get_clock(), qos_profile_system_default, state)
        client.wait_for_service()
        time.sleep(1.0)
        for a, b in calls:
            sum_of(node, client, a, b)
        time.sleep(1.0)

    return client


def test_all_four_moments_of_a_call_are_told_with_their_times(run: Run) -> None:
    events = run(server_with(State.CONTENTS), asks(State.METADATA, (2, 3)))
    assert sorted(event.info.event_type for event in events) == [SENT, RECEIVED, ANSWERED, GOT_ANSWER]
    by_type = {event.info.event_type: event for event in events}
    moments = [(each.info.stamp.sec, each.info.stamp.nanosec) for _, each in sorted(by_type.items())]
    assert moments == sorted(moments)
    seconds = [sec % 100 + nanosec / 1e9 for sec, nanosec in moments]
    assert [round(each - seconds[0], 2) for each in seconds] == [0.0, 0.0, 0.2, 0.2]
    assert len({bytes(event.info.client_gid) for event in events}) == 1
    assert {event.info.sequence_number for event in events} == {1}
    assert (by_type[RECEIVED].request, by_type[RECEIVED].response) == ([AddTwoInts.Request(a=2, b=3)], [])
    assert (by_type[ANSWERED].request, by_type[ANSWERED].response) == ([], [AddTwoInts.Response(sum=5)])
    for kind in (SENT, GOT_ANSWER):
        assert (by_type[kind].request, by_type[kind].response) == ([], [])


def test_two_clients_are_told_apart_and_their_requests_counted(run: Run) -> None:
    events = run(server_with(State.METADATA), asks(State.OFF, (1, 1), (2, 2)), asks(State.OFF, (3, 3)))
    asked = [event.info for event in events if event.info.event_type == RECEIVED]
    assert sorted(info.sequence_number for info in asked) == [1, 1, 2]
    assert len({bytes(info.client_gid) for info in asked}) == 2


def test_it_ends_with_off_and_with_the_service(run: Run) -> None:
    def program(found: list[Any]) -> None:
        rclpy.init()
        node = rclpy.create_node("n")

        def heard() -> int:
            return node.count_publishers(TOPIC)

        service, client = node.create_service(AddTwoInts, "add", add), node.create_client(AddTwoInts, "add")
        for end in (service, client):
            end.configure_introspection(node.get_clock(), qos_profile_system_default, State.METADATA)
        found.append(heard())
        client.configure_introspection(node.get_clock(), qos_profile_system_default, State.OFF)
        found.append(heard())
        service.configure_introspection(node.get_clock(), qos_profile_system_default, State.CONTENTS)
        found.append(heard())
        node.destroy_service(service)
        found.append(heard())
        client.configure_introspection(node.get_clock(), qos_profile_system_default, State.CONTENTS)
        node.destroy_node()
        found.append(len(list(node_names_with(TOPIC))))

    def node_names_with(topic: str) -> Iterator[str]:
        other = rclpy.create_node("other")
        yield from (each.node_name for each in other.get_publishers_info_by_topic(topic))

    assert run(program) == [2, 1, 1, 0, 0]


@pytest.mark.parametrize(
    ("clock", "state", "kind"),
    [(None, State.METADATA, TypeError), ("clock", 7, ValueError), ("clock", "on", ValueError)],
)
def test_what_it_cannot_be(run: Run, clock: Any, state: Any, kind: type[Exception]) -> None:
    def program(found: list[Any]) -> None:
        rclpy.init()
        node = rclpy.create_node("n")
        service = node.create_service(AddTwoInts, "add", add)
        with pytest.raises(kind):
            service.configure_introspection(clock and node.get_clock(), qos_profile_system_default, state)
        found.append(node.count_publishers(TOPIC))

    assert run(program) == [0]


def test_an_actions_three_services_are_told(run: Run) -> None:
    impl = Fibonacci.Impl

    def server(_: list[Any]) -> None:
        rclpy.init()
        node = rclpy.create_node("server")

        def execute(goal_handle: Any) -> Any:
            goal_handle.succeed()
            return Fibonacci.Result(sequence=[0, 1])

        action = ActionServer(node, Fibonacci, "fibonacci", execute)
        action.configure_introspection(node.get_clock(), qos_profile_system_default, State.CONTENTS)
        rclpy.spin(node)

    def client(found: list[Any]) -> None:
        rclpy.init()
        node = rclpy.create_node("client")
        events: list[Any] = []
        kinds = {"send_goal": impl.SendGoalService, "get_result": impl.GetResultService, "cancel_goal": CancelGoal}
        watch(
            node, events, *((kind.Event, f"/fibonacci/_action/{name}/_service_event") for name, kind in kinds.items())
        )
        action = ActionClient(node, Fibonacci, "fibonacci")
        action.configure_introspection(node.get_clock(), qos_profile_system_default, State.METADATA)
        action.wait_for_server()
        future = action.send_goal_async(Fibonacci.Goal(order=3))
        rclpy.spin_until_future_complete(node, future)
        result = future.result().get_result_async()
        rclpy.spin_until_future_complete(node, result)
        for _ in range(20):
            rclpy.spin_once(node, timeout_sec=0.1)
        found.extend(
            (type(event).__name__, event.info.event_type, len(event.request or event.response)) for event in events
        )

    assert sorted(run(server, client)) == [
        (name, kind, int(kind in (RECEIVED, ANSWERED)))
        for name in ("Fibonacci_GetResult_Event", "Fibonacci_SendGoal_Event")
        for kind in (SENT, RECEIVED, ANSWERED, GOT_ANSWER)
    ]


def test_a_program_that_is_told_by_parameters_what_to_publish(terminal: Terminal) -> None:
    programs = ("first_steps watched_service server", "first_steps watched_service client")
    assert having(terminal.run(*programs, seconds=1.2), "sum") == [
        f"{moment} watched_client: The sum is 5" for moment in ("0.5", "1.0")
    ]
    assert terminal.say("ros2 topic list --include-hidden-topics | grep _service_event") == []
    told = terminal.say("ros2 param set /watched_server introspection contents", "ros2 topic list")
    assert having(told, "Set", "_service_event") == ["Set parameter successful"]
    listen = "ros2 topic echo --once --field request /add_two_ints/_service_event"
    assert "[example_interfaces.srv.AddTwoInts_Request(a=2, b=3)]" in terminal.say(listen)
    assert having(terminal.say("ros2 param set /watched_client introspection all"), "param") == [
        "Setting parameter failed: must be one of disabled, metadata, contents"
    ]
