"""A function that runs the simulation and is itself run step by step: it sees the same run, and can be interrupted and left."""

from __future__ import annotations

import contextlib
import gc
import io
import os
import random
import sys
import threading
import time
import weakref
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
import rclpy
from geometry_msgs.msg import Twist
from rclpy.task import Future
from turtlesim.msg import Pose
from turtlesim.srv import TeleportAbsolute

from turtle_lesson import Lesson, start
from turtle_lesson.ros.runtime.world import open_world
from turtle_lesson.ros.sim import interrupts, run_blocking
from turtle_lesson.ros.sim.errors import NeverWakes, OutOfTime, WorldClosed
from turtle_lesson.ros.sim.stepped_call import SteppedCall

SECOND = 1_000_000_000


def drive(lesson: Lesson) -> list[object]:
    """Everything that a function of an experiment waits in."""
    seen: list[object] = []
    lesson.network("/scan", loss=0.1)
    lesson.launch("robot_controller", "start_system.launch.py")
    lesson.run(0.7)
    rclpy.init()
    node = rclpy.create_node("client")
    client = node.create_client(TeleportAbsolute, "/turtle1/teleport_absolute")
    seen.append(client.wait_for_service(2.0))
    future = client.call_async(TeleportAbsolute.Request(x=2.0, y=3.0))
    rclpy.spin_until_future_complete(node, future)
    node.create_subscription(Pose, "/turtle1/pose", lambda pose: seen.append((pose.x, pose.y, pose.theta)), 10)
    publisher = node.create_publisher(Twist, "/turtle1/cmd_vel", 10)
    node.create_timer(0.25, lambda: publisher.publish(Twist()))
    rclpy.spin_until_future_complete(node, Future(), timeout_sec=0.7)
    thread = threading.Thread(target=lambda: (time.sleep(0.6), seen.append("thread")))
    thread.start()
    time.sleep(0.2)
    thread.join()
    lesson.spin(0.5)
    seen.append(node.create_client(TeleportAbsolute, "/nobody").wait_for_service(0.3))
    client.call(TeleportAbsolute.Request(x=5.0, y=3.0))
    with contextlib.redirect_stdout(io.StringIO()) as said:
        lesson.launch("robot_controller", "start_system.launch.py")
    seen.append(said.getvalue())
    return seen


def trace(lesson: Lesson) -> list[object]:
    """All that the world has noted."""
    noted = lesson._world.trace
    assert noted is not None
    return [
        {key: list(times) for key, times in noted.published.items()},
        [(each.node, each.name, each.ended, list(each.open)) for each in noted.callbacks],
        [(each.service, each.asked, each.received, each.answered, each.told) for each in noted.calls],
        list(noted.log),
        lesson._recording.poses.array().tolist(),
        lesson._world.now,
    ]


@pytest.fixture(scope="module")
def without_steps() -> Iterator[tuple[list[object], list[object]]]:
    """What the function returns, and its trace, where nobody steps it."""
    lesson = start(seed=3)
    yield drive(lesson), trace(lesson)
    lesson._world.close()


def stepped(function: Callable[[Lesson], Any], **options: Any) -> tuple[Lesson, SteppedCall]:
    lesson = start(**options)
    lesson._world.sim.end = 60 * SECOND  # sooner than a blocking call gives up
    return lesson, SteppedCall(lesson._world.sim, lambda: function(lesson))


DRAWN = random.Random(1)
STEPS: dict[str, Callable[[], int]] = {
    "long": lambda: 7 * SECOND,
    "odd": lambda: DRAWN.randrange(1, SECOND),
    "poses": lambda: 16_000_000,
    "tiny": lambda: DRAWN.choice([1, 1, 1000, 113_960, 10**7, 10**8]),
}


@pytest.mark.parametrize("steps", STEPS)
def test_steps_change_nothing(steps: str, without_steps: tuple[list[object], list[object]]) -> None:
    lesson, call = stepped(drive, seed=3)
    while not call.done:
        until = lesson._world.now + STEPS[steps]()
        call.go_on(until)
        assert lesson._world.now == until or call.done
    assert call.error is None
    assert (call.value, trace(lesson)) == without_steps


