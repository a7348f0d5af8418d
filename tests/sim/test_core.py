"""The simulation's core, told as stories: clocks, sleeping, order, interrupts, and programs that misbehave."""

from __future__ import annotations

import contextvars
import gc
import os
import random
import signal
import sys
import threading
import time
from pathlib import Path

import pytest

from turtle_lesson.ros.runtime.world import World, open_world
from turtle_lesson.ros.sim import interrupts
from turtle_lesson.ros.sim.errors import DriveTimeout, NeverReturns, NeverWakes, OutOfTime, SimulationError, WorldClosed
from turtle_lesson.ros.sim.run_blocking import drive
from turtle_lesson.ros.sim.simulation import EPOCH

SECOND = 1_000_000_000


@pytest.fixture
def world():
    world = open_world()
    yield world
    world.close()


def test_sleepers_wake_in_the_order_of_their_times(world: World) -> None:
    log = []

    def sleeper(name: str, seconds: float):
        def main() -> None:
            for _ in range(3):
                time.sleep(seconds)
                log.append((name, world.now / SECOND))

        return main

    world.spawn(sleeper("slow", 0.5), name="slow")
    world.spawn(sleeper("fast", 0.2), name="fast")
    world.sim.run_until(2 * SECOND)

    assert log == [("fast", 0.2), ("fast", 0.4), ("slow", 0.5), ("fast", 0.6), ("slow", 1.0), ("slow", 1.5)]


def test_a_run_is_half_open(world: World) -> None:
    log = []

    def main() -> None:
        time.sleep(1.0)
        log.append("woke")

    world.spawn(main, name="main")
    world.sim.run_until(SECOND)
    assert log == []
    world.sim.run_until(SECOND + 1)
    assert log == ["woke"]


def test_inside_a_process_time_is_virtual_and_outside_it_is_real(world: World) -> None:
    seen: dict[str, float] = {}

    def main() -> None:
        time.sleep(3600.0)
        seen.update(time=time.time(), monotonic=time.monotonic(), counter=time.perf_counter(), ns=time.time_ns())

    before = time.monotonic()
    world.spawn(main, name="main")
    world.sim.run_until(3601 * SECOND)

    assert time.monotonic() - before < 60
    assert abs(time.time() - time.time_ns() / 1e9) < 1
    assert seen["time"] == pytest.approx(EPOCH / SECOND + 3600, abs=1e-3)
    assert seen["monotonic"] == pytest.approx(3600, abs=1e-3)
    assert seen["counter"] == pytest.approx(3600, abs=1e-3)
    assert seen["ns"] == EPOCH + 3600 * SECOND + 4_000  # the fourth look at a clock, 1 µs each


def test_a_busy_wait_ends_and_lets_others_go_on(world: World) -> None:
    log = []

    def waits() -> None:
        end = time.time() + 0.01
        while time.time() < end:
            pass
        log.append("waited")

    def sleeps() -> None:
        time.sleep(0.005)
        log.append("slept")

    world.spawn(waits, name="waits")
    world.spawn(sleeps, name="sleeps")
    world.sim.run_until(SECOND)
    assert log == ["slept", "waited"]


def test_sleeping_zero_lets_the_others_of_this_instant_go_first(world: World) -> None:
    log = []

    def main(name: str):
        def run() -> None:
            log.append(f"{name}1")
            time.sleep(0)
            log.append(f"{name}2")

        return run

    world.spawn(main("a"), name="a")
    world.spawn(main("b"), name="b")
    world.sim.run_until(10_000)
    assert log == ["a1", "b1", "a2", "b2"]


def test_sleeping_a_negative_time_is_refused_as_python_does(world: World) -> None:
    process = world.spawn(lambda: time.sleep(-1), name="main")
    world.sim.run_until(1)
    assert isinstance(process.error, ValueError)


def test_every_process_has_random_numbers_of_its_own() -> None:
    def draws(seed: int, names: list[str]) -> dict[str, list[float]]:
        world = open_world(seed)
        drawn: dict[str, list[float]] = {}
        for name in names:

            def main(name: str = name) -> None:
                for _ in range(3):
                    drawn.setdefault(name, []).append(random.random())
                    time.sleep(0.1)

            world.spawn(main, name=name)
        world.sim.run_until(SECOND)
        world.close()
        return drawn

    alone = draws(7, ["a"])
    together = draws(7, ["b", "a"])
    assert alone["a"] == together["a"] != together["b"]
    assert draws(8, ["a"]) != alone


def test_random_numbers_outside_are_the_usual_ones(world: World) -> None:
    random.seed(5)
    first = random.random()
    world.spawn(lambda: random.seed(1), name="main")
    world.sim.run_until(1)
    random.seed(5)
    assert random.random() == first


