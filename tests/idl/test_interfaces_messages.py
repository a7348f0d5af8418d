"""Message classes behave as Humble's generated ones do, as recorded there."""

import collections
import copy
import inspect
import math
import pickle
from array import array

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from interface_cases import ROBOT_CONTROLLER, any_messages, built_in, find_class, message_class, recorded, write_package

from turtle_lesson.ros.idl.message import (
    Array,
    BasicType,
    BoundedSequence,
    BoundedString,
    NamespacedType,
    UnboundedSequence,
    UnboundedString,
)
from turtle_lesson.ros.idl.registry import Registry, forget_modules, install_finder, uninstall_finder

RECORDED = recorded("interface_messages.json")

Twist, Vector3, Quaternion, PoseStamped, Imu, LaserScan, BatteryState, String, Pose, Log = (
    built_in.get(name)
    for name in (
        "geometry_msgs/msg/Twist",
        "geometry_msgs/msg/Vector3",
        "geometry_msgs/msg/Quaternion",
        "geometry_msgs/msg/PoseStamped",
        "sensor_msgs/msg/Imu",
        "sensor_msgs/msg/LaserScan",
        "sensor_msgs/msg/BatteryState",
        "std_msgs/msg/String",
        "turtlesim/msg/Pose",
        "rcl_interfaces/msg/Log",
    )
)


@pytest.fixture(scope="module")
def robot(tmp_path_factory):
    """A registry that also has the lesson's package; what other tests have imported of one is forgotten."""
    forget_modules("robot_controller")
    registry = Registry()
    registry.add("robot_controller", write_package(tmp_path_factory.mktemp("robot"), ROBOT_CONTROLLER))
    return registry


@pytest.fixture
def known(robot):
    """Names that the recorded expressions use."""
    own = {
        "TurtleStatus": robot.get("robot_controller/msg/TurtleStatus"),
        "NavigateTo": robot.get("robot_controller/srv/NavigateTo"),
        "NavigateTo_Request": robot.get("robot_controller/srv/NavigateTo_Request"),
        "NavigateTo_Response": robot.get("robot_controller/srv/NavigateTo_Response"),
        "np": np,
    }

    class Known(dict):
        def __missing__(self, name):
            return find_class(name)

    return Known(own | {"float": float})


def refused(kind, do):
    with pytest.raises(kind) as caught:
        do()
    return str(caught.value)


# What was recorded


@pytest.mark.parametrize(("name", "text"), RECORDED["shows"], ids=[name for name, _ in RECORDED["shows"]])
def test_a_message_shows_as_in_ros(known, name, text):
    assert repr(known[name]()) == str(known[name]()) == text


@pytest.mark.parametrize(
    "case", RECORDED["assignments"], ids=lambda case: f"{case['message']}.{case['field']} = {case['value']}"
)
def test_an_assignment_is_taken_or_refused_as_in_ros(known, case):
    message = known[case["message"]]()
    value = eval(case["value"], {}, known)
    if "reads" in case:
        setattr(message, case["field"], value)
        assert repr(getattr(message, case["field"])) == case["reads"]
    else:
        error = {"AssertionError": AssertionError, "AttributeError": AttributeError}[case["error"]]
        assert refused(error, lambda: setattr(message, case["field"], value)).startswith(case["text"])


@pytest.mark.parametrize("case", RECORDED["constructors"], ids=lambda case: case["call"])
def test_a_constructor_takes_and_refuses_as_in_ros(known, case):
    if "shows" in case:
        assert repr(eval(case["call"], {}, known)) == case["shows"]
    else:
        error = {"AssertionError": AssertionError, "TypeError": TypeError}[case["error"]]
        assert refused(error, lambda: eval(case["call"], {}, known)) == case["text"]


