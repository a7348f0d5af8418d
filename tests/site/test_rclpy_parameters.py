"""Parameters: declared, read, refused, overridden, told of, and reached over the wire, against recordings of a real rclpy."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
import rclpy
from rcl_interfaces.msg import (
    FloatingPointRange,
    IntegerRange,
    ParameterDescriptor,
    ParameterEvent,
    ParameterValue,
    SetParametersResult,
)
from rcl_interfaces.srv import (
    DescribeParameters,
    GetParameters,
    GetParameterTypes,
    ListParameters,
    SetParameters,
    SetParametersAtomically,
)
from rclpy.exceptions import (
    InvalidParameterException,
    InvalidParameterTypeException,
    InvalidParameterValueException,
    ParameterAlreadyDeclaredException,
    ParameterImmutableException,
    ParameterNotDeclaredException,
    ParameterUninitializedException,
    RCLError,
)
from rclpy.node import Node
from rclpy.parameter import Parameter

from turtle_lesson.ros.runtime.world import World

Type = Parameter.Type


@pytest.fixture
def node(world: World) -> Iterator[Node]:
    """A node called tester, made in a plain cell."""
    rclpy.init()
    yield rclpy.create_node("tester")


def message_of(kind: type[Exception], call: Callable[[], object]) -> str:
    """The text of the exception, of exactly this type, that a call raises."""
    with pytest.raises(kind) as caught:
        call()
    assert caught.type is kind
    return str(caught.value)


def set_one(node: Node, name: str, value: Any) -> tuple[bool, str]:
    """Set one parameter: whether that was successful, and the reason if not."""
    (result,) = node.set_parameters([Parameter(name, value=value)])
    return result.successful, result.reason


def within(low: float, high: float, step: float = 0.0) -> ParameterDescriptor:
    """The descriptor of a floating-point parameter with a range."""
    limits = FloatingPointRange(from_value=low, to_value=high, step=step)
    return ParameterDescriptor(floating_point_range=[limits])


def between(low: int, high: int, step: int = 0) -> ParameterDescriptor:
    """The descriptor of an integer parameter with a range."""
    return ParameterDescriptor(integer_range=[IntegerRange(from_value=low, to_value=high, step=step)])


# ---------------------------------------------------------------- declaring and reading


def test_a_declared_parameter_has_its_default(node: Node) -> None:
    assert node.declare_parameter("speed", 0.5).value == 0.5
    assert node.get_parameter("speed").value == 0.5
    assert node.has_parameter("speed")
    assert not node.has_parameter("nope")
    assert repr(node.get_parameter("speed").get_parameter_value()) == (
        "rcl_interfaces.msg.ParameterValue(type=3, bool_value=False, integer_value=0, double_value=0.5, "
        "string_value='', byte_array_value=[], bool_array_value=[], integer_array_value=[], double_array_value=[], "
        "string_array_value=[])"
    )


def test_a_parameter_is_declared_once(node: Node) -> None:
    node.declare_parameter("speed", 0.5)
    text = message_of(ParameterAlreadyDeclaredException, lambda: node.declare_parameter("speed", 0.5))
    assert text == "('Parameter(s) already declared', ['speed'])"


def test_reading_an_undeclared_parameter_says_which_are_declared(node: Node) -> None:
    node.declare_parameter("speed", 0.5)
    with pytest.raises(ParameterNotDeclaredException) as caught:
        node.get_parameter("sped")
    assert str(caught.value) == "('Invalid access to undeclared parameter(s)', 'sped')"
    assert caught.value.__notes__ == [
        "Declare it first, with a default: declare_parameter('sped', …). Declared so far: speed, use_sim_time; "
        "did you mean 'speed'?"
    ]


def test_get_parameter_or_has_an_answer_for_undeclared_ones(node: Node) -> None:
    assert node.get_parameter_or("nope", Parameter("nope", value=3)).value == 3
    assert node.get_parameter_or("nope").type_ == Type.NOT_SET
    node.declare_parameter("yes", 1)
    assert node.get_parameter_or("yes", Parameter("yes", value=3)).value == 1


@pytest.mark.parametrize(
    ("name", "value"), [("bad name", 1), ("a.b", 1), ("flag", True), ("text", "x"), ("list", [1.0, 2.0])]
)
def test_what_can_be_declared(node: Node, name: str, value: Any) -> None:
    assert node.declare_parameter(name, value).value == value


def test_an_empty_list_is_a_list_of_bytes_and_stays_one(node: Node) -> None:
    assert node.declare_parameter("empty", []).type_ == Type.BYTE_ARRAY


@pytest.mark.parametrize(
    ("arguments", "kind", "text"),
    [
        (("",), InvalidParameterException, "('Invalid parameter name', '')"),
        (
            (5, 1),
            TypeError,
            "a parameter is declared by a tuple of its name, value and descriptor, got (5, 1)",
        ),
        (("d", {"a": 1}), TypeError, "The given value is not one of the allowed types '{'a': 1}'."),
        (("l", [1, "a"]), TypeError, "The given value is not a list of one of the allowed types '[1, 'a']'."),
        (("l", [1, 2.0]), TypeError, "The given value is not a list of one of the allowed types '[1, 2.0]'."),
        (
            ("rng2", 9.0, within(0.0, 2.0)),
            InvalidParameterValueException,
            "('Invalid parameter value (9.0) for parameter. Reason: Parameter rng2 out of range Min: 0.0, Max: 2.0, "
            "value: 9.0', 'rng2')",
        ),
        (
            ("x", None, ParameterDescriptor()),
            ValueError,
            "Cannot declare a statically typed parameter with default value of type PARAMETER_NOT_SET",
        ),
        (
            ("x", Type.NOT_SET),
            ValueError,
            "Cannot declare parameter {x} with dynamic_typing=True and a type, or as NOT_SET",
        ),
    ],
)
def test_what_cannot_be_declared(node: Node, arguments: tuple, kind: type[Exception], text: str) -> None:
    assert message_of(kind, lambda: node.declare_parameter(*arguments)) == text
    assert list(node.get_parameters_by_prefix("")) == ["use_sim_time"]


@pytest.mark.parametrize("arguments", [("noval",), ("noval", None)])
def test_a_name_alone_is_declared_with_a_warning(node: Node, arguments: tuple) -> None:
    with pytest.warns(UserWarning) as caught:
        node.declare_parameter(*arguments)
    assert str(caught[0].message) == (
        "declaring the parameter 'noval' by its name only is deprecated: give it a default value, a Parameter.Type, or a "
        "descriptor with dynamic_typing=True"
    )
    assert node.get_parameter("noval").value is None
    assert set_one(node, "noval", "anything") == (True, "")


def test_a_type_alone_leaves_the_parameter_without_a_value_until_it_is_set(node: Node) -> None:
    assert node.declare_parameter("typed", Type.INTEGER).value is None
    text = message_of(ParameterUninitializedException, lambda: node.get_parameter("typed"))
    assert text == "The parameter 'typed' is not initialized"
    assert set_one(node, "typed", 3) == (True, "")
    assert node.get_parameter("typed").value == 3


def test_several_are_declared_at_once_below_a_namespace(node: Node) -> None:
    node.declare_parameters("gains", [("p", 1.0), ("d", 0.1, within(0.0, 1.0))])
    assert {name: each.value for name, each in node.get_parameters_by_prefix("gains").items()} == {
        "p": 1.0,
        "d": 0.1,
    }
    assert node.get_parameters_by_prefix("ns") == {}
    text = message_of(TypeError, lambda: node.declare_parameters("", [()]))
    assert text == "a parameter is declared by a tuple of its name, value and descriptor, got ()"


def test_a_descriptor_knows_name_and_type(node: Node) -> None:
    node.declare_parameter("rng", 1.0, within(0.0, 2.0))
    assert repr(node.describe_parameter("rng")) == (
        "rcl_interfaces.msg.ParameterDescriptor(name='rng', type=3, description='', additional_constraints='', "
        "read_only=False, dynamic_typing=False, floating_point_range=[rcl_interfaces.msg.FloatingPointRange("
        "from_value=0.0, to_value=2.0, step=0.0)], integer_range=[])"
    )
    assert node.get_parameter_type("rng") == 3


def test_parameters_check_that_type_and_value_agree() -> None:
    text = message_of(ValueError, lambda: Parameter("x", Type.INTEGER, "a"))
    assert text == "Type 'Type.INTEGER' and value 'a' do not agree"


# ---------------------------------------------------------------- setting


def test_the_type_of_a_parameter_is_fixed(node: Node) -> None:
    node.declare_parameter("speed", 0.5)
    assert set_one(node, "speed", 1) == (
        False,
        "Wrong parameter type, expected 'Type.DOUBLE' got 'Type.INTEGER'",
    )
    assert set_one(node, "speed", "x") == (
        False,
        "Wrong parameter type, expected 'Type.DOUBLE' got 'Type.STRING'",
    )
    assert set_one(node, "speed", 0.7) == (True, "")
    assert node.get_parameter("speed").value == 0.7


def test_a_dynamically_typed_parameter_takes_any_type_and_can_be_forgotten(node: Node) -> None:
    node.declare_parameter("dyn", 1, ParameterDescriptor(dynamic_typing=True))
    assert set_one(node, "dyn", "x") == (True, "")
    assert node.describe_parameter("dyn").type == Type.STRING.value
    assert set_one(node, "dyn", None) == (True, "")
    assert not node.has_parameter("dyn")


def test_a_statically_typed_parameter_cannot_be_set_to_nothing(node: Node) -> None:
    node.declare_parameter("speed", 0.5)
    assert set_one(node, "speed", None) == (False, "Static parameter cannot be undeclared")


def test_setting_an_undeclared_parameter_names_it(node: Node) -> None:
    node.declare_parameter("speed", 0.5)
    wishes = [Parameter("speed", value=0.7), Parameter("nope", value=1)]
    text = message_of(ParameterNotDeclaredException, lambda: node.set_parameters(wishes))
    assert text == "('Invalid access to undeclared parameter(s)', ['nope'])"  # the real one says [], for lack of care
    assert node.get_parameter("speed").value == 0.7  # those before it were set
    with pytest.raises(TypeError, match=r"a list of Parameter\('name', value=…\)"):
        node.set_parameters([("speed", 0.5)])


def test_a_node_may_allow_undeclared_parameters(node: Node) -> None:
    free = Node("free", allow_undeclared_parameters=True)
    assert free.get_parameter("x").value is None
    assert set_one(free, "x", 1) == (True, "")
    assert set_one(free, "x", "text") == (True, "")
    assert free.get_parameter("x").value == "text"


def test_read_only_and_ranges_are_kept_to(node: Node) -> None:
    node.declare_parameter("fixed", 7, ParameterDescriptor(read_only=True))
    node.declare_parameter("rng", 1.0, within(0.0, 2.0))
    node.declare_parameter("stepped", 1.0, within(0.0, 2.0, step=0.5))
    node.declare_parameter("irng", 2, between(0, 10, step=2))
    assert [set_one(node, name, value) for name, value in [("fixed", 8), ("rng", 5.0), ("irng", 5), ("irng", 50)]] == [
        (False, "Trying to set a read-only parameter: fixed."),
        (False, "Parameter rng out of range Min: 0.0, Max: 2.0, value: 5.0"),
        (False, "The parameter value for irng is not a valid step. Min: 0, max: 10, value: 5, step: 2"),
        (False, "Parameter irng out of range. Min: 0, Max: 10, value: 50"),
    ]
    assert set_one(node, "stepped", 0.7) == (
        False,
        "The parameter value for stepped is not close enough to a valid step. Min: 0.0, max: 2.0, value: 0.7, step: 0.5",
    )
    for name, value in (("rng", 2.0), ("rng", 0.0), ("stepped", 1.5), ("irng", 8), ("irng", 10)):
        assert set_one(node, name, value) == (True, "")


def test_undeclaring_forgets_what_may_be_forgotten(node: Node) -> None:
    node.declare_parameter("fixed", 7, ParameterDescriptor(read_only=True))
    node.declare_parameter("speed", 0.5)
    node.undeclare_parameter("speed")
    assert not node.has_parameter("speed")
    assert node.declare_parameter("speed", "now a text").value == "now a text"
    text = message_of(ParameterNotDeclaredException, lambda: node.undeclare_parameter("nope"))
    assert text == "('Invalid access to undeclared parameter(s)', 'nope')"
    text = message_of(ParameterImmutableException, lambda: node.undeclare_parameter("fixed"))
    assert text == "('Attempted to modify read-only parameter', 'fixed')"


def test_setting_atomically_is_all_or_nothing(node: Node) -> None:
    node.declare_parameters("", [("a", 1), ("b", 2)])
    bad = node.set_parameters_atomically([Parameter("a", value=5), Parameter("b", value="x")])
    assert (bad.successful, node.get_parameter("a").value) == (False, 1)
    good = node.set_parameters_atomically([Parameter("a", value=5), Parameter("b", value=6)])
    assert (good.successful, node.get_parameter("a").value, node.get_parameter("b").value) == (True, 5, 6)


def test_a_new_descriptor_can_bring_a_value_that_suits_it(node: Node) -> None:
    node.declare_parameter("speed", 5.0)
    text = message_of(InvalidParameterValueException, lambda: node.set_descriptor("speed", _typed(within(0.0, 2.0))))
    assert "Parameter speed out of range Min: 0.0, Max: 2.0, value: 5.0" in text
    alternative = Parameter("", value=1.5).get_parameter_value()
    assert node.set_descriptor("speed", _typed(within(0.0, 2.0)), alternative).double_value == 1.5
    assert set_one(node, "speed", 3.0)[0] is False


def _typed(descriptor: ParameterDescriptor) -> ParameterDescriptor:
    descriptor.type = Type.DOUBLE.value
    return descriptor


# ---------------------------------------------------------------- callbacks


def test_a_callback_may_refuse_and_give_its_reason(node: Node) -> None:
    node.declare_parameter("speed", 0.5)
    node.add_on_set_parameters_callback(lambda _: SetParametersResult(successful=False, reason="too fast"))
    assert set_one(node, "speed", 0.9) == (False, "too fast")
    assert node.get_parameter("speed").value == 0.5
    text = message_of(InvalidParameterValueException, lambda: node.declare_parameter("other", 1))
    assert text == "('Invalid parameter value (1) for parameter. Reason: too fast', 'other')"


def test_a_callback_that_forgets_to_answer_is_told_how(node: Node) -> None:
    node.add_on_set_parameters_callback(lambda _: None)
    for call in (
        lambda: set_one(node, "use_sim_time", True),
        lambda: node.declare_parameters("ns", [("a", 1), ("b", "x")]),
    ):
        text = message_of(AttributeError, call)
        assert "no attribute 'successful'" in text  # as the real one has it
        assert text.endswith("end it with `return SetParametersResult(successful=True)`")
    assert node.get_parameters_by_prefix("ns") == {}


def test_the_newest_callback_is_asked_first_and_can_be_removed(node: Node) -> None:
    node.declare_parameter("speed", 0.5)
    asked = []

    def answer(name: str) -> Callable[[list[Parameter]], SetParametersResult]:
        def callback(parameters: list[Parameter]) -> SetParametersResult:
            asked.append((name, parameters[0].value, node.get_parameter("speed").value))
            return SetParametersResult(successful=True)

        return callback

    first, second = answer("first"), answer("second")
    node.add_on_set_parameters_callback(first)
    node.add_on_set_parameters_callback(second)
    set_one(node, "speed", 0.9)
    assert asked == [("second", 0.9, 0.5), ("first", 0.9, 0.5)]  # the new value is not in force yet
    node.remove_on_set_parameters_callback(second)
    set_one(node, "speed", 1.0)
    assert asked[2:] == [("first", 1.0, 0.9)]


def test_callbacks_before_may_change_the_list_and_those_after_see_the_result(node: Node) -> None:
    node.declare_parameters("", [("speed", 0.5), ("double", 1.0)])
    after = []

    def before(parameters: list[Parameter]) -> list[Parameter]:
        if not parameters[0].value > 0.0:
            return []
        return [*parameters, Parameter("double", value=2 * parameters[0].value)]

    node.add_pre_set_parameters_callback(before)
    node.add_post_set_parameters_callback(lambda parameters: after.extend(each.name for each in parameters))
    assert set_one(node, "speed", 2.0) == (True, "")
    assert node.get_parameter("double").value == 4.0
    assert after == ["speed", "double"]
    assert set_one(node, "speed", -1.0) == (
        False,
        "parameter list cannot be empty, this might be due to pre_set_parameters_callback modifying the original "
        "parameters list.",
    )
    node.remove_pre_set_parameters_callback(before)
    assert set_one(node, "speed", -1.0) == (True, "")


# ---------------------------------------------------------------- overrides

DEFAULTS = [("speed", 0.5), ("name", "bob"), ("flags", [1, 2])]
UNCHANGED = {"speed": 0.5, "name": "bob", "flags": [1, 2]}


def declared(arguments: list[str]) -> dict[str, Any]:
    """What becomes of three parameters in /n1, started with these arguments: their values or errors."""
    rclpy.init(args=["prog", *arguments])
    node = rclpy.create_node("n1")
    found = {}
    for name, default in DEFAULTS:
        try:
            found[name] = node.declare_parameter(name, default).value
        except InvalidParameterTypeException as error:
            found[name] = str(error)
    rclpy.shutdown()
    return found


@pytest.mark.parametrize(
    ("rule", "changed"),
    [
        ("speed:=1.5", {"speed": 1.5}),
        (
            "speed:=2",
            {"speed": "Trying to set parameter 'speed' to '2' of type 'INTEGER', expecting type 'DOUBLE'"},
        ),
        (
            "speed:=fast",
            {"speed": "Trying to set parameter 'speed' to 'fast' of type 'STRING', expecting type 'DOUBLE'"},
        ),
        (
            "name:=5",
            {"name": "Trying to set parameter 'name' to '5' of type 'INTEGER', expecting type 'STRING'"},
        ),
        ('name:="5"', {"name": "5"}),
        ("name:='5'", {"name": "5"}),
        ("flags:=[3, 4]", {"flags": [3, 4]}),
        ("n1:speed:=3.5", {"speed": 3.5}),
        ("n2:speed:=3.5", {}),
        ("speed:=1e-1", {"speed": 0.1}),
    ],
)
def test_values_on_the_command_line_replace_the_defaults(world: World, rule: str, changed: dict[str, Any]) -> None:
    assert declared(["--ros-args", "-p", rule]) == {**UNCHANGED, **changed}


def test_a_whole_number_for_a_double_gets_the_advice_that_everybody_needs_once(world: World) -> None:
    rclpy.init(args=["prog", "--ros-args", "-p", "speed:=2"])
    with pytest.raises(InvalidParameterTypeException) as caught:
        rclpy.create_node("n1").declare_parameter("speed", 0.5)
    assert caught.value.__notes__ == [
        "ROS does not convert whole numbers to floating-point numbers by itself: write 2.0"
    ]


@pytest.mark.parametrize("rule", ["speed=1", "speed", "speed:="])
def test_a_rule_that_is_none_is_shown_how_one_looks(world: World, rule: str) -> None:
    text = message_of(RCLError, lambda: rclpy.init(args=["prog", "--ros-args", "-p", rule]))
    assert text.startswith(f"failed to initialize rcl: Couldn't parse parameter override rule: '-p {rule}'. Error: ")
    assert text.endswith(" a rule looks like name:=value")


@pytest.mark.parametrize(
    ("content", "changed"),
    [
        ("n1:\n  ros__parameters:\n    speed: 1.25\n    flags: [7, 8]\n", {"speed": 1.25, "flags": [7, 8]}),
        ("/n1:\n  ros__parameters: {speed: 1.25}\n", {"speed": 1.25}),
        ("/**:\n  ros__parameters:\n    speed: 2.25\n", {"speed": 2.25}),
        ("/*:\n  ros__parameters:\n    speed: 2.25\n", {"speed": 2.25}),
        ("/**/n1:\n  ros__parameters:\n    name: ann\n", {"name": "ann"}),
        ("/other:\n  ros__parameters:\n    speed: 9.0\n", {}),
        ("/*/n1:\n  ros__parameters:\n    speed: 9.0\n", {}),
        (
            "n1:\n  ros__parameters:\n    speed: 1\n",
            {"speed": "Trying to set parameter 'speed' to '1' of type 'INTEGER', expecting type 'DOUBLE'"},
        ),
        ("/**:\n  ros__parameters: {speed: 1.0}\nn1:\n  ros__parameters: {speed: 3.0}\n", {"speed": 3.0}),
    ],
)
def test_values_in_a_file_are_for_the_nodes_that_its_names_match(
    world: World, tmp_path: Path, content: str, changed: dict[str, Any]
) -> None:
    (tmp_path / "p.yaml").write_text(content)
    assert declared(["--ros-args", "--params-file", str(tmp_path / "p.yaml")]) == {**UNCHANGED, **changed}


@pytest.mark.parametrize(
    ("content", "complaint"),
    [
        ("n1:\n  speed: 1.0\n", "Cannot have a value before ros__parameters at line 2"),
        ("n1: [1, 2\n", "Error parsing a event near line 2: expected ',' or ']'"),
        ("x\n", "Cannot have a value before ros__parameters at line 1: a file maps the names of nodes"),
        (
            "n1:\n  ros__parameters:\n    gains: [1, 2.5]\n",
            "Sequence should be of same type. Value type 'double' do not belong at line 3; write 1.0",
        ),
        ("n1:\n  ros__parameters:\n    empty:\n", "No value at line 3; an empty text is written"),
        (None, "Error opening YAML file"),
    ],
)
def test_a_bad_parameter_file_is_refused_at_the_start(
    world: World, tmp_path: Path, content: str | None, complaint: str
) -> None:
    if content is not None:
        (tmp_path / "p.yaml").write_text(content)
    arguments = ["prog", "--ros-args", "--params-file", str(tmp_path / "p.yaml")]
    text = message_of(RCLError, lambda: rclpy.init(args=arguments))
    file = tmp_path / "p.yaml"
    assert text.startswith(f"failed to initialize rcl: Couldn't parse params file: '--params-file {file}'. Error: ")
    assert complaint in text


def test_values_given_to_the_constructor_go_before_those_of_the_command_line(world: World) -> None:
    rclpy.init(args=["prog", "--ros-args", "-p", "speed:=1.5", "-p", "extra:=7"])
    overrides = [Parameter("speed", value=2.5)]
    node = Node("n1", parameter_overrides=overrides)
    assert node.declare_parameter("speed", 0.5).value == 2.5
    assert node.declare_parameter("extra", 1, ignore_override=True).value == 1
    own = Node("n2", cli_args=["--ros-args", "-p", "speed:=9.5", "-r", "__node:=mine"])
    assert own.declare_parameter("speed", 0.5).value == 9.5
    assert own.get_name() == "mine"
    alone = Node("n3", use_global_arguments=False)
    assert alone.declare_parameter("speed", 0.5).value == 0.5
    eager = Node("eager", automatically_declare_parameters_from_overrides=True)
    assert eager.get_parameter("extra").value == 7


def test_an_empty_list_in_a_file_is_a_parameter_without_a_value(world: World, tmp_path: Path) -> None:
    file = tmp_path / "params.yaml"
    file.write_text("/**:\n  ros__parameters:\n    empty: []\n    speed: 1.5\n")
    rclpy.init(args=["prog", "--ros-args", "--params-file", str(file)])
    node = Node("eager", automatically_declare_parameters_from_overrides=True)
    assert node.has_parameter("empty") and node.get_parameter_or("empty", Parameter("else", value=3)).value == 3
    assert node.get_parameter_type("empty") == Parameter.Type.NOT_SET.value
    assert node.get_parameter("speed").value == 1.5


def test_a_parameters_message_without_a_value_is_no_default(world: World) -> None:
    rclpy.init(args=[])
    with pytest.raises(ValueError, match="default value of type PARAMETER_NOT_SET"):
        Node("n").declare_parameter("speed", ParameterValue())


def test_an_override_out_of_range_ends_the_declaration(world: World) -> None:
    rclpy.init(args=["prog", "--ros-args", "-p", "speed:=5.0"])
    node = rclpy.create_node("n1")
    text = message_of(InvalidParameterValueException, lambda: node.declare_parameter("speed", 0.5, within(0.0, 2.0)))
    assert "Parameter speed out of range Min: 0.0, Max: 2.0, value: 5.0" in text


# ---------------------------------------------------------------- over the wire


def demo() -> None:
    """A node with a parameter of each sort, as in the recordings of the command line."""
    rclpy.init()
    node = rclpy.create_node("param_demo")
    node.declare_parameter("speed", 0.5, within(0.0, 2.0))
    node.declare_parameter("fixed", 7, ParameterDescriptor(read_only=True))
    node.declare_parameter("name", "turtle")
    node.declare_parameter("gains.p", 1.0)
    node.declare_parameter("gains.deep.d", 0.1)
    node.declare_parameter("typed", Type.INTEGER)
    node.declare_parameter("dyn", 1, ParameterDescriptor(dynamic_typing=True))
    rclpy.spin(node)


@pytest.fixture
def ask(world: World) -> Callable[..., Any]:
    """Returns `ask(Service, field=value, …)`: calls one of the parameter services of /param_demo."""
    world.spawn(demo, name="demo")
    rclpy.init()
    node = rclpy.create_node("asker")

    def ask(kind: Any, **fields: Any) -> Any:
        words = "".join(f"_{letter.lower()}" if letter.isupper() else letter for letter in kind.__name__)
        client = node.create_client(kind, f"/param_demo/{words.lstrip('_')}")
        assert client.wait_for_service(timeout_sec=1.0)
        return client.call(kind.Request(**fields))

    return ask


def test_every_node_offers_six_parameter_services(world: World) -> None:
    rclpy.init()
    node = rclpy.create_node("n")
    assert [name for name, _ in node.get_service_names_and_types_by_node("n", "/")] == [
        "/n/describe_parameters",
        "/n/get_parameter_types",
        "/n/get_parameters",
        "/n/list_parameters",
        "/n/set_parameters",
        "/n/set_parameters_atomically",
    ]
    quiet = Node("quiet", start_parameter_services=False)
    assert quiet.get_service_names_and_types_by_node("quiet", "/") == []


def test_values_are_read_over_the_wire_all_or_none(ask: Callable[..., Any]) -> None:
    speed, name = ask(GetParameters, names=["speed", "name"]).values
    assert (speed.type, speed.double_value, name.string_value) == (3, 0.5, "turtle")
    assert ask(GetParameters, names=["speed", "nope"]).values == []
    assert ask(GetParameters, names=["typed"]).values == []


def test_types_are_read_over_the_wire(ask: Callable[..., Any]) -> None:
    assert list(ask(GetParameterTypes, names=["speed", "fixed", "typed"]).types) == [3, 2, 0]
    assert list(ask(GetParameterTypes, names=["speed", "nope"]).types) == []


def test_descriptors_are_read_over_the_wire(ask: Callable[..., Any]) -> None:
    speed, fixed = ask(DescribeParameters, names=["speed", "fixed"]).descriptors
    assert (speed.name, speed.type, speed.floating_point_range[0].to_value) == ("speed", 3, 2.0)
    assert (fixed.read_only, fixed.type) == (True, 2)
    assert ask(DescribeParameters, names=["nope"]).descriptors == []


def test_names_are_listed_over_the_wire(ask: Callable[..., Any]) -> None:
    everything = ask(ListParameters).result
    names = ["use_sim_time", "speed", "fixed", "name", "gains.p", "gains.deep.d", "typed", "dyn"]
    assert list(everything.names) == names
    assert list(everything.prefixes) == ["gains", "gains.deep"]
    assert list(ask(ListParameters, depth=1).result.names) == [name for name in names if "." not in name]
    assert list(ask(ListParameters, prefixes=["gains"]).result.names) == ["gains.p", "gains.deep.d"]
    assert list(ask(ListParameters, prefixes=["gains", "name"], depth=1).result.names) == ["name", "gains.p"]
    assert list(ask(ListParameters, prefixes=["gai", "ty"]).result.names) == ["typed"]


def test_values_are_set_over_the_wire(ask: Callable[..., Any]) -> None:
    def attempt(name: str, value: Any) -> tuple[bool, str]:
        wish = Parameter(name, value=value).to_parameter_msg()
        (result,) = ask(SetParameters, parameters=[wish]).results
        return result.successful, result.reason

    assert attempt("speed", 1.5) == (True, "")
    assert attempt("speed", 1) == (False, "Wrong parameter type, expected 'Type.DOUBLE' got 'Type.INTEGER'")
    assert attempt("speed", "fast") == (
        False,
        "Wrong parameter type, expected 'Type.DOUBLE' got 'Type.STRING'",
    )
    assert attempt("speed", 5.0) == (False, "Parameter speed out of range Min: 0.0, Max: 2.0, value: 5.0")
    assert attempt("fixed", 8) == (False, "Trying to set a read-only parameter: fixed.")
    assert attempt("name", True) == (False, "Wrong parameter type, expected 'Type.STRING' got 'Type.BOOL'")
    assert attempt("name", "bob") == (True, "")
    assert attempt("use_sim_time", "abc") == (
        False,
        "Wrong parameter type, expected 'Type.BOOL' got 'Type.STRING'",
    )
    # Where the real one forgets to name the parameter and says [], ours names it.
    assert attempt("nope", 1) == (False, "('Invalid access to undeclared parameter(s)', ['nope'])")
    assert ask(GetParameters, names=["speed"]).values[0].double_value == 1.5


def test_deleting_over_the_wire_is_setting_to_nothing(ask: Callable[..., Any]) -> None:
    def delete(name: str) -> tuple[bool, str]:
        (result,) = ask(SetParameters, parameters=[Parameter(name).to_parameter_msg()]).results
        return result.successful, result.reason

    assert delete("name") == (False, "Static parameter cannot be undeclared")
    assert delete("dyn") == (True, "")
    assert "dyn" not in ask(ListParameters).result.names


def test_several_are_set_at_once_over_the_wire(ask: Callable[..., Any]) -> None:
    good, bad = (
        Parameter("name", value="bob").to_parameter_msg(),
        Parameter("fixed", value=1).to_parameter_msg(),
    )
    result = ask(SetParametersAtomically, parameters=[good, bad]).result
    assert (result.successful, result.reason) == (False, "Trying to set a read-only parameter: fixed.")
    assert ask(GetParameters, names=["name"]).values[0].string_value == "turtle"
    assert ask(SetParametersAtomically, parameters=[good]).result.successful
    assert ask(GetParameters, names=["name"]).values[0].string_value == "bob"


# ---------------------------------------------------------------- events


def test_what_becomes_of_parameters_is_told_on_a_topic(run: Callable[..., list[Any]]) -> None:
    def listen(found: list[Any]) -> None:
        def note(event: ParameterEvent) -> None:
            if event.node == "/turtle/tester":
                kinds = (event.new_parameters, event.changed_parameters, event.deleted_parameters)
                found.append((event.stamp.nanosec, *([each.name for each in kind] for kind in kinds)))

        rclpy.init()
        node = rclpy.create_node("listener")
        node.create_subscription(ParameterEvent, "/parameter_events", note, 10)
        rclpy.spin(node)

    def change(found: list[Any]) -> None:
        rclpy.init()
        node = rclpy.create_node("tester", namespace="turtle")
        node.declare_parameter("speed", 0.5)
        node.declare_parameter("dyn", 1, ParameterDescriptor(dynamic_typing=True))
        node.declare_parameter("typed", Type.INTEGER)
        steps = iter([("speed", 0.7), ("speed", "refused"), ("typed", 3), ("typed", 4), ("dyn", None)])
        timer = node.create_timer(0.1, lambda: tick())

        def tick() -> None:
            step = next(steps, None)
            if step is None:
                node.undeclare_parameter("speed")  # of this nothing is told
                timer.cancel()
            else:
                set_one(node, *step)

        rclpy.spin(node)

    assert run(listen, change, seconds=1.0) == [
        (0, ["use_sim_time"], [], []),
        (0, ["speed"], [], []),
        (0, ["dyn"], [], []),
        (0, ["typed"], [], []),
        (100_000_000, [], ["speed"], []),
        (300_000_000, ["typed"], [], []),
        (400_000_000, [], ["typed"], []),
        (500_000_000, [], [], ["dyn"]),
    ]
