"""The terminal: how a line becomes commands, what its own words do, and that nonsense is answered in a line or two."""

from __future__ import annotations

import gc
import re
from io import StringIO
from pathlib import Path

import pytest
from command_cases import FOLDER, check, type_in
from hypothesis import given
from hypothesis import strategies as some

from turtle_lesson.ros.cli.arguments import WIDTH
from turtle_lesson.ros.cli.jobs import CellErrors, Errors
from turtle_lesson.ros.cli.run_command import GROUPS, NOT_HERE, ROS2, run
from turtle_lesson.ros.cli.script import UnfinishedError, Word, command_end, tokens
from turtle_lesson.ros.cli.shell import run_line
from turtle_lesson.ros.cli.verb import Verb
from turtle_lesson.ros.runtime.world import World


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.fixture
def type_line(world: World, capsys: pytest.CaptureFixture[str]):  # type: ignore[no-untyped-def]
    """Types a line; returns the exit code, stdout and stderr."""

    def type_line(line: str) -> tuple[int, str, str]:
        code = run_line(world, line)
        return code, *capsys.readouterr()

    return type_line


# -- words -----------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("line", "words"),
    [
        ("a b  c", ["a", "b", "c"]),
        ("a 'b c' \"d e\"", ["a", "b c", "d e"]),
        (r"a\ b c", ["a b", "c"]),
        ("a 'b'\"c\"d", ["a", "bcd"]),
        ('"{x: 5.0}" \'{"a": 1}\'', ["{x: 5.0}", '{"a": 1}']),
        (r'"a \"b\" \n"', [r'a "b" \n']),
        (r"'a \'", ["a \\"]),
        ("a # b", ["a"]),
        ("a#b", ["a#b"]),
        ("a \\\n b", ["a", "b"]),
        ("'' a", ["", "a"]),
        ("$x ${y} {a,b} ~x", ["$x", "${y}", "{a,b}", "~x"]),
        ("é 😀", ["é", "😀"]),
    ],
)
def test_words(line: str, words: list[str]) -> None:
    assert [token.text for token in tokens(line)] == words


def test_signs_between_commands() -> None:
    found = [token for token in tokens("a&&b||c;d&e|f>g>>h\ni 2>j 2>&1") if isinstance(token, str)]
    assert found == ["&&", "||", ";", "&", "|", ">", ">>", "\n", "2>", "2>&1"]


@pytest.mark.parametrize(
    ("first", "second"),
    [
        ("'a", "b'"),
        ('"a', 'b"'),
        ("a \\", "b"),
        ("a 'b\n", "'"),
        ("a &&", "b"),
        ("a |", "b"),
        ("a |\n# or", "b"),
    ],
)
def test_what_goes_on_in_the_next_line(first: str, second: str) -> None:
    assert command_end(f"x\n{first}\n{second}\nc\n", 2) == len(f"x\n{first}\n{second}\n")


@pytest.mark.parametrize("line", ["'a", '"a', "a 'b\n"])
def test_what_is_never_closed(line: str) -> None:
    with pytest.raises(UnfinishedError, match="is never closed"):
        command_end(f"{line}\nc\n")


@given(some.text(max_size=60))
def test_any_text_is_taken_apart_or_refused(text: str) -> None:
    try:
        assert all(isinstance(token, Word | str) for token in tokens(text))
    except UnfinishedError as error:
        assert "\n" not in str(error).replace("\\n", "")