def test_the_names_of_classes_and_modules(known):
    status = known["TurtleStatus"]
    assert repr(status) == "<class 'robot_controller.msg._turtle_status.TurtleStatus'>"
    assert repr(type(status)) == "<class 'robot_controller.msg._turtle_status.Metaclass_TurtleStatus'>"
    assert repr(known["NavigateTo"]) == "<class 'robot_controller.srv._navigate_to.NavigateTo'>"
    assert status._TYPE_NAME == "robot_controller/msg/TurtleStatus"
    assert known["NavigateTo"]._TYPE_NAME == "robot_controller/srv/NavigateTo"
    assert known["NavigateTo"].Request._TYPE_NAME == "robot_controller/srv/NavigateTo_Request"


def test_a_message_says_what_it_is_made_of():
    assert Twist.__slots__ == ["_linear", "_angular"]
    types = Twist.get_fields_and_field_types()
    assert types == {"linear": "geometry_msgs/Vector3", "angular": "geometry_msgs/Vector3"}
    types.clear()
    assert Twist.get_fields_and_field_types()
    assert (NamespacedType(["geometry_msgs", "msg"], "Vector3"),) * 2 == Twist.SLOT_TYPES
    assert Twist._DEFINITION.full_name == "geometry_msgs/msg/Twist"


def test_a_service_cannot_be_made_but_its_parts_can(known):
    assert refused(NotImplementedError, known["NavigateTo"]) == "Service classes can not be instantiated"
    assert known["NavigateTo"].Response(success=True).success is True


def test_services_and_actions_show_that_they_are_no_messages(known):
    action = built_in.get("turtlesim/action/RotateAbsolute")
    assert [each._TYPE_SUPPORT.folder for each in (Twist, known["NavigateTo"], action)] == [
        "msg",
        "srv",
        "action",
    ]
    assert type(Twist)._TYPE_SUPPORT and Twist()._TYPE_SUPPORT


def test_an_action_has_goal_result_feedback_and_what_carries_them():
    action = built_in.get("turtlesim/action/RotateAbsolute")
    assert refused(NotImplementedError, action) == "Action classes can not be instantiated"
    assert repr(action.Goal(theta=1.0)) == "turtlesim.action.RotateAbsolute_Goal(theta=1.0)"
    request = action.Impl.SendGoalService.Request(goal=action.Goal(theta=2.0))
    assert len(request.goal_id.uuid) == 16
    assert request._wire_copy() == request
    assert action.Impl.FeedbackMessage().feedback == action.Feedback()
    assert action.Impl.GetResultService.Response().result == action.Result()
    assert action.Impl.CancelGoalService._TYPE_NAME == "action_msgs/srv/CancelGoal"
    assert action.Impl.GoalStatusMessage._TYPE_NAME == "action_msgs/msg/GoalStatusArray"


# Comparing, copying, sharing


def test_messages_compare_by_their_fields():
    Point = built_in.get("geometry_msgs/msg/Point")
    assert Twist() == Twist() and Twist(linear=Vector3(x=1.0)) != Twist()
    assert Vector3() != Point()
    assert Vector3(x=math.nan) != Vector3(x=math.nan)
    assert Imu() == Imu()
    one = Imu()
    one.orientation_covariance[8] = 1.0
    assert one != Imu()


def test_messages_cannot_be_hashed():
    assert refused(TypeError, lambda: hash(Twist())) == "unhashable type: 'Twist'"


def test_a_sub_message_is_shared_not_copied():
    velocity = Vector3()
    command = Twist(linear=velocity)
    velocity.x = 2.0
    assert command.linear.x == 2.0


def test_two_messages_share_no_defaults():
    one, other = LaserScan(), LaserScan()
    one.ranges.append(1.0)
    one.header.frame_id = "base_link"
    assert other == LaserScan()


def test_pickle_and_deepcopy(robot):
    install_finder(robot)
    try:
        status = robot.get("robot_controller/msg/TurtleStatus")(x=1.0)
        assert pickle.loads(pickle.dumps(status)) == status
    finally:
        uninstall_finder(robot)
    stamped = PoseStamped()
    again = copy.deepcopy(stamped)
    again.pose.position.x = 1.0
    assert stamped == PoseStamped() != again


