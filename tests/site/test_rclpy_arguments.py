"""`--ros-args` in full, against what a real rclpy made of the same words; what YAML means to ROS; and any text at all."""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import rclpy
from example_interfaces.srv import AddTwoInts
from hypothesis import given
from hypothesis import strategies as st
from rcl_interfaces.msg import ParameterDescriptor
from rclpy._ros_args import (
    YamlValueError,
    parse_arguments,
    pattern_matches,
    read_parameter_file,
    scalar,
    tree,
    value_of,
)
from rclpy.exceptions import InvalidParameterTypeException, RCLError, RCLInvalidROSArgsError, UnknownROSArgsError
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.utilities import remove_ros_args
from std_msgs.msg import String

from turtle_lesson.ros.runtime.world import World

Capture = pytest.CaptureFixture[str]

NAMES = "/n1 /deep/n2 /chatter /deep/chatter /abs /n1/p"
VALUES = {"speed": 0.5, "name": "bob", "flags": [1, 2]}
WRONG = "Trying to set parameter '{}' to '{}' of type 'INTEGER', expecting type '{}'"


def what_becomes(words: list[str]) -> tuple[str, dict[str, Any], int, list[str]]:
    """Names, parameters and log level of two nodes that are started with these words, and the words that are left."""
    rclpy.init(args=["prog", *words])
    one, two = Node("n1"), Node("n2", namespace="/deep")
    topics = [(one, "chatter"), (two, "chatter"), (one, "/abs"), (one, "~/p")]
    names = [one.get_fully_qualified_name(), two.get_fully_qualified_name()]
    names += [node.create_publisher(String, topic, 10).topic_name for node, topic in topics]
    values = {}
    for name, default in VALUES.items():
        try:
            values[name] = one.declare_parameter(name, default).value
        except InvalidParameterTypeException as error:
            values[name] = str(error)
    level = int(one.get_logger().get_effective_level())
    rclpy.shutdown()
    return " ".join(names), values, level, remove_ros_args(["prog", *words])


# Recorded: words, names, changed values, level, what is left of the words.
RECORDED: list[tuple[list[str], str, dict[str, Any], int, list[str]]] = [
    ([], NAMES, {}, 20, []),
    (["-r", "chatter:=talk"], "/n1 /deep/n2 /talk /deep/talk /abs /n1/p", {}, 20, []),
    (["-r", "/chatter:=/talk"], "/n1 /deep/n2 /talk /deep/chatter /abs /n1/p", {}, 20, []),
    (["-r", "__node:=other"], "/other /deep/other /chatter /deep/chatter /abs /other/p", {}, 20, []),
    (["-r", "n1:__node:=other"], "/other /deep/n2 /chatter /deep/chatter /abs /other/p", {}, 20, []),
    (["-r", "__ns:=/robot"], "/robot/n1 /robot/n2 /robot/chatter /robot/chatter /abs /robot/n1/p", {}, 20, []),
    (["-r", "/deep/chatter:=/x"], "/n1 /deep/n2 /chatter /x /abs /n1/p", {}, 20, []),
    (["-r", "~/p:=q"], "/n1 /deep/n2 /chatter /deep/chatter /abs /q", {}, 20, []),
    (["--remap", "chatter:=talk", "--", "extra"], "/n1 /deep/n2 /talk /deep/talk /abs /n1/p", {}, 20, ["extra"]),
    (["-p", "speed:=1.5"], NAMES, {"speed": 1.5}, 20, []),
    (["-p", "speed:=2"], NAMES, {"speed": WRONG.format("speed", 2, "DOUBLE")}, 20, []),
    (["-p", "name:=5"], NAMES, {"name": WRONG.format("name", 5, "STRING")}, 20, []),
    (["-p", 'name:="5"'], NAMES, {"name": "5"}, 20, []),
    (["-p", "name:='5'"], NAMES, {"name": "5"}, 20, []),
    (["-p", "flags:=[3, 4]"], NAMES, {"flags": [3, 4]}, 20, []),
    (["-p", "n1:speed:=3.5"], NAMES, {"speed": 3.5}, 20, []),
    (["-p", "n2:speed:=3.5"], NAMES, {}, 20, []),
    (["--log-level", "debug", "-r", "chatter:=t"], "/n1 /deep/n2 /t /deep/t /abs /n1/p", {}, 10, []),
    (["--log-level", "n1:=warn"], NAMES, {}, 30, []),
    (["-e", "/enclave", "--disable-external-lib-logs", "--enable-rosout-logs"], NAMES, {}, 20, []),
]


