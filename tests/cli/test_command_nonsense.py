"""Whatever is typed after a verb is answered: with an exit code, and with a line that says why if it is not 0."""

from __future__ import annotations

import contextlib
import io
import re
from pathlib import Path

import command_system as system
import pytest
from command_cases import type_in
from hypothesis import given
from hypothesis import strategies as st

from turtle_lesson.ros.cli.run_command import GROUPS, run
from turtle_lesson.ros.cli.verb import Verb
from turtle_lesson.ros.runtime.world import World, open_world

VERBS = [
    (group, verb)
    for group in ("daemon", "interface", "node", "param", "service", "topic")
    for verb in GROUPS[group].members
]
NAMES = ["/chatter", "chatter", "/talker", "/param_demo", "speed", "name", "/nope", "/", "//", "~", "~/x", "/a//b", "_"]
ODD_NAMES = [
    "{node}",
    "{x}",
    "{",
    "-",
    "--",
    "---",
    "\x00",
    "\x1b[31m",
    "x" * 10_000,
    "a b",
    "\ud800",
    "/*",
    "%s",
    "é😀",
]
TYPES = ["std_msgs/msg/String", "std_msgs/String", "String", "std_srvs/srv/Empty", "std_msgs/", "os/path", "a/b/c/d"]
TYPES += [
    "rcl_interfaces/srv/SetParameters",
    "turtlesim/action/RotateAbsolute",
    "std_msgs/msg/__init__",
    "geometry_msgs",
]
VALUES = ["{data: hi}", "{data: 5}", "{data: [1]}", "[1", "{}", "", "~", "{parameters: [{name: 1}]}", "!!binary aGk="]
VALUES += [
    "-1",
    "0",
    "3",
    "0.5",
    "nan",
    "-inf",
    "1e999",
    "9" * 50,
    "1e-320",
    "true",
    "[1, a]",
    "[[1]]",
    "{<<: 1}",
    "&a [*a]",
]
WORDS = ["data", "header.stamp", "m.data", "1/0", "(", "exit()", "[", "^a", "a{99999999999}", "reliable"]


@st.composite
def commands(draw: st.DrawFn) -> list[str]:
    """A verb of the command line, and what may be typed after it: its options, names, values, and anything."""
    group, verb = draw(st.sampled_from(VERBS))
    found = GROUPS[group].members[verb]
    assert isinstance(found, Verb)
    options = [each for each in found.parser.option_names() if each != "--output-dir"]  # it would write into any folder
    word = st.sampled_from(NAMES + ODD_NAMES + TYPES + VALUES + WORDS) | st.text(max_size=20)
    option = st.sampled_from(options).map(lambda name: name[:-1]) | st.sampled_from(options)
    assigned = st.builds("{}={}".format, option, word)
    names, types, values = map(st.sampled_from, (NAMES + ODD_NAMES, TYPES, VALUES))
    usual = draw(st.sampled_from([(), (names,), (names, names), (names, types), (names, types, values), (types,)]))
    begin = [draw(choice) for choice in usual]
    rest = draw(st.lists(word | option | assigned, max_size=4))
    return ["ros2", group, verb, *(begin + rest if draw(st.booleans()) else rest + begin)]


@given(commands())
def test_anything_is_answered(tmp_path: Path, words: list[str]) -> None:
    world = open_world()
    out, error = io.StringIO(), io.StringIO()
    try:
        system.start(world, system.talker, system.param_demo)
        begun = world.now
        with contextlib.chdir(tmp_path):
            code = run(world, words, stdout=out, stderr=error)
        took = (world.now - begun) / 1e9
    finally:
        world.close()
    text = error.getvalue()
    assert code in (0, 1, 2)
    assert code == 0 or text.strip(), "an exit code without a word"
    assert not re.search(r"Traceback|: [A-Z]\w+(Error|Exception|Exit): ", text)
    assert all(character.isprintable() or character in "\n\t" for character in text)
    assert max(map(len, text.splitlines()), default=0) < 2_000
    assert took < 700, "it hangs"


@pytest.mark.parametrize("option", ["--spin-time", "--for", "--keep-alive", "--rate", "--qos-depth", "--times", "-w"])
@pytest.mark.parametrize("value", ["1e300", "nan", "9" * 18])
def test_numbers_beyond_all_bounds_are_wrong_usage(option: str, value: str, world: World) -> None:
    answer = type_in(world, f"ros2 topic pub /x std_msgs/String {option}={value}")
    assert (answer.stdout, answer.code) == ("", 2)
    assert re.search(rf"error: argument .*{option}.*: ", answer.stderr)


def test_what_would_take_longer_than_a_day_is_refused(world: World) -> None:
    answer = type_in(world, "ros2 topic pub /x std_msgs/String --rate 1e-5")
    assert answer.code == 2 and "invalid positive_float value: '1e-5'" in answer.stderr
    answer = type_in(world, "ros2 topic pub -w 0 /x std_msgs/String --times 90000")
    assert (answer.stdout, answer.code) == ("", 1)
    assert answer.stderr == "90000 messages at 1 a second take longer than a day: publish fewer\n"


def test_a_command_goes_on_for_as_long_as_it_was_told(world: World) -> None:
    """A call from a cell is given up after 15 minutes of robot time; a command, which limits its own waits, is not."""
    answer = type_in(world, "ros2 topic pub /x std_msgs/String -p 0 --for 2000")
    assert answer.stderr.startswith("(stopped after 2000 s of robot time;") and answer.code == 2
    assert answer.seconds == pytest.approx(2000.1)
    assert type_in(world, "ros2 node list --spin-time 5000").seconds == pytest.approx(5000.0)


def test_a_name_with_an_unknown_substitution_is_explained(world: World) -> None:
    for words in ("topic echo {}", "topic hz {}", "topic pub {} std_msgs/String", "service call {} std_srvs/Empty"):
        answer = type_in(world, f"ros2 {words.format('/a/{x}')}")
        assert answer.code == 1
        assert answer.stderr.startswith("topic name '/a/{x}' is invalid: unknown substitution: {x}"), words
