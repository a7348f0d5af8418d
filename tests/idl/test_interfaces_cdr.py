"""Messages as bytes: what ROS 2 would send, and nothing but clear errors for bytes that are none."""

import struct

import pytest
from hypothesis import given
from hypothesis import strategies as st
from interface_cases import ROBOT_CONTROLLER, any_messages, built_in, message_class, write_package

from turtle_lesson.ros.idl.cdr import deserialize, serialize
from turtle_lesson.ros.idl.registry import Registry

CODES = {
    "bool": "?", "byte": "c", "char": "B", "float32": "f", "float64": "d", "int8": "b", "uint8": "B",
    "int16": "h", "uint16": "H", "int32": "i", "uint32": "I", "int64": "q", "uint64": "Q",
}  # fmt: skip

String, Empty = built_in.get("std_msgs/String"), built_in.get("std_msgs/Empty")
LaserScan, Imu = built_in.get("sensor_msgs/LaserScan"), built_in.get("sensor_msgs/Imu")
Twist = built_in.get("geometry_msgs/Twist")


@pytest.fixture(scope="module")
def robot(tmp_path_factory):
    registry = Registry()
    registry.add("robot_controller", write_package(tmp_path_factory.mktemp("robot"), ROBOT_CONTROLLER))
    return registry


