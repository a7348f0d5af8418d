"""Parameters of other nodes: asking and setting them, hearing of changes, and reading them from files."""

from __future__ import annotations

import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import rclpy
from hypothesis import given
from hypothesis import strategies as st
from rcl_interfaces.msg import ParameterDescriptor, ParameterValue
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
from rclpy.node import Node
from rclpy.parameter import Parameter, get_parameter_value, parameter_dict_from_yaml_file, parameter_value_to_python
from rclpy.parameter_client import AsyncParameterClient
from rclpy.parameter_event_handler import ParameterEventHandler

from turtle_lesson.ros.runtime.world import World
from turtle_lesson.ros.sim.errors import NeverWakes

Run = Callable[..., list[Any]]


def demo() -> None:
    """A node with some parameters."""
    rclpy.init(args=[])
    node = rclpy.create_node("demo")
    node.declare_parameter("speed", 0.5)
    node.declare_parameter("arm.length", 3)
    node.declare_parameter("any", "x", ParameterDescriptor(dynamic_typing=True))
    rclpy.spin(node)


@pytest.fixture
def client(world: World) -> AsyncParameterClient:
    """A client of that node, which runs in a process of its own."""
    world.spawn(demo, name="demo")
    rclpy.init(args=[])
    client = AsyncParameterClient(Node("asker"), "demo")
    assert not client.services_are_ready()
    assert client.wait_for_services()
    return client


def answer(client: AsyncParameterClient, future: Any) -> Any:
    """What a future has at its end."""
    rclpy.spin_until_future_complete(client.node, future)
    return future.result()


def test_values_types_descriptors_and_names_are_asked_for(client: AsyncParameterClient) -> None:
    values = answer(client, client.get_parameters(["speed", "arm.length"])).values
    assert list(map(parameter_value_to_python, values)) == [0.5, 3]
    assert list(answer(client, client.get_parameter_types(["speed", "any"])).types) == [3, 4]
    (descriptor,) = answer(client, client.describe_parameters(["any"])).descriptors
    assert (descriptor.name, descriptor.dynamic_typing) == ("any", True)
    assert answer(client, client.list_parameters()).result.names == ["use_sim_time", "speed", "arm.length", "any"]
    assert answer(client, client.list_parameters(["arm"], 1)).result.names == ["arm.length"]


def test_values_are_set_one_by_one_or_all_at_once(client: AsyncParameterClient) -> None:
    wishes = [Parameter("speed", value=1.5), Parameter("arm.length", value=1.5).to_parameter_msg()]
    results = answer(client, client.set_parameters(wishes)).results
    assert [each.successful for each in results] == [True, False]
    result = answer(client, client.set_parameters_atomically([Parameter("speed", value=9.0), *wishes[1:]])).result
    assert result.reason == "Wrong parameter type, expected 'Type.INTEGER' got 'Type.DOUBLE'"
    assert parameter_value_to_python(answer(client, client.get_parameters(["speed"])).values[0]) == 1.5


def test_only_what_is_typed_dynamically_can_be_deleted(client: AsyncParameterClient) -> None:
    results = answer(client, client.delete_parameters(["any", "speed"])).results
    assert [each.reason for each in results] == ["", "Static parameter cannot be undeclared"]
    assert "any" not in answer(client, client.list_parameters()).result.names


def test_where_one_name_is_unknown_nothing_is_told_of_any(client: AsyncParameterClient) -> None:
    names = ["speed", "nonsense"]
    assert list(answer(client, client.get_parameters(names)).values) == []
    assert list(answer(client, client.get_parameter_types(names)).types) == []
    assert list(answer(client, client.describe_parameters(names)).descriptors) == []
    results = answer(client, client.set_parameters([Parameter(name, value=2.0) for name in names])).results
    assert [each.successful for each in results] == [True, False]
    assert "nonsense" in results[1].reason
    assert not answer(client, client.set_parameters_atomically([Parameter("nonsense", value=1)])).result.successful


