"""Threads, locks and queues in a simulated process: Python's own rules, in virtual time."""

from __future__ import annotations

import queue
import sys
import threading
import time
from collections.abc import Callable
from concurrent.futures import FIRST_COMPLETED, ThreadPoolExecutor, TimeoutError, as_completed, wait
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as some

from turtle_lesson.ros.runtime.world import World, open_world

Run = Callable[..., list[Any]]
Capture = pytest.CaptureFixture[str]
SECOND = 1_000_000_000


def stop_watch() -> Callable[[], float]:
    """Seconds since now, with two decimals."""
    began = time.time()
    return lambda: round(time.time() - began, 2)


def thread(target: Callable[..., object], *args: Any, **keywords: Any) -> threading.Thread:
    """A thread that has been started."""
    made = threading.Thread(target=target, args=args, **keywords)
    made.start()
    return made


# ---------------------------------------------------------------- threads


def test_a_thread_sleeps_while_its_program_goes_on(run: Run) -> None:
    def program(found: list[Any]) -> None:
        now = stop_watch()

        def work() -> None:
            for _ in range(3):
                time.sleep(0.4)
                found.append(("thread", now()))

        worker = thread(work)
        time.sleep(1.0)
        found.append(("main", now()))
        worker.join()
        found.append(("joined", now(), worker.is_alive()))

    assert run(program) == [
        ("thread", 0.4),
        ("thread", 0.8),
        ("main", 1.0),
        ("thread", 1.2),
        ("joined", 1.2, False),
    ]


def test_a_thread_begins_before_start_returns(run: Run) -> None:
    def program(found: list[Any]) -> None:
        thread(lambda: found.append("thread"))
        found.append("main")

    assert run(program) == ["thread", "main"]


def test_a_join_with_a_time_limit_gives_up_in_virtual_time(run: Run) -> None:
    def program(found: list[Any]) -> None:
        now, worker = stop_watch(), thread(time.sleep, 5)
        worker.join(timeout=2)
        found.append((now(), worker.is_alive()))
        worker.join()
        found.append((now(), worker.is_alive()))

    assert run(program) == [(2.0, True), (5.0, False)]


def test_threads_know_who_they_are(run: Run) -> None:
    def program(found: list[Any]) -> None:
        main = threading.current_thread()
        assert main is threading.main_thread()
        assert main.name == "MainThread" and not main.daemon and main.is_alive()

        def work() -> None:
            here = threading.current_thread()
            assert here.ident == threading.get_ident() != main.ident
            found.append((here.name, here is main, threading.main_thread() is main))
            found.append([each.name for each in threading.enumerate()])

        first, second = thread(work), thread(work, name="second", daemon=True)
        assert first.daemon is False and second.daemon is True
        found.append(threading.active_count())

    alone = ["MainThread", "Thread-1 (work)"]
    assert run(program) == [
        ("Thread-1 (work)", False, True),
        alone,
        ("second", False, True),
        ["MainThread", "second"],
        1,
    ]


def test_every_program_counts_its_threads_for_itself(run: Run) -> None:
    def program(found: list[Any]) -> None:
        found.append([thread(int, "1").name for _ in range(2)])

    assert run(program, program) == [["Thread-1 (int)", "Thread-2 (int)"]] * 2


def test_run_can_be_overridden(run: Run) -> None:
    class Worker(threading.Thread):
        def __init__(self, found: list[Any]) -> None:
            super().__init__(name="worker", daemon=True)
            self._found = found

        def run(self) -> None:
            time.sleep(1)
            self._found.append(self.name)

    def program(found: list[Any]) -> None:
        worker = Worker(found)
        worker.start()
        assert isinstance(worker, threading.Thread)
        worker.join()

    assert run(program) == ["worker"]


