"""XML and YAML launch files: they mean what a Python one means, and a mistake in them is named with its line."""

from __future__ import annotations

from pathlib import Path

import pytest
from launch_world import FakeWorld, write

from turtle_lesson.ros.launching.errors import LaunchError
from turtle_lesson.ros.launching.service import launch_file, show_arguments

START = "[INFO] [launch]: Default logging verbosity is set to INFO"

PYTHON = """
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, GroupAction, LogInfo, SetLaunchConfiguration, TimerAction
from launch.conditions import IfCondition, UnlessCondition
from launch.substitutions import LaunchConfiguration, ThisLaunchFileDir
from launch_ros.actions import Node, PushRosNamespace, SetParameter, SetRemap

def generate_launch_description():
    return LaunchDescription([
        DeclareLaunchArgument('rate', default_value='10', description='Publish rate [Hz]'),
        DeclareLaunchArgument('mode', default_value='slow', choices=['slow', 'fast']),
        SetLaunchConfiguration('prefix', ['robot_', LaunchConfiguration('rate')]),
        Node(package='robot_controller', executable='navigator', name='nav', output='screen',
             parameters=[{'rate': LaunchConfiguration('rate'), 'words': ['a', 'b'], 'text': '3',
                          'deep': {'er': 1.5, 'flag': True}}],
             remappings=[('/pose', '/turtle1/pose'), ('a', 'b')],
             arguments=['--fast', [LaunchConfiguration('prefix'), '/x'], 'two words']),
        GroupAction([
            PushRosNamespace('team'),
            SetParameter('use_sim_time', True),
            SetRemap('c', 'd'),
            Node(package='robot_controller', executable='status_monitor', namespace='inner'),
            Node(package='robot_controller', executable='obstacle_detector',
                 condition=IfCondition(LaunchConfiguration('off', default='false'))),
        ]),
        Node(package='robot_controller', executable='obstacle_detector',
             condition=UnlessCondition(LaunchConfiguration('off', default='false'))),
        LogInfo(msg=['mode is ', LaunchConfiguration('mode')]),
        TimerAction(period=1.5, actions=[LogInfo(msg='later')]),
    ])
"""
XML = """\
<?xml version="1.0"?>
<!-- the same -->
<launch>
  <arg name="rate" default="10" description="Publish rate [Hz]"/>
  <arg name="mode" default="slow"><choice value="slow"/><choice value="fast"/></arg>
  <let name="prefix" value="robot_$(var rate)"/>
  <node pkg="robot_controller" exec="navigator" name="nav" output="screen"
        args="--fast $(var prefix)/x 'two words'">
    <param name="rate" value="$(var rate)"/>
    <param name="words" value="a, b" value-sep=", "/>
    <param name="text" value="'3'"/>
    <param name="deep">
      <param name="er" value="1.5"/>
      <param name="flag" value="true"/>
    </param>
    <remap from="/pose" to="/turtle1/pose"/>
    <remap from="a" to="b"/>
  </node>
  <group>
    <push_ros_namespace namespace="team"/>
    <set_parameter name="use_sim_time" value="true"/>
    <set_remap from="c" to="d"/>
    <node pkg="robot_controller" exec="status_monitor" namespace="inner"/>
    <node pkg="robot_controller" exec="obstacle_detector" if="$(var off false)"/>
  </group>
  <node pkg="robot_controller" exec="obstacle_detector" unless="$(var off false)"/>
  <log message="mode is $(var mode)"/>
  <timer period="1.5"><log message="later"/></timer>
</launch>
"""
YAML = """\
# the same
launch:
- arg:
    name: rate
    default: "10"
    description: Publish rate [Hz]
- arg: {name: mode, default: slow, choice: [{value: slow}, {value: fast}]}
- let: {name: prefix, value: robot_$(var rate)}
- node:
    pkg: robot_controller
    exec: navigator
    name: nav
    output: screen
    args: "--fast $(var prefix)/x 'two words'"
    param:
    - name: rate
      value: $(var rate)
    - name: words
      value: [a, b]
    - {name: text, value: "3"}
    - name: deep
      param:
      - {name: er, value: 1.5}
      - {name: flag, value: true}
    remap:
    - {from: /pose, to: /turtle1/pose}
    - {from: a, to: b}
- group:
  - push-ros-namespace: {namespace: team}
  - set_parameter: {name: use_sim_time, value: true}
  - set_remap: {from: c, to: d}
  - node: {pkg: robot_controller, exec: status_monitor, namespace: inner}
  - node: {pkg: robot_controller, exec: obstacle_detector, if: $(var off false)}
- node: {pkg: robot_controller, exec: obstacle_detector, unless: $(var off false)}
- log: {message: mode is $(var mode)}
- timer:
    period: 1.5
    children:
    - log: {message: later}
"""
THE_SAME = {"same.launch.py": PYTHON, "same.launch.xml": XML, "same_launch.yaml": YAML, "same.launch.yml": YAML}


