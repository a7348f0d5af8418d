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


NAMES = (
    "talker_listener_launch.py", "talker_listener_launch.xml", "talker_listener_launch.yaml",
    "talker_listener.launch.py", "talker_listener.launch.xml",
    "talker_listener_best_effort_launch.py", "talker_listener_best_effort_launch.yaml",
    "talker_listener_best_effort.launch.xml",
)  # fmt: skip


@pytest.mark.parametrize("name", NAMES)
def test_a_launch_file_starts_talker_and_listener(shop: Terminal, name: str) -> None:
    printed = shop.say(f"ros2 launch demo_nodes_cpp {name}", seconds=1.5)
    (said,) = having(printed, "Publishing: 'Hello World: 1'")
    (heard,) = having(printed, "I heard: [Hello World: 1]")
    assert said.startswith("[talker-1] ")
    assert heard.startswith("[listener_best_effort-2] " if "best_effort" in name else "[listener-2] ")


@pytest.mark.parametrize("name", ["add_two_ints", "add_two_ints_async"])
@pytest.mark.parametrize("ending", ["_launch.py", ".launch.py", "_launch.xml", ".launch.xml"])
def test_a_launch_file_starts_server_and_client(shop: Terminal, name: str, ending: str) -> None:
    printed = shop.say(f"ros2 launch demo_nodes_cpp {name}{ending}", seconds=2.0)
    assert len(having(printed, "Result of add_two_ints: 5")) == 1
    ended = having(printed, "[INFO] [add_two_ints_server-1]: process has finished cleanly")
    assert len(ended) == (1 if ending.endswith("py") else 0)  # the Python file ends the launch with the client


def test_the_launch_files_are_found_by_their_path(shop: Terminal) -> None:
    file = "from launch import LaunchDescription\nfrom launch.actions import IncludeLaunchDescription\n"
    file += (
        "from launch.substitutions import PathJoinSubstitution\nfrom launch_ros.substitutions import FindPackageShare\n"
    )
    place = "[FindPackageShare('demo_nodes_cpp'), 'launch', 'topics', 'talker_listener_launch.py']"
    include = f"IncludeLaunchDescription(PathJoinSubstitution({place}))"
    file += f"def generate_launch_description():\n    return LaunchDescription([{include}])\n"
    (shop.folder / "mine.launch.py").write_text(file)
    assert having(shop.say("ros2 launch mine.launch.py", seconds=1.5), "I heard: [Hello World: 1]")
