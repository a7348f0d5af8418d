"""The front door: start(), and what a Lesson does with time, obstacles and mistakes."""

from __future__ import annotations

import asyncio
import os
import signal
import sys
import threading
import time
from pathlib import Path
from typing import Any

import pytest

from turtle_lesson import Lesson, start
from turtle_lesson.ros.cli.shell import run_line
from turtle_lesson.ros.launching.errors import LaunchError
from turtle_lesson.ros.sim.errors import WorldClosed
from turtle_lesson.ros.sim.simulation import EPOCH
from turtle_lesson.turtlesim.obstacles import Box, Circle


@pytest.fixture
def lesson() -> Lesson:
    return start()


def test_a_world_begins_with_the_simulator_and_nothing_else(lesson: Lesson) -> None:
    import rclpy

    rclpy.init()
    names = rclpy.create_node("me").get_fully_qualified_node_names()
    assert sorted(name for name in names if not name.startswith("/_")) == ["/me", "/turtlesim"]
    assert lesson.now == 0.0


def test_what_cannot_let_go_of_a_world_fails_once(lesson: Lesson) -> None:
    lesson._world.at_close.append(lambda: {}["gone"])
    with pytest.raises(KeyError):
        start()
    assert start().now == 0.0


def test_a_world_can_be_empty() -> None:
    lesson = start(package=None, simulator=False)
    lesson.run(1)
    with pytest.raises(ModuleNotFoundError, match="robot_controller"):
        __import__("robot_controller.msg")
    with pytest.raises(LaunchError, match="robot_controller"):
        lesson.launch("robot_controller", "start_system.launch.py")


def test_time_passes_only_when_it_is_run(lesson: Lesson) -> None:
    time.sleep(0.05)
    assert lesson.now == 0.0
    lesson.run(2.5)
    assert lesson.now == 2.5
    assert repr(lesson) == "<Lesson at 2.500 s of robot time>"


def test_spinning_calls_the_callbacks_of_cells(lesson: Lesson) -> None:
    import rclpy

    lesson.spin(1)
    assert lesson.now == pytest.approx(1.0), "without a node time passes all the same"
    rclpy.init()
    ticks: dict[str, int] = {"one": 0, "other": 0}
    for name in ticks:

        def tick(name: str = name) -> None:
            ticks[name] += 1

        rclpy.create_node(name).create_timer(0.5, tick)
    from rclpy._state import RclpyState

    one, other = list(lesson._world.notebook.state(RclpyState).context._nodes)
    lesson.spin(2.2)
    assert ticks == {"one": 4, "other": 4}
    lesson.spin(1, one)
    assert ticks == {"one": 6, "other": 4}
    lesson.spin(1000, one)  # more than a blocking call may take
    assert ticks == {"one": 2006, "other": 4}
    other.create_timer(0.1, lambda: 1 / 0)
    for _ in range(2):  # and again, the executor of before holds no node back
        with pytest.raises(ZeroDivisionError):
            lesson.spin(1)
    with pytest.raises(ValueError, match=r"try lesson\.spin\(5\)"):
        lesson.spin(-1)


@pytest.mark.parametrize("seconds", [-1, float("nan"), float("inf"), "5", None, True])
def test_time_must_be_a_number_of_seconds(lesson: Lesson, seconds: Any) -> None:
    with pytest.raises(ValueError, match=r"try lesson\.run\(5\)"):
        lesson.run(seconds)


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ({"seed": "x"}, "seed must be a whole number"),
        ({"package": "nope"}, "not a folder here"),
        ({"package": 3}, "package must be"),
    ],
)
def test_start_explains_its_arguments(arguments: dict[str, Any], said: str) -> None:
    with pytest.raises(ValueError, match=said):
        start(**arguments)


def test_a_real_ros_is_never_hidden(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "rclpy").mkdir()
    (tmp_path / "rclpy" / "__init__.py").touch()
    monkeypatch.syspath_prepend(str(tmp_path))
    kept = {name: sys.modules.pop(name) for name in list(sys.modules) if name.split(".")[0] == "rclpy"}
    try:
        with pytest.raises(RuntimeError, match="a real ROS 2 is sourced here"):
            start()
    finally:
        sys.modules.update(kept)


def test_the_lessons_recorder_is_not_among_the_nodes_that_a_program_sees(lesson: Lesson) -> None:
    import rclpy

    rclpy.init()
    lesson.run(0.1)
    assert rclpy.create_node("mine").get_node_names() == ["turtlesim", "mine"]
    assert "_lab" in rclpy.create_node("_hidden").get_node_names()


def test_the_world_before_is_closed(lesson: Lesson) -> None:
    start()
    with pytest.raises(WorldClosed, match="use the lesson that start"):
        lesson.run(1)


def test_twenty_worlds_leave_nothing_behind() -> None:
    import gc

    from turtle_lesson.ros.sim.strand import Strand

    def strands() -> int:
        gc.collect()
        return sum(isinstance(each, Strand) for each in gc.get_objects())

    def a_world() -> None:
        lesson = start()
        lesson.launch("robot_controller", "start_system.launch.py")
        lesson.run(1)

    a_world()
    before = strands()
    for _ in range(20):
        a_world()
    assert strands() <= before + 2