def test_numpys_random_numbers_are_seeded_too() -> None:
    import numpy

    def draw() -> list[float]:
        world = open_world(3)
        drawn: list[float] = []
        world.spawn(lambda: drawn.extend([numpy.random.rand(), numpy.random.default_rng().random()]), name="main")
        world.sim.run_until(1)
        world.close()
        return drawn

    assert draw() == draw()
    assert numpy.random.default_rng().random() != numpy.random.default_rng().random()


def test_exit_codes_are_pythons(world: World, capsys: pytest.CaptureFixture[str]) -> None:
    def fails() -> None:
        raise ValueError("boom")

    def waits() -> None:
        time.sleep(100)

    programs = {
        "returns": lambda: None,
        "exits": lambda: sys.exit(3),
        "says": lambda: sys.exit("no"),
        "fails": fails,
    }
    processes = {name: world.spawn(program, name=name) for name, program in programs.items()}
    processes["waits"] = world.spawn(waits, name="waits")
    world.sim.run_until(SECOND)
    assert processes["waits"].exit_code is None
    processes["waits"].interrupt()

    codes = {name: process.exit_code for name, process in processes.items()}
    assert codes == {"returns": 0, "exits": 3, "says": 1, "fails": 1, "waits": -2}
    assert "ValueError: boom" in capsys.readouterr().err


def test_each_process_has_its_own_arguments(world: World, tmp_path: Path) -> None:
    program = tmp_path / "program.py"
    program.write_text("import sys, time\nprint(sys.argv)\ntime.sleep(1)\nprint(sys.argv, __name__)\n")
    before = list(sys.argv)
    world.spawn(program, name="one", argv=["program.py", "1"])
    world.spawn(program, name="two", argv=["program.py", "2"])
    world.sim.run_until(2 * SECOND)
    assert sys.argv == before


def test_a_traceback_ends_at_the_learners_line(world: World, tmp_path: Path, capsys) -> None:
    program = tmp_path / "broken.py"
    program.write_text(
        "import rclpy\n"
        "from rclpy.node import Node\n"
        "def main():\n"
        "    rclpy.init()\n"
        "    node = Node('broken')\n"
        "    node.create_timer(0.1, lambda: node.get_parameter('speed'))\n"
        "    rclpy.spin(node)\n"
        "main()\n"
    )
    world.spawn(program, name="broken")
    world.sim.run_until(SECOND)
    lines = capsys.readouterr().err.splitlines()
    assert lines[0] == "Traceback (most recent call last):"
    assert [line.split(", ", 1)[1] for line in lines if line.startswith("  File")] == [
        "line 8, in <module>",
        "line 7, in main",
        "line 6, in <lambda>",
    ]
    last = lines.index("    node.create_timer(0.1, lambda: node.get_parameter('speed'))")
    assert lines[last + 1].startswith("rclpy.exceptions.ParameterNotDeclaredException")


def test_what_a_process_prints_goes_to_the_cell_that_runs_it(world: World) -> None:
    cell = contextvars.ContextVar("cell", default="none")
    printed = []

    def main() -> None:
        while True:
            printed.append(cell.get())
            time.sleep(1)

    world.spawn(main, name="main")
    for name in ("first", "second"):
        cell.set(name)
        world.sim.run_until(world.now + SECOND)
    assert printed == ["first", "second"]


@pytest.mark.skipif(threading.current_thread() is not threading.main_thread(), reason="signals need the main thread")
def test_an_interrupt_pauses_the_world_and_the_next_run_goes_on(world: World) -> None:
    log: list[int] = []

    def main() -> None:
        for number in range(1_000_000):
            log.append(number)
            if number == 100:
                os.kill(os.getpid(), signal.SIGINT)
            time.sleep(0.001)

    process = world.spawn(main, name="main")
    with pytest.raises(KeyboardInterrupt):
        world.sim.run_until(10 * SECOND)
    assert log[-1] == 100
    assert process.alive
    assert world.now < SECOND
    world.sim.run_until(SECOND)
    assert log == list(range(1000))


def test_a_callback_that_never_ends_is_found_and_explained(world: World, monkeypatch, capsys) -> None:
    monkeypatch.setattr(interrupts, "patience", 0.2)
    log = []

    def never_ends() -> None:
        while True:
            pass

    def others() -> None:
        time.sleep(0.5)
        log.append("the others go on")

    process = world.spawn(never_ends, name="never_ends")
    world.spawn(others, name="others")
    world.sim.run_until(SECOND)
    assert isinstance(process.error, NeverReturns)
    assert log == ["the others go on"]
    error = capsys.readouterr().err
    assert "never_ends has computed for 0.2 s without letting any time pass" in error
    assert "in never_ends" in error


