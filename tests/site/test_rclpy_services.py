"""Services and clients, against recordings of a real rclpy; and calls that hang there, which are explained here."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable
from typing import Any

import pytest
import rclpy
from adding_service import Request, Response, Run, add, server
from example_interfaces.srv import AddTwoInts
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup
from rclpy.executors import Executor, MultiThreadedExecutor, SingleThreadedExecutor
from rclpy.node import Node
from rclpy.task import Future
from std_msgs.msg import String
from std_srvs.srv import Empty

from turtle_lesson.ros.runtime.world import World
from turtle_lesson.ros.sim.errors import NeverWakes


def start() -> tuple[Node, Any]:
    """Begin as a program does: a node, and a client of /add."""
    rclpy.init()
    node = rclpy.create_node("client")
    return node, node.create_client(AddTwoInts, "add")


# ---------------------------------------------------------------- asking


def test_a_request_is_answered_while_the_client_spins(run: Run) -> None:
    def program(found: list[Any]) -> None:
        node, client = start()
        found += [client.wait_for_service(5), client.service_is_ready()]
        future = client.call_async(Request(a=1, b=2))
        found += [future.done(), repr(future)]
        rclpy.spin_until_future_complete(node, future)
        found += [future.done(), future.result()]

    assert run(server, program) == [True, True, False, "<rclpy.task.Future waiting>", True, Response(sum=3)]


def test_waiting_for_a_service_that_never_comes_takes_as_long_as_it_is_told(run: Run) -> None:
    def program(found: list[Any]) -> None:
        _, client = start()
        for timeout in (0.5, 0.0):
            began = time.time()
            found.append((client.wait_for_service(timeout), f"{time.time() - began:.2f}"))

    assert run(program) == [(False, "0.50"), (False, "0.00")]


def test_a_service_that_comes_late_is_waited_for(run: Run) -> None:
    def late(found: list[Any]) -> None:
        time.sleep(1.1)
        server(found)

    def program(found: list[Any]) -> None:
        _, client = start()
        began = time.time()
        found.append((client.wait_for_service(), f"{time.time() - began:.2f}"))

    assert run(late, program) == [(True, "1.25")]  # it looks every 0.25 s, as the real one does


@pytest.mark.parametrize(("timeout", "kind"), [("1.0", TypeError), (float("nan"), ValueError)])
def test_a_timeout_that_is_no_number_is_refused(run: Run, timeout: Any, kind: type[Exception]) -> None:
    def program(found: list[Any]) -> None:
        _, client = start()
        with pytest.raises(kind) as caught:
            client.wait_for_service(timeout)
        found += caught.value.__notes__
        found.append(client.wait_for_service(float("-inf")))

    said = f"The timeout is a number of seconds, or None to wait forever; got {timeout!r}."
    assert run(program) == [said, False]


def test_a_request_to_a_service_that_is_not_there_is_never_answered(run: Run) -> None:
    def program(found: list[Any]) -> None:
        node, client = start()
        future = client.call_async(Request())
        rclpy.spin_until_future_complete(node, future, timeout_sec=1.0)
        found += [future.done(), future.result()]

    def late(found: list[Any]) -> None:
        time.sleep(0.5)
        server(found)  # too late for a request that was sent before

    assert run(program, late) == [False, None]


@pytest.mark.parametrize(
    ("request_", "shown"),
    [
        (Response(), "example_interfaces.srv.AddTwoInts_Response(sum=0)"),
        (5, "5"),
        (Request, "the class AddTwoInts_Request"),
    ],
)
def test_only_requests_can_be_sent(run: Run, request_: Any, shown: str) -> None:
    def program(found: list[Any]) -> None:
        _, client = start()
        for send in (client.call, client.call_async):
            with pytest.raises(TypeError) as caught:  # of the real one without a text
                send(request_)
            found.append(str(caught.value))

    expected = f"a request of add is of type AddTwoInts.Request, got {shown}: try AddTwoInts.Request(…)"
    assert run(server, program) == [expected] * 2


def test_done_callbacks_are_called_by_the_executor_with_the_future(run: Run) -> None:
    def program(found: list[Any]) -> None:
        node, client = start()
        client.wait_for_service()
        future = client.call_async(Request(a=20, b=22))
        future.add_done_callback(lambda done: found.append((done is future, done.result().sum)))
        for _ in range(3):
            rclpy.spin_once(node, timeout_sec=0.1)
        future.add_done_callback(lambda _: found.append("at once, if it is spun"))
        rclpy.spin_once(node, timeout_sec=0.1)

    assert run(server, program) == [(True, 42), "at once, if it is spun"]


def test_an_exception_in_a_done_callback_comes_out_of_spin(run: Run) -> None:
    def program(found: list[Any]) -> None:
        node, client = start()
        client.wait_for_service()
        client.call_async(Request()).add_done_callback(lambda done: done.result().summ)
        with pytest.raises(AttributeError, match="has no attribute 'summ'"):
            rclpy.spin(node)
        found.append("raised")

    assert run(server, program) == ["raised"]


def test_each_answer_goes_to_the_request_it_belongs_to(run: Run) -> None:
    def program(found: list[Any]) -> None:
        node, client = start()
        client.wait_for_service()
        futures = [client.call_async(Request(a=number, b=number)) for number in range(5)]
        client.remove_pending_request(futures[2])
        for future in futures[:2] + futures[3:]:
            rclpy.spin_until_future_complete(node, future, timeout_sec=1.0)
        found += [future.result() and future.result().sum for future in futures]

    assert run(server, program) == [0, 2, None, 6, 8]


def test_two_servers_of_a_name_both_work_and_the_first_answer_counts(run: Run) -> None:
    def other(found: list[Any]) -> None:
        rclpy.init()
        node = rclpy.create_node("other")
        node.create_service(AddTwoInts, "add", lambda request, response: found.append("asked, too") or response)
        rclpy.spin(node)

    def program(found: list[Any]) -> None:
        node, client = start()
        client.wait_for_service()
        future = client.call_async(Request(a=1, b=2))
        rclpy.spin_until_future_complete(node, future)
        time.sleep(0.1)
        found.append(future.result().sum)

    assert run(server, other, program) == ["asked, too", 3]


def test_a_program_that_replaces_send_response_answers_when_it_likes(run: Run) -> None:
    def putting_off(found: list[Any]) -> None:
        rclpy.init()
        node = rclpy.create_node("server")
        service = node.create_service(AddTwoInts, "add", lambda request, response: request.a + request.b)
        send, waiting = service.send_response, []
        service.send_response = lambda total, header: waiting.append((total, header))

        def answer() -> None:
            while waiting:
                total, header = waiting.pop()
                send(Response(sum=total), header)

        node.create_timer(1.0, answer)
        rclpy.spin(node)

    def program(found: list[Any]) -> None:
        node, client = start()
        client.wait_for_service()
        began = time.time()
        future = client.call_async(Request(a=1, b=2))
        rclpy.spin_until_future_complete(node, future)
        found += [future.result(), f"{time.time() - began:.2f}"]

    assert run(putting_off, program) == [Response(sum=3), "1.00"]


# ---------------------------------------------------------------- errors in a service's callback


def raises(request: Any, response: Any) -> Any:
    raise ValueError("boom")


def wrong_type(request: Any, response: Any) -> Any:
    response.sum = "x"
    return response


ADVICE = ", where AddTwoInts.Response is expected: end it with `return response`"


@pytest.mark.parametrize(
    ("callback", "expected"),
    [
        (lambda request, response: None, "TypeError: the callback of /add returned None" + ADVICE),
        (
            lambda request, response: request,
            "TypeError: the callback of /add returned example_interfaces.srv.AddTwoInts_Request(a=1, b=2)" + ADVICE,
        ),
        (raises, "ValueError: boom"),
        (wrong_type, "AssertionError: The 'sum' field must be of type 'int'"),
        (lambda request: request, "TypeError: <lambda>() takes 1 positional argument but 2 were given"),
    ],
)
def test_a_service_callback_that_fails_ends_spin_and_the_client_waits_on(
    run: Run, callback: Callable[..., Any], expected: str
) -> None:
    def failing(found: list[Any]) -> None:
        rclpy.init()
        node = rclpy.create_node("server")
        node.create_service(AddTwoInts, "add", callback)
        try:
            rclpy.spin(node)
        except Exception as error:
            found.append(f"{type(error).__name__}: {error}")

    def program(found: list[Any]) -> None:
        node, client = start()
        client.wait_for_service()
        future = client.call_async(Request(a=1, b=2))
        rclpy.spin_until_future_complete(node, future, timeout_sec=1.0)
        found.append(future.done())

    assert run(failing, program) == [expected, False]


def test_a_service_callback_with_one_parameter_is_told_how_it_is_called(run: Run) -> None:
    def program(found: list[Any]) -> None:
        node, client = start()
        node.create_service(AddTwoInts, "add", lambda request: None)
        client.call_async(Request())
        with pytest.raises(TypeError) as caught:
            rclpy.spin(node)
        found += caught.value.__notes__

    assert run(program) == ["The callback of <Service add> is called with (request, response)."]


# ---------------------------------------------------------------- a synchronous call in a callback


def call_in_a_callback(
    run: Run, make_executor: Callable[[], Executor], groups: Callable[[], list[Any]], same_node: bool = False
) -> str:
    """How a synchronous call in a timer's callback ends: the sum, or why it would never end."""

    def program(found: list[Any]) -> None:
        rclpy.init()
        node, other = rclpy.create_node("client"), rclpy.create_node("server")
        for_client, for_timer, for_server = groups()
        serving = node if same_node else other
        serving.create_service(AddTwoInts, "add", add, callback_group=for_server)
        client = node.create_client(AddTwoInts, "add", callback_group=for_client)

        def tick() -> None:
            timer.cancel()
            try:
                found.append(f"sum={client.call(Request(a=1, b=2)).sum}")
            except NeverWakes as error:
                found.append(str(error))

        timer = node.create_timer(0.1, tick, callback_group=for_timer)
        executor = make_executor()
        executor.add_node(node)
        executor.add_node(other)
        executor.spin()

    (ending,) = run(program)
    return ending


