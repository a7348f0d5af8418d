"""What each widget costs while a page shows it, without a browser: processor time of a real kernel, and bytes on its channel.

With `--robot`, the same on `connect()`, with the stand-in for a real rclpy that the tests use. Nothing is asserted.
"""

from __future__ import annotations

import argparse
import json
import os
import statistics
import sys
import threading
import time
from pathlib import Path
from typing import Any

from jupyter_client.blocking.client import BlockingKernelClient
from jupyter_client.manager import start_new_kernel

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from kernels import ROOT, end

SECONDS = 5.0
ROUNDS = 3

MEASURE = '''
import time
def used():
    """Seconds that all threads of this kernel have computed, and by which clock."""
    return time.process_time(), time.monotonic()
'''

SIMULATION = """
from turtle_lesson import start
system = start(seed=0)
_ = system.launch("robot_controller", "start_system.launch.py", source="world")
system.set_obstacles("three pillars")
system.run(30)
system.play(1)
import asyncio, itertools
async def wander():
    for x, y in itertools.cycle([(9.5, 1.5), (9.5, 9.5), (1.5, 9.5), (1.5, 1.5)]):
        system.dashboard().desk.send(x, y, 0.0)
        await asyncio.sleep(6)
wandering = asyncio.get_running_loop().create_task(wander())
"""

ROBOT = """
import asyncio
import robot_story
turtle = robot_story.Turtle()
async def wander():
    while True:
        for turtle.speed in (1.0, -1.0):
            await asyncio.sleep(3)
wandering = asyncio.get_running_loop().create_task(wander())
"""

CONNECT = """
from turtle_lesson import connect
system = connect()
"""

WIDGETS = {
    "dashboard": "dashboard()",
    "goal pad": "goal_pad()",
    "scene": "scene()",
    "live plot": "live_plot('/turtle1/pose/x', '/robot/status/battery')",
    "teleop": "teleop()",
    "form": "form('/turtle1/cmd_vel')",
    "parameters": "parameters('/navigator')",
}


class Page:
    """A kernel, and what a page does with it: it runs cells, opens and closes views, and hears what comes for them."""

    def __init__(self, client: BlockingKernelClient) -> None:
        self._client = client
        self.messages = self.bytes = 0
        self._left = False
        self._listener = threading.Thread(target=self._listen)
        self._listener.start()

    def leave(self) -> None:
        """Hear no more."""
        self._left = True
        self._listener.join()

    def _listen(self) -> None:
        socket = self._client.iopub_channel.socket
        while not self._left:
            if socket.poll(100):
                parts = socket.recv_multipart()
                header = parts.index(b"<IDS|MSG>") + 2
                if json.loads(parts[header])["msg_type"] == "comm_msg":
                    self.messages += 1
                    self.bytes += sum(map(len, parts[header:]))

    def run(self, cell: str, value: str = "None") -> Any:
        """Run a cell; returns what `value` is then."""
        asked = self._client.execute(cell, user_expressions={"value": value})
        while True:
            answer = self._client.get_shell_msg(timeout=120)
            if answer["parent_header"]["msg_id"] == asked:
                break
        if answer["content"]["status"] != "ok":
            raise RuntimeError(answer["content"]["evalue"])
        text: str = answer["content"]["user_expressions"]["value"]["data"]["text/plain"]
        return json.loads(text.replace("(", "[").replace(")", "]").replace("'", '"').replace("None", "null"))

    def order(self, widget: str, name: str) -> None:
        """What a view sends: "open" or "close"."""
        data = {"method": "custom", "content": {"do": name, "view": "page"}}
        session, channel = self._client.session, self._client.shell_channel
        channel.send(session.msg("comm_msg", {"comm_id": widget, "data": data}))

    def cost(self) -> tuple[float, float, float]:
        """The kernel's share of a core (%), messages a second and bytes a message, over some seconds."""
        messages, size = self.messages, self.bytes
        used, began = self.run("", "used()")
        time.sleep(SECONDS)
        later, ended = self.run("", "used()")
        sent = self.messages - messages
        seconds = ended - began
        return 100 * (later - used) / seconds, sent / seconds, (self.bytes - size) / max(sent, 1)


def median_cost(page: Page) -> tuple[float, float, float]:
    """The round with the median share."""
    return sorted(page.cost() for _ in range(ROUNDS))[ROUNDS // 2]


def show(page: Page, robot: bool) -> None:
    """Print a row for each widget, and one for all of them."""
    page.run(MEASURE + (ROBOT if robot else SIMULATION))
    without = statistics.median(page.cost()[0] for _ in range(ROUNDS))
    print(f"{'the robot alone' if robot else 'the world alone'}: {without:.1f} % of a core")
    if robot:
        page.run(CONNECT)
        print(f"connect(), nothing shown: {median_cost(page)[0] - without:.1f} % of a core more")
    ids = {name: page.run(f"widget = system.{made}", "widget.model_id") for name, made in WIDGETS.items()}
    print(f"{'shown':12}{'% of a core':>12}{'frames/s':>10}{'ms/frame':>10}{'kB/frame':>10}")
    for name, shown in [*((name, [name]) for name in ids), ("all", list(ids))]:
        for each in shown:
            page.order(ids[each], "open")
        time.sleep(2)
        share, frames, size = median_cost(page)
        each_frame = f"{10 * (share - without) / frames:10.2f}{size / 1000:10.2f}" if frames > 5 else ""
        print(f"{name:12}{share - without:12.1f}{frames:10.1f}{each_frame}", flush=True)
        for each in shown:
            page.order(ids[each], "close")
        time.sleep(0.5)


def main(robot: bool) -> None:
    """Start a kernel, and measure in it."""
    tests = ROOT / "tests"
    paths = [*([tests / "real_rclpy_standin"] if robot else []), ROOT, tests]
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(map(str, paths))}
    manager, client = start_new_kernel(kernel_name="python3", env=environment)
    page = Page(client)
    try:
        show(page, robot)
    finally:
        page.leave()
        end(manager, client)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--robot", action="store_true", help="on connect(), with a stand-in for a real rclpy")
    main(parser.parse_args().robot)
