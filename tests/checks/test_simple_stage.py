"""The lesson's simple nodes, run unmodified from files by their launch file: they show exactly the lesson's faults.

Once in our own words (tests/data/simple_stage), and once as the lesson prints them, where its text is at hand. What
to expect was recorded from a real ROS 2.
"""

from __future__ import annotations

import itertools
import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import lesson_listings
import pytest

from turtle_lesson import Lesson, start
from turtle_lesson.learner.story import FINISHED

OWN = Path(__file__).parents[1] / "data" / "simple_stage"
NODES = {
    "navigator_node.py": ("robot_controller/navigator_node.py:", "Key Points:"),
    "status_monitor_node.py": ("robot_controller/status_monitor_node.py:", "Key Points:"),
    "obstacle_detector_node.py": ("robot_controller/obstacle_detector_node.py:", "Key Points:"),
}


def package_frame(folder: Path) -> Path:
    """A package around node files: what makes it build, and the interfaces, as in the finished one."""
    for name in ("package.xml", "CMakeLists.txt"):
        shutil.copy(FINISHED / name, folder / name)
    for name in ("msg", "srv"):
        shutil.copytree(FINISHED / name, folder / name)
    return folder


def in_our_words(folder: Path) -> Path:
    shutil.copytree(OWN, folder, dirs_exist_ok=True)
    return package_frame(folder)


def as_printed(folder: Path) -> Path:
    if not lesson_listings.TEXT.exists():
        pytest.skip("the lesson's text is not beside this checkout, and it is not ours to ship")
    package_frame(folder)
    for name in ("robot_controller", "launch"):
        (folder / name).mkdir()
    for name, (header, end) in NODES.items():
        (folder / "robot_controller" / name).write_text(lesson_listings.listing(header, end))
    launch = lesson_listings.listing("robot_controller/launch/start_system.launch.py:", "setup.py entry points")
    (folder / "launch" / "start_system.launch.py").write_text(launch)
    (folder / "msg" / "TurtleStatus.msg").write_text(
        lesson_listings.interface("TurtleStatus.msg (", "NavigateTo.srv (")
    )
    (folder / "srv" / "NavigateTo.srv").write_text(lesson_listings.interface("NavigateTo.srv (", "Update CMakeLists"))
    return folder


@pytest.fixture(params=[in_our_words, as_printed], ids=["in our words", "as printed"])
def lesson(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[Lesson]:
    lesson = start(package=request.param(tmp_path))
    lesson.launch("robot_controller", "start_system.launch.py")
    lesson.run(1)
    yield lesson


def listen(kind: Any, topic: str, seconds: float) -> list[Any]:
    """What a node in a cell hears on a topic within some seconds of robot time."""
    import rclpy
    from rclpy.task import Future

    rclpy.init()
    node = rclpy.create_node("listener")
    heard: list[Any] = []
    node.create_subscription(kind, topic, heard.append, 10)
    rclpy.spin_until_future_complete(node, Future(), timeout_sec=seconds)
    rclpy.shutdown()
    return heard


def test_the_navigator_drives_into_the_wall_and_says_no_then_yes(lesson: Lesson) -> None:
    import rclpy
    from geometry_msgs.msg import Twist
    from robot_controller.srv import NavigateTo
    from turtlesim.msg import Pose

    rclpy.init()
    node = rclpy.create_node("observer")
    commands: list[Any] = []
    poses: list[Any] = []
    node.create_subscription(Twist, "/turtle1/cmd_vel", commands.append, 10)
    node.create_subscription(Pose, "/turtle1/pose", poses.append, 10)
    client = node.create_client(NavigateTo, "/navigate_to")

    first = client.call(NavigateTo.Request(x=5.0, y=5.0))
    moving = [command for command in commands if command.linear.x]
    assert len(moving) == 354
    assert {command.linear.x for command in moving} == {0.2}
    assert commands[-1].linear.x == 0.0
    assert not first.success
    assert first.time_taken == pytest.approx(35.4, abs=0.1)
    assert poses[-1].x == pytest.approx(11.088889, abs=1e-5)
    assert {pose.y for pose in poses} == {5.544444561004639}
    assert {pose.theta for pose in poses} == {0.0}

    began = lesson.now
    second = client.call(NavigateTo.Request(x=5.0, y=5.0))
    assert second.success
    assert second.time_taken < 0.001
    assert lesson.now - began < 0.01


def test_while_it_sleeps_its_process_answers_nothing(lesson: Lesson) -> None:
    import rclpy
    from rcl_interfaces.srv import ListParameters
    from robot_controller.srv import NavigateTo

    rclpy.init()
    node = rclpy.create_node("observer")
    goal = node.create_client(NavigateTo, "/navigate_to").call_async(NavigateTo.Request(x=5.0, y=5.0))
    rclpy.spin_once(node, timeout_sec=1.0)
    question = node.create_client(ListParameters, "/navigator/list_parameters").call_async(ListParameters.Request())
    rclpy.spin_until_future_complete(node, question, timeout_sec=10.0)
    assert not goal.done()
    assert not question.done()
    for future in (goal, question):
        rclpy.spin_until_future_complete(node, future, timeout_sec=60.0)
        assert future.done()
    assert list(question.result().result.names) == ["use_sim_time"], "goal_timeout was never declared"


def test_the_monitor_reports_zero_for_ever(lesson: Lesson) -> None:
    from robot_controller.msg import TurtleStatus

    statuses = listen(TurtleStatus, "/robot/status", 10.0)
    assert {(status.x, status.y, status.theta) for status in statuses} == {(0.0, 0.0, 0.0)}
    drops = {round(before.battery - after.battery, 3) for before, after in itertools.pairwise(statuses)}
    assert drops == {0.1}


def test_the_scan_has_180_readings_where_181_are_meant(lesson: Lesson) -> None:
    from sensor_msgs.msg import LaserScan

    scans = listen(LaserScan, "/obstacles", 20.0)
    assert {len(scan.ranges) for scan in scans} == {180}
    assert {reading for scan in scans for reading in scan.ranges} == {0.5, 10.0}
    near = sum(reading == 0.5 for scan in scans for reading in scan.ranges) / (180 * len(scans))
    assert 0.04 < near < 0.06
    assert scans[0].header.frame_id == "base_link"
