"""What a notebook does with a robot, on the stand-in for a real ROS 2; `test_robot.py` runs this as a program of its own.

Each scene is a coroutine that returns facts. They are printed as JSON, with the traceback of a scene that failed.
"""

from __future__ import annotations

import asyncio
import atexit
import json
import math
import sys
import threading
import time
import traceback
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import rclpy
from geometry_msgs.msg import Twist
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.subscription import Subscription
from robot_controller.msg import TurtleStatus
from robot_controller.srv import NavigateTo
from sensor_msgs.msg import LaserScan
from std_msgs.msg import String
from turtlesim.msg import Pose

LOOP = threading.get_ident()
FACTS: dict[str, Any] = {}
SCENES: list[Callable[[Any], Any]] = []
ELSEWHERE: set[str] = set()
"""Functions of ours that were called in another thread than the loop's."""


def scene(function: Any) -> Any:
    SCENES.append(function)
    return function


async def until(true: Callable[[], Any], seconds: float = 300.0) -> Any:
    deadline = time.monotonic() + seconds
    while not (found := true()):
        if time.monotonic() > deadline:
            raise TimeoutError(f"{seconds} s were not enough")
        await asyncio.sleep(0.01)
    return found


def order(widget: Any, do: str, **arguments: Any) -> None:
    """What a browser's view sends."""
    widget._order(widget, {"do": do, "view": "v", **arguments}, [])


@contextmanager
def not_waited_for(thread: threading.Thread) -> Iterator[None]:
    """Raise an error in what waits for the end of the thread meanwhile."""

    def refuse(timeout: float | None = None) -> None:
        raise AssertionError("the notebook waits for the thread")

    thread.join = refuse  # type: ignore[method-assign]
    try:
        yield
    finally:
        del thread.join


def watch_threads() -> None:
    """Note what code of the lab a new thread runs."""

    def note(frame: Any, event: str, argument: Any) -> None:
        name = frame.f_code.co_filename.replace("\\", "/")
        if event == "call" and "turtle_lesson/lab/" in name and not frame.f_code.co_qualname.startswith("Loop."):
            ELSEWHERE.add(f"{name.rpartition('/')[2]}: {frame.f_code.co_name}")

    threading.setprofile(note)


# -- the robot -----------------------------------------------------------------------------------------------------


class Turtle:
    """A turtle, a navigator that jumps to its goal after a while, a monitor and a detector: two threads."""

    def __init__(self) -> None:
        self.x = self.y = 5.5
        self.speed = self.turn = 0.0
        self.heard: list[tuple[float, float]] = []
        self.requests: list[int] = []
        context = Context()
        context.init([])
        body, self.navigator = Node("turtlesim", context=context), Node("navigator", context=context)
        self.pose = body.create_publisher(Pose, "/turtle1/pose", 10)
        body.create_subscription(Twist, "/turtle1/cmd_vel", self._obey, 10)
        body.create_timer(0.016, self._move)
        self.navigator._parameters = {"max_speed": 2.0}
        self.navigator.create_service(NavigateTo, "/navigate_to", self._navigate)
        monitor, detector = Node("status_monitor", context=context), Node("obstacle_detector", context=context)
        self.status = monitor.create_publisher(TurtleStatus, "/robot/status", 10)
        monitor.create_timer(0.1, lambda: self.status.publish(TurtleStatus(x=self.x, y=self.y, battery=80.0)))
        self.picture = monitor.create_publisher(String, "/camera", 10)
        monitor.create_timer(0.1, lambda: self.picture.publish(String(data="many bytes")))
        self.scan = detector.create_publisher(LaserScan, "/obstacles", 10)
        detector.create_timer(0.2, self._scan)
        for nodes in ([body, monitor, detector], [self.navigator]):
            executor = SingleThreadedExecutor(context=context)
            for node in nodes:
                executor.add_node(node)
            threading.Thread(target=executor.spin, daemon=True).start()

    def _obey(self, message: Any) -> None:
        self.speed, self.turn = message.linear.x, message.angular.z
        self.heard.append((self.speed, self.turn))

    def _move(self) -> None:
        self.x += 0.016 * self.speed
        self.pose.publish(Pose(x=self.x, y=self.y, linear_velocity=self.speed))

    def _scan(self) -> None:
        step = math.radians(30)
        ends = {"angle_min": -3 * step, "angle_max": 3 * step, "angle_increment": step}
        self.scan.publish(LaserScan(**ends, range_max=10.0, ranges=[10.0, 10.0, 3.0, 2.0, 3.0, 10.0, 10.0]))

    def _navigate(self, request: Any, response: Any) -> Any:
        self.requests.append(threading.get_ident())
        if not 0 <= request.x <= 11.09:
            self.navigator.warn(f"Goal refused: x = {request.x} is outside of the world")
            return response
        time.sleep(0.3)
        self.x, self.y = request.x, request.y
        response.success, response.time_taken = True, 0.3
        return response


# -- the scenes ----------------------------------------------------------------------------------------------------