def default() -> list[Any]:
    return [None] * 3


def separate() -> list[Any]:
    return [MutuallyExclusiveCallbackGroup() for _ in range(3)]


def reentrant() -> list[Any]:
    return [ReentrantCallbackGroup()] * 3


def four_threads() -> Executor:
    return MultiThreadedExecutor(4)


def test_three_ways_in_which_a_synchronous_call_in_a_callback_works(run: Run) -> None:
    assert call_in_a_callback(run, four_threads, separate) == "sum=3"
    assert call_in_a_callback(run, four_threads, reentrant) == "sum=3"
    assert call_in_a_callback(run, four_threads, separate, same_node=True) == "sum=3"


@pytest.mark.parametrize(
    ("executor", "groups", "reason"),
    [
        (SingleThreadedExecutor, default, "the client that would take the answer is in the same group"),
        (four_threads, default, "the client that would take the answer is in the same group"),
        (SingleThreadedExecutor, separate, "the thread that would take the answer is the one that waits here"),
        (SingleThreadedExecutor, reentrant, "the thread that would take the answer is the one that waits here"),
    ],
)
def test_where_the_real_one_hangs_ours_says_why_and_what_to_do(
    run: Run, executor: Callable[[], Executor], groups: Callable[[], list[Any]], reason: str
) -> None:
    text = call_in_a_callback(run, executor, groups)
    assert text.startswith("this call of /add can never be answered: ")
    assert reason in text
    assert "`await client.call_async(request)`" in text
    assert "MultiThreadedExecutor" in text


