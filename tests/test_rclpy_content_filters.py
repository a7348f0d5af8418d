"""Content filters: a subscription says which messages it wants, in the language of DDS."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import pytest
import rclpy
from builtin_interfaces.msg import Time
from geometry_msgs.msg import Point, PolygonStamped, PoseWithCovariance, Twist
from hypothesis import given, settings
from hypothesis import strategies as st
from message_filters import Subscriber
from program_terminal import Terminal, having
from rclpy._content_filter import content_filter
from rclpy._filter_language import FilterError
from rclpy._rclpy_pybind11 import RCLError
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from rclpy.serialization import deserialize_message
from rclpy.subscription_content_filter_options import ContentFilterOptions
from sensor_msgs.msg import BatteryState, LaserScan
from std_msgs.msg import Bool, Byte, Int32, String, UInt8MultiArray
from turtlesim.msg import Pose

from turtle_lesson.ros.graph.network import conditions
from turtle_lesson.ros.world import World

Run = Callable[..., list[Any]]


def passes(message: Any, expression: str, *parameters: str) -> bool:
    return content_filter(type(message), expression, list(parameters))(message)


@pytest.fixture
def node(world: World) -> Node:
    rclpy.init()
    return rclpy.create_node("n")


def hear(node: Node, publisher: Any, found: list[Any], *numbers: int) -> list[Any]:
    """Publish numbers, spin, and hand over what has come."""
    found.clear()
    for number in numbers:
        publisher.publish(Int32(data=number))
    for _ in numbers:
        rclpy.spin_once(node, timeout_sec=0.1)
    return [message.data for message in found]


# -- on a topic --------------------------------------------------------------------------------------------------------


def test_a_subscription_hears_what_its_filter_lets_in(node: Node) -> None:
    found: list[Any] = []
    publisher = node.create_publisher(Int32, "numbers", 10)
    options = ContentFilterOptions(filter_expression="data > %0", expression_parameters=["15"])
    subscription = node.create_subscription(Int32, "numbers", found.append, 10, content_filter_options=options)
    everything: list[Any] = []
    node.create_subscription(Int32, "numbers", everything.append, 10)
    assert subscription.is_cft_enabled is subscription.is_cft_supported is True
    assert subscription.get_content_filter() == options
    assert hear(node, publisher, found, 10, 20, 30) == [20, 30]
    for _ in range(3):
        rclpy.spin_once(node, timeout_sec=0.1)
    assert [message.data for message in everything] == [10, 20, 30]


def test_a_filter_can_be_set_changed_and_taken_away(node: Node) -> None:
    found: list[Any] = []
    publisher = node.create_publisher(Int32, "numbers", 10)
    subscription = node.create_subscription(Int32, "numbers", found.append, 10)
    assert subscription.is_cft_enabled is False
    assert hear(node, publisher, found, 1, 2, 3) == [1, 2, 3]
    subscription.set_content_filter("data <> %0", ["2"])
    assert subscription.is_cft_enabled is True
    assert hear(node, publisher, found, 1, 2, 3) == [1, 3]
    subscription.set_content_filter(filter_expression="data = 2", expression_parameters=[])
    assert hear(node, publisher, found, 1, 2, 3) == [2]
    subscription.set_content_filter("", [])
    assert subscription.is_cft_enabled is False
    assert hear(node, publisher, found, 1, 2, 3) == [1, 2, 3]


def test_publishers_that_come_later_and_kept_messages_are_filtered_too(node: Node) -> None:
    found: list[Any] = []
    kept = QoSProfile(depth=5, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    early = node.create_publisher(Int32, "numbers", kept)
    hear(node, early, found, 1, 20)
    options = ContentFilterOptions("data > 10", [])
    node.create_subscription(Int32, "numbers", found.append, kept, content_filter_options=options)
    late = node.create_publisher(Int32, "numbers", kept)
    assert hear(node, late, found, 2, 30) == [20, 30]


def test_what_is_filtered_out_does_not_fill_the_queue(node: Node) -> None:
    found: list[Any] = []
    publisher = node.create_publisher(Int32, "numbers", 10)
    options = ContentFilterOptions("data = 1", [])
    node.create_subscription(Int32, "numbers", found.append, 1, content_filter_options=options)
    assert hear(node, publisher, found, 1, 2, 3, 4) == [1]


def test_raw_messages_and_message_filters_are_filtered(node: Node) -> None:
    found: list[Any] = []
    publisher = node.create_publisher(Int32, "numbers", 10)
    options = ContentFilterOptions("data >= 2", [])
    node.create_subscription(Int32, "numbers", found.append, 10, raw=True, content_filter_options=options)
    with_filter = Subscriber(node, Int32, "numbers", qos_profile=10, content_filter_options=options)
    heard: list[int] = []
    with_filter.registerCallback(lambda message: heard.append(message.data))
    for number in (1, 2, 3):
        publisher.publish(Int32(data=number))
    for _ in range(6):
        rclpy.spin_once(node, timeout_sec=0.1)
    assert [deserialize_message(each, Int32).data for each in found] == heard == [2, 3]


def test_a_lossy_network_carries_what_is_filtered(world: World, run: Run) -> None:
    def talk(_: list[Any]) -> None:
        rclpy.init()
        node = rclpy.create_node("talker")
        publisher = node.create_publisher(Int32, "numbers", 100)
        for number in range(100):
            publisher.publish(Int32(data=number))

    def listen(found: list[Any]) -> None:
        rclpy.init()
        node = rclpy.create_node("listener")
        options = ContentFilterOptions("data >= 95", [])
        node.create_subscription(
            Int32, "numbers", lambda message: found.append(message.data), 10, content_filter_options=options
        )
        rclpy.spin(node)

    world.graph.set_network("/numbers", conditions(loss=0.3))
    assert run(listen, talk) == [95, 96, 97, 98, 99]


def test_a_turtle_is_watched_at_the_wall_only(world: World, run: Run) -> None:
    def watch(found: list[Any]) -> None:
        rclpy.init()
        node = rclpy.create_node("watch")
        options = ContentFilterOptions("x > %0 AND linear_velocity <> 0", ["8.5"])
        node.create_subscription(
            Pose, "turtle1/pose", lambda pose: found.append(pose.x), 10, content_filter_options=options
        )
        drive = node.create_publisher(Twist, "turtle1/cmd_vel", 10)
        twist = Twist()
        twist.linear.x = 2.0
        node.create_timer(0.5, lambda: drive.publish(twist))
        rclpy.spin(node)

    from turtle_lesson.turtlesim.node import main

    world.spawn(main, name="turtlesim")
    xs = run(watch, seconds=3.0)
    assert 20 < len(xs) < 100
    assert 8.5 < min(xs) < 8.6


def test_the_program_of_the_demo(terminal: Terminal) -> None:
    programs = ("first_steps frost_guard guard", "first_steps frost_guard thermometer")
    printed = terminal.run(*programs, seconds=4.7)
    assert having(printed, "guard") == [
        "0.0 guard: listening for data < %0 OR data > %1 with 0.0, 70.0",
        "0.5 guard WARN: Frost: -50.0",
        "1.0 guard WARN: Frost: -30.0",
        "1.5 guard WARN: Frost: -10.0",
        "4.0 guard WARN: Fire: 90.0",
        "4.5 guard WARN: Frost: -50.0",
    ]
    assert len(having(printed, "thermometer")) == 9
    terminal.say("ros2 param set /guard frost -- -40.0")
    assert having(terminal.run(seconds=5.5), "guard") == ["8.0 guard WARN: Fire: 90.0", "8.5 guard WARN: Frost: -50.0"]


# -- the language ------------------------------------------------------------------------------------------------------

POSE = Pose(x=5.5, y=-2.0, theta=0.0, linear_velocity=1.0)


@pytest.mark.parametrize(
    ("expression", "parameters"),
    [
        ("x > 5", ()),
        ("x>5", ()),
        ("5 < x", ()),
        ("x = 5.5", ()),
        ("x = 55e-1", ()),
        ("y = -2", ()),
        ("y <> x", ()),
        ("y != x and x >= %0", ("5.5",)),
        ("x BETWEEN 5.5 AND 6", ()),
        ("x not between %1 and %0", ("9", "8")),
        ("NOT x > 6", ()),
        ("NOT NOT x > 5", ()),
        ("NOT (x > 6 OR y > 0)", ()),
        ("( x > 6 OR ( y < 0 ) )", ()),
        ("x > 0x5", ()),
        ("theta = 0 OR theta = 1 AND x > 5", ()),
    ],
)
def test_what_is_true_of_a_pose(expression: str, parameters: tuple[str, ...]) -> None:
    assert passes(POSE, expression, *parameters)
    assert not passes(POSE, f"NOT ({expression})", *parameters)


def test_and_and_or_are_taken_from_the_left() -> None:
    """As Fast DDS takes them; SQL takes AND first. With parentheses all agree."""
    assert not passes(POSE, "x = 5.5 OR y = 0 AND y = 1")
    assert passes(POSE, "x = 5.5 OR (y = 0 AND y = 1)")
    assert not passes(POSE, "NOT x = 5.5 AND y = 0")


def test_texts() -> None:
    hello = String(data="Hello World: 10")
    assert passes(hello, "data = %0", "'Hello World: 10'")
    assert passes(hello, "data LIKE 'Hello%'")
    assert passes(hello, "data like '%:_1_'")
    assert passes(hello, "data LIKE 'H*W*?'")
    assert passes(hello, "data MATCH '[A-Z].*[0-9]+'")
    assert passes(hello, "data < 'Help'")
    assert not passes(hello, "data LIKE 'Hello'")
    assert not passes(hello, "data LIKE '%.%'")
    assert not passes(hello, "data LIKE %0", "'hello%'")
    assert passes(String(data="%"), "'100%' LIKE data OR data = '%'")


def test_flags_bytes_and_small_numbers() -> None:
    assert passes(Bool(data=True), "data = TRUE")
    assert passes(Bool(data=True), "data = %0", "true")
    assert passes(Bool(data=False), "data = 0")
    assert passes(Byte(data=b"\x07"), "data BETWEEN 7 AND 7")
    assert passes(BatteryState(power_supply_status=2), "power_supply_status = 2 AND present = FALSE")


def test_fields_of_fields_and_values_of_arrays() -> None:
    twist = Twist()
    twist.angular.z = 0.5
    assert passes(twist, "angular.z > linear.x")
    pose = PoseWithCovariance()
    pose.covariance[35] = 0.25
    assert passes(pose, "covariance[35] = 0.25 AND covariance[0] < covariance[35] AND pose.orientation.w = 1")
    polygon = PolygonStamped()
    polygon.header.stamp = Time(sec=3)
    assert passes(polygon, "header.stamp.sec = 3 AND header.frame_id = ''")
    assert passes(UInt8MultiArray(data=[1, 2]), "data[1] > data[0]")
    assert passes(LaserScan(ranges=[0.4, math.inf]), "ranges[0] < 0.5 AND ranges[1] > 1e30")


def test_a_value_that_is_not_there_lets_nothing_in() -> None:
    empty = LaserScan()
    assert not passes(empty, "ranges[0] > 1")
    assert not passes(empty, "NOT ranges[0] > 1")
    assert not passes(empty, "ranges[0] > 1 OR ranges[0] <= 1")


def test_numbers_are_compared_as_the_wire_has_them() -> None:
    def received(message: Any) -> Any:
        return message._wire_copy()

    assert passes(received(Pose(x=0.1)), "x = 0.1")  # both are rounded to a float32
    assert passes(Point(x=0.1), "x = 0.1")
    assert passes(received(Pose(x=math.nan)), "x = 7")  # as Fast DDS has it: neither is greater
    assert passes(Int32(data=2**24 + 1), "data = 16777216.0")
    assert passes(Int32(data=2**24 + 1), "data > 16777216")


REFUSED = [
    (Pose, "x == 3", (), "expected a comparison such as = or > behind 'x', got '== 3': write a single = for equality"),
    (Pose, "x > ", (), "expected a field or a value behind 'x >', got the end"),
    (Pose, "(x > 1", (), "expected AND, OR or ) behind '(x > 1', got the end"),
    (Pose, "x > 1)", (), "expected AND, OR or the end behind 'x > 1', got ')'"),
    (Pose, "x > 1 && y > 2", (), "got '&& y > 2': write AND"),
    (Pose, "x > 1 And y > 2", (), "write AND or and, not And"),
    (Pose, "x BETWEEN 1 OR 2", (), "expected AND and the upper end behind 'x BETWEEN 1', got 'OR 2'"),
    (Pose, "x > %100", (), "parameters are %0 to %99"),
    (Pose, "5 > %0", ("3",), "no field of the message is compared in '5 > %0'"),
    (Pose, "x > %1", ("5",), "the expression uses %1, and expression_parameters holds 1"),
    (Pose, "x > %0", ("five",), "single quotes are values; write \"'five'\" for a text"),
    (Pose, "x > %0", ("",), "the parameter '' is not a value"),
    (Pose, "lineal_velocity > 0", (), "has no field 'lineal_velocity'; did you mean 'linear_velocity'?"),
    (Pose, "z > 3", (), "turtlesim/msg/Pose has no field 'z'; it has x, y, theta"),
    (Pose, "x > 'a'", (), "'x' is a float32 and 'a' is a text: they cannot be compared"),
    (Pose, "x = TRUE", (), "they cannot be compared"),
    (Pose, "x LIKE '5%'", (), "LIKE compares texts; 'x' is a float32"),
    (Pose, "x[0] > 3", (), "'x' is one float32"),
    (Pose, "x.y > 3", (), "a float32 has no fields, and so no 'y'"),
    (Pose, "x > 99999999999999999999", (), "has more than 64 bits"),
    (Pose, "(" * 60 + "x > 1" + ")" * 60, (), "more than 50 nested parentheses"),
    (
        Twist,
        "linear > 3",
        (),
        "'linear' is a whole geometry_msgs/msg/Vector3: name one of its fields, such as linear.x",
    ),
    (LaserScan, "ranges > 3", (), "say which of its values, such as ranges[0]"),
    (PoseWithCovariance, "covariance[36] > 3", (), "there is no [36], the last one is [35]"),
    (String, "data = 5", (), "'data' is a text and 5 is an integer"),
    (String, 'data = "hello"', (), "texts stand in single quotes: 'hello'"),
    (String, "data = 'hello", (), "the text has no end"),
    (String, "data MATCH '('", (), "is not a regular expression"),
]


@pytest.mark.parametrize(("kind", "expression", "parameters", "text"), REFUSED)
def test_a_wrong_filter_says_what_to_write(kind: type, expression: str, parameters: Any, text: str) -> None:
    with pytest.raises(FilterError) as caught:
        content_filter(kind, expression, list(parameters))
    assert text in str(caught.value)


def test_a_wrong_filter_makes_no_subscription_and_leaves_the_one_before(node: Node) -> None:
    wrong = ContentFilterOptions("datum > 1", [])
    with pytest.raises(
        RCLError, match=r"^Failed to create subscription: create_contentfilteredtopic\(\) failed .*datum"
    ):
        node.create_subscription(Int32, "numbers", print, 10, content_filter_options=wrong)
    assert node.count_subscribers("numbers") == 0
    subscription = node.create_subscription(Int32, "numbers", print, 10)
    set_filter = subscription.set_content_filter
    with pytest.raises(RCLError, match=r"^Failed to set cft expression parameters: create_contentfiltered.*'datum'"):
        set_filter(*wrong)
    with pytest.raises(RCLError, match=r"^Failed to set cft .*: current subscriber has no content filter topic$"):
        set_filter("", [])
    with pytest.raises(
        RCLError, match=r"^Failed to get cft .*: this subscriber has not created a ContentFilteredTopic$"
    ):
        subscription.get_content_filter()
    set_filter("data > 1", [])
    with pytest.raises(RCLError, match=r"failed to set_filter_expression: .*'datum'"):
        set_filter(*wrong)
    assert subscription.get_content_filter() == ("data > 1", [])


def test_parameters_are_texts(node: Node) -> None:
    subscription = node.create_subscription(Int32, "numbers", print, 10)
    for expression, parameters, text in [
        ("data > %0", [5], "expression_parameters are texts, got 5: write '5'"),
        ("data > %0", "5", "expression_parameters must be a list of str"),
        (7, [], "filter_expression must be a str"),
    ]:
        with pytest.raises(TypeError, match=text):
            subscription.set_content_filter(expression, parameters)  # type: ignore[arg-type]
    with pytest.raises(RCLError, match="101 parameters were given, and 100 can be"):
        subscription.set_content_filter("data > %0", ["5"] * 101)
    with pytest.raises(
        AttributeError, match="'str' object has no attribute 'filter_expression': a filter is made with"
    ):
        node.create_subscription(Int32, "numbers", print, 10, content_filter_options="data > 5")  # type: ignore[arg-type]


# -- any expression ----------------------------------------------------------------------------------------------------

WORDS = """x y theta data ranges[0] x[0] linear.x 5 -2.5 1e9 %0 %1 'a%' 'b' TRUE ( ) = <> < >= == AND or NOT BETWEEN
like MATCH ' % . [ ] ! & é"""
PIECES = st.sampled_from(WORDS.split())
WRITTEN = st.lists(PIECES | st.text(max_size=3), max_size=12).map(" ".join)


