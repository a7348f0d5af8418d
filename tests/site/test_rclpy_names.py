"""Names of nodes, topics and services, and arguments in the wrong place, against what a real rclpy said of them.

The expected texts are the recorded ones. Where the real rclpy answers with the innards of its C++ binding, ours raises
the same type of exception with a sentence that helps, and the test says so.
"""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
import rclpy
from example_interfaces.srv import AddTwoInts
from hypothesis import given
from hypothesis import strategies as st
from rclpy.exceptions import (
    InvalidHandle,
    InvalidNamespaceException,
    InvalidNodeNameException,
    InvalidServiceNameException,
    InvalidTopicNameException,
    NameValidationException,
    RCLError,
    UnknownROSArgsError,
)
from rclpy.expand_topic_name import expand_topic_name
from rclpy.node import Node
from rclpy.validate_full_topic_name import validate_full_topic_name
from rclpy.validate_namespace import validate_namespace
from rclpy.validate_node_name import validate_node_name
from rclpy.validate_topic_name import validate_topic_name
from std_msgs.msg import Int32, String

from turtle_lesson.ros.rmw.names import expand, full_topic_name_flaw, node_name_flaw, topic_name_flaw
from turtle_lesson.ros.runtime.world import World

LETTERS = "node name must not contain characters other than alphanumerics or '_'"
TOPIC_LETTERS = "topic name must not contain characters other than alphanumerics, '_', '~', '{', or '}'"


@pytest.fixture
def node(world: World) -> Iterator[Node]:
    """A node called tester, made in a plain cell."""
    rclpy.init()
    yield rclpy.create_node("tester")


def callback(*arguments: Any) -> None:
    """A callback that takes anything and does nothing."""


def message_of(kind: type[Exception], call: Callable[[], object]) -> str:
    """The text of the exception, of exactly this type, that a call raises."""
    with pytest.raises(kind) as caught:
        call()
    assert caught.type is kind
    return str(caught.value)


# ---------------------------------------------------------------- nodes


@pytest.mark.parametrize(
    ("name", "namespace", "full_name"),
    [
        ("good", None, "/good"),
        ("_under", None, "/_under"),
        ("n", "ns", "/ns/n"),
        ("n", "/ns", "/ns/n"),
        ("n", "", "/n"),
        ("n", "/", "/n"),
        ("n", "/robots/bob", "/robots/bob/n"),
    ],
)
def test_a_good_name_becomes_a_full_name(node: Node, name: str, namespace: str | None, full_name: str) -> None:
    assert Node(name, namespace=namespace).get_fully_qualified_name() == full_name


@pytest.mark.parametrize(
    ("name", "reason", "caret"),
    [
        ("bad name", LETTERS, 3),
        ("bad-name", LETTERS, 3),
        ("1bad", "node name must not start with a number", 0),
        ("", "node name must not be empty", 0),
        ("a/b", LETTERS, 1),
        ("/lead", LETTERS, 0),
        ("x" * 256, "node name length should not exceed '255'", 254),
        ("Ünï", LETTERS, 0),
        ("²x", LETTERS, 0),
    ],
)
def test_a_bad_node_name_is_shown_with_a_caret_under_the_bad_character(
    node: Node, name: str, reason: str, caret: int
) -> None:
    text = message_of(InvalidNodeNameException, lambda: Node(name))
    assert text == f"Invalid node name: {reason}:\n  '{name}'\n   {' ' * caret}^"


@pytest.mark.parametrize(
    ("namespace", "reason", "caret"),
    [
        ("/ns//x", "namespace must not contain repeated '/'", 4),
        ("/ns/", "namespace must not end with a '/', unless only a '/'", 3),
        ("/n s", "namespace must not contain characters other than alphanumerics, '_', or '/'", 2),
        ("/1ns", "namespace must not have a token that starts with a number", 1),
    ],
)
def test_a_bad_namespace_is_shown_with_a_caret(node: Node, namespace: str, reason: str, caret: int) -> None:
    text = message_of(InvalidNamespaceException, lambda: Node("n", namespace=namespace))
    assert text == f"Invalid namespace: {reason}:\n  '{namespace}'\n   {' ' * caret}^"