def test_defaults_of_the_definition():
    assert repr(Quaternion()) == "geometry_msgs.msg.Quaternion(x=0.0, y=0.0, z=0.0, w=1.0)"
    assert (Quaternion.W__DEFAULT, Quaternion().W__DEFAULT) == (1.0, 1.0)
    kind = message_class("int32[3] a [1, 2, 3]\nint8[] b [4]\nstring[] c ['x']\nfloat32 d 0.1\nbool[2] e [true, 0]")
    message = kind()
    assert (message.a.tolist(), message.b, message.c, message.e) == (
        [1, 2, 3],
        array("b", [4]),
        ["x"],
        [True, False],
    )
    assert (message.d, message._wire_copy().d) == (0.1, 0.10000000149011612)
    message.c.append("y")
    assert (kind().c, kind.C__DEFAULT) == (["x"], ["x"])


def test_constants_can_be_read_and_not_set():
    assert BatteryState.POWER_SUPPLY_STATUS_CHARGING == BatteryState().POWER_SUPPLY_STATUS_CHARGING == 1
    assert Log.INFO == b"\x14"
    text = "property 'POWER_SUPPLY_STATUS_CHARGING' of 'Metaclass_BatteryState' object has no setter"
    assert refused(AttributeError, lambda: setattr(BatteryState, "POWER_SUPPLY_STATUS_CHARGING", 9)) == text
    with pytest.raises(AttributeError):
        BatteryState().POWER_SUPPLY_STATUS_CHARGING = 9
    assert [name for name in dir(LaserScan) if name.isupper() and name[0] != "_"] == ["SLOT_TYPES"]
    kind = message_class("string GREETING='it\\'s me'\nfloat64 FAR=1e300\nbool ON=1\nchar A=65")
    assert (kind.GREETING, kind.FAR, kind.ON, kind.A) == ("it's me", 1e300, True, 65)


# Every kind of field


def test_field_types_as_text():
    kind = message_class(
        "bool a\nbyte b\nchar c\nfloat64 d\nstring<=5 e\nwstring f\nfloat32[3] g\nuint8[<=4] h\n"
        "geometry_msgs/Point[] i\nstring<=5[<=2] j"
    )
    assert list(kind.get_fields_and_field_types().values()) == [
        "boolean",
        "octet",
        "uint8",
        "double",
        "string<5>",
        "wstring",
        "float[3]",
        "sequence<uint8, 4>",
        "sequence<geometry_msgs/Point>",
        "sequence<string<5>, 2>",
    ]
    assert kind.SLOT_TYPES[4] == BoundedString(5)
    assert kind.SLOT_TYPES[6] == Array(BasicType("float"), 3)
    assert kind.SLOT_TYPES[7] == BoundedSequence(BasicType("uint8"), 4)
    assert kind.SLOT_TYPES[8] == UnboundedSequence(NamespacedType(["geometry_msgs", "msg"], "Point"))
    assert (UnboundedString(),) == String.SLOT_TYPES


LARGEST = "340282346600000016151267322115014000640.000000"
FLOATS = f"and each value of type 'float' and each float in [-{LARGEST}, {LARGEST}]"
SEQUENCE = "The 'v' field must be a set or sequence"


