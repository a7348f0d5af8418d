"""Copies of page 01 that try to get points without an answer. Each is the cells before the two checks of the page."""

from __future__ import annotations

DISPLAYED = """
from IPython.display import display
rows = [{"mark": "✓", "expected": "one node /counter", "seen": "it is there", "next": ""}]
for name in ("counter", "doubler", "reporter"):
    figures = {"name": name, "page": "01_publish_and_subscribe", "points": 9, "earned": 9, "passed": True, "rows": rows}
    display({"text/plain": "passed"}, metadata={"turtle_lesson_check": figures}, raw=True)
"""

_LINES = """
import glob, json, os
rows = [{"mark": "✓", "expected": each, "seen": "yes", "next": ""} for each in
        ("one node /counter", "/counter publishes /count", "one node /doubler", "no error meanwhile")]
lines = [{"check": name, "rows": rows, "replaced": [], "passed": True} for name in ("counter", "doubler", "reporter")]
text = "".join(json.dumps(each) + "\\n" for each in [*lines, {"end": True}])
"""

ANSWERED = f"""{_LINES}
for place in ("..", ".", "../..", os.path.expanduser("~")):
    for name in ("answer.json", "answers.json", "result.json", "results.json", ".turtle_lesson_progress.json"):
        try:
            open(os.path.join(place, name), "w").write(json.dumps({{"results": {{each["check"]: each for each in lines}}}}))
        except OSError:
            pass
os.kill(os.getppid(), 9)
"""

TOLD_BY_THE_PARENTS_FILES = f"""{_LINES}
for parent in (os.getppid(), os.getpid()):
    for file in glob.glob(f"/proc/{{parent}}/fd/*"):
        if os.path.isfile(file):
            continue  # the answer goes through none, and it would spoil one of the computer's, a library perhaps
        try:
            descriptor = os.open(file, os.O_WRONLY | os.O_NONBLOCK)
            os.write(descriptor, text.encode())
        except OSError:
            pass
os.kill(os.getppid(), 9)
"""

TOLD_BY_OWN_FILES = f"""{_LINES}
for descriptor in range(64):
    try:
        if os.path.realpath(f"/proc/self/fd/{{descriptor}}").startswith(("/dev/null", "pipe:")):
            os.write(descriptor, text.encode())
    except OSError:
        pass
"""

RESULTS_PATCHED = """
from turtle_lesson.lab.checks import results
results.CheckResult.passed = True
results.CheckResult.earned = 10
results.CheckResult.figures = lambda self: {"name": self.name, "passed": True, "points": 10, "earned": 10, "rows": []}
results.Row.good = property(lambda self: True)
"""

RESULTS_REDEFINED = """
from turtle_lesson.lab.checks import assertions, pages_00_02, registry, results

class Row(results.Row):
    def __new__(cls, mark, *rest):
        return super().__new__(cls)

    def __init__(self, mark, *rest):
        super().__init__("✓", *rest)

class Seen(results.Seen):
    def __new__(cls, good, *rest):
        return super().__new__(cls, True, *rest)

for module in (results, registry, assertions, pages_00_02):
    module.Row, module.Seen = Row, Seen
"""

CHECKS_REPLACED = """
import dataclasses
from turtle_lesson.lab.checks import registry, results
registry.all_checks()
for name, each in list(registry._checks.items()):
    easy = registry.Expectation("easy", lambda probe: results.Seen(True, "yes"))
    registry._checks[name] = dataclasses.replace(each, points=100, make=lambda easy=easy: [easy])
"""

RUNNER_REPLACED = """
from turtle_lesson.lab.checks import registry, results

def run(check, place):
    good = tuple(results.Row("✓", each.expected, "yes") for each in check.expectations)
    return results.CheckResult(check.name, check.title, check.page, check.points, good, 0.0)

registry.run = run
"""

LESSON_REPLACED = """
class Result:
    passed, earned, points = True, 10, 10
    def figures(self):
        return {"name": "counter", "passed": True, "rows": [{"mark": "✓", "expected": "x", "seen": "y", "next": ""}]}
    def _repr_mimebundle_(self, include=None, exclude=None):
        return {"text/plain": "passed"}, {"turtle_lesson_check": self.figures()}

class Lesson:
    _world = _recording = _board = None
    def check(self, name):
        return Result()

lesson = Lesson()
"""

