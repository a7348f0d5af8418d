"""Commands in cells: bare and as magics, among Python, in an IPython shell of the test's own."""

from __future__ import annotations

import sys
import traceback
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as some
from IPython.core.completer import provisionalcompleter
from IPython.core.interactiveshell import InteractiveShell
from traitlets.config import Config

from turtle_lesson import start
from turtle_lesson.ros.cli import terminal
from turtle_lesson.ros.cli.cells import COMMANDS, ELSEWHERE, UNSURE, advice, translate
from turtle_lesson.ros.cli.completion import complete
from turtle_lesson.ros.cli.shell import PROGRAMS
from turtle_lesson.ros.runtime import files
from turtle_lesson.ros.runtime.world import current_world

Run = Callable[..., str]


@pytest.fixture(scope="module")
def ipython() -> Iterator[InteractiveShell]:
    main = sys.modules["__main__"]
    shell = InteractiveShell(config=Config(HistoryManager={"enabled": False}))
    shell.colors = "nocolor"
    shell.run_line_magic("load_ext", "turtle_lesson")
    yield shell
    sys.modules["__main__"] = main  # IPython has put its own in its place


@pytest.fixture
def run(
    ipython: InteractiveShell, capsys: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: Any
) -> Iterator[Run]:
    """Runs a cell in a fresh world and returns what it printed."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(files, "_home", tmp_path)
    monkeypatch.setattr(files, "last_cd", None)
    with monkeypatch.context() as patch:
        patch.setattr("gc.collect", int)  # a full collection for each of 190 tests, which IPython itself doubts to need
        ipython.reset(new_session=False)
    ipython.user_ns["lesson"] = start(seed=0)
    capsys.readouterr()

    def run(cell: str, *, fails: bool = False) -> str:
        result = ipython.run_cell(cell)
        assert result.success != fails, capsys.readouterr()
        return capsys.readouterr().out

    yield run


TOPICS = "/parameter_events\n/rosout\n/turtle1/cmd_vel\n/turtle1/color_sensor\n/turtle1/pose\n"


def test_a_bare_command_prints_into_the_cell(run: Run, ipython: InteractiveShell) -> None:
    assert run("ros2 topic list") == TOPICS
    assert ipython.user_ns["_exit_code"] == 0


def test_so_does_a_magic(run: Run) -> None:
    assert run("%ros2 topic list") == TOPICS


def test_a_command_has_no_value(run: Run, ipython: InteractiveShell) -> None:
    assert ipython.run_cell("ros2 topic list").result is None


def test_several_commands_among_python_lines(run: Run) -> None:
    out = run(
        """
x = 1
ros2 node list
for number in range(2):
    if number == x:
        ros2 topic type /turtle1/pose   # only once
    else:
        print("zero")
