"""The modules of a program: `__main__`, those beside it and in its package are its own, as on a robot."""

from __future__ import annotations

import datetime
import importlib
import os
import subprocess
import sys
import textwrap
from collections.abc import Callable
from pathlib import Path

import pytest

from turtle_lesson.ros.ament.package import PythonProgram
from turtle_lesson.ros.runtime.world import World

Capture = pytest.CaptureFixture[str]
Write = Callable[[str, str], Path]
SECOND = 1_000_000_000


@pytest.fixture
def write(tmp_path: Path) -> Write:
    """Writes a file of the learner's."""

    def write(name: str, text: str) -> Path:
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(textwrap.dedent(text))
        return path

    return write


def outcome(world: World, capsys: Capture, *programs: Path | PythonProgram, seconds: int = 10) -> list[str]:
    """What programs print that run side by side."""
    processes = [
        world.spawn(program, name=f"p{number}", argv=["program", str(number)])
        for number, program in enumerate(programs)
    ]
    world.sim.run_until(world.now + seconds * SECOND)
    assert [process.exit_code for process in processes] == [0] * len(processes), capsys.readouterr().err
    return capsys.readouterr().out.splitlines()


def test_two_processes_of_one_program_share_no_variable(world: World, write: Write, capsys: Capture) -> None:
    write(
        "helper.py", "print('imported')\ncount = 0\ndef more():\n    global count\n    count += 1\n    return count\n"
    )
    program = write(
        "program.py",
        """
        import sys, time
        import helper
        for _ in range(3):
            print(sys.argv[1], helper.more())
            time.sleep(1)
        """,
    )
    assert outcome(world, capsys, program, program) == [
        "imported",
        "0 1",
        "imported",
        "1 1",
        *[f"{process} {count}" for count in (2, 3) for process in (0, 1)],
    ]


def test_what_they_import_later_is_their_own_too(world: World, write: Write, capsys: Capture) -> None:
    write("helper.py", "seen = []\n")
    program = write(
        "program.py",
        """
        import importlib, sys, time
        def look(number):
            import helper
            helper.seen.append(number)
            assert importlib.import_module("helper") is helper is sys.modules["helper"]
            return helper.seen
        for number in range(2):
            print(look(int(sys.argv[1]) * 10 + number))
            time.sleep(1)
        """,
    )
    assert outcome(world, capsys, program, program) == ["[0]", "[10]", "[0, 1]", "[10, 11]"]


def test_a_package_of_several_modules_is_each_processes_own(world: World, write: Write, capsys: Capture) -> None:
    write("pkgs/my_robot/__init__.py", "state = []\n")
    write(
        "pkgs/my_robot/parts/wheel.py",
        "from .. import state\ndef turn(n):\n    state.append(n)\n    return list(state)\n",
    )
    write(
        "pkgs/my_robot/main.py",
        """
        import sys, time
        from my_robot.parts import wheel
        import my_robot.parts.wheel as again
        def main():
            for number in range(2):
                print(wheel.turn(number), again is wheel, __name__)
                time.sleep(1)
        """,
    )
    folder = write("pkgs/notes.txt", "").parent
    run = PythonProgram(folder / "lib" / "my_robot" / "run", (folder,), "from my_robot.main import main\nmain()")
    lines = outcome(world, capsys, run, run)
    assert lines == ["[0] True my_robot.main"] * 2 + ["[0, 1] True my_robot.main"] * 2


def test_modules_that_let_time_pass_while_they_are_imported(world: World, write: Write, capsys: Capture) -> None:
    write("slow/__init__.py", "import time\nbegan = time.time()\ntime.sleep(0.5)\nfrom . import part\n")
    write("slow/part.py", "import time\ntime.sleep(0.5)\nnames = []\n")
    program = write(
        "program.py",
        """
        import sys, time
        time.sleep(float(sys.argv[1]) / 4)
        import slow.part
        slow.part.names.append(sys.argv[1])
        print(slow.part.names, slow.part is sys.modules["slow.part"], round(time.time() - slow.began, 3))
        """,
    )
    assert outcome(world, capsys, program, program, program) == [f"['{number}'] True 1.0" for number in range(3)]


