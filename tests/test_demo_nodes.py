"""The demos that everybody starts first, as recorded on a terminal."""

from __future__ import annotations

import pytest
from program_terminal import Terminal, having


@pytest.fixture
def shop(fresh_terminal: Terminal) -> Terminal:
    """A terminal in which nothing was built."""
    fresh_terminal.build()
    return fresh_terminal


def test_a_talker_and_a_listener_as_recorded(shop: Terminal) -> None:
    printed = shop.run("demo_nodes_py listener", "demo_nodes_py talker", seconds=3.5)
    assert having(printed, "talker:") == [f'{n + 1}.0 talker: Publishing: "Hello World: {n}"' for n in range(3)]
    assert having(printed, "listener:") == [f"{n + 1}.0 listener: I heard: [Hello World: {n}]" for n in range(3)]
    assert shop.interrupt() == []
    assert shop.exit_codes() == [0, 0]


def test_where_they_are_cpp_they_count_from_one(shop: Terminal) -> None:
    printed = shop.run("demo_nodes_cpp talker", "demo_nodes_cpp listener", seconds=1.5)
    assert having(printed, "1.0") == [
        "1.0 talker: Publishing: 'Hello World: 1'",
        "1.0 listener: I heard: [Hello World: 1]",
    ]


def test_a_client_waits_for_its_server(shop: Terminal) -> None:
    assert having(shop.run("demo_nodes_py add_two_ints_client", seconds=2.5), "waiting") == 2 * [
        "service not available, waiting again..."
    ]
    printed = shop.run("demo_nodes_py add_two_ints_server", seconds=1)
    assert having(printed, "request", "a: 2", "Result") == [
        "2.5 add_two_ints_server: Incoming request",
        "a: 2 b: 3",
        "2.5 add_two_ints_client: Result of add_two_ints: 5",
    ]
    assert shop.exit_codes() == [0, None]
    assert shop.say("ros2 pkg executables demo_nodes_py")[0] == "demo_nodes_py add_two_ints_client"