@scene
async def hears_poses(stage: Any) -> Any:
    recorder = stage.robot._recording
    await until(lambda: len(recorder.poses) > 30 and len(recorder.statuses) > 3 and recorder.last_scan)
    before, began = len(recorder.poses), stage.robot.now
    time.sleep(0.5)  # a cell that computes
    during, ended = len(recorder.poses), stage.robot.now
    await until(lambda: len(recorder.poses) > before + 25)
    stamps = recorder.poses.array()["stamp"]
    heard = [each for each in recorder.node._entities if isinstance(each, Subscription)]
    times = recorder.seconds(stamps)
    return {
        "during": during - before,
        "stamped_meanwhile": int(((times > began) & (times < ended)).sum()),
        "least": float((stamps[1:] - stamps[:-1]).min()),
        "age": stage.robot.now - float(times[-1]),
        "awaited": [each._full_name for each in heard if each._is_awaited()],
        "taken": [each._full_name for each in heard if not each._is_awaited()],
    }


@scene
async def goal_reaches_the_service(stage: Any) -> Any:
    pad = stage.robot.goal_pad()
    threads: set[int] = set()
    pad.observe(lambda change: threads.add(threading.get_ident()))
    order(pad, "open")
    order(pad, "goal", x=2.0, y=3.0, theta=0.0)
    await until(lambda: not pad.desk.goals[0].waits)
    order(pad, "goal", x=20.0, y=3.0, theta=0.0)
    await until(lambda: "outside" in pad.desk.goals[1].answer)
    await until(lambda: "(2.00, 3.00) m facing" in pad.text())
    goals = [{"state": goal.state, "answer": goal.answer} for goal in pad.desk.goals]
    order(pad, "close")
    return {
        "goals": goals,
        "server_threads": len({LOOP, *stage.turtle.requests}) - 1,
        "only_loop": threads == {LOOP},
        "text": pad.text(),
    }


@scene
async def dashboard_ticks(stage: Any) -> Any:
    board = stage.robot.dashboard()
    order(board, "open")
    began = board.now
    await until(lambda: [row["state"] for row in board.rates[:3]] == ["as expected"] * 3, 12)
    await until(lambda: [*board.log_old, *board.log_new])
    await until(lambda: any(row["topic"] == "/camera" and (row["hertz"] or 0) > 8 for row in board.rates))
    order(board, "play")
    order(board, "obstacle_add", shape="circle")
    await until(lambda: len(board.obstacles) == 1)
    facts = {
        "clock": board.clock,
        "went_on": board.now - began,
        "lights": {light["name"]: light["state"] for light in board.lights},
        "log": [line[2:] for line in [*board.log_old, *board.log_new]],
        "scan": board.scan_words["nearest"],
        "text": board.text(),
    }
    order(board, "close")
    return facts


@scene
async def teleop_publishes(stage: Any) -> Any:
    teleop, turtle = stage.robot.teleop(), stage.turtle
    order(teleop, "open")
    begin = turtle.x
    for _ in range(10):
        order(teleop, "drive", forward=1.0, turn=0.0)
        await asyncio.sleep(0.1)
    order(teleop, "release")
    await until(lambda: turtle.heard and turtle.heard[-1] == (0.0, 0.0))
    order(teleop, "drive", forward=0.5, turn=0.0)
    await until(lambda: turtle.heard[-1] == (1.0, 0.0))
    await until(lambda: turtle.heard[-1] == (0.0, 0.0))  # nobody holds the stick any more
    sent, words = len(turtle.heard), teleop.words
    order(teleop, "close")
    return {"way": turtle.x - begin, "sent": sent, "words": words}


@scene
async def form_publishes_and_calls(stage: Any) -> Any:
    topic, service = stage.robot.form("/turtle1/cmd_vel"), stage.robot.form("/navigate_to")
    order(topic, "open")
    order(topic, "edit", path="linear/x", text="0.25")
    order(topic, "publish")
    await until(lambda: (0.25, 0.0) in stage.turtle.heard)
    order(topic, "edit", path="linear/x", text="0.0")
    order(topic, "rate", rate=20.0)
    order(topic, "repeat")
    await until(lambda: topic.published > 5)
    order(topic, "stop")
    order(service, "open")
    order(service, "edit", path="x", text="4.0")
    order(service, "call")
    await until(lambda: service.answer)
    facts = {"answer": service.answer, "words": service.words}
    order(topic, "close")
    order(service, "close")
    return facts


@scene
async def live_plot_draws(stage: Any) -> Any:
    plot = stage.robot.live_plot("/robot/status/battery", "/turtle1/pose/x")
    order(plot, "open")
    await until(lambda: all(len(curve.table) > 5 for curve in plot._curves))
    text = plot.text()
    order(plot, "close")
    return {"text": text}