print("end")
%ros2 node list
"""
    )
    assert out == "/turtlesim\nzero\nturtlesim/msg/Pose\nend\n/turtlesim\n"


def test_a_backslash_goes_on_in_the_next_line(run: Run) -> None:
    out = run('ros2 topic pub --once /turtle1/cmd_vel \\\n    geometry_msgs/msg/Twist "{linear: {x: 0.2}}"\nprint(5)')
    assert "Vector3(x=0.2, y=0.0, z=0.0)" in out
    assert out.endswith("\n5\n")


def test_so_does_an_open_quote(run: Run) -> None:
    out = run('ros2 topic pub --once /turtle1/cmd_vel geometry_msgs/msg/Twist "{\n  linear: {x: 0.3}\n}"')
    assert "Vector3(x=0.3, y=0.0, z=0.0)" in out


def test_braces_and_dollars_are_not_expanded(run: Run, ipython: InteractiveShell) -> None:
    ipython.user_ns["x"] = 7
    ipython.user_ns["data"] = "wrong"
    out = run("ros2 topic pub -t 1 -w 0 /word std_msgs/msg/String \"{data: '$x {x} {data} ${HOME}'}\"")
    assert "String(data='$x {x} {data} ${HOME}')" in out


def test_one_command_after_another_only_if_the_first_went_well(run: Run, ipython: InteractiveShell) -> None:
    assert run("ros2 topic type /nope && ros2 node list") == ""
    assert ipython.user_ns["_exit_code"] == 1
    assert run("ros2 topic type /nope || ros2 node list") == "/turtlesim\n"


def test_a_failing_command_prints_and_does_not_raise(
    run: Run, ipython: InteractiveShell, capsys: pytest.CaptureFixture[str]
) -> None:
    ipython.run_cell("ros2 interface show Nope\nprint('on')")
    out, error = capsys.readouterr()
    assert out == "on\n"
    assert error.startswith("Invalid name 'Nope'.")
    assert ipython.user_ns["_exit_code"] == 1


def test_an_ampersand_leaves_it_running(run: Run) -> None:
    assert run("ros2 topic hz /turtle1/pose &").startswith("[1] ")
    assert run("lesson.run(3)").count("average rate: 62.500") == 2
    assert "ros2 topic hz /turtle1/pose &" in run("jobs")
    assert run("kill -INT %1\njobs\nlesson.run(2)") == ""


def test_words_of_the_terminal_work_in_a_cell(run: Run, tmp_path: Path) -> None:
    assert run("mkdir -p ws/src\ncd ws\nls\npwd") == f"src\n{tmp_path / 'ws'}\n"
    assert Path.cwd() == tmp_path / "ws"
    assert run("cd ~\nls; pwd") == f"ws\n{tmp_path}\n"


def test_a_fresh_world_has_a_fresh_terminal(run: Run, tmp_path: Path) -> None:
    run("mkdir ws\ncd ws")
    run("from turtle_lesson import start\nlesson = start(seed=0)")
    assert Path.cwd() == tmp_path


def test_a_whole_cell_can_be_a_script(run: Run) -> None:
    assert (
        run("%%terminal\n# a comment\nros2 node list\n\necho 'it''s' done; ros2 node list | wc -l")
        == "/turtlesim\nits done\n1\n"
    )


def test_a_users_variable_wins(run: Run, ipython: InteractiveShell) -> None:
    ipython.user_ns["ros2"] = 5
    ipython.user_ns["h"] = 2
    assert run("ros2 -h").endswith("3\n")
    assert run("y = (\nros2 -h)\nprint(y)\nros2 node list") == "3\n/turtlesim\n"


def test_errors_name_the_line_that_was_typed(run: Run, ipython: InteractiveShell) -> None:
    result = ipython.run_cell("ros2 topic list \\\n  -t\n\n1 / 0")
    assert result.error_in_exec is not None
    assert [entry.lineno for entry in traceback.extract_tb(result.error_in_exec.__traceback__)][-1] == 4


def test_what_ipython_would_stumble_over(run: Run) -> None:
    out = run("ros2 interface show 'it''s' ?\n%pprint off\nx = 5\nros2 node list\n!!echo done\nx\n")
    assert out == "Pretty printing has been turned OFF\n/turtlesim\nOut[0]: 5\n" or "/turtlesim\n" in out


def test_single_words_are_commands_too(run: Run, tmp_path: Path) -> None:
    assert run("pwd") == f"{tmp_path}\n"
    assert run("mkdir a b\n") == ""
    assert run("ls | wc -l") == "2\n"


def test_commands_in_functions_loops_and_with(run: Run) -> None:
    cell = """