# -- lines -----------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("line", "out"),
    [
        ("echo a && echo b", "a\nb\n"),
        ("cat nope && echo b", ""),
        ("cat nope || echo b", "b\n"),
        ("cat nope; echo $?", "1\n"),
        ("echo a; echo b # c; d", "a\nb\n"),
        ("echo a\n\n# comment\necho b", "a\nb\n"),
        ("echo a &&\n echo b", "a\nb\n"),
        ("echo 'a\nb' | grep b", "b\n"),
        ("echo 'a\nb\nc' | grep -v b | wc -l", "2\n"),
        ("echo 'a\nb\nc' | head -n 2", "a\nb\n"),
        ("echo 'a\nb' > x.txt; head x.txt -n 1; head x.txt -1", "a\na\n"),
        ("echo -n a; echo -e 'b\\tc\\n-'", "ab\tc\n-\n"),
        ("echo a > in.txt; cat < in.txt; grep a <in.txt", "a\na\n"),
        ("echo a > x.txt; echo b >> x.txt; cat x.txt", "a\nb\n"),
        ("cat nope 2> x.txt; cat x.txt", "cat: nope: No such file or directory\n"),
        ("echo a > ~/x.txt; cat < ~/x.txt", "a\n"),
        ("mkdir d; export D=d; echo a > $D/x.txt; cat < ${D}/x.txt; unset D", "a\n"),
        ("echo a > '$D'; ls; cat < '$D'", "$D\na\n"),
        ("$NONE; echo $?", "0\n"),
        ("cat nope > x.txt 2>&1; cat x.txt", "cat: nope: No such file or directory\n"),
        ("touch b.msg a.msg c.srv; ls *.msg", "a.msg\nb.msg\n"),
        ("touch a.msg; echo *.nope 'a*' a*", "*.nope a* a.msg\n"),
        ("ros2 pkg list | grep -c ^", "0\n"),
        ("ros2 pkg list | grep turtlesim", "turtlesim\n"),
        ("echo a \\  \n  b", "a b\n"),
        ("echo a\tb", "a b\n"),
        ("mkdir a; touch a/x y; cp y a; cp -r a b; mv y z; ls a b z", "a:\nx\ny\nb:\nx\ny\nz\n"),
        ("mkdir -p a/b; touch c; rm -r a c; ls", ""),
        ("mkdir --parents a/b; ls; ls a", "a\nb\n"),
        ("mkdir a; rm a; rm -f nope; ls", "a\n"),
        ("mkdir a; cp a b; cp -r a a/b; mv a b; ls", "b\n"),
        ("", ""),
        ("# only a comment", ""),
    ],
)
def test_lines(type_line, line: str, out: str) -> None:  # type: ignore[no-untyped-def]
    assert type_line(line)[1] == out


def test_the_end_of_a_stretch_is_no_error(type_line, folder: Path) -> None:  # type: ignore[no-untyped-def]
    remark = "(stopped after 0.5 s of robot time; --for SECONDS makes it longer or shorter)\n"
    code, out, error = type_line("ros2 topic pub /x std_msgs/msg/Int32 --for 0.5")
    assert (code, out[-len(remark) :], error) == (2, remark, "")


@pytest.mark.parametrize("rest", ["> kept.txt", "| grep -c publishing"])
def test_what_is_handed_on_holds_no_remark(type_line, folder: Path, rest: str) -> None:  # type: ignore[no-untyped-def]
    _, out, error = type_line(f"ros2 topic pub /x std_msgs/msg/Int32 --for 0.5 {rest}; cat kept.txt 2> none.txt")
    assert "publish" in out or out == "1\n"
    assert "stopped after" not in out
    assert error.startswith("(stopped after 0.5 s")


@pytest.mark.parametrize(
    ("line", "text"),
    [
        ("rqt_graph", "rqt_graph: there are no windows here; lesson.plot_graph(), "),
        ("rviz2 -d x.rviz", "rviz2: there are no windows here; "),
        ("rosdep install --from-paths src -y", "rosdep: nothing needs to be installed here: "),
        ("sudo apt install ros-humble-desktop", "sudo: nothing needs to be installed here: "),
        ("sudo ros2 topic list", "sudo: ros2 needs no sudo, neither here nor on a robot."),
        ("python3 -m robot", "python3: python3 FILE runs a file, "),
        ("'print(1/2)'", "print(1/2): command not found. If it is Python"),
        (
            "nano x.py",
            "nano: no editor here: open the file in JupyterLab's list at the left, or begin a cell with %%writefile x.py.",
        ),
        ("code .", "code: no editor here: "),
        ("roscore", "roscore: ROS 2 needs none: "),
        ("rostopic echo /x", "rostopic: that is ROS 1; in ROS 2 it is ros2 topic echo /x."),
        ("catkin_make", "catkin_make: that is ROS 1; in ROS 2 it is colcon build."),
        ("git status", "git: not available in this simulated terminal; !git status runs it on your computer."),
        ("clear", "clear: JupyterLab's menu Edit clears the outputs of cells."),
        ("'!ros2' topic list", "ros2: the ! runs the command on your computer, which has no ros2; without the ! "),
    ],
)
def test_words_of_other_terminals_are_answered_with_what_to_do_here(type_line, line: str, text: str) -> None:  # type: ignore[no-untyped-def]
    code, out, error = type_line(line)
    assert (code, out) == (127, "")
    assert error.startswith(text)
    assert error.count("\n") == 1


