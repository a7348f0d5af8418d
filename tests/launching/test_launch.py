"""Launching, told as what appears on the screen and which arguments reach the nodes."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st
from launch_world import FakeWorld, launch, node, write, write_launch_file

from turtle_lesson.ros.launching.service import launch_description, launch_file, show_arguments

LESSON = """
from launch import LaunchDescription
from launch_ros.actions import Node

def generate_launch_description():
    return LaunchDescription([
        Node(package='robot_controller', executable='navigator', name='navigator', output='screen',
             parameters=[{'goal_timeout': 5.0}]),
        Node(package='robot_controller', executable='status_monitor', name='status_monitor', output='screen',
             parameters=[{'publish_rate': 10}]),
        Node(package='robot_controller', executable='obstacle_detector', name='obstacle_detector',
             output='screen', parameters=[{'scan_rate': 5}]),
    ])
"""
START = "[INFO] [launch]: Default logging verbosity is set to INFO"
LIBEXEC = "install/robot_controller/lib/robot_controller"


def screen(capsys: pytest.CaptureFixture[str]) -> list[str]:
    """What was printed since the last time, without launch's first line."""
    lines = capsys.readouterr().out.splitlines()
    return [line for line in lines if line != START]


# -- the lesson's own file --------------------------------------------------------------------------------