import contextlib, io
def look(times):
\tfor _ in range(times):
\t\tros2 node list
with contextlib.redirect_stdout(io.StringIO()) as kept:
\tlook(2)
print(repr(kept.getvalue()))
"""
    assert run(cell) == run(cell) == repr("/turtlesim\n" * 2) + "\n"


def test_words_of_other_terminals_in_a_cell(
    run: Run, ipython: InteractiveShell, capsys: pytest.CaptureFixture[str]
) -> None:
    for word in (
        "rviz2",
        "if True:\n    nano x.py",
        "ros topic list",
        "$ rqt_graph",
        "!ros2 topic list",
    ):
        ipython.run_cell(f"{word}\nprint('on')")
        out, error = capsys.readouterr()
        assert out == "on\n", word
        assert error.count("\n") == 1, word
        assert ipython.user_ns["_exit_code"] == 127


def test_a_real_ros2_on_the_computer_is_asked_with_the_exclamation_mark(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("shutil.which", lambda name: f"/opt/ros/humble/bin/{name}")
    assert translate(["!ros2 topic list\n"]) == ["!ros2 topic list\n"]


def test_other_cell_magics_keep_their_cells(run: Run) -> None:
    assert run("%%writefile x.txt\nros2 topic list\n") == "Writing x.txt\n"
    assert run("cat x.txt") == "ros2 topic list\n"
    run("%%capture out\nros2 node list")
    assert run("print(out.stdout)") == "/turtlesim\n\n"


def test_loading_it_twice_changes_nothing(run: Run, ipython: InteractiveShell) -> None:
    count = len(ipython.input_transformer_manager.line_transforms), len(ipython.Completer.custom_matchers)
    run("%reload_ext turtle_lesson")
    assert (len(ipython.input_transformer_manager.line_transforms), len(ipython.Completer.custom_matchers)) == count
    assert run("ros2 node list") == "/turtlesim\n"


# -- the lesson ------------------------------------------------------------------------------------------------------------


def test_the_commands_of_the_lesson_build_its_package_as_typed(run: Run, ipython: InteractiveShell) -> None:
    run("from turtle_lesson import start\nlesson = start(seed=0, package=None)")
    out = run("mkdir -p turtle_ws/src\ncd turtle_ws/src\nros2 pkg create robot_controller --build-type ament_cmake")
    assert out.startswith("going to create a new package\npackage name: robot_controller\n")
    run("mkdir -p robot_controller/msg robot_controller/srv")
    out = run("cd ~/turtle_ws\ncolcon build --packages-select robot_controller\nsource install/setup.bash")
    assert "Finished <<< robot_controller" in out
    assert run("ros2 pkg prefix robot_controller") == "install/robot_controller\n"


@pytest.mark.parametrize(
    ("command", "code", "beginning"),
    [
        ("ros2 run turtlesim turtlesim_node", 0, "[INFO] [18000000"),
        (
            'ros2 service call /navigate_to robot_controller/srv/NavigateTo "{x: 5.0, y: 5.0, theta: 0.0}"',
            0,
            "requester: ",
        ),
        ("ros2 topic echo /robot/status", 2, "x: 5.54"),
        ("ros2 topic echo /obstacles", 2, "header:\n  stamp:\n"),
        ("ros2 node list", 0, "/navigator\n/obstacle_detector\n/status_monitor\n/turtlesim\n"),
        ("ros2 topic list", 0, "/obstacles\n"),
        ("ros2 service list", 0, "/clear\n"),
        ('ros2 topic pub /turtle1/cmd_vel geometry_msgs/Twist "{linear: {x: 0.2}}"', 2, "publisher: beginning loop\n"),
    ],
)
def test_the_commands_of_the_lesson_run_as_typed(
    run: Run, ipython: InteractiveShell, command: str, code: int, beginning: str
) -> None:
    started = run("ros2 launch robot_controller start_system.launch.py")
    assert "[INFO] [obstacle_detector-3]: process started with pid" in started
    assert run(command).startswith(beginning)
    assert ipython.user_ns["_exit_code"] == code


# -- which lines are commands ----------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "line",
    [
        "ros2",
        "ros2 -h",
        "ros2 topic list",
        "%ros2 topic list",
        "ros2 topic pub /x std_msgs/String \"{data: 'it'}\"",
        'ros2 service call /x y/Z "{a: don\'t}"',
        "colcon build",
        "colcon build --packages-select x && source install/setup.bash",
        "source install/setup.bash",
        "source /opt/ros/humble/setup.bash",
        ". install/setup.bash",
        "mkdir -p a/b",
        "cd ..",
        "cd",
        "cd /tmp",
        "kill -INT %1",
        "ros2 param set /n p '[1, 2'  # a comment",
        "$ ros2 topic list",
        "ros2\ttopic list",
        "echo 'hello' > a.txt",
        "rm -r build install log",
        "chmod +x file.py",
        "./file.py",
        "./demo/run.sh --fast",
        "../run.sh",
        "sh run.sh",
        "sleep 2",
        "sudo apt install x",
        "rviz2",
        "rso2 topic list",
        "Ros2 topic list",
        "colon build",
    ],
)
def test_these_are_commands(line: str) -> None:
    assert translate([f"{line}\n"]) != [f"{line}\n"]
    assert translate(["if x:\n", f"    {line}\n"])[1].startswith("    get_ipython()")


@pytest.mark.parametrize(
    "cell",
    [
        "ros2 = 5",
        "ros2.topic('list')",
        "ros2['topic']",
        "source(1)",
        "source: int = 5",
        "source += 1",
        "source, sink = 1, 2",
        "cd == 3",
        "ros2_topic list",
        "...",
        "(x\n . real)",
        "x = '''\nros2 topic list\n'''",
        "x = [\nros2\n]",
        "f(a,\n  source - 1)",
        "x = 1 + \\\ncd",
        "code = 5\ncode",
        "code",
        "date - 1",
        "find",
        "clear()",
        "clear.all",
        "clear = 1\nclear",
        "def f(clear):\n    clear\n",
        "if (clear := 1):\n    clear\n",
        "rm = 1; rm - 1",
        "code, x = 1, 2",
        "code = !ls",
        "code = %time 1",
        "echo: int = 5",
        "x = {ros2: cd}",
        "x[1: cd]",
        "f(lambda: cd)",
        "x: cd",
        "y: 'ros2 topic list' = 1; x = 1",
        "if x: cd = 1; source = 2",
        "else: x",
        "!ls; cd x",
        "x = !ls; cd x",
        "%time 1; cd x",
        "ros2?",
        "%ros2?",
        "git?",
        "rosy = 1; rosy",
        "print ros2",
        "y = ros2 topic list",
        "# ros2 topic list",
        "print('ros2 topic list')",
        "def f(source):\n    source / 2\n    return source",
        "for cd in x:\n    cd - 1",
        'x = f"{a["b"]}" + """\nros2 topic list # " \\"""\nros2 node list\n"""',
    ],
)
def test_these_are_python(cell: str) -> None:
    lines = cell.splitlines(keepends=True)
    assert translate(lines) == lines