def test_neither_do_a_dashboard_and_what_else_runs_the_world(without_steps: tuple[list[object], list[object]]) -> None:
    lesson, call = stepped(drive, seed=3)
    lesson.dashboard()
    assert not call._greenlet, "the function stands before its first line"
    for number in range(40):
        lesson.run(0.03)
        lesson._player._run(lesson._world.now + SECOND // 50)  # what live mode does
        if number % 10 == 0:
            lesson.plot_timeline()
    call.go_on(100 * SECOND)
    assert (call.value, trace(lesson)) == without_steps


def test_a_blocking_call_of_another_cell_steps_it_too(without_steps: tuple[list[object], list[object]]) -> None:
    lesson, call = stepped(drive, seed=3)
    world = lesson._world
    call.go_on(SECOND)
    while not call.done:
        before = world.now
        run_blocking.drive(world.notebook, time.sleep, 0.23)
        assert world.now == before + 230_000_000
    assert call.value == without_steps[0]
    assert trace(lesson)[2] == without_steps[1][2]


def test_what_nothing_can_end_fails_at_the_same_instant() -> None:
    """Without a simulator nothing happens at all, and a run still takes its time."""

    def waits(lesson: Lesson) -> float:
        lesson.run(2.5)
        for process in lesson._world.processes:
            process.kill()
        rclpy.init()
        with pytest.raises(NeverWakes):
            rclpy.spin_until_future_complete(rclpy.create_node("client"), Future())
        return lesson.now

    plain = waits(start(simulator=False))
    lesson, call = stepped(waits, simulator=False)
    call.go_on(SECOND)
    assert lesson.now == 1 and not call.done
    call.go_on(10 * SECOND)
    assert call.error is None and call.value == plain == lesson.now


def test_streams_and_surroundings_are_the_functions_own(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)

    @contextlib.contextmanager
    def around() -> Iterator[None]:
        os.chdir("inner")
        yield
        os.chdir("..")

    def says(lesson: Lesson) -> str:
        with contextlib.redirect_stdout(io.StringIO()) as said:
            print("function in", Path.cwd().name)
            lesson._world.spawn(lambda: print("program"), name="program")
            lesson.run(2)
            print("again")
        print("shown")
        return said.getvalue()

    (tmp_path / "inner").mkdir()
    lesson = start(simulator=False)
    out = sys.stdout
    call = SteppedCall(lesson._world.sim, lambda: says(lesson), around)
    call.go_on(SECOND)
    assert Path.cwd() == tmp_path and sys.stdout is out
    print("caller")
    call.go_on(3 * SECOND)
    assert call.value == "function in inner\nprogram\nagain\n"
    assert capsys.readouterr().out == "caller\nshown\n"
    assert Path.cwd() == tmp_path


# -- interrupts --------------------------------------------------------------------------------------------------------


def press_stop() -> None:
    interrupts._interrupt_main_thread()


def test_an_interrupt_pauses_it_and_the_next_step_goes_on(without_steps: tuple[list[object], list[object]]) -> None:
    lesson, call = stepped(drive, seed=3)
    for delay in (0, 300_000_000, 113_961, 1_500_000_000, 400_000_000):
        lesson._world.sim.call_later(delay, press_stop)
        with pytest.raises(KeyboardInterrupt):
            call.go_on(100 * SECOND)
        assert not call.done
    call.go_on(100 * SECOND)
    assert (call.value, trace(lesson)) == without_steps


def test_one_in_its_own_code_waits_for_its_next_run() -> None:
    def computes(lesson: Lesson) -> str:
        lesson.run(1)
        press_stop()
        lesson.run(1)
        return "done"

    lesson, call = stepped(computes, simulator=False)
    with pytest.raises(KeyboardInterrupt):
        call.go_on(9 * SECOND)
    assert lesson.now == 1
    call.go_on(9 * SECOND)
    assert call.value == "done" and lesson.now == 2


def test_code_that_computes_for_ever_gets_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(interrupts, "interrupt_patience", 0.05)

    def computes(lesson: Lesson) -> None:
        press_stop()
        while True:
            pass

    lesson, call = stepped(computes, simulator=False)
    with pytest.raises(KeyboardInterrupt):
        call.go_on(9 * SECOND)
    assert call.done and isinstance(call.error, KeyboardInterrupt)
    call.go_on(SECOND)
    lesson.run(1)
    assert lesson.now == 1


def test_where_the_world_ends_the_function_hears_of_it() -> None:
    def waits(lesson: Lesson) -> None:
        try:
            lesson.run(9)
        finally:
            rclpy.init()
            with pytest.raises(OutOfTime):
                rclpy.create_node("client").create_client(TeleportAbsolute, "/nobody").wait_for_service()

    lesson, call = stepped(waits)
    lesson._world.sim.end = 2 * SECOND
    for _ in range(4):
        call.go_on(lesson._world.now + SECOND)
    assert isinstance(call.error, OutOfTime) and lesson.now == 2


# -- the end -----------------------------------------------------------------------------------------------------------


def test_a_closed_world_ends_it_and_keeps_nothing_of_it() -> None:
    said: list[object] = []

    def cleans_up(lesson: Lesson) -> None:
        try:
            lesson.run(9)
        finally:
            try:
                lesson.run(1)
            except WorldClosed:
                said.append("closed")

    world = open_world()
    lesson = Lesson(world, simulator=False)
    call = SteppedCall(world.sim, lambda: cleans_up(lesson))
    world.at_close.append(call.close)
    call.go_on(SECOND)
    ended, gone = weakref.ref(call._greenlet), weakref.ref(world)
    world.close()
    assert call.done and said == ["closed"]
    call = lesson = world = None  # type: ignore[assignment]
    open_world()
    gc.collect()
    assert ended() is None and gone() is None


def test_a_function_that_will_not_end_is_left() -> None:
    def stays(lesson: Lesson) -> None:
        while True:
            with contextlib.suppress(BaseException):
                lesson.run(1)

    world = open_world()
    lesson = Lesson(world, simulator=False)
    call = SteppedCall(world.sim, lambda: stays(lesson))
    world.at_close.append(call.close)
    call.go_on(SECOND)
    world.close()
    assert not call.done
    start(simulator=False).run(1)


def test_one_that_never_began_is_forgotten() -> None:
    lesson, call = stepped(drive, simulator=False)
    call.close()
    lesson.run(1)
    assert not call._greenlet and lesson.now == 1