def test_a_service_in_the_callers_own_group_can_never_answer(run: Run) -> None:
    def client_apart() -> list[Any]:
        return [MutuallyExclusiveCallbackGroup(), None, None]

    text = call_in_a_callback(run, four_threads, client_apart, same_node=True)
    assert "the service is offered by this same process, and cannot be called while this callback waits" in text


def test_when_all_threads_wait_for_answers_nobody_is_left_to_take_one(run: Run) -> None:
    def program(found: list[Any]) -> None:
        node, _ = start()
        executor = MultiThreadedExecutor(2)
        executor.add_node(node)

        def tick(name: str, client: Any, timer: list[Any]) -> None:
            timer[0].cancel()
            try:
                found.append((name, client.call(Request(a=1, b=2)).sum))
            except NeverWakes as error:
                found.append((name, "can never be answered" in str(error)))

        for name in "AB":
            client = node.create_client(AddTwoInts, "add", callback_group=ReentrantCallbackGroup())
            timer: list[Any] = []
            callback = lambda name=name, client=client, timer=timer: tick(name, client, timer)  # noqa: E731
            timer.append(node.create_timer(0.1, callback, callback_group=ReentrantCallbackGroup()))
        executor.spin()

    assert run(server, program) == [("B", True), ("A", 3)]


