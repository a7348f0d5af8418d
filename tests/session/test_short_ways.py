"""How many of the lesson's functions are called for what a learner does most often. Counts are the same on every machine."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from types import FrameType
from typing import Any

import greenlet
import pytest
import rclpy
from std_msgs.msg import String

import turtle_lesson
from turtle_lesson import start
from turtle_lesson.ros.cli.shell import run_line
from turtle_lesson.ros.rmw.service import ClientEnd
from turtle_lesson.ros.runtime.world import World
from turtle_lesson.session.lesson import Lesson

OURS = str(Path(turtle_lesson.__file__).parent)


@pytest.fixture
def lesson() -> Iterator[Lesson]:
    lesson = start(seed=0)
    lesson.run(1)
    yield lesson
    lesson._world.close()


class Calls:
    """The calls of the lesson's functions, in all greenlets, until `last` is called, if that is given."""

    def __init__(self, last: Any = None) -> None:
        self.names: list[str] = []
        self.reached = False
        self._last = getattr(last, "__code__", None)

    def profile(self, frame: FrameType, event: str, argument: object) -> None:
        if event != "call" or self.reached or not frame.f_code.co_filename.startswith(OURS):
            return
        self.names.append(f"{Path(frame.f_code.co_filename).stem}.{frame.f_code.co_name}")
        self.reached = frame.f_code is self._last


@contextmanager
def calls(last: Any = None) -> Iterator[Calls]:
    """Count calls; each greenlet has a profile function of its own."""
    counted = Calls(last)
    before = sys.getprofile(), greenlet.gettrace()
    greenlet.settrace(lambda *_: sys.setprofile(counted.profile))
    sys.setprofile(counted.profile)
    try:
        yield counted
    finally:
        greenlet.settrace(before[1])
        sys.setprofile(before[0])


def test_a_message_reaches_its_callback_in_a_cells_spin_once(lesson: Lesson) -> None:
    heard: list[Any] = []
    rclpy.init()
    node = rclpy.create_node("me")
    node.create_subscription(String, "/words", heard.append, 10)
    publisher = node.create_publisher(String, "/words", 10)
    for count in range(1, 4):
        publisher.publish(String(data="hello"))
        with calls() as counted:
            rclpy.spin_once(node)
        assert len(heard) == count
    assert len(counted.names) <= 60, counted.names


def test_a_click_sends_its_request(lesson: Lesson) -> None:
    lesson.launch("robot_controller", "start_system.launch.py")
    pad = lesson.goal_pad()
    pad._order(pad, {"do": "open", "view": "v"}, [])
    for x in (2.0, 8.0):
        with calls(ClientEnd.ask) as counted:
            pad._order(pad, {"do": "goal", "view": "v", "x": x, "y": 5.0, "theta": 0.0}, [])
            lesson.run(0.1)
        lesson.run(8)
        assert counted.reached
    assert len(counted.names) <= 150, counted.names


def test_a_command_is_understood_before_its_program_starts(lesson: Lesson, capsys: pytest.CaptureFixture[str]) -> None:
    for _ in range(2):  # the first time, its modules are imported
        with calls(World.spawn) as counted:
            run_line(lesson._world, "ros2 topic echo --once /turtle1/pose")
        assert "theta" in capsys.readouterr().out
        assert counted.reached
    assert len(counted.names) <= 60, counted.names