@pytest.mark.parametrize(("words", "names", "changed", "level", "rest"), RECORDED)
def test_what_ros_arguments_change(
    world: World, words: list[str], names: str, changed: dict[str, Any], level: int, rest: list[str]
) -> None:
    begun = ["--ros-args"] if words else []
    assert what_becomes([*begun, *words]) == (names, {**VALUES, **changed}, level, ["prog", *rest])


@pytest.mark.parametrize(
    ("words", "names", "rest"),
    [
        (["-r", "chatter:=talk"], "/n1 /deep/n2 /talk /deep/talk /abs /n1/p", ["-r"]),
        (["__node:=old"], "/old /deep/old /chatter /deep/chatter /abs /old/p", []),
    ],
)
def test_rules_as_they_were_given_before_there_was_ros_args_count_and_are_warned_of_each_time_they_are_read(
    world: World, capsys: Capture, words: list[str], names: str, rest: list[str]
) -> None:
    found = what_becomes(words)
    assert (found[0], found[3]) == (names, ["prog", *rest])
    lines = [line for line in capsys.readouterr().out.splitlines() if "[rcl]" in line]
    rule = words[-1]
    text = f"[rcl]: Found remap rule '{rule}'. This syntax is deprecated. Use '--ros-args --remap {rule}' instead."
    assert [line.partition("] ")[2].partition("] ")[2] for line in lines] == [text, text]


@pytest.mark.parametrize(
    ("words", "beginning"),
    [
        (
            ["-r", "__ns:=robot"],
            "Couldn't parse remap rule: '-r __ns:=robot'. Error: a rule looks like old_name:=new_name, o",
        ),
        (["-r", "bad name:=x"], "Couldn't parse remap rule: '-r bad name:=x'. "),
        (["-r", "chatter:=bad name"], "Couldn't parse remap rule: '-r chatter:=bad name'. "),
        (["-r", "http://a:=b"], "Couldn't parse remap rule: '-r http://a:=b'. "),
        (
            ["-p", "speed=1"],
            "Couldn't parse parameter override rule: '-p speed=1'. Error: a rule looks like name:=value",
        ),
        (["-p", "speed"], "Couldn't parse parameter override rule: '-p speed'. "),
        (["-p", "speed:="], "Couldn't parse parameter override rule: '-p speed:='. "),
        (["-p", "n1::=5"], "Couldn't parse parameter override rule: '-p n1::=5'. "),
        (
            ["-p", "gains:=[1, 2.5]"],
            "Couldn't parse parameter override rule: '-p gains:=[1, 2.5]'. Error: Sequence should",
        ),
        (["-p", "map:={a: 1}"], "Couldn't parse parameter override rule: '-p map:={a: 1}'. Error: Unknown YAML event"),
        (["--log-level", "loud"], "Couldn't parse log level: '--log-level loud'. Error: Argument does not use a valid"),
        (
            ["--params-file", "/nope.yaml"],
            "Couldn't parse params file: '--params-file /nope.yaml'. Error: Error opening",
        ),
        (["-p"], "Couldn't parse trailing -p flag. "),
    ],
)
def test_words_that_cannot_be_read_are_refused_at_the_start_and_logged(
    world: World, capsys: Capture, words: list[str], beginning: str
) -> None:
    with pytest.raises(RCLError) as caught:
        rclpy.init(args=["prog", "--ros-args", *words])
    assert str(caught.value).startswith(f"failed to initialize rcl: {beginning}")
    assert capsys.readouterr().out == "[ERROR] [1800000000.000000000] [rcl]: Failed to parse global arguments\n"
    rclpy.init(args=[])  # one may try again
    assert rclpy.ok()


