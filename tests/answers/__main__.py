"""Runs pages of the lesson, each in a fork of one process that has imported it.

    python -m answers SOCKET    (in tests/; the number of a Unix socket that listens; `client.py` starts it)

Each connection runs one page, which its first line names: {"page": …}. It then reads a request a line, and writes a reply a
line (`server.py`). With {"restart": true} the one reply says what went wrong after restarts (`restart.py`), with {"stopped":
true} what went wrong when each cell was stopped once (`stopped.py`). It ends when the connection does. {"cells": [[source,
whether an error is wanted], …], "folder": …} is a learner's page in a folder that stays; the one reply holds the texts of
the cells' results.
"""

from __future__ import annotations

import contextlib
import gc
import importlib
import json
import os
import socket
import sys
import tempfile
import traceback
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

os.environ["TURTLE_LESSON_PROGRESS"] = "off"

from turtle_lesson import experiments
from turtle_lesson.lab.checks import navigation, page_10, probe
from turtle_lesson.lab.checks.registry import all_checks
from turtle_lesson.lab.drawing import Picture
from turtle_lesson.ros.sim import interrupts

from . import restart, stopped
from .server import Kept, Page, import_what_these_import, results, serve, the_shell

PATIENCE = 0.5
"""CPU time, s, after which a callback that lets no time pass is stopped: less than a learner is given, for the tests' sake."""

WORK = 2.0
"""CPU time, s, that a check may take here: three times what the longest one needs."""

LONGEST = 50.0
"""Robot time, s, that one drive may take here: the longest that is answered takes 47 s."""

MINUTES = 1.0
"""For how long the whole system of page 10 works here; the page itself shows that its solution does for five."""

IMPORTS = (
    "IPython.core.ultratb",
    "matplotlib.backends.backend_agg",
    "matplotlib.figure",
    "stack_data",
    "turtle_lesson.session",
)
"""What takes longest to import."""

WARM_UP = (
    "%load_ext turtle_lesson\nfrom turtle_lesson import start\nlesson = start(seed=0)\nlesson.run(0.1)",
    "import rclpy, tf2_ros, launch_ros.actions\nlesson.launch('robot_controller', 'start_system.launch.py')\nlesson.run(0.2)",
    "ros2 node list\nros2 topic echo --once /turtle1/pose\nros2 param list\nros2 run turtlesim turtlesim_node",
    "ros2 service call /reset std_srvs/srv/Empty",
    "seen = lesson.plot_path(), lesson.plot_timeline('/turtle1/pose'), lesson.plot_status(), lesson.plot_scan()",
    "lesson.predict('q', question='How far?', choices=['a', 'b'])",
    "shown = lesson.dashboard(), lesson.goal_pad(), lesson.teleop(), lesson.form('/reset')",
    "lesson.check('face_up')",
    "from std_msgs.msg import Bool, Float32, Int32, String\nfrom std_srvs.srv import Trigger",
    "lesson = start(seed=0, page='06_parameters_and_launch', package='mine')",
    "1 / 0",
    "from turtle_lesson.experiments import experiment",
)
"""Cells in which most of the rest is imported: once, instead of once a page and answer."""


def draw_no_pictures() -> None:
    """Have pictures be made, but not drawn, which takes a quarter of a page's time: nobody sees them, and nbval draws all."""
    Picture.png = lambda self: b""  # type: ignore[method-assign]


def carry_out_few_runs() -> None:
    """Have the experiments of a page carry out four runs of each setting, in one process: nbval compares all of them."""

    def few(function: Callable[..., Any], *, seeds: Iterable[int] = range(4), **options: Any) -> experiments.Results:
        fewer = seeds if "until" in options else [*seeds][:4]
        return every(function, seeds=fewer, **{"jobs": 1, **options})

    every = experiments.experiment
    experiments.experiment = few


def run_page(connection: socket.socket) -> None:
    """Run the page that the first line names, in a fresh folder."""
    with connection, connection.makefile("rw", encoding="utf-8") as stream, tempfile.TemporaryDirectory() as scratch:
        wanted = json.loads(stream.readline())
        if "cells" in wanted:
            os.environ.pop("TURTLE_LESSON_FOLDER", None)  # the current one is the learner's
            os.chdir(wanted["folder"])
            stream.write(json.dumps(results(wanted["cells"])) + "\n")
            return
        folder = Path(scratch, "folder")
        folder.mkdir()
        os.environ["TURTLE_LESSON_FOLDER"] = str(folder)
        os.chdir(folder)
        page = Page(wanted["page"], folder)
        if wanted.get("stopped"):
            cells = [(cell["source"], "raises-exception" in cell["tags"]) for cell in page.cells]
            stream.write(json.dumps(stopped.problem_here(page.shell, cells, wanted["page"])) + "\n")
        elif wanted.get("restart"):
            stream.write(json.dumps(restart.problems(page, wanted["page"])) + "\n")
        else:
            serve(page, Kept(folder, Path(scratch, "kept")), stream, stream)
        os.chdir("/")


def main() -> None:
    """Serve each connection to the socket in a fork of this process, until that is ended."""
    interrupts.patience = PATIENCE
    probe.WORK, navigation.LONGEST, page_10.MINUTES = WORK, LONGEST, MINUTES
    the_shell()
    for name in IMPORTS:
        importlib.import_module(name)
    all_checks()
    import_what_these_import(WARM_UP)
    draw_no_pictures()
    carry_out_few_runs()
    os.dup2(2, 1)  # what is printed belongs to the log
    gc.freeze()
    with socket.socket(fileno=int(sys.argv[1])) as listener:
        while True:
            connection, _ = listener.accept()
            if os.fork() == 0:
                status = 1
                try:
                    listener.close()
                    run_page(connection)
                    status = 0
                except BaseException:
                    traceback.print_exc()
                finally:
                    os._exit(status)
            connection.close()
            with contextlib.suppress(ChildProcessError):
                while os.waitpid(-1, os.WNOHANG)[0]:  # the pages that have ended
                    pass


if __name__ == "__main__":
    main()