def test_several_requests_may_be_under_way_and_each_future_has_its_own_answer(client: AsyncParameterClient) -> None:
    told: list[str] = []
    futures = [
        client.set_parameters([Parameter("speed", value=2.0)], lambda _: told.append("set")),
        client.get_parameters(["speed"], lambda _: told.append("got")),
        client.list_parameters(["arm"], callback=lambda _: told.append("listed")),
        client.describe_parameters(["speed"], lambda _: told.append("described")),
        client.get_parameter_types(["speed"], lambda _: told.append("types")),
        client.delete_parameters(["any"], lambda _: told.append("deleted")),
    ]
    for future in futures:
        answer(client, future)
    for _ in futures:
        rclpy.spin_once(client.node, timeout_sec=0.01)
    assert sorted(told) == ["deleted", "described", "got", "listed", "set", "types"]
    assert parameter_value_to_python(futures[1].result().values[0]) == 2.0
    assert list(futures[2].result().result.prefixes) == ["arm"]


def test_a_callback_may_await_parameters_of_another_node(run: Run) -> None:
    def program(found: list[Any]) -> None:
        rclpy.init(args=[])
        node = Node("asker", namespace="deep")
        client = AsyncParameterClient(node, "/demo", callback_group=MutuallyExclusiveCallbackGroup())
        client.wait_for_services()

        async def speed_up() -> None:
            response = await client.get_parameters(["speed"])
            speed = parameter_value_to_python(response.values[0])
            result = await client.set_parameters([Parameter("speed", value=speed * 2)])
            found.append((speed, result.results[0].successful))

        node.create_timer(0.5, speed_up)
        while time.monotonic() < 1.9:
            rclpy.spin_once(node, timeout_sec=0.05)

    assert run(lambda _: demo(), program) == [(0.5, True), (1.0, True), (2.0, True)]


def test_a_callback_is_told_of_the_answer(client: AsyncParameterClient) -> None:
    heard: list[Any] = []
    answer(client, client.get_parameters(["speed"], heard.append))
    rclpy.spin_once(client.node, timeout_sec=0.1)
    assert [parameter_value_to_python(future.result().values[0]) for future in heard] == [0.5]


def test_a_file_is_loaded(client: AsyncParameterClient, tmp_path: Path) -> None:
    file = tmp_path / "demo.yaml"
    file.write_text(
        "/demo:\n  ros__parameters:\n    speed: 2.5\n    arm: {length: 7}\n/**:\n  ros__parameters: {any: 5}\n"
    )
    assert [each.successful for each in answer(client, client.load_parameter_file(str(file))).results] == [True, True]
    assert answer(client, client.load_parameter_file_atomically(str(file), use_wildcard=True)).result.successful
    values = answer(client, client.get_parameters(["speed", "arm.length", "any"])).values
    assert list(map(parameter_value_to_python, values)) == [2.5, 7, 5]


def test_services_that_do_not_come_are_waited_for_as_long_as_one_is_told(run: Run) -> None:
    def program(found: list[Any]) -> None:
        rclpy.init(args=[])
        client = AsyncParameterClient(Node("asker"), "nobody")
        found.append(client.wait_for_services(timeout_sec=1.0))

    assert run(program) == [False]


def test_an_answer_that_can_never_be_is_not_waited_for(run: Run) -> None:
    def program(found: list[Any]) -> None:
        rclpy.init(args=[])
        node = Node("lonely")
        client = AsyncParameterClient(node, "lonely")

        def ask() -> None:
            with pytest.raises(NeverWakes):
                rclpy.spin_until_future_complete(node, client.get_parameters(["use_sim_time"]))
            found.append("explained")
            timer.cancel()

        timer = node.create_timer(0.1, ask)
        rclpy.spin(node)

    assert run(program) == ["explained"]


def test_events_of_all_nodes_are_heard(client: AsyncParameterClient) -> None:
    heard: list[Any] = []
    client.on_parameter_event(
        lambda event: heard.append((event.node, [each.name for each in event.changed_parameters]))
    )
    answer(client, client.set_parameters([Parameter("speed", value=1.0)]))
    rclpy.spin_once(client.node, timeout_sec=0.5)
    assert heard == [("/demo", ["speed"])]


# ---------------------------------------------------------------- ParameterEventHandler


