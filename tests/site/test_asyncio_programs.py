"""asyncio in a simulated process: Python's own loop, in virtual time, in its own line of execution."""

from __future__ import annotations

import asyncio
import contextvars
import sys
import threading
import time
from collections.abc import Callable
from typing import Any

import numpy
import pytest
import rclpy

from turtle_lesson.ros.runtime.world import World

Run = Callable[..., list[Any]]
SECOND = 1_000_000_000


def stop_watch() -> Callable[[], float]:
    """Seconds since now, with two decimals."""
    began = time.time()
    return lambda: round(time.time() - began, 2)


def test_tasks_sleep_side_by_side(run: Run) -> None:
    def program(found: list[Any]) -> None:
        now = stop_watch()

        async def work(seconds: float) -> float:
            await asyncio.sleep(seconds)
            found.append((seconds, now()))
            return seconds

        async def main() -> str:
            found.append(await asyncio.gather(work(2), work(1), work(3)))
            return "done"

        found.append((asyncio.run(main()), now()))

    assert run(program) == [(1, 1.0), (2, 2.0), (3, 3.0), [2, 1, 3], ("done", 3.0)]


def test_time_limits_queues_and_events(run: Run) -> None:
    def program(found: list[Any]) -> None:
        now = stop_watch()

        async def produce(line: asyncio.Queue[int], ready: asyncio.Event) -> None:
            for number in range(3):
                await asyncio.sleep(0.5)
                await line.put(number)
            ready.set()

        async def main() -> None:
            line: asyncio.Queue[int] = asyncio.Queue()
            ready = asyncio.Event()
            task = asyncio.create_task(produce(line, ready))
            with pytest.raises(asyncio.TimeoutError):
                await asyncio.wait_for(ready.wait(), timeout=0.25)
            found.extend([(await line.get(), now()) for _ in range(3)])
            await ready.wait()
            await task
            async with asyncio.timeout(1):
                await asyncio.sleep(0.5)
            async with asyncio.TaskGroup() as group:
                group.create_task(asyncio.sleep(1))
            found.append((task.get_name(), now()))

        asyncio.run(main())

    assert run(program) == [(0, 0.5), (1, 1.0), (2, 1.5), ("Task-2", 3.0)]


def test_a_loop_that_never_waits_lets_time_pass_all_the_same(run: Run) -> None:
    def program(found: list[Any]) -> None:
        async def main() -> None:
            end = asyncio.get_running_loop().time() + 0.01
            while asyncio.get_running_loop().time() < end:
                await asyncio.sleep(0)

        asyncio.run(main())
        found.append("ended")

    assert run(program) == ["ended"]


def test_work_for_other_threads_and_calls_from_them(run: Run) -> None:
    def program(found: list[Any]) -> None:
        now = stop_watch()

        def slow(seconds: float) -> str:
            time.sleep(seconds)
            return threading.current_thread().name

        async def main() -> None:
            loop = asyncio.get_running_loop()
            called, doubled = asyncio.Event(), []

            async def double(number: int) -> int:
                await asyncio.sleep(1)
                return 2 * number

            def elsewhere() -> None:
                time.sleep(1)
                loop.call_soon_threadsafe(called.set)
                doubled.append(asyncio.run_coroutine_threadsafe(double(21), loop).result())

            names = await asyncio.gather(loop.run_in_executor(None, slow, 2), asyncio.to_thread(slow, 2))
            found.append((names, now()))
            thread = threading.Thread(target=elsewhere)
            thread.start()
            await called.wait()
            found.append(now())
            await asyncio.sleep(1.5)
            found.append((doubled, now()))

        asyncio.run(main())

    assert run(program) == [(["asyncio_0", "asyncio_1"], 2.0), 3.0, ([42], 4.5)]