def test_one_that_swallows_every_error_is_given_up(world: World, monkeypatch, capsys) -> None:
    monkeypatch.setattr(interrupts, "patience", 0.1)

    def stubborn() -> None:
        while True:
            try:
                while True:
                    pass
            except BaseException:
                pass

    process = world.spawn(stubborn, name="stubborn")
    world.sim.run_until(SECOND)
    assert not process.alive
    assert "given up" in capsys.readouterr().err
    assert world.now == SECOND


def test_a_cell_can_drive_the_world_until_a_call_is_done(world: World) -> None:
    def call(seconds: float) -> str:
        time.sleep(seconds)
        return f"slept until {world.now / SECOND:g}"

    assert drive(world.notebook, call, 2.5) == "slept until 2.5"


def test_a_cell_that_waits_for_nothing_is_told_so(world: World) -> None:
    def waits() -> None:
        from turtle_lesson.ros.sim.strand import running_strand

        strand = running_strand()
        assert strand is not None
        strand.park()

    with pytest.raises(NeverWakes, match="can never happen"):
        drive(world.notebook, waits)


@pytest.mark.parametrize("busy", [True, False])
def test_no_run_passes_the_end_that_a_world_was_given(world: World, busy: bool) -> None:
    ticks = []
    if busy:
        world.spawn(lambda: [(time.sleep(1), ticks.append(world.now)) for _ in range(10)], name="ticker")
    world.sim.end = 3 * SECOND
    world.sim.run_until(3 * SECOND)
    for _ in range(2):
        with pytest.raises(OutOfTime, match=r"its world ended, at 3 s of robot time"):
            world.sim.run_until(5 * SECOND)
        assert world.now == 3 * SECOND
    with pytest.raises(OutOfTime):
        drive(world.notebook, time.sleep, 4.0)
    assert ticks == [SECOND, 2 * SECOND] * busy


def test_a_call_may_end_just_before_its_world_does(world: World) -> None:
    world.sim.end = 3 * SECOND
    drive(world.notebook, time.sleep, 2.9)
    assert world.now == 2.9 * SECOND


def test_an_interrupted_call_gets_the_interrupt_and_cleans_up(world: World) -> None:
    log = []

    def call() -> None:
        try:
            while True:
                time.sleep(0.001)
                if world.now > SECOND and not log:
                    log.append("interrupting")
                    os.kill(os.getpid(), signal.SIGINT)
        finally:
            log.append("cleaned up")

    with pytest.raises(KeyboardInterrupt):
        drive(world.notebook, call)
    assert log == ["interrupting", "cleaned up"]


def test_an_old_world_says_that_it_is_closed(world: World) -> None:
    open_world()
    with pytest.raises(WorldClosed, match="closed by a later start"):
        world.sim.run_until(SECOND)


def test_closing_lets_programs_clean_up_and_reclaims_those_that_refuse() -> None:
    world = open_world()
    log = []

    def polite() -> None:
        try:
            time.sleep(100)
        finally:
            log.append("polite cleaned up")

    def rude() -> None:
        while True:
            try:
                time.sleep(100)
            except BaseException:
                log.append("rude goes on")

    processes = [world.spawn(polite, name="polite"), world.spawn(rude, name="rude")]
    world.sim.run_until(SECOND)
    world.close()
    assert log[0] == "polite cleaned up"
    assert set(log[1:]) == {"rude goes on"}
    assert not any(process.alive for process in processes)


def test_time_cannot_run_backwards(world: World) -> None:
    world.sim.run_until(SECOND)
    with pytest.raises(SimulationError, match="back in time"):
        world.sim.run_until(0)
    with pytest.raises(SimulationError, match="in the past"):
        world.sim.call_later(-1, print)


def test_a_call_that_ignores_being_given_up_is_never_run_again(world: World) -> None:
    log: list[str] = []

    def stubborn() -> None:
        while True:
            try:
                time.sleep(100)
            except Exception:
                log.append("swallowed")

    with pytest.raises(DriveTimeout, match="900 s of robot time"):
        drive(world.notebook, stubborn)
    assert log == ["swallowed"]
    began = world.now
    world.sim.run_until(began + 10_000 * SECOND)
    assert world.now == began + 10_000 * SECOND
    assert log == ["swallowed"]


def test_an_interrupt_is_raised_even_if_the_call_has_just_ended(world: World) -> None:
    def call() -> str:
        os.kill(os.getpid(), signal.SIGINT)
        return "done"

    with pytest.raises(KeyboardInterrupt):
        drive(world.notebook, call)
    assert drive(world.notebook, lambda: "the world goes on") == "the world goes on"


