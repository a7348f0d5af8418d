"""Forms for messages and requests: their fields, what they send, and the same as a line for the terminal."""

from __future__ import annotations

import asyncio
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from lab_fakes import order

from turtle_lesson import Lesson, start
from turtle_lesson.lab.recorder import find_class
from turtle_lesson.lab.widgets import backend
from turtle_lesson.lab.widgets.form import in_yaml
from turtle_lesson.lab.widgets.message_fields import Field, Kind, fields_of, kinds_of, read_kind
from turtle_lesson.ros.idl.names import bounds, is_hidden


def fields(type_name: str) -> dict[str, Field]:
    return {field.path: field for field in fields_of(find_class(type_name)())}


# -- types -----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("text", "kind", "written"),
    [
        ("double", Kind("double"), "float64"),
        ("sequence<float>", Kind("float", "[]"), "float32[]"),
        ("sequence<geometry_msgs/Point, 3>", Kind("geometry_msgs/Point", "[<=3]"), "geometry_msgs/Point[<=3]"),
        ("double[36]", Kind("double", "[36]"), "float64[36]"),
        ("string<10>", Kind("string"), "string"),
        ("sequence<string<10>, 5>", Kind("string", "[<=5]"), "string[<=5]"),
        ("sequence<string<10>>", Kind("string", "[]"), "string[]"),
        ("boolean", Kind("boolean"), "bool"),
    ],
)
def test_kinds_are_read_as_ros_writes_them(text: str, kind: Kind, written: str) -> None:
    assert read_kind(text) == kind
    assert str(kind) == written


def test_limits_of_whole_numbers() -> None:
    assert [bounds(each) for each in ("int8", "uint16", "octet")] == [(-128, 127), (0, 65535), (0, 255)]
    assert bounds("int64") == (-(2**63), 2**63 - 1)


def test_empty_and_unknown_messages() -> None:
    assert kinds_of(find_class("std_msgs/msg/Empty")) == {}
    with pytest.raises(ValueError, match="colcon build --packages-select nowhere"):
        find_class("nowhere/msg/Nothing")


@pytest.mark.parametrize(
    "type_name",
    [
        "sensor_msgs/msg/BatteryState",
        "visualization_msgs/msg/MarkerArray",
        "geometry_msgs/msg/PoseWithCovarianceStamped",
        "std_msgs/msg/ByteMultiArray",
        "rcl_interfaces/msg/Log",
        "rcl_interfaces/msg/ParameterEvent",
        "std_msgs/msg/Empty",
    ],
)
def test_an_untouched_form_holds_the_defaults(type_name: str) -> None:
    message = find_class(type_name)()
    for field in fields(type_name).values():
        if field.is_single:
            assert field.value() == field.default
            field.put_into(message, field.value())
    assert message == find_class(type_name)()


# -- fields ----------------------------------------------------------------------------------------------------------


def test_fields_of_all_kinds() -> None:
    marker, typed = find_class("visualization_msgs/msg/Marker")(), fields("visualization_msgs/msg/Marker")
    texts = {"id": " 12 ", "scale/x": "−1e-3", "text": "Grüße: {a}", "frame_locked": True, "points": "[{}, {y: 2}]"}
    for path, text in texts.items():
        typed[path].text = text
        typed[path].put_into(marker, typed[path].value())
    assert (marker.id, marker.scale.x, marker.text, marker.frame_locked) == (12, -0.001, "Grüße: {a}", True)
    assert [(each.x, each.y) for each in marker.points] == [(0.0, 0.0), (0.0, 2.0)]
    assert [typed[path].control for path in ("header", "header/stamp", "text", "points")] == [
        "group",
        "now",
        "text",
        "text",
    ]


