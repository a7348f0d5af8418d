"""Live plots from strings: how topic and field are found, what is drawn, and what is said of what is not there."""

from __future__ import annotations

import asyncio
from typing import Any

import numpy as np
import pytest
from lab_fakes import order

from turtle_lesson import Lesson, start
from turtle_lesson.lab.widgets.live_plot import figure, split, thinned


def drawn(widget: Any) -> list[np.ndarray]:
    """The points of each curve, as the browser gets them."""
    numbers = np.frombuffer(widget.points, "<f4")
    curves, at = [], 0
    while at < len(numbers):
        end = at + 1 + 2 * int(numbers[at])
        curves.append(numbers[at + 1 : end].reshape(-1, 2))
        at = end
    return curves


def test_the_string_is_split_at_the_longest_topic() -> None:
    topics = ["/a", "/a/b", "/ab"]
    assert split("/a/b/c/d", topics) == ("/a/b", "/c/d")
    assert split("/a/x", topics) == ("/a", "/x")
    assert split("/ab[3]", topics) == ("/ab", "[3]")
    assert split("/abc/x", topics) == ("", "")


def test_curves_from_all_kinds_of_strings(lesson: Lesson) -> None:
    asked = ["/robot/status/battery", "/turtle1/pose/x", "/obstacles/ranges[90]", "/turtle1/cmd_vel/linear/x"]
    widget = lesson.live_plot(*asked, "/turtle1/pose.theta")
    order_goal(lesson)
    lesson.run(4)
    widget.tick()
    names = [curve["name"] for curve in widget.curves]
    assert names == ["battery", "x", "ranges[90]", "linear/x", "theta"]
    assert [curve["note"] for curve in widget.curves] == [""] * 5
    assert all(len(points) > 5 for points in drawn(widget))
    assert np.all(np.diff(drawn(widget)[1][:, 0]) >= 0)


def order_goal(lesson: Lesson) -> None:
    form = lesson.form("/navigate_to")
    order(form, "edit", path="x", text="8")
    order(form, "edit", path="y", text="8")
    order(form, "call")


def test_its_text_is_exact(lesson: Lesson) -> None:
    widget = lesson.live_plot("/turtle1/pose/x")
    lesson.run(2)
    assert repr(widget) == (
        "Live plot of the last 30 s at 3.90 s of robot time. "
        "/turtle1/pose/x: 125 messages, last 5.54, from 5.54 to 5.54."
    )
    assert "30 s at 3.90 s" in widget.text() and widget.picture().figure is not None
    lesson.live_plot("/turtle1/pose/x", seconds=0.5)
    assert "image/png" in widget._repr_mimebundle_()[0]


def test_only_the_last_seconds_are_drawn(lesson: Lesson) -> None:
    widget = lesson.live_plot("/turtle1/pose/x", seconds=1.0)
    lesson.run(5)
    times, _ = widget.window(widget._curves[0])
    assert times[0] >= 5.0 and len(times) in (62, 63)


@pytest.mark.parametrize(
    ("asked", "said"),
    [
        ("/turtle1/pose", "is not a number but a turtlesim/msg/Pose: try /turtle1/pose/x, /turtle1/pose/y"),
        ("/turtle1/pose/thata", 'has no field "thata". Did you mean "theta"?'),
        ("/turtle1/cmd_vel/linear", "is not a number but a geometry_msgs/Vector3: try /turtle1/cmd_vel/linear/x"),
        ("/turtle1/cmd_vel/linear/w", 'geometry_msgs/Vector3 has no field "w"'),
        ("/obstacles/ranges", "is not a number but a float32[]: try /obstacles/ranges[0]"),
        ("/obstacles/header/frame_id", "is not a number but a string"),
        ("/turtle1/pose/w", 'turtlesim/msg/Pose has no field "w". There are: x, y, theta'),
        ("/turtle1/pose/x/y", 'float32 has no field "y". There are: none.'),
        ("/turtle1/pose/[x]", "is not a path to a field"),
        ("/rosout/msg", "is not a number but a string"),
        ("", "such as"),
        (7, "such as"),
        (["/turtle1/pose/x", "/turtle1/pose/y"], "got ['/turtle1/pose/x', '/turtle1/pose/y']"),
    ],
)
def test_mistakes_are_explained(lesson: Lesson, asked: Any, said: str) -> None:
    with pytest.raises(ValueError) as raised:
        lesson.live_plot(asked)
    assert said in str(raised.value)