def test_interrupts_in_a_loop_of_calls_never_break_the_world(world: World) -> None:
    stop = threading.Event()

    def shoot() -> None:
        while not stop.wait(0.003):
            os.kill(os.getpid(), signal.SIGINT)

    hits = 0
    gun = threading.Thread(target=shoot)
    previous = signal.signal(signal.SIGINT, lambda *_: None)  # those that come between two calls are the cell's
    gun.start()
    try:
        for _ in range(300):
            try:
                drive(world.notebook, time.sleep, 0.001)
            except KeyboardInterrupt:
                hits += 1
    finally:
        stop.set()
        gun.join()
        signal.signal(signal.SIGINT, previous)
    assert not world.sim.running
    drive(world.notebook, time.sleep, 1.0)


def test_who_is_interrupted_cleans_up_in_one_instant_even_if_it_looks_at_a_clock(world: World) -> None:
    log = []

    def main() -> None:
        try:
            time.sleep(100)
        finally:
            log.append(time.time())
            log.append("motors off")

    process = world.spawn(main, name="main")
    world.sim.run_until(SECOND)
    process.interrupt()
    assert log[-1] == "motors off"
    assert process.exit_code == -2


def test_what_is_asked_for_later_comes_in_time_beside_a_busy_wait(world: World) -> None:
    called = []

    def waits() -> None:
        end = time.time() + 1.5
        while time.time() < end:
            pass

    world.spawn(waits, name="waits")
    world.sim.call_later(SECOND // 100, lambda: called.append(world.now))
    world.sim.run_until(SECOND // 10)
    assert called == [pytest.approx(SECOND // 100, abs=2_000)]


def test_a_world_runs_in_one_thread_only(world: World) -> None:
    errors: list[BaseException] = []

    def elsewhere() -> None:
        try:
            world.sim.run_until(SECOND)
        except SimulationError as error:
            errors.append(error)

    thread = threading.Thread(target=elsewhere)
    thread.start()
    thread.join()
    assert "call_soon_threadsafe" in str(errors[0])
    world.sim.run_until(SECOND)


def test_an_exit_in_a_thread_of_an_executor_ends_its_program_alone(world: World) -> None:
    import rclpy
    from rclpy.executors import MultiThreadedExecutor

    def main() -> None:
        rclpy.init()
        node = rclpy.create_node("main")
        node.create_timer(0.1, lambda: sys.exit(3))
        executor = MultiThreadedExecutor()
        executor.add_node(node)
        executor.spin()

    process = world.spawn(main, name="main")
    world.sim.run_until(SECOND)
    assert process.exit_code == 3
    assert world.now == SECOND


def test_a_clean_up_that_fails_keeps_nobody_from_hearing_of_the_end(world: World, capsys) -> None:
    import rclpy
    from rclpy.node import Node

    class Loud(Node):
        def destroy_node(self) -> None:
            raise RuntimeError("not now")

    def main() -> None:
        rclpy.init()
        Loud("loud")

    ended = []
    world.spawn(main, name="main", on_exit=ended.append)
    world.sim.run_until(SECOND)
    assert [process.exit_code for process in ended] == [0]
    assert world.graph.nodes == []


def test_an_interrupt_while_a_process_cleans_up_comes_when_that_is_done(world: World) -> None:
    cleaned = []

    def main() -> None:
        try:
            time.sleep(100)
        finally:
            os.kill(os.getpid(), signal.SIGINT)
            cleaned.append("all")

    process = world.spawn(main, name="tidy", argv=["tidy", "--fast"])
    world.sim.settle()
    arguments = sys.argv
    with pytest.raises(KeyboardInterrupt):
        process.kill()
    assert cleaned == ["all"]
    assert not process.alive
    assert sys.argv is arguments


def test_a_library_that_measures_garbage_collections_lets_no_time_pass(world: World) -> None:
    """A collection comes at any time: did reading the clock in it take virtual time, no run would repeat another."""
    seen: list[int] = []

    def measure(phase: str, info: dict[str, int]) -> None:
        time.perf_counter()

    def collecting() -> None:
        before = world.now
        gc.callbacks.append(measure)
        try:
            gc.collect()
        finally:
            gc.callbacks.remove(measure)
        seen.append(world.now - before)
        time.perf_counter()
        seen.append(world.now - before)

    world.spawn(collecting, name="collecting")
    world.sim.run_until(SECOND)
    assert seen == [0, 1_000]


def test_five_hundred_programs_may_begin_at_one_instant(world: World) -> None:
    log: list[float] = []

    def main() -> None:
        for _ in range(2):
            log.append(world.now // SECOND)
            time.sleep(1.0)

    for number in range(500):
        world.spawn(main, name=f"p{number}")
    world.sim.run_until(2 * SECOND)
    assert log == [0] * 500 + [1] * 500
