"""Threads that a notebook's cell starts live in robot time; those that libraries start stay Python's own."""

from __future__ import annotations

import asyncio
import concurrent.futures
import queue
import sys
import textwrap
import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import rclpy

from turtle_lesson.ros.runtime.world import World, open_world
from turtle_lesson.ros.sim.errors import NeverWakes, SimulationError, WorldClosed
from turtle_lesson.ros.stdlib.locks import VirtualLock

SECOND = 1_000_000_000
Cell = Callable[..., dict[str, Any]]


@pytest.fixture
def cell(world: World) -> Cell:
    """Runs code as a cell does: in the module `__main__`. Returns its names."""
    main = vars(sys.modules["__main__"])
    before = set(main)

    def run(code: str, **names: Any) -> dict[str, Any]:
        main.update(names, world=world, threading=threading, time=time, queue=queue, rclpy=rclpy)
        exec(compile(textwrap.dedent(code), "<cell>", "exec", dont_inherit=True), main)
        return main

    yield run
    for name in set(main) - before:
        del main[name]


def test_a_thread_of_a_cell_sleeps_in_robot_time_and_lives_on(cell: Cell, world: World) -> None:
    names = cell(
        """
        log = []
        def work():
            for number in range(4):
                log.append((number, world.now / 1e9))
                time.sleep(1)
        thread = threading.Thread(target=work, daemon=True)
        thread.start()
        """
    )
    assert names["log"] == [(0, 0.0)], "it has begun, at this instant"
    world.sim.run_until(2 * SECOND)
    assert names["log"] == [(0, 0.0), (1, 1.0)]
    cell("thread.join(timeout=1.5)\nstill = thread.is_alive()\nthread.join()")
    assert names["still"] and not names["thread"].is_alive()
    assert world.now == 4 * SECOND


def test_rclpy_spins_in_a_thread_of_a_cell(cell: Cell, world: World) -> None:
    names = cell(
        """
        rclpy.init()
        node, ticks = rclpy.create_node("n"), []
        node.create_timer(0.25, lambda: ticks.append(world.now / 1e9))
        thread = threading.Thread(target=rclpy.spin, args=(node,), daemon=True)
        thread.start()
        """
    )
    world.sim.run_until(SECOND + 1)
    assert names["ticks"] == [0.25, 0.5, 0.75, 1.0]
    cell(
        """
        rate = node.create_rate(2)
        for _ in range(3):
            rate.sleep()
        """
    )
    assert world.now == pytest.approx(2.5 * SECOND, abs=10_000)
    assert len(names["ticks"]) in (9, 10)
    cell("rclpy.shutdown()\nthread.join()")
    assert not names["thread"].is_alive()


def test_what_a_cell_waits_for_lets_robot_time_pass(cell: Cell, world: World) -> None:
    names = cell(
        """
        from concurrent.futures import ThreadPoolExecutor
        line, event, lock, found = queue.Queue(), threading.Event(), threading.Lock(), []
        def work():
            with lock:
                time.sleep(1)
            line.put("hello")
            time.sleep(1)
            event.set()
            return "done"
        thread = threading.Thread(target=work)
        thread.start()
        with lock:
            found.append(round(world.now / 1e9, 3))
        found.append((line.get(), event.wait(0.5), event.wait()))
        try:
            line.get(timeout=0.5)
        except queue.Empty:
            found.append(round(world.now / 1e9, 3))
        with ThreadPoolExecutor(2) as pool:
            found.append((pool.submit(work).result(), list(pool.map(abs, [-1, 2]))))
        found.append(round(world.now / 1e9, 3))
        """
    )
    assert names["found"] == [1.0, ("hello", False, True), 2.5, ("done", [1, 2]), 4.5]


def test_a_cell_sleeps_in_robot_time_while_a_thread_of_a_cell_lives(cell: Cell, world: World) -> None:
    names = cell(
        """
        log = []
        def work():
            for number in range(3):
                time.sleep(0.4)
                log.append(number)
        threading.Thread(target=work).start()
        time.sleep(1.0)
        """
    )
    assert names["log"] == [0, 1] and world.now == pytest.approx(SECOND, abs=5_000)
    time.sleep(0.001)  # this is no cell
    assert world.now == pytest.approx(SECOND, abs=5_000)
    cell("time.sleep(1.0)\nbegan = time.monotonic()\ntime.sleep(0.05)\ntook = time.monotonic() - began")
    assert names["log"] == [0, 1, 2] and names["took"] >= 0.05, "nobody lives any more: it is real"
    assert world.now == pytest.approx(2 * SECOND, abs=10_000)


def test_a_cell_and_its_calls_are_one_thread(cell: Cell) -> None:
    names = cell(
        """
        lock, found = threading.RLock(), []
        main = threading.current_thread()
        def hold():
            with lock:
                time.sleep(1)
        threading.Thread(target=hold).start()
        with lock:                     # waits, and so lets robot time pass
            found.append(lock.acquire(blocking=False))
            found.append(threading.current_thread() is main)
            lock.release()
        """
    )
    assert names["found"] == [True, True] or names["found"] == [1, True]


def test_a_cell_that_waits_in_vain_is_told_so(cell: Cell) -> None:
    with pytest.raises(NeverWakes, match=r"waiting for Queue.get\(\) would never end"):
        cell("queue.Queue().get()")
    with pytest.raises(NeverWakes, match="this same thread has already taken it"):
        cell("lock = threading.Lock()\nwith lock:\n    with lock:\n        pass")


