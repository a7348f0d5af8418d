"""Learners' copies of a page, made by hand: finished, half-finished, broken and never-ending."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path
from typing import Any

import nbformat
import pytest

from turtle_lesson.teaching import pages

PAGE = "01_publish_and_subscribe"
SET_UP = "%load_ext turtle_lesson\nfrom turtle_lesson import start\nlesson = start(seed=0)\nimport rclpy\nrclpy.init()"
COUNTER = """from std_msgs.msg import Int32
counter = rclpy.create_node("counter")
publisher = counter.create_publisher(Int32, "/count", 10)
number = 0
def count():
    global number
    number += 1
    publisher.publish(Int32(data=number))
timer = counter.create_timer(PERIOD, count)"""
DOUBLER = """from std_msgs.msg import Int32
doubler = rclpy.create_node("doubler")
doubled = doubler.create_publisher(Int32, "/doubled", 10)
def on_count(message):
    doubled.publish(Int32(data=2 * message.data))
subscription = doubler.create_subscription(Int32, "/count", on_count, 10)"""
RIGHT, TOO_SLOW = COUNTER.replace("PERIOD", "0.5"), COUNTER.replace("PERIOD", "1.0")
STUB = "# your node"
ENDLESS = "while True:\n    pass"
DEAF = "while True:\n    try:\n        while True:\n            pass\n    except KeyboardInterrupt:\n        pass"
ESCAPES = r"raise ValueError('\x1b[31mred\x1b]0;title\x07 \x9b2J\u202e<script>alert(1)</script>')"
MUCH_MEMORY = "bytearray(4_000_000_000)"
LARGE_FILE = "with open('large', 'wb') as file:\n    file.truncate(300_000_000)"
CURIOUS = """import os
seen = str(dict(os.environ)) + (open(f"/proc/{os.getppid()}/environ").read() if os.path.exists("/proc") else "")
assert "of-the-teacher" not in seen and "TEACHERS_TOKEN" not in seen and os.environ["HOME"] != "HOME_OF_TEACHER"
""".replace("HOME_OF_TEACHER", str(Path.home()))


def copy(counter: str, doubler: str, *more: str) -> Any:
    """A copy of the page with these answers in it, and perhaps more cells in front of them."""
    sources = [SET_UP, *more, counter, 'lesson.check("counter")', doubler, 'lesson.check("doubler")']
    cells = [nbformat.v4.new_code_cell(source) for source in sources]
    for cell in cells:
        if "lesson.check" in cell.source:
            cell.metadata["tags"] = ["check"]
    solution = nbformat.v4.new_code_cell(f"%%solution counter\n{RIGHT}", metadata={"tags": ["solution"]})
    notebook = nbformat.v4.new_notebook(cells=[*cells[:-2], solution, *cells[-2:]])
    notebook.metadata["turtle_lesson"] = {"page": PAGE}
    return notebook


def write(folder: Path, name: str, notebook: Any) -> Path:
    path = folder / f"{name}.ipynb"
    nbformat.write(notebook, path)
    return path


def publish(folder: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A checkout without version control in this folder, with one published page; returns the page."""
    published = folder / "checkout" / "notebooks"
    published.mkdir(parents=True)
    monkeypatch.setattr(pages, "CHECKOUT", published.parent)
    monkeypatch.setattr(pages, "PUBLISHED", published)
    return write(published, PAGE, was_run(copy(STUB, STUB)))


def commit() -> None:
    """Put the checkout's pages under version control, as they are now."""
    if shutil.which("git") is None:
        pytest.skip("there is no git here")
    git = ["git", "-C", str(pages.CHECKOUT), "-c", "user.name=a", "-c", "user.email=a@b.example"]
    for words in (["init", "-q"], ["add", "-f", "."], ["commit", "-q", "-m", "pages"]):
        subprocess.run([*git, *words], check=True)


def was_run(notebook: Any) -> Any:
    """The same notebook, with an output below each code cell."""
    for number, cell in enumerate(notebook.cells, start=1):
        if cell.cell_type == "code":
            cell.outputs = [nbformat.v4.new_output("stream", name="stdout", text="the answer\n")]
            cell.execution_count = number
    return notebook


def a_class(folder: Path) -> dict[str, tuple[int, str]]:
    """Copies in a folder; returns, by path in it, the points and what is said of a copy that is not run to its end."""
    expected: dict[str, tuple[int, str]] = {}

    def hand_in(name: str, points: int, notebook: Any, problem: str = "") -> None:
        (folder / name).parent.mkdir(exist_ok=True)
        write(folder, name, notebook)
        expected[name] = (points, problem)

    hand_in("anna/page_01", 6, copy(RIGHT, DOUBLER))
    hand_in("ben/page_01", 3, copy(RIGHT, STUB))
    hand_in("slow", 3, copy(TOO_SLOW, DOUBLER))
    hand_in("nothing", 0, copy(STUB, STUB))
    hand_in("typing_error", 3, copy("def (:", DOUBLER))
    hand_in("error_first", 6, copy(RIGHT, DOUBLER, "1 / 0", ESCAPES))
    hand_in("endless_cell", 6, copy(RIGHT, DOUBLER, ENDLESS))
    hand_in("flood", 6, copy(RIGHT, DOUBLER, "while True:\n    print('x' * 1000)"))
    hand_in("greedy", 6, copy(RIGHT, DOUBLER, MUCH_MEMORY, LARGE_FILE))
    hand_in("curious", 6, copy(RIGHT, DOUBLER, CURIOUS))
    hand_in("deaf_cell", 3, copy(RIGHT, DEAF), "was stopped")
    hand_in("dies", 3, copy(RIGHT, "import os; os._exit(3)"), "kernel died")
    (folder / "no_notebook.ipynb").write_text("this is no JSON")
    (folder / "binary.ipynb").write_bytes(bytes(range(256)))
    expected |= {"no_notebook": (0, "not a notebook"), "binary": (0, "not a notebook")}
    return expected
