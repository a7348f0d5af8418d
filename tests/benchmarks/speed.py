"""How fast the simulation is, beside its own callbacks alone, SimPy, asyncio, ir-sim (where it is installed) and a real rclpy.

All rows of a table are measured in rounds in which each work has its turn. The real rclpy's figures were recorded on another
machine (2 cores, ROS 2 Humble, one process): they are there for scale. With `--instructions`, instructions are counted instead
of time, by perf or else by valgrind (a quarter of an hour).
"""

from __future__ import annotations

import argparse
import contextlib
import gc
import importlib.util
import io
import os
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

from events import EVENTS, Work
from measure import cpu_clock, find_counter, instructions, interleaved, ratio
from speed_of_light import driving_system, driving_times, frozen_twin

from turtle_lesson import start

ROUNDS = 5
COUNTS = {"timer callback": 50_000, "timer, publish and callback": 50_000, "service there and back": 20_000}
REAL = {"timer callback": 47, "timer, publish and callback": 81, "service there and back": 256}
"""µs for each event with a real rclpy."""

SIMPLE_STAGE = Path(__file__).resolve().parents[1] / "data" / "simple_stage"

# -- events and the whole system ----------------------------------------------------------------------------------


def row(what: str, *figures: str) -> None:
    print(f"{what:42}" + "".join(f"{figure:>15}" for figure in figures), flush=True)


def show_events() -> None:
    """µs of the CPU for each event, here, in SimPy, in asyncio, and recorded."""
    row("CPU µs an event", "turtle_lesson", "SimPy", "asyncio", "to SimPy", "to asyncio", "real rclpy *")
    for what, makers in EVENTS.items():
        count = COUNTS[what]
        ours, simpy, asyncio = interleaved([make(count) for make in makers], ROUNDS, cpu_clock)
        figures = [f"{statistics.median(times) / count * 1e6:.2f} µs" for times in (ours, simpy, asyncio)]
        row(what, *figures, f"×{ratio(ours, simpy):.2f}", f"×{ratio(ours, asyncio):.2f}", f"{REAL[what]} µs")
    print("* recorded on another machine\n")


def show_whole_system(seconds: int = 100) -> None:
    """Virtual seconds in a second of the CPU: the turtle drives to one goal after the other."""
    row(
        "virtual s in a CPU second, driving",
        "turtle_lesson",
        "callbacks only",
        "cost, to them",
        "aim",
        "ir-sim",
        "to it",
    )
    peers = [irsim(seconds)] if importlib.util.find_spec("irsim") else []
    for source, what, others in (("mock", "mock scans", []), ("world", "ray casts", peers)):
        ours, light, *theirs = driving_times(source, seconds, ROUNDS, *others)
        speeds = [f"{seconds / statistics.median(times):.0f}" for times in (ours, light, *theirs)]
        compared = [speeds[2], f"×{ratio(ours, theirs[0]):.2f}"] if theirs else []
        row(what, *speeds[:2], f"×{ratio(ours, light):.2f}", "×1.60", *compared)
    with tempfile.TemporaryDirectory() as folder:
        row("the lesson's simple nodes, at rest", f"{simple_system_speed(Path(folder), seconds):.0f}")
    print()


def irsim(seconds: int) -> Work:
    """A robot in ir-sim, with the same pillars, beams and rate of scans; it moves only as often as it scans."""
    import irsim

    world = irsim.make(str(Path(__file__).with_name("irsim_world.yaml")), display=False, disable_all_plot=True)

    def work() -> None:
        for _ in range(5 * seconds):
            world.step()

    return work


def simple_system_speed(folder: Path, seconds: int) -> float:
    """Virtual seconds in a CPU second of the simple stage of the nodes, with what makes it a package."""
    import shutil

    from turtle_lesson.learner.story import FINISHED

    shutil.copytree(FINISHED, folder, dirs_exist_ok=True)
    shutil.copytree(SIMPLE_STAGE, folder, dirs_exist_ok=True)
    with contextlib.redirect_stdout(io.StringIO()):
        lesson = start(package=folder)
        lesson.launch("robot_controller", "start_system.launch.py")
        lesson.run(1)
        (times,) = interleaved([lambda: lesson.run(seconds)], ROUNDS, cpu_clock)
    return seconds / statistics.median(times)


# -- instructions -------------------------------------------------------------------------------------------------


def whole_system(source: str, alone: bool) -> Work:
    """Drive for one second of robot time: the whole system, or its frozen callbacks alone."""
    lesson = driving_system(source)
    if not alone:
        return lambda: lesson.run(1)
    light = frozen_twin(lesson, source)
    return lambda: light.run(1)