@pytest.mark.parametrize(
    ("type_", "value", "text"),
    [
        ("string<=5", "abcdef", "The 'v' field must be string value not longer than 5"),
        ("float64", 1, "The 'v' field must be of type 'float'"),
        ("int8", 128, "The 'v' field must be an integer in [-128, 127]"),
        ("uint64", -1, "The 'v' field must be an unsigned integer in [0, 18446744073709551615]"),
        ("char", 256, "The 'v' field must be an unsigned integer in [0, 255]"),
        ("bool", np.bool_(True), "The 'v' field must be of type 'bool'"),
        ("byte", b"ab", "The 'v' field must be of type 'bytes' or 'ByteString' with length 1"),
        ("bool[2]", [True], f"{SEQUENCE} with length 2 and each value of type 'bool'"),
        ("byte[]", [1], f"{SEQUENCE} and each value of type 'bytes'"),
        ("string[<=1]", ["a", "b"], f"{SEQUENCE} with length <= 1 and each value of type 'str'"),
        (
            "string<=2[<=3]",
            ["abc"],
            f"{SEQUENCE} with length <= 3 and each string value not longer than 2 and each value of type 'str'",
        ),
        ("geometry_msgs/Point[]", [Vector3()], f"{SEQUENCE} and each value of type 'Point'"),
        ("geometry_msgs/Point[]", Vector3(), f"{SEQUENCE} and each value of type 'Point'"),
        ("float32[]", array("d"), "The 'v' array.array() must have the type code of 'f'"),
        ("float32[]", [1e39], f"{SEQUENCE} {FLOATS}"),
        ("float32[<=2]", array("f", [1, 2, 3]), "The 'v' array.array() must have a size <= 2"),
        (
            "float32[<=2]",
            [1.0, 2.0, 3.0],
            f"{SEQUENCE} with length <= 2 {FLOATS}",
        ),
        (
            "int16[]",
            [40000],
            f"{SEQUENCE} and each value of type 'int' and each integer in [-32768, 32767]",
        ),
        (
            "float64[3]",
            np.zeros(3, "float32"),
            "The 'v' numpy.ndarray() must have the dtype of 'numpy.float64'",
        ),
        ("float64[3]", np.zeros(4), "The 'v' numpy.ndarray() must have a size of 3"),
        (
            "uint8[2]",
            [1, 2, 3],
            f"{SEQUENCE} with length 2 and each value of type 'int' and each unsigned integer in [0, 255]",
        ),
    ],
)
def test_more_that_is_refused(type_, value, text):
    message = message_class(f"{type_} v")()
    before = repr(message)
    assert refused(AssertionError, lambda: setattr(message, "v", value)) == text
    assert repr(message) == before


@pytest.mark.parametrize(
    ("type_", "value", "stored"),
    [
        ("byte", bytearray(b"a"), b"a"),
        ("uint8[]", range(3), array("B", [0, 1, 2])),
        ("float32[]", collections.deque([1.0]), array("f", [1.0])),
        ("float32[]", [math.inf, math.nan, -math.inf], None),
        ("float32[]", [np.float64(2.5)], array("f", [2.5])),
        ("int32[]", [True, 2], array("i", [1, 2])),
        ("float64[]", {1.5}, array("d", [1.5])),
        ("string[]", ("a", "b"), ("a", "b")),
        ("bool[2]", [True, False], [True, False]),
    ],
)
def test_more_that_is_taken(type_, value, stored):
    message = message_class(f"{type_} v")()
    message.v = value
    assert stored is None or message.v == stored


def test_the_bound_of_float32_is_the_one_that_ros_writes():
    largest = float(np.finfo(np.float32).max)
    scan = LaserScan()
    for do in (lambda: setattr(scan, "range_max", largest), lambda: setattr(scan, "ranges", [-largest])):
        assert "field must be" in refused(AssertionError, do)
    scan.range_max = 3.402823466e38
    scan.ranges = [3.402823466e38, -3.402823466e38]


def test_arrays_of_the_right_kind_are_taken_as_they_are():
    scan, ranges = LaserScan(), array("f", [1.0])
    scan.ranges = ranges
    ranges.append(2.0)
    assert scan.ranges is ranges
    imu, covariance = Imu(), np.zeros(9)
    imu.angular_velocity_covariance = covariance
    assert imu.angular_velocity_covariance is covariance


def test_a_constructor_converts_numbers_as_ros_does():
    assert LaserScan(ranges=[1, 2]).ranges == array("f", [1, 2])
    assert LaserScan(ranges=np.ones(2)).ranges == array("f", [1, 1])
    assert Imu(orientation_covariance=range(9)).orientation_covariance.tolist() == list(range(9))
    assert "size of 9" in refused(AssertionError, lambda: Imu(orientation_covariance=[1.0]))
    assert refused(TypeError, lambda: LaserScan(ranges=5.0)) == "'float' object is not iterable"