def test_a_group_that_is_only_busy_for_a_while_is_waited_for(run: Run) -> None:
    def program(found: list[Any]) -> None:
        rclpy.init()
        node = rclpy.create_node("client")
        group = MutuallyExclusiveCallbackGroup()
        client = node.create_client(AddTwoInts, "add", callback_group=group)
        node.create_subscription(String, "topic", lambda _: time.sleep(0.5), 10, callback_group=group)
        publisher = node.create_publisher(String, "topic", 10)

        def tick() -> None:
            timer.cancel()
            publisher.publish(String())
            time.sleep(0.1)
            began = time.time()
            found.append((client.call(Request(a=1, b=2)).sum, round(time.time() - began, 1)))

        timer = node.create_timer(0.1, tick)
        executor = MultiThreadedExecutor(4)
        executor.add_node(node)
        executor.spin()

    assert run(server, program) == [(3, 0.4)]


def test_a_call_with_a_timeout_gives_up(run: Run) -> None:
    def program(found: list[Any]) -> None:
        _, client = start()
        client.wait_for_service()
        began = time.time()
        found.append((client.call(Request(), timeout_sec=0.5), round(time.time() - began, 2)))

    assert run(server, program) == [(None, 0.5)]


def test_a_call_where_nobody_spins_or_serves_is_explained(run: Run) -> None:
    def program(found: list[Any]) -> None:
        node, client = start()
        for _ in range(2):
            with pytest.raises(NeverWakes) as caught:
                client.call(Request())
            found.append(str(caught.value))
            node.create_service(AddTwoInts, "add", add)

    missing, unspun = run(program)
    assert "no node offers this service (example_interfaces/srv/AddTwoInts). Is its node running?" in missing
    assert "wait_for_service(timeout_sec=…)" in missing
    assert "no executor spins <Node /client> meanwhile" in unspun
    assert "rclpy.spin_until_future_complete(node, future)" in unspun


# ---------------------------------------------------------------- from a plain cell


def test_a_cell_simply_calls(world: World) -> None:
    world.spawn(lambda: server([]), name="server")
    _, client = start()
    assert client.wait_for_service(timeout_sec=1.0)
    assert client.call(Request(a=1, b=2)) == Response(sum=3)
    future = client.call_async(Request(a=3, b=4))
    rclpy.spin_until_future_complete(client._node, future)
    assert future.result().sum == 7