def test_obstacles_go_out_latched(lesson: Lesson) -> None:
    import rclpy
    from rclpy.qos import DurabilityPolicy, QoSProfile
    from visualization_msgs.msg import MarkerArray

    lesson.place(Circle(x=8.0, y=5.5, radius=0.5), Box(x=2.0, y=2.0, width=1.0, height=2.0))
    lesson.run(5)
    rclpy.init()
    node = rclpy.create_node("late")
    heard: list[Any] = []
    latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    node.create_subscription(MarkerArray, "/world/obstacles", heard.append, latched)
    rclpy.spin_once(node, timeout_sec=1.0)
    kinds = [marker.type for marker in heard[0].markers if marker.action == marker.ADD]
    assert kinds == [heard[0].markers[0].CYLINDER, heard[0].markers[0].CUBE]
    assert len(lesson.obstacles) == 2


def test_what_is_no_obstacle_is_refused(lesson: Lesson) -> None:
    with pytest.raises(TypeError, match="try Circle"):
        lesson.place(3)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="three pillars"):
        lesson.set_obstacles("nowhere")
    assert lesson.obstacles == ()


def test_live_mode_paces_the_world_to_the_wall(lesson: Lesson) -> None:
    async def live() -> tuple[float, float]:
        lesson.play(rate=10.0)
        await asyncio.sleep(0.3)
        played = lesson.now
        lesson.pause()
        await asyncio.sleep(0.1)
        return played, lesson.now

    played, after = asyncio.run(live())
    assert 0.5 < played < 12.0
    assert after == played


def test_live_mode_spins_the_nodes_of_the_cells(lesson: Lesson) -> None:
    import rclpy

    async def live() -> float:
        lesson.play(rate=10.0)
        await asyncio.sleep(0.3)
        lesson.pause()
        return lesson.now

    rclpy.init()
    node, called = rclpy.create_node("mine"), []
    node.create_timer(0.1, lambda: called.append(lesson.now))
    played = asyncio.run(live())
    assert len(called) == pytest.approx(played / 0.1, abs=1)
    lesson.spin(1.0)
    assert len(called) == pytest.approx((played + 1.0) / 0.1, abs=1)


def test_a_callback_that_raises_ends_live_mode(lesson: Lesson, capsys: pytest.CaptureFixture[str]) -> None:
    import rclpy

    async def live() -> None:
        lesson.play(rate=10.0)
        await asyncio.sleep(0.3)

    rclpy.init()
    node = rclpy.create_node("mine")
    node.create_timer(0.1, lambda: 1 / 0)
    asyncio.run(live())
    said = capsys.readouterr()
    assert "Live mode has stopped because of this error" in said.out
    assert "ZeroDivisionError" in said.out + said.err


def test_an_interrupt_ends_live_mode_but_not_the_event_loop(lesson: Lesson, capsys: pytest.CaptureFixture[str]) -> None:
    def busy() -> None:
        while True:
            os.kill(os.getpid(), signal.SIGINT)
            time.sleep(1.0)

    async def live() -> float:
        lesson._world.spawn(busy, name="busy")
        lesson.play(rate=10.0)
        await asyncio.sleep(0.3)
        return lesson.now

    assert asyncio.run(live()) < 2.0
    assert "lesson.play() continues it" in capsys.readouterr().out
    lesson.run(1)


def test_live_mode_needs_a_notebook_and_a_sensible_rate(lesson: Lesson) -> None:
    with pytest.raises(RuntimeError, match=r"in a script use lesson\.run"):
        lesson.play()
    with pytest.raises(ValueError, match="above 0"):
        lesson.play(0)


def test_spinning_in_a_cell_is_live_until_it_is_interrupted(lesson: Lesson) -> None:
    import rclpy

    rclpy.init()
    node = rclpy.create_node("me")
    ticks: list[float] = []

    def tick() -> None:
        ticks.append(lesson.now)
        if len(ticks) == 10:
            os.kill(os.getpid(), signal.SIGINT)

    node.create_timer(0.02, tick)
    with pytest.raises(KeyboardInterrupt):
        rclpy.spin(node)
    assert len(ticks) == 10
    lesson.run(1)


def test_an_interrupted_run_goes_on(lesson: Lesson) -> None:
    threading.Timer(0.2, os.kill, (os.getpid(), signal.SIGINT)).start()
    with pytest.raises(KeyboardInterrupt):
        lesson.run(1_000_000)
    paused = lesson.now
    assert 0 < paused < 1_000_000
    lesson.run(1)
    assert lesson.now == pytest.approx(paused + 1)


def test_a_node_of_an_earlier_world_says_so(lesson: Lesson) -> None:
    import rclpy

    rclpy.init()
    node = rclpy.create_node("me")
    start()
    with pytest.raises(WorldClosed, match="make its node"):
        rclpy.spin_once(node, timeout_sec=1.0)


def test_the_clock_of_nodes_begins_at_the_epoch(lesson: Lesson) -> None:
    import rclpy

    rclpy.init()
    now = rclpy.create_node("me").get_clock().now().nanoseconds
    assert EPOCH <= now < EPOCH + 1_000_000


def test_a_second_simulator_is_pointed_out(lesson: Lesson, capsys: pytest.CaptureFixture[str]) -> None:
    world = lesson._world
    run_line(world, "ros2 run turtlesim turtlesim_node")
    said = "Two simulators are running now, and both follow every command: start(simulator=False) starts none."
    assert capsys.readouterr().out.splitlines()[-1] == said
    run_line(world, "ros2 run turtlesim draw_square")
    assert said not in capsys.readouterr().out


def test_a_first_simulator_is_alone(capsys: pytest.CaptureFixture[str]) -> None:
    world = start(simulator=False)._world
    run_line(world, "ros2 run turtlesim turtlesim_node")
    assert "two simulators" not in capsys.readouterr().out