def test_a_name_that_is_no_text_gets_a_sentence_instead_of_the_bindings_signature(node: Node) -> None:
    assert message_of(TypeError, lambda: Node(5)) == "a node's name must be a str, got 5"
    assert "namespace must be a str, got 5" in message_of(TypeError, lambda: Node("n", namespace=5))
    assert message_of(TypeError, lambda: Node(None)) == "a node's name must be a str, got None"


def test_a_node_class_that_forgets_to_call_its_base_class_is_told_so(node: Node) -> None:
    class Forgetful(Node):
        def __init__(self) -> None:
            self.publisher = self.create_publisher(String, "chatter", 10)

    text = message_of(AttributeError, Forgetful)
    assert text == ("this Forgetful is not a node yet: begin its __init__ with super().__init__('its_name')")


def test_a_subclass_may_call_its_own_things_whatever_it_likes(node: Node) -> None:
    class Free(Node):
        def __init__(self) -> None:
            super().__init__("free")
            for name in ("clock", "context", "entry", "events", "executor", "graph", "logger", "parameters", "timers"):
                setattr(self, f"_{name}", "mine")
            self.declare_parameter("speed", 0.5)
            self.create_timer(0.1, self._tick)
            self.create_publisher(String, "topic", 10)

        def _tick(self) -> None:
            self.get_logger().info(f"{self.get_clock().now().seconds_nanoseconds()[0]}, {self._graph}")

        def _warn(self, *arguments: Any) -> None:
            raise AssertionError("called by somebody else")

        _keep = _names = _set = _store = _declare = _destroy = _check_alive = _warn

    free = Free()
    rclpy.spin_once(free)
    free.destroy_node()
    assert "/free" not in node.get_fully_qualified_node_names()


def test_a_misspelled_method_is_an_ordinary_attribute_error(node: Node) -> None:
    assert message_of(AttributeError, lambda: node.creat_timer) == "'Node' object has no attribute 'creat_timer'"
    assert not hasattr(node, "goal")


# ---------------------------------------------------------------- topics and services


@pytest.mark.parametrize(
    ("name", "full_name"),
    [
        ("chatter", "/chatter"),
        ("/a/b", "/a/b"),
        ("~/priv", "/tester/priv"),
        ("a__b", "/a__b"),
        ("_hidden", "/_hidden"),
        ("{node}/x", "/tester/x"),
    ],
)
def test_a_good_topic_name_becomes_a_full_name(node: Node, name: str, full_name: str) -> None:
    assert node.create_publisher(String, name, 10).topic_name == full_name
    assert node.create_subscription(String, name, callback, 10).topic_name == full_name
    assert node.resolve_topic_name(name) == full_name


def test_names_are_below_the_nodes_namespace(node: Node) -> None:
    bob = Node("driver", namespace="/robots/bob")
    assert bob.create_publisher(String, "chatter", 10).topic_name == "/robots/bob/chatter"
    assert bob.create_publisher(String, "~/priv", 10).topic_name == "/robots/bob/driver/priv"
    assert bob.create_publisher(String, "/chatter", 10).topic_name == "/chatter"
    assert bob.create_service(AddTwoInts, "add", callback).service_name == "/robots/bob/add"


@pytest.mark.parametrize(
    ("name", "reason", "caret"),
    [
        ("~priv", "topic name must not have a tilde '~' that is not followed by a forward slash '/'", 1),
        ("bad topic", TOPIC_LETTERS, 3),
        ("/bad//x", "topic name must not contain repeated '/'", 5),
        ("trail/", "topic name must not end with a forward slash", 5),
        ("1x", "topic name token must not start with a number", 0),
        ("a/1x", "topic name token must not start with a number", 2),
        ("a-b", TOPIC_LETTERS, 1),
        ("", "topic name must not be empty string", 0),
        ("/", "topic name must not end with a forward slash", 0),
        ("a.b", TOPIC_LETTERS, 1),
    ],
)
def test_a_bad_topic_name_is_shown_with_a_caret(node: Node, name: str, reason: str, caret: int) -> None:
    expected = f"Invalid topic name: {reason}:\n  '{name}'\n   {' ' * caret}^"
    publish = message_of(InvalidTopicNameException, lambda: node.create_publisher(String, name, 10))
    assert publish == expected
    listen = message_of(InvalidTopicNameException, lambda: node.create_subscription(String, name, callback, 10))
    assert listen == expected


