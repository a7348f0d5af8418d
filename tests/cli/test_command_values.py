"""What is typed as YAML becomes a message, and a message becomes text, as recorded from the real tools."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import command_system as system
import pytest
import yaml
from command_cases import FOLDER, type_in
from command_interfaces import interfaces  # noqa: F401
from rosidl_runtime_py import message_to_csv, message_to_yaml, set_message_fields

from turtle_lesson.ros.cli.typed_values import class_of, populate, read_yaml
from turtle_lesson.ros.cli.verb import CommandError
from turtle_lesson.ros.idl.model import InvalidDefinition
from turtle_lesson.ros.idl.registry import registry
from turtle_lesson.ros.runtime.world import World

CUT = 200
"""Recorded lines that are longer than this may have been cut off."""


def recorded_values() -> Iterator[tuple[str, str, str]]:
    """Type, YAML and what came of it."""
    lines = (FOLDER / "values.txt").read_text(encoding="utf-8").splitlines()
    for asked, answered in zip(lines[2::2], lines[3::2], strict=False):
        kind, _, text = asked.partition("  ")
        yield kind, text, answered.strip()


@pytest.mark.parametrize(("kind", "text", "expected"), list(recorded_values()))
def test_yaml_becomes_a_message(kind: str, text: str, expected: str, world: World) -> None:
    message = class_of(kind, "msg")()
    if "ParserError" in expected:
        with pytest.raises(
            CommandError, match=r"^The passed value is not valid YAML: while parsing a flow mapping, expected"
        ):
            read_yaml(text)
        return
    if expected.startswith("!! "):
        name, _, quoted = expected[3:].partition(": ")
        with pytest.raises((TypeError, AttributeError, ValueError, AssertionError)) as caught:
            set_message_fields(message, read_yaml(text))
        assert (type(caught.value).__name__, str(caught.value)) == (name, ast.literal_eval(quoted))
    else:
        set_message_fields(message, read_yaml(text) or {})
        shown, whole = expected.removeprefix("-> "), len(expected) < CUT
        assert repr(message) == shown if whole else repr(message).startswith(shown)


def recorded_formats() -> Iterator[tuple[str, str, str]]:
    """Name of a message, its YAML and its comma-separated values."""
    text = (FOLDER / "formats.txt").read_text(encoding="utf-8")
    for part in re.split(r"^## ", text, flags=re.M)[1:]:
        head, _, rest = part.partition("\n")
        shown, _, values = rest.partition("---\n")
        yield head.partition(" = ")[0], shown, values.removeprefix("csv: ").removesuffix("\n")


@pytest.mark.parametrize(("name", "expected", "values"), list(recorded_formats()))
def test_a_message_becomes_text(name: str, expected: str, values: str, world: World) -> None:
    message = system.formats()[name]
    assert message_to_yaml(message, truncate_length=128) == expected
    assert message_to_csv(message, truncate_length=128) == values


@pytest.mark.parametrize("name", list(system.formats()))
def test_what_is_printed_as_yaml_can_be_typed(name: str, world: World) -> None:
    message = system.formats()[name]
    text = message_to_yaml(message)
    if name == "byte":
        return  # the real tools print it as a text that they do not take
    again = type(message)()
    set_message_fields(again, read_yaml(text))
    assert message_to_yaml(again) == text


def test_types_are_found_by_their_recorded_names(world: World) -> None:
    for name in ("geometry_msgs/msg/Twist", "geometry_msgs/Twist"):
        assert class_of(name, "msg").__name__ == "Twist"
    assert class_of("std_srvs/srv/Empty", "srv").__name__ == "Empty"


@pytest.mark.parametrize(
    "name",
    [
        "geometry_msgs.msg.Twist",
        "Twist",
        "geometry_msgs/srv/Twist",
        "nope/msg/X",
        "geometry_msgs/msg/Nope",
        "a/b/c/d",
        "",
    ],
)
def test_types_are_refused_by_their_recorded_names(name: str, world: World) -> None:
    with pytest.raises(CommandError, match=r"^The passed message type is invalid"):
        class_of(name, "msg")
    with pytest.raises(CommandError, match=r"^The passed service type is invalid"):
        class_of(name, "srv")


def test_a_few_aliases_are_read() -> None:
    assert read_yaml("{a: &a {x: 1}, b: *a}") == {"a": {"x": 1}, "b": {"x": 1}}


LAUGHS = "a0: &a0 [x, x]\n" + "".join(f"a{n}: &a{n} [{', '.join([f'*a{n - 1}'] * 8)}]\n" for n in range(1, 12))
"""Twelve lines that stand for seventeen thousand million values."""

MERGED = "a0: &a0 {k: 1}\n" + "".join(f"a{n}: &a{n} {{<<: [{', '.join([f'*a{n - 1}'] * 8)}]}}\n" for n in range(1, 12))


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (LAUGHS, "its aliases stand for more than 100,000 values: *a4 alone for 12,873. Write out what is needed"),
        (MERGED, "its aliases stand for more than 100,000 values: *a4 alone for"),
        ("&a [*a]", "*a stands for a value that contains it, which has no end"),
        ("&a {b: [*a]}", "*a stands for a value that contains it"),
        ("[" * 5000, "lists and mappings are nested more than 100 deep"),
        ("{a: " * 5000, "lists and mappings are nested more than 100 deep"),
        ("- " * 5000, "lists and mappings are nested more than 100 deep"),
        ("#" * 1_000_001, "it has 1,000,001 characters, and at most 1,000,000 are read"),
    ],
)
def test_a_short_text_that_stands_for_something_huge_is_refused(
    world: World, tmp_path: Path, text: str, said: str
) -> None:
    from rclpy.parameter import get_parameter_value, parameter_dict_from_yaml_file

    file = tmp_path / "p.yaml"
    file.write_text(text)
    with pytest.raises(yaml.YAMLError) as caught:
        parameter_dict_from_yaml_file(str(file))
    assert said in str(caught.value)
    assert get_parameter_value(text).string_value == text
    if len(text) < 100_000:
        with pytest.raises(CommandError, match=r"^The passed value is not valid YAML: ") as refused:
            read_yaml(text)
        assert said in str(refused.value) and "\n" not in str(refused.value)


def test_yaml_means_what_it_means_elsewhere() -> None:
    text = "{a: [1, 2.5, yes, ~, 0x10, 010, 1_000, 1e3, 12:30, 2020-01-01, '1'], <<: {b: 2}}"
    assert read_yaml(text) == yaml.safe_load(text)


def test_a_field_of_ours_that_is_none_is_no_field(world: World) -> None:
    message: Any = class_of("std_msgs/String", "msg")()
    for name in ("SLOT_TYPES", "__class__", "_data", "get_fields_and_field_types"):
        with pytest.raises(AttributeError, match="has no attribute"):
            set_message_fields(message, {name: 1})


def test_auto_and_now_are_the_time_of_sending(world: World) -> None:
    answer = type_in(world, "ros2 topic pub -t 2 -w 0 /joints sensor_msgs/msg/JointState 'header: auto'")
    stamps = re.findall(r"sec=(\d+), nanosec=(\d+)", answer.stdout)
    assert len(stamps) == 2 and stamps[0][0].startswith("18000000")
    assert int(stamps[1][0]) == int(stamps[0][0]) + 1
    answer = type_in(world, "ros2 topic pub --once -w 0 /t sensor_msgs/TimeReference '{time_ref: now, source: gps}'")
    assert re.search(r"time_ref=builtin_interfaces\.msg\.Time\(sec=18000000\d\d, .*source='gps'", answer.stdout)
    answer = type_in(world, "ros2 topic pub --once -w 0 /t std_msgs/String 'data: now'")
    assert "data='now'" in answer.stdout


def test_a_definition_of_ones_own_that_is_refused_says_why(world: World, tmp_path: Path) -> None:
    (tmp_path / "msg").mkdir()
    (tmp_path / "msg" / "Bad.msg").write_text("float x\n", encoding="utf-8")
    registry.add("bad_msgs", tmp_path)
    try:
        with pytest.raises(InvalidDefinition, match=r"bad_msgs/msg/Bad\.msg, line 1, 'float x'"):
            class_of("bad_msgs/msg/Bad", "msg")
    finally:
        registry.remove("bad_msgs")


@pytest.mark.parametrize(
    ("typed", "said"),
    [
        ("off: 1", "'bool'\nYAML reads it as false"),
        ("yes: 1", "'bool'\nYAML reads it as true"),
        ("3: 1", "'int'\nYAML reads it as 3"),
    ],
)
def test_a_fields_name_that_yaml_takes_for_something_else(world: World, typed: str, said: str) -> None:
    with pytest.raises(CommandError) as caught:
        populate(class_of("turtlesim/srv/SetPen", "srv").Request(), read_yaml("{r: 7, " + typed + "}"))
    advice = ": put the field's name in quotes, such as 'off'."
    assert str(caught.value) == f"Failed to populate field: attribute name must be string, not {said}{advice}"
