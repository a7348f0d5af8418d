"""Threads beside rclpy: the idioms that programs in the wild use, each as it behaves on a robot."""

from __future__ import annotations

import queue
import threading
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from typing import Any

import pytest
import rclpy
from adding_service import Request, Run, server
from example_interfaces.srv import AddTwoInts
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor, SingleThreadedExecutor
from rclpy.node import Node
from rclpy.task import Future
from std_msgs.msg import String

from turtle_lesson.ros.runtime.world import World
from turtle_lesson.ros.sim.errors import NeverWakes

Capture = pytest.CaptureFixture[str]
SECOND = 1_000_000_000


def start() -> Node:
    """Begin as a program does: a node called n, in the running process."""
    rclpy.init()
    return rclpy.create_node("n")


def stop_watch() -> Callable[[], float]:
    """Seconds since now, with two decimals."""
    began = time.time()
    return lambda: round(time.time() - began, 2)


def spin_in_thread(node: Node) -> threading.Thread:
    """The idiom: the node is spun by a daemon."""
    thread = threading.Thread(target=rclpy.spin, args=(node,), daemon=True)
    thread.start()
    return thread


# ---------------------------------------------------------------- loops that do nothing but ask

WAYS_TO_ASK: dict[str, Callable[[Any], object]] = {
    "a future": lambda it: it.future.done(),
    "an event": lambda it: it.event.is_set(),
    "a queue": lambda it: not it.queue.empty(),
    "a lock": lambda it: it.lock.acquire(blocking=False),
    "ROS": lambda it: not rclpy.ok() or it.seen,
    "a thread": lambda it: not it.thread.is_alive() or it.seen,
    "the graph": lambda it: it.node.count_publishers("late"),
    "a publisher": lambda it: it.publisher.get_subscription_count(),
    "a client": lambda it: it.client.service_is_ready(),
}


class Awaited:
    """What a timer changes after half a second, in a node that a thread spins."""

    def __init__(self) -> None:
        self.node = start()
        self.future, self.event, self.queue, self.lock = (
            Future(),
            threading.Event(),
            queue.Queue[int](),
            threading.Lock(),
        )
        self.lock.acquire()
        self.seen = False
        self.publisher = self.node.create_publisher(String, "early", 1)
        self.client = self.node.create_client(AddTwoInts, "add")
        self.timer = self.node.create_timer(0.5, self.happen)
        self.thread = spin_in_thread(self.node)

    def happen(self) -> None:
        """The half second is over."""
        self.timer.cancel()
        self.seen = True
        self.future.set_result(1)
        self.event.set()
        self.queue.put(1)
        self.lock.release()
        self.node.create_publisher(String, "late", 1)
        self.node.create_subscription(String, "early", print, 1)
        self.node.create_service(AddTwoInts, "add", print)


@pytest.mark.parametrize("what", WAYS_TO_ASK)
def test_a_loop_that_does_nothing_but_ask_ends_when_another_thread_has_done_it(run: Run, what: str) -> None:
    def program(found: list[Any]) -> None:
        it, now, asked = Awaited(), stop_watch(), 0
        while not WAYS_TO_ASK[what](it):
            asked += 1
        found += [now(), asked > 100_000]

    assert run(program) == [0.5, True]


def test_asking_now_and_then_takes_no_time(run: Run) -> None:
    def program(found: list[Any]) -> None:
        it, clock = Awaited(), rclpy.clock.Clock()
        began = clock.now()
        for _ in range(90):
            found.extend(ask for ask in WAYS_TO_ASK.values() if ask(it))
        found.append((clock.now() - began).nanoseconds)

    assert run(program) == [1_000]  # that of the second look at the clock


# ---------------------------------------------------------------- spinning in a thread


def test_a_main_loop_at_a_rate_beside_a_thread_that_spins(run: Run) -> None:
    def program(found: list[Any]) -> None:
        node, now = start(), stop_watch()
        node.create_timer(0.4, lambda: found.append(("timer", now())))
        spin_in_thread(node)
        rate = node.create_rate(2)
        for _ in range(3):
            found.append(("main", now()))
            rate.sleep()

    assert run(program) == [
        ("main", 0.0),
        ("timer", 0.4),
        ("main", 0.5),
        ("timer", 0.8),
        ("main", 1.0),
        ("timer", 1.2),
    ]