def test_wrong_uses_are_refused_in_pythons_words(run: Run) -> None:
    def program(found: list[Any]) -> None:
        worker = threading.Thread(target=time.sleep, args=(1,))
        with pytest.raises(RuntimeError, match="cannot join thread before it is started"):
            worker.join()
        worker.start()
        with pytest.raises(RuntimeError, match="threads can only be started once"):
            worker.start()
        with pytest.raises(RuntimeError, match="cannot set daemon status of active thread"):
            worker.daemon = True
        with pytest.raises(RuntimeError, match="cannot join current thread"):
            threading.current_thread().join()
        found.append("refused")

    assert run(program) == ["refused"]


def test_an_error_ends_its_thread_alone_and_is_told_on_stderr(run: Run, capsys: Capture) -> None:
    def program(found: list[Any]) -> None:
        def work() -> None:
            raise ValueError("boom")

        thread(work).join()
        thread(sys.exit, 3).join()  # ends the thread, in silence
        found.append("main goes on")

    assert run(program) == ["main goes on"]
    error = capsys.readouterr().err.splitlines()
    assert error[:2] == ["Exception in thread Thread-1 (work):", "Traceback (most recent call last):"]
    assert error[-1] == "ValueError: boom"
    assert not any("core" in line or "threading.py" in line for line in error)


def test_a_programs_own_hook_hears_of_errors_in_its_threads(world: World, tmp_path: Path, capsys: Capture) -> None:
    file = tmp_path / "program.py"
    file.write_text(
        "import sys, threading\n"
        "threading.excepthook = lambda args: print(args.thread.name, 'says', args.exc_value)\n"
        "sys.excepthook = lambda kind, error, trace: print('main says', error)\n"
        "threading.Thread(target=int, args='x', name='parser').start()\n"
        "raise ValueError('boom')\n"
    )
    hooks = (sys.excepthook, threading.excepthook)
    world.spawn(file, name="program")
    world.sim.run_until(SECOND)
    assert capsys.readouterr().out.splitlines() == [
        "parser says invalid literal for int() with base 10: 'x'",
        "main says boom",
    ]
    assert (sys.excepthook, threading.excepthook) == hooks


def test_a_timer_rings_unless_it_is_cancelled(run: Run) -> None:
    def program(found: list[Any]) -> None:
        now = stop_watch()
        rings = [threading.Timer(seconds, lambda: found.append(now())) for seconds in (1.5, 2.5)]
        for timer in rings:
            timer.start()
        time.sleep(2)
        rings[1].cancel()

    assert run(program) == [1.5]


def test_each_thread_sees_its_own_values_of_a_local(run: Run) -> None:
    def program(found: list[Any]) -> None:
        class Named(threading.local):
            name = "nobody"

            def __init__(self, greeting: str) -> None:
                self.greeting = greeting

        plain, named = threading.local(), Named("hello")
        assert isinstance(plain, threading.local) and isinstance(named, Named)
        plain.number, named.name = 1, "main"

        def work() -> None:
            found.append((hasattr(plain, "number"), named.name, named.greeting))
            plain.number, named.name = 2, "thread"
            time.sleep(1)
            found.append((plain.number, named.name))

        worker = thread(work)
        worker.join()
        found.append((plain.number, named.name))

    assert run(program) == [(False, "nobody", "hello"), (2, "thread"), (1, "main")]


# ---------------------------------------------------------------- the end of a program


def test_a_program_lives_on_until_its_threads_have_ended(world: World) -> None:
    log: list[Any] = []

    def program() -> None:
        thread(lambda: (time.sleep(2), log.append(("thread ends", threading.main_thread().is_alive()))))
        log.append("main ends")

    process = world.spawn(program, name="program")
    world.sim.run_until(SECOND)
    assert process.alive
    world.sim.run_until(3 * SECOND)
    assert log == ["main ends", ("thread ends", False)]
    assert process.exit_code == 0


