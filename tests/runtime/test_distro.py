"""Where ROS 2 releases differ, a world behaves as the one it is told to: Humble, unless told otherwise."""

from __future__ import annotations

import threading
import time
from array import array
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
import rclpy
from fibonacci_action import Result, Run, outcome, send, serving, wait
from fibonacci_action import start as begin
from geometry_msgs.msg import Point, Polygon, Vector3
from lifecycle_msgs.msg import Transition
from lifecycle_msgs.srv import ChangeState
from rcl_interfaces.msg import Log, ParameterEvent
from rclpy.duration import Duration
from rclpy.exceptions import RCLError
from rclpy.executors import MultiThreadedExecutor, SingleThreadedExecutor
from rclpy.lifecycle import LifecycleNode
from rclpy.parameter import Parameter
from rclpy.parameter_event_handler import ParameterEventHandler
from rclpy.serialization import deserialize_message, serialize_message
from rclpy.task import Future
from rclpy.time import Time
from sensor_msgs.msg import JointState, LaserScan
from std_msgs.msg import Float32, String

from turtle_lesson import start
from turtle_lesson.ros import distro
from turtle_lesson.ros.distro import DURATION_ARITHMETIC, EXECUTOR_AS_CONTEXT, MESSAGE_INFO, RELEASES, Release, changes
from turtle_lesson.ros.runtime.world import World, open_world

DIFFERENCES = Path(distro.__file__).with_name("DIFFERENCES.md")


@pytest.fixture
def world(request: pytest.FixtureRequest) -> Iterator[World]:
    """A fresh world of the release that the test names."""
    world = open_world(distro=getattr(request, "param", None))
    yield world
    world.close()
    open_world(distro="humble").close()


def of(*names: str) -> pytest.MarkDecorator:
    """Run the test in a world of each of these releases."""
    return pytest.mark.parametrize("world", names, indirect=True)


# ---------------------------------------------------------------- the choice