def changes(run: Run, prepare: Callable[[ParameterEventHandler, list[Any]], object]) -> list[Any]:
    """What is noted while two nodes change parameters: `/watcher` its own, and `/ns/other` two."""

    def program(found: list[Any]) -> None:
        rclpy.init(args=[])
        watcher, other = Node("watcher", namespace="ns"), Node("other", namespace="ns")
        for node in (watcher, other):
            node.declare_parameters("", [("speed", 0.0), ("name", "")])
        handler = ParameterEventHandler(watcher)
        prepare(handler, found)
        watcher.set_parameters([Parameter("speed", value=1.0)])
        other.set_parameters([Parameter("speed", value=2.0), Parameter("name", value="ann")])
        for _ in range(12):
            rclpy.spin_once(watcher, timeout_sec=0.1)
        handler.destroy()
        found.append(len(list(watcher.subscriptions)))

    return run(program)


def test_a_parameter_of_a_node_is_watched(run: Run) -> None:
    def prepare(handler: ParameterEventHandler, found: list[Any]) -> None:
        for node in ("", "other", "/ns/other", "/other"):
            handler.add_parameter_callback(
                "speed", node, lambda parameter, node=node: found.append((node, parameter.value.double_value))
            )

    assert changes(run, prepare) == [("", 1.0), ("/ns/other", 2.0), ("other", 2.0), 0]


def test_whole_events_are_watched_and_the_newest_callback_comes_first(run: Run) -> None:
    def prepare(handler: ParameterEventHandler, found: list[Any]) -> None:
        for name in ("first", "second"):
            handler.add_parameter_event_callback(lambda event, name=name: found.append((name, event.node)))
        gone = handler.add_parameter_event_callback(lambda event: found.append("gone"))
        handler.remove_parameter_event_callback(gone)
        with pytest.raises(RuntimeError, match="Callback doesn't exist"):
            handler.remove_parameter_event_callback(gone)

    heard = [(name, node) for node in ("/ns/watcher", "/ns/other", "/ns/other") for name in ("second", "first")]
    assert changes(run, prepare) == [*heard, 0]


def test_callbacks_can_be_taken_away(run: Run) -> None:
    def prepare(handler: ParameterEventHandler, found: list[Any]) -> None:
        handle = handler.add_parameter_callback("speed", "other", lambda parameter: found.append("heard"))
        assert (handle.parameter_name, handle.node_name) == ("speed", "/ns/other")
        handler.remove_parameter_callback(handle)
        with pytest.raises(RuntimeError, match="Callback doesn't exist"):
            handler.remove_parameter_callback(handle)
        handler.add_parameter_event_callback(
            lambda event: found.extend(each.name for each in handler.get_parameters_from_event(event))
        )

    assert changes(run, prepare) == ["speed", "speed", "name", 0]


def test_a_callback_may_take_itself_away(run: Run) -> None:
    def prepare(handler: ParameterEventHandler, found: list[Any]) -> None:
        def once(parameter: Any) -> None:
            found.append((parameter.name, parameter.value.double_value))
            handler.remove_parameter_callback(handle)

        def first_event(event: Any) -> None:
            found.append(event.node)
            handler.remove_parameter_event_callback(event_handle)

        handle = handler.add_parameter_callback("speed", "other", once)
        handler.add_parameter_callback("speed", "other", lambda parameter: found.append("stays"))
        event_handle = handler.add_parameter_event_callback(first_event)

    assert changes(run, prepare) == ["/ns/watcher", "stays", ("speed", 2.0), 0]


def test_what_is_deleted_is_no_change_of_a_value(run: Run) -> None:
    def program(found: list[Any]) -> None:
        rclpy.init(args=[])
        node = Node("n")
        handler = ParameterEventHandler(node, callback_group=MutuallyExclusiveCallbackGroup())
        handler.add_parameter_callback("speed", "", lambda parameter: found.append(parameter.value.integer_value))
        handler.add_parameter_event_callback(lambda event: found.extend(each.name for each in event.deleted_parameters))
        node.declare_parameter("speed", 5, ParameterDescriptor(dynamic_typing=True))
        node.set_parameters([Parameter("speed")])
        for _ in range(5):
            rclpy.spin_once(node, timeout_sec=0.1)

    assert run(program) == [5, "speed"]


# ---------------------------------------------------------------- values from texts and files


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("true", True),
        ("1", 1),
        ("1.5", 1.5),
        ("[]", []),
        ("[1, 2]", [1, 2]),
        ("[a, b]", ["a", "b"]),
        ("[1, a]", "[1, a]"),
        ("abc", "abc"),
        ("", ""),
        ("{a: 1}", "{a: 1}"),
        ("2027-01-15", "2027-01-15"),
        ("[", "["),
    ],
)
def test_a_text_is_read_as_yaml(text: str, value: object) -> None:
    found = get_parameter_value(text)
    assert parameter_value_to_python(found) == value
    assert found.type == {bool: 1, int: 2, float: 3, str: 4}.get(type(value), found.type)
    assert text != "[]" or found.type == Parameter.Type.BOOL_ARRAY.value


