"""Driving by hand: a held stick publishes, one that is let go or falls silent stops."""

from __future__ import annotations

import asyncio
import math
from pathlib import Path
from typing import Any

import pytest
from lab_fakes import order

from turtle_lesson import Lesson, start
from turtle_lesson.lab.widgets import teleop as module
from turtle_lesson.lab.widgets.teleop import Teleop


@pytest.fixture
def lesson() -> Lesson:
    return start()


@pytest.fixture
def hand(monkeypatch: pytest.MonkeyPatch) -> dict[str, float]:
    """The real time that the dead man's switch sees."""
    clock = {"now": 0.0}
    monkeypatch.setattr(module, "real_monotonic", lambda: clock["now"])
    return clock


def listen(lesson: Lesson, topic: str = "/turtle1/cmd_vel") -> list[tuple[float, float, float]]:
    """Robot time, forward and turn of each Twist from now on."""
    import rclpy
    from geometry_msgs.msg import Twist

    heard: list[tuple[float, float, float]] = []

    def main() -> None:
        rclpy.init()
        node = rclpy.create_node("ear")
        node.create_subscription(
            Twist, topic, lambda m: heard.append((round(lesson.now, 2), m.linear.x, m.angular.z)), 10
        )
        rclpy.spin(node)

    lesson._world.spawn(main, name="ear")
    lesson._world.sim.settle()
    return heard


def test_a_held_stick_publishes_ten_times_a_second_and_zeros_when_it_is_let_go(lesson: Lesson, hand: Any) -> None:
    heard = listen(lesson)
    widget = lesson.teleop()
    order(widget, "drive", forward=1.0, turn=0.5)
    lesson.run(0.45)
    order(widget, "release")
    lesson.run(0.5)
    assert heard == [(at, 2.0, 1.0) for at in (0.0, 0.1, 0.2, 0.3, 0.4)] + [(0.45, 0.0, 0.0)]
    assert widget.words == "Stopped."
    assert lesson._recording.poses.array()["x"][-1] > 6.0


def test_a_stick_that_falls_silent_is_let_go(lesson: Lesson, hand: dict[str, float]) -> None:
    widget = lesson.teleop()
    order(widget, "drive", forward=1.0, turn=0.0)
    hand["now"] = 0.29
    widget.tick()
    assert widget.stick["held"]
    hand["now"] = 0.31
    widget.tick()
    assert not widget.stick["held"] and widget.sent["linear"] == 0.0
    assert widget.words == "Stopped: no sign of the stick for 0.3 s."


def test_it_also_stops_while_a_cell_computes_and_only_robot_time_passes(lesson: Lesson, hand: dict[str, float]) -> None:
    widget = lesson.teleop()
    order(widget, "drive", forward=1.0, turn=0.0)
    hand["now"] = 5.0
    lesson.run(3)
    assert widget.sent == {"linear": 0.0, "angular": 0.0, "count": 2}


def test_it_stops_when_its_last_view_closes(lesson: Lesson, hand: Any) -> None:
    widget = lesson.teleop()
    order(widget, "open")
    order(widget, "drive", forward=1.0, turn=0.0)
    order(widget, "close")
    assert not widget.stick["held"] and widget.sent["linear"] == 0.0
    assert not [each for each in lesson._recording.node.publishers if each.topic_name == "/turtle1/cmd_vel"]


def test_looking_at_it_changes_nothing(lesson: Lesson) -> None:
    before = lesson._recording.node.count_publishers("/turtle1/cmd_vel")
    widget = lesson.teleop()
    order(widget, "open")
    lesson.run(1)
    assert lesson._recording.node.count_publishers("/turtle1/cmd_vel") == before
    assert repr(widget) == "Teleop on /turtle1/cmd_vel, at most 2.00 m/s and 2.00 rad/s: nothing sent yet."