def test_long_words_of_other_terminals_are_cut(type_line) -> None:  # type: ignore[no-untyped-def]
    assert len(type_line("git " + "x" * 10_000)[2]) < 400


@pytest.mark.parametrize(
    ("line", "text"),
    [
        ("ros2 'topic list", "syntax error: the quote ' before \"'topic list\" is never closed"),
        ("&& ros2", "syntax error: there is no command before '&&'"),
        ("ros2 pkg list |", "syntax error: there is no command after '|'"),
        ("ros2 pkg list &&", "syntax error: there is no command after '&&'"),
        ("ros2 pkg list >", "syntax error: '>' needs the name of a file"),
        ("cat <", "syntax error: '<' needs the name of a file"),
        ("cat < x", "cat: x: No such file or directory"),
        ("echo a > $NONE", "echo: $NONE: ambiguous redirect: it stands for 0 names, and one is needed"),
        ("touch a.x b.x; cat < *.x", "cat: *.x: ambiguous redirect: it stands for 2 names, and one is needed"),
        ("$NONE > no/where", "bash: no/where: No such file or directory"),
        ("ros topic list", "ros: command not found. Did you mean 'ros2'?"),
        (
            "frobnicate -x /",
            "frobnicate: command not found. This simulated terminal has ros2, colcon, source",
        ),
        ("print(5)", "print(5): command not found. If it is Python, write it on a line of its own"),
        ("rm -rf /", "rm: cannot remove '/': the current folder or the notebook's is in it"),
        ("rm -rf .", "rm: cannot remove '.': "),
        ("rm -r /usr/lib", "rm: cannot remove '/usr/lib': it is outside your folder ("),
        ("rm nope", "rm: cannot remove 'nope': No such file or directory"),
        ("rm", "rm: missing operand"),
        ("mv .. x", "mv: cannot move '..': "),
        ("cp nope x", "cp: cannot copy 'nope': No such file or directory"),
        ("cp a", "cp: missing operand; it is used as in cp old.py new.py"),
        ("mv nope x", "mv: cannot move 'nope': No such file or directory"),
        ("python3 file.py", "python3: file.py: No such file or directory"),
        ("./nope.py", "./nope.py: No such file or directory"),
        ("touch x; chmod +x x; ./x", "./x: only programs in Python run here: the first line"),
        ("cd nope", "cd: nope: No such file or directory"),
        ("cd a b", "cd: too many arguments"),
        ("mkdir", "mkdir: missing operand"),
        ("mkdir a/b", "mkdir: cannot create directory 'a/b': No such file or directory. mkdir -p also makes"),
        ("mkdir -q x", "mkdir: no option -q here; known: -p, -v"),
        ("mkdir --mode=755 x", "mkdir: no option --mode=755 here; known: -p, -v"),
        ("mkdir .", "mkdir: cannot create directory '.': File exists"),
        ("ls nope", "ls: cannot access 'nope': No such file or directory"),
        ("cat .", "cat: .: Is a directory"),
        ("cat 'a\0b'", "cat: "),
        ("echo a > no/where", "echo: no/where: No such file or directory"),
        ("kill", "kill: which one?"),
        ("kill 99999", "kill: 99999: no such job or process"),
        ("kill %4", "kill: %4: no such job or process"),
        ("kill %4 it", "kill: %4, it: no such job or process"),
        ("kill it", "kill: it: no such job or process"),
        ("kill -HUP 1", "kill: HUP: invalid signal specification"),
        ("grep", "grep: missing operand"),
        ("chmod 000 x", "chmod: here it makes files executable"),
        ("source", "bash: source: filename argument required"),
        ("source nope.bash", "bash: nope.bash: No such file or directory"),
        ("sleep", "sleep: how long?"),
        ("sleep soon", "sleep: how long?"),
    ],
)
def test_mistakes_get_a_line(type_line, line: str, text: str) -> None:  # type: ignore[no-untyped-def]
    code, out, error = type_line(line)
    assert code != 0
    assert out == ""
    assert error.startswith(text)
    assert error.count("\n") <= 2


def test_cd_goes_and_comes_back(type_line, folder: Path) -> None:  # type: ignore[no-untyped-def]
    assert type_line("mkdir -p a/b && cd a/b && pwd")[1] == f"{folder}/a/b\n"
    assert type_line("cd ..; pwd; cd; pwd")[1].splitlines() == [f"{folder}/a", str(folder)]