def test_a_loop_in_a_thread(run: Run) -> None:
    def program(found: list[Any]) -> None:
        with pytest.raises(RuntimeError, match="no running event loop"):
            asyncio.get_running_loop()
        loop = asyncio.new_event_loop()
        thread = threading.Thread(target=loop.run_forever)
        thread.start()
        future = asyncio.run_coroutine_threadsafe(asyncio.sleep(1, "slept"), loop)
        found.append(future.result(timeout=5))
        loop.call_soon_threadsafe(loop.stop)
        thread.join()
        loop.close()
        found.append(loop.is_closed())

    assert run(program) == ["slept", True]


def test_the_old_ways_to_a_loop(run: Run) -> None:
    def program(found: list[Any]) -> None:
        loop = asyncio.get_event_loop()
        assert asyncio.get_event_loop() is loop
        found.append(loop.run_until_complete(asyncio.sleep(1, "slept")))
        asyncio.set_event_loop(None)
        with pytest.raises(RuntimeError, match="There is no current event loop in thread 'MainThread'"):
            asyncio.get_event_loop()
        loop.close()

    assert run(program) == ["slept"]


def test_a_loop_is_seen_by_its_own_program_alone(run: Run) -> None:
    def looped(found: list[Any]) -> None:
        async def main() -> None:
            for _ in range(5):
                time.sleep(0.1)  # which holds up the loop, and lets the others go on
                await asyncio.sleep(0.1)
            found.append([number async for number in numbers()])

        async def numbers() -> Any:
            yield 1
            time.sleep(0.5)
            yield 2

        asyncio.run(main())

    def other(found: list[Any]) -> None:
        for _ in range(20):
            assert asyncio._get_running_loop() is None
            assert sys.get_asyncgen_hooks() == (None, None)
            time.sleep(0.07)

    hooks = sys.get_asyncgen_hooks()
    assert run(looped, other, looped) == [[1, 2], [1, 2]]
    assert sys.get_asyncgen_hooks() == hooks


def test_tasks_have_contexts_of_their_own(run: Run) -> None:
    number = contextvars.ContextVar("number", default=0)

    def program(found: list[Any]) -> None:
        async def work(value: int) -> None:
            number.set(value)
            with numpy.errstate(divide="raise" if value else "ignore"):
                await asyncio.sleep(1)
                time.sleep(0.1)
                found.append((number.get(), numpy.geterr()["divide"]))

        async def main() -> None:
            await asyncio.gather(work(0), work(1))

        asyncio.run(main())
        found.append(number.get())

    assert run(program) == [(0, "ignore"), (1, "raise"), 0]


def test_what_tasks_print_goes_to_the_cell_that_runs_them(world: World) -> None:
    cell = contextvars.ContextVar("cell", default="none")
    log: list[Any] = []

    def program() -> None:
        async def tick(name: str) -> None:
            for _ in range(3):
                log.append((name, cell.get()))
                await asyncio.sleep(1)

        async def main() -> None:
            asyncio.get_running_loop().call_later(1.5, lambda: log.append(("later", cell.get())))
            await asyncio.gather(tick("a"), tick("b"))

        asyncio.run(main())

    world.spawn(program, name="program")
    for name in ("first", "second", "third"):
        cell.set(name)
        world.sim.run_until(world.now + SECOND)
    assert log == [
        ("a", "first"),
        ("b", "first"),
        ("a", "second"),
        ("b", "second"),
        ("later", "second"),
        ("a", "third"),
        ("b", "third"),
    ]


def test_ctrl_c_cancels_the_main_task(world: World) -> None:
    log: list[str] = []

    async def main() -> None:
        try:
            await asyncio.sleep(1000)
        finally:
            log.append("cleaning up")
            await asyncio.sleep(0.5)
            log.append("cleaned up")

    process = world.spawn(lambda: asyncio.run(main()), name="program")
    world.sim.run_until(SECOND)
    process.interrupt()
    world.sim.run_until(3 * SECOND)
    assert log == ["cleaning up", "cleaned up"]
    assert process.exit_code == -2


