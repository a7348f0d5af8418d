"""What a launch file can have wrong: the real tool's words, then the place and what to try."""

from __future__ import annotations

from pathlib import Path

import pytest
from launch_world import HEAD, FakeWorld, launch, node, write, write_launch_file

from turtle_lesson.ros.ament.package import Package
from turtle_lesson.ros.launching.errors import LaunchError, find_launch_file
from turtle_lesson.ros.launching.service import launch_file
from turtle_lesson.ros.sim.errors import learners_frames

NO_FRONTEND = " - InvalidFrontendLaunchFileError: The launch file may have a syntax error, or its format is unknown"


def failure(path: Path, world: FakeWorld | None = None, **arguments: object) -> LaunchError:
    """The error that launching the file gives. Nothing must have been started."""
    world = world or FakeWorld()
    with pytest.raises(LaunchError) as caught:
        launch_file(world, path, arguments)
    assert world.processes == []
    return caught.value


def loading(*what: str) -> str:
    """The real text about a Python launch file that could not be loaded."""
    return "\n".join(["Caught multiple exceptions when trying to load file of format [py]:", *what, NO_FRONTEND])


def test_an_unknown_executable(tmp_path: Path) -> None:
    error = failure(write_launch_file(tmp_path, node() + node("navigatr")))
    assert error.reason == (
        "executable 'navigatr' not found on the libexec directory 'install/robot_controller/lib/robot_controller'"
    )
    assert error.console == (f"[ERROR] [launch]: Caught exception in launch (see debug for traceback): {error.reason}")
    assert str(error).splitlines()[1:] == [
        f"  in {tmp_path}/test.launch.py, line 15: Node(package='robot_controller', executable='navigatr'),",
        "  Did you mean 'navigator'? robot_controller has: navigator, obstacle_detector, status_monitor.",
    ]


def test_an_unknown_package(tmp_path: Path) -> None:
    error = failure(write_launch_file(tmp_path, "Node(package='robot_controler', executable='navigator'),"))
    assert error.reason == ("\"package 'robot_controler' not found, searching: ['install/robot_controller']\"")
    assert error.hint == "Did you mean 'robot_controller'?"
    assert error.line == 14


def test_a_package_that_installs_no_program(tmp_path: Path) -> None:
    prefix = Path("install/robot_controller")
    world = FakeWorld(Package("robot_controller", prefix / "share/robot_controller", prefix=prefix))
    error = failure(write_launch_file(tmp_path, node()), world)
    assert error.reason == (
        "package 'robot_controller' found at 'install/robot_controller', but libexec directory "
        "'install/robot_controller/lib/robot_controller' does not exist"
    )
    assert "install(PROGRAMS" in error.hint


def test_a_syntax_error(tmp_path: Path) -> None:
    path = write(tmp_path, "def generate_launch_description():\n    return [1 2]\n", "syntax.launch.py")
    error = failure(path)
    said = " - SyntaxError: invalid syntax. Perhaps you forgot a comma? (syntax.launch.py, line 2)"
    assert error.reason == loading(said)
    assert (error.file, error.line) == (str(path), 2)
    assert "comma" in error.hint


def test_no_function(tmp_path: Path) -> None:
    path = write(tmp_path, "def generate_launch_descripton():\n    return None\n")
    error = failure(path)
    assert error.reason == loading(
        f" - InvalidPythonLaunchFileError: launch file at '{path}' does not contain the required function "
        "'generate_launch_description()'"
    )
    assert error.hint == "Write: def generate_launch_description(): return LaunchDescription([…])"


@pytest.mark.parametrize(
    ("returned", "reason", "hint"),
    [
        (
            "None",
            "'NoneType' object has no attribute 'get_launch_arguments_with_include_launch_description_actions'",
            "generate_launch_description() must end with: return LaunchDescription([…])",
        ),
        (
            "[]",
            "'list' object has no attribute 'get_launch_arguments_with_include_launch_description_actions'",
            "generate_launch_description() must end with: return LaunchDescription([…])",
        ),
    ],
)
def test_the_wrong_thing_returned(tmp_path: Path, returned: str, reason: str, hint: str) -> None:
    error = failure(write(tmp_path, f"def generate_launch_description():\n    return {returned}\n"))
    assert (error.reason, error.hint) == (reason, hint)


def test_a_missing_required_argument(tmp_path: Path) -> None:
    path = write_launch_file(tmp_path, "DeclareLaunchArgument('robot', description='Name of the robot (required)'),")
    error = failure(path)
    assert error.reason == (
        "Included launch description missing required argument 'robot' "
        "(description: 'Name of the robot (required)'), given: []"
    )
    assert error.hint == "Give it a value: robot:=… (in a notebook lesson.launch(…, robot='…'))."
    assert failure(path, robt="bob").reason.endswith("given: [robt]")