@pytest.mark.parametrize(
    ("type_name", "path", "text", "said"),
    [
        ("geometry_msgs/msg/Point", "x", "", "a number such as 1.5 is wanted"),
        ("geometry_msgs/msg/Point", "x", "1,5", "write a point, not a comma"),
        ("std_msgs/msg/Float32", "data", "1e39", "fits here, not 1e+39"),
        ("std_msgs/msg/Int8", "data", "128", "from −128 to 127 fits here, not 128"),
        ("std_msgs/msg/UInt8", "data", "-1", "from 0 to 255 fits here, not −1"),
        ("std_msgs/msg/Int32", "data", "1.0", 'a whole number such as 3 is wanted, got "1.0"'),
        ("std_msgs/msg/Byte", "data", "256", "from 0 to 255"),
        ("std_msgs/msg/Int8", "data", "9" * 400, "from −128 to 127"),
        ("geometry_msgs/msg/Polygon", "points", "{x: 1}", "a list such as [1.5, 2.0] or [{x: 1.5}, {x: 2.0}]"),
        ("geometry_msgs/msg/Polygon", "points", "[1, 2", "a list such as"),
        ("geometry_msgs/msg/Polygon", "points", "[{q: 1}]", "has no attribute 'q'"),
        ("geometry_msgs/msg/PoseWithCovariance", "covariance", "[1.0]", "36"),
        ("sensor_msgs/msg/LaserScan", "ranges", "[near]", "must be real number, not str"),
    ],
)
def test_what_cannot_be_sent_is_said_in_words(type_name: str, path: str, text: str, said: str) -> None:
    field = fields(type_name)[path]
    field.text = text
    with pytest.raises(ValueError) as raised:
        field.put_into(find_class(type_name)(), field.value())
    assert said in str(raised.value)


def test_a_byte_is_a_number_in_a_form() -> None:
    message, field = find_class("std_msgs/msg/Byte")(), fields("std_msgs/msg/Byte")["data"]
    field.text = "7"
    field.put_into(message, field.value())
    assert message.data == b"\x07"


# -- the line for the terminal ---------------------------------------------------------------------------------------


def test_the_line_holds_what_differs_from_the_default() -> None:
    assert in_yaml({}) == '"{}"'
    assert in_yaml({"linear/x": 1.5}) == '"{linear: {x: 1.5}}"'


@given(st.text(max_size=40))
def test_any_text_survives_the_shell_and_yaml(text: str) -> None:
    from turtle_lesson.ros.cli.script import Word, tokens
    from turtle_lesson.ros.cli.typed_values import read_yaml

    words = list(tokens(f"ros2 topic pub --once /t std_msgs/msg/String {in_yaml({'data': text})}"))
    assert all(isinstance(word, Word) for word in words)
    last = words[-1]
    assert isinstance(last, Word)
    assert read_yaml(last.text) == {"data": text}


# -- the widget ------------------------------------------------------------------------------------------------------


def test_it_publishes_once_and_moves_the_turtle(lesson: Lesson) -> None:
    widget = lesson.form("/turtle1/cmd_vel")
    order(widget, "edit", path="linear/x", text="1.0")
    order(widget, "publish")
    lesson.run(2)
    assert lesson._recording.poses.array()["x"][-1] == pytest.approx(6.55, abs=0.05)
    assert widget.published == 1 and widget.words == "Published on /turtle1/cmd_vel."


def test_it_publishes_at_a_rate_of_robot_time_until_it_is_stopped(lesson: Lesson) -> None:
    widget = lesson.form("/turtle1/cmd_vel")
    order(widget, "rate", rate=4)
    order(widget, "repeat")
    assert widget.line == 'ros2 topic pub --rate 4 /turtle1/cmd_vel geometry_msgs/msg/Twist "{}"'
    lesson.run(1.1)
    order(widget, "stop")
    lesson.run(1)
    assert widget.published == 5
    assert widget.words == "Stopped after 5 messages on /turtle1/cmd_vel." and "--once" in widget.line


def test_while_a_field_is_wrong_the_last_sound_message_goes_on(lesson: Lesson) -> None:
    widget = lesson.form("/turtle1/cmd_vel")
    order(widget, "edit", path="linear/x", text="1.0")
    order(widget, "repeat")
    order(widget, "edit", path="linear/x", text="1.0x")
    lesson.run(1.05)
    assert widget.published == 11 and lesson._recording.commands.array()["forward"][-1] == 1.0


def test_nothing_wrong_is_sent(lesson: Lesson) -> None:
    widget = lesson.form("/turtle1/cmd_vel")
    order(widget, "edit", path="linear/x", text="fast")
    assert widget.errors == {"linear/x": 'a number such as 1.5 is wanted, got "fast"'} and widget.line == ""
    order(widget, "publish")
    assert widget.words.startswith("Not sent: linear/x: ") and widget.published == 0
    order(widget, "reset")
    assert widget.errors == {}