def test_enclaves_say_nothing_and_loggers_have_no_files(world: World) -> None:
    rclpy.init(args=["prog", "--ros-args", "-e", "any", "--log-config-file", "x"], context=rclpy.Context())


@pytest.mark.parametrize("words", [("prog",), "prog", ["prog", 1], ["prog", None]])
def test_arguments_are_a_list_of_texts(world: World, words: Any) -> None:
    with pytest.raises(TypeError, match="arguments must be a list of str"):
        rclpy.init(args=words)
    rclpy.init(args=[])
    with pytest.raises(TypeError, match="arguments must be a list of str"):
        Node("n", cli_args=words)


def test_a_node_s_own_arguments_are_its_mistake(world: World, capsys: Capture) -> None:
    rclpy.init(args=[])
    with pytest.raises(RCLInvalidROSArgsError, match="Couldn't parse trailing -r flag"):
        Node("n", cli_args=["--ros-args", "-r"])
    with pytest.raises(UnknownROSArgsError):
        Node("n", cli_args=["--ros-args", "--foo"])
    assert Node("n", cli_args=["__node:=m"]).get_name() == "m"
    assert "[rcl]: Found remap rule '__node:=m'. This syntax is deprecated." in capsys.readouterr().out


def test_all_unknown_words_are_named(world: World) -> None:
    with pytest.raises(UnknownROSArgsError) as caught:
        rclpy.init(args=["prog", "--ros-args", "--foo", "-r", "a:=b", "bar"])
    assert str(caught.value) == "['--foo', 'bar']"
    assert caught.value.__notes__[0].startswith("-r, -p, --params-file, --log-level and similar")


def test_a_rule_may_be_for_topics_or_for_services_alone(world: World) -> None:
    rclpy.init(args=["prog", "--ros-args", "-r", "rosservice://a:=b", "-r", "n:rostopic://a:=c"])
    node = Node("n")
    assert node.resolve_topic_name("a") == "/c"
    assert node.resolve_service_name("a") == "/b"
    assert node.create_client(AddTwoInts, "a").service_name == "/b"
    assert node.resolve_topic_name("a", only_expand=True) == "/a"
    assert Node("other").resolve_topic_name("a") == "/a"


def test_a_node_may_have_arguments_of_its_own_which_go_first(world: World) -> None:
    rclpy.init(args=["prog", "--ros-args", "-r", "a:=common", "-p", "speed:=1.0", "-p", "n:speed:=2.0"])
    node = Node("n", cli_args=["--ros-args", "-r", "a:=own", "-p", "speed:=3.0"])
    assert node.resolve_topic_name("a") == "/own"
    assert node.declare_parameter("speed", 0.0).value == 3.0
    alone = Node("alone", use_global_arguments=False)
    assert alone.resolve_topic_name("a") == "/a"


def test_logs_can_be_switched_off(world: World, capsys: Capture) -> None:
    rclpy.init(args=["prog", "--ros-args", "--disable-stdout-logs"])
    node = Node("n")
    heard: list[str] = []
    from rcl_interfaces.msg import Log

    node.create_subscription(Log, "/rosout", lambda log: heard.append(log.msg), 10)
    node.get_logger().info("only to rosout")
    rclpy.spin_once(node, timeout_sec=0.1)
    assert (capsys.readouterr().out, heard) == ("", ["only to rosout"])
    rclpy.shutdown()
    rclpy.init(args=["prog", "--ros-args", "--disable-rosout-logs"])
    node = Node("n")
    node.create_subscription(Log, "/rosout", lambda log: heard.append(log.msg), 10)
    node.get_logger().info("only here")
    rclpy.spin_once(node, timeout_sec=0.1)
    assert "only here" in capsys.readouterr().out
    assert heard == ["only to rosout"]


# ---------------------------------------------------------------- parameter files