def test_a_program_sees_its_modules_and_its_path_in_sys(world: World, write: Write, capsys: Capture) -> None:
    write(
        "shapes.py",
        "import sys\nclass Square: pass\ndef make(name):\n    return getattr(sys.modules[__name__], name)()\n",
    )
    program = write(
        "program.py",
        """
        import sys, time
        from sys import argv, path
        import shapes
        class Circle: pass
        time.sleep(1)
        print(type(shapes.make("Square")).__name__, sys.modules[__name__].Circle is Circle, "shapes" in sys.modules)
        print(argv is sys.argv, path is sys.path, sys.path[0] == __file__.rpartition("/")[0], sys.version_info[0])
        time.sleep(1)
        sys.path.clear()
        sys.argv = ["other"]
        time.sleep(1)
        print(sys.argv)
        """,
    )
    path, argv = list(sys.path), list(sys.argv)
    lines = outcome(world, capsys, program, program)
    assert lines == ["Square True True", "True True True 3"] * 2 + ["['other']"] * 2
    assert (sys.path, sys.argv) == (path, argv)


def test_a_program_may_write_somewhere_else(world: World, write: Write, capsys: Capture) -> None:
    program = write(
        "program.py",
        """
        import io, sys, time
        shown, sys.stdout = sys.stdout, io.StringIO()
        print("kept")
        time.sleep(1)
        print("too")
        kept, sys.stdout = sys.stdout.getvalue(), shown
        time.sleep(1)
        print(repr(kept))
        """,
    )
    assert outcome(world, capsys, program, program) == [repr("kept\ntoo\n")] * 2


def test_each_start_reads_the_files_anew(world: World, write: Write, capsys: Capture) -> None:
    program = write("program.py", "import helper\nprint(helper.answer)\n")
    for answer in "12":
        write("helper.py", f"answer = {answer}\n")
        assert outcome(world, capsys, program) == [answer]


def test_the_main_module_is_the_programs(world: World, write: Write, capsys: Capture) -> None:
    program = write(
        "program.py",
        """
        from __future__ import annotations
        import __main__, dataclasses, pickle, sys, time, typing

        @dataclasses.dataclass
        class Pose:
            x: float = 0.0
            scale: dataclasses.InitVar[float] = 1.0
            before: Pose | None = None

        if __name__ == "__main__":
            time.sleep(float(sys.argv[1]))
            print(__main__.Pose is Pose, pickle.loads(pickle.dumps(Pose(2.0))))
            print(typing.get_type_hints(Pose)["before"], __file__.endswith("program.py"), __spec__)
        """,
    )
    main = sys.modules["__main__"]
    lines = outcome(world, capsys, program, program)
    assert (
        lines == ["True Pose(x=2.0, before=None)", "__main__.Pose | None True None"] * 2
        or lines
        == [
            "True Pose(x=2.0, before=None)",
            "typing.Optional[__main__.Pose] True None",
        ]
        * 2
    )
    assert sys.modules["__main__"] is main


def test_annotations_are_evaluated_as_the_file_says(world: World, write: Write, capsys: Capture) -> None:
    program = write("program.py", "def f(x: 1 + 1): pass\nprint(f.__annotations__)\n")
    assert outcome(world, capsys, program) == ["{'x': 2}"]


def test_folders_that_a_program_adds_to_its_path_are_its_own(world: World, write: Write, capsys: Capture) -> None:
    write("tools/extra.py", "value = 5\n")
    program = write(
        "program.py",
        """
        import os, sys
        sys.path.append(os.path.join(os.path.dirname(__file__), "tools"))
        import extra
        print(extra.value)
        """,
    )
    before = list(sys.path)
    assert outcome(world, capsys, program) == ["5"]
    assert sys.path == before and "extra" not in sys.modules


def test_a_folder_of_helpers_needs_no_init_file(world: World, write: Write, capsys: Capture) -> None:
    write("helpers/maths.py", "def double(x):\n    return 2 * x\n")
    program = write("program.py", "from helpers.maths import double\nprint(double(4))\n")
    assert outcome(world, capsys, program, program) == ["8", "8"]


def test_a_mere_folder_hides_no_library(world: World, write: Write, capsys: Capture) -> None:
    write("std_msgs/notes.txt", "")
    write("launch/start.launch.py", "")
    program = write("program.py", "import launch\nfrom std_msgs.msg import String\nprint(String().data == '')\n")
    assert outcome(world, capsys, program) == ["True"]