def test_it_says_when_nobody_listens_and_who_does_elsewhere(lesson: Lesson) -> None:
    said = "No node listens on /turtle9/cmd_vel. There are listeners on /turtle1/cmd_vel."
    assert lesson.teleop("/turtle9/cmd_vel").unheard == said
    assert lesson.teleop().unheard == ""
    listen(lesson, "/turtle9/cmd_vel")
    widget = lesson.teleop("/turtle9/cmd_vel")
    widget._paces.clear()
    widget.tick()
    assert widget.unheard == ""


def test_whoever_listens_for_another_type_is_named(lesson: Lesson) -> None:
    assert lesson.teleop("/rosout").unheard == "No node listens on /rosout. There are listeners on /turtle1/cmd_vel."
    events = "rcl_interfaces/msg/ParameterEvent, not geometry_msgs/msg/Twist."
    assert lesson.teleop("/parameter_events").unheard in (
        "No node listens on /parameter_events. There are listeners on /turtle1/cmd_vel.",
        f"The nodes that listen on /parameter_events expect {events}",
    )


def test_highest_speeds(lesson: Lesson, hand: Any) -> None:
    widget = lesson.teleop()
    order(widget, "limits", forward=0.5)
    order(widget, "drive", forward=-1.0, turn=0.0)
    assert widget.sent["linear"] == -0.5
    assert "last sent -0.50 m/s and 0.00 rad/s." in repr(widget)
    order(widget, "limits", forward=0)
    assert widget.words == "The highest speed (forward) must be a number from 0.01 to 10, got 0."
    order(widget, "limits", sideways=1.0)
    assert "forward and turn" in widget.words and widget.limits == {"forward": 0.5, "turn": 2.0}


@pytest.mark.parametrize("nonsense", ["fast", None, True, math.nan])
def test_nonsense_from_outside_moves_nothing(lesson: Lesson, nonsense: Any) -> None:
    widget = lesson.teleop()
    order(widget, "drive", forward=nonsense, turn=0.0)
    assert "must be a number from -1 to 1" in widget.words
    assert widget.sent["count"] == 0 and not widget.stick["held"]


@pytest.mark.parametrize("topic", ["", None, "not a topic", "/1st"])
def test_a_topic_must_be_a_name(lesson: Lesson, topic: Any) -> None:
    with pytest.raises(Exception, match="topic"):
        lesson.teleop(topic)


def test_driving_starts_time() -> None:
    async def page() -> float:
        lesson = start()
        widget = lesson.teleop()
        assert isinstance(widget, Teleop)
        order(widget, "drive", forward=1.0, turn=0.0)
        await asyncio.sleep(0.2)
        lesson.pause()
        return lesson.now

    assert 0.05 < asyncio.run(page()) < 1.0


def test_keys_go_to_the_program_that_reads_them(lesson: Lesson, tmp_path: Path, capsys: Any) -> None:
    widget = lesson.teleop()
    heard = listen(lesson)
    program = tmp_path / "keys.py"
    program.write_text(
        "import sys, tty\ntty.setraw(sys.stdin)\nfor _ in range(3):\n    print(repr(sys.stdin.read(1)))\n"
    )
    process = lesson._world.spawn(program, name="keys")
    lesson.run(1)
    widget._tick()
    assert widget.program == "keys" and "Keys go to keys." in repr(widget)
    for key in ("w", "F20", " ", "Enter"):
        order(widget, "key", key=key, down=True)
        order(widget, "key", key=key, down=False)
    lesson.run(1)
    assert capsys.readouterr().out.splitlines()[-3:] == ["'w'", "' '", "'\\r'"]
    assert (heard, process.exit_code) == ([], 0)
    widget._tick()
    assert widget.program == ""


def test_a_widget_that_is_there_needs_no_word_about_keys(lesson: Lesson, tmp_path: Path, capsys: Any) -> None:
    lesson.teleop()
    program = tmp_path / "keys.py"
    program.write_text("import sys, tty\ntty.setraw(sys.stdin)\nsys.stdin.read(1)")
    lesson._world.spawn(program, name="keys")
    lesson.run(1)
    assert "waits for keys" not in capsys.readouterr().err