def test_what_is_included_on_a_condition_needs_its_arguments_only_then(tmp_path: Path) -> None:
    inner = write(tmp_path, HEAD + "        DeclareLaunchArgument('robot'),\n    ])\n", "inner.launch.py")
    condition = "condition=IfCondition(LaunchConfiguration('go', default='false'))"
    outer = write_launch_file(tmp_path, f"IncludeLaunchDescription('{inner}', {condition}),")
    assert not launch_file(FakeWorld(), outer).running
    assert "missing required argument 'robot'" in failure(outer, go=True).reason


def test_a_bad_node_name(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    error = failure(write_launch_file(tmp_path, node("status_monitor", name="'status monitor'")))
    assert error.reason == (
        "Invalid node name: node name must not contain characters other than alphanumerics or '_':\n"
        "  'status monitor'\n"
        "         ^"
    )
    assert capsys.readouterr().out.splitlines()[-1] == (
        "[ERROR] [launch_ros.actions.node]: Error while expanding or validating node name or namespace for "
        "'package=robot_controller, executable=status_monitor, name=status monitor, namespace=None':"
    )


@pytest.mark.parametrize(
    ("action", "said", "hint"),
    [
        (
            node(parameters="{'count': 5}"),
            "TypeError: 'Node' expected 'parameters' to be one of [<class 'list'>], but got '{'count': 5}' "
            "of type '<class 'dict'>'",
            "Put it into a list: parameters=[{…}]",
        ),
        (
            "Node(package='robot_controller'),",
            "TypeError: Node.__init__() missing 1 required keyword-only argument: 'executable'",
            "Write executable='…' in it.",
        ),
        (
            node(parameter="[]"),
            "TypeError: Action.__init__() got an unexpected keyword argument 'parameter'",
            "Did you mean 'parameters'?",
        ),
        (
            node(remappings="('a', 'b')"),
            "TypeError: Node expected 'remappings' to be a list of pairs, got 'a' in it; write "
            "remappings=[('/from', '/to')]",
            "",
        ),
        (
            "DeclareLaunchArgument('rate', default_value=10),",
            "TypeError: Failed to normalize given item of type '<class 'int'>', when only 'str' or "
            "'launch.Substitution' were expected.",
            "Launch needs text here, but got a value of type int; a number is put in quotes, as in '5.0'.",
        ),
        (
            "DeclareLaunchArgument('mode', default_value='c', choices=['a', 'b']),",
            "RuntimeError: Provided default_value \"c\" is not in provided choices \"['a', 'b']\".",
            "",
        ),
        (
            "IncludeLaunchDescription('x.launch.py', launch_arguments={'a': 'b'}),",
            "ValueError: launch_arguments is a dictionary, expected pairs of name and value",
            "Write launch_arguments={…}.items()",
        ),
    ],
)
def test_mistakes_that_show_when_the_file_is_loaded(tmp_path: Path, action: str, said: str, hint: str) -> None:
    error = failure(write_launch_file(tmp_path, action))
    assert error.reason == loading(f" - {said}")
    assert (error.line, error.hint) == (14, hint)


def test_a_name_that_was_not_imported(tmp_path: Path) -> None:
    path = write(
        tmp_path,
        """\
        from launch import LaunchDescription

        def generate_launch_description():
            return LaunchDescription([
                Node(package='robot_controller', executable='param_demo'),
            ])
        """,
    )
    error = failure(path)
    assert error.reason == loading(" - NameError: name 'Node' is not defined")
    assert error.line == 5
    assert error.hint == "Add at the top of the file: from launch_ros.actions import Node"


@pytest.mark.parametrize(
    ("line", "said"),
    [
        (
            "from launch.actions import DeclareLaunchArgumnt",
            "launch.actions has no 'DeclareLaunchArgumnt'; did you mean 'DeclareLaunchArgument'?",
        ),
        (
            "from launch.actions import Node",
            "launch.actions has no 'Node' here yet: it is in launch_ros: from launch_ros.actions import Node",
        ),
        (
            "from launch_ros.descriptions import RosExecutable",
            "launch_ros.descriptions has no 'RosExecutable' here yet: use Node",
        ),
        (
            "from launch.actions import ForLoop",
            "launch.actions has no 'ForLoop' here yet: write the loop in Python: [Node(…) for name in names]",
        ),
        (
            "from launch.substitutions import AnySubstitution",
            "launch.substitutions has no 'AnySubstitution' here yet: use OrSubstitution",
        ),
        (
            "from launch.event_handlers import OnIncludeLaunchDescription",
            "launch.event_handlers has no 'OnIncludeLaunchDescription' here yet: launch itself carries an included description "
            "out",
        ),
        (
            "from launch_ros.substitutions import Parameter",
            "launch_ros.substitutions has no 'Parameter' here yet: give SetParameter a LaunchConfiguration, and use that",
        ),
        (
            "from launch_ros.actions import SetROSLogDir",
            "launch_ros.actions has no 'SetROSLogDir' here yet: there are no log files",
        ),
    ],
)
def test_imports_of_what_is_not_here(tmp_path: Path, line: str, said: str) -> None:
    error = failure(write(tmp_path, f"{line}\n"))
    assert error.reason == loading(f" - ImportError: {said}")
    assert error.line == 1


@pytest.mark.parametrize(
    ("action", "reason"),
    [
        (node(name="LaunchConfiguration('nam')"), "launch configuration 'nam' does not exist"),
        (
            node(output="'scren'"),
            'scren is not a valid standard output config i.e. "screen", "log" or "both"',
        ),
        (node(parameters="[{'p': []}]"), "Expected a non-empty sequence, with items of uniform type."),
        (node(parameters="[{'p': [1, 'a']}]"), "Expected a non-empty sequence, with items of uniform type."),
        (node(parameters="[{'p': None}]"), "Unexpected type for parameter value None"),
        (node(parameters="[{'p': TextSubstitution(text='null')}]"), "Unexpected type for parameter value None"),
        (
            node(parameters="[{'p': TextSubstitution(text='[[a, b]]')}]"),
            "Expected a non-empty sequence, with items of uniform type.",
        ),
        (node(namespace="'two words'"), "Invalid namespace: namespace must not contain characters"),
        (
            node(condition="IfCondition('maybe')"),
            "invalid condition expression, expected one of [true, 1, false, 0]",
        ),
        (
            node(condition="IfCondition(PythonExpression(['fast == 1']))"),
            "the Python expression 'fast == 1' failed",
        ),
        ("LogInfo(msg=EnvironmentVariable('NO_SUCH')),", "environment variable 'NO_SUCH' does not exist"),
        ("None,", "'NoneType' object has no attribute 'describe_sub_entities'"),
        (
            "DeclareLaunchArgument('mode', default_value='a', choices=['a', 'b']),",
            'Argument "mode" provided value "c"',
        ),
        ("TimerAction(period=-1.0, actions=[]),", "a launch can wait for a number of seconds from 0 up, not for -1.0"),
        ("TimerAction(period=float('nan'), actions=[]),", "a launch can wait for a number of seconds from 0 up"),
        ("LogInfo(msg=FindPackageShare('turtlesm')),", "\"package 'turtlesm' not found, searching: ["),
    ],
)
def test_mistakes_that_show_when_the_description_is_walked_through(tmp_path: Path, action: str, reason: str) -> None:
    error = failure(write_launch_file(tmp_path, node() + action), mode="c")
    assert error.reason.startswith(reason)
    assert action.startswith("None") or (error.file, error.line) == (str(tmp_path / "test.launch.py"), 15)


def test_a_wrong_parameter_is_named(tmp_path: Path) -> None:
    error = failure(write_launch_file(tmp_path, node(parameters="[{'p': TextSubstitution(text='null')}]")))
    assert error.hint.startswith("This is parameter 'p'. The text is 'null'; ParameterValue(")


@pytest.mark.parametrize(
    ("action", "said"),
    [
        ("choices=['a', 'b']", "Argument \"mode\" provided value \"c\" is not valid. Valid options are: ['a', 'b']"),
        ("default_value='d', choices=['a']", 'Provided default_value "d" is not in provided choices "[\'a\']".'),
    ],
)
def test_a_wrong_choice_is_logged_by_the_argument_before_the_launch_ends(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], action: str, said: str
) -> None:
    error = failure(write_launch_file(tmp_path, f"DeclareLaunchArgument('mode', {action}),"), mode="c")
    last = capsys.readouterr().out.splitlines()[-1]
    assert last == f"[ERROR] [launch.actions.declare_launch_argument]: {said}"
    assert said in error.reason