def test_the_lessons_file_starts_three_nodes_as_on_a_terminal(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    world = FakeWorld()
    handle = launch_file(world, write(tmp_path, LESSON))
    assert capsys.readouterr().out.splitlines() == [
        START,
        "[INFO] [navigator-1]: process started with pid [1001]",
        "[INFO] [status_monitor-2]: process started with pid [1002]",
        "[INFO] [obstacle_detector-3]: process started with pid [1003]",
    ]
    assert [process.argv[1:] for process in world.processes] == [
        ["--ros-args", "-r", "__node:=navigator", "-p", "goal_timeout:=5.0"],
        ["--ros-args", "-r", "__node:=status_monitor", "-p", "publish_rate:=10"],
        ["--ros-args", "-r", "__node:=obstacle_detector", "-p", "scan_rate:=5"],
    ]
    assert Path(world.processes[0].target).as_posix() == f"{LIBEXEC}/navigator"
    assert handle.running
    assert [each.name for each in handle._service.processes] == [
        "navigator-1",
        "status_monitor-2",
        "obstacle_detector-3",
    ]


def test_ctrl_c_ends_all_of_them_and_says_how_they_died(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    world = FakeWorld()
    handle = launch_file(world, write(tmp_path, LESSON))
    capsys.readouterr()
    handle.stop()
    assert screen(capsys) == [
        "[WARNING] [launch]: user interrupted with ctrl-c (SIGINT)",
        "[navigator-1] KeyboardInterrupt",
        "[status_monitor-2] KeyboardInterrupt",
        "[obstacle_detector-3] KeyboardInterrupt",
        "[ERROR] [navigator-1]: process has died [pid 1001, exit code -2, cmd "
        f"'{LIBEXEC}/navigator --ros-args -r __node:=navigator -p goal_timeout:=5.0'].",
        "[ERROR] [status_monitor-2]: process has died [pid 1002, exit code -2, cmd "
        f"'{LIBEXEC}/status_monitor --ros-args -r __node:=status_monitor -p publish_rate:=10'].",
        "[ERROR] [obstacle_detector-3]: process has died [pid 1003, exit code -2, cmd "
        f"'{LIBEXEC}/obstacle_detector --ros-args -r __node:=obstacle_detector -p scan_rate:=5'].",
    ]
    assert not handle.running
    handle.stop()
    assert screen(capsys) == []


def test_a_node_that_ignores_sigint_is_terminated_after_five_seconds(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    world, handle = launch(tmp_path, node())
    world.processes[0].stubborn = True
    handle.stop()
    capsys.readouterr()
    world.run(4.9)
    assert screen(capsys) == []
    world.run(0.2)
    assert screen(capsys) == [
        "[ERROR] [navigator-1]: process[navigator-1] failed to terminate '5' seconds after receiving "
        "'SIGINT', escalating to 'SIGTERM'",
        "[INFO] [navigator-1]: sending signal 'SIGTERM' to process[navigator-1]",
        f"[ERROR] [navigator-1]: process has died [pid 1001, exit code -15, cmd '{LIBEXEC}/navigator --ros-args'].",
    ]


# -- output -----------------------------------------------------------------------------------------------


def test_output_is_shown_line_by_line_and_its_rest_at_the_end(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    world, _ = launch(tmp_path, node(output="'screen'"))
    process = world.processes[0]
    capsys.readouterr()
    process.stdout.write("hel")
    assert screen(capsys) == []
    process.stdout.write("lo\nworld\n")
    process.stdout.write("the e")
    process.stderr.write("[INFO] [1800000000.000000000] [navigator]: here\n")
    process.stdout.write("nd")
    process.end(0)
    assert screen(capsys) == [
        "[navigator-1] hello",
        "[navigator-1] world",
        "[navigator-1] [INFO] [1800000000.000000000] [navigator]: here",
        "[navigator-1] the end",
        "[INFO] [navigator-1]: process has finished cleanly [pid 1001]",
    ]


@pytest.mark.parametrize(
    ("output", "shown"),
    [
        ("'log'", ["err"]),
        ("'screen'", ["out", "err"]),
        ("'both'", ["out", "err"]),
        ("'full'", ["out", "err"]),
        ("'own_log'", []),
        ("'none'", []),
        ("{'stdout': 'screen', 'stderr': 'log'}", ["out"]),
        ("{'both': ['log', 'screen']}", ["out", "err"]),
        ("LaunchConfiguration('where', default='screen')", ["out", "err"]),
    ],
)
def test_what_of_the_output_reaches_the_screen(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], output: str, shown: list[str]
) -> None:
    world, _ = launch(tmp_path, node(output=output))
    capsys.readouterr()
    world.processes[0].stdout.write("out\n")
    world.processes[0].stderr.write("err\n")
    assert screen(capsys) == [f"[navigator-1] {word}" for word in shown]


# -- names, namespaces, remappings, arguments -------------------------------------------------------------


def test_names_namespaces_remappings_and_arguments_become_the_real_command_line(tmp_path: Path) -> None:
    world, _ = launch(
        tmp_path,
        node(
            "status_monitor",
            name="'mon'",
            namespace="'robot1'",
            remappings="[('/robot/status', '/robot1/status')]",
            arguments="['--fast', ['a', 'b']]",
            ros_arguments="['--log-level', 'debug']",
        ),
    )
    assert " ".join(world.argv()) == (
        "--fast ab --ros-args --log-level debug -r __node:=mon -r __ns:=/robot1 -r /robot/status:=/robot1/status"
    )


def test_pushed_namespaces_and_parameters_hold_to_the_end_of_their_group(tmp_path: Path) -> None:
    world, _ = launch(
        tmp_path,
        f"""
        GroupAction([
            PushRosNamespace('a'), PushRosNamespace('b'),
            SetParameter('use_sim_time', True), SetRemap('x', 'y'),
            {node()}
            {node(namespace="'own'")}
            {node(namespace="'/abs'", parameters="[{'k': 1}]")}
        ]),
        {node()}
        """,
    )
    shared = "-p use_sim_time:=true"
    assert [" ".join(process.argv[1:]) for process in world.processes] == [
        f"--ros-args -r __ns:=/a/b {shared} -r x:=y",
        f"--ros-args -r __ns:=/a/b/own {shared} -r x:=y",
        f"--ros-args -r __ns:=/abs {shared} -p k:=1 -r x:=y",
        "--ros-args",
    ]


def test_a_python_file_can_be_started_without_a_package(tmp_path: Path) -> None:
    script = write(tmp_path, "print('hi')", "mine.py")
    world, handle = launch(tmp_path, f"Node(executable={str(script)!r}),")
    assert world.processes[0].target == script.resolve()
    assert [each.name for each in handle._service.processes] == ["mine.py-1"]


# -- parameters -------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("given", "argument"),
    [
        ("5.0", "5.0"),
        ("10", "10"),
        ("True", "true"),
        ("1e-05", "1.0e-05"),
        ("float('inf')", ".inf"),
        ("'fast'", "fast"),
        ("'5.0'", "'5.0'"),
        ("'true'", "'true'"),
        ("''", "''"),
        ("'a: b # c'", "'a: b # c'"),
        ("[1, 2]", "[1, 2]"),
        ("(1, 2.5)", "[1.0, 2.5]"),
        ("[True, False]", "[true, false]"),
        ("['a', '1']", "[a, '1']"),
        ("LaunchConfiguration('value')", "5.0"),
        ("LaunchConfiguration('count')", "10"),
        ("LaunchConfiguration('flag')", "true"),
        ("LaunchConfiguration('word')", "fast"),
        ("LaunchConfiguration('list')", "[1, 2]"),
        ("LaunchConfiguration('nothing')", "''"),
        ("['', LaunchConfiguration('nothing')]", "''"),
        ("[LaunchConfiguration('word'), '_one']", "fast_one"),
        ("[[LaunchConfiguration('word')], ['slow']]", "[fast, slow]"),
        ("ParameterValue(LaunchConfiguration('count'), value_type=str)", "'10'"),
        ("ParameterValue(LaunchConfiguration('count'), value_type=float)", "10.0"),
        ("ParameterValue([1, 2], value_type=list[float])", "[1.0, 2.0]"),
        ("PythonExpression(['2 * ', LaunchConfiguration('count')])", "20"),
    ],
)
def test_values_keep_their_type_and_substitutions_are_read_as_yaml(tmp_path: Path, given: str, argument: str) -> None:
    arguments = {"value": 5.0, "count": 10, "flag": True, "word": "fast", "list": "[1, 2]", "nothing": ""}
    world, _ = launch(tmp_path, node(parameters=f"[{{'p': {given}}}]"), **arguments)
    assert world.argv() == ["--ros-args", "-p", f"p:={argument}"]


plain = st.booleans() | st.integers() | st.floats(allow_nan=False) | st.text()


@given(plain | st.lists(st.text(), min_size=1) | st.lists(st.floats(allow_nan=False), min_size=1))
def test_yaml_reads_any_value_again_as_it_was(value: object) -> None:
    from launch_ros.parameter_descriptions import as_argument

    again = yaml.safe_load(as_argument(value))
    assert again == value and type(again) is type(value)


def test_nested_parameters_get_dots_and_files_keep_their_place(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = write(tmp_path, "/**:\n  ros__parameters:\n    a: 1\n", "p.yaml")
    parameters = (
        f"[{{'a': {{'b': 1, 'c': {{'d': 'x'}}}}}}, {str(file)!r}, "
        "PathJoinSubstitution([ThisLaunchFileDir(), 'missing.yaml']), {'z': 2}]"
    )
    world, _ = launch(tmp_path, node(parameters=parameters))
    missing = str(tmp_path / "missing.yaml")
    assert world.argv() == [
        *["--ros-args", "-p", "a.b:=1", "-p", "a.c.d:=x", "--params-file", str(file)],
        *["--params-file", missing, "-p", "z:=2"],
    ]
    warning = f"[WARNING] [launch_ros.actions.node]: Parameter file path is not a file: {missing}"
    assert warning in screen(capsys)


def test_a_parameter_of_a_name_that_no_rule_can_hold_is_given_in_a_file(tmp_path: Path) -> None:
    world, _ = launch(tmp_path, node(parameters="[{'~speed': 0.7, 'b': 1, 'a-b': [1, 2]}, {'/abs': 'x, y'}]"))
    argv = world.argv()
    files = [Path(word) for before, word in pairwise(argv) if before == "--params-file"]
    values = [yaml.safe_load(file.read_text())["/**"]["ros__parameters"] for file in files]
    assert values == [{"~speed": 0.7}, {"a-b": [1, 2]}, {"/abs": "x, y"}]
    assert [word for word in argv if word not in map(str, files)] == [
        *["--ros-args", "--params-file", "-p", "b:=1", "--params-file", "--params-file"],
    ]


# -- arguments, conditions, groups, includes --------------------------------------------------------------

ARGS = """
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

def generate_launch_description():
    return LaunchDescription([
        DeclareLaunchArgument('rate', default_value='10', description='Publish rate [Hz]'),
        DeclareLaunchArgument('robot', description='Name of the robot (required)'),
        Node(package='robot_controller', executable='status_monitor', namespace=LaunchConfiguration('robot'),
             parameters=[{'publish_rate': LaunchConfiguration('rate')}]),
    ])
"""


def test_arguments_are_shown_as_the_real_tool_shows_them(tmp_path: Path) -> None:
    world, file = FakeWorld(), write(tmp_path, ARGS)
    assert show_arguments(world, file) == (
        "Arguments (pass arguments as '<name>:=<value>'):\n"
        "\n    'rate':\n        Publish rate [Hz]\n        (default: '10')\n"
        "\n    'robot':\n        Name of the robot (required)"
    )
    plain = write(tmp_path, LESSON, "plain.launch.py")
    assert show_arguments(world, plain) == ("Arguments (pass arguments as '<name>:=<value>'):\n\n  No arguments.")


def test_given_arguments_replace_defaults(tmp_path: Path) -> None:
    world = FakeWorld()
    launch_file(world, write(tmp_path, ARGS), {"robot": "bob", "rate": 25})
    assert " ".join(world.argv()) == "--ros-args -r __ns:=/bob -p publish_rate:=25"


def test_an_argument_that_nothing_takes_gets_a_warning(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    world = FakeWorld()
    launch_file(world, write(tmp_path, ARGS), {"robot": "bob", "rat": 25})
    assert screen(capsys)[-1] == (
        "[WARNING] [launch]: nothing in this launch file takes the argument 'rat'. Did you mean 'rate'?"
    )
    launch(tmp_path, node(name="LaunchConfiguration('undeclared')"), undeclared="read")
    assert not any("WARNING" in line for line in screen(capsys))


@pytest.mark.parametrize(("sim", "started"), [("true", ["navigator"]), ("0", ["status_monitor"])])
def test_conditions_choose_what_is_started(tmp_path: Path, sim: str, started: list[str]) -> None:
    world, _ = launch(
        tmp_path,
        "DeclareLaunchArgument('sim', default_value='false', choices=['true', 'false', '0', '1']),\n"
        + node("navigator", condition="IfCondition(LaunchConfiguration('sim'))")
        + node("status_monitor", condition="UnlessCondition(LaunchConfiguration('sim'))")
        + node("obstacle_detector", condition="LaunchConfigurationEquals('sim', 'never')")
        + node("detector", condition="IfCondition(EqualsSubstitution(LaunchConfiguration('sim'), 'never'))"),
        sim=sim,
    )
    assert [process.name for process in world.processes] == started


def test_log_info_comes_before_the_processes_start(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    launch(
        tmp_path,
        "DeclareLaunchArgument('sim', default_value='true'),\n"
        + node()
        + "LogInfo(msg='hello from LogInfo'), LogInfo(msg=['sim is ', LaunchConfiguration('sim')]),",
    )
    assert screen(capsys) == [
        "[INFO] [launch.user]: hello from LogInfo",
        "[INFO] [launch.user]: sim is true",
        "[INFO] [navigator-1]: process started with pid [1001]",
    ]


def test_an_included_file_gets_its_arguments_and_knows_its_own_folder(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "inner").mkdir()
    write_launch_file(
        tmp_path / "inner",
        "DeclareLaunchArgument('who', default_value='nobody'), LogInfo(msg=ThisLaunchFileDir()),\n"
        + node(name="LaunchConfiguration('who')"),
    )
    world, _ = launch(
        tmp_path,
        """
        IncludeLaunchDescription(
            PythonLaunchDescriptionSource([ThisLaunchFileDir(), '/inner/test.launch.py']),
            launch_arguments={'who': 'bob'}.items()),
        LogInfo(msg=ThisLaunchFileDir()),
        """,
    )
    assert world.argv() == ["--ros-args", "-r", "__node:=bob"]
    inner, outer = screen(capsys)[:2]
    assert inner.endswith("inner") and outer.endswith(tmp_path.name)


def test_an_opaque_function_sees_the_arguments_and_gives_actions(tmp_path: Path) -> None:
    file = write(
        tmp_path,
        """
        from launch import LaunchDescription
        from launch.actions import OpaqueFunction
        from launch.substitutions import LaunchConfiguration
        from launch_ros.actions import Node

        def robots(context):
            number = int(LaunchConfiguration('number').perform(context))
            return [Node(package='robot_controller', executable='navigator', namespace=f'r{i}')
                    for i in range(number)]

        def generate_launch_description():
            return LaunchDescription([OpaqueFunction(function=robots)])
        """,
    )
    world = FakeWorld()
    launch_file(world, file, {"number": 3})
    assert [process.argv[-1] for process in world.processes] == [f"__ns:=/r{i}" for i in range(3)]


def test_a_description_can_be_launched_from_a_cell() -> None:
    from launch import LaunchDescription
    from launch_ros.actions import Node

    world = FakeWorld()
    description = LaunchDescription([Node(package="robot_controller", executable="navigator")])
    handle = launch_description(world, description)
    assert repr(handle) == "<Launch of a description, running: navigator-1>"


# -- events -----------------------------------------------------------------------------------------------


def test_a_timer_acts_after_its_time_in_robot_time(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    world, handle = launch(tmp_path, "TimerAction(period=2.0, actions=[LogInfo(msg='two seconds later')]),")
    assert handle.running
    world.run(1.9)
    assert screen(capsys) == []
    world.run(0.2)
    assert screen(capsys) == ["[INFO] [launch.user]: two seconds later"]
    assert not handle.running


def test_a_timer_that_was_cancelled_before_it_began_is_not_waited_for(tmp_path: Path) -> None:
    _, handle = launch(tmp_path, "*[(timer.cancel(), timer)[1] for timer in [TimerAction(period=2.0, actions=[])]],")
    assert not handle.running


def test_handlers_of_start_output_and_exit(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = write(
        tmp_path,
        """
        from launch import LaunchDescription
        from launch.actions import LogInfo, RegisterEventHandler
        from launch.event_handlers import OnProcessExit, OnProcessIO, OnProcessStart
        from launch_ros.actions import Node

        def generate_launch_description():
            first = Node(package='robot_controller', executable='navigator')
            second = Node(package='robot_controller', executable='status_monitor')
            return LaunchDescription([
                first,
                RegisterEventHandler(OnProcessStart(target_action=first, on_start=[LogInfo(msg='started')])),
                RegisterEventHandler(OnProcessIO(target_action=first, on_stdout=lambda event: LogInfo(
                    msg=f'heard {event.text.decode().strip()}'))),
                RegisterEventHandler(OnProcessExit(target_action=first, on_exit=lambda event, context: [
                    LogInfo(msg=f'{event.process_name} gave {event.returncode}'), second])),
            ])
        """,
    )
    world = FakeWorld()
    launch_file(world, file)
    assert screen(capsys) == [
        "[INFO] [navigator-1]: process started with pid [1001]",
        "[INFO] [launch.user]: started",
    ]
    world.processes[0].stdout.write("beep\n")
    world.run(0)
    assert screen(capsys) == ["[INFO] [launch.user]: heard beep"]
    world.processes[0].end(3)
    world.run(0)
    assert screen(capsys)[1:] == [
        "[INFO] [launch.user]: navigator-1 gave 3",
        "[INFO] [status_monitor-2]: process started with pid [1002]",
    ]


def test_a_required_node_takes_the_others_with_it(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    world, handle = launch(
        tmp_path,
        node("status_monitor", name="'a'")
        + node("navigator", name="'b'", on_exit="Shutdown()")
        + "RegisterEventHandler(OnShutdown(on_shutdown=[LogInfo(msg='on shutdown')])),",
    )
    capsys.readouterr()
    world.processes[1].end(1)
    world.run(0)
    assert screen(capsys) == [
        "[ERROR] [navigator-2]: process has died [pid 1002, exit code 1, cmd "
        f"'{LIBEXEC}/navigator --ros-args -r __node:=b'].",
        "[INFO] [launch]: process[navigator-2] was required: shutting down launched system",
        "[INFO] [launch.user]: on shutdown",
        "[INFO] [status_monitor-1]: sending signal 'SIGINT' to process[status_monitor-1]",
        "[status_monitor-1] KeyboardInterrupt",
        "[ERROR] [status_monitor-1]: process has died [pid 1001, exit code -2, cmd "
        f"'{LIBEXEC}/status_monitor --ros-args -r __node:=a'].",
    ]
    assert not handle.running


def test_a_respawning_node_comes_back_until_its_retries_are_used_up(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    world, handle = launch(tmp_path, node(respawn="True", respawn_delay="1.0", respawn_max_retries="1"))
    capsys.readouterr()
    world.processes[0].end(1)
    world.run(0.9)
    assert len(world.processes) == 1 and handle.running
    world.run(0.2)
    assert screen(capsys)[1:] == ["[INFO] [navigator-1]: process started with pid [1002]"]
    world.processes[1].end(1)
    world.run(5)
    assert len(world.processes) == 2 and not handle.running


def test_stopping_cancels_timers_and_respawns(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    world, handle = launch(
        tmp_path, node(respawn="True") + "TimerAction(period=1.0, actions=[LogInfo(msg='too late')]),"
    )
    handle.stop()
    capsys.readouterr()
    world.run(10)
    assert screen(capsys) == []
    assert not handle.running and len(world.processes) == 1