def screen(capsys: pytest.CaptureFixture[str]) -> list[str]:
    return [line for line in capsys.readouterr().out.splitlines() if line != START]


def launched(folder: Path, text: str, name: str = "test.launch.xml", **arguments: object) -> FakeWorld:
    """A fresh world after a launch and two seconds. A text without a root gets one."""
    if name.endswith("xml") and "<launch" not in text:
        text = f"<launch>\n{text}\n</launch>\n"
    world = FakeWorld()
    launch_file(world, write(folder, text, name), arguments)
    world.run(2)
    return world


def failure(folder: Path, text: str, name: str = "bad.launch.xml") -> LaunchError:
    with pytest.raises(LaunchError) as caught:
        launched(folder, text, name)
    return caught.value


# -- the three formats -------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", THE_SAME)
def test_the_three_formats_start_the_same_nodes(tmp_path: Path, capsys: pytest.CaptureFixture[str], name: str) -> None:
    world = launched(tmp_path, THE_SAME[name], name, mode="fast")
    assert [" ".join(process.argv[1:]) for process in world.processes] == [
        "--fast robot_10/x two words --ros-args -r __node:=nav -p rate:=10 -p words:=[a, b] -p text:='3' "
        "-p deep.er:=1.5 -p deep.flag:=true -r /pose:=/turtle1/pose -r a:=b",
        "--ros-args -r __ns:=/team/inner -p use_sim_time:=true -r c:=d",
        "--ros-args",
    ]
    assert screen(capsys) == [
        "[INFO] [launch.user]: mode is fast",
        "[INFO] [navigator-1]: process started with pid [1001]",
        "[INFO] [status_monitor-2]: process started with pid [1002]",
        "[INFO] [obstacle_detector-3]: process started with pid [1003]",
        "[INFO] [launch.user]: later",
    ]


@pytest.mark.parametrize("name", THE_SAME)
def test_the_three_formats_show_the_same_arguments(tmp_path: Path, name: str) -> None:
    assert show_arguments(FakeWorld(), write(tmp_path, THE_SAME[name], name)) == (
        "Arguments (pass arguments as '<name>:=<value>'):\n"
        "\n    'rate':\n        Publish rate [Hz]\n        (default: '10')\n"
        "\n    'mode':\n        One of: ['slow', 'fast']\n        (default: 'slow')"
    )


@pytest.mark.parametrize("outer", ["xml", "yaml", "py"])
@pytest.mark.parametrize("inner", ["xml", "yaml", "py"])
def test_a_file_of_any_format_includes_one_of_any_other(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], outer: str, inner: str
) -> None:
    inside = {
        "xml": "<launch><arg name='who' default='x'/><log message='$(var who) in $(dirname)'/></launch>",
        "yaml": "launch:\n- arg: {name: who, default: x}\n- log: {message: $(var who) in $(dirname)}\n",
        "py": "from launch import *\nfrom launch.actions import *\nfrom launch.substitutions import *\n"
        "def generate_launch_description():\n    return LaunchDescription([DeclareLaunchArgument('who'), "
        "LogInfo(msg=[LaunchConfiguration('who'), ' in ', ThisLaunchFileDir()])])\n",
    }
    outside = {
        "xml": "<launch><include file='$(dirname)/in/in.launch.{}'><arg name='who' value='bob'/></include></launch>",
        "yaml": "launch:\n- include:\n    file: $(dirname)/in/in.launch.{}\n    arg: [{{name: who, value: bob}}]\n",
        "py": "from launch import *\nfrom launch.actions import *\nfrom launch.substitutions import *\n"
        "def generate_launch_description():\n    return LaunchDescription([IncludeLaunchDescription("
        "[ThisLaunchFileDir(), '/in/in.launch.{}'], launch_arguments=[('who', 'bob')])])\n",
    }
    (tmp_path / "in").mkdir()
    write(tmp_path / "in", inside[inner], f"in.launch.{inner}")
    launched(tmp_path, outside[outer].format(inner), f"out.launch.{outer}")
    assert screen(capsys) == [f"[INFO] [launch.user]: bob in {tmp_path}/in"]


