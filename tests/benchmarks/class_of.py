"""What a class costs on a JupyterHub: a plain one on this machine, with the configuration of deploy/jupyterhub.

So many learners (10, or the argument) log in at once. Each opens a page, starts the whole system and draws a picture; later
each has the dashboard shown, with time playing at the pace of life. For each learner's server and kernel it prints memory and
processor time. All of them run as the user of this process. Nothing is asserted.
"""

from __future__ import annotations

import statistics
import sys
import tempfile
import threading
import time
from collections.abc import Iterable
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack
from pathlib import Path

import psutil

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "browser"))

from jupyter_hub import Channels, Hub, Person, find_proxy, jupyterhub

SECONDS = 20
STARTED = """%load_ext turtle_lesson
from turtle_lesson import start
lesson = start(seed=0)
_ = lesson.launch("robot_controller", "start_system.launch.py")
lesson.run(30)
lesson.plot_path()"""
SHOWN = "widget = lesson.dashboard(); lesson.play(1); print(widget.model_id)"


def seconds(processes: Iterable[psutil.Process]) -> float:
    """Processor time that these have used."""
    return sum(sum(each.cpu_times()[:2]) for each in processes)


def megabytes(processes: Iterable[psutil.Process]) -> tuple[float, float]:
    """Memory of these: their share where they share some with others on the machine, and as if they were alone."""
    used = [each.memory_full_info() for each in processes]
    return sum(each.pss for each in used) / 1e6, sum(each.rss for each in used) / 1e6


class Classroom:
    """The processes of a hub, by what they are."""

    def __init__(self, hub: Hub) -> None:
        self.hub = psutil.Process(hub.process.pid)

    def parts(self) -> dict[str, list[psutil.Process]]:
        """All that run now."""
        own = self.hub.children()
        servers = [each for each in own if "jupyterhub.singleuser" in each.cmdline()]
        kernels = [child for each in servers for child in each.children()]
        return {
            "hub": [self.hub],
            "proxy": [each for each in own if each not in servers],
            "server": servers,
            "kernel": kernels,
        }

    def show(self, title: str) -> None:
        """Print what each part takes, over some seconds."""
        parts = {name: each for name, each in self.parts().items() if each}
        began, before = time.monotonic(), {name: seconds(each) for name, each in parts.items()}
        time.sleep(SECONDS)
        passed = time.monotonic() - began
        print(title)
        for name, each in parts.items():
            share = 100 * (seconds(each) - before[name]) / passed / len(each)
            shared, alone = megabytes(each)
            print(
                f"  {name:8}{shared / len(each):8.0f} MB ({alone / len(each):.0f} alone){share:8.1f} % of a core",
                flush=True,
            )


def hear(channels: Channels, stopped: threading.Event, heard: list[str]) -> None:
    """Take what comes for a page's widgets, until the page is left."""
    for kind, _, _ in channels.messages():
        heard.append(kind)
        if stopped.is_set():
            break


def log_in(hub: Hub, name: str) -> tuple[Person, float]:
    """Somebody with a server, and the seconds until it was there."""
    began = time.monotonic()
    person = Person(hub, name)
    person.start_server()
    return person, time.monotonic() - began


def measure(hub: Hub, names: list[str], pages: ExitStack, threads: ThreadPoolExecutor) -> None:
    """Print all figures."""
    room, used = Classroom(hub), seconds
    began = used([room.hub])
    people, waited = zip(*threads.map(lambda name: log_in(hub, name), names), strict=True)
    parts = room.parts()
    print(f"logins at once: {len(names)}, the first page after {min(waited):.1f} to {max(waited):.1f} s")
    print(
        f"processor time of a login: {used(parts['server']) / len(names):.1f} s, of the hub {used([room.hub]) - began:.1f} s"
    )
    room.show("servers, no page open")
    channels = [pages.enter_context(each.connected(each.kernel())) for each in people]
    list(threads.map(lambda each: each.run(STARTED), channels))
    cells = [seconds([each]) for each in room.parts()["kernel"]]
    print(f"processor time of a page's set-up: {statistics.median(cells):.1f} s")
    room.show("a started lesson each")
    widgets = [said.split()[-1] for said in threads.map(lambda each: each.run(SHOWN), channels)]
    for each, widget in zip(channels, widgets, strict=True):
        content = {"method": "custom", "content": {"do": "open", "view": "page"}}
        each.send("comm_msg", {"comm_id": widget, "data": content})
    stopped, heard = threading.Event(), []
    listeners = [threads.submit(hear, each, stopped, heard) for each in channels]
    time.sleep(3)
    count = len(heard)
    room.show("the dashboard shown and playing, each")
    print(f"messages a second, each: {(len(heard) - count) / SECONDS / len(names):.0f}")
    stopped.set()
    for each in listeners:
        each.result()


def main(learners: int) -> None:
    """Start a hub, and measure."""
    proxy = find_proxy()
    if proxy is None:
        sys.exit("JupyterHub's proxy is missing: npm install --prefix tests/browser")
    names = [f"learner{number}" for number in range(learners)]
    with (
        tempfile.TemporaryDirectory() as folder,
        jupyterhub(Path(folder), names, proxy, None) as hub,
        ExitStack() as pages,
        ThreadPoolExecutor(learners) as threads,
    ):
        measure(hub, names, pages, threads)


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 10)
