"""The table of patches: every row is put in and taken out, and a plain Python is afterwards as it was."""

from __future__ import annotations

import json
import subprocess
import sys
import threading
from functools import cache
from typing import Any

import pytest

from turtle_lesson.ros.stdlib import patches

# One child process looks at all rows; each row is a test of its own.
EACH_ROW = """
import importlib, json, sys
from pkgutil import resolve_name
rows = json.loads(sys.argv[1])
owners = {}
for owner, name in rows:
    try:
        owners[owner] = resolve_name(owner)
    except ImportError:
        pass
missing = object()
def now():
    return [getattr(owners[owner], name, missing) if owner in owners else missing for owner, name in rows]
def own():
    return [vars(owners[o]).get(n, missing) if isinstance(owners.get(o), type) else None for o, n in rows]
originals, of_classes, finders = now(), own(), list(sys.meta_path)

import turtle_lesson
from turtle_lesson.ros.runtime.world import open_world
from turtle_lesson.ros.stdlib import patches
early = now()
world = open_world()
ours, our_finders = now(), list(sys.meta_path)
world.close()
patches.uninstall()
after, after_of_classes, after_finders = now(), own(), list(sys.meta_path)
again = open_world()
ours_again = now()
again.close()
print(json.dumps({
    "there": [each is not missing for each in originals],
    "early": [mine is not real for mine, real in zip(early, originals)],
    "replaced": [mine is not real for mine, real in zip(ours, originals)],
    "again": [mine is not real for mine, real in zip(ours_again, originals)],
    "put back": [each is real or each == real != missing for each, real in zip(after, originals)],
    "the same": [each is real for each, real in zip(after_of_classes, of_classes)],
    "finders": [len(our_finders) - len(finders), after_finders == finders],
}))
"""

# What a plain process can see of the interpreter, before and after.
AS_BEFORE = """
import asyncio, atexit, concurrent.futures.thread, dataclasses, importlib.util, inspect, logging, os, pickle, queue, random
import multiprocessing.process, signal, subprocess, sys, threading, time, typing, _thread, _threading_local
import numpy, numpy.random

said = []

def say(*words):
    said.append(" ".join(map(str, words)))

def state():
    modules = (
        asyncio, asyncio.events, atexit, concurrent.futures.thread, dataclasses, importlib, inspect, logging, os, pickle,
        queue, random, multiprocessing.process, signal, subprocess, threading, time, typing, _thread, _threading_local,
        numpy.random, sys,
    )
    seen = {}
    for module in modules:
        for name, value in vars(module).items():
            seen[module.__name__, name] = value
            if isinstance(value, type) and value.__module__ == module.__name__:
                seen.update({(module.__name__, f"{name}.{key}"): each for key, each in vars(value).items()})
    return seen

OF_ITS_OWN = {"__annotations__", "_sha512", "last_exc", "last_value"}
before = state()
copies = list(sys.meta_path), list(sys.path_hooks), dict(os.environ), type(os.environ), threading.enumerate()
handlers = [signal.getsignal(each) for each in signal.valid_signals()]
streams = sys.stdin, sys.stdout, sys.stderr, sys.argv, sys.displayhook, sys.excepthook

import turtle_lesson
from turtle_lesson.ros.stdlib import patches

lesson = turtle_lesson.start()
from threading import Event, Lock, RLock, Thread, local
from time import monotonic, sleep
from queue import Queue, SimpleQueue
from subprocess import Popen
from concurrent.futures import ThreadPoolExecutor
import rclpy
rclpy.init()
node = rclpy.create_node("talker")
node.create_timer(0.1, lambda: None)
rclpy.spin_once(node)
rclpy.shutdown()
from turtle_lesson.ros.runtime.world import current_world
try:
    patches.uninstall()
except RuntimeError as error:
    say(error)
current_world().close()
patches.uninstall()

after = state()
# A module gets further names when its submodules are imported; a class gets none.
changed = sorted({
    key for key in before.keys() | {key for key in after if "." in key[1]}
    if before.get(key, "none") is not after.get(key, "none") and key[1].rpartition(".")[2] not in OF_ITS_OWN
})
say([key for key in changed if before.get(key, 0) != after.get(key, 0)])
say(copies[0] == sys.meta_path, copies[1] == sys.path_hooks, copies[2] == dict(os.environ), copies[3] is type(os.environ))
say(copies[4] == threading.enumerate())
say(handlers == [signal.getsignal(each) for each in signal.valid_signals()])
say(all(a is b for a, b in zip(streams, (sys.stdin, sys.stdout, sys.stderr, sys.argv, sys.displayhook, sys.excepthook))))

# What was taken meanwhile goes on as the real thing.
lock, again, event, items, simple, own = Lock(), RLock(), Event(), Queue(), SimpleQueue(), local()
def work():
    own.name = "other"
    with lock, again:
        sleep(0.01)
    simple.put(items.get(timeout=10))
    event.set()
own.name = "main"
thread = Thread(target=work)
thread.start()
items.put("item")
say(event.wait(10), simple.get(timeout=10), own.name, type(lock).__module__)
thread.join()
say(thread.is_alive(), monotonic() - time.monotonic() < 1)
with ThreadPoolExecutor() as pool:
    say(list(pool.map(abs, [-1, 2])))
say(Popen([sys.executable, "-c", "print('real')"], stdout=-1).communicate()[0].strip())
turtle_lesson.start()
say(threading.Lock is not before["threading", "Lock"])
print("---")
for each in said:
    print(each)
"""


