"""`ros2 param`, against recordings of the real one."""

from __future__ import annotations

import os
from pathlib import Path

import command_system as system
import pytest
from command_cases import check, type_in
from command_interfaces import interfaces  # noqa: F401

from turtle_lesson.ros.cli.group_param import flat, from_text, nested
from turtle_lesson.ros.cli.verb import CommandError
from turtle_lesson.ros.runtime.world import World

pytestmark = pytest.mark.usefixtures("interfaces")

REFUSED = "The 'string_value' field must be of type 'str'"


@pytest.fixture
def demo(world: World) -> World:
    """A world in which a node with parameters of all kinds runs."""
    system.start(world, system.param_demo, system.status_monitor)
    return world


def test_beside_the_lessons_nodes(world: World) -> None:
    system.start(world, *system.LESSON)
    check(world, "param.txt")


def test_parameters_of_all_kinds(demo: World) -> None:
    check(demo, "param_demo.txt")


def test_a_node_that_is_busy_is_left_out_of_the_list_and_not_waited_for(world: World) -> None:
    system.start(world, *system.LESSON)

    def caller() -> None:
        import rclpy
        from robot_controller.srv import NavigateTo

        rclpy.init(args=[])
        node = rclpy.create_node("_caller")
        client = node.create_client(NavigateTo, "/navigate_to")
        rclpy.spin_until_future_complete(node, client.call_async(NavigateTo.Request(x=90.0)))

    system.start(world, caller)
    answer = type_in(world, "ros2 param list")
    assert answer.stdout == "/obstacle_detector:\n  use_sim_time\n/status_monitor:\n  use_sim_time\n"
    assert answer.stderr == "Exception while calling service of node '/navigator': None\n"
    assert (answer.code, answer.seconds) == (0, pytest.approx(1.1, abs=0.01))
    answer = type_in(world, "ros2 param get /navigator use_sim_time")
    assert answer.code == 1 and answer.stdout == ""
    assert answer.stderr.startswith("No answer from /navigator in 5 s of robot time: is it busy")


@pytest.mark.parametrize(
    ("text", "kind", "value"),
    [
        ("1", 2, 1),
        ("1.0", 3, 1.0),
        ("true", 1, True),
        ("True", 1, True),
        ("yes", 1, True),
        ("on", 1, True),
        ("abc", 4, "abc"),
        ("'1'", 4, "1"),
        ('"1"', 4, "1"),
        ("[1, 2]", 7, [1, 2]),
        ("[1.0, 2]", 4, "[1.0, 2]"),
        ("[1, 2.0]", 4, "[1, 2.0]"),
        ("[a, b]", 9, ["a", "b"]),
        ("[true, false]", 6, [True, False]),
        ("[1, a]", 4, "[1, a]"),
        ("[]", 6, []),
        ("1e3", 4, "1e3"),
        ("1.0e3", 4, "1.0e3"),
        (".5", 3, 0.5),
        ("5.", 3, 5.0),
        ("-3", 2, -3),
        ("0x10", 2, 16),
        ("nan", 4, "nan"),
        ("inf", 4, "inf"),
        ("[1", 4, "[1"),
        ("1,2", 4, "1,2"),
        ("!!str 1", 4, "1"),
    ],
)
def test_the_type_of_a_value_is_read_from_its_text(text: str, kind: int, value: object, world: World) -> None:
    from rclpy.parameter import parameter_value_to_python

    message = from_text(text)
    assert (message.type, parameter_value_to_python(message)) == (kind, value)


@pytest.mark.parametrize("text", ["{a: 1}", "null", "", "a: b", "2020-01-01"])
def test_what_is_no_value_is_refused_in_the_real_words(text: str, world: World) -> None:
    with pytest.raises(CommandError, match=REFUSED):
        from_text(text)


@pytest.mark.parametrize(
    "text", ["9" * 30, "9" * 9_000, "[" * 9_000, "&a [" + "*a, " * 30 + "]", "\x00", "x" * 200_000]
)
def test_a_value_that_is_a_trap_is_refused(text: str, world: World) -> None:
    with pytest.raises(CommandError):
        from_text(text)


def test_dumped_parameters_can_be_loaded(demo: World, tmp_path: Path) -> None:
    file = tmp_path / "demo.yaml"
    file.write_text(type_in(demo, "ros2 param dump /param_demo").stdout)
    type_in(demo, "ros2 param set /param_demo speed 2.0")
    answer = type_in(demo, f"ros2 param load param_demo {file}")
    names = ["count", "flags", "gains", "name", "speed", "use_sim_time"]
    assert answer.stdout == "".join(f"Set parameter {name} successful\n" for name in names)
    assert answer.stderr == "Set parameter fixed failed: Trying to set a read-only parameter: fixed.\n"
    assert type_in(demo, "ros2 param get /param_demo speed --hide-type").stdout == "0.5\n"


def test_a_file_without_the_node_says_which_nodes_it_has(demo: World, tmp_path: Path) -> None:
    file = tmp_path / "demo.yaml"
    file.write_text("param_demo:\n  ros__parameters: {speed: 1.0}\n")
    answer = type_in(demo, f"ros2 param load /param_demo {file}")
    expected = "Param file does not contain parameters for /param_demo,  only for nodes: dict_keys(['param_demo'])"
    assert (answer.stderr.splitlines()[0], answer.stdout, answer.code) == (expected, "", 1)
    file.write_text("/**:\n  ros__parameters: {speed: 1.25}\n")
    assert type_in(demo, f"ros2 param load /param_demo {file}").stdout == "Set parameter speed successful\n"


