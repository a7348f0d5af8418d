"""The stop button at random moments of many kinds of cell, imports included, and what the kernel is like afterwards.

    .venv/bin/python tests/soak/interrupts.py 1000 --seed 0

After each interrupt the kernel must answer, and its time, threads, random numbers, streams, environment variables, signal
handlers, current folder, modules and locks must be the real ones. Every fourth interrupted cell is run once more, which
must end without an error. The last line says how many interrupts hit how many kinds of cell, and what was found.
"""

from __future__ import annotations

import argparse
import os
import signal
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from random import Random

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

import kernels
from answers.stopped import BUTTON
from jupyter_client.manager import start_new_kernel

ROOT = Path(__file__).resolve().parents[2]
ANSWER = 240
"""Seconds of real time in which a kernel that lives has surely answered."""

PREPARE = f"""
%load_ext turtle_lesson
import _imp, asyncio, faulthandler, os, random, signal, sys, threading, time
import psutil, rclpy
from geometry_msgs.msg import Twist
from turtle_lesson import start
from turtlesim.srv import TeleportAbsolute

faulthandler.register(signal.SIGUSR2, open("stacks.txt", "w"))
with open("program.py", "w") as file:
    file.write('''
import os, random, threading, time
os.environ["COLOUR"] = "red"
random.seed(1)
thread = threading.Thread(target=time.sleep, args=(0.3,))
thread.start()
for _ in range(200):
    time.sleep(0.01)
    random.random()
thread.join()
print("done", time.time())
''')
with open("importer.py", "w") as file:
    file.write('''
import time
import unittest.mock, wsgiref.simple_server, xmlrpc.client, mailbox, optparse
time.sleep(0.1)
''')

def forget():
    for name in list(sys.modules):
        if name.partition(".")[0] in ("unittest", "wsgiref", "xmlrpc", "mailbox", "optparse", "http"):
            del sys.modules[name]

def facts():
    before, now, after = time.clock_gettime(time.CLOCK_REALTIME), time.time(), time.clock_gettime(time.CLOCK_REALTIME)
    random.seed(5)
    known = (signal.SIGINT, signal.SIGTERM, signal.SIGUSR1)
    return dict(
        time=before <= now <= after and time.monotonic() <= time.monotonic(), random=random.random(),
        thread=threading.current_thread() is threading.main_thread() and type(threading.main_thread()).__name__,
        threads=psutil.Process().num_threads(),
        streams=[type(stream).__module__ for stream in (sys.stdout, sys.stderr)], argv=list(sys.argv),
        environ=dict(os.environ), signals=[signal.getsignal(each) for each in known], folder=os.getcwd(),
        main=sys.modules["__main__"].__name__, own=[name for name in sys.modules if name in ("program", "importer")],
        lock=_imp.lock_held(), loop=id(asyncio.get_running_loop()), hook=threading.excepthook.__name__,
        world=lesson._world.sim.running,
    )

{BUTTON}
lesson = start(seed=0)
"""

FRESH = "lesson = start(seed=0)\nrclpy.try_shutdown(); rclpy.init()\nme = rclpy.create_node('me')"
"""What all other kinds of cell build on."""

CELLS = {
    "start": FRESH,
    "launch": 'lesson.launch("robot_controller", "start_system.launch.py")',
    "run": "lesson.run(60)",
    "compute": "lesson._world.spawn(lambda: sum(range(6_000_000)), name='computes')\nlesson.run(1)",
    "node": "me.create_timer(0.01, lambda: None)\nfor _ in range(200): rclpy.spin_once(me)",
    "service": "client = me.create_client(TeleportAbsolute, '/turtle1/teleport_absolute')\n"
    "for _ in range(40): client.call(TeleportAbsolute.Request(x=2.0, y=2.0))",
    "publish": "pub = me.create_publisher(Twist, '/turtle1/cmd_vel', 10)\nfor _ in range(400): pub.publish(Twist())",
    "command": "ros2 topic list\nros2 topic echo /turtle1/pose --once\nros2 node info /turtlesim",
    "program": "python3 program.py",
    "importing program": "forget()\npython3 importer.py",
    "import": "forget()\nimport unittest.mock, wsgiref.simple_server, xmlrpc.client, mailbox, optparse",
    "thread": "t = threading.Thread(target=time.sleep, args=(3,))\nt.start()\ntime.sleep(1)\nt.join()",
    "live": "lesson.play(50)\nawait asyncio.sleep(0.2)\nlesson.pause()",
    "picture": "lesson.run(1)\nlesson.plot_path()",
    "widgets": "lesson.dashboard()",
    "prediction": "question = f'q{random.random()}'\nlesson.predict(question, 'How far?', unit='m')",
}


