"""How fast the simulation is, beside SimPy and asyncio doing the same number of events, and beside a real rclpy.

The real rclpy's figures were recorded on another machine (2 cores, ROS 2 Humble, one process): they are there for scale.
"""

from __future__ import annotations

import asyncio
import contextlib
import io
import os
import statistics
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import simpy
from speed_of_light import driving_speeds, median_time

from turtle_lesson import start
from turtle_lesson.ros.runtime.world import World, open_world
from turtle_lesson.ros.stdlib.patches import original

clock = original(time, "perf_counter")
ROUNDS = 5
SIMPLE_STAGE = Path(__file__).resolve().parents[1] / "data" / "simple_stage"


# -- a timer that ticks ------------------------------------------------------------------------------------------


def rclpy_timer(count: int) -> Callable[[], None]:
    import rclpy

    world = open_world()

    def main() -> None:
        rclpy.init()
        node = rclpy.create_node("ticker")
        node.create_timer(0.001, lambda: None)
        rclpy.spin(node)

    world.spawn(main, name="ticker")
    return advance(world, count)


def advance(world: World, milliseconds: int) -> Callable[[], None]:
    return lambda: world.sim.run_until(world.now + milliseconds * 1_000_000)


def simpy_timer(count: int) -> Callable[[], None]:
    def work() -> None:
        environment = simpy.Environment()

        def tick() -> Any:
            while True:
                yield environment.timeout(1)

        environment.process(tick())
        environment.run(until=count)

    return work


def asyncio_timer(count: int) -> Callable[[], None]:
    async def tick() -> None:
        for _ in range(count):
            await asyncio.sleep(0)

    return lambda: asyncio.run(tick())


# -- a message from one program to another --------------------------------------------------------------------------


def rclpy_message(count: int) -> Callable[[], None]:
    import rclpy
    from geometry_msgs.msg import Twist

    world = open_world()

    def talker() -> None:
        rclpy.init()
        node = rclpy.create_node("talker")
        publisher, message = node.create_publisher(Twist, "chatter", 10), Twist()
        node.create_timer(0.001, lambda: publisher.publish(message))
        rclpy.spin(node)

    def listener() -> None:
        rclpy.init()
        node = rclpy.create_node("listener")
        node.create_subscription(Twist, "chatter", lambda message: None, 10)
        rclpy.spin(node)

    world.spawn(talker, name="talker")
    world.spawn(listener, name="listener")
    return advance(world, count)


def simpy_message(count: int) -> Callable[[], None]:
    def work() -> None:
        environment = simpy.Environment()
        store = simpy.Store(environment)

        def talker() -> Any:
            while True:
                yield environment.timeout(1)
                yield store.put({"linear": (0.0, 0.0, 0.0), "angular": (0.0, 0.0, 0.0)})

        def listener() -> Any:
            while True:
                yield store.get()

        environment.process(talker())
        environment.process(listener())
        environment.run(until=count)

    return work


def asyncio_message(count: int) -> Callable[[], None]:
    async def run() -> None:
        queue: asyncio.Queue[Any] = asyncio.Queue(1)

        async def listener() -> None:
            for _ in range(count):
                await queue.get()

        task = asyncio.create_task(listener())
        for _ in range(count):
            await asyncio.sleep(0)
            await queue.put({"linear": (0.0, 0.0, 0.0), "angular": (0.0, 0.0, 0.0)})
        await task

    return lambda: asyncio.run(run())


# -- a question and its answer ------------------------------------------------------------------------------------


def rclpy_service(count: int) -> Callable[[], None]:
    import rclpy
    from example_interfaces.srv import AddTwoInts

    def work() -> None:
        world = open_world()

        def server() -> None:
            rclpy.init()
            node = rclpy.create_node("server")
            node.create_service(AddTwoInts, "add", lambda request, response: response)
            rclpy.spin(node)

        def asker() -> None:
            rclpy.init()
            node = rclpy.create_node("asker")
            client, request = node.create_client(AddTwoInts, "add"), AddTwoInts.Request()
            for _ in range(count):
                rclpy.spin_until_future_complete(node, client.call_async(request))

        world.spawn(server, name="server")
        world.spawn(asker, name="asker")
        world.sim.run_until(count * 1_000_000)

    return work


def simpy_service(count: int) -> Callable[[], None]:
    def work() -> None:
        environment = simpy.Environment()
        requests, answers = simpy.Store(environment), simpy.Store(environment)

        def server() -> Any:
            while True:
                yield answers.put((yield requests.get()))

        def asker() -> Any:
            for number in range(count):
                yield requests.put(number)
                yield answers.get()

        environment.process(server())
        environment.run(until=environment.process(asker()))

    return work


def asyncio_service(count: int) -> Callable[[], None]:
    async def run() -> None:
        requests: asyncio.Queue[asyncio.Future[int]] = asyncio.Queue()

        async def server() -> None:
            while True:
                (await requests.get()).set_result(0)

        task = asyncio.create_task(server())
        for _ in range(count):
            future: asyncio.Future[int] = asyncio.get_running_loop().create_future()
            await requests.put(future)
            await future
        task.cancel()

    return lambda: asyncio.run(run())


# -- the whole system ---------------------------------------------------------------------------------------------


def system_speed(seconds: int, package: str | Path, **arguments: str) -> float:
    """Virtual seconds for each second of real time: turtlesim, the three nodes and the lab's recorder."""
    with contextlib.redirect_stdout(io.StringIO()):
        lesson = start(package=package)
        if arguments.get("source") == "world":
            lesson.set_obstacles("three pillars")
        lesson.launch("robot_controller", "start_system.launch.py", **arguments)
        lesson.run(1)
        return seconds / median_time(lambda: lesson.run(seconds), ROUNDS, clock)