def test_an_error_in_a_thread_of_a_cell_is_shown(cell: Cell, world: World, capsys: pytest.CaptureFixture[str]) -> None:
    cell("threading.Thread(target=int, args='x', name='parser').start()")
    assert capsys.readouterr().err.startswith("Exception in thread parser:\nValueError: invalid literal")


def test_start_ends_the_threads_of_the_world_before(cell: Cell) -> None:
    names = cell(
        """
        lock = threading.Lock()
        def work():
            lock.acquire()
            time.sleep(100)
        thread = threading.Thread(target=work)
        thread.start()
        """
    )
    open_world()
    assert not names["thread"].is_alive()
    with pytest.raises(WorldClosed, match="make new locks, queues and threads in the new world"):
        cell("lock.acquire()")


def test_the_simulation_cannot_be_run_within_itself(cell: Cell, world: World) -> None:
    names = cell("lock = threading.Lock()\nlock.acquire()\nerrors = []")

    def blocks() -> None:
        try:
            names["lock"].acquire()
        except SimulationError as error:
            names["errors"].append(str(error))

    world.sim.call_later(1, blocks)
    world.sim.run_until(2)
    assert names["errors"] == ["the simulation runs already: a callback cannot run it once more"]


def test_files_beside_the_notebook_are_the_learners_too(
    cell: Cell, world: World, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "my_helper.py").write_text("import threading\ndef make():\n    return threading.Lock()\n")
    monkeypatch.chdir(tmp_path)
    monkeypatch.syspath_prepend(tmp_path)
    names = cell("from my_helper import make\nlock = make()")
    assert type(names["lock"]) is VirtualLock
    del sys.modules["my_helper"]


# ---------------------------------------------------------------- what stays Python's own


def test_this_test_is_no_cell_so_its_threads_are_real(world: World) -> None:
    began, thread = time.monotonic(), threading.Thread(target=time.sleep, args=(0.2,))
    thread.start()
    assert thread.is_alive() and thread in threading.enumerate()
    thread.join()
    assert time.monotonic() - began >= 0.2 and world.now == 0
    assert type(threading.Lock()) is type(threading._allocate_lock())
    assert type(threading.RLock()) is threading._CRLock


def test_what_a_cell_has_libraries_start_is_real(cell: Cell) -> None:
    names = cell(
        """
        import asyncio
        async def main():
            name = await asyncio.to_thread(lambda: threading.current_thread().name)
            await asyncio.sleep(0.01)
            return name, type(asyncio.get_running_loop()).__module__
        found = asyncio.run(main())
        """
    )
    assert names["found"][0].startswith("asyncio_")
    assert names["found"][1] == "asyncio.unix_events" or sys.platform != "linux"


def test_without_a_world_a_cells_threads_are_real(cell: Cell, world: World, monkeypatch: pytest.MonkeyPatch) -> None:
    world.close()
    names = cell("thread = threading.Thread(target=time.sleep, args=(0.01,))\nthread.start()\nthread.join()")
    assert "_strand" not in vars(names["thread"])


def test_a_cell_that_runs_in_a_real_thread_gets_real_locks(cell: Cell) -> None:
    names = cell("def make():\n    return threading.Lock(), threading.current_thread().name")
    with concurrent.futures.ThreadPoolExecutor(1, thread_name_prefix="real") as pool:
        lock, name = pool.submit(names["make"]).result()
    assert type(lock) is not VirtualLock and name == "real_0"


def test_types_are_what_they_were(world: World) -> None:
    assert isinstance(threading.Lock(), threading.Lock if isinstance(threading.Lock, type) else object)
    assert isinstance(queue.SimpleQueue(), queue.SimpleQueue)
    assert type(queue.SimpleQueue()).__module__ == "_queue"
    assert str(queue.SimpleQueue[int]) == "_queue.SimpleQueue[int]"
    assert isinstance(threading.local(), threading.local)

    class Mine(threading.local):
        number = 1

        def __init__(self, word: str) -> None:
            self.word = word

    mine = Mine("hello")
    assert isinstance(mine, threading.local) and issubclass(Mine, threading.local) and type(Mine) is type
    assert (mine.number, mine.word) == (1, "hello")
    assert threading.Thread.start.__qualname__ == "Thread.start"
    assert threading.get_ident.__name__ == "get_ident"

    class Clock:
        now, sleep = time.monotonic, time.sleep  # as builtins are, they are not bound

    assert Clock().now() > 0 and Clock().sleep(0) is None


def test_real_threads_may_use_what_a_program_has_made(world: World) -> None:
    """A lock that a program has made, and that it gave away, excludes threads of the real computer from one another."""
    made: list[Any] = []
    world.spawn(lambda: made.extend([threading.Lock(), threading.Event(), queue.Queue()]), name="program")
    world.sim.run_until(1)
    lock, event, line = made

    def work() -> None:
        for _ in range(200):
            with lock:
                value = counts[0]
                time.sleep(0)
                counts[0] = value + 1
        line.put("done")

    counts = [0]
    threads = [threading.Thread(target=work) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert counts == [800] and line.qsize() == 4
    threading.Timer(0.05, event.set).start()
    waiter: list[bool] = []
    thread = threading.Thread(target=lambda: waiter.append(event.wait(500)))
    thread.start()
    thread.join()
    assert waiter == [True]


def test_a_loop_outside_is_python_own(world: World) -> None:
    loop = asyncio.new_event_loop()
    assert type(loop).__module__.startswith("asyncio.")
    assert loop.run_until_complete(loop.run_in_executor(None, threading.get_ident)) != threading.get_ident()
    loop.close()