def test_a_main_loop_that_sleeps_beside_a_thread_that_spins(run: Run) -> None:
    def program(found: list[Any]) -> None:
        node, now, heard = start(), stop_watch(), []
        node.create_subscription(String, "chatter", lambda message: heard.append(message.data), 10)
        publisher = node.create_publisher(String, "chatter", 10)
        spin_in_thread(node)
        while now() < 1.0:
            publisher.publish(String(data=f"{now():.1f}"))
            time.sleep(0.25)
        found.append(heard)

    assert run(program) == [["0.0", "0.2", "0.5", "0.8"]]


def test_a_synchronous_call_from_the_main_program(run: Run) -> None:
    def program(found: list[Any]) -> None:
        node = start()
        client = node.create_client(AddTwoInts, "add")
        spin_in_thread(node)
        assert client.wait_for_service(timeout_sec=1.0)
        found.extend(client.call(Request(a=number, b=1)).sum for number in range(3))

    assert run(server, program) == [1, 2, 3]


def test_a_synchronous_call_from_a_worker_thread_while_main_spins(run: Run) -> None:
    def program(found: list[Any]) -> None:
        node = start()
        client = node.create_client(AddTwoInts, "add")

        def work() -> None:
            client.wait_for_service()
            for number in range(3):
                found.append(client.call(Request(a=number, b=2)).sum)
                time.sleep(0.5)
            rclpy.shutdown()

        threading.Thread(target=work).start()
        rclpy.spin(node)
        found.append("ended")

    assert run(server, program) == [2, 3, 4, "ended"]


def test_a_worker_that_calls_before_anybody_spins(run: Run) -> None:
    def program(found: list[Any]) -> None:
        node = start()
        client = node.create_client(AddTwoInts, "add")
        client.wait_for_service()
        threading.Thread(target=lambda: found.append(client.call(Request(a=1, b=2)).sum)).start()
        time.sleep(1)
        rclpy.spin_until_future_complete(node, Future(), timeout_sec=1)

    assert run(server, program) == [3]


@pytest.mark.parametrize("executor", [None, MultiThreadedExecutor])
def test_a_shutdown_ends_the_thread_that_spins_in_silence(
    world: World, capsys: Capture, executor: type[MultiThreadedExecutor] | None
) -> None:
    log: list[Any] = []

    def program() -> None:
        node = start()
        spin = partial(rclpy.spin, node, executor and executor())
        thread = threading.Thread(target=spin)
        thread.start()
        time.sleep(1)
        rclpy.shutdown()
        thread.join()
        log.append(thread.is_alive())
        rclpy.init()  # and ROS may begin anew, with another executor
        rclpy.spin_once(rclpy.create_node("n"), timeout_sec=1)
        log.append(round(time.monotonic()))

    process = world.spawn(program, name="program")
    world.sim.run_until(5 * SECOND)
    assert log == [False, 2] and process.exit_code == 0
    assert capsys.readouterr().err == ""


def test_a_shutdown_is_an_error_in_the_thread_that_spins_an_executor_of_its_own(world: World, capsys: Capture) -> None:
    def program() -> None:
        executor = SingleThreadedExecutor()
        executor.add_node(start())
        threading.Thread(target=executor.spin).start()
        time.sleep(1)
        rclpy.shutdown()

    world.spawn(program, name="program")
    world.sim.run_until(5 * SECOND)
    assert capsys.readouterr().err.splitlines() == [
        "Exception in thread Thread-1 (spin):",
        "rclpy.executors.ExternalShutdownException",
    ]


def test_an_executor_of_ones_own_in_a_thread_is_shut_down_in_silence(run: Run) -> None:
    def program(found: list[Any]) -> None:
        node, executor = start(), SingleThreadedExecutor()
        executor.add_node(node)
        node.create_timer(0.5, lambda: found.append("tick"))
        thread = threading.Thread(target=executor.spin)
        thread.start()
        time.sleep(1.2)
        executor.shutdown()
        thread.join()
        found.append("joined")

    assert run(program) == ["tick", "tick", "joined"]


def test_a_program_whose_spinning_thread_is_no_daemon_lives_on(world: World) -> None:
    log: list[str] = []

    def program() -> None:
        node = start()
        node.create_timer(1.0, lambda: log.append("tick"))
        threading.Thread(target=rclpy.spin, args=(node,)).start()

    process = world.spawn(program, name="program")
    world.sim.run_until(3 * SECOND + 1)
    assert process.alive and log == ["tick"] * 3
    process.interrupt()
    assert not process.alive