def test_a_signature_tells_the_fields():
    expected = "(*, x=0.0, y=0.0, z=0.0, w=1.0, **_unknown)"
    assert str(inspect.signature(Quaternion)) == expected
    assert str(inspect.signature(Twist)) == "(*, linear=..., angular=..., **_unknown)"
    assert "linear: geometry_msgs/Vector3" in Twist.__doc__
    assert "must be a sub message" in refused(AssertionError, lambda: Twist(linear=...))


@pytest.mark.parametrize("name", ["self", "value", "type", "data", "array", "cls", "property", "len", "other"])
def test_fields_may_have_awkward_names(name):
    kind = message_class(f"float32 {name}\nfloat32[] more\ngeometry_msgs/Point[2] points")
    message = kind(**{name: 1.5})
    setattr(message, name, 2.5)
    assert getattr(message._wire_copy(), name) == 2.5
    assert message == message._wire_copy() != kind()


def test_notes_say_what_came_and_what_to_try():
    def note(do):
        with pytest.raises(AssertionError) as caught:
            do()
        return caught.value.__notes__[0]

    assert note(lambda: Vector3(x=1)).startswith("Got 1 (int); write a number with a point such as 1.0")
    assert note(lambda: Twist(linaer=Vector3())) == "Did you mean 'linear'? The fields are: linear, angular"
    assert note(lambda: setattr(LaserScan(), "ranges", [1.0, 2])) == "Element 1 is 2 (int)"
    rebuilt = Registry().get("geometry_msgs/Vector3")()
    assert note(lambda: Twist(linear=rebuilt)).startswith("The package was built again")
    assert note(lambda: setattr(LaserScan(), "ranges", np.ones(2))).endswith(".tolist() makes a list of it")


# What goes over the wire


def test_the_wire_rounds_float32_and_nothing_else():
    pose = Pose(x=0.1, theta=math.inf)
    received = pose._wire_copy()
    assert (pose.x, received.x, received.theta) == (0.1, 0.10000000149011612, math.inf)
    assert Vector3(x=0.1)._wire_copy().x == 0.1


def test_the_wire_keeps_plain_values_only():
    message = message_class("int32 n\nstring s\nfloat64 f")(n=True, s=np.str_("a"), f=np.float64(1.5))
    received = message._wire_copy()
    assert [type(value) for value in (received.n, received.s, received.f)] == [int, str, float]


def test_a_wire_copy_shares_nothing():
    path = message_class("geometry_msgs/PoseStamped[] poses\nfloat32[] a\nfloat64[2] b\nstring[] c\nbool[] d")
    message = path(poses=[PoseStamped()], a=[1.0], c=["x"], d=[True])
    received = message._wire_copy()
    received.poses[0].pose.position.x = 9.0
    received.poses.append(PoseStamped())
    received.a[0] = received.b[0] = 9.0
    received.c[0] = "y"
    received.d[0] = False
    assert message == path(poses=[PoseStamped()], a=[1.0], c=["x"], d=[True])


def test_what_was_slipped_into_a_list_is_found_when_it_is_sent():
    path = message_class("geometry_msgs/Point[] points")()
    path.points.append("here")
    text = "The 'points' field must be a set or sequence and each value of type 'Point'"
    assert refused(AssertionError, path._wire_copy) == text


def test_fields_whose_names_only_look_nested_are_kept_apart():
    stamped = "turtlesim/Pose pose\nturtlesim/Color pose_color\nfloat32 pose_x\nturtlesim/Pose pose_pose"
    kind = message_class(stamped)
    message = kind(pose=Pose(x=1.0), pose_x=2.0, pose_pose=Pose(x=3.0))
    received = message._wire_copy()
    assert received == message
    assert received.pose is not received.pose_pose


@given(any_messages())
def test_any_message_survives_the_wire(message):
    received = message._wire_copy()
    assert received._wire_copy() == received
    assert type(received) is type(message)
    copied = copy.deepcopy(message)
    assert repr(copied) == repr(message)
    assert copied == message


@given(st.lists(st.floats(-3e38, 3e38) | st.just(math.inf)))
def test_ranges_are_rounded_as_array_rounds_them(numbers):
    scan = LaserScan()
    scan.ranges = numbers
    assert scan.ranges == array("f", numbers) == scan._wire_copy().ranges
