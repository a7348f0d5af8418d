"""rosidl_runtime_py: interfaces by name, messages as text and text as messages, as programs use it.

What the real one answers to YAML, and how it prints messages, is pinned in test_command_values.py, by recordings.
"""

from __future__ import annotations

from array import array
from collections import OrderedDict
from enum import IntEnum
from typing import Any

import builtin_interfaces.msg as builtin
import geometry_msgs.msg as geometry
import nav_msgs.msg as nav
import numpy as np
import pytest
import rosidl_runtime_py as api
import sensor_msgs.msg as sensors
import std_msgs.msg as std
import std_srvs.srv as services
import turtlesim.action as actions
import yaml
from hypothesis import assume, given
from hypothesis import strategies as st
from interface_cases import built_in, messages
from rosidl_parser.definition import (
    AbstractGenericString,
    AbstractNestedType,
    AbstractSequence,
    Array,
    BasicType,
    BoundedSequence,
    NamespacedType,
    UnboundedSequence,
    UnboundedString,
)
from rosidl_runtime_py import message_to_csv, message_to_ordereddict, message_to_yaml, set_message_fields
from rosidl_runtime_py import utilities as by_name

from turtle_lesson.ros.idl.registry import registry

# -- by name -------------------------------------------------------------------------------------------------------------


def test_interfaces_are_found_by_their_full_names() -> None:
    assert by_name.get_interface("geometry_msgs/msg/Twist") is geometry.Twist
    assert by_name.get_message("geometry_msgs/Twist") is geometry.Twist
    assert by_name.get_service("std_srvs/srv/Empty") is by_name.get_service("std_srvs/Empty") is services.Empty
    assert by_name.get_action("turtlesim/RotateAbsolute") is actions.RotateAbsolute
    feedback = by_name.get_interface("turtlesim/action/RotateAbsolute_FeedbackMessage")
    assert feedback is actions.RotateAbsolute.Impl.FeedbackMessage


@pytest.mark.parametrize(
    ("get", "name", "error", "said"),
    [
        (
            "get_message",
            "std_srvs/srv/Empty",
            ValueError,
            "Expected the full name of a message, got 'std_srvs/srv/Empty'",
        ),
        (
            "get_service",
            "std_msgs/msg/Bool",
            ValueError,
            "Expected the full name of a service, got 'std_msgs/msg/Bool'",
        ),
        (
            "get_action",
            "std_srvs/srv/Empty",
            ValueError,
            "Expected the full name of an action, got 'std_srvs/srv/Empty'",
        ),
        ("get_message", "Twist", ValueError, "Empty module name"),
        ("get_message", "/Twist", ValueError, "Empty module name"),
        ("get_message", "", ValueError, "Empty module name"),
        ("get_message", "nope_msgs/msg/Twist", ModuleNotFoundError, "No module named 'nope_msgs'"),
        ("get_message", "std_msgs/srv/Bool", ModuleNotFoundError, "No module named 'std_msgs.srv'"),
        ("get_message", "std_msgs/msg/Boool", AttributeError, "has no attribute 'Boool'. Did you mean 'Bool'?"),
        ("get_interface", "std_msgs/Bool", AttributeError, "has no attribute 'Bool'"),
    ],
)
def test_what_is_not_there_is_refused_as_by_the_real_one(get: str, name: str, error: Any, said: str) -> None:
    with pytest.raises(error) as caught:
        getattr(by_name, get)(name)
    assert type(caught.value) is error
    assert said in str(caught.value)


def test_kinds_are_told_apart() -> None:
    kinds = [std.Empty, services.Empty, actions.RotateAbsolute]
    assert [by_name.is_message(kind) for kind in kinds] == [True, False, False]
    assert [by_name.is_service(kind) for kind in kinds] == [False, True, False]
    assert [by_name.is_action(kind) for kind in kinds] == [False, False, True]


# -- messages as text ----------------------------------------------------------------------------------------------------


def test_a_message_becomes_a_dictionary() -> None:
    stamped = geometry.PointStamped(point=geometry.Point(x=1.0))
    plain = message_to_ordereddict(stamped)
    assert type(plain) is type(plain["point"]) is OrderedDict
    assert list(plain) == ["header", "point"]
    assert plain["point"] == {"x": 1.0, "y": 0.0, "z": 0.0}
    assert plain["header"]["stamp"] == {"sec": 0, "nanosec": 0}


