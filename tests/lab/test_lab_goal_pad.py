"""The goal pad without a browser: what its panels do when a view sends them orders."""

from __future__ import annotations

import asyncio
import math
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest

from turtle_lesson import start
from turtle_lesson.lab.path import WORLD
from turtle_lesson.lab.widgets.goal_pad import KEPT, SPACING, TAIL
from turtle_lesson.ros.sim.simulation import EPOCH
from turtle_lesson.session.lesson import Lesson
from turtle_lesson.session.live import Stopwatch
from turtle_lesson.turtlesim.obstacles import WORLDS, Box, Circle

MIDDLE = 5.544445


@pytest.fixture
def lesson(capsys: pytest.CaptureFixture[str]) -> Iterator[Lesson]:
    """A turtle and its three nodes, a second after their launch; the detector measures."""
    lesson = start()
    lesson.launch("robot_controller", "start_system.launch.py", source="world")
    lesson.run(1)
    yield lesson
    lesson._world.close()


def shown(lesson: Lesson) -> Any:
    """The goal pad, with one view open."""
    pad = lesson.goal_pad()
    tell(pad, "open")
    return pad


def tell(pad: Any, name: str, /, **content: Any) -> None:
    """What the browser does."""
    pad._order(pad, {"do": name, "view": "v", **content}, [])


def go(pad: Any, x: Any, y: Any, theta: Any = 0.0) -> None:
    tell(pad, "goal", x=x, y=y, theta=theta)


def after(lesson: Lesson, pad: Any, seconds: float) -> list[dict[str, Any]]:
    """The goals that the browser knows of, some robot time later."""
    lesson.run(seconds)
    pad.tick()
    return pad.goals


def numbers(trait: bytes) -> np.ndarray:
    return np.frombuffer(trait, "<f4")


# -- goals -----------------------------------------------------------------------------------------------------------


def test_a_goal_is_reached_and_the_answer_is_shown(lesson: Lesson) -> None:
    pad = shown(lesson)
    go(pad, 8.0, 8.0, 1.57)
    assert pad.words == "Goal 1 at (8.00, 8.00) m: on its way."
    [goal] = after(lesson, pad, 6)
    assert (goal["state"], goal["answer"]) == ("reached", "success: True, time_taken: 1.9 s")
    assert goal["away"] == pytest.approx(math.dist((8, 8), (MIDDLE, MIDDLE)), abs=1e-4)
    x, y, theta, _ = numbers(pad.pose)
    assert math.dist((x, y), (8, 8)) < 0.2
    assert theta == pytest.approx(1.57, abs=0.1)
    assert "1 goal sent: 1 reached. Goal 1 at (8.00, 8.00) m facing 1.57 rad (90.0°): reached." in repr(pad)


def test_a_refused_goal_says_why_in_the_navigators_words(lesson: Lesson) -> None:
    pad = shown(lesson)
    go(pad, 12.0, 3.0)
    [goal] = after(lesson, pad, 0.1)
    why = "(12.00, 3.00) is outside the world: x and y must be from 0 to 11.09."
    assert (goal["state"], goal["answer"]) == ("refused", f"{why} (success: False, time_taken: 0.0 s)")
    assert why in pad.words


def test_a_second_goal_on_the_way_finds_the_navigator_busy(lesson: Lesson) -> None:
    pad = shown(lesson)
    go(pad, 8.0, 8.0)
    lesson.run(0.5)
    go(pad, 1.0, 1.0)
    first, second = after(lesson, pad, 0.5)
    assert first["state"] == "on its way"
    assert second["state"] == "busy"
    assert second["answer"].startswith("Still on the way to (8.00, 8.00); ask again")
    assert [goal["state"] for goal in after(lesson, pad, 5)] == ["reached", "busy"]


def test_a_goal_that_is_not_reached_in_time_says_why(lesson: Lesson) -> None:
    lesson.launch("robot_controller", "start_system.launch.py", goal_timeout=1.0)
    pad = shown(lesson)
    go(pad, 1.0, 1.0)
    [goal] = after(lesson, pad, 5)
    assert goal["state"] == "not reached"
    assert "That is all the time goal_timeout gives (1.0 s)" in goal["answer"]
    assert goal["answer"].endswith("(success: False, time_taken: 1.0 s)")