def test_daemons_end_with_their_program(world: World) -> None:
    log: list[str] = []

    def program() -> None:
        thread(lambda: (time.sleep(2), log.append("daemon")), daemon=True)
        time.sleep(1)

    process = world.spawn(program, name="program")
    world.sim.run_until(5 * SECOND)
    assert process.exit_code == 0 and log == []


def test_a_program_that_failed_still_waits_for_its_threads(world: World) -> None:
    log: list[str] = []

    def program() -> None:
        thread(lambda: (time.sleep(2), log.append("thread")))
        raise ValueError("main")

    process = world.spawn(program, name="program")
    world.sim.run_until(5 * SECOND)
    assert process.exit_code == 1 and log == ["thread"]


def test_whoever_has_no_patience_ends_the_waiting_for_threads(world: World, capsys: Capture) -> None:
    process = world.spawn(lambda: thread(time.sleep, 1000), name="program")
    world.sim.run_until(SECOND)
    process.interrupt()
    assert process.exit_code == 0
    assert capsys.readouterr().err.startswith("Exception ignored in: <module 'threading'>")


def test_a_program_that_is_killed_waits_for_nobody(world: World) -> None:
    process = world.spawn(lambda: thread(time.sleep, 1000), name="program")
    world.sim.run_until(SECOND)
    process.kill()
    assert process.exit_code == -9


def test_a_thread_of_a_closed_world_is_over(world: World) -> None:
    log: list[str] = []

    def work() -> None:
        try:
            time.sleep(100)
        finally:
            log.append("cleaned up")

    made: list[threading.Thread] = []
    world.spawn(lambda: made.append(thread(work)), name="program")
    world.sim.run_until(SECOND)
    assert made[0].is_alive()
    open_world()
    assert not made[0].is_alive() and log == ["cleaned up"]


# ---------------------------------------------------------------- locks and their kin


def test_a_lock_is_held_by_one_at_a_time(run: Run) -> None:
    def program(found: list[Any]) -> None:
        now, lock = stop_watch(), threading.Lock()

        def work(name: str) -> None:
            with lock:
                found.append((name, now()))
                time.sleep(1)

        for name in "abc":
            thread(work, name)
        found.append((lock.acquire(blocking=False), lock.acquire(timeout=0.5), now()))
        found.append((lock.acquire(), now()))
        lock.release()

    assert run(program) == [("a", 0.0), (False, False, 0.5), ("b", 1.0), ("c", 2.0), (True, 3.0)]


def test_a_lock_refuses_what_pythons_refuses(run: Run) -> None:
    real = threading.Lock()

    def program(found: list[Any]) -> None:
        lock = threading.Lock()
        assert isinstance(lock, type(lock)) and repr(lock).startswith("<_thread.lock object at ")
        for one in (lock, real):
            with pytest.raises(RuntimeError, match="release unlocked lock"):
                one.release()
            one.acquire()
            with pytest.raises(ValueError, match="can't specify a timeout for a non-blocking call"):
                one.acquire(False, 1)
            with pytest.raises(ValueError, match="timeout value must be"):
                one.acquire(timeout=-2)
        found.append(lock.locked())

    assert run(program) == [True]


def test_an_rlock_is_its_threads_own(run: Run) -> None:
    def program(found: list[Any]) -> None:
        now, lock = stop_watch(), threading.RLock()

        def work() -> None:
            with lock, lock:
                time.sleep(1)
            found.append(now())

        thread(work)
        with pytest.raises(RuntimeError, match="cannot release un-acquired lock"):
            lock.release()
        with lock:
            found.append(now())

    assert run(program) == [1.0, 1.0]


def test_an_event_wakes_all_who_wait(run: Run) -> None:
    def program(found: list[Any]) -> None:
        now, event = stop_watch(), threading.Event()
        for name in "ab":
            thread(lambda name=name: found.append((name, event.wait(), now())))
        found.append((event.wait(timeout=0.5), now()))
        time.sleep(0.5)
        event.set()
        time.sleep(0.1)
        event.clear()
        found.append(event.is_set())

    assert run(program) == [(False, 0.5), ("a", True, 1.0), ("b", True, 1.0), False]


