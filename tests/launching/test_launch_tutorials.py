"""The official launch tutorials, as launch files of one's own: built, installed, launched, and seen to work."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from workshop import Workshop, built, distance

from turtle_lesson.ros.cli.shell import run_line
from turtle_lesson.ros.runtime.world import World

KINDS = ("py", "xml", "yaml")


@pytest.fixture
def party(
    world: World, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> Iterator[Workshop]:
    """The package turtle_party, built and sourced."""
    with built("launch_tutorial", world, tmp_path, monkeypatch, capsys) as workshop:
        yield workshop


def red(party: Workshop, node: str, colour: str = "r") -> str:
    return party.say(f"ros2 param get {node} background_{colour}")[-1]


def logged(lines: list[str]) -> list[str]:
    """What LogInfo said."""
    return [line.removeprefix("[INFO] [launch.user]: ") for line in lines if "[launch.user]" in line]


def test_launch_files_of_all_kinds_are_installed(party: Workshop, capsys: pytest.CaptureFixture[str]) -> None:
    installed = party.say("ls install/turtle_party/share/turtle_party/launch")
    assert {f"mimic_launch.{kind}" for kind in KINDS} <= set(installed)
    run_line(party.world, "ros2 launch turtle_party mimic_lunch.yaml")
    assert capsys.readouterr().err.splitlines()[-1] == "Did you mean 'mimic_launch.yaml'?"


@pytest.mark.parametrize("kind", KINDS)
def test_one_turtle_mimics_the_other(party: Workshop, kind: str) -> None:
    lines = party.say(f"ros2 launch turtle_party mimic_launch.{kind}", seconds=1)
    assert [line for line in lines if "process started" in line] == [
        f"[INFO] [{name}]: process started with pid [{pid}]"
        for name, pid in (("turtlesim_node-1", 1002), ("turtlesim_node-2", 1003), ("mimic-3", 1004))
    ]
    assert party.say("ros2 node list") == ["/left/sim", "/mimic", "/right/sim"]
    turtle = "/left/turtle1/cmd_vel geometry_msgs/msg/Twist '{linear: {x: 2.0}, angular: {z: -1.8}}'"
    left, right = party.watch("left/turtle1", "right/turtle1").values()
    party.say(f"ros2 topic pub --times 3 {turtle}", seconds=1)
    assert distance(right[0], right[-1]) > 0.5 and distance(left[-1], right[-1]) < 0.1


@pytest.mark.parametrize("kind", KINDS)
def test_substitutions_conditions_and_commands(party: Workshop, kind: str) -> None:
    party.say(f"ros2 launch turtle_party party_launch.{kind}", seconds=1)
    assert red(party, "/party/sim") == "Integer value is: 120"
    assert "/party/turtle2/pose" in party.say("ros2 topic list")
    party.run(3)
    assert red(party, "/party/sim") == "Integer value is: 120"
    party.say("kill -INT %1")
    party.say(f"ros2 launch turtle_party party_launch.{kind} turtlesim_ns:=mine use_given_red:=True", seconds=4)
    assert red(party, "/mine/sim") == "Integer value is: 200"


def test_arguments_are_given_to_an_included_file(party: Workshop) -> None:
    party.say("ros2 launch turtle_party main_launch.py", seconds=4)
    assert red(party, "/given/sim") == "Integer value is: 200"
    shown = party.say("ros2 launch turtle_party party_launch.xml --show-args")
    assert shown == party.say("ros2 launch turtle_party party_launch.py -s")
    assert shown[2:5] == ["    'turtlesim_ns':", "        no description given", "        (default: 'party')"]


def test_event_handlers(party: Workshop) -> None:
    lines = party.say("ros2 launch turtle_party events_launch.py", seconds=1)
    name = 'Spawn "{x: 2, y: 2, theta: 0.2}"-2'
    assert [line for line in lines if "process" in line] == [
        "[INFO] [turtlesim_node-1]: process started with pid [1002]",
        f"[INFO] [{name}]: process started with pid [1003]",
        f"[INFO] [{name}]: process has finished cleanly [pid 1003]",
        "[INFO] [sim background_r 120-3]: process started with pid [1004]",
        "[INFO] [sim background_r 120-3]: process has finished cleanly [pid 1004]",
    ]
    said = [line for line in logged(lines) if line != 'the answer is ""']
    assert said == [
        "started, spawning a turtle",
        "the answer is \"requester: making request: turtlesim.srv.Spawn_Request(x=2.0, y=2.0, theta=0.2, name='')\"",
        'the answer is "response:',
        "spawned",
    ]
    party.run(3)
    assert red(party, "/party/sim") == "Integer value is: 200"
    lines = party.say("kill -9 1002", seconds=1)
    assert logged(lines) == ["somebody closed it", "asked to shut down: window closed"]
    assert party.say("ros2 node list") == []


def test_a_large_project(party: Workshop) -> None:
    party.say("ros2 launch turtle_party large_launch.py", seconds=1)
    assert party.say("ros2 node list") == ["/mimics/mimic", "/world1/sim", "/world2/sim", "/world3/sim"]
    colours = {world: [red(party, f"/{world}/sim", colour).split()[-1] for colour in "rgb"] for world in WORLDS}
    assert colours == WORLDS


WORLDS = {"world1": ["7", "84", "122"], "world2": ["150", "86", "44"], "world3": ["33", "86", "44"]}


def test_managed_nodes_are_led_through_their_states(party: Workshop) -> None:
    lines = party.say("ros2 launch turtle_party managed_launch.py", seconds=1)
    assert logged(lines) == ["inactive now", "active now"]
    assert sorted(line for line in lines if line.startswith("0.")) == [
        *["0.3 one: activated", "0.3 one: configured", "0.6 two: activated", "0.6 two: configured"]
    ]
    assert party.say("ros2 lifecycle get /one", "ros2 lifecycle get /two") == ["active [3]", "active [3]"]
    assert "/launch_ros_1002" in party.say("ros2 node list")
    assert "Clients count: 1" in party.say("ros2 service info /one/change_state")
    party.say("kill -INT %1")
    assert party.say("ros2 node list") == []


def test_a_transition_that_is_not_possible_ends_the_program(party: Workshop, tmp_path: Path) -> None:
    text = Path("install/turtle_party/share/turtle_party/launch/managed_launch.py").read_text()
    Path("wrong_launch.py").write_text(text.replace("TRANSITION_CONFIGURE", "TRANSITION_DEACTIVATE"))
    lines = party.say("ros2 launch wrong_launch.py", seconds=1)
    assert any("Transition is not registered" in line for line in lines)
    assert any(line.startswith("[ERROR] [managed-1]: process has died") for line in lines)


def test_a_launch_by_hand(party: Workshop) -> None:
    assert party.say("ros2 run turtle_party by_hand", seconds=3) == [
        "[INFO] [launch]: Default logging verbosity is set to INFO",
        "[INFO] [launch.user]: by hand",
        "[INFO] [sleep-1]: process started with pid [1003]",
        "[INFO] [launch.user]: a second later",
        "[INFO] [sleep-1]: process has finished cleanly [pid 1003]",
        "it returned 0",
    ]
