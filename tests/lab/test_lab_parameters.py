"""The parameters panel: what a node says of its parameters, setting them, refusals, and what others change."""

from __future__ import annotations

import asyncio
from typing import Any

import pytest
from lab_fakes import order

from turtle_lesson import Lesson, start
from turtle_lesson.lab.widgets.parameters import (
    BOOL,
    BYTES,
    DOUBLE,
    DOUBLES,
    INTEGER,
    NOT_SET,
    STRING,
    STRINGS,
    read_parameter,
    shown_parameter,
)


def item(widget: Any, name: str) -> dict[str, Any]:
    return next(each for each in widget.items if each["name"] == name)


def example(lesson: Lesson, **options: Any) -> None:
    """A node with a parameter of each kind."""
    import rclpy
    from rcl_interfaces.msg import IntegerRange, ParameterDescriptor, SetParametersResult

    def main() -> None:
        rclpy.init()
        node = rclpy.create_node("example", **options)
        node.declare_parameter("flag", True)
        steps = IntegerRange(from_value=0, to_value=10, step=5)
        node.declare_parameter("steps", 5, ParameterDescriptor(integer_range=[steps], description="In fives"))
        node.declare_parameter("name", "turtle")
        node.declare_parameter("weights", [1.0, 2.5])
        node.declare_parameter("fixed", 3, ParameterDescriptor(read_only=True))
        node.declare_parameter("any", 1, ParameterDescriptor(dynamic_typing=True))

        def judge(parameters: Any) -> Any:
            bad = any(each.name == "name" and each.value == "hare" for each in parameters)
            return SetParametersResult(successful=not bad, reason="no hares here" if bad else "")

        node.add_on_set_parameters_callback(judge)
        rclpy.spin(node)

    lesson._world.spawn(main, name="example")
    lesson.run(0.1)


def test_it_asks_without_moving_time_and_shows_what_the_node_says(lesson: Lesson) -> None:
    before = lesson.now
    panel = lesson.parameters("/navigator")
    assert lesson.now == before and panel.standing
    assert repr(panel) == "Parameters of /navigator: Asked /navigator; it answers once robot time passes."
    lesson.run(1)
    assert repr(panel).startswith("/navigator has 7 parameters: use_sim_time = False, goal_timeout = 5.0, ")
    speed = item(panel, "linear_speed")
    assert (speed["control"], speed["low"], speed["high"]) == ("slider", 0.01, 10.0)
    assert speed["help"] == "Highest speed, m/s; it comes down near the goal"
    assert panel.problem == "" and not panel.standing


def test_asking_now_takes_a_moment_of_robot_time(lesson: Lesson) -> None:
    panel = lesson.parameters("navigator")
    before = lesson.now
    order(panel, "ask")
    assert len(panel.items) == 7 and 0 < lesson.now - before <= 0.05


def test_each_kind_has_its_control(lesson: Lesson) -> None:
    example(lesson)
    panel = lesson.parameters("/example")
    order(panel, "ask")
    controls = {each["name"]: each["control"] for each in panel.items if each["name"] != "use_sim_time"}
    assert controls == {
        "flag": "checkbox", "steps": "slider", "name": "text", "weights": "text", "fixed": "number", "any": "number"
    }  # fmt: skip
    assert item(panel, "weights")["value"] == "[1.0, 2.5]" and item(panel, "flag")["value"] is True
    assert item(panel, "fixed")["locked"].startswith("read-only")
    assert item(panel, "steps")["step"] == 5 and item(panel, "steps")["help"] == "In fives"


def test_values_of_all_kinds_are_set(lesson: Lesson) -> None:
    example(lesson)
    panel = lesson.parameters("/example")
    order(panel, "ask")
    typed = {"flag": False, "steps": "10", "name": "Ada: {x}", "weights": "[3, 4.5]", "any": "[a, b]"}
    for name, value in typed.items():
        order(panel, "set", name=name, value=value)
        assert item(panel, name)["error"] == ""
    values = {each["name"]: each["value"] for each in panel.items}
    assert [values[name] for name in typed] == [False, "10", "Ada: {x}", "[3.0, 4.5]", "[a, b]"]
    assert panel.words == "any is [a, b] now."


def test_a_refusal_is_told_in_the_nodes_words_and_the_old_value_stays(lesson: Lesson) -> None:
    example(lesson)
    panel = lesson.parameters("/example")
    order(panel, "ask")
    order(panel, "set", name="name", value="hare")
    assert panel.words == "name stays turtle. Refused: no hares here"
    assert item(panel, "name")["value"] == "turtle" and item(panel, "name")["answers"] == 1
    order(panel, "set", name="steps", value="7")
    assert "steps" in item(panel, "steps")["error"] and item(panel, "steps")["value"] == "5"
    order(panel, "set", name="fixed", value="4")
    assert "read-only" in item(panel, "fixed")["error"]