def test_a_bad_service_name_says_service_and_then_topic_as_the_real_one_does(node: Node) -> None:
    expected = f"Invalid service name: {TOPIC_LETTERS}:\n  'bad srv'\n      ^"
    serve = message_of(InvalidServiceNameException, lambda: node.create_service(AddTwoInts, "bad srv", callback))
    assert serve == expected
    ask = message_of(InvalidServiceNameException, lambda: node.create_client(AddTwoInts, "bad srv"))
    assert ask == expected


def test_the_full_name_is_checked_too(node: Node) -> None:
    text = message_of(InvalidTopicNameException, lambda: node.create_publisher(String, "{ns}/x", 10))
    assert text == "Invalid topic name: topic name must not contain repeated '/':\n  '//x'\n    ^"
    text = message_of(InvalidTopicNameException, lambda: node.create_publisher(String, "x" * 247, 10))
    assert "topic length should not exceed '247'" in text


def test_resolving_a_bad_name_says_why_in_one_line_and_counting_too(node: Node) -> None:
    text = message_of(RCLError, lambda: node.resolve_topic_name("a b"))
    assert text == f"failed to resolve name: {TOPIC_LETTERS}"
    text = message_of(RCLError, lambda: node.resolve_service_name("{ns}/a"))
    assert text == "failed to resolve name: topic name must not contain repeated '/'"
    text = message_of(ValueError, lambda: node.count_publishers("a b"))
    assert text == f"topic name 'a b' is invalid: {TOPIC_LETTERS}"
    text = message_of(ValueError, lambda: node.get_publishers_info_by_topic("~a~"))
    assert text == "topic name '~a~' is invalid: topic name must not have tilde '~' unless it is the first character"


def test_an_unknown_substitution_is_named_and_the_known_ones_too(node: Node) -> None:
    text = message_of(ValueError, lambda: node.create_publisher(String, "{foo}/x", 10))
    assert text.startswith("topic name '{foo}/x' is invalid: unknown substitution: {foo}")
    assert text.endswith("(known are {node} and {namespace})")  # instead of a path in the C source


def test_a_topic_that_is_no_text_gets_a_sentence_instead_of_the_bindings_signature(node: Node) -> None:
    expected = "a topic name must be a str, got 5: is the order of the arguments (type, name, …)?"
    assert message_of(TypeError, lambda: node.create_publisher(String, 5, 10)) == expected
    assert "got None" in message_of(RCLError, lambda: node.create_publisher(String, None, 10))
    text = message_of(TypeError, lambda: node.create_publisher("x", String, 10))
    assert "is the order of the arguments (type, name, …)?" in text


# ---------------------------------------------------------------- other arguments


def test_a_forgotten_argument_is_pythons_own_error(node: Node) -> None:
    missing = {
        "Node.create_publisher() missing 1 required positional argument: 'qos_profile'": (
            lambda: node.create_publisher(String, "x")
        ),
        "Node.create_subscription() missing 1 required positional argument: 'qos_profile'": (
            lambda: node.create_subscription(String, "x", 10)
        ),
        "Node.create_timer() missing 1 required positional argument: 'callback'": lambda: node.create_timer(0.1),
    }
    for expected, call in missing.items():
        assert message_of(TypeError, call) == expected


def test_something_that_is_no_message_type_is_refused_with_an_example(node: Node) -> None:
    text = message_of(AttributeError, lambda: node.create_publisher("String", "x", 10))
    assert text.startswith("type object 'str' has no attribute '_TYPE_SUPPORT'")
    assert text.endswith(
        "a message or service class is expected here, such as geometry_msgs.msg.Twist, but 'String' came"
    )  # the real one suspects a type of ROS 1


