"""Commands in a real Jupyter kernel: what the stop button ends, and that the rest of the cell does not go on."""

from __future__ import annotations

from collections.abc import Iterator

import kernels
import pytest
from kernels import Ask

SET_UP = ("%load_ext turtle_lesson\nfrom turtle_lesson import start\nlesson = start(seed=0)",)


@pytest.fixture(scope="module")
def ask(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Ask]:
    """Runs a cell in a kernel, stops it after some seconds if told so, and returns what it printed and its error."""
    folder = tmp_path_factory.mktemp("notebook")
    with kernels.running(folder, SET_UP, lambda content: "".join(content.get("traceback", []))) as ask:
        yield ask


def test_the_stop_button_ends_a_long_command_and_the_cell(ask: Ask) -> None:
    out, error = ask("ros2 topic hz /turtle1/pose --for 80000 > hz.txt; echo on\nprint('on')", stop_after=0.5)
    assert out == ""
    assert (
        error
        == "KeyboardInterrupt: ros2 topic hz /turtle1/pose --for 80000 was stopped, and no command after it was run"
    )
    assert ask("print(_exit_code)\nros2 node list") == ("2\n/turtlesim\n", "")


def test_so_it_does_in_live_mode(ask: Ask) -> None:
    ask("lesson.play(5.0)")
    out, error = ask("ros2 topic echo /turtle1/pose --field x\nprint('on')", stop_after=1.0)
    assert out.startswith("5.54")
    assert "on\n" not in out
    assert error.startswith("KeyboardInterrupt: ros2 topic echo /turtle1/pose --field x was stopped")
    assert ask("lesson.pause()\nros2 topic echo /turtle1/pose --field x --once") == ("5.544444561004639\n---\n", "")


def test_python_may_catch_it(ask: Ask) -> None:
    cell = "try:\n    ros2 topic hz /turtle1/pose --for 80000 > x\nexcept KeyboardInterrupt:\n    ros2 node list"
    assert ask(cell, stop_after=0.5) == ("/turtlesim\n", "")