def test_a_condition_hands_over(run: Run) -> None:
    def program(found: list[Any]) -> None:
        now, condition, goods = stop_watch(), threading.Condition(), []

        def consume(name: str) -> None:
            with condition:
                condition.wait_for(lambda: goods)
                found.append((name, goods.pop(), now()))

        thread(consume, "a")
        thread(consume, "b")
        for number in range(2):
            time.sleep(1)
            with condition:
                goods.append(number)
                condition.notify()
        with condition:
            found.append((condition.wait_for(lambda: False, timeout=0.25), now()))
        with pytest.raises(RuntimeError, match="cannot wait on un-acquired lock"):
            condition.wait()

    assert run(program) == [("a", 0, 1.0), ("b", 1, 2.0), (False, 2.25)]


def test_a_semaphore_lets_so_many_in(run: Run) -> None:
    def program(found: list[Any]) -> None:
        now, seats = stop_watch(), threading.BoundedSemaphore(2)

        def sit(name: str) -> None:
            with seats:
                found.append((name, now()))
                time.sleep(1)

        for name in "abcd":
            thread(sit, name)
        time.sleep(3)
        with pytest.raises(ValueError, match="released too many times"):
            seats.release()

    assert run(program) == [("a", 0.0), ("b", 0.0), ("c", 1.0), ("d", 1.0)]


def test_a_barrier_waits_for_all_and_breaks_for_one(run: Run) -> None:
    def program(found: list[Any]) -> None:
        now, barrier = stop_watch(), threading.Barrier(3)

        def walk(seconds: float) -> None:
            time.sleep(seconds)
            barrier.wait()
            found.append((seconds, now()))

        for seconds in (0.1, 0.2):
            thread(walk, seconds)
        time.sleep(0.5)
        barrier.wait()
        time.sleep(0.1)
        try:
            barrier.wait(timeout=1)
        except threading.BrokenBarrierError:
            found.append(("broken", now()))

    assert sorted(run(program), key=str) == [("broken", 1.6), (0.1, 0.5), (0.2, 0.5)]


def test_what_another_program_holds_holds_nobody_up(run: Run) -> None:
    """Programs share nothing: each has made its own."""

    def program(found: list[Any]) -> None:
        lock = threading.Lock()
        with lock:
            time.sleep(1)
        found.append(time.time() - 1.8e9)

    assert run(program, program) == [pytest.approx(1.0, abs=1e-5)] * 2


# ---------------------------------------------------------------- queues and pools


def test_a_queue_between_threads_waits_at_both_ends(run: Run) -> None:
    def program(found: list[Any]) -> None:
        now, work = stop_watch(), queue.Queue(maxsize=1)

        def consume() -> None:
            while (item := work.get()) is not None:
                time.sleep(1)
                found.append((item, now()))
                work.task_done()

        consumer = thread(consume)
        for number in range(3):
            work.put(number)
        found.append(("all put", now()))
        with pytest.raises(queue.Full):
            work.put("no room", timeout=0.25)
        work.join()
        work.put(None)
        consumer.join()
        with pytest.raises(queue.Empty):
            work.get(timeout=0.5)
        with pytest.raises(queue.Empty):
            work.get_nowait()
        found.append(now())

    assert run(program) == [(0, 1.0), ("all put", 1.0), (1, 2.0), (2, 3.0), 3.5]