def test_an_error_in_an_included_file_names_that_file(tmp_path: Path) -> None:
    inner = write(tmp_path, "def generate_launch_description():\n    return 1 / 0\n", "inner.launch.py")
    outer = write_launch_file(tmp_path, f"IncludeLaunchDescription(PythonLaunchDescriptionSource({str(inner)!r})),")
    error = failure(outer)
    assert (error.reason, error.file, error.line) == ("division by zero", str(inner), 2)


def test_the_cause_is_shown_where_it_says_more_than_one_line(tmp_path: Path) -> None:
    text = """\
        def robots(number):
            return 10 // number

        def generate_launch_description():
            return robots(0)
        """
    error = failure(write(tmp_path, text))
    assert error.line == 2
    assert isinstance(error.__cause__, ZeroDivisionError)
    assert len(learners_frames(error.__cause__.__traceback__)) == 2
    plain = failure(write(tmp_path, "def generate_launch_description():\n    1 / 0\n"))
    assert plain.line == 2 and plain.__cause__ is None and plain.__suppress_context__


def test_an_error_that_comes_later_is_printed_and_ends_the_launch(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    world, handle = launch(tmp_path, node() + f"TimerAction(period=1.0, actions=[{node('navigatr')}]),")
    capsys.readouterr()
    world.run(2)
    lines = capsys.readouterr().out.splitlines()
    caught = "[ERROR] [launch]: Caught exception in launch (see debug for traceback): "
    assert lines[0].startswith(f"{caught}executable 'navigatr' not found on the libexec directory")
    assert lines[1].startswith(f"  in {tmp_path}/test.launch.py, line 15")
    assert "[INFO] [navigator-1]: sending signal 'SIGINT' to process[navigator-1]" in lines
    assert not handle.running


def test_what_ros2_launch_says_when_the_file_is_not_found(tmp_path: Path) -> None:
    (tmp_path / "launch").mkdir()
    write(tmp_path / "launch", "", "start_system.launch.py")
    world = FakeWorld(Package("robot_controller", tmp_path))
    found = find_launch_file(world, "robot_controller", "start_system.launch.py")
    assert found == tmp_path / "launch/start_system.launch.py"
    with pytest.raises(LaunchError) as caught:
        find_launch_file(world, "robot_controller", "start_sytem.launch.py")
    assert str(caught.value).splitlines() == [
        "file 'start_sytem.launch.py' was not found in the share directory of package 'robot_controller' "
        f"which is at '{tmp_path}'",
        "  Did you mean 'start_system.launch.py'?",
    ]
    with pytest.raises(LaunchError) as caught:
        find_launch_file(world, "nope_pkg", "start_system.launch.py")
    assert caught.value.reason == (
        f"Package 'nope_pkg' not found: \"package 'nope_pkg' not found, searching: ['{tmp_path}']\""
    )


def test_a_path_that_does_not_exist(tmp_path: Path) -> None:
    write(tmp_path, "", "real.launch.py")
    error = failure(tmp_path / "rael.launch.py")
    assert error.reason == f"[Errno 2] No such file or directory: '{tmp_path}/rael.launch.py'"
    assert error.hint == "Did you mean 'real.launch.py'?"


@pytest.mark.parametrize(
    ("path", "hint"),
    [
        ("'{folder}/iner.launch.xml'", "Did you mean 'inner.launch.xml'?"),
        ("'{folder}/sub/inner.launch.xml'", "There is no folder {folder}/sub."),
        ("'{folder}'", "That is a folder; name the launch file in it."),
    ],
)
def test_an_included_file_that_is_not_there(tmp_path: Path, path: str, hint: str) -> None:
    write(tmp_path, "<launch/>", "inner.launch.xml")
    named = path.format(folder=tmp_path)
    for source in (named, f"PythonLaunchDescriptionSource({named})"):
        error = failure(write_launch_file(tmp_path, f"IncludeLaunchDescription({source}),"))
        assert error.hint == hint.format(folder=tmp_path)
        assert error.line == 14


def test_a_missing_package_is_the_only_thing_said_of_a_python_file(tmp_path: Path) -> None:
    """The real text goes on: "… may have a syntax error", which the file has not."""
    text = """\
        from ament_index_python import get_package_share_directory

        def generate_launch_description():
            share = get_package_share_directory('robot_controler')
        """
    path = write(tmp_path, text)
    error = failure(path)
    said = "package 'robot_controler' not found, searching: ['install/robot_controller']"
    assert error.reason == f'Caught exception when trying to load file of format [py]: "{said}"'
    assert str(error).splitlines()[1:] == [
        f"  in {path}, line 4: share = get_package_share_directory('robot_controler')",
        "  Did you mean 'robot_controller'?",
    ]


@pytest.mark.parametrize(
    ("name", "hint"),
    [
        ("cartographer_ros", "cartographer_ros is not available here: it is not part of this simulation."),
        ("lifecycle", "lifecycle is not available here: it is not part of this simulation."),
        ("arm_cpp", "Is it built, and is its setup file sourced?"),
        ("arm", "Is it built, and is its setup file sourced?"),
        ("turtle_bot3_cartographer", "Did you mean 'turtlebot3_cartographer'?"),
        ("turtlebot3_cartografer", "Did you mean 'turtlebot3_cartographer'?"),
    ],
)
def test_a_package_is_suggested_only_if_its_name_is_close(name: str, hint: str) -> None:
    world = FakeWorld()
    for other in ("turtlebot3_cartographer", "lifecycle_py", "arm_py"):
        world.packages.add(Package(other, Path(other)))
    with pytest.raises(LaunchError) as caught:
        find_launch_file(world, name, "x.launch.py")
    assert caught.value.hint == hint