@pytest.fixture
def file(tmp_path: Path) -> Callable[[str], str]:
    """Returns `file(text)`: the path of a parameter file with this text."""

    def write(text: str) -> str:
        (tmp_path / "p.yaml").write_text(text, encoding="utf-8")
        return str(tmp_path / "p.yaml")

    return write


def speed_of(words: list[str], name: str = "n1", namespace: str = "") -> float:
    """The value that these words give to the parameter `speed` of a node."""
    rclpy.init(args=["prog", "--ros-args", *words])
    value = Node(name, namespace=namespace).declare_parameter("speed", 0.0).value
    rclpy.shutdown()
    return value


@pytest.mark.parametrize(
    ("keys", "node", "matches"),
    [
        ("n1", "/n1", True),
        ("/n1", "/n1", True),
        ("n1", "/deep/n1", False),
        ("/deep/n1", "/deep/n1", True),
        ("deep:\n  n1", "/deep/n1", True),
        ("/**", "/deep/n1", True),
        ("/**/n1", "/n1", True),
        ("/**/n1", "/very/deep/n1", True),
        ("/*/n1", "/n1", False),
        ("/*/n1", "/deep/n1", True),
        ("/deep/*", "/deep/n1", True),
        ("/deep/**", "/deep/er/n1", True),
        ("/deep/**", "/deeper/n1", False),
        ("/**/deep/**", "/a/deep/b/n1", True),
    ],
)
def test_which_nodes_a_name_in_a_file_means(
    world: World, file: Callable[[str], str], keys: str, node: str, matches: bool
) -> None:
    depth = "  " * (keys.count("\n") + 1)
    text = f"{keys}:\n{depth}ros__parameters:\n{depth}  speed: 1.5\n"
    namespace, _, name = node.rpartition("/")
    assert speed_of(["--params-file", file(text)], name, namespace) == (1.5 if matches else 0.0)


BOTH = "/**:\n  ros__parameters: {speed: 1.0}\nn1:\n  ros__parameters: {speed: 2.0}\n"
NAMED = "n1:\n  ros__parameters: {speed: 2.0}\n"


def test_of_several_values_that_counts_whose_nodes_were_named_last(world: World, file: Callable[[str], str]) -> None:
    assert speed_of(["--params-file", file(BOTH)]) == 2.0
    assert speed_of(["--params-file", file(NAMED), "-p", "speed:=3.0"]) == 3.0
    assert speed_of(["-p", "speed:=3.0", "--params-file", file(NAMED)]) == 2.0
    # `-p` joins what the file says of all nodes, which comes before what it says of this one.
    assert speed_of(["--params-file", file(BOTH), "-p", "speed:=3.0"]) == 2.0


@pytest.mark.parametrize(
    ("text", "complaint"),
    [
        ("n1:\n  speed: 1.0\n", "Cannot have a value before ros__parameters at line 2"),
        ("n1:\n  ros__parameters:\n    a: [1\n    b: 2\n", "Error parsing a event near line 4"),
        (
            "n1:\n  ros__parameters:\n    a: [1, 2.5]\n",
            "Sequence should be of same type. Value type 'double' do not belong",
        ),
        ("n1:\n  ros__parameters:\n    a: [x, true]\n", "Sequence should be of same type. Value type 'bool' do"),
        (
            "n1:\n  ros__parameters:\n    a: [[1]]\n",
            "Unknown YAML event at line 3: a value, or a list of plain values, is expected here",
        ),
        ("n1:\n  ros__parameters:\n    a: [{b: 1}]\n", "Unknown YAML event at line 3"),
        ("n1:\n  ros__parameters:\n    a:\n", "No value at line 3"),
        ("n1:\n  ros__parameters: 5\n", "Cannot have a value before ros__parameters at line 2"),
        ("n1:\n  ros__parameters:\n    a: &x 1\n    b: *x\n", "Will not support aliasing at line 4"),
        (
            "n1:\n  - " + "[" * 5000,
            "Error parsing a event near line 2: lists and mappings are nested more than 100 deep",
        ),
        ("#" * 2_000_000, "Error parsing a event near line 0: it has 1,000,001 characters, and at most 1,000,000 are"),
        ("ros__parameters:\n  a: 1\n", "There are no node names before ros__parameters at line 1"),
        (
            "bad name:\n  ros__parameters:\n    a: 1\n",
            "node name must not contain characters other than alphanumerics or '_'",
        ),
        ("[1, 2]: 5\n", "A list, a mapping or nothing cannot be a name at line 1"),
        ("n1: [1]\n", "Cannot have a value before ros__parameters at line 1"),
        ("- n1\n", "Cannot have a value before ros__parameters at line 1"),
        ("n1:\n  ros__parameters:\n", "Cannot have a value before ros__parameters at line 2"),
        ("\ta: 1\n", "Error parsing a event near line"),
        ("\x00", "Error parsing a event near line 0"),
    ],
)
def test_a_bad_file_is_refused_with_the_line(
    world: World, file: Callable[[str], str], text: str, complaint: str
) -> None:
    with pytest.raises(RCLError) as caught:
        rclpy.init(args=["prog", "--ros-args", "--params-file", file(text)])
    assert f"'. Error: {complaint}" in str(caught.value)


