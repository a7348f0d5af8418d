"""The kernel of `turtle-lesson open`, after a restart in the middle of a page: it says which cell to run first."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import kernels
import pytest
from jupyter_client.kernelspec import KernelSpecManager
from jupyter_client.manager import start_new_kernel

from turtle_lesson.teaching.main import JUPYTER

Ask = Callable[[str], tuple[str, str]]

HINT = "Run the set-up cell first: it is the page's first code cell, with %load_ext turtle_lesson, and no commands."
SET_UP = "%load_ext turtle_lesson\nfrom turtle_lesson import start\nlesson = start(seed=0)\n"


@pytest.fixture
def ask(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Ask]:
    """Runs a cell in a fresh kernel; returns what it printed or showed, and its error."""
    monkeypatch.setenv("JUPYTER_PATH", str(JUPYTER))
    monkeypatch.setenv("PYTHONPATH", str(Path(__file__).resolve().parents[2]), prepend=os.pathsep)
    manager, client = start_new_kernel(cwd=str(tmp_path), kernel_name="python3")

    def ask(cell: str) -> tuple[str, str]:
        said = {"out": "", "error": ""}

        def hear(message: dict[str, Any]) -> None:
            content = message["content"]
            said["out"] += content.get("text", "") + content.get("data", {}).get("text/plain", "")
            said["error"] += "\n".join(content.get("traceback", []))

        client.execute_interactive(cell, output_hook=hear, timeout=540, allow_stdin=False)
        return said["out"], said["error"]

    yield ask
    kernels.end(manager, client)


def test_it_takes_the_place_of_jupyters_own(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("JUPYTER_PATH", str(JUPYTER))
    spec = KernelSpecManager().get_kernel_spec("python3")
    assert Path(spec.resource_dir).is_relative_to(JUPYTER)
    assert spec.display_name == "Python 3 (ipykernel)", "the name that pages ask for"


def test_commands_and_names_of_the_lesson_say_which_cell_to_run(ask: Ask) -> None:
    for cell in (
        "ros2 topic list",
        "x = 1\nros2 topic list\n",
        "for topic in '/scan', '/pose':\n    ros2 topic info {topic}",
        "ros2 -h",
        "%ros2 node list",
        "cd workspace\ncolcon build\nsource install/setup.bash",
        "lesson.run(3)",
        "import rclpy",
        "from rclpy.node import Node",
        "start(seed=1)",
    ):
        out, error = ask(cell)
        assert HINT in out + error, cell
        assert "SyntaxError" not in error, cell
    ask(SET_UP)
    assert ask("ros2 node list") == ("/turtlesim\n", "")
    out, error = ask("lessn")
    assert "NameError" in error and HINT not in error


def test_what_is_not_the_lessons_is_as_ever(ask: Ask) -> None:
    assert ask("import sys\nsorted(n for n in sys.modules if n.startswith('turtle_lesson'))") == ("[]", "")
    assert ask("[name for name in dir() if name in ('watch', 'HINT', 'terminal', 're')]") == ("[]", "")
    assert ask("ros2, source = 7, 2\nros2 -source") == ("5", "")
    assert ask("%%writefile notes.txt\nros2 topic list\nlesson.run()") == ("Writing notes.txt\n", "")
    assert ask("ls")[0].strip() == "notes.txt"
    _, error = ask("lessons")
    assert "NameError" in error and HINT not in error
    _, error = ask("if True print(1)")
    assert "SyntaxError" in error and HINT not in error