@pytest.mark.parametrize("content", ["", "- 1", "[", "/param_demo: 5", "/param_demo: {speed: 1}", "\x00"])
def test_a_file_that_is_none_is_answered_in_a_line(content: str, demo: World, tmp_path: Path) -> None:
    file = tmp_path / "demo.yaml"
    file.write_text(content)
    answer = type_in(demo, f"ros2 param load /param_demo {file}")
    assert answer.code == 1 and answer.stderr.count("\n") == 1
    answer = type_in(demo, f"ros2 param load /param_demo {tmp_path}/none.yaml")
    assert answer.stderr == f"[Errno 2] No such file or directory: '{tmp_path}/none.yaml'\n"


def test_a_file_in_another_encoding_is_not_guessed_at(demo: World, tmp_path: Path) -> None:
    file = tmp_path / "demo.yaml"
    file.write_bytes("/param_demo: {ros__parameters: {name: café}}".encode("latin-1"))
    answer = type_in(demo, f"ros2 param load /param_demo {file}")
    assert (answer.stderr, answer.stdout, answer.code) == (f"cannot read {file}: it is not text in UTF-8\n", "", 1)


def test_a_file_that_never_ends_is_not_read(demo: World, tmp_path: Path) -> None:
    for path in filter(os.path.exists, ("/dev/zero", str(tmp_path))):
        answer = type_in(demo, f"ros2 param load /param_demo {path}")
        assert answer.stderr == f"cannot read {path}: it is a folder or a device, not a file\n"


def test_a_file_that_is_far_too_long_is_refused(demo: World, tmp_path: Path) -> None:
    file = tmp_path / "long.yaml"
    file.write_text("#" * 10_000_000)
    answer = type_in(demo, f"ros2 param load /param_demo {file}")
    assert answer.code == 1 and "is too long: at most 100000 characters" in answer.stderr


def test_the_old_ways_to_dump_are_warned_of(demo: World, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    answer = type_in(demo, "ros2 param dump /status_monitor --print")
    assert answer.stdout == "/status_monitor:\n  ros__parameters:\n    use_sim_time: false\n\n"
    assert answer.stderr == "WARNING: '--print' is deprecated; this utility prints to stdout by default\n"
    answer = type_in(demo, f"ros2 param dump /param_demo --output-dir {tmp_path}")
    assert answer.stdout == f"Saving to:  {tmp_path}/param_demo.yaml\n"
    assert answer.stderr == "WARNING: '--output-dir' is deprecated; use redirection to save to a file\n"
    assert "name: turtle" in (tmp_path / "param_demo.yaml").read_text()


def test_a_dump_goes_only_into_a_folder_of_the_learner(demo: World, tmp_path: Path) -> None:
    answer = type_in(demo, f"ros2 param dump /param_demo --output-dir {tmp_path}/none")
    assert (answer.stdout, answer.stderr) == ("", f"'{tmp_path}/none' is not a valid directory.\n")
    assert answer.code == 1
    answer = type_in(demo, f"ros2 param dump /param_demo --output-dir {tmp_path}")
    assert "is outside your folder" in answer.stderr and answer.code == 1
    assert not list(tmp_path.iterdir())


def test_nearly_right_names_are_found(demo: World) -> None:
    assert type_in(demo, "ros2 param get /param_dmo speed").stderr == "Node not found\nDid you mean '/param_demo'?\n"
    assert type_in(demo, "ros2 param get /param_demo sped").stderr == "Parameter not set\nDid you mean 'speed'?\n"
    answer = type_in(demo, "ros2 param describe /param_demo name sped")
    assert answer.stderr == "/param_demo has no parameter 'sped'\nDid you mean 'speed'?\n"
    assert type_in(demo, "ros2 param set /param_demo sped 1.0").stderr.endswith("['sped'])\nDid you mean 'speed'?\n")


def test_only_some_parameters_are_listed(demo: World) -> None:
    assert type_in(demo, "ros2 param list /param_demo --param-prefixes speed --param-type").stdout == (
        "  speed (type: double)\n"
    )
    assert type_in(demo, "ros2 param list /param_demo --filter '^f'").stdout == "  fixed\n  flags\n"
    assert type_in(demo, "ros2 param list --filter '['").code == 1


def test_a_prefix_may_end_within_a_name_and_a_filter_begins_where_a_name_begins(demo: World) -> None:
    assert type_in(demo, "ros2 param list /param_demo --param-prefixes f na").stdout == "  fixed\n  flags\n  name\n"
    assert type_in(demo, "ros2 param list /param_demo --filter lags").stdout == ""


def test_a_node_of_which_nothing_is_listed_has_no_heading(demo: World) -> None:
    assert type_in(demo, "ros2 param list --filter speed").stdout == "/param_demo:\n  speed\n"
    assert type_in(demo, "ros2 param list --param-prefixes spe").stdout == "/param_demo:\n  speed\n"


def test_names_with_dots_are_nested() -> None:
    pairs = [("a.b", 1), ("a.c.d", 2), ("e", 3)]
    assert nested(pairs) == {"a": {"b": 1, "c": {"d": 2}}, "e": 3}
    assert flat(nested(pairs)) == pairs