def test_a_warning_of_something_else_is_no_reason(lesson: Lesson) -> None:
    lesson.place(Circle(x=MIDDLE + 0.4, y=MIDDLE, radius=0.3))
    pad = shown(lesson)
    go(pad, 8.0, 8.0)
    lesson.run(0.5)
    go(pad, 12.0, 1.0)
    lesson.run(5)
    go(pad, 12.0, 1.0)
    goals = after(lesson, pad, 0.5)
    assert [goal["state"] for goal in goals] == ["reached", "busy", "refused"]
    assert not any("Obstacle" in goal["answer"] for goal in goals)
    assert "outside the world" in goals[2]["answer"]


def test_without_a_navigator_it_says_what_to_type() -> None:
    lesson = start()
    lesson.run(1)
    pad = shown(lesson)
    go(pad, 8.0, 8.0)
    assert pad.goals[0]["state"] == "not sent"
    assert pad.goals[0]["answer"] == (
        'No node answers /navigate_to. Start the navigator: lesson.launch("robot_controller", "start_system.launch.py") '
        "or ros2 run robot_controller navigator &"
    )
    assert lesson.now == 1.0
    lesson.launch("robot_controller", "start_system.launch.py")
    go(pad, 8.0, 8.0)
    assert [goal["state"] for goal in after(lesson, pad, 5)] == ["not sent", "reached"]


def test_without_the_package_it_says_how_to_build_it() -> None:
    lesson = start(package=None)
    pad = shown(lesson)
    go(pad, 8.0, 8.0)
    assert pad.goals[0]["state"] == "not sent"
    assert "robot_controller is not here. Build it and source it: colcon build" in pad.goals[0]["answer"]


@pytest.mark.parametrize("restart", [False, True])
def test_a_navigator_that_is_stopped_on_the_way_leaves_no_goal_waiting(lesson: Lesson, restart: bool) -> None:
    handle = lesson.launch("robot_controller", "start_system.launch.py")
    pad = shown(lesson)
    go(pad, 1.0, 1.0)
    lesson.run(0.3)
    handle.stop()
    if restart:
        lesson.launch("robot_controller", "start_system.launch.py")
    pad._paces.clear()
    [goal] = after(lesson, pad, 1.0)
    assert (goal["state"], goal["answer"].split(";")[0]) == ("no answer", "The navigator was stopped on the way")


def test_of_fifty_goals_at_once_none_is_lost(lesson: Lesson) -> None:
    pad = shown(lesson)
    for number in range(50):
        go(pad, 1.0 + 0.1 * number, 2.0)
    goals = after(lesson, pad, 6)
    assert [goal["number"] for goal in goals] == list(range(1, 51))
    assert [goal["state"] for goal in goals] == ["reached"] + 49 * ["busy"]
    assert all("Still on the way to (1.00, 2.00)" in goal["answer"] for goal in goals[1:])
    assert "50 goals sent: 1 reached and 49 busy." in repr(pad)


def test_the_browser_is_told_of_the_newest_goals(lesson: Lesson) -> None:
    pad = shown(lesson)
    for _ in range(70):
        go(pad, 12.0, 2.0)
    assert [goal["number"] for goal in after(lesson, pad, 1)] == list(range(11, 71))


@pytest.mark.parametrize("value", [None, "8", True, math.nan, math.inf])
def test_what_is_no_number_is_no_goal(lesson: Lesson, value: Any) -> None:
    pad = shown(lesson)
    go(pad, value, 8.0)
    assert pad.words == f"The goal's x must be a number, got {value!r}."
    assert pad.goals == []


def test_a_number_too_large_for_the_message_is_said(lesson: Lesson) -> None:
    pad = shown(lesson)
    go(pad, 1e50, 8.0)
    assert pad.goals[0]["state"] == "not sent"
    assert "'x' field must be a float in" in pad.goals[0]["answer"]


def test_it_is_a_client_only_while_it_is_needed(lesson: Lesson) -> None:
    node = lesson._recording.node
    pad = shown(lesson)
    assert not list(node.clients)
    subscriptions = len(list(node.subscriptions))
    go(pad, 8.0, 8.0)
    assert len(list(node.clients)) == 1
    assert len(list(node.subscriptions)) == subscriptions + 1
    tell(pad, "close")
    assert len(list(node.clients)) == 1, "an answer is still to come"
    lesson.run(5)
    assert pad.desk.goals[0].state == "reached"
    assert not list(node.clients)
    assert len(list(node.subscriptions)) == subscriptions