def test_how_many_and_how_long(lesson: Lesson) -> None:
    with pytest.raises(ValueError, match="name a topic and a field"):
        lesson.live_plot()
    with pytest.raises(ValueError, match="8 at most"):
        lesson.live_plot(*(f"/obstacles/ranges[{number}]" for number in range(9)))
    with pytest.raises(ValueError, match=r"must be a number from 0\.1 to 3600"):
        lesson.live_plot("/turtle1/pose/x", seconds=-1)


def test_a_topic_that_is_not_there_yet_is_waited_for() -> None:
    lesson = start()
    widget = lesson.live_plot("/robot/status/battery", "/turtle2/pose/x")
    lesson.run(1)
    widget.tick()
    assert widget.curves[0]["note"].startswith("There is no such topic yet; now there are /parameter_events")
    lesson.launch("robot_controller", "start_system.launch.py")
    order(lesson.form("/spawn"), "call")
    lesson.run(3)
    widget.tick()
    assert [curve["note"] for curve in widget.curves] == ["", ""]
    assert "/robot/status/battery: 2" in widget.text()


def test_a_topic_that_comes_with_another_type_is_explained(lesson: Lesson) -> None:
    lesson = start()
    widget = lesson.live_plot("/robot/status/bettery")
    lesson.launch("robot_controller", "start_system.launch.py")
    lesson.run(2)
    widget.tick()
    assert 'no field "bettery". Did you mean "battery"?' in widget.curves[0]["note"]


def test_a_topic_that_is_mistyped_is_told_beside_its_curve(lesson: Lesson) -> None:
    widget = lesson.live_plot("/turtle1/psoe/x", "/something/else")
    slip, other = (curve["note"] for curve in widget.curves)
    assert slip.startswith("There is no such topic yet; now there are /obstacles, ")
    assert slip.endswith('Did you mean "/turtle1/pose"?') and "Did you mean" not in other


def test_a_message_of_one_number_needs_no_field(lesson: Lesson) -> None:
    import rclpy
    from std_msgs.msg import Float64

    def main() -> None:
        rclpy.init()
        node = rclpy.create_node("thermometer")
        publisher = node.create_publisher(Float64, "/temperature", 10)
        node.create_timer(0.1, lambda: publisher.publish(Float64(data=21.5)))
        rclpy.spin(node)

    lesson._world.spawn(main, name="thermometer")
    lesson.run(1)
    widget = lesson.live_plot("/temperature")
    lesson.run(1)
    assert "last 21.50" in widget.text()


def test_an_array_that_is_too_short_leaves_a_gap(lesson: Lesson) -> None:
    widget = lesson.live_plot("/obstacles/ranges[5000]")
    lesson.run(1)
    assert widget.text().endswith("/obstacles/ranges[5000]: 5 messages, last not a number.")
    assert widget.picture().figure is None


def test_it_stops_listening_with_its_last_view_and_begins_again_with_the_next() -> None:
    async def page() -> tuple[int, int, int]:
        lesson = start()
        node = lesson._recording.node
        lesson.run(2)
        before = len(list(node.subscriptions))
        widget = lesson.live_plot("/turtle1/color_sensor/r")
        order(widget, "open")
        listening = len(list(node.subscriptions)) - before
        order(widget, "close")
        deaf = len(list(node.subscriptions)) - before
        order(widget, "open")
        again = len(list(node.subscriptions)) - before
        widget.close()
        return listening, deaf, again

    assert asyncio.run(page()) == (1, 0, 1)


def test_lowest_and_highest_survive_when_points_are_left_out() -> None:
    times = np.linspace(0, 30, 3001)
    values = np.sin(times)
    values[1234] = 9.0
    kept_times, kept = thinned(times, values, 0.1)
    assert len(kept) <= 603 and kept.max() == 9.0 and kept_times[-1] == 30.0
    assert np.all(np.diff(kept_times) > 0)


def test_figures_of_any_size() -> None:
    assert [figure(each) for each in (5.544, 0.0, -0.00123, 1.25e9)] == ["5.54", "0.00", "-0.00123", "1.25e+09"]