def test_a_service_is_no_message_and_a_message_no_service(node: Node) -> None:
    assert message_of(RuntimeError, lambda: node.create_publisher(AddTwoInts, "x", 10)) == (
        "The message type provided is not valid (<class 'example_interfaces.srv._add_two_ints.AddTwoInts'>), "
        "this might be a service or action"
    )
    expected = (
        "The service type provided is not valid (<class 'std_msgs.msg._string.String'>), "
        "this might be a message or action"
    )
    assert message_of(RuntimeError, lambda: node.create_service(String, "x", callback)) == expected
    assert message_of(RuntimeError, lambda: node.create_client(String, "x")) == expected
    with pytest.raises(RuntimeError) as caught:
        node.create_service(AddTwoInts.Request, "x", callback)
    assert caught.value.__notes__ == ["AddTwoInts.Request is only a part of AddTwoInts."]


def test_a_message_instead_of_its_class_is_accepted_as_the_real_one_does(node: Node) -> None:
    assert node.create_publisher(String(), "x", 10).topic_name == "/x"


@pytest.mark.parametrize(
    ("qos", "kind", "text"),
    [
        (-1, ValueError, "history depth must be greater than or equal to zero"),
        ("10", TypeError, "Expected QoSProfile or int, but received <class 'str'>"),
        (1.5, TypeError, "Expected QoSProfile or int, but received <class 'float'>"),
    ],
)
def test_a_queue_length_that_is_none(node: Node, qos: Any, kind: type[Exception], text: str) -> None:
    assert message_of(kind, lambda: node.create_publisher(String, "x", qos)) == text


def test_a_callback_where_the_queue_length_belongs_brings_the_order_to_mind(node: Node) -> None:
    with pytest.raises(TypeError, match="received <class 'function'>") as caught:
        node.create_subscription(String, "x", 10, callback)
    assert caught.value.__notes__ == [
        "The order is create_subscription(type, topic, callback, qos), create_publisher(type, topic, qos)."
    ]


def test_what_the_real_one_accepts_without_a_word(node: Node) -> None:
    assert node.create_publisher(String, "x", 0).topic_name == "/x"
    assert node.create_subscription(String, "x", None, 10).topic_name == "/x"
    assert node.create_timer("0.1", callback).timer_period_ns == 100_000_000
    assert node.create_timer(0, callback).timer_period_ns == 0


def test_a_timers_period_is_a_number_of_seconds(node: Node) -> None:
    text = message_of(RCLError, lambda: node.create_timer(-1.0, callback))
    assert text == "failed to create timer: timer period must be non-negative, got -1 s"
    for period, kind, shown in (
        (callback, TypeError, "the function callback"),
        ("abc", ValueError, "'abc'"),
        (float("nan"), ValueError, "nan"),
        (float("inf"), OverflowError, "inf"),
    ):
        text = message_of(kind, lambda period=period: node.create_timer(period, callback))
        assert text == (f"a timer's period must be a number of seconds, got {shown}: try create_timer(0.1, self.tick)")


def test_only_messages_of_the_topics_type_can_be_published(node: Node) -> None:
    publisher = node.create_publisher(String, "pp", 10)
    expected = "Expected <class 'std_msgs.msg._string.String'>, got <class '{}'>"
    for message, name in (
        (Int32(), "std_msgs.msg._int32.Int32"),
        ("hi", "str"),
        (String, "std_msgs.msg._string.Metaclass_String"),
    ):
        text = message_of(TypeError, lambda message=message: publisher.publish(message))
        assert text == expected.format(name)
    for message, note in (
        ("hi", "Put it into a message first: String(data=…)."),
        (String, "This is the class itself; String() makes a message."),
    ):
        with pytest.raises(TypeError) as caught:
            publisher.publish(message)
        assert caught.value.__notes__ == [note]
    text = message_of(TypeError, publisher.publish)
    assert text == "Publisher.publish() missing 1 required positional argument: 'msg'"