def test_the_sources_have_their_own_names(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    write(tmp_path, "<launch><log message='x'/></launch>", "a.xml")
    write(tmp_path, "launch: [{log: {message: y}}]", "b.yaml")
    text = """
    from launch import LaunchDescription
    from launch.actions import IncludeLaunchDescription as Include
    from launch.launch_description_sources import AnyLaunchDescriptionSource, FrontendLaunchDescriptionSource
    from launch_xml.launch_description_sources import XMLLaunchDescriptionSource
    from launch_yaml.launch_description_sources import YAMLLaunchDescriptionSource
    FOLDER = FOLDER_HERE
    def generate_launch_description():
        return LaunchDescription([
            Include(XMLLaunchDescriptionSource(FOLDER + '/a.xml')),
            Include(YAMLLaunchDescriptionSource([FOLDER, '/b.yaml'])),
            Include(FrontendLaunchDescriptionSource(FOLDER + '/a.xml')),
            Include(AnyLaunchDescriptionSource(FOLDER + '/b.yaml')),
        ])
    """
    launched(tmp_path, text.replace("FOLDER_HERE", repr(str(tmp_path))), "all.launch.py")
    assert [line[-1] for line in screen(capsys)] == ["x", "y", "x", "y"]


# -- what stands in them -----------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("plain $ text", None),
        (r"\$(var x) \\ \' \"", "$(var x) \\ ' \""),
        ("'$(var x)'", "'1'"),
        ("$(var nope 'a default')", "a default"),
        ("$(var nope $(var x))$(var x)", "11"),
        ("$(env LAUNCH_TEST_UNSET none)", "none"),
        ("$(eval '$(var x) + 1')", "2"),
        ("$(eval \"'$(var word)' == 'fast'\")", "True"),
        ("$(eval 'math.floor(2.5)')", "2"),
        ("$(not $(var yes))", "false"),
        ("$(and $(var yes) true)", "true"),
        ("$(or $(var yes) false)", "true"),
        ("$(equals $(var x) 1.0)", "true"),
        ("$(not-equals a b)", "true"),
        ("$(find-pkg-share robot_controller)/launch", "install/robot_controller/share/robot_controller/launch"),
        ("$(find-pkg-prefix robot_controller)", "install/robot_controller"),
        ("$(exec-in-pkg navigator robot_controller)", "install/robot_controller/lib/robot_controller/navigator"),
        ("$(find-exec ros2)", "ros2"),
        ("$(command 'echo hello there')", "hello there\n"),
    ],
)
def test_substitutions_in_a_text(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], text: str, said: str | None
) -> None:
    from xml.sax.saxutils import quoteattr

    before = "<let name='x' value='1'/><let name='yes' value='true'/>"
    file = f"{before}<let name='word' value='fast'/><log message={quoteattr(text)}/>"
    if said is None:
        assert failure(tmp_path, file).hint == r"A dollar sign that begins no $(…) is written \$."
        return
    launched(tmp_path, file)
    assert capsys.readouterr().out.removeprefix(f"{START}\n") == f"[INFO] [launch.user]: {said}\n"


