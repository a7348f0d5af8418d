"""Whatever stands in an XML or YAML launch file: it is carried out, or refused with a sentence; nothing crashes or hangs."""

from __future__ import annotations

import contextlib
import io
import tempfile
from pathlib import Path
from typing import Any
from xml.sax.saxutils import quoteattr

import yaml
from hypothesis import given
from hypothesis import strategies as st
from launch_world import FakeWorld

from turtle_lesson.ros.launching.errors import LaunchError
from turtle_lesson.ros.launching.service import launch_file, show_arguments

TAGS = [
    "arg", "let", "node_container", "node", "lifecycle_node", "executable", "group", "include", "log", "log_info", "timer",
    "shutdown", "set_env", "unset_env", "append_env", "push_ros_namespace", "set_parameter",
    "set_remap", "set_use_sim_time", "for_each", "ros_timer", "composable_node",
    "param", "remap", "env", "keep", "choice", "launch", "nonsense",
]  # fmt: skip
NAMES = [
    "name", "value", "pkg", "exec", "namespace", "args", "ros_args", "output", "if", "unless", "default", "description",
    "message", "level", "file", "from", "to", "cmd", "shell", "period", "scoped", "forwarding",
    "value-sep", "type", "respawn", "respawn_delay", "emulate_tty", "reason", "filename", "prepend", "separator", "cwd",
    "allow_substs", "launch-prefix", "sigterm_timeout", "autostart", "id", "node", "children", "nonsense",
]  # fmt: skip
WORDS = [
    "robot_controller", "navigator", "true", "false", "0", "1", "-1", "1e9", "x", "$(var x)", "$(var x 1)", "$(eval '1 + 1')",
    "$(eval '1 / 0')", "$(dirname)", "$(find-pkg-share robot_controller)", "$(env HOME)", "$(anon a)", "$(command 'ls /')",
    "[1, 2]", "ros2 topic list", "'a b' c", "screen", "/ns", "a,b", ",", "", " ", "$", "$(", "\\", "'", '"',
]  # fmt: skip

values = st.sampled_from(WORDS) | st.text(max_size=12)
bits = st.sampled_from(["$(", ")", " ", "'", '"', "\\", "$", "var", "eval", "x", "1", "not", "$(var x)", "dirname"])


def carried_out(text: str, name: str) -> None:
    """Carry a text out for some seconds. Only a LaunchError may come of it, and that says something."""
    world: Any = FakeWorld()
    with tempfile.TemporaryDirectory() as folder, contextlib.redirect_stdout(io.StringIO()):
        path = Path(folder) / name
        path.write_text(text, encoding="utf-8")
        for attempt in (lambda: show_arguments(world, path), lambda: launch_file(world, path, {"x": "2"})):
            try:
                attempt()
            except LaunchError as error:
                assert error.reason and error.console and str(error)
        world.run(3)


def as_xml(tag: str, attributes: dict[str, str], children: list[str]) -> str:
    shown = "".join(f" {name}={quoteattr(value)}" for name, value in attributes.items())
    return f"<{tag}{shown}>{''.join(children)}</{tag}>"


printable = st.text(st.characters(exclude_categories=["Cs", "Cc"]), max_size=12) | st.sampled_from(WORDS)
attributes = st.dictionaries(st.sampled_from(NAMES), printable, max_size=5)
leaves = st.builds(as_xml, st.sampled_from(TAGS), attributes, st.just([]))
trees = st.recursive(
    leaves,
    lambda inner: st.builds(as_xml, st.sampled_from(TAGS), attributes, st.lists(inner, max_size=3)),
    max_leaves=8,
)


@given(st.lists(trees, max_size=4))
def test_any_xml_tree(parts: list[str]) -> None:
    carried_out(f"<launch>{''.join(parts)}</launch>", "fuzz.launch.xml")


plain = values | st.booleans() | st.integers() | st.floats() | st.none()
bodies = st.recursive(
    plain | st.dictionaries(st.sampled_from(NAMES), plain, max_size=5),
    lambda inner: (
        st.lists(st.dictionaries(st.sampled_from(TAGS), inner, min_size=1, max_size=2), max_size=3)
        | st.dictionaries(st.sampled_from([*NAMES, "param", "remap"]), inner, max_size=3)
    ),
    max_leaves=8,
)


@given(st.lists(st.dictionaries(st.sampled_from(TAGS), bodies, min_size=1, max_size=1), max_size=4))
def test_any_yaml_tree(items: list[Any]) -> None:
    carried_out(yaml.safe_dump({"launch": items}), "fuzz_launch.yaml")


@given(st.text(max_size=60) | st.lists(bits, max_size=8).map("launch:\n- log: {message: ".__add__("").join))
def test_any_text(text: str) -> None:
    with contextlib.suppress(UnicodeEncodeError):
        carried_out(text, "fuzz.launch.yaml")
        carried_out(text, "fuzz.launch.xml")
        carried_out(f"<launch>{text}</launch>", "fuzz_launch.xml")


@given(st.lists(bits, max_size=10).map("".join) | st.text(max_size=30))
def test_any_substitution(text: str) -> None:
    from launch import LaunchContext
    from launch.frontend import parse_substitution
    from launch.utilities import perform_substitutions

    try:
        pieces = parse_substitution(text)
    except (ValueError, RuntimeError, TypeError) as error:
        assert str(error)
        return
    if all(type(piece).__name__ == "TextSubstitution" for piece in pieces) and "\\" not in text:
        assert perform_substitutions(LaunchContext(), pieces) == text


def test_a_file_that_grows_without_end_is_refused() -> None:
    bomb = "launch:\n- &a\n  group: &b\n  - log: {message: x}\n"
    level = "b"
    for number in range(9):
        bomb += f"- group: &c{number}\n" + f"  - group: *{level}\n" * 10
        level = f"c{number}"
    carried_out(bomb, "bomb.launch.yaml")
    carried_out("launch: &a\n- group: *a\n", "round.launch.yaml")
    carried_out('<launch><log message="' + "$(not " * 5000 + '"/></launch>', "deep.launch.xml")
    carried_out("<launch>" + "<group>" * 3000 + "</group>" * 3000 + "</launch>", "deep.launch.xml")
