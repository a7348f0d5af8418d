"""Executors and callback groups, ready-made and of one's own, as the official examples write them."""

from __future__ import annotations

import pytest
from program_terminal import Terminal, having


def first(*programs: str) -> list[str]:
    return [f"first_steps {each}" for each in programs]


def test_two_nodes_in_one_executor(terminal: Terminal) -> None:
    assert terminal.run(*first("composed"), seconds=0.7) == [
        '0.5 talk_member_function: Publishing: "Hello: 0"',
        '0.5 hear_member_function: I heard: "Hello: 0"',
    ]
    terminal.interrupt()
    assert terminal.exit_codes() == [0]


def test_one_group_runs_one_callback_at_a_time(terminal: Terminal) -> None:
    assert terminal.run(*first("two_at_once same"), seconds=2.1) == [
        "0.5 double_talker: quick 0",
        "1.0 double_talker: slow begins",
        "1.8 double_talker: slow ends",
        "1.8 double_talker: quick 1",
        "2.0 double_talker: slow begins",
    ]


@pytest.mark.parametrize("groups", ["own", "reentrant"])
def test_other_groups_let_them_run_side_by_side(terminal: Terminal, groups: str) -> None:
    assert terminal.run(*first(f"two_at_once {groups}"), seconds=1.9) == [
        "0.5 double_talker: quick 0",
        "1.0 double_talker: slow begins",
        "1.0 double_talker: quick 1",
        "1.5 double_talker: quick 2",
        "1.8 double_talker: slow ends",
    ]


def test_an_executor_of_ones_own_with_priorities(terminal: Terminal) -> None:
    terminal.run(*first("emergency_first"))
    publish = "ros2 topic pub -1 /{} std_msgs/msg/{}"
    printed = terminal.say(
        publish.format("work", "String '{data: a}'"),
        publish.format("work", "String '{data: b}'"),
        publish.format("stop", "Empty"),
        seconds=3,
    )
    told = [line.partition(" ")[2] for line in having(printed, "worker", "stopper")]
    assert told == ["worker: begins a", "stopper WARN: stopped", "worker: ends a", "worker: begins b", "worker: ends b"]


def test_a_callback_group_of_ones_own(terminal: Terminal) -> None:
    printed = terminal.run(*first("token_bucket"), seconds=2.2)
    assert [line.split()[0] for line in printed] == ["0.1", "0.2", "0.3", "0.5", "1.0", "1.5", "2.0"]


def test_two_executors_in_two_threads(terminal: Terminal) -> None:
    printed = terminal.run(*first("ping_pong"), seconds=2)
    assert (printed[0], printed[-1]) == ("at least 50: True fair: True", "over")
    assert terminal.exit_codes() == [0]