def test_a_signal_wakes_a_loop(world: World) -> None:
    import signal

    log: list[float] = []

    async def main() -> None:
        stop, loop = asyncio.Event(), asyncio.get_running_loop()
        with pytest.raises(NotImplementedError, match=r"signal\.signal"):
            loop.add_signal_handler(signal.SIGTERM, stop.set)
        signal.signal(signal.SIGTERM, lambda *_: loop.call_soon_threadsafe(stop.set))
        await stop.wait()
        log.append(world.now / SECOND)

    process = world.spawn(lambda: asyncio.run(main()), name="program")
    world.sim.run_until(2 * SECOND)
    process.send_signal(signal.SIGTERM)
    world.sim.run_until(3 * SECOND)
    assert log == [pytest.approx(2.0)] and process.exit_code == 0


def test_what_the_real_computer_would_be_needed_for_is_refused(run: Run) -> None:
    def program(found: list[Any]) -> None:
        async def main() -> None:
            with pytest.raises(NotImplementedError, match="not possible here: files, sockets"):
                await asyncio.open_connection("localhost", 80)
            with pytest.raises(NotImplementedError, match="processes of the real computer"):
                await asyncio.create_subprocess_exec("true")

        asyncio.run(main())
        found.append("refused")

    assert run(program) == ["refused"]


# ---------------------------------------------------------------- beside rclpy


def test_a_task_may_spin_a_node_between_others(run: Run) -> None:
    def program(found: list[Any]) -> None:
        rclpy.init()
        node = rclpy.create_node("n")
        node.create_timer(0.5, lambda: found.append("tick"))

        async def spin() -> None:
            while rclpy.ok():
                rclpy.spin_once(node, timeout_sec=0)
                await asyncio.sleep(0.01)

        async def main() -> None:
            spinning = asyncio.create_task(spin())
            await asyncio.sleep(1.6)
            found.append("slept")
            spinning.cancel()

        asyncio.run(main())

    assert run(program) == ["tick", "tick", "tick", "slept"]


def test_a_callback_of_a_node_that_is_spun_in_a_task_finds_the_loop(world: World) -> None:
    found: list[bool] = []

    async def main() -> None:
        rclpy.init()
        node, loop = rclpy.create_node("node"), asyncio.get_running_loop()

        def tick() -> None:
            found.append(asyncio.get_running_loop() is loop)
            if len(found) == 3:
                rclpy.shutdown()

        node.create_timer(1.0, tick)
        rclpy.spin(node)

    world.spawn(lambda: asyncio.run(main()), name="node")
    world.spawn(lambda: [time.sleep(0.3) for _ in range(20)], name="sleeps")
    world.sim.run_until(3_500_000_000)
    assert found == [True, True, True]


def test_a_loop_in_a_thread_beside_a_node_that_spins(run: Run) -> None:
    def program(found: list[Any]) -> None:
        rclpy.init()
        node, loop = rclpy.create_node("n"), asyncio.new_event_loop()
        threading.Thread(target=loop.run_forever, daemon=True).start()

        async def answer(number: int) -> None:
            await asyncio.sleep(0.25)
            found.append((number, round(time.time() % 60, 2)))

        numbers = iter(range(3))
        node.create_timer(1.0, lambda: asyncio.run_coroutine_threadsafe(answer(next(numbers)), loop))
        node.create_timer(3.5, rclpy.shutdown)
        rclpy.spin(node)

    assert run(program) == [(0, 1.25), (1, 2.25), (2, 3.25)]


def test_asyncio_does_not_run_in_callbacks_of_a_node(run: Run) -> None:
    def program(found: list[Any]) -> None:
        rclpy.init()
        node = rclpy.create_node("n")

        async def callback() -> None:
            await asyncio.sleep(0.1)

        node.create_timer(0.1, callback)
        with pytest.raises(RuntimeError, match=r"^no running event loop"):
            rclpy.spin(node)
        found.append("told")

    assert run(program) == ["told"]