def test_an_empty_file_says_nothing(world: World, file: Callable[[str], str]) -> None:
    for text in ("", "# only words\n", "n1: {}\n", "n1:\n  ros__parameters: {}\n"):
        assert read_parameter_file(file(text)) == []


def test_nested_names_are_joined_by_dots(file: Callable[[str], str]) -> None:
    text = "n1:\n  ros__parameters:\n    a: {b: {c: 1, 2: x}}\n    d.e: [on, off]\n"
    assert read_parameter_file(file(text)) == [("n1", "a.b.c", 1), ("n1", "a.b.2", "x"), ("n1", "d.e", [True, False])]


# ---------------------------------------------------------------- rules, against a recording

NESTED = ("a:=[[1]]", "a:=[1,[2]]")
"""Lists in lists: rcl takes them for one list, here they are refused."""


def test_every_recorded_rule_is_taken_or_refused_as_recorded(world: World, capsys: Capture) -> None:
    """data/rcl_rules.jsonl: words, and what a real rcl (Jazzy) left of them, or the beginning of its complaint."""
    different = []
    for line in (Path(__file__).parents[1] / "data" / "rcl_rules.jsonl").read_text(encoding="utf-8").splitlines():
        words, expected = json.loads(line)
        try:
            found: Any = remove_ros_args(["p", *words])
        except (RCLError, UnknownROSArgsError) as error:
            found = str(error)
        if words[-1] not in NESTED and not _as_recorded(found, expected):
            different.append((words, found, expected))
    assert not different


def _as_recorded(found: Any, expected: Any) -> bool:
    if isinstance(expected, list) or isinstance(found, list):
        return found == expected
    rule, is_trailing, _ = expected.partition("Couldn't parse trailing ")
    rule = expected.partition("Error: ")[0]  # the reason is put into words of ours
    return found.startswith("Couldn't parse trailing " if is_trailing else rule)


# ---------------------------------------------------------------- what words mean


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("1", 1),
        ("-17", -17),
        ("+3", 3),
        ("0x1F", 31),
        ("010", 8),
        ("08", 8.0),
        ("1_000", "1_000"),
        ("12:30", "12:30"),
        ("2027-01-15", "2027-01-15"),
        ("1.", 1.0),
        (".5", 0.5),
        ("1e3", 1000.0),
        ("-1.5E-2", -0.015),
        ("0x1p4", "0x1p4"),
        ("1e999", "1e999"),
        ("9223372036854775807", 2**63 - 1),
        ("9223372036854775808", float(2**63)),
        ("inf", math.inf),
        ("-.Inf", -math.inf),
        ("true", True),
        ("Yes", True),
        ("y", True),
        ("OFF", False),
        ("n", False),
        ("tRUE", "tRUE"),
        ("null", "null"),
        ("~", "~"),
        ("abc", "abc"),
        ("1.5m", "1.5m"),
        ("", ""),
    ],
)
def test_what_an_unquoted_word_means(text: str, value: object) -> None:
    found = scalar(text)
    assert (type(found), found) == (type(value), value)