def many_turtles(count: int) -> float:
    """Real µs for each virtual second and turtle, of one simulator with `count` turtles."""
    import rclpy
    from turtlesim.srv import Spawn

    with contextlib.redirect_stdout(io.StringIO()):
        lesson = start(package=None)
        rclpy.init()
        client = rclpy.create_node("spawner").create_client(Spawn, "/spawn")
        for number in range(count - 1):
            client.call(Spawn.Request(x=1.0 + number % 9, y=1.0 + number // 9 % 9))
        rclpy.shutdown()
        lesson.run(1)
        seconds = max(1, 200 // count)
        return median_time(lambda: lesson.run(seconds), ROUNDS, clock) / seconds / count * 1e6


def own_package(folder: Path) -> Path:
    """The simple stage of the nodes, with what makes it a package."""
    import shutil

    from turtle_lesson.learner.story import FINISHED

    shutil.copytree(FINISHED, folder, dirs_exist_ok=True)
    shutil.copytree(SIMPLE_STAGE, folder, dirs_exist_ok=True)
    return folder


# -- starting up --------------------------------------------------------------------------------------------------

KERNEL = """
import psutil, os
def rss():
    return psutil.Process(os.getpid()).memory_info().rss / 2**20
before = rss()
from turtle_lesson import start
lesson = start()
controller = lesson.launch("robot_controller", "start_system.launch.py")
lesson.run(1)
print("MB", before, rss())
"""


def kernel_memory() -> tuple[float, float]:
    """MB of a Jupyter kernel: bare, and after start() and a launch."""
    from jupyter_client.manager import start_new_kernel

    manager, client = start_new_kernel()
    said: list[str] = []
    try:
        client.execute_interactive(KERNEL, timeout=60, output_hook=lambda m: said.append(m["content"].get("text", "")))
    finally:
        client.stop_channels()
        manager.shutdown_kernel(now=True)
    line = next(line for text in said for line in text.splitlines() if line.startswith("MB"))
    before, after = (float(word) for word in line.split()[1:])
    return before, after


STEPS = {
    "import turtle_lesson": "import turtle_lesson",
    "start()": "lesson = turtle_lesson.start()",
    "the first launch": "lesson.launch('robot_controller', 'start_system.launch.py'); lesson.run(1)",
    "the first picture": "lesson.plot_path().png()",
    "a second start()": "turtle_lesson.start()",
}


def first_steps() -> list[float]:
    """Seconds of computing that a fresh Python spends on each of the steps, the medians of seven."""
    note = "times.append(time.process_time())"
    program = "\n".join(["import time", f"times = []; {note}", *(f"{step}; {note}" for step in STEPS.values())])
    program += "\nprint(*(end - begin for begin, end in zip(times, times[1:])))"
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
    command = [sys.executable, "-c", program]
    runs = [subprocess.run(command, capture_output=True, text=True, check=True, env=environment) for _ in range(8)]
    columns = zip(*(map(float, run.stdout.splitlines()[-1].split()) for run in runs[1:]), strict=True)
    return [statistics.median(column) for column in columns]


def row(what: str, *figures: str) -> None:
    print(f"{what:38}" + "".join(f"{figure:>15}" for figure in figures))


def compare(what: str, count: int, works: list[Callable[[int], Callable[[], None]]], real: float) -> None:
    """One row: µs for each event, here, in SimPy, in asyncio, and recorded."""
    times = [median_time(work(count), ROUNDS, clock) / count * 1e6 for work in works]
    row(what, *(f"{each:.2f} µs" for each in times), f"{real:.0f} µs", f"×{real / times[0]:.0f}")


def main() -> None:
    import tempfile

    print(f"Python {sys.version.split()[0]}, medians of {ROUNDS}\n")
    row("µs an event", "turtle_lesson", "SimPy", "asyncio", "real rclpy *", "real / ours")
    compare("timer callback", 50_000, [rclpy_timer, simpy_timer, asyncio_timer], 47)
    compare("timer, publish and callback", 50_000, [rclpy_message, simpy_message, asyncio_message], 81)
    compare("service there and back", 20_000, [rclpy_service, simpy_service, asyncio_service], 256)
    print("* recorded on another machine\n")

    row("virtual s in a real second", "turtle_lesson", "aim")
    row("whole system, mock scans", f"{system_speed(100, 'finished'):.0f}", "2000")
    row("whole system, ray casts", f"{system_speed(100, 'finished', source='world'):.0f}", "1000")
    with tempfile.TemporaryDirectory() as folder:
        row(
            "whole system, the lesson's simple nodes",
            f"{system_speed(100, own_package(Path(folder))):.0f}",
            "2000",
        )
    print()
    row("virtual s in a CPU second, driving", "turtle_lesson", "callbacks only", "ratio", "aim")
    for source, what in (("mock", "mock scans"), ("world", "ray casts")):
        system, light = driving_speeds(source, 100, ROUNDS)
        row(what, f"{system:.0f}", f"{light:.0f}", f"×{light / system:.2f}", "×1.60")
    print()
    row("turtles in one simulator", "1", "10", "100", "1000")
    row("µs a virtual second and turtle", *(f"{many_turtles(count):.0f}" for count in (1, 10, 100, 1000)))
    print()
    before, after = kernel_memory()
    row("kernel, bare / with the whole system", f"{before:.0f} MB", f"{after:.0f} MB")
    print()
    steps = first_steps()
    row("s of computing, in a fresh Python", "turtle_lesson", "aim")
    for step, seconds in zip(STEPS, steps, strict=True):
        row(step, f"{seconds:.3f} s", "0.50 s" if step == "the first picture" else "")
    row("import and start() together", f"{steps[0] + steps[1]:.3f} s", "0.25 s")


if __name__ == "__main__":
    main()
