"""What tf2 answers: any two frames, at any time that it knows of, and why not otherwise, in tf2's own words."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
import tf2_geometry_msgs
import tf2_py
import tf_transformations
from builtin_interfaces.msg import Time as TimeMessage
from geometry_msgs.msg import (
    PointStamped,
    PoseStamped,
    PoseWithCovarianceStamped,
    TransformStamped,
    Twist,
    Vector3Stamped,
    WrenchStamped,
)
from hypothesis import given
from hypothesis import strategies as st
from rclpy.duration import Duration
from rclpy.time import Time
from std_msgs.msg import Header
from tf2_ros import (
    Buffer,
    ConnectivityException,
    ExtrapolationException,
    InvalidArgumentException,
    LookupException,
    TransformException,
    TransformRegistration,
    TypeException,
)

from turtle_lesson.ros.runtime.world import World

LATEST = Time()
numbers = st.floats(-10.0, 10.0)
angles = st.floats(-3.1, 3.1)


def frame(
    parent: str, child: str, x: float = 0.0, y: float = 0.0, yaw: float = 0.0, at: float = 0.0
) -> TransformStamped:
    """A transform in the plane, at a time (s)."""
    message = TransformStamped(child_frame_id=child)
    message.header = Header(frame_id=parent, stamp=Time(seconds=at).to_msg())
    message.transform.translation.x, message.transform.translation.y = float(x), float(y)
    message.transform.rotation.z, message.transform.rotation.w = math.sin(yaw / 2), math.cos(yaw / 2)
    return message


def told(*frames: TransformStamped, **options: Any) -> Buffer:
    """A buffer that was told these."""
    buffer = Buffer(**options)
    for each in frames:
        buffer.set_transform(each, "test")
    return buffer


def matrix(transform: TransformStamped) -> np.ndarray:
    """A transform as a matrix."""
    shift, turn = transform.transform.translation, transform.transform.rotation
    turned = tf_transformations.quaternion_matrix([turn.x, turn.y, turn.z, turn.w])
    return tf_transformations.translation_matrix([shift.x, shift.y, shift.z]) @ turned


def why_not(kind: type, buffer: Buffer, target: str, source: str, time: Any = LATEST) -> str:
    """The message of the error that a lookup ends with; `can_transform` knows it, too."""
    assert buffer.can_transform(target, source, time) is False
    with pytest.raises(kind) as caught:
        buffer.lookup_transform(target, source, time)
    assert type(caught.value) is kind and isinstance(caught.value, TransformException)
    return str(caught.value)


# ---------------------------------------------------------------- the tree


@given(
    st.lists(st.tuples(st.integers(0, 99), numbers, numbers, numbers, angles, angles, angles), min_size=1, max_size=5)
)
def test_any_two_frames_of_a_tree_are_related_as_the_product_of_the_matrices_between_them(frames: list[Any]) -> None:
    buffer, poses = Buffer(), [np.identity(4)]
    for number, (parent, x, y, z, *turns) in enumerate(frames, start=1):
        parent %= number
        message = frame(f"f{parent}", f"f{number}", x, y)
        message.transform.translation.z = z
        turn = message.transform.rotation
        turn.x, turn.y, turn.z, turn.w = tf_transformations.quaternion_from_euler(*turns)
        buffer.set_transform_static(message, "test")
        poses.append(poses[parent] @ matrix(message))
    for target, to in enumerate(poses):
        for source, pose in enumerate(poses):
            found = buffer.lookup_transform(f"f{target}", f"f{source}", LATEST)
            assert np.allclose(matrix(found), np.linalg.inv(to) @ pose)
            assert (found.header.frame_id, found.child_frame_id) == (f"f{target}", f"f{source}")


def test_a_frame_that_nobody_told_of_does_not_exist() -> None:
    buffer = told(frame("world", "turtle1"))
    text = '"turtle2" passed to lookupTransform argument target_frame does not exist. '
    assert why_not(LookupException, buffer, "turtle2", "turtle1") == text
    text = '"turtle2" passed to lookupTransform argument source_frame does not exist. '
    assert why_not(LookupException, buffer, "world", "turtle2") == text
    asked = buffer.can_transform("turtle2", "turtle1", LATEST, return_debug_tuple=True)
    assert asked == (
        False,
        'Invalid frame ID "turtle2" passed to canTransform argument target_frame - frame does not exist',
    )


def test_the_error_has_a_note_with_the_frames_that_there_are() -> None:
    with pytest.raises(LookupException) as caught:
        told(frame("world", "turtle1")).lookup_transform("turtle2", "world", LATEST)
    assert caught.value.__notes__ == ["Frames received so far: turtle1, world"]
    with pytest.raises(LookupException) as caught:
        Buffer().lookup_transform("turtle2", "world", LATEST)
    assert "Frames received so far: none; is a broadcaster running" in caught.value.__notes__[0]


def test_names_are_neither_empty_nor_begin_with_a_slash() -> None:
    buffer = told(frame("/world", "/turtle1", x=1))  # for those who tell, the slash is taken off
    assert buffer.lookup_transform("world", "turtle1", LATEST).transform.translation.x == 1.0
    start = 'Invalid argument "/world" passed to lookupTransform argument target_frame'
    text = f"{start} - in tf2 frame_ids cannot start with a '/'"
    assert why_not(InvalidArgumentException, buffer, "/world", "turtle1") == text
    text = 'Invalid argument "" passed to lookupTransform argument source_frame - in tf2 frame_ids cannot be empty'
    assert why_not(InvalidArgumentException, buffer, "world", "") == text
    with pytest.raises(TypeError, match="a frame's name must be a str, got 7"):
        buffer.lookup_transform("world", 7, LATEST)  # type: ignore[arg-type]


def test_two_trees_are_not_connected() -> None:
    buffer = told(frame("world", "turtle1"), frame("map", "robot"))
    text = why_not(ConnectivityException, buffer, "robot", "turtle1")
    assert text == (
        "Could not find a connection between 'robot' and 'turtle1' because they are not part of the same tree."
        "Tf has two or more unconnected trees."
    )


def test_a_loop_is_no_tree() -> None:
    pairs = ("a", "b"), ("b", "c"), ("c", "a"), ("world", "robot")
    buffer = told(*[frame(parent, child, at=1) for parent, child in pairs])
    text = why_not(LookupException, buffer, "robot", "a")
    assert text.startswith("The tf tree is invalid because it contains a loop.\nFrame b exists with parent a.\n")
    assert why_not(LookupException, buffer, "robot", "a", Time(seconds=1)).startswith("The tf tree is invalid")


def test_a_frame_seen_from_itself_needs_no_tree() -> None:
    found = Buffer().lookup_transform("nowhere", "nowhere", Time(seconds=3))
    assert (found.header.stamp.sec, found.transform.rotation.w) == (3, 1.0)
    assert told(frame("world", "a", at=5)).lookup_transform("a", "a", LATEST).header.stamp.sec == 5


# ---------------------------------------------------------------- time


@given(st.floats(0.0, 1.0), angles, st.floats(-3.0, 3.0))
def test_between_two_times_frames_move_and_turn_evenly(share: float, yaw: float, more: float) -> None:
    buffer = told(frame("world", "a", 1, 0, yaw, at=10), frame("world", "a", 3, 4, yaw + more, at=12))
    found = buffer.lookup_transform("world", "a", Time(seconds=10 + 2 * share))
    expected = matrix(frame("world", "a", 1 + 2 * share, 4 * share, yaw + share * more))
    assert np.allclose(matrix(found), expected, atol=1e-6)


def test_a_turn_takes_the_shorter_way() -> None:
    buffer = told(frame("world", "a", yaw=3.0, at=1), frame("world", "a", yaw=-3.0, at=2))
    turn = buffer.lookup_transform("world", "a", Time(seconds=1.5)).transform.rotation
    assert abs(tf_transformations.euler_from_quaternion([turn.x, turn.y, turn.z, turn.w])[2]) == pytest.approx(math.pi)


def test_tf2_does_not_guess_beyond_what_it_was_told() -> None:
    buffer = told(frame("world", "a", at=10), frame("world", "a", at=11), frame("world", "b", at=10.5))
    ends = "when looking up transform from frame [a] to frame [world]"
    text = why_not(ExtrapolationException, buffer, "world", "a", Time(seconds=11.25))
    requested = "Requested time 11.250000 but the latest data is at time 11.000000"
    assert text == f"Lookup would require extrapolation into the future.  {requested}, {ends}"
    text = why_not(ExtrapolationException, buffer, "world", "a", Time(seconds=9))
    requested = "Requested time 9.000000 but the earliest data is at time 10.000000"
    assert text == f"Lookup would require extrapolation into the past.  {requested}, {ends}"
    text = why_not(ExtrapolationException, buffer, "b", "a", Time(seconds=11))
    only = "Lookup would require extrapolation at time 11.000000, but only time 10.500000 is in the buffer"
    assert text == f"{only}, when looking up transform from frame [a] to frame [b]"


def test_time_zero_is_the_latest_time_that_all_frames_between_know() -> None:
    moving = [frame("world", "a", x=t, at=t) for t in (1, 2, 3)] + [frame("world", "b", x=t, at=t) for t in (1, 2)]
    buffer = told(*moving)
    buffer.set_transform_static(frame("a", "lidar", x=0.5), "test")
    found = buffer.lookup_transform("b", "lidar", LATEST)
    assert (found.header.stamp.sec, found.transform.translation.x) == (2, 0.5)
    assert buffer.get_latest_common_time("b", "lidar") == Time(seconds=2)
    assert buffer.lookup_transform("world", "lidar", LATEST).transform.translation.x == 3.5
    assert buffer.lookup_transform("lidar", "a", Time(seconds=1000)).transform.translation.x == -0.5


def test_what_is_older_than_ten_seconds_is_forgotten(world: World, capsys: pytest.CaptureFixture[str]) -> None:
    buffer = told(*[frame("world", "a", x=t, at=t) for t in range(1, 31)])
    assert buffer.can_transform("world", "a", Time(seconds=20))
    why_not(ExtrapolationException, buffer, "world", "a", Time(seconds=18.5))
    buffer.set_transform(frame("world", "a", at=3), "late")
    assert capsys.readouterr().out == (
        "Warning: TF_OLD_DATA ignoring data from the past for frame a at time 3.000000 according to authority late\n"
        "Possible reasons are listed at http://wiki.ros.org/tf/Errors%20explained\n"
    )
    short = told(*[frame("world", "a", x=t, at=t) for t in range(1, 31)], cache_time=Duration(seconds=2))
    why_not(ExtrapolationException, short, "world", "a", Time(seconds=26))


def test_messages_may_come_in_any_order_and_twice() -> None:
    buffer = told(*[frame("world", "a", x=t, at=t) for t in (3, 1, 2, 3, 2)])
    assert buffer.lookup_transform("world", "a", Time(seconds=1.5)).transform.translation.x == 1.5
    assert "rate: 1.500\n" in buffer.all_frames_as_yaml()


def test_a_look_back_through_a_frame_that_stays() -> None:
    buffer = told(
        *[frame("world", "a", x=t, at=t) for t in (1, 2, 3)], *[frame("world", "b", y=t, at=t) for t in (1, 3)]
    )
    found = buffer.lookup_transform_full("b", Time(seconds=3), "a", Time(seconds=1), "world")
    assert (found.transform.translation.x, found.transform.translation.y, found.header.stamp.sec) == (1.0, -3.0, 3)
    with pytest.raises(ExtrapolationException, match="Lookup would require extrapolation into the future"):
        buffer.lookup_transform_full("b", LATEST, "a", Time(seconds=9), "world")
    with pytest.raises(LookupException, match="argument fixed_frame does not exist"):
        buffer.lookup_transform_full("b", LATEST, "a", LATEST, "nope")


def test_times_may_be_messages_but_not_numbers() -> None:
    buffer = told(frame("world", "a", x=7, at=1))
    assert buffer.lookup_transform("world", "a", TimeMessage(sec=1)).transform.translation.x == 7.0
    with pytest.raises(TypeError, match=r"a time is expected, got 1\.0"):
        buffer.lookup_transform("world", "a", 1.0)  # type: ignore[arg-type]
    with pytest.raises(TypeError, match=r"timeout must be a rclpy.duration.Duration, got 2\.0"):
        buffer.lookup_transform("world", "a", LATEST, 2.0)  # type: ignore[arg-type]


# ---------------------------------------------------------------- what is refused


@pytest.mark.parametrize(
    ("message", "text"),
    [
        (
            frame("a", "a"),
            'TF_SELF_TRANSFORM: Ignoring transform from authority "me" with frame_id and  child_frame_id "a" because '
            "they are the same",
        ),
        (
            frame("a", ""),
            'TF_NO_CHILD_FRAME_ID: Ignoring transform from authority "me" because child_frame_id not set ',
        ),
        (
            frame("", "a"),
            'TF_NO_FRAME_ID: Ignoring transform with child_frame_id "a"  from authority "me" because frame_id not set',
        ),
        (
            frame("w", "a", x=math.nan),
            'TF_NAN_INPUT: Ignoring transform for child_frame_id "a" from authority "me" because of a nan value in the '
            "transform (nan 0.000000 0.000000) (0.000000 0.000000 0.000000 1.000000)",
        ),
    ],
)
def test_transforms_that_cannot_be_right_are_ignored_with_a_line(
    world: World, message: TransformStamped, text: str, capsys: pytest.CaptureFixture[str]
) -> None:
    buffer = Buffer()
    buffer.set_transform(message, "me")
    assert capsys.readouterr().out == f"Error:   {text}\n"
    assert buffer.all_frames_as_string() == "" and buffer.all_frames_as_yaml() == "[]"


def test_the_same_complaint_is_printed_once_a_second(world: World, capsys: pytest.CaptureFixture[str]) -> None:
    buffer = Buffer()
    for _ in range(30):
        buffer.set_transform(frame("w", "a", x=math.nan), "me")
        buffer.set_transform(frame("w", "b", x=math.nan), "me")
        world.sim.run_until(world.now + 100_000_000)
    lines = capsys.readouterr().out.splitlines()
    assert [line.count('child_frame_id "a"') for line in lines] == [1, 0] * 3


def test_the_length_of_a_quaternion_does_not_matter_and_neither_does_its_sign() -> None:
    message = frame("w", "a")
    message.transform.rotation.z, message.transform.rotation.w = -3.0, -3.0
    turn = told(message).lookup_transform("w", "a", LATEST).transform.rotation
    assert (turn.z, turn.w) == pytest.approx((math.sqrt(0.5), math.sqrt(0.5)))


# ---------------------------------------------------------------- all frames, and none


def test_all_frames_in_words_and_as_yaml() -> None:
    buffer = told(frame("world", "a", at=1), frame("world", "a", at=3))
    buffer.set_transform_static(frame("a", "lidar"), "test")
    assert buffer.all_frames_as_string() == "Frame a exists with parent world.\nFrame lidar exists with parent a.\n"
    assert buffer.all_frames_as_yaml().splitlines()[:7] == [
        "a: ",
        "  parent: 'world'",
        "  broadcaster: 'test'",
        "  rate: 1.000",
        "  most_recent_transform: 3.000000",
        "  oldest_transform: 1.000000",
        "  buffer_length: 2.000",
    ]
    assert buffer._getFrameStrings() == ["a", "world", "lidar"]


def test_clearing_forgets_all_that_moves() -> None:
    buffer = told(frame("world", "a", at=1))
    buffer.set_transform_static(frame("world", "lidar"), "test")
    buffer.clear()
    assert buffer.can_transform("world", "lidar", LATEST) and not buffer.can_transform("world", "a", LATEST)


# ---------------------------------------------------------------- waiting


def test_a_future_is_done_when_the_transform_comes() -> None:
    buffer = Buffer()
    future = buffer.wait_for_transform_async("world", "a", Time(seconds=2))
    other = buffer.wait_for_transform_async("world", "a", Time(seconds=1))
    buffer.set_transform(frame("world", "a", x=1, at=1), "test")
    assert not future.done() and other.done()
    buffer.set_transform(frame("world", "a", x=3, at=3), "test")
    assert future.result().transform.translation.x == 2.0 and not buffer._waiting
    assert buffer.wait_for_transform_async("world", "a", LATEST).done()


def test_a_cell_that_waits_lets_robot_time_pass(world: World) -> None:
    buffer = Buffer()
    assert buffer.can_transform("world", "a", LATEST, timeout=Duration(seconds=1.5)) is False
    assert 1.5e9 <= world.now < 1.53e9


# ---------------------------------------------------------------- data


def stamped(kind: Any, name: str = "robot") -> Any:
    return kind(header=Header(frame_id=name))


def test_data_is_transformed_as_its_kind_wants_it() -> None:
    buffer = told(frame("world", "robot", 1, 2, math.pi / 2))
    point, vector, pose = stamped(PointStamped), stamped(Vector3Stamped), stamped(PoseStamped)
    point.point.x = vector.vector.x = pose.pose.position.x = 1.0
    there = buffer.transform(point, "world")
    assert (there.point.x, there.point.y, there.header.frame_id) == pytest.approx((1.0, 3.0, "world"))
    turned = buffer.transform(vector, "world").vector
    assert (turned.x, turned.y) == pytest.approx((0.0, 1.0))
    seen = buffer.transform(pose, "world").pose
    assert (seen.position.y, seen.orientation.z, seen.orientation.w) == pytest.approx((3.0, 0.5**0.5, 0.5**0.5))


def test_uncertainty_turns_with_the_frame_and_a_shifted_force_has_a_lever() -> None:
    buffer = told(frame("world", "robot", 1, 2, math.pi / 2))
    pose = stamped(PoseWithCovarianceStamped)
    pose.pose.covariance = [4.0, *[0.0] * 34, 9.0]
    covariance = np.array(buffer.transform(pose, "world").pose.covariance).reshape(6, 6)
    assert np.allclose(np.diag(covariance), [0, 4, 0, 0, 0, 9])
    wrench = stamped(WrenchStamped)
    wrench.wrench.force.x = 2.0
    found = buffer.transform(wrench, "world").wrench
    assert (found.force.y, found.torque.z) == pytest.approx((2.0, 2.0))


def test_data_that_nobody_registered_is_refused() -> None:
    with pytest.raises(TypeException, match=r"Type <class '.*Twist'> is not loaded or supported") as caught:
        TransformRegistration().get(Twist)
    advice = "For geometry_msgs write: import tf2_geometry_msgs; messages of sensor_msgs are not transformed"
    assert caught.value.__notes__ == [advice]
    with pytest.raises(
        TypeError, match=r"a Pose is expected, got PoseStamped: a PoseStamped is transformed by do_transform_pose_st"
    ):
        tf2_geometry_msgs.do_transform_pose(PoseStamped(), TransformStamped())


def test_the_exceptions_are_tf2s() -> None:
    assert repr(tf2_py.LookupException) == "<class 'tf2.LookupException'>"


# ---------------------------------------------------------------- whatever is told and asked


names = st.sampled_from(["world", "a", "b", "c", "/a", "", "ü ☃", "NO_PARENT"])
times = st.integers(0, 40).map(lambda tenth: tenth / 2)
wild = st.floats(allow_nan=True, allow_infinity=True)


@given(st.lists(st.tuples(names, names, wild, wild, times, st.booleans()), max_size=12), names, names, times)
def test_nothing_that_is_told_or_asked_breaks_a_buffer(frames: list[Any], target: str, source: str, at: float) -> None:
    buffer = Buffer()
    for parent, child, x, z, time, static in frames:
        message = frame(parent, child, x, at=time)
        message.transform.rotation.z = z
        (buffer.set_transform_static if static else buffer.set_transform)(message, "somebody")
    possible, why = buffer.can_transform(target, source, Time(seconds=at), return_debug_tuple=True)
    try:
        found = buffer.lookup_transform(target, source, Time(seconds=at))
        assert found.child_frame_id == source and possible
    except TransformException as error:
        assert str(error) and not possible and why
    buffer.all_frames_as_string()
    assert buffer.all_frames_as_yaml() or buffer._getFrameStrings()