def test_arrays_become_lists_and_numbers_plain() -> None:
    imu = sensors.Imu()
    imu.orientation_covariance[0] = 0.5
    covariance = message_to_ordereddict(imu)["orientation_covariance"]
    assert covariance == [0.5] + [0.0] * 8 and type(covariance[0]) is float
    grades = IntEnum("Grades", "GOOD BAD")
    odd = std.Int32(data=grades.BAD)
    assert message_to_yaml(odd) == "data: 2\n"
    assert message_to_yaml(std.String(data=np.str_("a"))) == "data: a\n"
    assert message_to_yaml(std.Float64(data=np.float64(0.5))) == "data: 0.5\n"


def test_long_values_are_cut_and_left_out() -> None:
    scan = sensors.LaserScan(ranges=[1.0, 2.0, 3.0])
    scan.header.frame_id = "base_link"
    assert message_to_ordereddict(scan, truncate_length=2)["ranges"] == [1.0, 2.0, "..."]
    assert message_to_ordereddict(scan, truncate_length=4)["header"]["frame_id"] == "base..."
    assert message_to_ordereddict(scan, no_str=True)["header"]["frame_id"] == "<string length: <9>>"
    shown = message_to_ordereddict(scan, no_arr=True)
    assert (shown["ranges"], shown["intensities"]) == (
        "<sequence type: float, length: 3>",
        "<sequence type: float, length: 0>",
    )
    imu = message_to_ordereddict(sensors.Imu(), no_arr=True)
    assert imu["orientation_covariance"] == "<array type: double[9]>"
    assert message_to_csv(scan, truncate_length=2, no_str=True).startswith("0,0,<string length: <9>>,0.0")
    assert message_to_csv(scan, truncate_length=2).endswith("1.0,2.0,...,")
    array_in_a_line = message_to_yaml(std.UInt8MultiArray(data=[1, 2]), flow_style=True)
    assert array_in_a_line == "layout:\n  dim: []\n  data_offset: 0\ndata: [1, 2]\n"  # fields always have their lines


def test_the_types_of_fields_can_be_looked_at() -> None:
    types = api.get_message_slot_types(sensors.LaserScan())
    assert list(types)[:2] == ["header", "angle_min"]
    header, angle, ranges = types["header"], types["angle_min"], types["ranges"]
    assert isinstance(header, NamespacedType) and header.namespaced_name() == ("std_msgs", "msg", "Header")
    assert api.import_message_from_namespaced_type(header) is std.Header
    assert isinstance(angle, BasicType) and angle.typename == "float"
    assert isinstance(ranges, UnboundedSequence) and isinstance(ranges, AbstractSequence | AbstractNestedType)
    assert ranges.value_type == BasicType("float")
    fixed = api.get_message_slot_types(sensors.Imu())["orientation_covariance"]
    assert isinstance(fixed, Array)
    assert fixed.size == 9
    polygon = built_in.get("shape_msgs/SolidPrimitive").SLOT_TYPES[1]
    assert isinstance(polygon, BoundedSequence) and polygon.maximum_size == 3
    text = std.String.SLOT_TYPES[0]
    assert isinstance(text, UnboundedString) and isinstance(text, AbstractGenericString)


# -- text as messages ----------------------------------------------------------------------------------------------------


def test_values_are_put_in_and_left_alone() -> None:
    values = {"name": ["a", "b"], "position": [1, 2], "header": {"frame_id": "map", "stamp": {"sec": 3}}}
    joints = sensors.JointState()
    assert set_message_fields(joints, values) == []
    assert joints.position == array("d", [1.0, 2.0])
    assert (joints.header.frame_id, joints.header.stamp.sec) == ("map", 3)
    joints.name.append("c")
    assert values == {"name": ["a", "b"], "position": [1, 2], "header": {"frame_id": "map", "stamp": {"sec": 3}}}


def test_lists_of_messages_and_whole_messages() -> None:
    path = nav.Path()
    set_message_fields(path, {"poses": [{"pose": {"position": {"x": 1}}}, {}]})
    assert [each.pose.position.x for each in path.poses] == [1.0, 0.0]
    twist = geometry.Twist()
    linear = geometry.Vector3(x=2.0)
    set_message_fields(twist, {"linear": linear})
    assert twist.linear == linear and twist.linear is not linear
    imu = sensors.Imu()
    set_message_fields(imu, {"orientation_covariance": list(range(9))})
    assert imu.orientation_covariance.tolist() == [float(n) for n in range(9)]


