"""Commands in live mode, and the stop button: who is paced to the wall clock, what ends, and what goes on."""

from __future__ import annotations

import os
import signal
import threading
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace

import pytest

from turtle_lesson.ros.ament.package import Package
from turtle_lesson.ros.cli.shell import CommandInterrupted, run_line, shell_of
from turtle_lesson.ros.runtime.world import World, live_rate
from turtle_lesson.ros.stdlib.clocks import real_monotonic


@pytest.fixture
def talker(world: World) -> World:
    """A world in which somebody says a word ten times a second."""

    def talk() -> None:
        import rclpy
        from std_msgs.msg import String

        rclpy.init(args=[])
        node = rclpy.create_node("talker")
        publisher = node.create_publisher(String, "/word", 10)
        node.create_timer(0.1, lambda: publisher.publish(String(data="hello")))
        rclpy.spin(node)

    world.spawn(talk, name="talker")
    world.sim.settle()
    return world


@pytest.fixture
def live(talker: World) -> World:
    """The same, in live mode, ten times as fast as life."""
    talker.player = SimpleNamespace(rate=10.0, playing=True)
    return talker


def interrupted_after(seconds: float, function: Callable[[], int]) -> int:
    """Call a function, and press the stop button after some real time."""
    timer = threading.Timer(seconds, os.kill, [os.getpid(), signal.SIGINT])
    timer.start()
    try:
        return function()
    finally:
        timer.join()


def own_nodes(world: World) -> list[str]:
    return [node.full_name for node in world.graph.nodes]


def test_the_rate_is_known_only_while_it_plays(world: World) -> None:
    assert live_rate(world) is None
    player = SimpleNamespace(rate=2.0, playing=False)
    world.player = player
    assert live_rate(world) is None
    player.playing = True
    assert live_rate(world) == 2.0


def test_a_command_is_paced_and_ends_by_itself(live: World) -> None:
    began = real_monotonic()
    assert run_line(live, "ros2 topic echo /word --for 2") == 2
    assert real_monotonic() - began > 0.15
    assert own_nodes(live) == ["/talker"]


def test_what_never_ends_goes_on_until_the_stop_button(live: World, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(CommandInterrupted, match="ros2 topic echo /word was stopped"):
        interrupted_after(1.0, lambda: run_line(live, "ros2 topic echo /word || echo on; echo on"))
    assert shell_of(live).exit_code == 2, "as the real one gives"
    assert live.now > 6_000_000_000, "it would have stopped after 5 s, were it not live"
    out = capsys.readouterr().out
    assert out.startswith("data: hello\n---\n")
    assert "on\n" not in out
    assert own_nodes(live) == ["/talker"]


def test_without_live_mode_the_stop_button_ends_the_cell_but_not_the_world(talker: World) -> None:
    with pytest.raises(KeyboardInterrupt):
        interrupted_after(0.3, lambda: run_line(talker, "ros2 topic hz /word --for 80000 > hz.txt; echo no"))
    assert own_nodes(talker) == ["/talker"]
    assert run_line(talker, "ros2 topic echo /word --once") == 0


def test_what_runs_in_the_cell_itself_is_stopped_as_well(world: World, capsys: pytest.CaptureFixture[str]) -> None:
    world.packages.add(Package("loud", Path("loud"), executables={"talker": _tick}))
    with pytest.raises(CommandInterrupted):
        interrupted_after(0.3, lambda: run_line(world, "ros2 run --for 80000 loud talker; echo no"))
    assert "no" not in capsys.readouterr().out
    assert own_nodes(world) == ["/ticker"], "as in a terminal, what was started there goes on"


def _tick() -> None:
    import rclpy

    rclpy.init()
    node = rclpy.create_node("ticker")
    node.create_timer(0.01, lambda: None)
    rclpy.spin(node)


def test_run_returns_at_once_in_live_mode_too(live: World, capsys: pytest.CaptureFixture[str]) -> None:
    began = live.now
    run_line(live, "ros2 run nope nope; ros2 pkg list")
    assert live.now - began < 1_000_000_000


@pytest.fixture(autouse=True)
def folder(tmp_path: os.PathLike[str], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