@given(st.text(max_size=30))
def test_any_text_is_a_value(text: str) -> None:
    assert isinstance(parameter_value_to_python(get_parameter_value(text)), (bool, int, float, str, list))


def test_a_type_that_there_is_not() -> None:
    with pytest.raises(ValueError, match=r"77 is not a valid Parameter\.Type"):
        parameter_value_to_python(ParameterValue(type=77))


FILE = """
/**:
  ros__parameters: {all: 1, speed: 0.0}
a:
  ros__parameters: {speed: 1.0, arm: {length: 2}}
b:
  ros__parameters: {speed: 3.0, name: [x, y]}
empty:
  ros__parameters:
"""


@pytest.mark.parametrize(
    ("options", "expected"),
    [
        ({}, {"speed": 3.0, "arm.length": 2, "name": ["x", "y"]}),
        ({"target_nodes": ["a"]}, {"speed": 1.0, "arm.length": 2}),
        ({"target_nodes": ["a"], "use_wildcard": True}, {"all": 1, "speed": 1.0, "arm.length": 2}),
        ({"target_nodes": ["a"], "namespace": "ns."}, {"ns.speed": 1.0, "ns.arm.length": 2}),
        ({"target_nodes": ["empty"]}, {}),
    ],
)
def test_a_file_becomes_messages_by_name(tmp_path: Path, options: dict[str, Any], expected: dict[str, Any]) -> None:
    (tmp_path / "p.yaml").write_text(FILE)
    found = parameter_dict_from_yaml_file(str(tmp_path / "p.yaml"), **options)
    assert {name: parameter_value_to_python(each.value) for name, each in found.items()} == expected
    assert all(name == each.name for name, each in found.items())


@pytest.mark.parametrize(
    ("text", "options", "complaint"),
    [
        (FILE, {"target_nodes": ["c"]}, "Param file does not contain parameters for c,only for nodes: "),
        ("/**:\n  ros__parameters: {a: 1}\n", {}, "Param file does not contain selected parameters"),
        ("a: {b: 1}\n", {}, "YAML file is not a valid ROS parameter file for node a"),
        ("5\n", {}, "YAML file is not a valid ROS parameter file: "),
    ],
)
def test_a_file_that_is_none_is_refused(tmp_path: Path, text: str, options: dict[str, Any], complaint: str) -> None:
    (tmp_path / "p.yaml").write_text(text)
    with pytest.raises(RuntimeError) as caught:
        parameter_dict_from_yaml_file(str(tmp_path / "p.yaml"), **options)
    assert str(caught.value).startswith(complaint)


# ---------------------------------------------------------------- any value

SCALARS = st.booleans() | st.integers(-(2**63), 2**63 - 1) | st.floats(allow_nan=False) | st.text(max_size=10)
LISTS = st.lists(st.booleans()) | st.lists(st.integers(-(2**63), 2**63 - 1)) | st.lists(st.floats(allow_nan=False))


@given(SCALARS | LISTS | st.lists(st.text(max_size=5)) | st.none())
def test_any_value_survives_its_message(value: Any) -> None:
    parameter = Parameter("p", value=value)
    back = Parameter.from_parameter_msg(parameter.to_parameter_msg())
    assert (back.name, list(back.value) if isinstance(value, list) else back.value) == ("p", value)
    assert value == [] or back.type_ is parameter.type_


@given(
    st.recursive(SCALARS | st.none() | st.binary(max_size=2), lambda inner: st.lists(inner, max_size=3), max_leaves=6)
)
def test_any_value_at_all_is_taken_or_refused_with_a_sentence(value: Any) -> None:
    try:
        kind = Parameter.Type.from_parameter_value(value)
    except TypeError as error:
        assert "allowed types" in str(error)
    else:
        if kind.check(value):
            assert Parameter("p", value=value).type_ is kind
        else:  # of a byte array each item is one byte
            with pytest.raises(ValueError, match="do not agree"):
                Parameter("p", value=value)