def test_stamps_of_now_are_left_to_be_set() -> None:
    scan = sensors.LaserScan()
    [stamp] = set_message_fields(scan, {"header": "auto", "angle_min": 1}, expand_header_auto=True)
    stamp(builtin.Time(sec=5))
    assert (scan.header.stamp.sec, scan.angle_min) == (5, 1.0)
    values = {"header": {"stamp": "now", "frame_id": "hello"}}
    [stamp] = set_message_fields(scan, values, expand_header_auto=True, expand_time_now=True)
    stamp(builtin.Time(sec=7))
    assert (scan.header.stamp.sec, scan.header.frame_id) == (7, "hello")
    for values in ({"header": "auto"}, {"header": {"stamp": "now"}}):
        with pytest.raises(TypeError, match=r"^Value '(auto|now)' is expected to be a dictionary but is a str$"):
            set_message_fields(scan, values)


def test_errors_name_the_field_and_what_was_meant_perhaps() -> None:
    with pytest.raises(AttributeError, match=r"^'Twist' object has no attribute 'linaer'") as caught:
        set_message_fields(geometry.Twist(), {"linaer": {}})
    assert caught.value.__notes__ == ["Did you mean 'linear'?"]
    with pytest.raises(ValueError, match="invalid literal for int"):
        set_message_fields(std.Int32(), {"data": "five"})
    with pytest.raises(TypeError, match=r"^Value 'data' is expected to be a dictionary but is a str$"):
        set_message_fields(std.Int32(), "data")  # type: ignore[arg-type]


def test_a_message_of_ones_own_making_will_do() -> None:
    """The functions look only at what every generated class has, not at anything of ours."""

    class Odd:
        SLOT_TYPES = (BasicType("double"), NamespacedType(["std_msgs", "msg"], "Header"))

        def __init__(self) -> None:
            self.far, self.header = 0.0, std.Header()

        @classmethod
        def get_fields_and_field_types(cls) -> dict[str, str]:
            return {"far": "double", "header": "std_msgs/Header"}

    odd = Odd()
    set_message_fields(odd, {"far": 2, "header": {"frame_id": "x"}})
    assert message_to_yaml(odd).splitlines()[0] == "far: 2.0"
    assert message_to_csv(odd) == "2.0,0,0,x"


# -- there and back ------------------------------------------------------------------------------------------------------


@given(st.data())
def test_what_is_printed_in_full_can_be_read_back(data: st.DataObject) -> None:
    packages = {package: registry.package(package).interface_names() for package in registry.packages()}
    names = [f"{package}/{name}" for package, found in packages.items() for name in found if name.startswith("msg/")]
    kind = by_name.get_message(data.draw(st.sampled_from(names)))
    message = data.draw(messages(kind, by_name.get_message))
    text = message_to_yaml(message)
    assume(text.isascii())  # YAML takes some rare characters for the end of a line
    values = yaml.safe_load(text)
    assert values == message_to_ordereddict(message)
    if not _holds_bytes(message):
        again = kind()
        set_message_fields(again, values)
        assert message_to_yaml(again) == text


def _holds_bytes(message: Any) -> bool:
    """Whether a byte is anywhere in it: these are printed as texts, which are not taken for bytes."""
    return "b'" in repr(message) or 'b"' in repr(message)


ODD: st.SearchStrategy[Any] = st.recursive(
    st.none()
    | st.booleans()
    | st.integers()
    | st.floats()
    | st.text(max_size=5)
    | st.sampled_from(["auto", "now", b"a"]),
    lambda inner: (
        st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=3) | st.just("data"), inner, max_size=3)
    ),
    max_leaves=6,
)


@given(st.data())
def test_any_values_are_taken_or_refused_in_words(data: st.DataObject) -> None:
    names = [
        "sensor_msgs/Imu",
        "sensor_msgs/LaserScan",
        "rcl_interfaces/ParameterValue",
        "nav_msgs/Path",
        "std_msgs/Byte",
    ]
    message = by_name.get_message(data.draw(st.sampled_from(names)))()
    fields = list(message.get_fields_and_field_types())
    values = data.draw(st.dictionaries(st.sampled_from(fields), ODD, max_size=3) | ODD)
    try:
        set_message_fields(message, values, expand_header_auto=True, expand_time_now=True)
    except (TypeError, AttributeError, ValueError, AssertionError, OverflowError) as error:
        assert str(error)
    assert message_to_yaml(message._wire_copy())
