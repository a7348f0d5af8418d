"""`input()` and `sys.stdin` in programs: lines from a file, a pipe, `lesson.run(input=…)`, and the cell's own prompt."""

from __future__ import annotations

import io
import os
import signal
import sys
import threading
from collections.abc import Callable, Iterator
from pathlib import Path
from textwrap import dedent
from typing import Any

import kernels
import pytest
from jupyter_client.manager import start_new_kernel
from program_terminal import Terminal

from turtle_lesson import start

ASKER = """
x = float(input("x? "))
y = float(input("y? "))
print("sum", x + y)
"""
COMMANDER = """
import rclpy
from geometry_msgs.msg import Twist

rclpy.init()
node = rclpy.create_node("commander")
publisher = node.create_publisher(Twist, "/turtle1/cmd_vel", 10)
while True:
    try:
        speed = float(input("speed: "))
    except EOFError:
        break
    twist = Twist()
    twist.linear.x = speed
    publisher.publish(twist)
    print("at", node.get_clock().now().nanoseconds // 100_000_000 % 10_000)
"""
Type = Callable[..., list[str]]


@pytest.fixture
def type_lines(empty_terminal: Terminal) -> Type:
    """Writes program.py, and returns what is printed when lines are typed into the terminal beside it."""

    def type_lines(program: str, *lines: str, seconds: float = 0.0) -> list[str]:
        Path("program.py").write_text(dedent(program))
        return empty_terminal.say(*lines, seconds=seconds)

    return type_lines


@pytest.mark.parametrize(
    "line",
    [
        "echo -e '1\\n2.5' | python3 program.py",
        "python3 program.py < lines.txt",
        "cat lines.txt | python3 program.py",
    ],
)
def test_a_program_reads_a_pipe_or_a_file(type_lines: Type, line: str) -> None:
    Path("lines.txt").write_text("1\n2.5")
    assert type_lines(ASKER, line) == ["x? y? sum 3.5"]


def test_so_does_a_program_of_a_package(fresh_terminal: Terminal) -> None:
    fresh_terminal.say("ros2 pkg create --build-type ament_python --node-name asker asking")
    Path("asking/asking/asker.py").write_text(f"def main():{ASKER.replace(chr(10), chr(10) + '    ')}\n")
    fresh_terminal.say("colcon build && source install/setup.bash")
    assert fresh_terminal.say("echo -e '3\\n4' | ros2 run asking asker") == ["x? y? sum 7.0"]
    assert "EOFError: EOF when reading a line" in fresh_terminal.say("echo 3 | ros2 run asking asker")


def test_an_input_that_ends_raises_what_python_raises(type_lines: Type) -> None:
    printed = type_lines(ASKER, "echo 3 | python3 program.py")
    assert printed[-2:] == [
        "EOFError: EOF when reading a line",
        "The program asked for another line after it had read all of its input.",
    ]


def test_sys_stdin_is_a_text_stream(type_lines: Type) -> None:
    program = """
        import sys
        print(repr(sys.stdin.readline()), repr(sys.stdin.read(3)), sys.stdin.isatty())
        print([line.strip() for line in sys.stdin], repr(sys.stdin.readline()))
    """
    assert type_lines(program, "echo -en 'one\\ntwo\\nthree\\nfour' | python3 program.py") == [
        "'one\\n' 'two' False",
        "['', 'three', 'four'] ''",
    ]


def test_a_line_that_was_asked_for_in_vain_says_what_to_do(type_lines: Type, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "stdin", io.StringIO())
    printed = type_lines(ASKER, "python3 program.py")
    assert printed[-2] == "EOFError: EOF when reading a line"
    assert printed[-1].startswith(
        "Nobody is here to answer input(). Give the lines beforehand (lesson.run(5, input=['3'])"
    )


def test_lines_given_to_a_run_are_typed_for_the_programs_that_ask(capsys: Any, tmp_path: Path) -> None:
    lesson = start()
    path = tmp_path / "asker.py"
    path.write_text(f"import time\ntime.sleep(1)\n{ASKER}")
    for name in ("one", "two"):
        lesson._world.spawn(path, name=name)
    lesson.run(2, input=["1", "2", "3", "4"])
    assert capsys.readouterr().out.splitlines()[-6:] == ["x? 1", "y? 2", "sum 3.0", "x? 3", "y? 4", "sum 7.0"]
    with pytest.raises(TypeError, match="input must be lines of text"):
        lesson.run(1, input=[3])  # type: ignore[list-item]


