"""The programs of tf2_ros, tf2_tools and turtlesim, and the small print of broadcasters and listeners."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
import rclpy
from geometry_msgs.msg import TransformStamped
from program_terminal import Terminal, having
from rclpy.time import Time
from tf2_ros import Buffer, StaticTransformBroadcaster, TransformBroadcaster, TransformListener
from workshop import Workshop, distance

from turtle_lesson.ros.runtime.world import World
from turtle_lesson.session.lesson import underlay_packages

Run = Callable[..., list[Any]]


@pytest.fixture
def shop(world: World, capsys: pytest.CaptureFixture[str]) -> Iterator[Workshop]:
    """A terminal in a fresh world, ten seconds old."""
    for package in underlay_packages():
        world.packages.add(package)
    world.sim.run_until(10_000_000_000)
    yield Workshop(world, capsys)


def frame(parent: str, child: str, x: float = 0.0) -> TransformStamped:
    message = TransformStamped(child_frame_id=child)
    message.header.frame_id = parent
    message.transform.translation.x = x
    return message


STATIC = "ros2 run tf2_ros static_transform_publisher"


def test_the_underlay_has_its_programs(shop: Workshop) -> None:
    assert shop.say(
        "ros2 pkg executables tf2_ros", "ros2 pkg executables tf2_tools", "ros2 pkg executables turtlesim"
    ) == [
        "tf2_ros static_transform_publisher",
        "tf2_ros tf2_echo",
        "tf2_tools view_frames",
        "turtlesim draw_square",
        "turtlesim mimic",
        "turtlesim turtle_teleop_key",
        "turtlesim turtlesim_node",
    ]


def test_xacro_runs_where_it_is_installed(fresh_terminal: Terminal, monkeypatch: pytest.MonkeyPatch) -> None:
    text = "xacro is not available here: the Python package xacro is not installed: pip install xacro"
    monkeypatch.setitem(sys.modules, "xacro", None)
    assert having(fresh_terminal.say("ros2 run xacro xacro robot.xacro"), text)
    monkeypatch.delitem(sys.modules, "xacro")
    Path("xacro.py").write_text("import sys\ndef main():\n    print('made by', *sys.argv[1:])\n")
    monkeypatch.syspath_prepend(str(Path.cwd()))
    packages = {package.name: package for package in underlay_packages()}
    fresh_terminal.world.packages.add(packages["xacro"])
    assert fresh_terminal.say("ros2 run xacro xacro robot.xacro w:=1") == ["made by robot.xacro w:=1"]
    monkeypatch.delitem(sys.modules, "xacro")


# ---------------------------------------------------------------- static_transform_publisher


def test_a_static_transform_by_flags(shop: Workshop) -> None:
    node = "--ros-args -r __node:=lidar_frame"
    printed = shop.say(
        f"{STATIC} --x 1 --y -1e-3 --z -0.5 --yaw 3.1415927 --frame-id world --child-frame-id lidar {node}", seconds=1
    )
    assert printed == [
        "0.0 lidar_frame: Spinning until stopped - publishing transform",
        "translation: ('1.000000', '-0.001000', '-0.500000')",
        "rotation: ('0.000000', '0.000000', '1.000000', '-0.000000')",
        "from 'world' to 'lidar'",
    ]


def test_a_static_transform_in_the_old_way(shop: Workshop) -> None:
    printed = shop.say(f"{STATIC} 1 2 3 1.5707963 0 0 world a", f"{STATIC} 0 0 0 0 0 1 0 a b", seconds=1)
    assert (
        printed[0]
        == "[WARN] [1800000010.000000000] []: Old-style arguments are deprecated; see --help for new-style arguments"
    )
    assert "rotation: ('0.000000', '0.000000', '0.707107', '0.707107')" in printed
    assert "rotation: ('0.000000', '0.000000', '1.000000', '0.000000')" in printed


@pytest.mark.parametrize(
    ("words", "problem"),
    [
        ("1 2 3", "the following arguments are required: --frame-id, --child-frame-id"),
        ("--x", "argument --x: expected one argument"),
        ("--x one --frame-id a --child-frame-id b", "argument --x: invalid float value: 'one'"),
        ("one 0 0 0 0 0 a b", "argument --x: invalid float value: 'one'"),
        ("--child-frame-id b", "the following arguments are required: --frame-id"),
        ("--yaw 1 --qz 1 --frame-id a --child-frame-id b", "Cannot specify both quaternion and Euler rotations"),
        ("--x 1 0 0 0 0 0 0 --frame-id a --child-frame-id b", "unrecognized arguments: 0 0 0 0 0 0"),
        (
            "--frame-id a --child-frame-id a",
            "cannot publish static transform from 'a' to 'a': child_frame_id cannot equal frame_id",
        ),
    ],
)
def test_what_a_static_transform_cannot_be(shop: Workshop, words: str, problem: str) -> None:
    printed = shop.say(f"{STATIC} {words}")
    assert f"static_transform_publisher: error: {problem}" in printed
    assert printed[-1] == "[ros2run]: Process exited with failure 2"


def test_a_static_transform_has_help(shop: Workshop) -> None:
    assert shop.say(f"{STATIC} --help")[0].startswith("usage: static_transform_publisher [-h] [--x X]")


# ---------------------------------------------------------------- looking


def test_echo_says_how_it_is_used(shop: Workshop) -> None:
    usage = "usage: tf2_echo [-h] source_frame target_frame [echo_rate]"
    assert shop.say("ros2 run tf2_ros tf2_echo world")[0] == usage
    said = shop.say("ros2 run tf2_ros tf2_echo a b fast")
    assert said[1] == "tf2_echo: error: argument echo_rate: invalid float value: 'fast'"
    assert "the rate must be more than 0" in shop.say("ros2 run tf2_ros tf2_echo a b 0")[1]


def test_echo_at_a_rate_of_its_own(shop: Workshop) -> None:
    shop.say(f"{STATIC} --pitch 1.5707963267948966 --roll 0.3 --frame-id world --child-frame-id a", seconds=0.1)
    printed = shop.say("ros2 run tf2_ros tf2_echo world a 4", seconds=1.1)
    assert sum(line.startswith("At time") for line in printed) == 4
    assert "- Rotation: in RPY (radian) [0.300, 1.571, 0.000]" in printed


def test_the_tree_of_frames_is_drawn_as_text(shop: Workshop) -> None:
    for parent, child in (("world", "robot"), ("robot", "lidar"), ("robot", "camera"), ("world", "2")):
        shop.say(f"{STATIC} --frame-id {parent} --child-frame-id {child}", seconds=0.1)
    assert shop.say("ros2 run tf2_tools view_frames", seconds=6)[1:] == [
        "5.4 view_frames: Generating graph...",
        "world",
        "├── robot  (static)",
        "│   ├── lidar  (static)",
        "│   └── camera  (static)",
        "└── 2  (static)",
    ]


def test_no_frames_are_no_tree(shop: Workshop) -> None:
    assert shop.say("ros2 run tf2_tools view_frames --wait-time 1", seconds=2)[-1].startswith("No tf data received")


# ---------------------------------------------------------------- broadcasters and listeners


def test_a_static_broadcaster_tells_all_that_it_knows_and_the_first_of_a_frame_counts(
    run: Run, capsys: pytest.CaptureFixture[str]
) -> None:
    def teller(found: list[Any]) -> None:
        rclpy.init(args=[])
        node = rclpy.create_node("teller")
        broadcaster = StaticTransformBroadcaster(node)
        broadcaster.sendTransform(frame("world", "a", 1.0))
        broadcaster.sendTransform((frame("world", "b", 2.0), frame("world", "a", 9.0)))
        rclpy.spin(node)

    def listener(found: list[Any]) -> None:
        rclpy.init(args=[])
        node, buffer = rclpy.create_node("listener"), Buffer()
        TransformListener(buffer, node)
        for _ in range(20):
            rclpy.spin_once(node, timeout_sec=0.1)
        found += [buffer.lookup_transform("world", each, Time()).transform.translation.x for each in "ab"]

    assert run(teller, listener) == [1.0, 2.0]
    error = capsys.readouterr()
    assert "'a' was sent before, and on /tf_static the first transform of a frame counts" in error.out + error.err


def test_a_listener_with_a_thread_hears_while_its_program_is_busy(run: Run) -> None:
    def teller(found: list[Any]) -> None:
        rclpy.init(args=[])
        node = rclpy.create_node("teller")
        broadcaster = TransformBroadcaster(node, 10)
        node.create_timer(0.1, lambda: broadcaster.sendTransform(frame("world", "a", 1.0)))
        rclpy.spin(node)

    def program(found: list[Any]) -> None:
        import time

        rclpy.init(args=[])
        buffers = [Buffer(), Buffer(), Buffer()]
        TransformListener(buffers[0], rclpy.create_node("with_thread"), spin_thread=True)
        TransformListener(buffers[1], rclpy.create_node("without"))
        TransformListener(buffers[2], None, spin_thread=True)
        time.sleep(1.0)
        found += [buffer.can_transform("world", "a", Time()) for buffer in buffers]
        rclpy.shutdown()

    assert run(teller, program) == [True, False, True]


def test_other_topics_and_no_more_listening(run: Run) -> None:
    def program(found: list[Any]) -> None:
        rclpy.init(args=["--ros-args", "-r", "/tf:=/robot/tf"])
        node, buffer, other = rclpy.create_node("both"), Buffer(), Buffer()
        broadcaster = TransformBroadcaster(node)
        listener = TransformListener(buffer, node, qos=1, static_qos=1)
        TransformListener(other, node, tf_topic="/elsewhere")
        for name in "ab":
            broadcaster.sendTransform(frame("world", name))
            for _ in range(3):
                rclpy.spin_once(node, timeout_sec=0.1)
            listener.unregister()
        found += [
            node.get_publishers_info_by_topic("/robot/tf") != [],
            buffer._getFrameStrings(),
            other._getFrameStrings(),
        ]

    assert run(program) == [True, ["a", "world"], []]


def test_buffers_and_nodes_in_the_wrong_places(world: World) -> None:
    rclpy.init(args=[])
    node = rclpy.create_node("cell")
    with pytest.raises(TypeError, match=r"TransformListener\(buffer, node\) fills a Buffer, got <Node /cell>"):
        TransformListener(node, Buffer())  # type: ignore[arg-type]


def test_a_timeout_in_a_callback_of_a_single_threaded_executor_waits_in_vain(run: Run) -> None:
    def program(found: list[Any]) -> None:
        rclpy.init(args=[])
        node, buffer = rclpy.create_node("both"), Buffer()
        TransformListener(buffer, node)
        broadcaster = TransformBroadcaster(node)

        def ask() -> None:
            timer.cancel()
            broadcaster.sendTransform(frame("world", "a"))
            begun = node.get_clock().now()
            there = buffer.can_transform("world", "a", Time(), timeout=rclpy.duration.Duration(seconds=2.0))
            found.append((there, round((node.get_clock().now() - begun).nanoseconds / 1e9, 1)))
            node.create_timer(0.1, lambda: found.append(buffer.can_transform("world", "a", Time())))

        timer = node.create_timer(0.1, ask)
        rclpy.spin(node)

    assert run(program, seconds=3)[:2] == [(False, 2.0), True]


def test_a_clock_that_is_set_back_clears_the_buffer(run: Run) -> None:
    def program(found: list[Any]) -> None:
        from rosgraph_msgs.msg import Clock

        rclpy.init(args=["--ros-args", "-p", "use_sim_time:=true"])
        node = rclpy.create_node("replayed")
        buffer = Buffer(node=node)
        clock = node.create_publisher(Clock, "/clock", 10)
        for seconds in (50, 51, 20):
            clock.publish(Clock(clock=Time(seconds=seconds).to_msg()))
            rclpy.spin_once(node, timeout_sec=0.1)
            message = frame("world", "a")
            message.header.stamp.sec = seconds
            if seconds > 20:
                buffer.set_transform(message, "test")
            found.append(buffer.can_transform("world", "a", Time()))

    assert run(program) == [True, True, False]


# ---------------------------------------------------------------- turtlesim's own programs


def test_draw_square_draws_a_square(shop: Workshop) -> None:
    seen = shop.watch("turtle1")
    printed = shop.say("ros2 run turtlesim turtlesim_node", "ros2 run turtlesim draw_square", seconds=25)
    goals = [line.partition("New goal ")[2] for line in printed if "draw_square: New goal" in line]
    assert goals[:2] == ["[7.544445 5.544445, 0.000000]", "[7.464445 5.544445, 1.570796]"]
    for corner in ((5.54, 5.54), (7.46, 5.54), (7.46, 7.46), (5.54, 7.46)):
        assert min(distance((*corner, 0.0), place) for place in seen["turtle1"]) < 0.05
    xs, ys = [place[0] for place in seen["turtle1"]], [place[1] for place in seen["turtle1"]]
    assert math.isclose(max(xs) - min(xs), 2.0, abs_tol=0.1) and math.isclose(max(ys) - min(ys), 2.0, abs_tol=0.1)


def test_mimic_does_what_another_turtle_does(shop: Workshop) -> None:
    seen = shop.watch("turtle1", "turtle2")
    names = "-r input/pose:=turtle1/pose -r output/cmd_vel:=turtle2/cmd_vel"
    shop.say("ros2 run turtlesim turtlesim_node", f"ros2 run turtlesim mimic --ros-args {names}", seconds=1)
    shop.say("ros2 service call /spawn turtlesim/srv/Spawn '{x: 2.0, y: 2.0, name: turtle2}'", seconds=1)
    twist = "'{linear: {x: 1.0}, angular: {z: 0.5}}'"
    shop.say(f"ros2 topic pub --once /turtle1/cmd_vel geometry_msgs/msg/Twist {twist}", seconds=5)
    (x, y, theta), (other_x, other_y, other_theta) = seen["turtle1"][-1], seen["turtle2"][-1]
    assert theta > 0.4 and other_theta == pytest.approx(theta, abs=0.6)
    assert (other_x - 2.0, other_y - 2.0) == pytest.approx((x - 5.544445, y - 5.544445), abs=0.8)


def test_teleop_drives_and_turns_by_keys(shop: Workshop) -> None:
    shop.say("ros2 run turtlesim turtlesim_node", seconds=1)
    seen, keyboard = shop.watch("turtle1"), shop.world.sim.keyboard
    said = shop.say("ros2 run turtlesim turtle_teleop_key --ros-args -p scale_linear:=1.0", seconds=0.5)
    assert said[:3] == ["Reading from keyboard", "---------------------------", "Use arrow keys to move the turtle."]
    assert said[-1].startswith("turtle_teleop_key waits for keys.")
    for key in ("up", "left", "r"):
        keyboard.press(key)
        shop.run(3)
    assert seen["turtle1"][-1] == pytest.approx((6.55, 5.54, 1.5708), abs=0.05)
    keyboard.press("d")
    shop.run(0.5)
    keyboard.press("f")
    shop.run(3)
    assert 1.7 < seen["turtle1"][-1][2] < 2.5
    keyboard.press("q")
    shop.run(0.1)
    assert [process.exit_code for process in shop.world.processes if process.name == "turtle_teleop_key"] == [0]


def test_a_cell_may_have_a_listener_with_a_thread() -> None:
    """What a learner types in a cell, run as one: the thread is the simulation's, wherever the listener starts it."""
    from turtle_lesson.ros.runtime.world import open_world

    world = open_world()

    def teller() -> None:
        rclpy.init(args=[])
        node = rclpy.create_node("teller")
        broadcaster = TransformBroadcaster(node)
        node.create_timer(0.1, lambda: broadcaster.sendTransform(frame("world", "a", 1.0)))
        rclpy.spin(node)

    world.spawn(teller, name="teller")
    cell = """
import rclpy
from rclpy.duration import Duration
from rclpy.time import Time
from tf2_ros import Buffer, TransformListener

rclpy.init(args=[])
buffer = Buffer()
listener = TransformListener(buffer, rclpy.create_node("cell"), spin_thread=True)
there = buffer.lookup_transform("world", "a", Time(), timeout=Duration(seconds=5.0)).transform.translation.x
"""
    import __main__

    before = dict(vars(__main__))
    try:
        exec(cell, vars(__main__))
        assert (vars(__main__)["there"], world.now < 1e9) == (1.0, True)
    finally:
        for name in set(vars(__main__)) - set(before):
            delattr(__main__, name)
        world.close()
