"""The whole system beside its own callbacks, called directly from a loop over a heap: what the ROS in between costs.

The callbacks, the message copies and the turtle of the loop are frozen (folder `frozen`), so that the measure stays the
same when the package changes. The loop has no executors, processes or switches, keeps no trace, and knows neither quality
of service nor callback groups. It calls the same callbacks at the same rates, and each subscription gets a copy of each
message. Before anything is measured, what its recorder has heard is compared with what the system's has.
"""

from __future__ import annotations

import contextlib
import io
from collections.abc import Callable, Iterator
from heapq import heappop, heappush
from itertools import count, cycle
from typing import Any

import numpy as np
from frozen.nodes import SECOND, Goal, Navigator, ObstacleDetector, Recorder, StatusMonitor
from frozen.turtle import Turtlesim
from measure import cpu_clock, interleaved

from turtle_lesson import start
from turtle_lesson.ros.rmw.transport import latency_of
from turtle_lesson.session.lesson import Lesson

GOALS = (Goal(2.0, 2.0, 0.5), Goal(9.0, 3.0, 0.5), Goal(8.5, 9.0, 0.5), Goal(2.5, 8.0, 0.5))
PILLARS = np.array([(8.5, 5.5, 0.4), (3.5, 8.0, 0.5), (4.0, 2.5, 0.6)])
CLOCK_READ = 1_000
"""Reading the clock takes 1 µs of robot time, as in the system."""