def test_a_folder_of_nearly_the_right_name_is_named(type_line) -> None:  # type: ignore[no-untyped-def]
    assert "Did you mean 'turtle_ws'?" in type_line("mkdir turtle_ws; cd turtel_ws")[2]


# -- programs by their name --------------------------------------------------------------------------------------------------


def test_a_program_is_run_by_its_first_line(type_line, world: World) -> None:  # type: ignore[no-untyped-def]
    Path("draw.py").write_text("#!/usr/bin/env python3\nimport sys\nprint(sys.argv[1:])\n")
    code, out, error = type_line("./draw.py circle")
    assert (code, out) == (1, "")
    assert error.startswith("./draw.py: Permission denied. Make it executable: chmod +x ./draw.py")
    type_line("chmod +x draw.py; ./draw.py circle")
    world.sim.run_until(1)
    assert type_line("./draw.py square")[1].startswith("['square']")


# -- ros2 ------------------------------------------------------------------------------------------------------------------


def test_wrong_usage_is_answered_as_recorded(world: World) -> None:
    check(world, "usage.txt")


def test_usage_lines_are_the_real_ones(world: World) -> None:
    for usage in (FOLDER / "usage_lines.txt").read_text(encoding="utf-8").split("\n\n")[1:]:
        command = " ".join(usage.partition("[-h]")[0].split()[1:])
        shown = type_in(world, f"{command} -h").stdout.split("\n\n")[0]
        assert shown == usage.rstrip(), command


def test_a_wrong_name_is_noticed_before_help_is_printed(world: World) -> None:
    for command in ("ros2 -h topc", "ros2 topic -h ech"):
        answer = type_in(world, command)
        assert (answer.stdout, answer.code) == ("", 2)
        assert "invalid choice" in answer.stderr


def test_help_lists_the_commands_and_the_verbs(world: World) -> None:
    for command in ("ros2", "ros2 -h", "ros2 --help"):
        answer = type_in(world, command)
        assert (answer.stdout, answer.stderr, answer.code) == (f"{ROS2.text}\n", "", 0)
    for group in GROUPS.values():
        answer = type_in(world, f"{group.prog} --help")
        assert (answer.stderr, answer.code) == ("", 0)
        if "" not in group.members:
            assert answer.stdout == f"{group.text}\n" == type_in(world, group.prog).stdout
            for name in group.members:
                assert f"\n  {name} " in answer.stdout


def test_every_verb_has_help_of_its_own(world: World) -> None:
    for group in GROUPS.values():
        for verb in group.members.values():
            assert isinstance(verb, Verb)
            answer = type_in(world, f"{verb.prog} -h")
            assert (answer.stderr, answer.code) == ("", 0)
            assert answer.stdout.startswith(f"usage: {verb.prog}")
            assert verb.help in " ".join(answer.stdout.split())
            assert all(action.help for action in verb.parser.actions), f"{verb.prog}: an argument without help"
            assert "--for" not in answer.stdout.split("\n\n")[0], "the usage line is the real tool's"
            assert all(len(line) <= WIDTH or "{" in line or line[:3] == "  -" for line in answer.stdout.splitlines())


def test_a_verb_that_is_missing_here_is_told_from_one_that_is_wrong(world: World) -> None:
    for name in NOT_HERE:
        answer = type_in(world, f"ros2 {name} list")
        assert answer.code == 2
        assert "A real ROS 2 has it." in answer.stderr
        assert answer.stderr.count("\n") == 1


@pytest.mark.parametrize(
    ("command", "hint"),
    [
        ("ros2 tpic list", "Did you mean 'topic'?"),
        ("ros2 node lst", "Did you mean 'list'?"),
        ("ros2 topic echo /x --feild y", "Did you mean '--field'?"),
        ("ros2 topic --include-hidden list", "Did you mean '--include-hidden-topics'?"),
        ("ros2 pkg create x --build-type ament_pythn", "Did you mean 'ament_python'?"),
        ("ros2 --hlp", "Did you mean '--help'?"),
    ],
)
def test_did_you_mean(world: World, command: str, hint: str) -> None:
    answer = type_in(world, command)
    assert answer.code == 2
    assert answer.stderr.splitlines()[-1] == hint


def test_a_flag_of_the_command_reaches_its_verbs(world: World) -> None:
    assert type_in(world, "ros2 topic --include-hidden-topics list").code == 0
    assert type_in(world, "ros2 topic list --include-hidden-topics").code == 0


