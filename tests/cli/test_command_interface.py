"""`ros2 interface`: what it prints, compared with recordings of the real one."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from command_cases import cases, check, type_in
from workspace_on_disk import install_robot_controller

from turtle_lesson.ros.idl.names import did_you_mean
from turtle_lesson.ros.idl.registry import registry
from turtle_lesson.ros.runtime.world import World


@pytest.fixture(autouse=True)
def workspace(world: World, tmp_path: Path) -> Iterator[Path]:
    install_robot_controller(world, tmp_path)
    yield tmp_path
    registry.remove("robot_controller")


def _add(folder: Path, text: str, name: str = "msg/Odd.msg") -> None:
    (folder / name).parent.mkdir(parents=True, exist_ok=True)
    (folder / name).write_text(text, encoding="utf-8")
    registry.add("odd_msgs", folder)


@pytest.fixture
def odd(tmp_path: Path) -> Iterator[Path]:
    yield tmp_path / "odd"
    registry.remove("odd_msgs")


def test_interface_answers_as_recorded(world: World) -> None:
    check(world, "interface.txt")


# Interfaces that the packages of the recording have since Iron, Jazzy or Kilted.
NEWER = {
    "geometry_msgs/msg/PolygonInstance",
    "geometry_msgs/msg/PolygonInstanceStamped",
    "rcl_interfaces/msg/LoggerLevel",
    "rcl_interfaces/msg/SetLoggerLevelsResult",
    "rcl_interfaces/srv/GetLoggerLevels",
    "rcl_interfaces/srv/SetLoggerLevels",
}


def test_the_whole_list_is_the_recorded_one_and_that_of_packages_which_were_not_installed_there(world: World) -> None:
    [recorded] = cases("interface_list.txt")
    lines = type_in(world, "ros2 interface list").stdout.splitlines()
    there = {line.strip().partition("/")[0] for line in recorded.stdout if line.startswith(" ")}
    assert [line for line in lines if not line.startswith(" ") or _is_of(line, there)] == recorded.stdout


def _is_of(line: str, packages: set[str]) -> bool:
    name = line.strip()
    return name.partition("/")[0] in packages and name not in NEWER


def test_kinds_can_be_chosen(world: World) -> None:
    assert type_in(world, "ros2 interface list -m").stdout.splitlines()[0] == "Messages:"
    assert "std_srvs" not in type_in(world, "ros2 interface packages -m").stdout
    assert "std_srvs" in type_in(world, "ros2 interface packages --only-srvs").stdout


COMMENTED = """\
# what it is for

std_msgs/Header header   # when and where
string<=5 text "a # b"   # no comment in quotes
uint8 LIMIT=3
float32[] data
"""


def test_comments_of_the_interface_itself_are_shown_but_not_those_inside(world: World, odd: Path) -> None:
    _add(odd, COMMENTED)
    expected = COMMENTED.splitlines()
    expected[3:3] = ["\tbuiltin_interfaces/Time stamp", "\t\tint32 sec", "\t\tuint32 nanosec", "\tstring frame_id"]
    assert type_in(world, "ros2 interface show odd_msgs/msg/Odd").stdout.splitlines() == expected


def test_comments_can_be_left_out(world: World, odd: Path) -> None:
    """The real tool cuts lines in odd places here (recorded in interface_show.txt); ours leaves comments out."""
    _add(odd, COMMENTED)
    lines = type_in(world, "ros2 interface show odd_msgs/msg/Odd --no-comments").stdout.splitlines()
    assert lines[0] == "std_msgs/Header header"
    assert lines[-3:] == ['string<=5 text "a # b"', "uint8 LIMIT=3", "float32[] data"]


def test_comments_inside_can_be_shown_too(world: World, odd: Path) -> None:
    (odd / "msg").mkdir(parents=True)
    (odd / "msg" / "Inner.msg").write_text("int32 x  # how many\n", encoding="utf-8")
    _add(odd, "Inner inner\n")
    assert type_in(world, "ros2 interface show odd_msgs/msg/Odd").stdout == "Inner inner\n\tint32 x\n"
    shown = type_in(world, "ros2 interface show odd_msgs/msg/Odd --all-comments").stdout
    assert shown == "Inner inner\n\tint32 x  # how many\n"


def test_a_prototype_without_quotes_can_go_into_a_file(world: World) -> None:
    answer = type_in(world, "ros2 interface proto geometry_msgs/msg/Point --no-quotes")
    assert answer.stdout == "x: 0.0\ny: 0.0\nz: 0.0\n\n"


TWIST = """\
# How fast a body moves and turns.

