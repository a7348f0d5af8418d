"""What is left behind by worlds that have ended, and by one that goes on for hours: memory and objects, measured in a kernel.

    .venv/bin/python tests/soak/worlds.py rounds            200 times: start, launch, show, play, close
    .venv/bin/python tests/soak/worlds.py rounds --left     the same, but the widgets are left for the next start() to end
    .venv/bin/python tests/soak/worlds.py rounds --undisplayed  the same, but no cell has a result, and none is drawn
    .venv/bin/python tests/soak/worlds.py hours             two hours of robot time with all widgets shown
    .venv/bin/python tests/soak/worlds.py orders            10,000 orders from a page at once

Each line shows the resident memory (MB; on Linux, after freed memory was given back to the system); greenlets, worlds,
asyncio tasks and objects that Python knows; threads and open files of the process; Jupyter's comms and the widgets that
ipywidgets keeps. A page is not needed: the soak says what views say.
The results of all cells stay in `Out`. What IPython 9 keeps of every output besides (a picture is some 100 kB) is thrown away.
"""

from __future__ import annotations

import argparse
import ast
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

import kernels
from jupyter_client.blocking.client import BlockingKernelClient
from jupyter_client.manager import start_new_kernel

ROOT = Path(__file__).resolve().parents[2]
ROUNDS, EVERY = 200, 20
HOURS, MINUTES = 2, 20

Figures = dict[str, float]

PREPARE = f"""
import asyncio, ctypes, gc, math, sys, time
sys.path.insert(0, {str(ROOT)!r})
import comm, greenlet, psutil
from ipywidgets.widgets import widget as _registry
from turtle_lesson import start
from turtle_lesson.ros.runtime.world import World

def say(widget, order, /, **content):
    content = {{"do": order, "view": "v", **content}}
    widget.comm.handle_msg({{"content": {{"data": {{"method": "custom", "content": content}}}}, "buffers": []}})

def figures():
    getattr(get_ipython().history_manager, "outputs", {{}}).clear()
    gc.collect()
    if sys.platform == "linux":
        ctypes.CDLL(None).malloc_trim(0)
    objects, process = gc.get_objects(), psutil.Process()
    return {{
        "MB": round(process.memory_info().rss / 1e6, 1),
        "objects": len(objects),
        "worlds": sum(type(each) is World for each in objects),
        # a thread's own greenlet, which has no parent, is there as soon as the thread asks for it
        "greenlets": sum(isinstance(each, greenlet.greenlet) and each.parent is not None for each in objects),
        "tasks": len(asyncio.all_tasks()),
        "threads": process.num_threads(),
        "files": process.num_fds() if hasattr(process, "num_fds") else process.num_handles(),
        "comms": len(comm.get_comm_manager().comms),
        "widgets": len(_registry._instances),
    }}
"""

ROUND = (
    "lesson = start(seed=0)",
    'lesson.launch("robot_controller", "start_system.launch.py")',
    "lesson.dashboard()",
    "lesson.scene()",
    "for each in (lesson.dashboard(), lesson.scene()): say(each, 'open')",
    "say(lesson.dashboard(), 'goal', x=9.0, y=9.0, theta=0.0)",
    "lesson.play(10)\nawait asyncio.sleep(0.1)",
    "lesson.pause()",
)
CLOSE = "for each in (lesson.dashboard(), lesson.scene()): each.close()"

EVERYTHING = """
lesson = start(seed=0)
lesson.launch("robot_controller", "start_system.launch.py")
lesson.run(1)
shown = [lesson.dashboard(), lesson.goal_pad(), lesson.scene(), lesson.teleop(), lesson.parameters("/navigator")]
shown += [lesson.form("/turtle1/cmd_vel"), lesson.form("/navigate_to")]
shown += [lesson.live_plot("/turtle1/pose/x", "/robot/status/battery")]
for each in shown: say(each, "open")
lesson.play(math.inf)
"""
A_WHILE = """
while lesson.now < {until}:
    pad = lesson.goal_pad()
    if not pad.goals or pad.goals[-1]["state"] not in ("looking for the navigator", "on its way"):
        number = pad.goals[-1]["number"] if pad.goals else 0
        say(pad, "goal", x=2.0 + 7.0 * (number % 2), y=2.0 + 7.0 * (number // 2 % 2), theta=0.0)
    await asyncio.sleep(0.2)
for each in shown: say(each, "alive")
"""