def test_showing_it_lets_no_time_pass_and_says_where_the_turtle_is(lesson: Lesson) -> None:
    pad = shown(lesson)
    assert lesson.now == 1.9
    assert repr(pad) == (
        "Goal pad at 1.90 s of robot time: the turtle is at (5.54, 5.54) m facing 0.00 rad (0.0°). "
        "No goal sent yet. No obstacle in the world."
    )
    assert lesson.goal_pad() is pad


def test_before_the_first_pose_it_says_so() -> None:
    assert "no pose heard yet" in repr(start(simulator=False).goal_pad())


# -- the clock -------------------------------------------------------------------------------------------------------


def test_the_clock_plays_at_a_rate_pauses_and_steps(lesson: Lesson) -> None:
    async def story() -> None:
        pad = shown(lesson)
        assert pad.clock == {"turns": True, "playing": False, "rate": 1.0}
        tell(pad, "rate", rate=10)
        assert not pad.clock["playing"], "choosing a rate starts nothing"
        tell(pad, "play")
        await asyncio.sleep(0.5)
        pad.tick()
        assert pad.clock == {"turns": True, "playing": True, "rate": 10.0}
        tell(pad, "pause")
        assert lesson.now > 2.0
        assert 0.2 < pad.wall["seconds"] < 3.0
        assert pad.wall["speed"] == 0.0
        before = lesson.now
        tell(pad, "step", seconds=0.1)
        assert lesson.now == pytest.approx(before + 0.1)
        assert pad.now == pytest.approx(lesson.now, abs=1e-3)
        await asyncio.sleep(0.1)
        assert lesson.now == pytest.approx(before + 0.1)
        tell(pad, "close")

    asyncio.run(story())


def test_as_fast_as_possible_is_fast_and_leaves_the_notebook_usable(lesson: Lesson) -> None:
    async def story() -> None:
        pad = shown(lesson)
        tell(pad, "rate", rate="max")
        tell(pad, "play")
        turns, before = 0, lesson.now
        for _ in range(10):
            await asyncio.sleep(0.05)
            turns += 1
        pad.tick()
        assert pad.clock["rate"] == "max"
        assert pad.wall["speed"] > 1 and lesson.now > before + 1  # hundreds on a quiet machine
        assert turns == 10
        lesson.pause()
        tell(pad, "close")

    asyncio.run(story())


def test_play_takes_infinity_as_a_rate(lesson: Lesson) -> None:
    async def story() -> float:
        lesson.play(math.inf)
        await asyncio.sleep(0.3)
        lesson.pause()
        return lesson.now

    assert asyncio.run(story()) > 5


def test_a_goal_lets_paused_time_go_on(lesson: Lesson) -> None:
    async def story() -> None:
        pad = shown(lesson)
        lesson._player.rate = math.inf
        go(pad, 8.0, 8.0)
        await asyncio.sleep(0.5)
        assert [goal["state"] for goal in after(lesson, pad, 0)] == ["reached"]
        lesson.pause()
        tell(pad, "close")

    asyncio.run(story())


@pytest.mark.parametrize("rate", [0, -1, "fast", None, math.nan])
def test_an_impossible_rate_is_refused_in_words(lesson: Lesson, rate: Any) -> None:
    pad = shown(lesson)
    tell(pad, "rate", rate=rate)
    assert "rate must be a number above 0" in pad.words
    assert pad.clock["rate"] == 1.0


def test_a_step_is_short(lesson: Lesson) -> None:
    pad = shown(lesson)
    tell(pad, "step", seconds=3600)
    assert pad.words == "The step must be a number from 0 to 1, got 3600."
    assert lesson.now == 1.9


def test_the_stopwatch_tells_the_speed_of_the_last_second() -> None:
    watch = Stopwatch(100.0)
    assert watch.seconds == watch.speed == 0.0
    for tick in range(1, 31):
        watch.mark(100 + tick / 10, 1_000_000_000 if tick > 15 else 100_000_000)
    assert watch.seconds == pytest.approx(3.0)
    assert watch.speed == pytest.approx(10.0)


# -- the map ---------------------------------------------------------------------------------------------------------