def test_it_calls_a_service_and_shows_the_answer(lesson: Lesson) -> None:
    widget = lesson.form("/navigate_to")
    for name, text in (("x", "7"), ("y", "6")):
        order(widget, "edit", path=name, text=text)
    assert widget.line == 'ros2 service call /navigate_to robot_controller/srv/NavigateTo "{x: 7.0, y: 6.0}"'
    order(widget, "call")
    assert widget.running
    order(widget, "call")
    assert "has not answered the last request yet" in widget.words
    lesson.run(10)
    assert widget.answer.startswith("success: true\ntime_taken: ")
    assert widget.words.startswith("/navigate_to answered after ") and not widget.running


def test_no_answer_within_the_time_and_nobody_there(lesson: Lesson, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(backend, "LONGEST_WAIT", 0.5)
    widget = lesson.form("/navigate_to")
    order(widget, "edit", path="x", text="9")
    order(widget, "call")
    lesson.run(0.6)
    widget.tick()
    assert widget.words == "No answer from /navigate_to within 0.5 s of robot time." and not widget.running
    for handle in lesson._launched.values():
        handle.stop()
    lesson.run(1)
    order(widget, "call")
    assert widget.words == "Not asked: No node offers /navigate_to now."


def test_one_can_stop_waiting(lesson: Lesson) -> None:
    widget = lesson.form("/navigate_to")
    order(widget, "call")
    order(widget, "stop")
    lesson.run(5)
    assert widget.answer == "" and "No longer waiting for /navigate_to" in widget.words


def test_a_form_can_be_for_any_topic_and_service_that_is_there(lesson: Lesson) -> None:
    node = lesson._recording.node
    for name, _ in (*node.get_topic_names_and_types(), *node.get_service_names_and_types()):
        if is_hidden(name):  # of an action: its parts are no types of a form
            continue
        assert lesson.form(name).line.startswith(("ros2 topic pub --once ", "ros2 service call "))


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("/navigate", 'Did you mean "/navigate_to"?'),
        ("turtle1/cmdvel", 'Did you mean "/turtle1/cmd_vel"?'),
        ("/zzz", "There are: /clear, /kill"),
        ("", "a topic or a service such as"),
        (None, "a topic or a service such as"),
    ],
)
def test_unknown_names(lesson: Lesson, name: Any, said: str) -> None:
    with pytest.raises(ValueError) as raised:
        lesson.form(name)
    assert said in str(raised.value)


@pytest.mark.parametrize(
    "content",
    [
        {"do": "edit", "path": "nowhere", "text": "1"},
        {"do": "edit", "path": "linear", "text": "1"},
        {"do": "edit", "path": "linear/x", "text": 1},
        {"do": "edit", "path": "linear/x", "text": True},
        {"do": "rate", "rate": "fast"},
        {"do": "rate", "rate": 0},
        {"do": "_publish", "message": None},
        {"do": 7},
    ],
)
def test_nonsense_from_outside_is_said_in_words(lesson: Lesson, content: dict[str, Any]) -> None:
    widget = lesson.form("/turtle1/cmd_vel")
    widget._order(widget, {"view": "v", **content}, [])
    assert widget.words and widget.published == 0


def test_its_text_is_exact_and_showing_it_is_not_seen(lesson: Lesson) -> None:
    widget = lesson.form("/turtle1/cmd_vel")
    kept = lesson._recording.node.count_publishers("/turtle1/cmd_vel")
    assert kept == 1
    assert repr(widget) == (
        "Form for messages on /turtle1/cmd_vel (geometry_msgs/msg/Twist): "
        'ros2 topic pub --once /turtle1/cmd_vel geometry_msgs/msg/Twist "{}"'
    )


def test_it_stops_when_its_last_view_closes() -> None:
    async def page() -> int:
        lesson = start()
        widget = lesson.form("/turtle1/cmd_vel")
        order(widget, "open")
        order(widget, "repeat")
        await asyncio.sleep(0.2)
        order(widget, "close")
        lesson.pause()
        published = widget.published
        lesson.run(2)
        return widget.published - published

    assert asyncio.run(page()) == 0