def test_a_cell_may_call_a_service_of_its_own_node_but_not_of_one_that_nobody_spins(world: World) -> None:
    node, client = start()
    node.create_service(AddTwoInts, "add", add)
    assert client.call(Request(a=1, b=2)).sum == 3
    other = rclpy.create_node("other")
    other.create_service(AddTwoInts, "elsewhere", add)
    elsewhere = node.create_client(AddTwoInts, "elsewhere")
    with pytest.raises(NeverWakes, match="the service's node is in this notebook, too, and no executor spins it"):
        elsewhere.call(Request())
    together = SingleThreadedExecutor()
    together.add_node(node)
    together.add_node(other)
    assert elsewhere.call(Request(a=2, b=2)).sum == 4


def test_a_cell_that_calls_nobody_is_told_so_and_who_was_perhaps_meant(world: World) -> None:
    node, client = start()
    with pytest.raises(NeverWakes, match="no node offers this service"):
        client.call(Request())
    node.create_service(AddTwoInts, "add_two", add)
    with pytest.raises(NeverWakes, match=r"no node offers this service \(.*\); did you mean '/add_two'\? Is its node"):
        node.create_client(AddTwoInts, "ad_two").call(Request())
    with pytest.raises(NeverWakes, match="of type example_interfaces/srv/AddTwoInts, not std_srvs/srv/Empty"):
        node.create_client(Empty, "add_two").call(Empty.Request())


# ---------------------------------------------------------------- await


def await_in_a_callback(run: Run, group: Callable[[], Any]) -> list[Any]:
    def program(found: list[Any]) -> None:
        rclpy.init()
        node = rclpy.create_node("client")
        client = node.create_client(AddTwoInts, "add", callback_group=group())

        async def tick() -> None:
            timer.cancel()
            found.append("async callback begins")
            response = await client.call_async(Request(a=5, b=6))
            found.append(f"sum {response.sum}")

        timer = node.create_timer(0.1, tick)
        try:
            rclpy.spin(node)
        except NeverWakes as error:
            found.append(str(error))

    return run(server, program)


def test_an_async_callback_awaits_an_answer_if_the_client_has_a_group_of_its_own(run: Run) -> None:
    assert await_in_a_callback(run, MutuallyExclusiveCallbackGroup) == ["async callback begins", "sum 11"]
    assert await_in_a_callback(run, ReentrantCallbackGroup) == ["async callback begins", "sum 11"]


def test_in_the_default_group_awaiting_hangs_in_reality_and_is_explained_here(run: Run) -> None:
    begins, text = await_in_a_callback(run, lambda: None)
    assert begins == "async callback begins"
    assert text.startswith("this coroutine waits for an answer of add, but can never get it")
    assert "callback_group=MutuallyExclusiveCallbackGroup()" in text


def test_an_async_service_callback_may_await_another_service(run: Run) -> None:
    def middle(found: list[Any]) -> None:
        rclpy.init()
        node = rclpy.create_node("middle")
        client = node.create_client(AddTwoInts, "add", callback_group=MutuallyExclusiveCallbackGroup())

        async def double(request: Any, response: Any) -> Any:
            inner = await client.call_async(request)
            response.sum = 2 * inner.sum
            return response

        node.create_service(AddTwoInts, "double", double)
        rclpy.spin(node)

    def program(found: list[Any]) -> None:
        rclpy.init()
        node = rclpy.create_node("client")
        client = node.create_client(AddTwoInts, "double")
        client.wait_for_service()
        future = client.call_async(Request(a=3, b=4))
        rclpy.spin_until_future_complete(node, future)
        found.append(future.result().sum)

    assert run(server, middle, program) == [14]


