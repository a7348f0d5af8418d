"""Launch's remaining actions, substitutions and handlers, told as what appears on the screen and reaches the nodes."""

from __future__ import annotations

import sys
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest
from launch_world import FakeWorld, launch, node, write, write_launch_file

from turtle_lesson.ros.launching.errors import LaunchError
from turtle_lesson.ros.launching.service import launch_file

START = "[INFO] [launch]: Default logging verbosity is set to INFO"


def screen(capsys: pytest.CaptureFixture[str]) -> list[str]:
    return [line for line in capsys.readouterr().out.splitlines() if line != START]


def said(capsys: pytest.CaptureFixture[str]) -> list[str]:
    """What LogInfo printed."""
    begin = "[INFO] [launch.user]: "
    return [line.removeprefix(begin) for line in screen(capsys) if line.startswith(begin)]


def test_a_line_may_have_pieces_and_any_characters(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    launch(tmp_path, "LogInfo(msg=['100', '% {x}']),")
    assert screen(capsys) == ["[INFO] [launch.user]: 100% {x}"]


@pytest.mark.parametrize(
    ("substitution", "text"),
    [
        ("PathJoinSubstitution([FindPackageShare('robot_controller'), 'launch', ['a', '.py']])", "launch/a.py"),
        ("PathJoinSubstitution(['a', 'b']) / LaunchConfiguration('x')", "a/b/1"),
        ("EqualsSubstitution(LaunchConfiguration('x'), 1)", "true"),
        ("NotEqualsSubstitution('a', 'b')", "true"),
        ("EqualsSubstitution('a', True)", "false"),
        ("NotSubstitution('false')", "true"),
        ("AndSubstitution('true', OrSubstitution('false', 'true'))", "true"),
        ("Command(['echo ', LaunchConfiguration('x')])", "1"),
        ("FindExecutable(name='ros2')", "ros2"),
        ("PythonExpression(['math.pi > ', LaunchConfiguration('x')])", "True"),
        ("PythonExpression(['sys.byteorder != \"\"'], ['sys'])", "True"),
        ("FindPackagePrefix('robot_controller')", "install/robot_controller"),
    ],
)
def test_substitutions(tmp_path: Path, capsys: pytest.CaptureFixture[str], substitution: str, text: str) -> None:
    launch(tmp_path, f"SetLaunchConfiguration('x', '1'), LogInfo(msg={substitution}),")
    line = said(capsys)[0]
    assert line.endswith(text) if "/" in text else line == text


def test_what_commands_print(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    write(tmp_path, "<robot/>", "robot.urdf")
    launch(
        tmp_path,
        "LogInfo(msg=Command(['cat ', ThisLaunchFileDir(), '/robot.urdf'])), "
        "LogInfo(msg=Command(['xacro ', ThisLaunchFileDir(), '/robot.urdf', ' name:=bob'])),",
    )
    assert said(capsys) == ["<robot/>", "<robot/>"]
    for action, reason in [
        (
            "LogInfo(msg=Command('rm -rf /')),",
            "executed command failed. Command: rm -rf /\nCaptured stderr output: 'rm' is a program of the",
        ),
        (
            "LogInfo(msg=Command('cat nope')),",
            "executed command failed. Command: cat nope\nCaptured stderr output: cat: nope: No such file",
        ),
        ("LogInfo(msg=Command('xacro ')),", "executed command failed. Command: xacro \nCaptured stderr output: cat: "),
    ]:
        with pytest.raises(LaunchError) as caught:
            launch(tmp_path, action)
        assert caught.value.reason.startswith(reason)


XACRO = """\
<robot xmlns:xacro="http://www.ros.org/wiki/xacro" name="r">
  <xacro:arg name="w" default="2"/>
  <xacro:macro name="wheel" params="n"><link name="${n}" w="$(arg w)"/></xacro:macro>
  <xacro:wheel n="left"/>
</robot>
"""
STAND_IN = """\
import sys

def main():
    if "nope" in sys.argv[1]:
        print("\\x1b[31merror: no such file\\x1b[0m", file=sys.stderr)
        sys.exit(2)
    print("made by", *sys.argv)
"""


def test_xacro_evaluates_macros_where_it_is_installed(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    stand_in = ModuleType("xacro")
    exec(STAND_IN, vars(stand_in))
    monkeypatch.setitem(sys.modules, "xacro", stand_in)
    write(tmp_path, XACRO, "robot.xacro")
    command = "Command([FindExecutable(name='xacro'), ' ', ThisLaunchFileDir(), '/robot.xacro w:=3'])"
    launch(tmp_path, f"LogInfo(msg={command}),")
    assert said(capsys)[0] == f"made by xacro {tmp_path}/robot.xacro w:=3"
    write(tmp_path, XACRO, "nope.xacro")
    with pytest.raises(LaunchError, match=r"Captured stderr output: error: no such file\n"):
        launch(tmp_path, "LogInfo(msg=Command(['xacro ', ThisLaunchFileDir(), '/nope.xacro'])),")


def test_what_needs_xacro_is_left_out_where_it_is_not_installed(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "xacro", None)
    write(tmp_path, XACRO, "robot.xacro")
    launch(tmp_path, "LogInfo(msg=Command(['xacro ', ThisLaunchFileDir(), '/robot.xacro'])), LogInfo(msg='the rest'),")
    lines = capsys.readouterr().out.splitlines()
    assert lines[-2].startswith(f"[WARNING] [launch]: an action that needs `xacro {tmp_path}/robot.xacro` is left out")
    assert lines[-2].endswith("is not installed: pip install xacro (in a notebook: %pip install xacro)")
    assert lines[-1].endswith("the rest")


def test_the_real_xacro(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    pytest.importorskip("xacro")
    write(tmp_path, XACRO, "robot.xacro")
    launch(tmp_path, "LogInfo(msg=Command(['xacro ', ThisLaunchFileDir(), '/robot.xacro w:=3'])),")
    assert '<link name="left" w="3"/>' in capsys.readouterr().out


def test_parameters_for_all_nodes(tmp_path: Path) -> None:
    setting = "SetParameter('depth', 3), SetUseSimTime(True), "
    world, _ = launch(tmp_path, setting + node(name="'one'") + node(name="'two'", parameters="[{'depth': 4}]"))
    shared = ["-p", "depth:=3", "-p", "use_sim_time:=true"]
    assert world.argv(0) == ["--ros-args", "-r", "__node:=one", *shared]
    assert world.argv(1) == ["--ros-args", "-r", "__node:=two", *shared, "-p", "depth:=4"]


def test_substitutions_within_a_parameter_file(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = write(tmp_path, "/**:\n  ros__parameters:\n    name: $(var who)\n", "p.yaml")
    world, _ = launch(
        tmp_path,
        "SetLaunchConfiguration('who', 'bob'),\n"
        + node(parameters=f"[ParameterFile({str(file)!r}, allow_substs=True)]"),
    )
    assert Path(world.argv()[-1]).read_text().endswith("name: bob\n")
    world.processes[0].end(1)
    assert "--ros-args --params-file launch_params/p.yaml'" in screen(capsys)[-1]


def test_what_all_programs_print_can_be_asked_for(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    world: Any = FakeWorld()
    launch_file(world, write_launch_file(tmp_path, node(output="'own_log'")), show_all_output=True)
    world.processes[0].stdout.write("hello\n")
    assert screen(capsys)[-1] == "[navigator-1] hello"


def test_a_description_can_be_emitted_as_an_event(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = write(
        tmp_path,
        """
        from launch import LaunchDescription
        from launch.actions import EmitEvent, LogInfo
        from launch.events import IncludeLaunchDescription

        def generate_launch_description():
            inner = LaunchDescription([LogInfo(msg='included')])
            return LaunchDescription([EmitEvent(event=IncludeLaunchDescription(inner))])
        """,
    )
    launch_file(FakeWorld(), file)
    assert said(capsys) == ["included"]


def test_the_end_of_a_timer_can_be_waited_for(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = write(
        tmp_path,
        """
        from launch import LaunchDescription
        from launch.actions import *
        from launch.event_handlers import OnExecutionComplete

        def generate_launch_description():
            timer = TimerAction(period=1.0, actions=[LogInfo(msg='tick')])
            return LaunchDescription([
                timer,
                RegisterEventHandler(OnExecutionComplete(target_action=timer, on_completion=[
                    LogInfo(msg='timer is done'), Shutdown(reason='done')])),
            ])
        """,
    )
    world: Any = FakeWorld()
    launch_file(world, file)
    world.run(2)
    assert said(capsys) == ["tick", "timer is done"]


def test_a_printed_line_is_heard_in_one_piece(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    heard = "lambda event: LogInfo(msg=repr(event.text))"
    world, _ = launch(tmp_path, f"RegisterEventHandler(OnProcessIO(on_stdout={heard}, on_stderr={heard})),\n" + node())
    process = world.processes[0]
    for text in ("one", "\n", "two\nthree", "\n", "rest"):
        process.stdout.write(text)
    process.stderr.write("wrong\n")
    process.end(0)
    world.run(0)
    assert said(capsys) == [r"b'one\n'", r"b'two\nthree\n'", r"b'wrong\n'", "b'rest'"]


def test_values_of_asked_for_types() -> None:
    from launch.utilities import value_in_text

    assert value_in_text("1.5", float) == 1.5
    assert value_in_text("yes", None) is True
    assert value_in_text("[1, 2]", list[int]) == [1, 2]
    assert value_in_text("[a, b]", list[str]) == ["a", "b"]
    assert value_in_text("$(var x)", float, can_be_str=True) == "$(var x)"
    for text, kind in (("maybe", bool), ("1.5", int), ("a", list[int]), ("[1, a]", list[int]), ("{a: 1}", None)):
        with pytest.raises(ValueError):
            value_in_text(text, kind)


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("again.launch.xml", "<launch><include file='$(dirname)/again.launch.xml'/></launch>"),
        ("again.launch.yaml", "launch: [{include: {file: $(filename)}}, {include: {file: $(filename)}}]"),
        (
            "again.launch.py",
            "from launch import *\nfrom launch.actions import *\n"
            "def generate_launch_description():\n"
            "    return LaunchDescription([IncludeLaunchDescription(__file__), IncludeLaunchDescription(__file__)])\n",
        ),
    ],
)
def test_a_file_that_includes_itself_is_stopped(tmp_path: Path, name: str, text: str) -> None:
    with pytest.raises(LaunchError) as caught:
        launch_file(FakeWorld(), write(tmp_path, text, name))
    assert caught.value.reason == "launch files include one another endlessly"
    assert caught.value.hint.startswith(f"{name} is included again and again")


@pytest.mark.parametrize(
    ("action", "reason", "hint"),
    [
        (
            "EmitEvent(event=Shutdown()),",
            "EmitEvent() expected an event instance, got '<launch.actions.shutdown_action.Shutdown object>'.",
            "Events are in launch.events",
        ),
        ("RegisterEventHandler(LogInfo(msg='x')),", "RegisterEventHandler expected an event handler", ""),
        ("LogInfo(msg=LocalSubstitution('event.pid')),", "'event.pid': context.locals does not contain", ""),
    ],
)
def test_mistakes_are_told_with_their_line(tmp_path: Path, action: str, reason: str, hint: str) -> None:
    with pytest.raises(LaunchError) as caught:
        launch(tmp_path, action)
    assert reason in caught.value.reason and hint in caught.value.hint
    assert caught.value.line == 14