def test_ctrl_c_reaches_the_main_program(world: World) -> None:
    log: list[str] = []

    def program() -> None:
        node = start()
        spin_in_thread(node)
        rate = node.create_rate(10)
        try:
            while rclpy.ok():
                rate.sleep()
        except KeyboardInterrupt:
            log.append("interrupted")
        finally:
            node.destroy_node()

    process = world.spawn(program, name="program")
    world.sim.run_until(SECOND)
    process.interrupt()
    assert log == ["interrupted"] and process.exit_code == 0


def test_two_threads_that_spin_two_nodes(run: Run) -> None:
    def program(found: list[Any]) -> None:
        start()
        for name, period in (("a", 0.5), ("b", 0.7)):
            node, executor = rclpy.create_node(name), SingleThreadedExecutor()
            node.create_timer(period, lambda name=name: found.append(name))
            executor.add_node(node)
            threading.Thread(target=executor.spin, daemon=True).start()
        time.sleep(1.6)

    assert run(program) == ["a", "b", "a", "b", "a"]


def test_an_executor_that_a_thread_spins_may_be_spun_once_by_another(run: Run) -> None:
    """Whoever comes first takes what is there; nothing is lost, and nobody is forgotten."""

    def program(found: list[Any]) -> None:
        node, executor, ticks, now = start(), SingleThreadedExecutor(), [], stop_watch()
        node.create_timer(0.1, lambda: ticks.append(threading.current_thread().name))
        executor.add_node(node)
        threading.Thread(target=executor.spin, daemon=True, name="spinner").start()
        for _ in range(3):
            executor.spin_once(timeout_sec=0.15)
            time.sleep(0.2)
        time.sleep(0.3)
        found.append((abs(len(ticks) - 10 * now()) <= 1, set(ticks) == {"spinner", "MainThread"}))

    assert run(program) == [(True, True)]


# ---------------------------------------------------------------- between callbacks and threads


def test_a_queue_from_a_callback_to_a_worker(run: Run) -> None:
    def program(found: list[Any]) -> None:
        node, now = start(), stop_watch()
        jobs: queue.Queue[str] = queue.Queue()
        publisher = node.create_publisher(String, "job", 10)
        numbers = iter(range(10))
        node.create_subscription(String, "job", lambda message: jobs.put(message.data), 10)
        node.create_timer(0.2, lambda: publisher.publish(String(data=f"job {next(numbers)}")))

        def work() -> None:
            for _ in range(3):
                job = jobs.get()
                time.sleep(0.5)  # the node goes on meanwhile
                found.append((job, now()))
            rclpy.shutdown()

        threading.Thread(target=work).start()
        rclpy.spin(node)

    assert run(program) == [("job 0", 0.7), ("job 1", 1.2), ("job 2", 1.7)]


@pytest.mark.parametrize("kind", [MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup])
def test_an_event_in_a_callback_that_another_callback_sets(run: Run, kind: Callable[[], Any]) -> None:
    def program(found: list[Any]) -> None:
        node, now, event = start(), stop_watch(), threading.Event()

        def wait() -> None:
            waiting.cancel()
            found.append(("waits", now()))
            event.wait()
            found.append(("goes on", now()))

        waiting = node.create_timer(0.1, wait, callback_group=kind())
        node.create_timer(0.5, event.set, callback_group=kind())
        executor = MultiThreadedExecutor()
        executor.add_node(node)
        executor.spin_until_future_complete(Future(), timeout_sec=1.0)

    assert run(program) == [("waits", 0.1), ("goes on", 0.5)]


def test_a_lock_between_callbacks(run: Run) -> None:
    def program(found: list[Any]) -> None:
        node, now, lock = start(), stop_watch(), threading.Lock()

        def tick(name: str) -> None:
            with lock:
                time.sleep(0.3)
                found.append((name, now()))

        for name in "ab":
            node.create_timer(0.1, lambda name=name: tick(name), callback_group=MutuallyExclusiveCallbackGroup())
        executor = MultiThreadedExecutor()
        executor.add_node(node)
        executor.spin_until_future_complete(Future(), timeout_sec=0.8)

    assert run(program)[:2] == [("a", 0.4), ("b", 0.7)]


def test_a_future_of_rclpys_that_a_thread_completes(run: Run) -> None:
    def program(found: list[Any]) -> None:
        node, future, now = start(), Future(), stop_watch()
        threading.Timer(1.0, lambda: future.set_result("done")).start()
        rclpy.spin_until_future_complete(node, future)
        found.append((future.result(), now()))

    assert run(program) == [("done", 1.0)]


