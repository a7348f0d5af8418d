"""A network that is slow or loses messages, and what each quality of service makes of it (rmw/transport.py has the rules)."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from typing import Any

import pytest
import rclpy
from example_interfaces.srv import AddTwoInts
from hypothesis import given
from hypothesis import strategies as st
from rclpy.duration import Duration
from rclpy.event_handler import SubscriptionEventCallbacks
from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy
from std_msgs.msg import Int32

from turtle_lesson.ros.rmw.endpoint import Watchdog
from turtle_lesson.ros.rmw.network import Network, conditions
from turtle_lesson.ros.runtime.world import World, open_world
from turtle_lesson.ros.sim.errors import NeverWakes
from turtle_lesson.ros.sim.simulation import Simulation

Run = Callable[..., list[Any]]
SECOND = 1_000_000_000
EPOCH = 1_800_000_000
HASTY = QoSProfile(depth=10, reliability=ReliabilityPolicy.BEST_EFFORT)
ALL = QoSProfile(history=HistoryPolicy.KEEP_ALL)


class Radio:
    """A talker that publishes numbers, and one listener or more, over a topic of a world of their own."""

    def __init__(self, offered: Any = 10, requested: Any = ALL, period: float = 0.1, count: int = 100, seed: int = 0):
        self.world = open_world(seed)
        self.heard: list[int] = []
        self.when: list[tuple[float, float]] = []
        """When each number was sent, and when it was heard."""
        self.lost: list[int] = []
        self._offered, self._requested, self._period, self._count = offered, requested, period, count
        self._runs = False

    def network(self, **how: float) -> None:
        self.world.graph.set_network("/x", conditions(**how) if how else None)

    def run(self, seconds: float = 20.0) -> list[int]:
        if not self._runs:
            self._runs = True
            self.world.spawn(self._talk, name="talker")
            self.world.spawn(self._listen, name="listener")
        self.world.sim.run_until(self.world.now + round(seconds * SECOND))
        for process in self.world.processes:
            if process.error is not None:
                raise process.error
        return self.heard

    def _talk(self) -> None:
        rclpy.init()
        publisher = rclpy.create_node("talker").create_publisher(Int32, "x", self._offered)
        time.sleep(0.001)
        for number in range(self._count):
            publisher.publish(Int32(data=number))
            time.sleep(self._period)
        time.sleep(1000)

    def _listen(self) -> None:
        rclpy.init()
        node = rclpy.create_node("listener")
        events = SubscriptionEventCallbacks(message_lost=lambda event: self.lost.append(event.total_count_change))
        node.create_subscription(Int32, "x", self._hear, self._requested, event_callbacks=events)
        rclpy.spin(node)

    def _hear(self, message: Any, info: dict[str, int]) -> None:
        self.heard.append(message.data)
        self.when.append((info["source_timestamp"] / 1e9 - EPOCH, info["received_timestamp"] / 1e9 - EPOCH))


@pytest.fixture(autouse=True)
def fresh(world: World) -> Iterator[None]:
    """A world before and after."""
    yield
    open_world()


# ---------------------------------------------------------------- slow


def test_latency_is_how_long_a_message_takes() -> None:
    radio = Radio()
    radio.network(latency=0.25)
    assert radio.run() == list(range(100))
    assert {round(heard - sent, 4) for sent, heard in radio.when} == {0.25}


def test_jitter_comes_on_top_and_reliable_messages_keep_their_order() -> None:
    for period in (0.15, 0.01):
        radio = Radio(ALL, period=period)
        radio.network(latency=0.1, jitter=0.1)
        assert radio.run() == list(range(100))
        ways = [heard - sent for sent, heard in radio.when]
        assert min(ways) >= 0.1 and 0.18 < max(ways) <= 0.2001
        assert min(ways) < 0.12 or period < 0.1  # the faster they follow each other, the more wait for the slowest


def test_a_best_effort_message_that_is_overtaken_is_lost() -> None:
    radio = Radio(HASTY, HASTY, period=0.01)
    radio.network(latency=0.1, jitter=0.1)
    heard = radio.run()
    assert heard == sorted(heard)
    assert 5 < len(heard) < 50
    assert len(heard) + sum(radio.lost) == max(heard) + 1


# ---------------------------------------------------------------- lossy


def test_best_effort_messages_get_lost_and_the_subscription_is_told() -> None:
    radio = Radio(HASTY, HASTY)
    radio.network(loss=0.3)
    heard = radio.run()
    assert 60 < len(heard) < 80
    assert len(heard) + sum(radio.lost) == max(heard) + 1  # what was lost at the end nobody knows yet


def test_reliable_messages_arrive_all_of_them_in_order_though_later() -> None:
    radio = Radio()
    radio.network(loss=0.3)
    assert radio.run() == list(range(100))
    assert radio.lost == []
    delays = [round((heard - sent) * 1000, 1) for sent, heard in radio.when]
    assert sorted(set(delays)) == pytest.approx([0.1, 10.3, 20.5], abs=0.15)  # lost not at all, once, twice


def test_who_waits_for_one_message_waits_for_those_behind_it() -> None:
    radio = Radio(ALL, period=0.001)
    radio.network(loss=0.1)
    assert radio.run() == list(range(100))
    arrivals = [heard for _, heard in radio.when]
    assert arrivals == sorted(arrivals)
    assert len(set(arrivals)) < 95  # some came in a bunch


def test_what_the_publisher_has_forgotten_cannot_be_sent_again() -> None:
    radio = Radio(1, period=0.001)
    radio.network(loss=0.3)
    heard = radio.run()
    assert heard == sorted(heard) and 99 in heard
    assert 60 < len(heard) < 85
    assert len(heard) + sum(radio.lost) == 100


def test_the_subscriptions_own_request_decides() -> None:
    radio = Radio(10, HASTY)  # the publisher would repeat, the subscription does not ask
    radio.network(loss=0.3)
    assert len(radio.run()) < 80


def test_a_cable_is_pulled_and_put_in_again() -> None:
    for offered, after in ((10, range(20, 30)), (ALL, range(10, 30)), (HASTY, ())):
        radio = Radio(offered, HASTY if offered is HASTY else ALL, count=60)
        radio.run(0.95)
        radio.network(loss=1)
        radio.run(2.0)
        assert radio.heard == list(range(10))
        radio.network()
        assert radio.run() == [*range(10), *after, *range(30, 60)]


@given(
    seed=st.integers(0, 1000),
    latency=st.floats(0, 0.3),
    jitter=st.floats(0, 0.3),
    loss=st.floats(0, 0.7),
    depth=st.integers(1, 20),
    period=st.sampled_from([0.001, 0.05, 0.2]),
)
def test_whatever_the_network_order_holds_and_counts_add_up(seed: int, period: float, depth: int, **how: float) -> None:
    for offered in (depth, QoSProfile(depth=depth, reliability=ReliabilityPolicy.BEST_EFFORT), ALL):
        reliability = ReliabilityPolicy.BEST_EFFORT if isinstance(offered, QoSProfile) and offered is not ALL else None
        requested = QoSProfile(history=HistoryPolicy.KEEP_ALL, reliability=reliability or ReliabilityPolicy.RELIABLE)
        radio = Radio(offered, requested, period, count=30, seed=seed)
        radio.network(**how)
        heard = radio.run(60)
        assert heard == sorted(set(heard))
        assert len(heard) + sum(radio.lost) == max(heard, default=-1) + 1
        assert all(received - sent >= 0.0001 for sent, received in radio.when)
        if offered is ALL:
            assert heard == list(range(30))


# ---------------------------------------------------------------- chance


def test_the_seed_decides_what_is_lost() -> None:
    def heard(seed: int) -> list[int]:
        radio = Radio(HASTY, HASTY, seed=seed)
        radio.network(loss=0.3)
        return list(radio.run())

    assert heard(1) == heard(1) != heard(2)


def test_another_listener_changes_nothing() -> None:
    def heard(*others: str) -> list[int]:
        radio = Radio(HASTY, HASTY)
        radio.network(loss=0.3)

        def other() -> None:
            rclpy.init()
            node = rclpy.create_node("other")
            node.create_subscription(Int32, "x", lambda message: None, HASTY)
            rclpy.spin(node)

        for name in others:
            radio.world.spawn(other, name=name)
        return list(radio.run())

    assert heard() == heard("other") == heard("one", "two")


# ---------------------------------------------------------------- with the other policies


def test_what_is_too_old_on_arrival_is_not_delivered() -> None:
    short = QoSProfile(depth=10, lifespan=Duration(seconds=0.2))
    radio = Radio(short)
    radio.network(latency=0.3)
    assert radio.run() == []
    radio = Radio(short)
    radio.network(latency=0.19)
    assert radio.run() == list(range(100))


def test_late_joiners_get_the_past_through_a_bad_network() -> None:
    latched = QoSProfile(depth=5, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    radio = Radio(latched, latched, count=20)
    radio.network(loss=0.5)
    radio.world.spawn(radio._talk, name="talker")
    radio.world.sim.run_until(5 * SECOND)
    radio.world.spawn(radio._listen, name="listener")
    radio.world.sim.run_until(10 * SECOND)
    assert radio.heard == [15, 16, 17, 18, 19]


def test_losses_make_deadlines_late(run: Run, world: World) -> None:
    world.graph.set_network("/x", conditions(loss=0.5))
    limit = QoSProfile(depth=10, reliability=ReliabilityPolicy.BEST_EFFORT, deadline=Duration(seconds=0.15))

    def program(found: list[Any]) -> None:
        rclpy.init()
        node = rclpy.create_node("n")
        publisher = node.create_publisher(Int32, "x", limit)
        events = SubscriptionEventCallbacks(deadline=lambda event: found.append(event.total_count))
        node.create_subscription(Int32, "x", lambda message: None, limit, event_callbacks=events)
        node.create_timer(0.1, lambda: publisher.publish(Int32()))
        rclpy.spin(node)

    assert 10 < len(run(program)) < 60


# ---------------------------------------------------------------- has it arrived?


def test_a_publisher_can_wait_until_everything_has_arrived(run: Run, world: World) -> None:
    world.graph.set_network("/slow", conditions(latency=0.5))

    def program(found: list[Any]) -> None:
        rclpy.init()
        node = rclpy.create_node("n")
        for topic, qos in (("usual", 10), ("slow", 10), ("slow", HASTY), ("nobody", 10)):
            publisher = node.create_publisher(Int32, topic, qos)
            if topic != "nobody":
                node.create_subscription(Int32, topic, print, qos)
            publisher.publish(Int32())
            began = time.time()
            acked = publisher.wait_for_all_acked(Duration(seconds=0)), publisher.wait_for_all_acked()
            found.append((*acked, round(time.time() - began, 2)))

    assert run(program) == [(False, True, 0.0), (False, True, 0.5), (True, True, 0.0), (True, True, 0.0)]


def test_what_was_kept_for_a_late_subscription_is_under_way_to_it(run: Run) -> None:
    latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)

    def program(found: list[Any]) -> None:
        rclpy.init()
        node = rclpy.create_node("n")
        publisher = node.create_publisher(Int32, "x", latched)
        publisher.publish(Int32(data=7))
        reader = node.create_subscription(Int32, "x", print, latched)._reader
        found += [message.data for _, message in reader.under_way()]
        found += [publisher.wait_for_all_acked(Duration(seconds=0)), publisher.wait_for_all_acked()]

    assert run(program) == [7, False, True]


def test_waiting_for_what_never_arrives_ends_in_time(run: Run, world: World) -> None:
    world.graph.set_network("/x", conditions(loss=1))

    def program(found: list[Any]) -> None:
        rclpy.init()
        node = rclpy.create_node("n")
        publisher = node.create_publisher(Int32, "x", 10)
        node.create_subscription(Int32, "x", print, 10)
        publisher.publish(Int32())
        found.append((publisher.wait_for_all_acked(Duration(seconds=2)), round(time.time() - EPOCH, 2)))
        with pytest.raises(TypeError, match="the timeout must be a Duration, got 2"):
            publisher.wait_for_all_acked(2)  # type: ignore[arg-type]

    assert run(program) == [(False, 2.0)]


def test_a_plain_cell_can_wait_too(world: World) -> None:
    world.graph.set_network("/x", conditions(loss=0.5))
    rclpy.init()
    node = rclpy.create_node("n")
    publisher = node.create_publisher(Int32, "x", 10)
    node.create_subscription(Int32, "x", print, 10)
    for _ in range(5):
        publisher.publish(Int32())
    assert publisher.wait_for_all_acked()


def test_what_was_published_last_arrives_although_the_publisher_has_gone(run: Run, world: World) -> None:
    world.graph.set_network("/x", conditions(latency=0.05, loss=0.3))

    def brief(found: list[Any]) -> None:
        time.sleep(0.1)
        rclpy.init()
        publisher = rclpy.create_node("brief").create_publisher(Int32, "x", 10)
        for number in range(5):
            publisher.publish(Int32(data=number))

    def hear(found: list[Any]) -> None:
        rclpy.init()
        node = rclpy.create_node("hear")
        node.create_subscription(Int32, "x", lambda message: found.append(message.data), 10)
        rclpy.spin(node)

    assert run(brief, hear) == [0, 1, 2, 3, 4]


# ---------------------------------------------------------------- services


def calls(run: Run) -> list[tuple[int, float]]:
    """Sums asked for one after the other, and how long each took (s)."""

    def server(found: list[Any]) -> None:
        rclpy.init()
        node = rclpy.create_node("server")
        node.create_service(AddTwoInts, "add", _sum)
        rclpy.spin(node)

    def client(found: list[Any]) -> None:
        rclpy.init()
        node = rclpy.create_node("client")
        asking = node.create_client(AddTwoInts, "add")
        asking.wait_for_service()
        for number in range(20):
            began = time.time()
            future = asking.call_async(AddTwoInts.Request(a=number, b=1))
            rclpy.spin_until_future_complete(node, future)
            found.append((future.result().sum, round(time.time() - began, 3)))

    return run(server, client, seconds=60)


def _sum(request: Any, response: Any) -> Any:
    response.sum = request.a + request.b
    return response


def test_a_service_is_reliable_only_later(run: Run, world: World) -> None:
    world.graph.set_network("/add", conditions(latency=0.1))
    assert calls(run) == [(number + 1, 0.2) for number in range(20)]
    world.graph.set_network("/add", conditions(latency=0.1, loss=0.4))
    answers = calls(run)
    assert [answer for answer, _ in answers] == list(range(1, 21))
    assert min(seconds for _, seconds in answers) == 0.2
    assert max(seconds for _, seconds in answers) > 0.4
    world.graph.set_network("/add", None)
    assert {seconds for _, seconds in calls(run)} == {0.0}


def test_a_cell_that_calls_a_service_which_is_cut_off_is_told_so(run: Run, world: World) -> None:
    def server(found: list[Any]) -> None:
        rclpy.init()
        node = rclpy.create_node("server")
        node.create_service(AddTwoInts, "add", _sum)
        rclpy.spin(node)

    run(server, seconds=1.0)
    rclpy.init()
    client = rclpy.create_node("client").create_client(AddTwoInts, "add")
    world.graph.set_network("/add", conditions(loss=1))
    with pytest.raises(NeverWakes, match=r"lesson\.network loses all transmissions of this service"):
        client.call(AddTwoInts.Request(a=1, b=2))
    world.graph.set_network("/add", None)
    assert client.call(AddTwoInts.Request(a=1, b=2)).sum == 3


# ---------------------------------------------------------------- names


def test_a_name_goes_before_patterns_and_a_later_pattern_before_an_earlier_one() -> None:
    network = Network()
    slow, slower, slowest = (conditions(latency=seconds) for seconds in (1, 2, 3))
    network.set("*", slow)
    network.set("/turtle?/pose", slower)
    network.set("/turtle1/pose", slowest)
    assert [network.of(name) for name in ("/scan", "/turtle2/pose", "/turtle1/pose")] == [slow, slower, slowest]
    network.set("*", slow)
    assert network.of("/turtle2/pose") == slow
    network.set("/turtle1/pose", None)
    network.set("*", None)
    assert network.of("/turtle1/pose") == slower
    assert list(network.rules()) == ["/turtle?/pose"]
    network.clear()
    assert network.of("/turtle1/pose") is None


# ---------------------------------------------------------------- the watchdog behind deadlines and leases


@given(span=st.integers(1, 5_000_000), gaps=st.lists(st.integers(1, 20_000_000), min_size=1, max_size=20))
def test_every_span_that_is_over_is_counted_once(span: int, gaps: list[int]) -> None:
    simulation, alarms = Simulation(), []
    watchdog = Watchdog(simulation, span, alarms.append, repeats=True)
    for gap in gaps:
        watchdog.renew()
        simulation.run_until(simulation.now + gap)
    watchdog.renew()
    assert sum(alarms) == sum((gap - 1) // span for gap in gaps)
    assert len(alarms) <= len(gaps) + sum(gaps) // min(1_000_000, span) and len(alarms) <= 21 * len(gaps)