def test_what_is_not_there_is_said_as_python_says_it(world: World, write: Write, capsys: Capture) -> None:
    world.spawn(write("program.py", "import helpr\n"), name="program")
    world.sim.run_until(SECOND)
    assert "ModuleNotFoundError: No module named 'helpr'" in capsys.readouterr().err.splitlines()


def test_an_error_in_a_helper_is_shown_at_its_line(world: World, write: Write, capsys: Capture) -> None:
    write("helper.py", "def fail():\n    return 1 / 0\n")
    world.spawn(write("program.py", "import helper\nhelper.fail()\n"), name="program")
    world.sim.run_until(SECOND)
    lines = capsys.readouterr().err.splitlines()
    assert "helper.py" in lines[-3] and lines[-2] == "    return 1 / 0"


def test_the_notebook_keeps_its_own_modules(
    world: World, write: Write, capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.syspath_prepend(write("helper.py", "count = 0\n").parent)
    mine = importlib.import_module("helper")
    mine.count = 100
    program = write(
        "program.py", "import helper, time\nhelper.count += 1\ntime.sleep(2)\nimport helper as h\nprint(h.count)\n"
    )
    world.spawn(program, name="program")
    world.sim.run_until(world.now + SECOND)
    assert sys.modules["helper"] is mine is importlib.import_module("helper")
    world.sim.run_until(world.now + 2 * SECOND)
    assert capsys.readouterr().out == "1\n" and mine.count == 100
    del sys.modules["helper"]


def test_nothing_is_left_behind(world: World, write: Write, capsys: Capture) -> None:
    write("helper.py", "")
    names, path, finders = set(sys.modules), list(sys.path), list(sys.meta_path)
    outcome(world, capsys, write("program.py", "import helper\n"))
    assert (set(sys.modules), list(sys.path), list(sys.meta_path)) == (names, path, finders)


def test_a_robots_calendar_shows_robot_time_in_utc(world: World, write: Write, capsys: Capture) -> None:
    program = write(
        "program.py",
        """
        import datetime, pickle, time
        from datetime import date, datetime as moment, timezone
        time.sleep(90)
        now = moment.now()
        print(now.replace(microsecond=0), moment.utcnow().minute, date.today(), moment.now(timezone.utc).tzname())
        print(isinstance(now, datetime.datetime), isinstance(date.today(), moment), issubclass(moment, date))
        print(round(now.timestamp() - time.time(), 3), pickle.loads(pickle.dumps(now)) == now)
        print(time.strftime("%H:%M"), time.ctime(), time.localtime().tm_hour, time.mktime(time.localtime()) - time.time() < 1)
        print(moment.fromtimestamp(0), repr(now - now), moment(2027, 1, 15) < now, moment.fromisoformat("2027-01-15"))
        """,
    )
    assert outcome(world, capsys, program, seconds=100) == [
        "2027-01-15 08:01:30 1 2027-01-15 UTC",
        "True False True",
        "-0.0 True",
        "08:01 Fri Jan 15 08:01:30 2027 8 True",
        "1970-01-01 00:00:00 datetime.timedelta(0) True 2027-01-15 00:00:00",
    ]
    assert datetime.datetime.now().year < 2100 and type(datetime.datetime.now()) is datetime.datetime


def test_environment_variables_are_each_processes_own(
    world: World, write: Write, capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("COLOUR", "red")
    program = write(
        "program.py",
        """
        import os, sys, time
        if sys.argv[1] == "0":
            os.environ["COLOUR"] = "blue"
            os.environ["SHAPE"] = "round"
            del os.environ["SHAPE"]
        time.sleep(1)
        print(sys.argv[1], os.getenv("COLOUR"), os.environ["COLOUR"], "SHAPE" in os.environ, dict(os.environ)["COLOUR"])
        try:
            del os.environ["SHAPE"]
        except KeyError as error:
            print(error)
        """,
    )
    assert outcome(world, capsys, program, program) == [
        "0 blue blue False blue",
        "'SHAPE'",
        "1 red red False red",
        "'SHAPE'",
    ]
    assert os.environ["COLOUR"] == "red"
    assert "COLOUR=red" in subprocess.run([sys.executable, "-c", ENVIRONMENT], capture_output=True, text=True).stdout


ENVIRONMENT = "import os; print(*(f'{name}={value}' for name, value in os.environ.items()))"