def test_a_release_is_chosen_by_an_argument_or_by_the_environment(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("ROS_DISTRO", raising=False)
    assert open_world().release.name == "humble"
    monkeypatch.setenv("ROS_DISTRO", "kilted")
    assert open_world().release.name == "kilted"
    assert open_world(distro="jazzy").release.name == "jazzy"
    monkeypatch.setenv("ROS_DISTRO", "noetic")
    with pytest.raises(ValueError, match=r"\"humble\", .* got 'noetic' .*ROS_DISTRO"):
        start()
    with pytest.raises(ValueError, match='distro must be one of the releases "humble", "iron", "jazzy", "kilted"'):
        start(distro="Humble")
    monkeypatch.undo()
    open_world(distro="humble").close()


@of("jazzy")
def test_programs_find_the_release_in_their_environment(run: Run) -> None:
    def program(found: list[str]) -> None:
        import os

        found.append(os.environ["ROS_DISTRO"])

    assert run(program) == ["jazzy"]


def test_a_newer_release_has_what_an_older_one_has() -> None:
    numbers = [sum(Release(name).has(change) for change in changes()) for name in RELEASES]
    assert numbers == sorted(numbers) and numbers[0] == 0 and numbers[-1] == len(list(changes()))


def test_differences_lists_the_whole_table() -> None:
    page = DIFFERENCES.read_text(encoding="utf-8")
    rows = [f"| {each.since.capitalize()} | {each.what} | {each.before} | {each.source} |" for each in changes()]
    assert [row for row in rows if row not in page] == []


# ---------------------------------------------------------------- fields of messages


def test_until_humble_a_field_is_checked_when_it_is_assigned(world: World) -> None:
    with pytest.raises(AssertionError, match="The 'x' field must be of type 'float'"):
        Vector3().x = 1
    with pytest.raises(AssertionError, match="Invalid arguments"):
        Vector3(w=1.0)


@of("iron", "jazzy")
def test_since_iron_fields_take_what_is_assigned(run: Run) -> None:
    def program(found: list[Any]) -> None:
        rclpy.init()
        node = rclpy.create_node("n")
        publishers = {kind: node.create_publisher(kind, kind.__name__, 1) for kind in (Vector3, LaserScan, Polygon)}
        for kind in publishers:
            node.create_subscription(kind, kind.__name__, found.append, 1)
        publishers[Vector3].publish(Vector3(x=1, w="no such field"))
        scan = LaserScan()
        scan.ranges = (1, 2)
        publishers[LaserScan].publish(scan)
        polygon = Polygon()
        polygon.points = [String(data="no point")]
        with pytest.raises(
            TypeError, match="'points' field must be a set or sequence and each value of type 'Point32'"
        ):
            publishers[Polygon].publish(polygon)
        for _ in range(2):
            rclpy.spin_once(node)

    scan, vector = sorted(run(program), key=repr, reverse=True)
    assert repr(vector) == "geometry_msgs.msg.Vector3(x=1.0, y=0.0, z=0.0)"
    assert scan.ranges == array("f", [1.0, 2.0])


@of("jazzy")
def test_a_message_inside_another_is_checked_when_it_is_sent(world: World) -> None:
    class Elsewhere:
        """A message that another program made, say of another version of its package."""

    joints = JointState(name=("a", "b"), position=[1, 2])
    assert list(deserialize_message(serialize_message(joints), JointState).position) == [1.0, 2.0]
    joints.header.frame_id = 5
    with pytest.raises(TypeError, match="The 'frame_id' field must be of type 'str'") as caught:
        serialize_message(joints)
    assert caught.value.__notes__[-1] == "Since ROS 2 Iron this is found when the message is sent."
    joints.header = Elsewhere()
    with pytest.raises(TypeError, match="'header' field must be a sub message of type 'Header'"):
        serialize_message(joints)


@of("jazzy")
def test_the_checks_can_be_asked_for(world: World, monkeypatch: pytest.MonkeyPatch) -> None:
    assert Point(x=1).x == 1
    monkeypatch.setenv("ROS_PYTHON_CHECK_FIELDS", "1")
    with pytest.raises(AssertionError, match="The 'x' field must be of type 'float'"):
        Point(x=1)
    with pytest.raises(AssertionError, match="Invalid arguments"):
        Float32(dat=1.0)


# ---------------------------------------------------------------- executors and actions


@pytest.mark.parametrize(
    ("world", "order"),
    [
        ("humble", ["task", "late", "third", "second", "first"]),
        ("kilted", ["first", "second", "third", "late", "task"]),
    ],
    indirect=["world"],
)
def test_tasks_and_done_callbacks_begin_with_the_newest_until_kilted(run: Run, order: list[str]) -> None:
    def program(found: list[str]) -> None:
        rclpy.init()
        node, executor = rclpy.create_node("n"), SingleThreadedExecutor()
        executor.add_node(node)
        future = Future(executor=executor)
        for name in ("first", "second", "third"):
            future.add_done_callback(lambda _, name=name: found.append(name))
        future.set_result(None)
        future.add_done_callback(lambda _: found.append("late"))
        executor.create_task(lambda a, b: found.append(a + b), "ta", b="sk")
        for _ in range(5):
            executor.spin_once(timeout_sec=0)

    assert run(program) == order


@of("humble", "jazzy")
def test_the_time_for_which_a_result_is_kept_begins_with_the_goal_until_iron(run: Run, world: World) -> None:
    def execute(goal_handle: Any) -> Any:
        time.sleep(3)
        goal_handle.succeed()
        return Result(sequence=[6])

    def program(found: list[Any]) -> None:
        node, client = begin()
        handle = send(node, client)
        wait(node, Future(), 4)
        found.append(outcome(node, handle))

    # a goal of 3 s, whose result is asked for 1 s after its end
    expected = (0, []) if world.release.name == "humble" else (4, [6])
    assert run(serving(execute, result_timeout=2), program) == [expected]


@pytest.mark.parametrize(("world", "end"), [("jazzy", 1.0), ("kilted", 3.0)], indirect=["world"])
def test_since_kilted_a_shutdown_waits_for_callbacks_that_still_run(run: Run, end: float) -> None:
    def program(found: list[float]) -> None:
        rclpy.init()
        node, executor = rclpy.create_node("n"), MultiThreadedExecutor(2)
        timer = node.create_timer(0.5, lambda: (timer.cancel(), time.sleep(2.5)))
        executor.add_node(node)
        threading.Thread(target=executor.spin).start()
        time.sleep(1.0)
        executor.shutdown()
        found.append(round(time.monotonic(), 1))
        executor.shutdown(wait_for_threads=False)

    assert run(program) == [end]


@of("jazzy", "kilted")
def test_since_kilted_a_forbidden_transition_is_logged_and_answered(
    run: Run, world: World, capsys: pytest.CaptureFixture[str]
) -> None:
    def program(found: list[Any]) -> None:
        rclpy.init()
        node = LifecycleNode("managed")
        client = node.create_client(ChangeState, "~/change_state")
        asked = client.call_async(ChangeState.Request(transition=Transition(id=2)))
        try:
            rclpy.spin_until_future_complete(node, asked)
            found.append(asked.result().success)
        except RCLError:
            found.append("error")

    old = world.release.name == "jazzy"
    assert run(program) == ["error" if old else False]
    said = "[managed]: Unable to start transition 2 from current state (1, 'unconfigured')"
    assert (said in capsys.readouterr().err) is not old


@of("humble", "jazzy")
def test_since_iron_an_event_may_be_filled_with_rclpys_own_parameters(world: World) -> None:
    rclpy.init()
    handler = ParameterEventHandler(rclpy.create_node("robot"))
    changed = [Parameter("speed", value=0.5), Parameter("name", value="x")]
    if world.release.name == "humble":
        with pytest.raises(AssertionError, match="'changed_parameters' field must be a set or sequence"):
            ParameterEvent(node="/robot", changed_parameters=changed)
    else:
        event = ParameterEvent(node="/robot", changed_parameters=changed)
        assert list(handler.get_parameters_from_event(event)) == changed


@of("humble", "iron")
def test_since_iron_the_lines_of_child_loggers_are_on_rosout(run: Run, world: World) -> None:
    def program(found: list[str]) -> None:
        rclpy.init()
        node = rclpy.create_node("robot")
        node.create_subscription(Log, "/rosout", lambda log: found.append(f"{log.name}: {log.msg}"), 10)
        node.get_logger().get_child("arm").get_child("hand").info("open")
        node.get_logger().info("ready")
        rclpy.spin(node)

    heard = ["robot: ready"] if world.release.name == "humble" else ["robot.arm.hand: open", "robot: ready"]
    assert run(program) == heard


# ---------------------------------------------------------------- times


@of("humble", "jazzy")
def test_a_time_equals_no_number(world: World) -> None:
    if world.release.name == "jazzy":
        assert (Time(nanoseconds=5) == 5, Duration(nanoseconds=5) != 5) == (False, True)
    else:
        for moment in (Time(nanoseconds=5), Duration(nanoseconds=5)):
            for compare in (lambda it: it == 5, lambda it: it != None):  # noqa: E711
                with pytest.raises(TypeError, match=r"Can't compare (time|duration) with object of type: "):
                    compare(moment)


# ---------------------------------------------------------------- what newer releases add


@of("humble", "kilted")
def test_what_a_release_lacks_works_and_is_remembered(run: Run, world: World) -> None:
    def program(found: list[Any]) -> None:
        rclpy.init()
        node = rclpy.create_node("n")
        node.create_subscription(String, "text", lambda message, info: None, 1)
        found.append(Duration(seconds=1) + Duration(seconds=2) == Duration(seconds=1) * 3)
        with SingleThreadedExecutor():
            pass

    assert run(program) == [True]
    expected = [MESSAGE_INFO, DURATION_ARITHMETIC, EXECUTOR_AS_CONTEXT] if world.release.name == "humble" else []
    assert [change for change, file in world.release.lacked if file == __file__] == expected