def test_python_that_could_be_a_command_is_python_if_the_name_is_a_variable() -> None:
    assert translate(["source / opt\n"], {"source"}) == ["source / opt\n"]
    assert translate(["source = 1\n", "source / opt\n"])[1] == "source / opt\n"
    assert translate(["source / opt\n"], set()) != ["source / opt\n"]


def work_of(lines: list[str]) -> int:
    """How many lines are run and functions called to translate these lines."""
    work = 0

    def count(frame: object, event: str, argument: object) -> Any:
        nonlocal work
        work += event in ("line", "call", "c_call")
        return count

    before = sys.getprofile(), sys.gettrace()
    sys.setprofile(count)
    sys.settrace(count)
    try:
        translate(lines)
    finally:
        sys.setprofile(before[0])
        sys.settrace(before[1])
    return work


ENDLESS = [
    "ros2 topic list \\",
    "echo \\",
    "x = 1 + \\",
    "foo(",
    "foo(bar,",
    "x = [",
    "ls -1",
    "echo (",
    "echo it's",
    "echo '",
    'ls \\"""',
    '\\"""',
    'x = """ ' + "'''",
    "x''' (",
    "a'\\",
    "def f(ls",
    "ls, x",
    "%time \\",
]


@pytest.mark.parametrize("line", ENDLESS)
def test_twice_as_many_lines_are_at_most_twice_the_work(line: str) -> None:
    """Lines that go on to the cell's end, or whose brackets and quotes are never closed, are not read again and again."""
    lines = [f"{line}\n"] * 200
    assert work_of(2 * lines) < 2.2 * work_of(lines)


def test_what_is_never_closed_takes_the_rest_of_the_cell() -> None:
    lines = ["x = (\n", "ls -1\n", "z = 1\n", "ros2 node list\n"]
    assert translate(lines) == lines, "Python tells which bracket was never closed"
    lines = ["y = [\n", "ls -1\n", "]\n", "ls -1\n"]
    assert [line.startswith("get_ipython()") for line in translate(lines)] == [False] * 3 + [True]


def test_a_command_that_ends_in_a_backslash_is_one_command() -> None:
    """It is refused once, with all its lines, not once for each."""
    translated = translate(["ros2 topic pub /t \\\n", "  std_msgs/String \\\n"])
    assert translated[0].count("std_msgs/String") == 1
    assert translated[1:] == ["\n"]


@given(some.lists(some.text(alphabet="ros2 cd\\\"'#()[]{}&|;=:\n\tx5%!é\x00"), max_size=6))
def test_whatever_a_cell_holds_its_lines_keep_their_number(parts: list[str]) -> None:
    lines = "\nros2 ".join(parts).splitlines(keepends=True)
    assert len(translate(lines)) == len(lines)