class Kernel:
    """A kernel in a folder of its own; `run(source)` returns what a cell printed, and the name of its error."""

    def __init__(self, folder: Path) -> None:
        self.stacks = folder / "stacks.txt"
        self.manager, self.client = start_new_kernel(cwd=str(folder), kernel_name="python3")
        said, error = self.run(f"import sys; sys.path.insert(0, {str(ROOT)!r})\n{PREPARE}")
        assert not error, said
        self.run(FRESH)
        self.run("lesson.dashboard()")
        self.run("real = facts()")

    def run(self, source: str) -> tuple[str, str]:
        """Run a cell. Raises TimeoutError, with what each of its threads does, if the kernel does not answer."""
        said: list[str] = []
        ended: list[str] = []

        def hear(message: dict[str, dict[str, str]]) -> None:
            content = message["content"]
            said.append(content.get("text", ""))
            if "ename" in content:
                ended.append(content["ename"])
                said.append(content["evalue"])

        try:
            self.client.execute_interactive(source, output_hook=hear, timeout=ANSWER, allow_stdin=False)
        except TimeoutError as error:
            os.kill(self.manager.provisioner.pid, signal.SIGUSR2)
            time.sleep(5)
            raise TimeoutError(f"{source}\n{self.stacks.read_text()}") from error
        except ValueError:  # Jupyter itself was interrupted in the middle of a message, as it may be in any notebook
            ended.append("")
        return "".join(said), "".join(ended)


@contextmanager
def kernel() -> Iterator[Kernel]:
    """A kernel that is prepared, until the end of the block."""
    with tempfile.TemporaryDirectory() as folder:
        made = Kernel(Path(folder))
        try:
            yield made
        finally:
            kernels.end(made.manager, made.client)


def soak(kernel: Kernel, interrupts: int, seed: int, found: Counter[str]) -> Iterator[str]:
    """Interrupt cells until so many interrupts have hit; yields the kind of each, and counts what is wrong in `found`."""
    chance = Random(seed)
    kinds = list(CELLS)
    hits = tries = 0
    took = dict.fromkeys(kinds, 0.0)
    while hits < interrupts:
        if tries % len(kinds) == 0:
            chance.shuffle(kinds)
        kind = kinds[tries % len(kinds)]
        tries += 1
        if not took[kind]:  # how long it takes, and whether it works at all
            began = time.monotonic()
            said, error = kernel.run(CELLS[kind])
            took[kind] = time.monotonic() - began
            if error:
                found[f"{kind} fails uninterrupted: {error}: {said[-300:]}"] += 1
        kernel.run(f"get_ipython().meta['stop_after'] = {chance.uniform(0.0005, took[kind])}")
        kernel.run(CELLS[kind])
        said, _ = kernel.run(
            "print(get_ipython().meta.pop('stopped', False), {k: v for k, v in facts().items() if v != real[k]})"
        )
        if not said.startswith("True"):
            continue  # the cell was over before
        hits += 1
        if said.strip() != "True {}":
            found[f"{kind}: not as before: {said.strip()[:300]}"] += 1
        said, error = kernel.run(FRESH) if kind == "start" else ("", "")
        if not error and hits % 4 == 0:
            said, error = kernel.run(CELLS[kind])
        if error:
            found[f"{kind} fails when run again: {error}: {said[-300:]}"] += 1
        yield kind


def main() -> None:
    """Carry out what the command line asks for."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("interrupts", type=int, help="how many")
    parser.add_argument("--seed", type=int, default=0, help="chooses cells and moments")
    given = parser.parse_args()
    found: Counter[str] = Counter()
    hits: Counter[str] = Counter()
    with kernel() as one:
        for kind in soak(one, given.interrupts, given.seed, found):
            hits[kind] += 1
            if hits.total() % 50 == 0:
                print(hits.total(), dict(found), flush=True)
    print(f"{hits.total()} interrupts of {len(hits)} kinds of cell {dict(hits)}; found: {dict(found) or 'nothing'}")


if __name__ == "__main__":
    main()
