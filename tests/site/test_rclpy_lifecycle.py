"""Managed nodes: the states, who is asked about transitions, what is told of them, and what happens to errors."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest
import rclpy
from lifecycle_msgs.msg import TransitionEvent
from lifecycle_msgs.srv import ChangeState, GetAvailableStates, GetAvailableTransitions, GetState
from rclpy.exceptions import RCLError
from rclpy.lifecycle import (
    LifecycleNode,
    LifecycleNodeMixin,
    LifecyclePublisher,
    LifecycleState,
    ManagedEntity,
    SimpleManagedEntity,
    TransitionCallbackReturn,
)
from rclpy.node import Node
from std_msgs.msg import String

from turtle_lesson.ros.runtime.world import World

Run = Callable[..., list[Any]]
Capture = pytest.CaptureFixture[str]
SUCCESS, FAILURE, ERROR = TransitionCallbackReturn


@pytest.fixture
def node(world: World) -> LifecycleNode:
    """A managed node that does nothing."""
    rclpy.init(args=[])
    return LifecycleNode("managed")


def state_of(node: Any) -> str:
    """The state that a managed node is in."""
    return node._state_machine.current_state[1]


# ---------------------------------------------------------------- the way through the states


def test_a_node_goes_from_unconfigured_over_inactive_to_active_and_back_and_ends(node: LifecycleNode) -> None:
    states = [state_of(node)]
    for trigger in (
        node.trigger_configure,
        node.trigger_activate,
        node.trigger_deactivate,
        node.trigger_cleanup,
        node.trigger_shutdown,
    ):
        assert trigger() is SUCCESS
        states.append(state_of(node))
    assert states == ["unconfigured", "inactive", "active", "inactive", "unconfigured", "finalized"]
    with pytest.raises(RCLError, match="Shutdown transtion not possible"):
        node.trigger_shutdown()


def test_a_transition_that_is_not_possible_says_what_is(node: LifecycleNode, capsys: Capture) -> None:
    with pytest.raises(RCLError) as caught:
        node.trigger_activate()
    assert str(caught.value) == "Failed to trigger lifecycle state machine transition: Transition is not registered."
    assert caught.value.__notes__ == ["The node is unconfigured; possible from there: configure [1], shutdown [5]."]
    assert "[rcl_lifecycle]: No transition matching 3 found for current state unconfigured" in capsys.readouterr().out
    assert state_of(node) == "unconfigured"


@pytest.mark.parametrize("configured", [False, True])
def test_every_state_that_is_at_rest_can_be_shut_down(node: LifecycleNode, configured: bool) -> None:
    if configured:
        node.trigger_configure()
        node.trigger_activate()
    node.trigger_shutdown()
    assert state_of(node) == "finalized"


class Stubborn(LifecycleNode):
    """Answers with what it is given, and notes what it is asked."""

    def __init__(self, **answers: Any) -> None:
        self.answers = answers
        self.asked: list[tuple[str, LifecycleState]] = []
        super().__init__("stubborn")

    def _answer(self, name: str, state: LifecycleState) -> Any:
        self.asked.append((name, state))
        answer = self.answers.get(name, SUCCESS)
        if isinstance(answer, Exception):
            raise answer
        return answer

    def on_configure(self, state: LifecycleState) -> Any:
        return self._answer("configure", state)

    def on_error(self, state: LifecycleState) -> Any:
        return self._answer("error", state)


@pytest.mark.parametrize(
    ("answers", "outcome", "state", "asked"),
    [
        ({"configure": FAILURE}, FAILURE, "unconfigured", ["configure"]),
        ({"configure": ERROR}, ERROR, "unconfigured", ["configure", "error"]),
        ({"configure": ERROR, "error": FAILURE}, ERROR, "finalized", ["configure", "error"]),
        ({"configure": ERROR, "error": ERROR}, ERROR, "finalized", ["configure", "error"]),
        ({"configure": ValueError("no camera")}, ERROR, "unconfigured", ["configure", "error"]),
        ({"configure": ERROR, "error": ValueError("worse")}, ERROR, "finalized", ["configure", "error"]),
    ],
)
def test_what_a_callback_answers_decides_where_the_node_ends(
    world: World, answers: dict[str, Any], outcome: Any, state: str, asked: list[str]
) -> None:
    rclpy.init(args=[])
    node = Stubborn(**answers)
    assert node.trigger_configure() is outcome
    assert state_of(node) == state
    assert [name for name, _ in node.asked] == asked
    assert {given for _, given in node.asked} == {LifecycleState(label="unconfigured", state_id=1)}


def test_an_error_in_a_callback_is_logged_with_its_place(world: World, capsys: Capture) -> None:
    rclpy.init(args=[])
    Stubborn(configure=ValueError("no camera")).trigger_configure()
    (line,) = capsys.readouterr().out.splitlines()
    assert "[ERROR] [1800000000.000000000] [stubborn]: on_configure raised ValueError: no camera (" in line
    assert "test_rclpy_lifecycle.py, line " in line


def test_a_callback_that_forgets_to_answer_is_told_how(world: World) -> None:
    rclpy.init(args=[])
    with pytest.raises(AttributeError) as caught:
        Stubborn(configure=None).trigger_configure()
    assert str(caught.value) == "'NoneType' object has no attribute 'to_label'"
    assert caught.value.__notes__ == [
        "on_configure returned None; end it with `return TransitionCallbackReturn.SUCCESS`."
    ]


# ---------------------------------------------------------------- managed entities


class Part(ManagedEntity):
    """Notes what it is told, and refuses one thing."""

    def __init__(self, name: str, told: list[str], refuses: str = "") -> None:
        self.name, self.told, self.refuses = name, told, refuses

    def __getattribute__(self, name: str) -> Any:
        if not name.startswith("on_"):
            return super().__getattribute__(name)
        self.told.append(f"{self.name}.{name}")
        return lambda state: FAILURE if name == self.refuses else SUCCESS


def test_the_parts_of_a_node_are_asked_in_order_up_to_the_first_that_refuses(node: LifecycleNode) -> None:
    told: list[str] = []
    for part in (Part("a", told), Part("b", told, refuses="on_activate"), Part("c", told)):
        node.add_managed_entity(part)
        node.add_managed_entity(part)  # once is enough
    assert node.trigger_configure() is SUCCESS
    assert told == ["a.on_configure", "b.on_configure", "c.on_configure"]
    told.clear()
    assert node.trigger_activate() is FAILURE
    assert told == ["a.on_activate", "b.on_activate"]
    assert state_of(node) == "inactive"


def test_a_simple_part_is_enabled_while_its_node_is_active(node: LifecycleNode) -> None:
    done: list[str] = []

    class Lamp(SimpleManagedEntity):
        @SimpleManagedEntity.when_enabled
        def shine(self, how: str) -> None:
            """Only where it may."""
            done.append(how)

        @SimpleManagedEntity.when_enabled(when_not_enabled=lambda: done.append("off"))
        def blink(self) -> None:
            done.append("blink")

    lamp = Lamp()
    node.add_managed_entity(lamp)
    node.trigger_configure()
    lamp.shine("dark")
    lamp.blink()
    node.trigger_activate()
    assert lamp.is_activated
    lamp.shine("bright")
    lamp.blink()
    node.trigger_deactivate()
    assert not lamp.is_activated
    assert done == ["off", "bright", "blink"]
    assert Lamp.shine.__doc__ == "Only where it may."


def test_a_lifecycle_publisher_publishes_only_while_its_node_is_active(run: Run) -> None:
    def program(found: list[Any]) -> None:
        rclpy.init(args=[])
        node = LifecycleNode("talker")
        publisher = node.create_lifecycle_publisher(String, "chatter", 10)
        assert type(publisher) is LifecyclePublisher
        with pytest.raises(TypeError, match="multiple values for keyword argument 'publisher_class'"):
            node.create_lifecycle_publisher(String, "chatter", 10, publisher_class=LifecyclePublisher)
        node.create_subscription(String, "chatter", lambda message: found.append(message.data), 10)
        for trigger in ("configure", "activate", "deactivate"):
            getattr(node, f"trigger_{trigger}")()
            publisher.publish(String(data=trigger))
            rclpy.spin_once(node, timeout_sec=0.1)
        assert node.destroy_lifecycle_publisher(publisher)
        assert not node.destroy_lifecycle_publisher(publisher)

    assert run(program) == ["activate"]


def test_a_node_of_ones_own_base_can_be_managed_too(world: World) -> None:
    class Mine(LifecycleNodeMixin, Node):
        def __init__(self) -> None:
            Node.__init__(self, "mine", namespace="/robots")
            LifecycleNodeMixin.__init__(self, enable_communication_interface=False)

    rclpy.init(args=[])
    node = Mine()
    node.trigger_configure()
    assert state_of(node) == "inactive"
    names = [name for name, _ in node.get_service_names_and_types() if "state" in name or "transition" in name]
    assert names == []
    assert dict(node.get_topic_names_and_types())["/robots/mine/transition_event"] == [
        "lifecycle_msgs/msg/TransitionEvent"
    ]


# ---------------------------------------------------------------- over the wire


def talker() -> None:
    """A managed node that is spun."""
    rclpy.init(args=[])
    rclpy.spin(Stubborn())


@pytest.fixture
def ask(world: World) -> Callable[..., Any]:
    """Returns `ask(kind, service, **request)`: asks the managed node that runs in another process."""
    world.spawn(talker, name="talker")
    rclpy.init(args=[])
    node = rclpy.create_node("asker")
    world.sim.run_until(100_000_000)

    def ask(kind: Any, service: str, **request: Any) -> Any:
        client = node.create_client(kind, f"/stubborn/{service}")
        return client.call(kind.Request(**request))

    return ask


def transition(number: int = 0, label: str = "") -> Any:
    """The request to make a transition."""
    request = ChangeState.Request()
    request.transition.id, request.transition.label = number, label
    return request.transition


def test_states_are_asked_for_and_changed_by_services(ask: Callable[..., Any]) -> None:
    def state() -> tuple[int, str]:
        current = ask(GetState, "get_state").current_state
        return current.id, current.label

    assert state() == (1, "unconfigured")
    assert ask(ChangeState, "change_state", transition=transition(1)).success
    assert state() == (2, "inactive")
    assert ask(ChangeState, "change_state", transition=transition(label="activate")).success
    assert state() == (3, "active")
    assert not ask(ChangeState, "change_state", transition=transition(label="configure")).success
    assert state() == (3, "active")


def test_a_service_lists_all_states(ask: Callable[..., Any]) -> None:
    states = ask(GetAvailableStates, "get_available_states").available_states
    at_rest = ["unknown", "unconfigured", "inactive", "active", "finalized"]
    under_way = ["configuring", "cleaningup", "shuttingdown", "activating", "deactivating", "errorprocessing"]
    assert [each.label for each in states] == at_rest + under_way
    assert [each.id for each in states] == [0, 1, 2, 3, 4, 10, 11, 12, 13, 14, 15]


def test_services_list_the_transitions_that_are_possible_now_and_all(ask: Callable[..., Any]) -> None:
    def names(service: str) -> list[str]:
        found = ask(GetAvailableTransitions, service).available_transitions
        return [f"{each.transition.label} {each.start_state.label} {each.goal_state.label}" for each in found]

    assert names("get_available_transitions") == [
        "configure unconfigured configuring",
        "shutdown unconfigured shuttingdown",
    ]
    graph = names("get_transition_graph")
    assert len(graph) == 25
    assert graph[1] == "transition_success configuring inactive"
    assert graph[-1] == "transition_error errorprocessing finalized"


def test_a_wrong_transition_ends_the_nodes_spin(world: World, capsys: Capture) -> None:
    def program() -> None:
        rclpy.init(args=[])
        node = LifecycleNode("managed")
        node.create_client(ChangeState, "~/change_state").call_async(ChangeState.Request(transition=transition(2)))
        rclpy.spin(node)

    process = world.spawn(program, name="program")
    world.sim.run_until(1_000_000_000)
    told = capsys.readouterr().err.splitlines()
    assert told[0].endswith("[rcl_lifecycle]: No transition matching 2 found for current state unconfigured")
    assert process.exit_code == 1 and told[-2:] == [
        "rclpy._rclpy_pybind11.RCLError: Failed to trigger lifecycle state machine transition: Transition is not registered.",
        "The node is unconfigured; possible from there: configure [1], shutdown [5].",
    ]


def test_every_step_is_told_on_a_topic(run: Run) -> None:
    def program(found: list[Any]) -> None:
        rclpy.init(args=[])
        node = LifecycleNode("managed")

        def heard(event: TransitionEvent) -> None:
            found.append((event.start_state.label, event.goal_state.label, event.goal_state.id))

        node.create_subscription(TransitionEvent, "~/transition_event", heard, 10)
        node.trigger_configure()
        for _ in range(2):
            rclpy.spin_once(node, timeout_sec=0.1)

    assert run(program) == [("unconfigured", "configuring", 10), ("configuring", "inactive", 2)]


def test_the_aliases_of_the_tutorials(world: World) -> None:
    assert rclpy.lifecycle.Node is LifecycleNode
    assert rclpy.lifecycle.State is LifecycleState
    assert rclpy.lifecycle.Publisher is LifecyclePublisher
    assert [(each.name, each.value, each.to_label()) for each in TransitionCallbackReturn] == [
        ("SUCCESS", 97, "transition_success"),
        ("FAILURE", 98, "transition_failure"),
        ("ERROR", 99, "transition_error"),
    ]