def test_a_loop_that_asks_and_publishes_lets_the_robot_move(
    capsys: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    lesson = start()
    path = tmp_path / "commander.py"
    path.write_text(COMMANDER)
    monkeypatch.setattr(sys, "stdin", io.StringIO())
    process = lesson._world.spawn(path, name="commander")
    lesson.run(4, input=["1.0", "1.0", "-1.0"])
    printed = [line for line in capsys.readouterr().out.splitlines() if "turtlesim" not in line]
    assert printed == ["speed: 1.0", "at 0", "speed: 1.0", "at 10", "speed: -1.0", "at 20", "speed: "]
    assert process.exit_code == 0


# -- in a notebook -------------------------------------------------------------------------------------------------------

Ask = Callable[..., tuple[str, str, list[str]]]


@pytest.fixture(scope="module")
def ask(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Ask]:
    """Runs a cell in a kernel and answers its prompts; an answer of None presses the stop button instead.

    Returns what it printed, its error, and the prompts.
    """
    folder = tmp_path_factory.mktemp("notebook")
    (folder / "asker.py").write_text(ASKER)
    (folder / "commander.py").write_text(COMMANDER)
    manager, client = start_new_kernel(cwd=str(folder), kernel_name="python3")

    def ask(cell: str, *answers: str | None, prompts_shown: bool = True) -> tuple[str, str, list[str]]:
        said: dict[str, str] = {"out": "", "error": ""}
        prompts: list[str] = []
        waiting = list(answers)

        def hear(message: dict[str, Any]) -> None:
            content = message["content"]
            said["out"] += content.get("text", "")
            said["error"] += content.get("ename", "")

        def answer(message: dict[str, Any]) -> None:
            prompts.append(message["content"]["prompt"])
            given = waiting.pop(0)
            if given is None:
                threading.Timer(0.2, os.kill, [manager.provisioner.pid, signal.SIGINT]).start()
            else:
                client.input(given)

        client.execute_interactive(
            dedent(cell), output_hook=hear, stdin_hook=answer, timeout=540, allow_stdin=prompts_shown
        )
        return said["out"], said["error"], prompts

    root = str(Path(__file__).resolve().parents[2])
    ask(f"import sys; sys.path.insert(0, {root!r})")
    ask("%load_ext turtle_lesson\nfrom turtle_lesson import start\nlesson = start(seed=0)")
    yield ask
    kernels.end(manager, client)


def test_the_cell_asks_and_robot_time_stands_still(ask: Ask) -> None:
    ask("lesson = start(seed=0)\nlesson.run(1)")
    assert ask("python3 asker.py\nprint(lesson.now)", "1", "2") == ("sum 3.0\n1.0\n", "", ["x? ", "y? "])


def test_a_loop_goes_on_in_the_next_cell_and_the_stop_button_ends_it(ask: Ask) -> None:
    _, error, prompts = ask("lesson = start(seed=0)\npython3 commander.py", "1.0")
    assert (error, prompts) == ("", ["speed: "])
    out, error, prompts = ask("lesson.run(10)", "1.0", None)
    assert out.startswith("at 0\nat 10\n") and ("KeyboardInterrupt" in out, error) == (True, "KeyboardInterrupt")
    assert prompts == ["speed: ", "speed: "]
    assert ask("jobs\nlesson.run(2)\nprint(round(lesson.now))") == ("4\n", "", [])


def test_where_no_prompt_can_be_shown_the_input_has_ended(ask: Ask) -> None:
    out, error, prompts = ask("python3 asker.py", prompts_shown=False)
    assert (error, prompts) == ("", [])
    assert "EOFError: EOF when reading a line" in out and "Nobody is here to answer input()" in out


def test_in_live_mode_the_next_cell_that_lets_time_pass_asks(ask: Ask) -> None:
    ask(
        """
        from pathlib import Path
        Path("later.py").write_text("import time\\ntime.sleep(0.5)\\nprint('heard', input('then? '))")
        lesson = start(seed=0)
        python3 later.py
        lesson.play(10)
        import asyncio
        while lesson.now < 1: await asyncio.sleep(0.01)
        """
    )
    out, error, prompts = ask("lesson.pause()\nlesson.run(0.2)", "yes")
    assert (out, error, prompts) == ("heard yes\n", "", ["then? "])


def test_live_mode_cannot_ask(type_lines: Type, empty_terminal: Terminal, monkeypatch: pytest.MonkeyPatch) -> None:
    typed = empty_terminal.world.sim.keyboard
    typed.live = True
    assert type_lines("print('heard', input('then? '))", "python3 program.py", seconds=1) == [
        "program asks 'then?': to answer, run a cell such as lesson.run(1)."
    ]
    typed.live = False
    monkeypatch.setattr(sys, "stdin", io.StringIO("yes\n"))
    assert empty_terminal.say(seconds=1) == ["then? heard yes"]