def test_doctor_says_what_this_is_and_what_is_up(world: World) -> None:
    answer = type_in(world, "ros2 doctor")
    assert answer.code == 0
    assert answer.stdout.startswith("This is Turtle Lesson's simulation")
    assert answer.stdout.endswith("All 2 checks passed\n")


def test_doctor_finds_twins_and_lonely_topics(world: World) -> None:
    def talk() -> None:
        import rclpy
        from std_msgs.msg import String

        rclpy.init()
        node = rclpy.create_node("twin")
        node.create_publisher(String, "word", 1)
        rclpy.spin(node)

    for _ in range(2):
        world.spawn(talk, name="twin")
    world.sim.settle()
    answer = type_in(world, "ros2 doctor")
    assert answer.stdout.endswith("All 2 checks passed, with 2 warnings\n")
    assert answer.stderr.splitlines() == [
        "WARNING: 2 nodes share the name /twin",
        "WARNING: Publisher without subscriber detected on /word.",
    ]


def test_what_can_never_end_is_ended_and_explained(world: World, monkeypatch: pytest.MonkeyPatch) -> None:
    def wait(args: object) -> int:
        import rclpy

        rclpy.init(args=[])
        rclpy.spin(rclpy.create_node("_waits"))
        return 0

    monkeypatch.setitem(GROUPS["doctor"].members, "", Verb("doctor", "wait", (), wait))
    answer = type_in(world, "ros2 doctor")
    assert "ros2 doctor waits for something that can never happen" in answer.stderr
    assert answer.code == 2
    assert world.graph.nodes == []


def test_a_verb_that_breaks_is_one_line(world: World, monkeypatch: pytest.MonkeyPatch) -> None:
    def break_down(args: object) -> int:
        raise ZeroDivisionError("this is a bug")

    monkeypatch.setitem(GROUPS["doctor"].members, "", Verb("doctor", "break", (), break_down))
    answer = type_in(world, "ros2 doctor")
    assert (answer.stderr, answer.code) == ("ros2 doctor: ZeroDivisionError: this is a bug\n", 1)


# -- nonsense --------------------------------------------------------------------------------------------------------------

LONG = "x" * 10_000
JUNK = "\x00\x01\x1b[31m\x7f\ufffe\ud800"


def all_commands() -> list[list[str]]:
    found = []
    for name, group in GROUPS.items():
        found += [[name]] if "" in group.members else [[name], *([name, verb] for verb in group.members)]
    return found


@pytest.mark.parametrize("words", all_commands(), ids=" ".join)
@pytest.mark.parametrize("nonsense", [LONG, JUNK, "../../etc", "", "-", "--", "[" * 500, "%s{0}$(x)`y`", "a/b/c/d"])
def test_nonsense_is_answered_in_a_few_lines(world: World, words: list[str], nonsense: str) -> None:
    for count in (1, 3):
        before = world.now
        answer = _typed(world, ["ros2", *words, *[nonsense] * count])
        said = answer[1].splitlines()
        usage = next((place for place, line in enumerate(said) if ": error: " in line), 0)
        assert len(said) - usage <= 8, said
        assert all(len(line) < 2000 for line in said)
        assert "Traceback" not in answer[1] + answer[0]
        assert not re.search(r"[\x00\x01\x1b\x7f]", answer[1])
        assert world.now - before < 30e9


def _typed(world: World, words: list[str]) -> tuple[str, str, int]:
    from io import StringIO

    out, error = StringIO(), StringIO()
    code = run(world, words, stdout=out, stderr=error)
    return out.getvalue(), error.getvalue(), code


@given(some.text(max_size=200))
def test_any_line_is_answered(world: World, text: str) -> None:
    """Whatever stands behind ros2 on a line; signs that write files or start other commands are left out."""
    run_line(world, "ros2 " + re.sub(r"[>;&|\n]", "", text))


def test_a_commands_stderr_that_nobody_holds_any_more_leaves_the_cells_stream_alone() -> None:
    class Cell(StringIO):
        flushed = 0

        def flush(self) -> None:
            self.flushed += 1

    cell = Cell()
    for make in (lambda: CellErrors(cell, cell), lambda: Errors(cell), lambda: CellErrors(Errors(cell), cell)):
        make().flush()
    gc.collect()
    assert cell.flushed == 3