class Writer:
    """CDR written a second time, from its rules: every number begins at a multiple of its size."""

    def __init__(self):
        self.body = bytearray()

    def number(self, code, value):
        self.body += bytes(-len(self.body) % struct.calcsize(code)) + struct.pack("<" + code, value)

    def value(self, type_, value):
        if not type_.is_primitive:
            self.message(value)
        elif type_.base == "wstring":
            units = value.encode("utf-16-le")
            self.number("I", len(units) // 2)
            for (unit,) in struct.iter_unpack("<H", units):
                self.number("I", unit)
        elif type_.base == "string":
            letters = value.encode() + b"\0"
            self.number("I", len(letters))
            self.body += letters
        else:
            self.number(CODES[type_.base], value)

    def message(self, message):
        fields = message._DEFINITION.fields
        if not fields:
            self.number("B", 0)
        for field in fields:
            value = getattr(message, field.name)
            if field.type.is_array and not field.type.is_fixed:
                self.number("I", len(value))
            for each in value if field.type.is_array else [value]:
                self.value(field.type, each)


def test_bytes_are_those_of_ros(robot):
    status = robot.get("robot_controller/msg/TurtleStatus")
    assert serialize(status(x=1.0)).hex() == "000100000000803f0000000000000000000000000000000000000000"
    assert serialize(String(data="hi")).hex() == "0001000003000000686900"
    assert serialize(Empty()).hex() == "0001000000"


def test_services_and_actions_travel_in_parts(robot):
    navigate = robot.get("robot_controller/srv/NavigateTo")
    answer = navigate.Response(success=True, time_taken=0.1)
    assert deserialize(serialize(answer), navigate.Response) == answer._wire_copy()
    turn = built_in.get("turtlesim/action/RotateAbsolute")
    goal = turn.Impl.SendGoalService.Request(goal=turn.Goal(theta=1.5))
    assert deserialize(serialize(goal), turn.Impl.SendGoalService.Request) == goal


@given(any_messages())
def test_any_message_comes_back_as_it_went(message):
    data = serialize(message)
    writer = Writer()
    writer.message(message)
    assert data == b"\0\1\0\0" + bytes(writer.body)
    received = deserialize(data, type(message))
    assert received == message._wire_copy()
    assert repr(received) == repr(message._wire_copy())


def test_what_came_in_can_be_changed():
    received = deserialize(serialize(Imu()), Imu)
    received.orientation_covariance[0] = 1.0
    received = deserialize(serialize(LaserScan(ranges=[1.0])), LaserScan)
    received.ranges.append(2.0)
    assert received.ranges.tolist() == [1.0, 2.0]


def test_big_endian_bytes_are_refused():
    with pytest.raises(ValueError, match="big endian"):
        deserialize(bytes.fromhex("0000000000000003686900"), String)


@given(st.data())
def test_bytes_cut_short_are_refused(data):
    whole = serialize(LaserScan(ranges=[1.0, 2.0]))
    cut = data.draw(st.integers(0, len(whole) - 1))
    with pytest.raises(ValueError, match="are not a message of type sensor_msgs/msg/LaserScan"):
        deserialize(whole[:cut], LaserScan)


@given(st.binary(max_size=200), any_messages())
def test_garbage_is_read_as_some_message_or_refused(garbage, message):
    kind = type(message)
    try:
        received = deserialize(b"\0\1\0\0" + garbage, kind)
    except ValueError as error:
        assert kind._TYPE_NAME in str(error)
    else:
        assert type(received) is kind


def test_bounds_hold_for_what_comes_in():
    short, long = message_class("int32[<=2] v"), message_class("int32[<=3] v")
    with pytest.raises(ValueError, match=r"3 elements in int32\[<=2\]"):
        deserialize(serialize(long(v=[1, 2, 3])), short)
    with pytest.raises(ValueError, match="6 characters in a string of at most 5"):
        deserialize(serialize(String(data="abcdef")), message_class("string<=5 data"))
    names = serialize(message_class("string[] v")(v=["abcdef"]))
    with pytest.raises(ValueError, match="6 characters in a string of at most 5"):
        deserialize(names, message_class("string<=5[] v"))
    with pytest.raises(ValueError, match=r"3 elements in byte\[<=2\]"):
        deserialize(serialize(message_class("byte[] v")(v=[b"a"] * 3)), message_class("byte[<=2] v"))


def test_lists_that_grew_too_long_are_not_sent():
    message = message_class("string[<=1] v")(v=["a"])
    message.v.append("b")
    with pytest.raises(ValueError, match=r"2 elements in string\[<=1\]"):
        serialize(message)


def test_wide_strings_travel_as_utf_16_in_four_bytes_a_unit():
    wide = built_in.get("example_interfaces/msg/WString")
    data = serialize(wide(data="a😀"))
    assert data.hex() == "00010000" + "03000000" + "61000000" + "3dd80000" + "00de0000"
    assert deserialize(data, wide) == wide(data="a😀")
    short = message_class("wstring<=2[<=2] data")
    assert deserialize(serialize(short(data=["ab", "ö"])), short) == short(data=["ab", "ö"])


@pytest.mark.parametrize(
    ("tail", "reason"),
    [
        ("0100000000000100", "greater than maximum"),
        ("010000003dd80000", "unexpected end of data|truncated data"),  # half of a character
        ("ffffffff", ""),
    ],
)
def test_wide_strings_that_are_none_are_refused(tail, reason):
    wide = built_in.get("example_interfaces/msg/WString")
    with pytest.raises(ValueError, match=f"are not a message of type example_interfaces/msg/WString.*({reason})"):
        deserialize(bytes.fromhex("00010000" + tail), wide)


def test_half_a_character_is_not_sent():
    for kind in (String, built_in.get("example_interfaces/msg/WString")):
        with pytest.raises(ValueError, match="cannot be written as CDR"):
            serialize(kind(data="\ud83d"))


def test_only_messages_are_sent(robot):
    navigate = robot.get("robot_controller/srv/NavigateTo")
    for wrong in (3, "text", Twist, navigate):
        with pytest.raises(TypeError, match="expected a message"):
            serialize(wrong)
    with pytest.raises(TypeError, match=r"give \.Request or \.Response"):
        deserialize(b"", navigate)


def test_a_changed_definition_has_bytes_of_its_own():
    old, new = message_class("int8 v"), message_class("int32 v")
    assert (len(serialize(old())), len(serialize(new())), len(serialize(old()))) == (5, 8, 5)