Vector3 linear   # m/s along the x, y and z axes
	float64 x
	float64 y
	float64 z
Vector3 angular  # rad/s about the x, y and z axes; z > 0 turns to the left
	float64 x
	float64 y
	float64 z
"""


def test_standard_types_say_what_their_fields_mean(world: World) -> None:
    assert type_in(world, "ros2 interface show geometry_msgs/msg/Twist").stdout == TWIST
    shown = type_in(world, "ros2 interface show geometry_msgs/msg/PoseStamped --all-comments").stdout.splitlines()
    assert "\t# Where something is, and which way it faces." in shown and "" in shown
    assert "\tPoint position          # m" in shown
    assert type_in(world, "ros2 interface show std_srvs/srv/SetBool").stdout.splitlines()[1:3] == [
        "---",
        "bool success    # whether it was done",
    ]


def test_all_types_of_a_name_are_suggested(world: World) -> None:
    answer = type_in(world, "ros2 interface show Pose")
    assert answer.stderr.endswith("\nDid you mean 'geometry_msgs/msg/Pose' or 'turtlesim/msg/Pose'?\n")


def test_a_learners_package_has_its_own_comments_alone(world: World, odd: Path) -> None:
    _add(odd, "Vector3 linear\n", "msg/Twist.msg")
    (odd / "comments.txt").write_text("[msg/Twist]\nlinear: m/s\n")
    assert registry.text("odd_msgs", "msg/Twist", comments=True) == "Vector3 linear\n"


def test_all_comments_or_none_but_not_both_can_be_asked_for(world: World) -> None:
    answer = type_in(world, "ros2 interface show geometry_msgs/msg/Point --all-comments --no-comments")
    assert answer.stderr.endswith("error: argument --no-comments: not allowed with argument --all-comments\n")


def test_a_prototype_of_nothing(world: World) -> None:
    assert type_in(world, "ros2 interface proto std_srvs/srv/Empty").stdout == '"{}\n"\n'


def test_every_interface_can_be_shown_and_has_a_prototype(world: World) -> None:
    for line in type_in(world, "ros2 interface list").stdout.splitlines():
        if line.startswith(" "):
            for verb in ("show", "proto"):
                answer = type_in(world, f"ros2 interface {verb} {line.strip()}")
                assert (answer.stderr, answer.code) == ("", 0), line


@pytest.mark.parametrize(
    ("name", "known", "meant"),
    [
        ("/robot/status", "/robot_status", True),
        ("/cmd_vel", "/turtle1/cmd_vel", True),
        ("vra", "var", True),
        ("turtle_teleop", "turtle_teleop_key", True),
        ("geometry_msgs/msg/Pose3D", "geometry_msgs/msg/Pose2D", True),
        ("std_msgs/msg/Nope", "std_msgs/msg/Int8", False),
        ("nope.launch.py", "start_system.launch.py", False),
        ("cartographer_ros", "turtlebot3_cartographer", False),
        ("--timeout", "--spin-time", False),
        ("/battery", "/chatter", False),
        ("trace", "interface", False),
    ],
)
def test_only_what_may_be_a_slip_is_suggested(name: str, known: str, meant: bool) -> None:
    assert did_you_mean(name, [known]) == (f"Did you mean '{known}'?" if meant else "")
