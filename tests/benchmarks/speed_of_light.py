"""The whole system beside its own callbacks, called directly from a loop over a heap: what the ROS in between costs.

The loop has no executors, processes or switches, keeps no trace, and knows neither quality of service nor callback groups.
It calls the same callbacks of the same nodes at the same rates, and each subscription gets a copy of each message.
"""

from __future__ import annotations

import contextlib
import io
import statistics
import time
from collections.abc import Callable, Iterator
from heapq import heappop, heappush
from itertools import count, cycle
from typing import Any

from turtle_lesson import start
from turtle_lesson.ros.stdlib.patches import original
from turtle_lesson.session.lesson import Lesson

cpu_clock = original(time, "process_time")
SECOND = 1_000_000_000
GOALS = ((2.0, 2.0), (9.0, 3.0), (8.5, 9.0), (2.5, 8.0))


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
    for x, y in cycle(GOALS):
        rclpy.spin_until_future_complete(node, client.call_async(NavigateTo.Request(x=x, y=y, theta=0.5)))


def driving_speeds(source: str, seconds: int, rounds: int) -> tuple[float, float]:
    """Virtual seconds for each second of the CPU: the system driving, and its callbacks alone. Medians of some rounds."""
    lesson = driving_system(source)
    with contextlib.redirect_stdout(io.StringIO()):
        system = seconds / median_time(lambda: lesson.run(seconds), rounds, cpu_clock)
        light = SpeedOfLight(lesson)
        return system, seconds / median_time(lambda: light.run(seconds), rounds, cpu_clock)


def median_time(work: Callable[[], object], rounds: int, clock: Callable[[], float]) -> float:
    """The median time in seconds, by a clock, of some calls, after one that does not count."""
    work()
    times = []
    for _ in range(rounds):
        began = clock()
        work()
        times.append(clock() - began)
    return statistics.median(times)


class SpeedOfLight:
    """The callbacks of a system, which is of no use for anything else afterwards."""

    def __init__(self, lesson: Lesson) -> None:
        self._simulation = lesson._world.sim
        self._simulation.running = True  # or a callback that looks at the clock would run it
        self._heap: list[tuple[int, int, Callable[[Any], object], Any]] = []
        self._numbers = count()
        self.calls = 0
        nodes = list(nodes_of(lesson))
        listeners = {each._reader: each for node in nodes for each in node.subscriptions}
        for node in nodes:
            for publisher in node.publishers:
                publisher._write = self._sender(publisher._writer, listeners)
            for timer in node.timers:
                self._at(timer._next, self._tick, timer)
        self._navigator = next(node for node in nodes if node.get_name() == "navigator")
        self._goals = cycle(GOALS)
        self._drive: Any = None
        self._at(self._simulation.now, self._send_goal, None)

    def run(self, seconds: float) -> None:
        """Call all that is due in the next seconds of robot time."""
        heap, simulation = self._heap, self._simulation
        end = simulation.now + int(seconds * SECOND)
        while heap[0][0] < end:
            simulation.now, _, action, argument = heappop(heap)
            action(argument)
        simulation.now = end

    def _at(self, time: int, action: Callable[[Any], object], argument: Any) -> None:
        heappush(self._heap, (time, next(self._numbers), action, argument))

    def _tick(self, timer: Any) -> None:
        if not timer._canceled:
            self.calls += 1
            timer.callback()
        self._at(self._simulation.now + timer._period, self._tick, timer)

    def _sender(self, writer: Any, listeners: dict[Any, Any]) -> Callable[[Any], None]:
        simulation, latency = self._simulation, writer.topic.latency
        found = [listeners[reader] for reader in writer.readers if reader in listeners]
        plain = [each.callback for each in found if each._reader.times is None]
        with_times = [each.callback for each in found if each._reader.times is not None]

        def deliver(message: Any) -> None:
            now = simulation.now
            for callback in plain:
                callback(message._wire_copy())
            for callback in with_times:
                callback(message._wire_copy(), {"source_timestamp": now - latency, "received_timestamp": now})
            self.calls += len(found)

        def send(message: Any) -> None:
            if found:
                self._at(simulation.now + latency, deliver, message._wire_copy())

        return send

    def _send_goal(self, _: None) -> None:
        """Look ten times a second whether the goal is reached, and send the next one."""
        from robot_controller.srv import NavigateTo

        if self._drive is None:
            x, y = next(self._goals)
            request = NavigateTo.Request(x=x, y=y, theta=0.5)
            self._drive = self._navigator.on_navigate_to(request, NavigateTo.Response())
        try:
            self._drive.send(None)
        except StopIteration:
            self._drive = None
        self._at(self._simulation.now + SECOND // 10, self._send_goal, None)


def nodes_of(lesson: Lesson) -> Iterator[Any]:
    """All nodes that are spun."""
    from rclpy._state import RclpyState

    for process in lesson._world.processes:
        executor = process.state(RclpyState).executor
        if executor is not None:
            yield from executor.get_nodes()
