"""Clocks, ROS time from /clock, jumps, sleeping, rates and what a timer tells: rclpy's and rcl's rules, in virtual time."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from typing import Any

import pytest
import rclpy
from hypothesis import given
from hypothesis import strategies as st
from rclpy.clock import Clock, ClockChange, ClockType, JumpHandle, JumpThreshold, ROSClock, TimeJump
from rclpy.duration import Duration
from rclpy.exceptions import InvalidHandle, NotInitializedException, ROSInterruptException
from rclpy.executors import MultiThreadedExecutor
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.time import Time
from rclpy.time_source import CLOCK_TOPIC, USE_SIM_TIME_NAME, TimeSource
from rclpy.timer import Timer
from rosgraph_msgs.msg import Clock as ClockMessage

from turtle_lesson.ros.runtime.world import World
from turtle_lesson.ros.sim.errors import NeverWakes

Run = Callable[..., list[Any]]
Capture = pytest.CaptureFixture[str]
SIM_TIME = Parameter(USE_SIM_TIME_NAME, value=True)


def clock_at(*moments: tuple[float, float]) -> Callable[[list[Any]], None]:
    """A program that says on /clock, at moments of robot time (s), what time it is (s)."""

    def clock(found: list[Any]) -> None:
        rclpy.init(args=[])
        publisher = rclpy.create_node("clock_server").create_publisher(ClockMessage, CLOCK_TOPIC, 10)
        begun = time.time()
        for moment, seconds in moments:
            time.sleep(max(0.0, begun + moment - time.time()))
            publisher.publish(ClockMessage(clock=Time(seconds=seconds).to_msg()))
        time.sleep(100.0)

    return clock


def follower(name: str = "follower", **options: Any) -> Node:
    """A node that follows /clock."""
    return Node(name, parameter_overrides=[SIM_TIME], **options)


def seconds_of(clock: Clock) -> float:
    """What a clock shows, in s."""
    return round(clock.now().nanoseconds / 1e9, 4)


# ---------------------------------------------------------------- what /clock does


def test_a_node_that_uses_simulated_time_shows_what_was_last_heard_on_the_clock_topic(run: Run) -> None:
    def program(found: list[Any]) -> None:
        rclpy.init(args=["--ros-args", "-p", "use_sim_time:=true"])
        node = rclpy.create_node("n")
        found.append((node.get_clock().ros_time_is_active, seconds_of(node.get_clock())))
        node.create_timer(0.4, lambda: found.append(seconds_of(node.get_clock())), clock=Clock())
        rclpy.spin(node)

    found = run(program, clock_at((1.0, 50.0), (1.3, 50.5), (2.0, 7.0)), seconds=2.5)
    assert found == [(True, 0.0), 0.0, 0.0, 50.0, 50.5, 50.5, 7.0]


def test_timers_go_by_the_clock_topic_and_those_of_other_clocks_do_not(run: Run) -> None:
    def program(found: list[Any]) -> None:
        rclpy.init(args=[])
        node = follower()
        node.create_timer(1.0, lambda: found.append(("ros", seconds_of(node.get_clock()))))
        node.create_timer(1.0, lambda: found.append("steady"), clock=Clock(clock_type=ClockType.STEADY_TIME))
        rclpy.spin(node)

    moments = [(0.1 * step, 100.0 + step) for step in range(1, 5)]
    found = run(program, clock_at(*moments), seconds=1.5)
    assert found == [("ros", 101.0), ("ros", 102.0), ("ros", 103.0), ("ros", 104.0), "steady"]


def test_a_clock_that_jumps_far_ahead_makes_a_timer_tick_once_and_keeps_its_phase(run: Run) -> None:
    def program(found: list[Any]) -> None:
        rclpy.init(args=[])
        node = follower()
        rclpy.spin_once(node, timeout_sec=0.15)
        node.create_timer(1.0, lambda: found.append(seconds_of(node.get_clock())))
        rclpy.spin(node)

    found = run(program, clock_at((0.1, 10.0), (0.2, 14.5), (0.3, 14.9), (0.4, 15.0)), seconds=1.0)
    assert found == [14.5, 15.0]


def test_in_the_trace_a_timer_on_the_clock_topic_is_ready_when_it_ticks(run: Run, world: World) -> None:
    world.keep_trace()

    def program(found: list[Any]) -> None:
        rclpy.init(args=[])
        node = follower()
        node.create_timer(0.5, lambda: None)
        rclpy.spin(node)

    run(clock_at((1.0, 10.0), (2.0, 10.6), (3.0, 11.2)), program)
    assert world.trace is not None
    ticks = next(each.ended for each in world.trace.callbacks if each.kind == "timer")
    assert [ready for ready, _, _ in ticks] == [began for _, began, _ in ticks] and len(ticks) == 3


def test_in_the_trace_rclpys_own_methods_are_callbacks_too_but_not_what_a_rate_needs(run: Run, world: World) -> None:
    world.keep_trace()

    def program(found: list[Any]) -> None:
        rclpy.init(args=[])
        node = follower()
        relay = node.create_publisher(ClockMessage, "copy", 10)
        node.create_subscription(ClockMessage, "original", relay.publish, 10)
        node.create_timer(0.5, node.get_clock().now)
        node.create_rate(2.0)
        rclpy.spin(node)

    run(program, seconds=1.0)
    assert world.trace is not None
    own = [(each.kind, each.name) for each in world.trace.callbacks if each.kind != "service"]
    assert own == [("subscription", "publish"), ("timer", "now")]
    assert "get_parameters" in {each.name for each in world.trace.callbacks if each.kind == "service"}


CLOCKED = (5.5, 6.0, 6.5, 7.0, 10.0, 10.5, 11.0, 11.0, 12.25, 12.5, 20.0, 20.0, 20.2)
CLOCKED += (4.0, 4.5, 5.0, 5.2, 6.0, 4.9, 5.9, 6.0, 6.0, 6.3, 50.0)
"""What /clock says, 0.1 s apart, after it has said 5.0."""


@pytest.mark.parametrize(
    ("period", "ticks", "left"),
    [
        (
            1.0,
            [6.0, 7.0, 10.0, 11.0, 12.25, 20.0, 5.0, 6.0, 5.9, 50.0],
            [5, 10, 5, 10, 10, 5, 10, 10, 7.5, 5, 10, 10, 8, 10, 5, 10, 8, 10, 10, 10, 9, 9, 6, 9],
        ),
        (
            0.3,
            [5.5, 6.0, 6.5, 7.0, 10.0, 10.5, 11.0, 12.25, 12.5, 20.0, 4.5, 5.0, 5.2, 6.0, 5.9, 6.3, 50.0],
            [1, 2, 3, 1, 1, 2, 3, 3, 2.5, 3, 3, 3, 1, 3, 1, 2, 3, 1, 3, 2, 1, 1, 1, 2],
        ),
    ],
)
def test_a_timer_on_the_clock_topic_ticks_when_that_of_a_real_one_did(
    run: Run, period: float, ticks: list[float], left: list[float]
) -> None:
    """Recorded (Jazzy): when the callback was called, and what was left of the period (0.1 s) after each word of /clock."""
    found_ticks: list[float] = []

    def program(found: list[Any]) -> None:
        rclpy.init(args=[])
        node = follower()
        rclpy.spin_once(node, timeout_sec=0.15)
        timer = node.create_timer(period, lambda: found_ticks.append(seconds_of(node.get_clock())))

        def look() -> None:
            found.append(round(timer.time_until_next_call() / 1e8, 4))

        node.create_timer(0.1, look, clock=Clock())
        rclpy.spin(node)

    moments = [(0.05, 5.0), *((0.1 + 0.1 * index, seconds) for index, seconds in enumerate(CLOCKED))]
    found = run(program, clock_at(*moments), seconds=2.7)
    assert found_ticks == ticks
    assert found[: len(CLOCKED)] == left


def test_after_a_jump_back_a_timer_waits_one_period(run: Run) -> None:
    def program(found: list[Any]) -> None:
        rclpy.init(args=[])
        node = follower()
        node.create_timer(1.0, lambda: found.append(seconds_of(node.get_clock())))
        rclpy.spin(node)

    found = run(program, clock_at((0.1, 100.0), (0.2, 5.0), (0.3, 5.9), (0.4, 6.0)), seconds=1.0)
    assert found == [100.0, 6.0]


def test_simulated_time_can_be_switched_on_and_off(run: Run) -> None:
    def program(found: list[Any]) -> None:
        rclpy.init(args=[])
        node = rclpy.create_node("n")
        node.create_timer(0.5, lambda: found.append(seconds_of(node.get_clock())))

        def switch(on: bool) -> None:
            (result,) = node.set_parameters([Parameter(USE_SIM_TIME_NAME, value=on)])
            assert result.successful
            found.append(("switched", on, [each.topic for each in node.subscriptions]))

        started = time.time()
        while (passed := time.time() - started) < 4.0:
            if passed > 1.2 and not node.get_clock().ros_time_is_active and len(found) == 2:
                switch(True)
            if passed > 2.9 and node.get_clock().ros_time_is_active:
                switch(False)
            rclpy.spin_once(node, timeout_sec=0.05)

    found = run(program, clock_at((2.0, 20.0), (2.3, 20.6), (2.6, 20.7)))
    assert found[:3] == [1_800_000_000.5, 1_800_000_001.0, ("switched", True, ["/clock"])]
    assert found[3:5] == [20.6, ("switched", False, [])]
    assert [round(each - 1_800_000_000, 2) for each in found[5:]] == [
        3.1,
        3.6,
    ]  # rcl waits for period minus what is left


def test_what_follows_the_clock_topic_but_hears_nothing_says_so(run: Run, capsys: Capture) -> None:
    def program(found: list[Any]) -> None:
        rclpy.init(args=["--ros-args", "-p", "use_sim_time:=true"])
        rclpy.spin(rclpy.create_node("n"))

    run(program)
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith(
        "[WARN] [1800000005.000000000] [n]: The parameter use_sim_time is true, but nothing has been"
    )


def test_a_node_that_hears_the_clock_says_nothing(run: Run, capsys: Capture) -> None:
    run(clock_at((1.0, 1.0)), lambda found: (rclpy.init(args=[]), rclpy.spin(follower())))
    assert capsys.readouterr().err == ""


def test_events_about_parameters_bear_the_nodes_own_time(run: Run) -> None:
    def program(found: list[Any]) -> None:
        from rcl_interfaces.msg import ParameterEvent

        rclpy.init(args=[])
        ear = rclpy.create_node("ear")
        ear.create_subscription(ParameterEvent, "/parameter_events", lambda event: found.append(event.stamp.sec), 10)
        node = follower()
        rclpy.spin_once(node, timeout_sec=1.0)
        node.declare_parameter("speed", 1.0)
        for _ in range(3):
            rclpy.spin_once(ear, timeout_sec=0.1)

    assert run(program, clock_at((0.5, 77.0)))[-1] == 77


# ---------------------------------------------------------------- time sources


def test_a_time_source_can_be_made_by_hand(run: Run) -> None:
    def program(found: list[Any]) -> None:
        rclpy.init(args=[])
        node, clock = rclpy.create_node("n"), ROSClock()
        source = TimeSource(node=node)
        source.attach_clock(clock)
        source.ros_time_is_active = True
        rclpy.spin_once(node, timeout_sec=1.0)
        late = ROSClock()
        source.attach_clock(late)
        found.append((seconds_of(clock), seconds_of(late), node.get_clock().ros_time_is_active))
        source.detach_node()
        found.append(len(list(node.subscriptions)))

    assert run(program, clock_at((0.5, 12.0))) == [(12.0, 12.0, False), 0]


def test_a_time_source_takes_nodes_and_ros_clocks_only(world: World) -> None:
    source = TimeSource()
    with pytest.raises(TypeError, match=r"Node must be of type rclpy.node.Node"):
        source.attach_node("n")
    with pytest.raises(ValueError, match=r"Only clocks with type ROS_TIME can be attached."):
        source.attach_clock(Clock())


def test_use_sim_time_is_a_bool(world: World) -> None:
    rclpy.init(args=[])
    node = rclpy.create_node("n")
    (result,) = node.set_parameters([Parameter(USE_SIM_TIME_NAME, value="yes")])
    assert result.reason == "Wrong parameter type, expected 'Type.BOOL' got 'Type.STRING'"


# ---------------------------------------------------------------- kinds of clock


def test_the_clock_of_ros_time_is_a_class_of_its_own(world: World) -> None:
    assert type(Clock(clock_type=ClockType.ROS_TIME)) is ROSClock
    assert type(Clock()) is Clock
    assert repr(ROSClock()) == "Clock(clock_type=ROS_TIME)"
    assert f"{ROSClock().clock_type} {ClockType.STEADY_TIME!s}" == "ClockType.ROS_TIME ClockType.STEADY_TIME"
    assert Clock(clock_type=ClockType.STEADY_TIME).clock_type == ClockType.STEADY_TIME
    with pytest.raises(TypeError, match="Clock type must be a ClockType enum"):
        Clock(clock_type="STEADY_TIME")


def test_the_time_of_a_ros_clock_can_be_set_by_hand(world: World) -> None:
    clock = ROSClock()
    clock.set_ros_time_override(Time(seconds=5, clock_type=ClockType.ROS_TIME))
    assert not clock.ros_time_is_active and clock.now() > Time(seconds=1_000_000, clock_type=ClockType.ROS_TIME)
    clock._set_ros_time_is_active(True)
    assert clock.now() == Time(seconds=5, clock_type=ClockType.ROS_TIME)
    with pytest.raises(TypeError, match=r"Time must be specified as rclpy.time.Time. Received type: <class 'int'>"):
        clock.set_ros_time_override(5)


# ---------------------------------------------------------------- jumps


def jumps_of(threshold: JumpThreshold) -> list[Any]:
    """What is told of a clock that begins at 10 s, goes on to 11 s, back to 10.5 s, and ends to follow."""
    clock, told = ROSClock(), []
    clock.set_ros_time_override(Time(seconds=10))

    def before() -> None:
        told.append(("before", seconds_of(clock) if clock.ros_time_is_active else None))

    clock.create_jump_callback(
        threshold,
        pre_callback=before,
        post_callback=lambda jump: told.append((jump.clock_change.name, jump.delta.nanoseconds / 1e9)),
    )
    clock._set_ros_time_is_active(True)
    clock.set_ros_time_override(Time(seconds=11))
    clock.set_ros_time_override(Time(seconds=10.5))
    clock._set_ros_time_is_active(False)
    clock.set_ros_time_override(Time(seconds=99))
    return told


ACTIVATED, AHEAD = ("ROS_TIME_ACTIVATED", 0.0), ("ROS_TIME_NO_CHANGE", 1.0)
BACK, DEACTIVATED = ("ROS_TIME_NO_CHANGE", -0.5), ("ROS_TIME_DEACTIVATED", 0.0)


@pytest.mark.parametrize(
    ("forward", "backward", "changes", "expected"),
    [
        (None, None, True, [("before", None), ACTIVATED, ("before", 10.5), DEACTIVATED]),
        (1.0, None, False, [("before", 10.0), AHEAD]),
        (1.1, None, False, []),
        (None, -0.5, False, [("before", 11.0), BACK]),
        (None, -0.6, False, []),
    ],
)
def test_jumps_are_told_to_who_wants_to_know_of_them(
    world: World, forward: float | None, backward: float | None, changes: bool, expected: list[Any]
) -> None:
    durations = [None if each is None else Duration(seconds=each) for each in (forward, backward)]
    assert (
        jumps_of(JumpThreshold(min_forward=durations[0], min_backward=durations[1], on_clock_change=changes))
        == expected
    )


def test_who_wants_to_know_of_no_jumps_any_more_says_so(world: World) -> None:
    clock, told = ROSClock(), []
    threshold = JumpThreshold(min_forward=None, min_backward=None)
    with clock.create_jump_callback(threshold, post_callback=told.append) as handle:
        assert isinstance(handle, JumpHandle)
        clock._set_ros_time_is_active(True)
    clock._set_ros_time_is_active(False)
    handle.unregister()  # a second time does nothing
    assert [jump.clock_change for jump in told] == [ClockChange.ROS_TIME_ACTIVATED]
    assert told == [TimeJump(ClockChange.ROS_TIME_ACTIVATED, Duration())]


@pytest.mark.parametrize(
    ("make", "text"),
    [
        (
            lambda: JumpThreshold(min_forward=Duration(), min_backward=None),
            "min_forward must be a positive non-zero duration",
        ),
        (
            lambda: JumpThreshold(min_forward=None, min_backward=Duration()),
            "min_backward must be a negative non-zero duration",
        ),
        (
            lambda: JumpThreshold(min_forward=None, min_backward=None, on_clock_change=False),
            "At least one jump threshold must be enabled",
        ),
        (
            lambda: ROSClock().create_jump_callback(JumpThreshold(min_forward=None, min_backward=None)),
            "One of pre_callback or post_callback must be callable",
        ),
        (
            lambda: ROSClock().create_jump_callback(JumpThreshold(min_forward=None, min_backward=None), pre_callback=5),
            "must be callable, and so must the other if given",
        ),
    ],
)
def test_wishes_that_make_no_sense(world: World, make: Callable[[], object], text: str) -> None:
    with pytest.raises(ValueError, match=text):
        make()


# ---------------------------------------------------------------- sleeping


def test_a_sleep_ends_when_the_clock_topic_says_so(run: Run) -> None:
    def program(found: list[Any]) -> None:
        rclpy.init(args=[])
        node = follower()
        clock = node.get_clock()

        def nap() -> None:
            timer.cancel()
            slept = clock.sleep_for(Duration(seconds=2))
            found.append((slept, seconds_of(clock), round(time.monotonic(), 1)))
            found.append(clock.sleep_until(Time(seconds=1, clock_type=ClockType.ROS_TIME)))

        group = rclpy.callback_groups.MutuallyExclusiveCallbackGroup()
        timer = node.create_timer(1.0, nap, callback_group=group)
        executor = MultiThreadedExecutor(2)
        executor.add_node(node)
        executor.spin()

    assert run(program, clock_at((0.1, 100.0), (0.5, 101.9), (0.9, 102.5))) == [(True, 102.5, 0.9), True]


def test_a_sleep_ends_with_false_when_time_has_another_source_or_ros_is_shut_down(run: Run) -> None:
    def program(found: list[Any]) -> None:
        rclpy.init(args=[])
        node = rclpy.create_node("n")
        clock = node.get_clock()
        node.create_timer(1.0, lambda: node.set_parameters([SIM_TIME]), clock=Clock(clock_type=ClockType.STEADY_TIME))
        node.create_timer(3.0, rclpy.shutdown, clock=Clock(clock_type=ClockType.STEADY_TIME))

        def nap() -> None:
            timer.cancel()
            found.append((clock.sleep_for(Duration(seconds=50)), round(time.monotonic(), 1)))
            found.append((Clock().sleep_for(Duration(seconds=50)), round(time.monotonic(), 1)))

        timer = node.create_timer(0.1, nap, callback_group=rclpy.callback_groups.MutuallyExclusiveCallbackGroup())
        executor = MultiThreadedExecutor(2)
        executor.add_node(node)
        executor.spin()
        time.sleep(1.0)

    assert run(program) == [(False, 1.0), (False, 3.0)]


def test_a_sleep_in_the_only_thread_that_could_hear_the_clock_is_explained(run: Run) -> None:
    def program(found: list[Any]) -> None:
        rclpy.init(args=[])
        node = follower()
        with pytest.raises(NeverWakes, match="follows /clock") as caught:
            node.get_clock().sleep_for(Duration(seconds=1))
        found.append(str(caught.value))

    (text,) = run(program, clock_at((0.5, 1.0)))
    assert "Use a timer; or a MultiThreadedExecutor, with this callback in a group of its own." in text


@pytest.mark.parametrize("kind", list(ClockType)[1:], ids=lambda kind: kind.name)
def test_a_negative_duration_is_over_at_once(run: Run, kind: ClockType) -> None:
    def program(found: list[Any]) -> None:
        rclpy.init(args=[])
        found.append(Clock(clock_type=kind).sleep_for(Duration(seconds=-1)))
        found.append(round(time.monotonic(), 3))

    assert run(program) == [True, 0.0]


def test_sleeping_wants_a_context_that_is_up_and_a_time_of_the_same_clock(run: Run) -> None:
    def program(found: list[Any]) -> None:
        with pytest.raises(NotInitializedException):
            Clock().sleep_for(Duration(seconds=1))
        rclpy.init(args=[])
        with pytest.raises(ValueError, match="until's clock type does not match this clock's type"):
            Clock().sleep_until(Time(clock_type=ClockType.ROS_TIME))

    run(program)


# ---------------------------------------------------------------- rates


def test_a_tick_that_came_while_nobody_slept_is_not_lost(run: Run) -> None:
    def program(found: list[Any]) -> None:
        rclpy.init(args=[])
        node = rclpy.create_node("n")

        def walk() -> None:
            timer.cancel()
            rate = node.create_rate(10)
            begun = time.monotonic()
            for nap in (0.0, 0.25, 0.0, 0.0):
                time.sleep(nap)
                rate.sleep()
                found.append(round(time.monotonic() - begun, 2))
            node.destroy_rate(rate)
            with pytest.raises(RuntimeError, match="Rate cannot sleep because it has been destroyed"):
                rate.sleep()
            rate = node.create_rate(1)
            node.destroy_timer(rate._timer)
            with pytest.raises(InvalidHandle, match="Rate cannot sleep because the timer has been destroyed"):
                rate.sleep()

        timer = node.create_timer(0.1, walk)
        executor = MultiThreadedExecutor(2)
        executor.add_node(node)
        executor.spin()

    assert run(program) == [0.1, 0.35, 0.4, 0.5]


def test_a_rate_ends_with_the_shutdown(run: Run) -> None:
    def program(found: list[Any]) -> None:
        rclpy.init(args=[])
        node = rclpy.create_node("n")

        def walk() -> None:
            timer.cancel()
            rate = node.create_rate(0.1)
            for _ in range(2):
                with pytest.raises(ROSInterruptException, match=r"rclpy.shutdown\(\) has been called"):
                    rate.sleep()
                found.append(round(time.monotonic(), 1))

        timer = node.create_timer(0.1, walk)
        node.create_timer(1.0, rclpy.shutdown, callback_group=rclpy.callback_groups.ReentrantCallbackGroup())
        executor = MultiThreadedExecutor(2)
        executor.add_node(node)
        executor.spin()
        time.sleep(0.1)

    assert run(program) == [1.0, 1.0]


def test_a_rate_goes_by_the_clock_topic_too(run: Run) -> None:
    def program(found: list[Any]) -> None:
        rclpy.init(args=[])
        node = follower()

        def walk() -> None:
            timer.cancel()
            rate = node.create_rate(1)
            for _ in range(2):
                rate.sleep()
                found.append(seconds_of(node.get_clock()))

        group = rclpy.callback_groups.MutuallyExclusiveCallbackGroup()
        timer = node.create_timer(0.5, walk, callback_group=group)
        executor = MultiThreadedExecutor(2)
        executor.add_node(node)
        executor.spin()

    assert run(program, clock_at((0.1, 10.0), (0.2, 10.6), (0.3, 11.2), (0.4, 11.9), (0.5, 12.1))) == [11.2, 12.1]


def test_a_rate_may_follow_spin_once_in_one_loop_if_its_timer_is_what_was_called(run: Run) -> None:
    def program(found: list[Any]) -> None:
        rclpy.init(args=[])
        node = rclpy.create_node("n")
        rate = node.create_rate(1)
        begun = time.monotonic()
        for _ in range(3):
            rclpy.spin_once(node)
            rate.sleep()
            found.append(round(time.monotonic() - begun, 2))
        node.create_timer(0.5, lambda: found.append("another callback"))
        with pytest.raises(NeverWakes, match="this rate would sleep forever"):
            while True:
                rclpy.spin_once(node)
                rate.sleep()

    assert run(program) == [1.0, 2.0, 3.0, "another callback"]


def test_a_rate_that_is_destroyed_wakes_the_thread_that_sleeps(run: Run) -> None:
    def program(found: list[Any]) -> None:
        rclpy.init(args=[])
        node = rclpy.create_node("n")
        rate = node.create_rate(1e-7)
        sleeper = threading.Thread(target=rate.sleep)
        sleeper.start()
        time.sleep(1)
        found.append(node.destroy_rate(rate))
        sleeper.join()

    assert run(program) == [True]


def test_a_rate_follows_spin_once_in_a_cell_as_well(world: World) -> None:
    rclpy.init(args=[])
    node = rclpy.create_node("n")
    rate = node.create_rate(4)
    for _ in range(3):
        rclpy.spin_once(node)
        rate.sleep()
    assert world.now == 750_000_000


def test_a_cell_may_sleep_at_a_rate_without_spinning(world: World) -> None:
    rclpy.init(args=[])
    rate = rclpy.create_node("n").create_rate(4)
    for _ in range(3):
        rate.sleep()
    assert world.now == 750_000_000


def test_a_timer_is_a_context_manager_and_gone_after_its_block(world: World) -> None:
    rclpy.init(args=[])
    node = rclpy.create_node("n")
    with node.create_timer(1.0, lambda: None) as timer:
        assert isinstance(timer, Timer)
        with timer.handle:
            assert timer.time_until_next_call() == 1_000_000_000
        assert timer.handle.pointer == timer.handle.pointer
    assert list(node.timers) == []
    with pytest.raises(InvalidHandle, match="cannot use Destroyable because destruction was requested"):
        timer.reset()


# ---------------------------------------------------------------- times and durations


moments = st.integers(0, 2**63 - 1)
spans = st.integers(-(2**63), 2**63 - 1)


@given(moments, spans)
def test_arithmetic_with_any_times_is_exact_or_refused(moment: int, span: int) -> None:
    start, length = Time(nanoseconds=moment), Duration(nanoseconds=span)
    if moment + span < 0:
        with pytest.raises(ValueError, match="must not be negative"):
            start + length
    elif moment + span >= 2**63:
        with pytest.raises(OverflowError, match="too large to store in C time point"):
            start + length
    else:
        assert (start + length).nanoseconds == (length + start).nanoseconds == moment + span
        assert ((start + length) - start).nanoseconds == span
        assert (start + length > start) == (span > 0)


@given(st.integers(0, 2**31 - 1), st.integers(0, 10**9 - 1))
def test_times_and_durations_survive_their_messages(seconds: int, nanoseconds: int) -> None:
    moment = Time(seconds=seconds, nanoseconds=nanoseconds, clock_type=ClockType.ROS_TIME)
    assert Time.from_msg(moment.to_msg()) == moment
    assert moment.seconds_nanoseconds() == (seconds, nanoseconds)
    span = Duration(seconds=-seconds, nanoseconds=nanoseconds)
    assert Duration.from_msg(span.to_msg()) == span


def test_a_time_becomes_a_date(world: World) -> None:
    from datetime import datetime

    assert Time(seconds=1_800_000_000.5).to_datetime() == datetime.fromtimestamp(1_800_000_000.5)
    with pytest.raises(TypeError, match="Time object's clock type should be either ROS_TIME or SYSTEM_TIME"):
        Time(clock_type=ClockType.STEADY_TIME).to_datetime()