def run(code: str, *arguments: str) -> str:
    """What a program prints in a Python of its own."""
    ended = subprocess.run(
        [sys.executable, "-c", code, *arguments], capture_output=True, text=True, timeout=300, check=False
    )
    assert ended.returncode == 0, ended.stderr
    return ended.stdout


@cache
def looked_at() -> dict[str, Any]:
    """What a child process has seen of all rows, in their order."""
    return json.loads(run(EACH_ROW, json.dumps([(row.owner, row.name) for row in patches.TABLE])))


@pytest.mark.parametrize("index", range(len(patches.TABLE)), ids=[f"{row.owner}.{row.name}" for row in patches.TABLE])
def test_a_row_is_put_in_and_taken_out(index: int) -> None:
    seen, row = {name: values[index] for name, values in looked_at().items() if name != "finders"}, patches.TABLE[index]
    assert row.why
    if not seen["there"]:  # on this system, or in this Python
        assert not seen["replaced"]
    else:
        assert seen["replaced"] and seen["again"]
        assert seen["early"] == (row in patches.EARLY)
    assert seen["put back"] or not seen["there"]
    assert seen["the same"]


def test_finders_are_put_in_and_taken_out() -> None:
    assert looked_at()["finders"] == [len(patches.FINDERS) + 1, True]


def test_a_plain_python_is_afterwards_as_it_was() -> None:
    assert run(AS_BEFORE).partition("---\n")[2].splitlines() == [
        "a world is open, whose programs need what is to be taken out: close it first",
        "[]",
        "True True True True",
        "True",
        "True",
        "True",
        "True item main _thread",
        "False True",
        "[1, 2]",
        "b'real'",
        "True",
    ]


def test_a_python_without_a_private_name_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    patches._check_python()
    monkeypatch.setattr(patches, "PRIVATE_NAMES", ((threading, "_gone"),))
    with pytest.raises(NotImplementedError, match=r"has changed .* need: _gone \(<module 'threading'"):
        patches._check_python()


def test_a_newer_python_is_tried_and_said(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(patches, "NEWEST", (3, 10))
    with pytest.warns(RuntimeWarning, match=r"was tried on Python 3\.11 to 3\.14"):
        patches._check_python()


LATE_NUMPY = """
import sys, turtle_lesson
from turtle_lesson.ros.runtime.world import open_world
from turtle_lesson.ros.stdlib import patches

def draw():
    import numpy
    print(numpy.random.rand(2), numpy.random.default_rng().random())

for _ in range(2):
    world = open_world(seed=3)
    print("numpy.random" in sys.modules)
    world.spawn(draw, name="draw")
    world.sim.settle()
import numpy
print(isinstance(numpy.random.rand.__self__, numpy.random.RandomState))
world.close()
patches.uninstall()
print(isinstance(numpy.random.rand.__self__, numpy.random.RandomState))
"""


def test_the_random_numbers_of_numpy_are_replaced_when_it_is_imported() -> None:
    run = subprocess.run([sys.executable, "-c", LATE_NUMPY], capture_output=True, text=True, check=False)
    assert run.stderr == ""
    late, first, there, again, replaced, put_back = run.stdout.splitlines()
    assert (late, there, replaced, put_back) == ("False", "True", "False", "True")
    assert first == again