class Kernel:
    """A kernel with the lesson in it. `run` gives what a cell printed, and raises RuntimeError with the error of the cell."""

    def __init__(self, client: BlockingKernelClient) -> None:
        self.client = client
        self.run(PREPARE)

    def run(self, cell: str) -> str:
        said: list[str] = []
        errors: list[str] = []

        def hear(message: dict[str, Any]) -> None:
            content = message["content"]
            said.append(content.get("text", ""))
            errors.extend(content.get("traceback", ()))

        self.client.execute_interactive(cell, output_hook=hear, timeout=3600, allow_stdin=False)
        if errors:
            raise RuntimeError("\n".join(errors))
        return "".join(said)

    def figures(self) -> Figures:
        figures: Figures = ast.literal_eval(self.run("print(figures())"))
        return figures


@contextmanager
def kernel() -> Iterator[Kernel]:
    """A fresh kernel in an empty folder, with a history of its own: SQLite opens a journal when another kernel writes to it."""
    with tempfile.TemporaryDirectory() as folder:
        own = ["--HistoryManager.hist_file=:memory:"]
        manager, client = start_new_kernel(cwd=folder, kernel_name="python3", extra_arguments=own)
        try:
            yield Kernel(client)
        finally:
            kernels.end(manager, client)


def rounds(
    kernel: Kernel, count: int, every: int, *, close: bool, display: bool = True
) -> Iterator[tuple[int, Figures]]:
    """Go through worlds as a page does, cell by cell; gives the figures of the first and of each `every`th round."""
    for number in range(1, count + 1):
        for cell in (*ROUND, CLOSE) if close else ROUND:
            kernel.run(cell if display else f"{cell}\nNone")
        if number == 1 or number % every == 0:
            yield number, kernel.figures()


def hours(kernel: Kernel, count: float) -> Iterator[tuple[int, Figures]]:
    """Let robot time pass with all widgets shown and the turtle driving; gives the figures every 20 minutes of it."""
    kernel.run(EVERYTHING)
    for minute in range(0, round(60 * count) + 1, MINUTES):
        kernel.run(A_WHILE.format(until=max(60 * minute, 10)))
        yield minute, kernel.figures()


def orders(kernel: Kernel, count: int) -> tuple[float, float, str]:
    """Send orders to a teleop widget through the kernel's own channel, all at once.

    Returns the seconds until all were carried out, until a cell answered, and what the widget says then.
    """
    kernel.run("lesson = start(seed=0)\nteleop = lesson.teleop()")
    comm_id = kernel.run("print(teleop.comm.comm_id)").strip()
    channel, session = kernel.client.shell_channel, kernel.client.session
    begun = time.monotonic()
    for number in range(1, count + 1):
        content = {"do": "limits", "view": "v", "forward": 10.0 * number / count}
        data = {"method": "custom", "content": content}
        channel.send(session.msg("comm_msg", {"comm_id": comm_id, "data": data}))
    kernel.run("pass")
    answered = time.monotonic() - begun
    kernel.run("while teleop.limits['forward'] < 10.0: await asyncio.sleep(0.01)")
    return time.monotonic() - begun, answered, kernel.run("print(teleop)").strip()


def show(what: str, found: Iterator[tuple[int, Figures]]) -> None:
    for number, figures in found:
        if what:
            print(f"| {what} | {' | '.join(figures)} |")
            what = ""
        print(f"| {number} | {' | '.join(map(str, figures.values()))} |", flush=True)


def main() -> None:
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("what", choices=("rounds", "hours", "orders"))
    options.add_argument("--left", action="store_true", help="do not close the widgets")
    options.add_argument("--undisplayed", action="store_true", help="no cell has a result")
    options.add_argument("--count", type=float, help="how many rounds, hours or orders")
    asked = options.parse_args()
    with kernel() as one:
        if asked.what == "rounds":
            show(
                "round",
                rounds(one, int(asked.count or ROUNDS), EVERY, close=not asked.left, display=not asked.undisplayed),
            )
        elif asked.what == "hours":
            show("minute", hours(one, asked.count or HOURS))
        else:
            count = int(asked.count or 10_000)
            done, answered, said = orders(one, count)
            print(
                f"{count} orders: the next cell answered after {answered:.1f} s, all were done after {done:.1f} s: {said}"
            )


if __name__ == "__main__":
    main()
