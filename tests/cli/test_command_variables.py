"""Environment variables in the terminal: set, shown, and found by the programs that are started after that."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from pathlib import Path
from unittest.mock import patch

import pytest
from launch_world import write

from turtle_lesson.ros.ament.package import Package
from turtle_lesson.ros.cli.cells import translate
from turtle_lesson.ros.cli.shell import run_line
from turtle_lesson.ros.runtime.world import World

Type = Callable[[str], tuple[int, str, str]]


@pytest.fixture
def type_line(world: World, capsys: pytest.CaptureFixture[str], tmp_path: Path) -> Iterator[Type]:
    """Types a line; returns the exit code, stdout and stderr."""
    program = write(tmp_path, "import os\nprint(os.environ.get('COLOUR'))\n", "show.py")
    world.packages.add(Package("demo", tmp_path, executables={"show": program}))

    def type_line(line: str) -> tuple[int, str, str]:
        code = run_line(world, line)
        world.sim.run_until(world.now + 100_000_000)
        return code, *capsys.readouterr()

    with patch.dict(os.environ, clear=True):
        yield type_line


def test_programs_find_what_was_exported(type_line: Type) -> None:
    assert type_line("export COLOUR='dark red' EMPTY=") == (0, "", "")
    assert type_line("ros2 run demo show")[1].startswith("dark red\n")
    assert type_line("printenv")[1].startswith("COLOUR=dark red\nEMPTY=\n")
    assert type_line("export") == type_line("printenv")
    assert type_line("printenv EMPTY COLOUR") == (0, "\ndark red\n", "")
    assert type_line("unset COLOUR NO_SUCH; printenv COLOUR") == (1, "", "")
    assert type_line("ros2 run demo show")[1].startswith("None\n")


def test_a_variable_before_a_command_is_set_for_it_alone(type_line: Type) -> None:
    assert type_line("COLOUR=blue ros2 run demo show")[1].startswith("blue\n")
    assert "COLOUR" not in os.environ
    assert "blue" in type_line("COLOUR=blue ros2 run demo show & ")[1], "also if it is started when the line is done"
    assert type_line("COLOUR=green") == (0, "", "")
    assert type_line("COLOUR=blue SHAPE=round printenv COLOUR SHAPE; printenv COLOUR")[1] == "blue\nround\ngreen\n"


def test_words_with_variables(type_line: Type) -> None:
    type_line("export NAME=turtle1 WIDE='a b' STAR='*'")
    assert type_line("echo $NAME /${NAME}/pose $NO_SUCH '$NAME' \\$NAME $WIDE x$NAME$STAR") == (
        0,
        "turtle1 /turtle1/pose $NAME $NAME a b xturtle1*\n",
        "",
    )
    assert type_line('echo "{$NAME: 5.0}"')[1] == "{$NAME: 5.0}\n"


@pytest.mark.parametrize("line", ["export 1x=2", "export a-b", "unset =", "export a = b"])
def test_names_that_are_none(type_line: Type, line: str) -> None:
    code, out, error = type_line(line)
    assert (code, out, error.count("\n")) == (1, "", 1)
    assert "is not the name of a variable" in error


@pytest.mark.parametrize(
    "line",
    [
        "export COLOUR=red",
        "RCUTILS_CONSOLE_OUTPUT_FORMAT='{name}: {message}' ros2 run demo show",
        "A=1 B=2 ros2 run demo show",
        "printenv COLOUR",
    ],
)
def test_such_lines_are_commands_in_a_cell(line: str) -> None:
    assert "terminal" in "".join(translate([line + "\n"]))


@pytest.mark.parametrize("line", ["a = ros2", "COLOUR = 'x ros2 run'", "x='a ros2 run'", "export = 1", "a=b=c"])
def test_such_lines_are_python(line: str) -> None:
    assert translate([line + "\n"]) == [line + "\n"]