def carry_out(name: str, count: int) -> None:
    """What `--instructions` counts in a Python of its own: so many events, or seconds of robot time."""
    gc.disable()  # or one collection more or less would count as the work's
    row_name, _, column = name.partition(" / ")
    if row_name in EVENTS:
        EVENTS[row_name][int(column)](count)()
        return
    work = whole_system(row_name, column == "callbacks")
    with contextlib.redirect_stdout(io.StringIO()):
        for _ in range(count):
            work()


def show_instructions() -> None:
    """The same two tables in thousands of instructions."""
    counter = find_counter()
    if counter is None:
        sys.exit("this machine has no counter of instructions: neither perf nor valgrind tells any")
    command = [sys.executable, __file__, "--work"]
    print(f"thousands of instructions, counted by {counter}\n")
    row("an event", "turtle_lesson", "SimPy", "asyncio", "to SimPy", "to asyncio")
    for what in EVENTS:
        ours, *peers = (instructions(counter, [*command, f"{what} / {column}"], 2_000, 22_000) for column in range(3))
        figures = [f"{each / 1000:.1f}" for each in (ours, *peers)]
        row(what, *figures, *(f"×{ours / each:.2f}" for each in peers))
    print()
    row("a virtual second, driving", "turtle_lesson", "callbacks only", "cost, to them")
    for source, what in (("mock", "mock scans"), ("world", "ray casts")):
        ours, light = (
            instructions(counter, [*command, f"{source} / {part}"], 5, 85) for part in ("system", "callbacks")
        )
        row(what, f"{ours / 1000:.0f}", f"{light / 1000:.0f}", f"×{ours / light:.2f}")


# -- many turtles, memory and starting up -------------------------------------------------------------------------


def cost_of_a_turtle(count: int) -> float:
    """CPU µs for each virtual second and turtle, of one simulator with `count` turtles."""
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
        seconds = max(2, 400 // count)
        (times,) = interleaved([lambda: lesson.run(seconds)], 3, cpu_clock)
        return statistics.median(times) / seconds / count * 1e6


def show_turtles() -> None:
    """What a turtle costs among others. A world is made anew for each figure, so a round has one of each."""
    counts = (1, 10, 100, 1000)
    rounds = [[cost_of_a_turtle(count) for count in counts] for _ in range(3)]
    row("turtles in one simulator", *map(str, counts), "1000 to 100")
    costs = (statistics.median(costs) for costs in zip(*rounds, strict=True))
    row("µs a virtual second and turtle", *(f"{cost:.0f}" for cost in costs), f"×{ratio(*columns(rounds, 3, 2)):.2f}")
    print()


def columns(rounds: list[list[float]], *numbers: int) -> list[list[float]]:
    """Some columns of a table."""
    return [[each[number] for each in rounds] for number in numbers]


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


def show_memory() -> None:
    """The memory of a kernel, with the whole system beyond a bare one."""
    bare, whole = zip(*(kernel_memory() for _ in range(ROUNDS)), strict=True)
    beyond = statistics.median(after - before for before, after in zip(bare, whole, strict=True))
    row("MB of a kernel", "bare", "whole system", "beyond", "aim")
    row("", f"{statistics.median(bare):.0f}", f"{statistics.median(whole):.0f}", f"{beyond:.1f}", "15")
    print()


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
    seconds = zip(*(map(float, run.stdout.splitlines()[-1].split()) for run in runs[1:]), strict=True)
    return [statistics.median(column) for column in seconds]


def show_first_steps() -> None:
    """What a fresh Python computes until the first picture."""
    steps = first_steps()
    row("s of computing, in a fresh Python", "turtle_lesson", "aim")
    for step, seconds in zip(STEPS, steps, strict=True):
        row(step, f"{seconds:.3f} s", "0.50 s" if step == "the first picture" else "")
    row("import and start() together", f"{steps[0] + steps[1]:.3f} s", "0.25 s")


def main() -> None:
    parser = argparse.ArgumentParser(description="How fast the simulation is.")
    parser.add_argument("--instructions", action="store_true", help="count instructions instead of time")
    parser.add_argument("--work", nargs=2, metavar=("NAME", "COUNT"), help="only carry out one work, to count it")
    options = parser.parse_args()
    if options.work:
        carry_out(options.work[0], int(options.work[1]))
    elif options.instructions:
        show_instructions()
    else:
        print(f"Python {sys.version.split()[0]}, medians of {ROUNDS} rounds; load {os.getloadavg()[0]:.1f}\n")
        for show in (show_events, show_whole_system, show_turtles, show_memory, show_first_steps):
            show()


if __name__ == "__main__":
    main()