def test_a_pool_does_what_callbacks_ask_for(run: Run) -> None:
    def program(found: list[Any]) -> None:
        node, now, pool = start(), stop_watch(), ThreadPoolExecutor(2)

        def compute(number: int) -> None:
            time.sleep(1)
            found.append((number, now()))

        numbers = iter(range(10))
        node.create_timer(0.4, lambda: pool.submit(compute, next(numbers)))
        rclpy.spin_until_future_complete(node, Future(), timeout_sec=1.3)
        found.append("main ends")

    assert run(program) == ["main ends", (0, 1.4), (1, 1.8), (2, 2.4)]


# ---------------------------------------------------------------- the end of main()


def test_callbacks_in_their_middle_go_on_to_their_end_when_main_returns(world: World) -> None:
    log: list[Any] = []

    def program() -> None:
        node, now = start(), stop_watch()

        def slow() -> None:
            timer.cancel()
            time.sleep(2)
            log.append(("callback ends", now(), threading.current_thread().name))

        timer = node.create_timer(0.1, slow)
        executor = MultiThreadedExecutor()
        executor.add_node(node)
        executor.spin_once(timeout_sec=1)
        time.sleep(0.1)
        log.append(("main ends", now()))

    process = world.spawn(program, name="program")
    world.sim.run_until(5 * SECOND)
    assert log == [("main ends", 0.2), ("callback ends", 2.1, "ThreadPoolExecutor-0_0")]
    assert process.exit_code == 0


# ---------------------------------------------------------------- what can never be


def told(world: World, program: Callable[[list[Any]], object]) -> str:
    """What a program is told that waits in vain; it is told within the instant in which that is certain."""
    process = world.spawn(lambda: program([]), name="program")
    world.spawn(lambda: server([]), name="server")
    world.sim.run_until(5 * SECOND)
    assert isinstance(process.error, NeverWakes), process.error
    return str(process.error)


def test_an_event_that_only_the_same_executor_could_set(world: World) -> None:
    def program(found: list[Any]) -> None:
        node, event = start(), threading.Event()
        node.create_timer(0.1, event.wait)
        node.create_timer(0.2, event.set)
        rclpy.spin(node)

    assert told(world, program).startswith(
        "waiting for Event.wait() would never end: nothing is left in this program that could end it. It has no other "
        "thread. While a callback waits, a single-threaded executor calls no other"
    )


def test_an_event_that_only_the_same_callback_group_could_set(world: World) -> None:
    def program(found: list[Any]) -> None:
        node, event, executor = start(), threading.Event(), MultiThreadedExecutor()
        node.create_timer(0.1, event.wait)
        node.create_timer(0.2, event.set)
        executor.add_node(node)
        executor.spin()

    assert "no executor calls another one of the same mutually exclusive callback group" in told(world, program)


def test_a_call_in_a_callback_of_a_node_that_a_thread_spins(world: World, capsys: Capture) -> None:
    def program() -> None:
        node = start()
        client = node.create_client(AddTwoInts, "add", callback_group=MutuallyExclusiveCallbackGroup())
        node.create_timer(0.5, lambda: client.call(Request()))
        spin_in_thread(node)
        while rclpy.ok():
            time.sleep(1)

    world.spawn(lambda: server([]), name="server")
    world.spawn(program, name="program")
    world.sim.run_until(2 * SECOND)
    error = capsys.readouterr().err
    assert error.startswith("Exception in thread Thread-1 (spin):")
    assert "the thread that would take the answer is the one that waits here" in error


def test_a_call_that_the_main_program_leaves_alone(world: World, capsys: Capture) -> None:
    def program(found: list[Any]) -> None:
        node = start()
        client = node.create_client(AddTwoInts, "add")
        threading.Thread(target=lambda: (client.wait_for_service(), client.call(Request()))).start()
        threading.Event().wait()

    assert "Its other threads are waiting as well: Thread-1 (<lambda>) waits for the call of /add." in told(
        world, program
    )


def test_a_rate_in_a_callback_of_the_only_thread_that_spins(world: World, capsys: Capture) -> None:
    def program(found: list[Any]) -> None:
        node, done = start(), threading.Event()
        rate = node.create_rate(2)
        node.create_timer(0.3, lambda: (rate.sleep(), done.set()))
        spin_in_thread(node)
        done.wait()

    assert "waiting for Event.wait() would never end" in told(world, program)
    assert "waiting for the next tick would never end" in capsys.readouterr().err