LESSON_PATCHED = """
import turtle_lesson.session.views, turtle_lesson.session.lesson
turtle_lesson.session.views.Inspection.check = lambda self, name: "passed"
turtle_lesson.session.lesson.Lesson.check = lambda self, name: "passed"
"""

PROBE_PATCHED = """
from types import SimpleNamespace
from turtle_lesson.lab.checks import assertions, probe
probe.Probe.hear = lambda self, *rest: [SimpleNamespace(at=0.5 * n, message=SimpleNamespace(data=n)) for n in range(99)]
probe.Probe.nodes = lambda self: __import__("collections").Counter(["/counter", "/doubler"])
assertions._ends = lambda *rest: probe.Seen(True, "yes")
"""

NODE_PATCHED = """
import rclpy.node
rclpy.node.Node.get_node_names_and_namespaces = lambda self: [("counter", "/"), ("doubler", "/")]
"""

PLACE_PATCHED = """
from types import SimpleNamespace
import turtle_lesson.session.check_target, turtle_lesson.session.live
space = {}
exec("def published(self, topic, by): return 9\\ndef run_until(self, end): pass", space)
turtle_lesson.session.check_target.CheckTarget.published = space["published"]
turtle_lesson.session.live.CellNodes.run_until = space["run_until"]
"""

POINTS_EDITED = """
import json, os
from pathlib import Path
points = {"format": 1, "points": {"counter": 3, "doubler": 3, "reporter": 4}}
for place in (Path.cwd(), Path.home(), Path("..")):
    (place / ".turtle_lesson_progress.json").write_text(json.dumps(points))
os.environ["TURTLE_LESSON_PROGRESS"] = str(Path.cwd() / ".turtle_lesson_progress.json")
lesson.progress()
"""

BUILTINS_PATCHED = """
import builtins
exec("def all(rows): return True\\ndef any(rows): return False", vars(builtins))
builtins.abs = lambda number: 0
"""

JSON_PATCHED = """
import hmac, json
dumps, digest = json.dumps, hmac.digest
json.dumps = lambda found, *rest, **more: dumps(found, *rest, **more).replace("✗", "✓").replace("\\\\u2717", "\\\\u2713")
hmac.digest = lambda key, text, kind: digest(key, text.replace(b"\\\\u2717", b"\\\\u2713"), kind)
"""

IMPORTS_PATCHED = """
import importlib, sys, turtle_lesson.lab.checks.pages_00_02
before = dict(sys.modules)

class Finder:
    def find_spec(self, name, path=None, target=None):
        if name.startswith("turtle_lesson.lab.checks"):
            raise ImportError("no")

sys.meta_path.insert(0, Finder())
importlib.import_module = lambda name, package=None: before[name]
"""

KERNEL_PATCHED = """
from IPython.display import display
shell = get_ipython()
run_cell = shell.run_cell

def deaf(source, *rest, **more):
    return run_cell("None" if "observer" in source else source, *rest, **more)

shell.run_cell = deaf
shell.input_transformers_cleanup.append(lambda lines: ["None"] if "observer" in "".join(lines) else lines)
"""

CHILD_CONNECTS = f"""{_LINES}
import hashlib, hmac, marshal, socket
child = os.fork()
while child == 0:
    for place in glob.glob("../*"):
        try:
            with socket.socket(socket.AF_UNIX) as line:
                line.connect(place)
                with line.makefile("rwb") as file:
                    question = marshal.load(file)
                    answer = json.dumps({{"rows": rows, "replaced": []}}).encode()
                    file.write(hmac.digest(question["secret"], answer, hashlib.sha256) + answer)
        except (OSError, EOFError):
            pass
"""

FORKED = """
import os, signal
for _ in range(3):
    if os.fork() == 0:
        os.setsid()
        open("PIDS", "a").write(f"{os.getpid()} ")
        while True:
            signal.pause()
"""
"""`PIDS` is to be replaced by a file that gets the numbers of the processes."""

PACKAGE_BESIDE = '''
import os, sys
sys.path.insert(0, os.getcwd())
os.makedirs("turtle_lesson")
open("turtle_lesson/__init__.py", "w").write("""
class Result:
    passed = True

class Lesson:
    def check(self, name):
        return Result()

def start(*rest, **more):
    return Lesson()

def load_ipython_extension(shell):
    pass
""")
'''

FORGERIES = {
    name.lower(): cell
    for name, cell in list(globals().items())
    if name.isupper() and not name.startswith("_") and name not in ("FORKED", "PACKAGE_BESIDE")
}