def test_what_cannot_be_read_is_never_sent(lesson: Lesson) -> None:
    panel = lesson.parameters("/navigator")
    order(panel, "ask")
    before = lesson.now
    order(panel, "set", name="linear_speed", value="3,5")
    assert item(panel, "linear_speed")["error"].endswith("write a point, not a comma")
    order(panel, "set", name="nothing", value="1")
    assert panel.words == "/navigator has no parameter 'nothing'."
    assert lesson.now == before


def test_changes_from_elsewhere_are_followed(lesson: Lesson) -> None:
    from turtle_lesson.ros.cli.shell import run_line

    panel = lesson.parameters("/navigator")
    order(panel, "ask")
    run_line(lesson._world, "ros2 param set /navigator linear_speed 1.25")
    lesson.run(0.01)
    assert item(panel, "linear_speed")["value"] == "1.25"


def test_a_node_that_goes_and_comes_back(lesson: Lesson) -> None:
    panel = lesson.parameters("/navigator")
    order(panel, "ask")
    for handle in lesson._launched.values():
        handle.stop()
    lesson.run(1)
    look(panel)
    assert panel.problem == "/navigator is gone. The nodes now: /turtlesim."
    order(panel, "set", name="linear_speed", value="1.0")
    assert item(panel, "linear_speed")["error"] and "/navigator is gone" in panel.words
    lesson.launch("robot_controller", "start_system.launch.py")
    look(panel)
    lesson.run(1)
    look(panel)
    assert panel.problem == "" and len(panel.items) == 7


def look(panel: Any) -> None:
    panel._paces.clear()
    panel.tick()


def test_a_node_without_services_for_its_parameters(lesson: Lesson) -> None:
    example(lesson, start_parameter_services=False)
    panel = lesson.parameters("/example")
    assert panel.problem == "/example offers no services for its parameters (start_parameter_services=False)."


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("/navigater", 'Did you mean "/navigator"?'),
        ("/zzz", "There are: /navigator, /obstacle_detector, /status_monitor, /turtlesim."),
        (None, 'such as "/navigator"'),
    ],
)
def test_unknown_nodes(lesson: Lesson, name: Any, said: str) -> None:
    with pytest.raises(ValueError) as raised:
        lesson.parameters(name)
    assert said in str(raised.value)


def test_a_change_while_time_goes_on_needs_no_step() -> None:
    async def page() -> tuple[str, str]:
        lesson = start()
        lesson.launch("robot_controller", "start_system.launch.py")
        panel = lesson.parameters("/navigator")
        lesson.play()
        await asyncio.sleep(0.2)
        order(panel, "set", name="linear_speed", value="2")
        asked = panel.words
        await asyncio.sleep(0.2)
        lesson.pause()
        return asked, panel.words

    asked, answered = asyncio.run(page())
    assert asked == "Asked /navigator to set linear_speed; its answer comes once robot time passes."
    assert answered == "linear_speed is 2.0 now."


@pytest.mark.parametrize(
    ("typed", "kind", "value"),
    [
        (True, BOOL, "True"),
        ("−3", INTEGER, "-3"),
        ("2", DOUBLE, "2.0"),
        ("2", STRING, "2"),
        ("[1, 2]", DOUBLES, "[1.0, 2.0]"),
        ("[]", STRINGS, "[]"),
        ("[x, 'y: z']", STRINGS, "[x, 'y: z']"),
        ("[0, 255]", BYTES, "[0, 255]"),
        ("5", NOT_SET, "5"),
        ("true", NOT_SET, "True"),
        ("hello", NOT_SET, "hello"),
    ],
)
def test_values_are_read_by_their_type_and_shown(typed: Any, kind: int, value: str) -> None:
    assert shown_parameter(read_parameter(typed, kind)) == value


@pytest.mark.parametrize(
    ("typed", "kind", "said"),
    [
        ("yes", BOOL, "do not agree"),
        ("1.5", INTEGER, "a whole number such as 3 is wanted, got"),
        (str(2**64), INTEGER, "to 9223372036854775807 fits here"),
        ("x", DOUBLE, 'a number such as 1.5 is wanted, got "x"'),
        ("1, 2", DOUBLES, "a list such as [1.5, 2.0]"),
        ("[1, a]", DOUBLES, "could not convert string to float: 'a'"),
        ("[1", DOUBLES, "a list such as"),
        ("[1]", STRINGS, "do not agree"),
    ],
)
def test_what_a_value_cannot_be(typed: Any, kind: int, said: str) -> None:
    with pytest.raises(ValueError) as raised:
        read_parameter(typed, kind)
    assert said in str(raised.value)