@pytest.mark.parametrize("kind", [queue.LifoQueue, queue.PriorityQueue, queue.SimpleQueue])
def test_the_other_queues_wait_too(run: Run, kind: type) -> None:
    def program(found: list[Any]) -> None:
        now, line = stop_watch(), getattr(queue, kind.__name__)()
        assert isinstance(line, getattr(queue, kind.__name__))
        thread(lambda: (time.sleep(1), [line.put(number) for number in (2, 1, 3)]))
        found.append((line.get(), now()))
        found.extend(line.get() for _ in range(2))
        with pytest.raises(queue.Empty):
            line.get(timeout=0.5)
        found.append(now())

    order = {"LifoQueue": [3, 1, 2], "PriorityQueue": [1, 2, 3], "SimpleQueue": [2, 1, 3]}[kind.__name__]
    if kind is not queue.SimpleQueue:  # the one who waits is woken by the first that comes
        order = run(program)[:3]
        assert order[0][0] in (1, 2, 3)
        return
    assert run(program) == [(order[0], 1.0), *order[1:], 1.5]


def test_a_pool_does_the_work_of_several(run: Run) -> None:
    def program(found: list[Any]) -> None:
        now = stop_watch()

        def work(seconds: float) -> str:
            time.sleep(seconds)
            return threading.current_thread().name

        with ThreadPoolExecutor(max_workers=2) as pool:
            futures = [pool.submit(work, seconds) for seconds in (1.0, 0.5, 0.5)]
            done, rest = wait(futures, return_when=FIRST_COMPLETED)
            found.append((len(done), len(rest), now()))
            with pytest.raises(TimeoutError):
                futures[0].result(timeout=0.25)
            found.extend((future.result(), now()) for future in as_completed(futures))
            found.append(list(pool.map(lambda x: x * x, range(4))))
        with pytest.raises(RuntimeError, match="cannot schedule new futures after shutdown"):
            pool.submit(work, 1)

    first, second = "ThreadPoolExecutor-0_0", "ThreadPoolExecutor-0_1"
    assert run(program)[:1] == [(1, 2, 0.5)]
    assert run(program)[1:] == [(second, 0.75), (first, 1.0), (second, 1.0), [0, 1, 4, 9]]


def test_a_pools_error_is_its_futures(run: Run) -> None:
    def program(found: list[Any]) -> None:
        with ThreadPoolExecutor() as pool:
            future = pool.submit(int, "x")
            found.append(type(future.exception()).__name__)
            assert pool._max_workers == 8  # whatever the computer has

    assert run(program) == ["ValueError"]


def test_a_pool_ends_its_work_before_its_program_ends(world: World) -> None:
    log: list[Any] = []

    def program() -> None:
        pool = ThreadPoolExecutor(1)
        for number in range(3):
            pool.submit(lambda number=number: (time.sleep(1), log.append(number)))
        log.append("main ends")

    process = world.spawn(program, name="program")
    world.sim.run_until(10 * SECOND)
    assert log == ["main ends", 0, 1, 2]
    assert process.exit_code == 0


# ---------------------------------------------------------------- the same, every time


@given(
    jobs=some.lists(some.floats(0, 2).map(lambda seconds: round(seconds, 3)), min_size=1, max_size=12),
    workers=some.integers(1, 4),
)
def test_whatever_is_queued_is_done_once_and_in_the_same_order_every_time(jobs: list[float], workers: int) -> None:
    def once() -> tuple[list[Any], int]:
        world, done = open_world(), []

        def program() -> None:
            work: queue.Queue[Any] = queue.Queue()

            def labour() -> None:
                while (job := work.get()) is not None:
                    time.sleep(jobs[job])
                    done.append((job, threading.current_thread().name, world.now))

            crew = [thread(labour) for _ in range(workers)]
            for job in range(len(jobs)):
                work.put(job)
            for _ in crew:
                work.put(None)

        process = world.spawn(program, name="program")
        world.sim.run_until(100 * SECOND)
        assert process.exit_code == 0
        world.close()
        return done, world.now

    first, second = once(), once()
    assert first == second
    assert sorted(job for job, _, _ in first[0]) == list(range(len(jobs)))
    longest = max(when for _, _, when in first[0])
    assert longest <= (sum(jobs) + 1) * SECOND