def test_bytes_are_published_if_they_are_a_message(node: Node) -> None:
    publisher = node.create_publisher(String, "pp", 10)
    publisher.publish(bytes.fromhex("0001000003000000686900"))
    with pytest.raises(ValueError, match="these 1 bytes are not a message of type std_msgs/msg/String"):
        publisher.publish(b"x")  # the real one sends them, and every receiver stumbles


def test_a_destroyed_publisher_publishes_no_more(node: Node) -> None:
    publisher = node.create_publisher(String, "pp", 10)
    publisher.destroy()
    text = message_of(InvalidHandle, lambda: publisher.publish(String()))
    assert text == "cannot use Destroyable because destruction was requested"


def test_what_is_not_built_here_says_so(node: Node) -> None:
    with pytest.raises(AttributeError, match="has no 'spinn'; did you mean 'spin'"):
        rclpy.spinn  # noqa: B018


def test_a_submodule_need_not_be_imported_to_be_used(node: Node) -> None:
    assert rclpy.logging.get_logger("free").name == "free"
    assert rclpy.qos.QoSProfile(depth=1).depth == 1


# ---------------------------------------------------------------- looking at the graph


def test_the_graph_is_seen_by_name_and_type(node: Node) -> None:
    for name in ("chatter", "/a/b", "a__b", "_hidden"):
        node.create_publisher(String, name, 10)
    assert node.get_topic_names_and_types()[:4] == [
        ("/_hidden", ["std_msgs/msg/String"]),
        ("/a/b", ["std_msgs/msg/String"]),
        ("/a__b", ["std_msgs/msg/String"]),
        ("/chatter", ["std_msgs/msg/String"]),
    ]
    assert node.get_node_names() == ["tester"]
    assert node.count_publishers("chatter") == 1
    assert node.count_publishers("/nope") == 0
    assert node.get_publisher_names_and_types_by_node("tester", "/")[-1] == (
        "/rosout",
        ["rcl_interfaces/msg/Log"],
    )


def test_a_second_node_of_the_same_name_is_possible_and_warned_of(node: Node, capsys: pytest.CaptureFixture) -> None:
    assert rclpy.create_node("tester").get_name() == "tester"
    assert node.get_node_names() == ["tester", "tester"]
    assert capsys.readouterr().out == (
        "[WARN] [1800000000.000000000] [rcl.logging_rosout]: Publisher already registered for provided node name. If "
        "this is due to multiple nodes with the same name then all logs for that logger name will go out over the "
        "existing publisher. As soon as any node with that name is destructed it will unregister the publisher, "
        "preventing any further logs for that name from being published on the rosout topic.\n"
    )


# ---------------------------------------------------------------- against a recording


def test_every_recorded_name_is_taken_or_refused_as_recorded(world: World) -> None:
    """data/rcl_names.jsonl: reasons; then names, and what a real rclpy (Jazzy) says of them as node, namespace, topic,
    full topic name and expanded (node /x/n): True or the name, or the number of a reason and the place of the caret."""
    lines = (Path(__file__).parents[1] / "data" / "rcl_names.jsonl").read_text(encoding="utf-8").splitlines()
    reasons, *rows = (json.loads(line) for line in lines)
    checks = (validate_node_name, validate_namespace, validate_topic_name, validate_full_topic_name)
    for name, *expected in rows:
        found: list[Any] = [_said(check, name, reasons) for check in checks]
        try:
            found.append(expand_topic_name(name, "n", "/x"))
        except ValueError as error:
            reason = str(error).removeprefix(f"topic name '{name}' is invalid: ").partition(" (known are")[0]
            found.append(reasons.index(reason))
        assert found == expected, name


def _said(check: Callable[[str], bool], name: str, reasons: list[str]) -> Any:
    try:
        return check(name)
    except NameValidationException as error:
        first, _, caret = str(error).splitlines()
        return [reasons.index(first.partition(": ")[2][:-1]), len(caret) - 4]


# ---------------------------------------------------------------- any text at all

NAMELIKE = st.text(alphabet="ab_19/~{} -é", max_size=8) | st.text(max_size=8)


