"""Quality of service, as the official demos show it: what comes, what is lost, and which events tell of it."""

from __future__ import annotations

import pytest
from program_terminal import Terminal, having


def first(*programs: str) -> list[str]:
    return [f"first_steps {each}" for each in programs]


def test_a_deadline_is_missed(terminal: Terminal) -> None:
    printed = terminal.run(*first("deadline 600"), seconds=3.2)
    assert having(printed, "Missed", "Publishing", "created") == [
        "0.0 qos_listener: Subscription created",
        *[f"{0.5 + number / 2} qos_talker: Publishing: Talker says {number}" for number in range(4)],
        "2.6 Talker: QoSOfferedDeadlineMissedInfo(total_count=1, total_count_change=1)",
        "2.6 Listener: QoSRequestedDeadlineMissedInfo(total_count=1, total_count_change=1)",
        "3.0 qos_talker: Publishing: Talker says 4",
    ]


def test_messages_expire(terminal: Terminal) -> None:
    printed = terminal.run(*first("lifespan 1000 4 2250"), seconds=3)
    assert having(printed, "qos_listener") == [
        "2.2 qos_listener: Subscription created",
        "2.2 qos_listener: I heard: Talker says 2",
        "2.2 qos_listener: I heard: Talker says 3",
    ]


def test_a_publisher_goes_and_its_liveliness_with_it(terminal: Terminal) -> None:
    printed = terminal.run(*first("liveliness 1000"), seconds=5)
    change = (
        "QoSLivelinessChangedInfo(alive_count={}, not_alive_count=0, alive_count_change={}, not_alive_count_change=0)"
    )
    assert having(printed, "Listener") == [
        f"0.0 Listener: {change.format(1, 1)}",
        f"3.0 Listener: {change.format(0, -1)}",
    ]


def test_a_publisher_no_longer_asserts_its_liveliness(terminal: Terminal) -> None:
    printed = terminal.run(*first("liveliness 1000 --policy MANUAL_BY_TOPIC --topic-assert-period 300"), seconds=5)
    assert having(printed, "Lost", "not_alive_count=1") == [
        "3.7 Talker: QoSLivelinessLostInfo(total_count=1, total_count_change=1)",
        "3.7 Listener: QoSLivelinessChangedInfo(alive_count=0, not_alive_count=1, alive_count_change=-1, "
        "not_alive_count_change=1)",
    ]


@pytest.mark.parametrize(
    ("policy", "kind"),
    [
        ("durability", "DURABILITY"),
        ("deadline", "DEADLINE"),
        ("liveliness", "LIVELINESS"),
        ("liveliness_lease_duration", "LIVELINESS"),
        ("reliability", "RELIABILITY"),
    ],
)
def test_both_ends_hear_that_they_do_not_fit(terminal: Terminal, policy: str, kind: str) -> None:
    printed = terminal.run(*first(f"misfit {policy}"), seconds=2)
    told = f"incompatible qos - total 1 delta 1 last_policy_kind: rmw_qos_policy_kind_t.RMW_QOS_POLICY_{kind}"
    assert having(printed, "talker: inc", "listener: inc") == [f"0.0 talker: {told}", f"0.0 listener: {told}"]
    assert not having(printed, "heard") and terminal.exit_codes() == [0]


def test_both_ends_hear_of_each_other(terminal: Terminal) -> None:
    assert terminal.run(*first("matched"), seconds=1) == [
        f"0.0 watcher: {what}"
        for what in (
            "subscriptions: 1 (+1)",
            "subscriptions: 2 (+1)",
            "subscriptions: 1 (-1)",
            "subscriptions: 0 (-1)",
            "publishers: 1 (+1)",
            "publishers: 0 (-1)",
        )
    ]


def test_a_listener_that_hears_of_lost_messages(terminal: Terminal) -> None:
    line = "ros2 topic pub -t 3 -r 2 /pictures sensor_msgs/msg/Image '{header: {stamp: now}}'"
    terminal.run(*first("hear_lost"))
    printed = terminal.say(line, seconds=1)
    assert [each.partition(" ")[2] for each in having(printed, "hear_lost")] == [
        "hear_lost: I heard an Image, True"
    ] * 3