def test_the_scan_is_drawn_from_where_the_turtle_was_and_vanishes_when_it_is_old(lesson: Lesson) -> None:
    pad = shown(lesson)
    assert numbers(pad.scanned_from) == pytest.approx([MIDDLE, MIDDLE, 0.0], abs=1e-4)
    _, _, reach, *ranges = numbers(pad.scan)
    assert (len(ranges), reach) == (181, 10.0)
    assert ranges[90] == pytest.approx(MIDDLE, abs=1e-3)
    lesson.launch("robot_controller", "start_system.launch.py", source="world").stop()
    lesson.run(2)
    pad.tick()
    assert pad.scanned_from == b""


def test_while_it_turns_the_hits_of_every_scan_lie_on_the_walls(lesson: Lesson) -> None:
    pad = shown(lesson)
    pad.desk.send(2.0, 2.0, 1.5)
    walls = np.array([[0.0], [WORLD]])
    for _ in range(12):
        lesson.run(0.2)
        pad.tick()
        (x, y, theta), (angle, step, reach, *ranges) = numbers(pad.scanned_from), numbers(pad.scan)
        seen = np.array(ranges) < reach - 1e-3
        turns = theta + angle + step * np.arange(len(ranges))
        hits = np.concatenate([x + ranges * np.cos(turns) - walls, y + ranges * np.sin(turns) - walls])
        assert np.abs(hits).min(axis=0)[seen].max() < 0.001


def test_the_trail_grows_in_even_steps_and_sends_little(lesson: Lesson) -> None:
    pad, poses = shown(lesson), lesson._recording.poses
    resent = 0
    for tick in range(1, 4000):
        poses.append(int(2e9) + EPOCH + tick * 16_000_000, 5.5 + 0.02 * tick, 5.5, 0.0, 1.5)
        if tick % 3 == 0:
            before = pad.trail
            pad.tick()
            assert len(pad.tail) <= 8 * (TAIL + 2)
            resent += pad.trail is not before
    points = np.concatenate([numbers(pad.trail), numbers(pad.tail)]).reshape(-1, 2)
    points = points[np.isfinite(points[:, 0])]
    steps = np.hypot(*np.diff(points, axis=0).T)
    steps = steps[steps > 0]
    assert (steps >= SPACING - 1e-4).all() and steps.max() < SPACING + 0.02
    assert KEPT - TAIL <= len(points) <= KEPT + TAIL and resent < 30


def test_the_trail_is_broken_where_the_turtle_was_put_elsewhere(lesson: Lesson) -> None:
    pad, poses = shown(lesson), lesson._recording.poses
    poses.append(int(2e9) + EPOCH, 9.0, 9.0, 0.0, 0.0)
    pad.tick()
    points = np.concatenate([numbers(pad.trail), numbers(pad.tail), numbers(pad.pose)[:2]]).reshape(-1, 2)
    assert points[-1] == pytest.approx([9.0, 9.0])
    gap = np.flatnonzero(np.isnan(points[:, 0]))[-1]
    assert (points[gap + 1 :] == 9.0).all()


# -- the editor ------------------------------------------------------------------------------------------------------


def ahead(lesson: Lesson) -> float:
    """What the beam straight ahead reads in the newest scan, m."""
    return lesson._recording.last_scan.ranges[90]


def test_an_obstacle_put_in_the_way_is_seen_by_the_next_scan(lesson: Lesson) -> None:
    pad = shown(lesson)
    tell(pad, "obstacle_add", shape="circle")
    [circle] = lesson.obstacles
    assert math.dist((circle.x, circle.y), (MIDDLE, MIDDLE)) > 1.3, "it leaves the turtle room"
    tell(pad, "obstacle_change", number=0, x=MIDDLE + 3, y=MIDDLE)
    assert lesson.obstacles == (Circle(MIDDLE + 3, MIDDLE, 0.5),)
    assert ahead(lesson) == pytest.approx(MIDDLE, abs=1e-3)
    lesson.run(0.25)
    assert ahead(lesson) == pytest.approx(2.5, abs=1e-3)
    tell(pad, "obstacle_remove", number=0)
    assert pad.words.startswith("Removed the circle at (8.54, 5.54), radius 0.50 m. No obstacle in the world.")
    lesson.run(0.25)
    assert ahead(lesson) == pytest.approx(MIDDLE, abs=1e-3)