class SpeedOfLight:
    """The same robot without ROS: it drives to one goal after the other.

    `first` says when (ns) each timer's callback ran first, and `on_navigate_to`.
    """

    def __init__(self, source: str, first: dict[str, int]) -> None:
        self.now = 0
        self._heap: list[tuple[int, int, Callable[[Any], object], Any]] = []
        self._number = count().__next__
        self._goals = cycle(GOALS)
        turtlesim, self.recorder = Turtlesim(), Recorder()
        shown, heard = turtlesim.shown, self.recorder
        status, navigator = StatusMonitor(self._read_clock), Navigator(self._read_clock)
        self.detector = detector = ObstacleDetector(self._read_clock, source, PILLARS)
        poses = [navigator.on_pose, status.on_pose] + [detector.on_pose] * (source == "world")
        shown.publish_pose = self._topic("/turtle1/pose", poses, heard.poses.hear)
        shown.publish_colour = self._topic("/turtle1/color_sensor", [], None)
        navigator.publish = self._topic("/turtle1/cmd_vel", [shown.on_command], heard.commands.hear)
        navigator.answer = self._next_goal
        status.publish = self._topic("/robot/status", [], heard.statuses.hear)
        detector.publish = self._topic("/obstacles", [navigator.on_scan], heard.on_scan)
        self._navigate, self._service = navigator.on_navigate_to, latency_of("/navigate_to")
        self._at(first["_on_tick"], self._repeat, (turtlesim.on_tick, SECOND * 16 // 1000))
        self._at(first["on_publish_timer"], self._repeat, (status.on_publish_timer, SECOND // 10))
        self._at(first["on_scan_timer"], self._repeat, (detector.on_scan_timer, SECOND // 5))
        self._steering = [navigator.on_steering_timer, SECOND // 10]
        self._at(first["on_steering_timer"], self._steer, self._steering)
        self._at(first["on_navigate_to"], self._begin_drive, next(self._goals))

    def run(self, seconds: float) -> None:
        """Call all that is due in the next seconds of robot time."""
        heap, end = self._heap, self.now + round(seconds * SECOND)
        while heap[0][0] < end:
            self.now, _, action, argument = heappop(heap)
            action(argument)
        self.now = end

    def _at(self, time: int, action: Callable[[Any], object], argument: Any) -> None:
        heappush(self._heap, (time, self._number(), action, argument))

    def _read_clock(self) -> int:
        self.now += CLOCK_READ
        return self.now

    def _repeat(self, timer: tuple[Callable[[], object], int]) -> None:
        callback, period = timer
        due = self.now
        callback()
        self._at(due + period, self._repeat, timer)

    def _steer(self, timer: list[Any]) -> None:
        """The steering timer begins anew with each goal: ticks of before are no longer its own."""
        if timer is self._steering:
            callback, period = timer
            self._at(self.now + period, self._steer, timer)
            callback()

    def _begin_drive(self, goal: Goal) -> None:
        self._steering = list(self._steering)
        self._at(self.now + SECOND // 10, self._steer, self._steering)
        self._navigate(goal)

    def _next_goal(self, _: bool) -> None:
        """The answer travels to the client, and its next request to the navigator."""
        self._at(self.now + 2 * self._service, self._begin_drive, next(self._goals))

    def _topic(
        self, name: str, plain: list[Callable[[Any], object]], recorded: Callable[[Any, dict[str, int]], object] | None
    ) -> Callable[[Any], None]:
        latency = latency_of(name)

        def deliver(message: Any) -> None:
            for callback in plain:
                callback(message.copy())
            if recorded is not None:
                recorded(message.copy(), {"source_timestamp": self.now - latency, "received_timestamp": self.now})

        def publish(message: Any) -> None:
            if plain or recorded is not None:
                self._at(self.now + latency, deliver, message.copy())

        return publish


# -- the whole system ---------------------------------------------------------------------------------------------


def driving_system(source: str) -> Lesson:
    """The finished nodes, driving to one goal after the other."""
    with contextlib.redirect_stdout(io.StringIO()):
        lesson = start(package="finished")
        if source == "world":
            lesson.set_obstacles("three pillars")
        lesson.launch("robot_controller", "start_system.launch.py", source=source)
        lesson.run(2)
        lesson._world.spawn(send_goals, name="goals")
        lesson.run(3)
    return lesson


def send_goals() -> None:
    """A program that sends the next goal when one is reached."""
    import rclpy
    from robot_controller.srv import NavigateTo

    rclpy.init()
    node = rclpy.create_node("goals")
    client = node.create_client(NavigateTo, "/navigate_to")
    for x, y, theta in cycle(GOALS):
        rclpy.spin_until_future_complete(node, client.call_async(NavigateTo.Request(x=x, y=y, theta=theta)))


def frozen_twin(lesson: Lesson, source: str) -> SpeedOfLight:
    """The same robot without ROS, at the same time. RuntimeError if for 10 s it does not hear what the system hears."""
    trace = lesson._world.trace
    assert trace is not None
    runs = {each.name: each.runs(trace.now)["ready"] for each in trace.callbacks}
    light = SpeedOfLight(source, {name: int(times[0]) for name, times in runs.items() if len(times)})
    light.run(lesson.now)
    detector = next(node for node in nodes_of(lesson) if node.get_name() == "obstacle_detector")
    light.detector.random.set_state(detector._random.get_state())
    with contextlib.redirect_stdout(io.StringIO()):
        lesson.run(10)
    light.run(10)
    heard, recorder = lesson._recording, light.recorder
    for name, frozen in (("poses", recorder.poses), ("statuses", recorder.statuses)):
        rows = getattr(heard, name).array()
        twin = np.frombuffer(bytes(frozen.rows), rows.dtype)[-len(rows) :].copy()
        twin["stamp"] += heard.origin
        if not np.array_equal(twin[-600:], rows[-600:]):
            raise RuntimeError(f"the frozen robot's {name} are not those of the system")
    if list(recorder.last_scan.ranges) != list(heard.last_scan.ranges):
        raise RuntimeError("the frozen robot's scan is not that of the system")
    return light


def nodes_of(lesson: Lesson) -> Iterator[Any]:
    """All nodes that are spun."""
    from rclpy._state import RclpyState

    for process in lesson._world.processes:
        executor = process.state(RclpyState).executor
        if executor is not None:
            yield from executor.get_nodes()


def driving_times(source: str, seconds: int, rounds: int, *peers: Callable[[], object]) -> list[list[float]]:
    """CPU seconds that some robot time takes in each round: of the system driving, of its callbacks alone, and of peers."""
    lesson = driving_system(source)
    light = frozen_twin(lesson, source)
    with contextlib.redirect_stdout(io.StringIO()):
        return interleaved([lambda: lesson.run(seconds), lambda: light.run(seconds), *peers], rounds, cpu_clock)