def test_a_coroutine_that_awaits_what_it_cannot_may_catch_that_and_go_on(run: Run) -> None:
    class Odd:
        def __await__(self) -> Any:
            yield 5

    def program(found: list[Any]) -> None:
        node, _ = start()
        later = Future()
        node.create_timer(0.5, lambda: later.set_result(7), callback_group=ReentrantCallbackGroup())

        async def tick() -> None:
            timer.cancel()
            for awaited in (Odd(), Odd(), later):
                try:
                    found.append(await awaited)
                except TypeError as error:
                    found.append(str(error)[:49])

        timer = node.create_timer(0.1, tick)
        rclpy.spin(node)

    only = "a callback can only await rclpy's own futures and"
    assert run(program, seconds=0.8) == [only, only, 7]


def test_a_coroutine_that_does_not_give_up_a_hopeless_answer_holds_nobody_up(run: Run) -> None:
    def program(found: list[Any]) -> None:
        node, client = start()

        async def tick() -> None:
            timer.cancel()
            future = client.call_async(Request())
            while not future.done():
                try:
                    await future
                except NeverWakes:
                    found.append("told")

        timer = node.create_timer(0.1, tick)
        rclpy.spin(node)

    assert run(server, program) == ["told"]


def test_a_future_of_ones_own_can_be_awaited_and_its_group_stays_taken_meanwhile(run: Run) -> None:
    def program(found: list[Any]) -> None:
        rclpy.init()
        node = rclpy.create_node("n")
        arrived: Future = Future()

        async def wait() -> None:
            waiting.cancel()
            found.append(f"got {await arrived}")

        waiting = node.create_timer(0.1, wait)
        node.create_timer(0.3, lambda: found.append("same group"))
        ending = node.create_timer(
            1.0,
            lambda: (ending.cancel(), arrived.set_result("it")),
            callback_group=MutuallyExclusiveCallbackGroup(),
        )
        rclpy.spin(node)

    assert run(program, seconds=1.25) == ["got it", "same group", "same group"]


def test_asyncio_does_not_run_inside_an_executor(run: Run) -> None:
    def program(found: list[Any]) -> None:
        rclpy.init()
        node = rclpy.create_node("n")

        async def tick() -> None:
            await asyncio.sleep(0.1)

        node.create_timer(0.1, tick)
        with pytest.raises(RuntimeError) as caught:
            rclpy.spin(node)
        found += [str(caught.value), *caught.value.__notes__]

    assert run(program) == [
        "no running event loop",
        "rclpy's executors are not asyncio loops: asyncio's functions do not work in their callbacks. To wait, await a "
        "future of rclpy's, or have a timer call you later.",
    ]


def test_the_traceback_of_that_ends_at_the_learners_own_line(
    world: World, run: Run, capsys: pytest.CaptureFixture[str]
) -> None:
    def program(found: list[Any]) -> None:
        rclpy.init()
        node = rclpy.create_node("n")

        async def tick() -> None:
            await asyncio.sleep(0.1)

        node.create_timer(0.1, tick)
        rclpy.spin(node)

    with pytest.raises(RuntimeError):
        run(program)
    lines = capsys.readouterr().err.splitlines()
    assert [line.rpartition(", in ")[2] for line in lines if line.startswith("  File")][-2:] == ["program", "tick"]
    assert "await asyncio.sleep(0.1)" in lines[-3]


# ---------------------------------------------------------------- being busy


def test_a_service_that_sleeps_answers_one_after_the_other(run: Run) -> None:
    def busy(found: list[Any]) -> None:
        rclpy.init()
        node = rclpy.create_node("server")
        node.create_service(AddTwoInts, "add", lambda request, response: time.sleep(2.0) or add(request, response))
        rclpy.spin(node)

    def asks(name: str) -> Callable[[list[Any]], None]:
        def program(found: list[Any]) -> None:
            node, client = start()
            client.wait_for_service()
            future, began = client.call_async(Request(a=1, b=1)), time.time()
            rclpy.spin_until_future_complete(node, future)
            found.append((name, round(time.time() - began, 1)))

        return program

    assert run(busy, asks("first"), asks("second")) == [("first", 2.0), ("second", 4.0)]