@settings(max_examples=300)
@given(WRITTEN, st.lists(WRITTEN, max_size=2))
def test_whatever_is_written_is_understood_or_refused(expression: str, parameters: list[str]) -> None:
    for message in (POSE, String(data="a"), LaserScan()):
        try:
            verdict = passes(message, expression, *parameters)
        except FilterError:
            continue
        assert isinstance(verdict, bool)


def test_long_expressions_are_no_trouble() -> None:
    assert passes(POSE, " AND ".join(["x > 5"] * 5000))
    assert passes(POSE, "NOT " * 5000 + "x > 5")
    assert not passes(String(data="a" * 2000), "data LIKE '" + "%a" * 30 + "%b'")


NUMBERS = st.integers(-5, 5)
SIGNS = {"=": "==", "<>": "!=", "!=": "!=", "<": "<", "<=": "<=", ">": ">", ">=": ">="}
Both = tuple[str, str]
"""A condition in the filter's language and in Python's."""


def compared(one: str, sign: str, other: str) -> Both:
    return f"{one} {sign} {other}", f"({one} {SIGNS[sign]} {other})"


OPERANDS = NUMBERS.map(str) | st.sampled_from(["x", "y"])
LEAVES = st.builds(compared, st.sampled_from(["x", "y"]), st.sampled_from(list(SIGNS)), OPERANDS) | st.builds(
    lambda low, high: (f"x BETWEEN {low} AND {high}", f"({low} <= x <= {high})"), NUMBERS, NUMBERS
)


def combined(part: st.SearchStrategy[Both]) -> st.SearchStrategy[Both]:
    joined = st.builds(
        lambda one, word, other: (f"({one[0]}) {word} ({other[0]})", f"({one[1]} {word.lower()} {other[1]})"),
        part,
        st.sampled_from(["AND", "OR"]),
        part,
    )
    return joined | part.map(lambda one: (f"NOT ({one[0]})", f"(not {one[1]})"))


@settings(max_examples=200)
@given(st.recursive(LEAVES, combined, max_leaves=8), NUMBERS, NUMBERS)
def test_a_filter_agrees_with_python(both: Both, x: int, y: int) -> None:
    written, python = both
    assert passes(Point(x=float(x), y=float(y)), written) == eval(python, {"x": x, "y": y})