@scene
async def parameters_are_set(stage: Any) -> Any:
    panel = stage.robot.parameters("/navigator")
    order(panel, "open")
    await until(lambda: panel.items)
    order(panel, "set", name="max_speed", value="3.5")
    await until(lambda: stage.turtle.navigator._parameters["max_speed"] == 3.5)
    await until(lambda: "3.5" in panel.words)
    order(panel, "set", name="max_speed", value="11")
    await until(lambda: panel.items[0]["error"])
    facts = {"item": panel.items[0], "text": panel.text()}
    order(panel, "close")
    return facts


@scene
async def scene_follows(stage: Any) -> Any:
    world = stage.robot.scene()
    order(world, "open")
    before = world.turtle
    stage.turtle.speed = 1.0
    await until(lambda: world.turtle != before and world.scan and world.obstacles)
    stage.turtle.speed = 0.0
    text = world.text()
    order(world, "close")
    return {"text": text}


@scene
async def pictures(stage: Any) -> Any:
    robot = stage.robot
    return {
        "path": robot.plot_path().text,
        "status": robot.plot_status().text,
        "scan": robot.plot_scan().text,
        "graph": robot.plot_graph().text,
    }


@scene
async def the_notebooks_own_nodes(stage: Any) -> Any:
    """Its own rclpy.init and shutdown are no business of the lab's, nor the other way round."""
    before = rclpy.ok()
    rclpy.init()
    own = rclpy.create_node("own")
    own.destroy_node()
    rclpy.shutdown()
    heard = len(stage.robot._recording.poses)
    await until(lambda: len(stage.robot._recording.poses) > heard + 10)
    return {"before": before, "after": rclpy.ok(), "robot": repr(stage.robot)}


@scene
async def connecting_again(stage: Any) -> Any:
    """The cell with `connect()` is run a second time: the first robot ends, widgets and all."""
    from turtle_lesson import connect

    first, thread = stage.robot, stage.robot._backend._thread
    stage.shown = [first.goal_pad(), first.dashboard(), first.teleop(), first.form("/navigate_to"), first.scene()]
    stage.shown += [first.parameters("/navigator"), first.live_plot("/robot/status/battery", "/turtle1/pose/x")]
    pad = stage.shown[0]
    order(pad, "open")
    with not_waited_for(thread):
        stage.robot = connect()
    await until(lambda: not thread.is_alive() and first._backend._left and pad.ended)
    names = [name for name, _ in stage.turtle.navigator.get_node_names_and_namespaces()]
    facts = {"first": repr(first), "labs": names.count("_lab"), "path": first.plot_path().text[:14]}
    facts["old"] = [repr(widget)[:40] for widget in stage.shown]
    try:
        first.goal_pad()
    except RuntimeError as error:
        facts["error"] = str(error)
    await until(lambda: len(stage.robot._recording.poses) > 10)
    return facts


@scene
async def nobody_is_there(stage: Any) -> Any:
    silent = stage.robot._recording.why_silent("/world/obstacles")
    return {"silent": silent}


@scene
async def closing(stage: Any) -> Any:
    thread, pad = stage.robot._backend._thread, stage.robot.goal_pad()
    order(pad, "open")
    with not_waited_for(thread):
        stage.robot.close()
    await until(lambda: not thread.is_alive() and pad.ended)
    await until(lambda: "_lab" not in [name for name, _ in stage.turtle.navigator.get_node_names_and_namespaces()])
    stage.robot.close()
    return {"robot": repr(stage.robot)}


@scene
async def a_signal_ends_all_contexts(stage: Any) -> Any:
    from turtle_lesson import connect

    robot = connect()
    turtle_context = stage.turtle.navigator.context
    from rclpy import _network

    _network.contexts.remove(turtle_context)  # the turtle is another program
    rclpy.shutdown_by_signal()
    await until(lambda: not robot._backend._thread.is_alive() and robot._backend._left)
    stage.robot = connect()
    await until(lambda: len(stage.robot._recording.poses) > 10)
    return {"first": repr(robot), "then": repr(stage.robot)}


class Stage:
    def __init__(self) -> None:
        from turtle_lesson import connect

        self.turtle = Turtle()
        watch_threads()
        self.robot = connect()


async def main() -> None:
    asyncio.get_running_loop().set_exception_handler(
        lambda loop, context: FACTS.setdefault("loop_errors", []).append(
            "".join(traceback.format_exception(context["exception"])) if "exception" in context else str(context)
        )
    )
    stage = Stage()
    for each in SCENES:
        try:
            FACTS[each.__name__] = await each(stage)
        except Exception:
            FACTS[each.__name__] = {"failed": traceback.format_exc()}
    FACTS["elsewhere"] = sorted(ELSEWHERE)
    FACTS["rclpy"] = rclpy.__file__
    FACTS["ours"] = [
        name for name, module in sys.modules.items() if "ros/site" in (getattr(module, "__file__", "") or "")
    ]


def last_word() -> None:
    from rclpy import _network

    FACTS["left_over"] = [node.get_name() for node in _network.nodes if node.get_name() == "_lab"]
    print(json.dumps(FACTS))


if __name__ == "__main__":
    atexit.register(last_word)
    asyncio.run(main())
