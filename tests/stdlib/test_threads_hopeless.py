"""What can never wake is found at once and explained; what merely looks hopeless is left alone."""

from __future__ import annotations

import asyncio
import queue
import signal
import threading
import time
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from typing import Any

import pytest

from turtle_lesson.ros.runtime.world import World
from turtle_lesson.ros.sim.errors import NeverWakes

SECOND = 1_000_000_000
Capture = pytest.CaptureFixture[str]


def thread(target: Callable[..., object], *args: Any, **keywords: Any) -> threading.Thread:
    """A thread that has been started."""
    made = threading.Thread(target=target, args=args, **keywords)
    made.start()
    return made


@pytest.fixture
def why(world: World) -> Callable[[Callable[[], object]], str]:
    """Runs a program, and returns what it is told when it waits in vain."""

    def run(program: Callable[[], object]) -> str:
        process = world.spawn(program, name="program")
        world.sim.run_until(100 * SECOND)
        assert isinstance(process.error, NeverWakes), process
        return str(process.error)

    return run


Why = Callable[[Callable[[], object]], str]


@pytest.mark.parametrize(
    ("wait", "name"),
    [
        (lambda: queue.Queue().get(), "Queue.get"),
        (lambda: queue.SimpleQueue().get(), "SimpleQueue.get"),
        (lambda: threading.Event().wait(), "Event.wait"),
        (lambda: threading.Barrier(2).wait(), "Barrier.wait"),
        (lambda: threading.Semaphore(0).acquire(), "Semaphore.acquire"),
        (lambda: Future().result(), "Future.result"),
    ],
)
def test_who_is_alone_waits_for_nobody(why: Why, wait: Callable[[], object], name: str) -> None:
    assert why(wait) == (
        f"waiting for {name}() would never end: nothing is left in this program that could end it. It has no other thread."
    )


def test_a_condition_that_nobody_notifies(why: Why) -> None:
    def program() -> None:
        condition = threading.Condition()
        with condition:
            condition.wait()

    assert why(program).startswith("waiting for Condition.wait() would never end: nothing is left in this program")


def test_a_full_queue_that_nobody_empties(why: Why) -> None:
    def program() -> None:
        line: queue.Queue[int] = queue.Queue(maxsize=1)
        line.put(1)
        line.put(2)

    assert why(program).startswith("waiting for Queue.put() would never end")


def test_a_lock_taken_twice_by_the_same_thread_although_others_are_busy(why: Why) -> None:
    def program() -> None:
        thread(time.sleep, 50)
        lock = threading.Lock()
        with lock, lock:
            pass

    assert why(program) == (
        "waiting for the lock would never end: this same thread has already taken it. Release it first, or use "
        "threading.RLock(), which the same thread may take again."
    )


def test_a_lock_of_a_thread_that_has_ended_although_others_are_busy(why: Why) -> None:
    def program() -> None:
        thread(time.sleep, 50)
        lock = threading.RLock()
        thread(lock.acquire).join()
        lock.acquire()

    assert why(program).endswith("would never end: Thread-2 (acquire) has ended without releasing it.")


@pytest.mark.parametrize("kind", ["Lock", "RLock"])
def test_two_threads_that_take_two_locks_in_different_order(why: Why, kind: str) -> None:
    def program() -> None:
        a, b = getattr(threading, kind)(), getattr(threading, kind)()
        thread(time.sleep, 50)

        def other() -> None:
            with b:
                time.sleep(1)
                with a:
                    pass

        thread(other)
        with a:
            time.sleep(2)
            with b:
                pass

    assert why(program) == (
        "waiting for the lock would never end: MainThread waits for what Thread-2 (other) has, and Thread-2 (other) waits "
        "for what MainThread has. If all threads take locks in the same order, that cannot happen."
    )


def test_the_only_one_who_could_help_fails(why: Why, capsys: Capture) -> None:
    def program() -> None:
        line: queue.Queue[int] = queue.Queue()
        thread(lambda: (time.sleep(1), 1 / 0))
        line.get()

    assert why(program).startswith("waiting for Queue.get() would never end")
    assert "ZeroDivisionError" in capsys.readouterr().err


def test_a_program_that_waits_for_a_thread_that_waits_in_vain(world: World, capsys: Capture) -> None:
    """The error is raised where the fault is: in the thread. The main program then goes on."""
    log: list[str] = []

    def program() -> None:
        line: queue.Queue[int] = queue.Queue()
        thread(lambda: (time.sleep(1), line.get())).join()
        log.append("main goes on")

    process = world.spawn(program, name="program")
    world.sim.run_until(5 * SECOND)
    assert log == ["main goes on"] and process.exit_code == 0
    error = capsys.readouterr().err
    assert "Exception in thread Thread-1 (<lambda>):" in error
    assert "Its other threads are waiting as well: MainThread waits for Thread.join()." in error


def test_an_asyncio_loop_whose_tasks_wait_for_one_another(why: Why) -> None:
    async def main() -> None:
        await asyncio.Event().wait()

    assert why(lambda: asyncio.run(main())).startswith("this asyncio loop would wait forever: all of its tasks wait")


def test_it_can_be_caught_and_locks_are_given_back(world: World) -> None:
    log: list[Any] = []

    def program() -> None:
        event, lock = threading.Event(), threading.Lock()
        try:
            with lock:
                event.wait()
        except NeverWakes:
            log.append(lock.locked())

    world.spawn(program, name="program")
    world.sim.run_until(SECOND)
    assert log == [False]


# ---------------------------------------------------------------- nothing is said of these


def finishes(world: World, program: Callable[[], object], seconds: int = 100) -> bool:
    process = world.spawn(program, name="program")
    world.sim.run_until(seconds * SECOND)
    if process.error is not None:
        raise process.error
    return process.exit_code == 0


def test_somebody_sleeps_and_helps_then(world: World) -> None:
    def program() -> None:
        event = threading.Event()
        threading.Timer(50, event.set).start()
        event.wait()

    assert finishes(world, program)


def test_one_thread_of_many_helps_all(world: World) -> None:
    def program() -> None:
        first, second = queue.Queue(), queue.Queue()
        thread(lambda: second.put(first.get()))
        thread(lambda: (time.sleep(1), first.put(1)))
        assert second.get() == 1

    assert finishes(world, program)


def test_what_the_threads_of_a_pool_wait_for(why: Why) -> None:
    def program() -> None:
        pool = ThreadPoolExecutor(1, "pool")
        pool.submit(int).result()
        threading.Event().wait()

    assert why(program).endswith("Its other threads are waiting as well: pool_0 waits for SimpleQueue.get().")


def test_a_lock_that_another_thread_releases(world: World) -> None:
    def program() -> None:
        lock = threading.Lock()
        lock.acquire()
        thread(lambda: (time.sleep(1), lock.release()))
        lock.acquire()

    assert finishes(world, program)


def test_a_main_program_that_waits_for_ctrl_c(world: World) -> None:
    log: list[str] = []

    def program() -> None:
        stop = threading.Event()
        signal.signal(signal.SIGINT, lambda *_: stop.set())
        stop.wait()
        log.append("stopped")

    process = world.spawn(program, name="program")
    world.sim.run_until(SECOND)
    assert process.alive
    process.interrupt()
    assert log == ["stopped"] and process.exit_code == 0


def test_a_pool_that_rests(world: World) -> None:
    def program() -> None:
        pool = ThreadPoolExecutor(2)
        pool.submit(print, end="").result()
        time.sleep(10)
        assert pool.submit(int, "1").result() == 1

    assert finishes(world, program)