def test_not_a_number_is_a_number() -> None:
    assert all(math.isnan(scalar(text)) for text in (".nan", ".NaN", "nan"))


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("!!str 1", "1"),
        ("!!int '1'", "1"),
        ("[]", None),
        ("#", None),
        (" ", None),
        ("- 1\n- 2", [1, 2]),
        ("&x 1", 1),
        ("|\n a\n b", "a\nb"),
        ("~", "~"),
        ("[null, a]", ["null", "a"]),
        ("a:b", "a:b"),
        ("'it''s'", "it's"),
    ],
)
def test_values_of_more_than_a_word(world: World, text: str, value: Any) -> None:
    """Recorded, too. What is empty, even a list, is no value: a parameter declared with one has none then."""
    rclpy.init(args=["prog", "--ros-args", "-p", f"a:={text}"])
    node = Node("n")
    anything = ParameterDescriptor(dynamic_typing=True)
    assert node.declare_parameter("a", None, anything).value == value
    if value is None:
        assert Node("m").declare_parameter("a", [1]).type_ is Parameter.Type.NOT_SET


@given(st.text(max_size=12) | st.from_regex(r"[-+.0-9a-fA-FxXeEpPiInN]{1,10}", fullmatch=True))
def test_any_word_means_something(text: str) -> None:
    assert isinstance(scalar(text), (bool, int, float, str))


@given(st.integers(-(2**63), 2**63 - 1) | st.floats(allow_nan=False))
def test_numbers_are_what_python_writes_for_them(number: float) -> None:
    found = scalar(repr(number))
    assert (type(found), found) == (type(number), number) or abs(number) < 1e-300


WORDS = [
    "n1",
    "ros__parameters",
    "/**",
    "a",
    "b.c",
    ": ",
    ":\n",
    "\n",
    "  ",
    "    ",
    "- ",
    "[1, 2]",
    "{x: 1}",
    "1.5",
    "null",
]
SIGNS = ["'", '"', "#", "&x ", "*x", "!!str ", "|", ">", "\t", "---\n", "%", "é", "\x07", "[", "}", "? "]
PIECES = st.sampled_from(WORDS) | st.sampled_from(SIGNS)


@given(st.lists(PIECES, max_size=20).map("".join) | st.text(max_size=60))
def test_any_file_is_read_or_refused_with_a_sentence(text: str) -> None:
    import tempfile

    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "p.yaml"
        path.write_text(text, encoding="utf-8", errors="surrogatepass")
        try:
            found = read_parameter_file(str(path))
        except YamlValueError as error:
            assert len(str(error)) > 10
        else:
            assert all(isinstance(name, str) for _, name, _ in found)


@given(
    st.lists(
        st.sampled_from(["--ros-args", "--", "-r", "-p", "--log-level", "--params-file", "-e"]) | st.text(max_size=10)
    )
)
def test_any_words_are_read_or_refused(words: list[str]) -> None:
    try:
        parse_arguments(words)
    except (RCLInvalidROSArgsError, UnknownROSArgsError) as error:
        assert str(error)


@given(st.text(max_size=40))
def test_any_value_of_a_parameter_is_read_or_refused(text: str) -> None:
    try:
        found = tree(text)
        if found is not None:
            value_of(found)
    except YamlValueError as error:
        assert str(error)


@given(
    st.lists(st.sampled_from(["*", "**", "a", "b"]), min_size=1, max_size=5),
    st.lists(st.sampled_from("abc"), min_size=1),
)
def test_a_pattern_of_names_alone_means_that_node(parts: list[str], node: list[str]) -> None:
    name = "/" + "/".join(node)
    assert pattern_matches("/**", name) and pattern_matches(name, name)
    if not set(parts) & {"*", "**"}:
        assert pattern_matches("/" + "/".join(parts), name) == (parts == node)