# -- completion ------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("line", "word"),
    [
        ("ros2 to", "topic"),
        ("ros2 topic ec", "echo"),
        ("ros2 topic echo /turtle1/p", "/turtle1/pose"),
        ("ros2 node info /", "/turtlesim"),
        ("ros2 service call /spa", "/spawn"),
        ("ros2 service call /spawn ", "turtlesim/srv/Spawn"),
        ("ros2 topic pub /turtle1/cmd_vel ", "geometry_msgs/msg/Twist"),
        ("ros2 topic pub /new std_msgs/msg/Str", "std_msgs/msg/String"),
        ("ros2 topic pub /new geometry_msgs/msg/Vector3 ", '"{x: 0.0, y: 0.0, z: 0.0}"'),
        ("ros2 service call /spawn turtlesim/srv/Spawn ", "\"{x: 0.0, y: 0.0, theta: 0.0, name: ''}\""),
        ("ros2 interface show std_m", "std_msgs/msg/String"),
        ("ros2 pkg executables turtles", "turtlesim"),
        ("ros2 pkg create x --build-type ", "ament_python"),
        ("ros2 run ", "robot_controller"),
        ("ros2 run robot_controller nav", "navigator"),
        ("ros2 launch robot_controller ", "start_system.launch.py"),
        ("ros2 topic echo --fie", "--field"),
        ("ros2 topic list && ros2 no", "node"),
        ("colcon b", "build"),
        ("ros2 param get /turtlesim back", "background_b"),
        ("ros2 param get turtlesim background_", "background_g"),
        ("ros2 param set /turtlesim ", "background_r"),
        ("ros2 param describe /turtlesim background_b ", "background_g"),
        ("ros2 bag record ", "/turtle1/pose"),
        ("ros2 bag record -s ", "sqlite3"),
        ("ros2 service find turtlesim/srv/Sp", "turtlesim/srv/Spawn"),
    ],
)
def test_tab_offers(run: Run, ipython: InteractiveShell, line: str, word: str) -> None:
    assert word in complete(current_world(), line)
    for typed in (line, f"x = 1\n{line}"):
        with provisionalcompleter():
            offered = list(ipython.Completer.completions(typed, len(typed)))
        assert word in [each.text for each in offered]


def test_tab_completes_paths(run: Run, tmp_path: Path) -> None:
    (tmp_path / "install").mkdir()
    (tmp_path / "install" / "setup.bash").touch()
    assert complete(current_world(), "source ins") == ["install/"]
    assert complete(current_world(), "source install/s") == ["install/setup.bash"]


@pytest.mark.parametrize(
    ("typed", "word"),
    [
        ("ros2 node info \\\n    /tur", "/turtlesim"),
        ("if x:\n    ros2 topic e", "echo"),
        ("%ros2 topic e", "echo"),
        ("%terminal ros2 topic e", "echo"),
    ],
)
def test_tab_offers_wherever_a_command_may_stand(run: Run, ipython: InteractiveShell, typed: str, word: str) -> None:
    with provisionalcompleter():
        assert word in [each.text for each in ipython.Completer.completions(typed, len(typed))]


def test_tab_completes_files_where_a_command_wants_one(run: Run, tmp_path: Path) -> None:
    (tmp_path / "a_bag").mkdir()
    (tmp_path / "a.yaml").touch()
    for command in ("ros2 bag play ", "ros2 bag info ", "ros2 param load /turtlesim ", "cat ", "source "):
        assert {"a_bag/", "a.yaml"} <= {*complete(current_world(), command)}, command
    for command in ("cd ", "ros2 param dump /turtlesim --output-dir "):
        assert complete(current_world(), command) == ["a_bag/"]
    assert complete(current_world(), "ros2 bag play a_") == ["a_bag/"]
    assert complete(current_world(), "cat no/where") == complete(current_world(), "cat 'a b\0/") == []


def test_tab_lets_no_time_pass(run: Run) -> None:
    before = current_world().now
    assert complete(current_world(), "ros2 param get /turtlesim ")
    assert current_world().now == before


@pytest.mark.parametrize(
    "line", ["ros2 nope ", "ros2 topic nope ", 'ros2 "', "ros2 topic echo /x y z q ", "x = ros2 ", ""]
)
def test_tab_offers_nothing_where_nothing_fits(run: Run, line: str) -> None:
    assert not [word for word in complete(current_world(), line) if not word.startswith("-")]


def test_tab_leaves_python_alone(run: Run, ipython: InteractiveShell) -> None:
    ipython.user_ns["source_of_light"] = 1
    with provisionalcompleter():
        offered = [each.text for each in ipython.Completer.completions("source_of", 9)]
    assert "source_of_light" in offered


def test_every_word_that_may_be_typed_bare_is_known_to_the_terminal(run: Run) -> None:
    assert {*COMMANDS, *UNSURE} <= {*PROGRAMS, *terminal.BUILTINS, *ELSEWHERE}
    assert {*PROGRAMS, *terminal.BUILTINS} <= {*COMMANDS, *UNSURE, "."}
    assert all(advice([word]) for word in ELSEWHERE)
    assert not ELSEWHERE & {*PROGRAMS, *terminal.BUILTINS}