def test_groups_keep_their_settings_to_themselves(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    launched(
        tmp_path,
        """
        <let name="a" value="outer"/>
        <group><let name="a" value="inner"/><log message="$(var a)"/></group>
        <log message="$(var a)"/>
        <group scoped="false"><let name="a" value="leaked"/></group>
        <log message="$(var a)"/>
        <set_env name="COLOUR" value="blue"/><append_env name="COLOUR" value="ish" separator="-"/>
        <log message="$(env COLOUR)"/>
        """,
    )
    said = ["inner", "outer", "leaked", "blue-ish"]
    assert screen(capsys) == [f"[INFO] [launch.user]: {word}" for word in said]


def test_parameter_files_and_types(tmp_path: Path) -> None:
    params = write(tmp_path, "/**:\n  ros__parameters:\n    rate: $(var rate)\n", "params.yaml")
    world = launched(
        tmp_path,
        f"""
        <arg name="rate" default="5"/>
        <node pkg="robot_controller" exec="navigator">
            <param from="{params}"/>
            <param from="{params}" allow_substs="true"/>
            <param name="id" value="$(var rate)" type="str"/>
            <param name="many" value="[1.5, 2.0]" type="list_of_float"/>
        </node>
        """,
    )
    words = world.argv()
    assert words[1:3] == ["--params-file", str(params)]
    assert Path(words[4]).name == "params.yaml" and "rate: 5" in Path(words[4]).read_text()
    assert words[5:] == ["-p", "id:='5'", "-p", "many:=[1.5, 2.0]"]


def test_the_end_of_a_launch_can_be_asked_for(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    world = launched(
        tmp_path,
        """
        <node pkg="robot_controller" exec="navigator" respawn="true" respawn_delay="0.5"/>
        <timer period="1"><shutdown reason="enough"/></timer>
        """,
    )
    assert [process.exit_code for process in world.processes] == [-2]


# -- mistakes ----------------------------------------------------------------------------------------------------------

NODE = '<node pkg="robot_controller" exec="navigator"'


@pytest.mark.parametrize(
    ("line", "said", "hint"),
    [
        (
            f'{NODE} outputs="screen"/>',
            "Unexpected attribute(s) found in `node`: {'outputs'}",
            "Did you mean 'output'?",
        ),
        (
            f"{NODE}><arg name='x'/></node>",
            "Unexpected nested tag(s) found in `node`: {'arg'}",
            "Did you mean 'args'?",
        ),
        ("<nod/>", "Unrecognized entity of the type: nod", "Did you mean 'node'?"),
        (
            '<log message="$(param depth)"/>',
            "Unknown substitution: param",
            "Available here are: and, command, dirname, env, equals, eval, exec-in-pkg, filename, find-exec, find-pkg-prefix, "
            "find-pkg-share, not, not-equals, or, var.",
        ),
        (
            '<node package="robot_controller" executable="navigator"/>',
            "Attribute 'exec' of type '<class 'str'>' not found in Entity 'node'",
            "It is called exec here, not executable.",
        ),
        (
            '<node pkg="robot_controller"><exec>navigator</exec></node>',
            "Attribute 'exec' of Entity 'node' expected to be of type '<class 'str'>', got '<class 'list'>'",
            "Write exec as an attribute, with its value in quotation marks.",
        ),
        (
            '<include path="x"/>',
            "Attribute 'file' of type '<class 'str'>' not found in Entity 'include'",
            "It is called file here, not path.",
        ),
        (
            '<arg name="x" value="1"/>',
            "Unexpected attribute(s) found in `arg`: {'value'}",
            "Did you mean 'default'?",
        ),
        (
            f'{NODE} if="true" unless="true"/>',
            "if and unless conditions can't be used simultaneously",
            "",
        ),
        (f"{NODE}><param name='x'/></node>", "either a value attribute or nested params are needed", ""),
        (
            f"{NODE}><param name='x'><param from='y'/></param></node>",
            "either a value attribute or nested params are needed",
            "",
        ),
        (f"{NODE}><param value='x'/></node>", "param Entity should have either name or from attribute", ""),
        (
            f"{NODE}><param name='x' from='y'/></node>",
            "param Entity should have either name or from attribute",
            "",
        ),
        (
            '<group scoped="maybe"/>',
            "Attribute 'scoped' of Entity 'group' expected to be of type '<class 'bool'>'."
            "'maybe' can not be converted to one of those types",
            "",
        ),
        ('<log message="$(vra x)"/>', "Unknown substitution: vra", "Did you mean 'var'?"),
        (
            '<log message="$(var)"/>',
            "the substitution var cannot have 0 arguments",
            "Write $(var <variable_name> <default>); put an argument with spaces in quotes.",
        ),
        (
            '<log message="$(var x"/>',
            "the text '$(var x' is not understood from character 8 on",
            "Is the bracket of '$(var x' closed?",
        ),
    ],
)
def test_a_mistake_in_xml_is_named_with_its_line(tmp_path: Path, line: str, said: str, hint: str) -> None:
    error = failure(tmp_path, f"<launch>\n  <group>\n    {line}\n  </group>\n</launch>\n")
    assert error.reason == f"Caught exception when trying to load file of format [xml]: {said}"
    assert (error.file, error.line, error.hint) == (str(tmp_path / "bad.launch.xml"), 3, hint)


@pytest.mark.parametrize(
    ("text", "said", "line", "hint"),
    [
        (
            "- node:\n  pkg: robot_controller\n  exec: navigator\n",
            "Subentity must be a dictionary with only one key, which is the entity type",
            2,
            "Write each item as - node: (or another action), and indent what belongs to it deeper.",
        ),
        (
            "- group:\n- log: {message: x}\n",
            "Expected entity `group` to have children entities.",
            2,
            "Write them as a list below it, each indented and with a hyphen: - node:",
        ),
        (
            "- arg:\n    name: x\n    default: 5\n",
            "Attribute 'default' of Entity 'arg' expected to be of type '<class 'str'>', got '<class 'int'>'",
            2,
            "Write default as an attribute, with its value in quotation marks.",
        ),
        (
            "- node:\n    pkg: a\n    exec: b\n    param:\n      name: x\n",
            "Attribute 'param' of Entity 'node' expected to be a list of dictionaries.",
            2,
            "Write each param as a tag of its own; in YAML it begins with a hyphen.",
        ),
        (
            "- log: {message: x}\n- node: {pkg: a, exec: b, outputs: screen}\n",
            "Unexpected key(s) found in `node`: {'outputs'}",
            3,
            "Did you mean 'output'?",
        ),
        (
            "- push_ros_namespace: robot1\n",
            "Expected a dict or list, got <class 'str'>",
            2,
            "Write the attributes of push_ros_namespace below it, each on a line of its own.",
        ),
    ],
)
def test_a_mistake_in_yaml_is_named_with_its_line(tmp_path: Path, text: str, said: str, line: int, hint: str) -> None:
    error = failure(tmp_path, f"launch:\n{text}", "bad_launch.yaml")
    assert error.reason == f"Caught exception when trying to load file of format [yaml]: {said}"
    assert (error.line, error.hint) == (line, hint)


@pytest.mark.parametrize(
    ("name", "text", "said", "line", "hint"),
    [
        (
            "a.launch.xml",
            "<launch>\n<group>\n</launch>\n",
            "mismatched tag: line 3, column 2",
            3,
            "Every <tag>",
        ),
        (
            "a.launch.xml",
            "<launch>\n<log message=x/>\n</launch>",
            "not well-formed (invalid token)",
            2,
            "Put values in quotation marks",
        ),
        ("a.launch.xml", "<launch>\n", "no element found: line 2, column 0", 2, "The file ends too early"),
        ("a.launch.yaml", "launch:\n- log:\n\tmessage: x\n", "while scanning", 3, "YAML is indented"),
        (
            "a.launch.yaml",
            "launch:\n- log:\n    message: a: b\n",
            "mapping values",
            3,
            "Put a value that contains ': '",
        ),
        (
            "a.launch.yaml",
            "launch:\n- &a [*a]\n",
            "*a stands for a value that contains it",
            2,
            "",
        ),
        ("a.launch.yaml", "launch: " + "[" * 500, "lists and mappings are nested more than 100", 1, ""),
        ("a.launch.yaml", "a: 1\nb: 2\n", "Expected only one root", 1, "The file begins with launch:"),
        ("a.launch.yaml", "", "Expected only one root", 1, "The file begins with launch:"),
    ],
)
def test_a_file_that_cannot_be_read(tmp_path: Path, name: str, text: str, said: str, line: int, hint: str) -> None:
    error = failure(tmp_path, text, name)
    kind = name.rpartition(".")[2]
    assert error.reason.startswith(f"Caught exception when trying to load file of format [{kind}]: {said}")
    assert error.line == line and error.hint.startswith(hint)


def test_a_root_of_another_name(tmp_path: Path) -> None:
    assert "Expected 'launch' as root tag" in failure(tmp_path, "lunch: []", "a.launch.yaml").reason


def test_a_mistake_that_shows_while_it_runs_has_its_line_too(tmp_path: Path) -> None:
    text = '<launch>\n  <let name="rate" value="1"/>\n  <node pkg="robot_controler" exec="x"/>\n</launch>'
    error = failure(tmp_path, text)
    assert (error.line, error.hint) == (3, "Did you mean 'robot_controller'?")
    undefined = failure(tmp_path, f"<launch>\n{NODE} name='$(var nam)'/>\n</launch>")
    assert undefined.reason == "launch configuration 'nam' does not exist"
    assert undefined.line == 2 and '<arg name="nam" default="…"/>' in undefined.hint


def test_an_action_of_ones_own_can_have_a_tag(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    from launch import frontend
    from launch.actions import LogInfo

    @frontend.expose_action("shout")
    class Shout(LogInfo):
        """Prints a line."""

    try:
        launched(tmp_path, "<shout message='hello'/>")
    finally:
        del frontend._actions["shout"]
    assert screen(capsys) == ["[INFO] [launch.user]: hello"]