@given(NAMELIKE)
def test_exactly_the_words_are_node_names_and_the_caret_points_into_every_other_text(name: str) -> None:
    flaw = node_name_flaw(name)
    assert (flaw is None) == bool(re.fullmatch(r"[A-Za-z_][A-Za-z0-9_]*", name))
    assert flaw is None or 0 <= flaw.place < max(1, len(name))


@given(NAMELIKE)
def test_exactly_words_joined_by_slashes_are_full_topic_names(name: str) -> None:
    flaw = full_topic_name_flaw(name)
    assert (flaw is None) == bool(re.fullmatch(r"(/[A-Za-z_][A-Za-z0-9_]*)+", name))
    assert flaw is None or 0 <= flaw.place < max(1, len(name))


@given(NAMELIKE)
def test_a_topic_name_that_is_accepted_has_a_good_full_name_or_is_refused_with_a_reason(name: str) -> None:
    if topic_name_flaw(name) is None:
        try:
            full_name = expand(name, "node", "/ns")
        except ValueError as error:
            assert "unknown substitution" in str(error)
        else:
            assert full_name.startswith("/") or full_topic_name_flaw(full_name) is not None


# ---------------------------------------------------------------- remapping


@pytest.mark.parametrize(
    ("arguments", "names"),
    [
        ("", "/n1 /deep/n2 /chatter /deep/chatter /abs /n1/p"),
        ("-r chatter:=talk", "/n1 /deep/n2 /talk /deep/talk /abs /n1/p"),
        ("-r /chatter:=/talk", "/n1 /deep/n2 /talk /deep/chatter /abs /n1/p"),
        ("-r __node:=other", "/other /deep/other /chatter /deep/chatter /abs /other/p"),
        ("-r n1:__node:=other", "/other /deep/n2 /chatter /deep/chatter /abs /other/p"),
        ("-r __ns:=/robot", "/robot/n1 /robot/n2 /robot/chatter /robot/chatter /abs /robot/n1/p"),
        ("-r /deep/chatter:=/x", "/n1 /deep/n2 /chatter /x /abs /n1/p"),
        ("-r ~/p:=q", "/n1 /deep/n2 /chatter /deep/chatter /abs /q"),
        ("--remap chatter:=talk -- extra", "/n1 /deep/n2 /talk /deep/talk /abs /n1/p"),
    ],
)
def test_names_are_remapped_from_the_command_line(world: World, arguments: str, names: str) -> None:
    rclpy.init(args=["prog", "--ros-args", *arguments.split()])
    one, two = Node("n1"), Node("n2", namespace="/deep")
    topics = [(one, "chatter"), (two, "chatter"), (one, "/abs"), (one, "~/p")]
    found = [one.get_fully_qualified_name(), two.get_fully_qualified_name()]
    found += [node.create_publisher(String, topic, 10).topic_name for node, topic in topics]
    assert found == names.split()


@pytest.mark.parametrize("rule", ["bad name:=x", "chatter:=bad name", "chatter", "chatter:=", ":=x", "__ns:=robot"])
def test_a_bad_remapping_rule_is_refused_at_the_start(world: World, rule: str) -> None:
    text = message_of(RCLError, lambda: rclpy.init(args=["prog", "--ros-args", "-r", rule]))
    assert text.startswith(f"failed to initialize rcl: Couldn't parse remap rule: '-r {rule}'. ")


def test_unknown_ros_arguments_are_named(world: World) -> None:
    text = message_of(UnknownROSArgsError, lambda: rclpy.init(args=["prog", "--ros-args", "--foo"]))
    assert text == "['--foo']"
    text = message_of(RCLError, lambda: rclpy.init(args=["prog", "--ros-args", "-r"]))
    assert text == "failed to initialize rcl: Couldn't parse trailing -r flag. No remap rule found."


def test_what_is_left_of_the_arguments_without_those_for_ros() -> None:
    arguments = ["prog", "--ros-args", "-r", "chatter:=talk", "--", "extra"]
    assert rclpy.utilities.remove_ros_args(arguments) == ["prog", "extra"]