def test_the_editor_and_the_page_change_the_same_obstacles(lesson: Lesson) -> None:
    pad = shown(lesson)
    tell(pad, "world", name="three pillars")
    assert lesson.obstacles == WORLDS["three pillars"]
    lesson.place(Box(2.0, 2.0, 1.0, 2.0, angle=0.5))
    tell(pad, "obstacle_change", number=3, width=3.0)
    assert lesson.obstacles[3] == Box(2.0, 2.0, 3.0, 2.0, 0.5)
    assert [each["shape"] for each in pad.obstacles] == ["circle", "circle", "circle", "box"]
    assert [each.node_name for each in lesson._recording.node.get_publishers_info_by_topic("/world/obstacles")] == [
        "_lab"
    ]
    lesson.run(3)
    assert lesson.obstacles[3] == Box(2.0, 2.0, 3.0, 2.0, 0.5), "also when the topic has brought it back"
    assert [each.width for each in lesson._recording.obstacles.values()][3] == 3.0
    assert "4 obstacles in the world." in repr(pad)


def test_while_time_stands_still_the_map_shows_what_was_put_there(lesson: Lesson) -> None:
    pad = shown(lesson)
    tell(pad, "obstacle_add", shape="box")
    assert len(pad.obstacles) == 1
    assert len(lesson._recording.obstacles) == 0
    assert pad.words.endswith("1 obstacle in the world. The nodes notice it once robot time passes.")


def test_what_another_node_publishes_counts_too(lesson: Lesson) -> None:
    import rclpy
    from rclpy.qos import DurabilityPolicy, QoSProfile
    from visualization_msgs.msg import MarkerArray

    from turtle_lesson.turtlesim.obstacles import to_marker_array

    pad = shown(lesson)
    tell(pad, "world", name="slalom")
    lesson.run(2)
    rclpy.init()
    node = rclpy.create_node("other")
    latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    publisher = node.create_publisher(MarkerArray, "/world/obstacles", latched)
    publisher.publish(to_marker_array([Circle(1.0, 2.0, 0.25)], node.get_clock().now().to_msg()))
    lesson.run(2)
    pad.tick()
    assert lesson.obstacles == (Circle(1.0, 2.0, 0.25),)
    tell(pad, "obstacle_add", shape="box")
    assert [type(each) for each in lesson.obstacles] == [Circle, Box]


@pytest.mark.parametrize(
    ("order", "complaint"),
    [
        ({"do": "obstacle_change", "number": 0, "radius": -1}, "radius must be a number above zero, in metres, not -1"),
        ({"do": "obstacle_change", "number": 0, "radius": None}, "radius must be a number above zero"),
        ({"do": "obstacle_change", "number": 0, "width": 1.0}, "unexpected keyword argument 'width'"),
        ({"do": "obstacle_change", "number": 7, "x": 1.0}, "That obstacle is gone."),
        ({"do": "obstacle_remove", "number": -1}, "That obstacle is gone."),
        ({"do": "world", "name": "moon"}, "there is no world called 'moon'; there are 'empty', 'three pillars'"),
    ],
)
def test_what_cannot_be_is_said_and_changes_nothing(lesson: Lesson, order: dict[str, Any], complaint: str) -> None:
    pad = shown(lesson)
    tell(pad, "world", name="three pillars")
    pad._order(pad, {**order, "view": "v"}, [])
    assert complaint in pad.words
    assert lesson.obstacles == WORLDS["three pillars"]


def test_of_moves_that_come_fast_none_is_lost(lesson: Lesson) -> None:
    pad = shown(lesson)
    tell(pad, "world", name="three pillars")
    for _ in range(10):
        tell(pad, "obstacle_move", number=1, right=0.1, up=-0.5)
    assert lesson.obstacles[1] == Circle(4.5, 3.0, 0.5)


def test_many_obstacles_are_put_beside_each_other(lesson: Lesson) -> None:
    pad = shown(lesson)
    for number in range(12):
        tell(pad, "obstacle_add", shape="circle" if number % 2 else "box")
    places = [(each.x, each.y) for each in lesson.obstacles]
    apart = [math.dist(one, other) for at, one in enumerate(places) for other in places[:at]]
    assert min(apart) > 1.0
