"""Threads that wait by doing nothing at all, round after round."""

from __future__ import annotations

import ast
import textwrap
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from turtle_lesson.ros.runtime.world import World
from turtle_lesson.ros.stdlib.deadlock import NAME, without_busy_loops

SECOND = 1_000_000_000
PROGRAM = """
import threading
import time

import rclpy
from std_msgs.msg import Int32

rclpy.init()
node = rclpy.create_node("ears")
heard = []
node.create_subscription(Int32, "number", lambda message: heard.append(message.data), 10)
publisher = node.create_publisher(Int32, "number", 10)
node.create_timer(0.5, lambda: publisher.publish(Int32(data=len(heard))))
threading.Thread(target=rclpy.spin, args=(node,), daemon=True).start()
{loop}
print("heard", heard, "at", round(time.time() % 1000, 2))
"""
LOOPS = {
    "pass": "while len(heard) < 3:\n    pass",
    "dots": "while len(heard) < 3: ...",
    "a comment's place": "while not heard[2:]:\n    'wait'\n    continue",
    "break": "while True:\n    if len(heard) == 3:\n        break\n    else:\n        pass",
    "return": "def wait():\n    while True:\n        if heard[2:]:\n            return\nwait()",
    "for ever": "threading.Timer(1.6, lambda: print('up')).start()\nwhile len(heard) < 3 and rclpy.ok():\n    pass",
}


@pytest.mark.parametrize("name", LOOPS)
def test_a_thread_looks_until_another_has_brought_it(
    world: World, tmp_path: Path, capsys: pytest.CaptureFixture[str], name: str
) -> None:
    (tmp_path / "ears.py").write_text(PROGRAM.format(loop=LOOPS[name]))
    world.spawn(tmp_path / "ears.py", name="ears")
    world.sim.run_until(2 * SECOND)
    assert capsys.readouterr().out.splitlines()[0] == "heard [0, 1, 2] at 1.5"


def test_a_busy_wait_by_the_clock_is_as_long_as_it_should_be(
    world: World, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    wait = "began = time.time()\nwhile time.time() - began < 0.75:\n    pass"
    (tmp_path / "ears.py").write_text(PROGRAM.format(loop=wait))
    world.spawn(tmp_path / "ears.py", name="ears")
    world.sim.run_until(2 * SECOND)
    assert capsys.readouterr().out.splitlines()[0] == "heard [0] at 0.75"


def test_the_line_that_is_to_blame_stays_the_same(
    world: World, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    text = "import threading\nthreading.Timer(9, print).start()\nvalues = [1, 2]\nwhile values.pop():\n    pass\n"
    (tmp_path / "pops.py").write_text(text)
    world.spawn(tmp_path / "pops.py", name="pops")
    world.sim.run_until(SECOND)
    said = capsys.readouterr().err
    assert "line 4, in <module>\n    while values.pop():" in said and "IndexError: pop from empty list" in said
    assert "another_look" not in said


@pytest.mark.parametrize(
    "before",
    [
        *("", "\ufeff", "x = 1\r", "x = 1\r\n", "x = \\\n1\n\f", "for x in y:\n pass\nelse:\n ", "with x:\n "),
        *("try:\n x\nfinally:\n ", "try:\n x\nexcept E:\n ", "match x:\n case 1:\n  ", "if x:\n y\nelif z:\n "),
        *("class A:\n def f(self):\n  async def g():\n   ", "while x:\n y\n ", "'while'\nif x:\n\t"),
    ],
)
def test_a_busy_loop_is_found_wherever_it_stands(before: str) -> None:
    tree = without_busy_loops(f"{before}while not x: pass\n".encode(), "x.py")
    assert ast.dump(tree).count(NAME) == 1


@pytest.mark.parametrize("loop", ["while work():\n    count += 1", "while True:\n    step()", "for x in y:\n    pass"])
def test_loops_that_do_something_are_left_alone(loop: str) -> None:
    assert without_busy_loops(loop, "x.py") is loop


@given(st.text(alphabet="while True:\n pas#'\"()0", max_size=40))
def test_what_cannot_be_compiled_says_so_as_ever(text: str) -> None:
    text = textwrap.dedent(text)

    def fault_of(source: object) -> str | None:
        try:
            compile(source, "x.py", "exec")  # type: ignore[call-overload]
        except (SyntaxError, ValueError) as error:
            return str(error)
        return None

    try:
        tree = without_busy_loops(text, "x.py")
    except (SyntaxError, ValueError) as error:
        assert str(error) == fault_of(text)
    else:
        assert fault_of(tree) == fault_of(text)
