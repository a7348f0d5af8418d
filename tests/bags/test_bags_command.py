"""`ros2 bag record`, `info` and `play`, as typed. No recording of the real tool exists for them: what is asserted here is
the format of rosbag2 of Humble (ros2bag's verbs, rosbag2_transport's log lines, rosbag2_py's format_bag_meta_data.cpp).

Where we differ on purpose: times have nine digits and are UTC (Humble cuts them to milliseconds without leading zeros and
prints local time), `record` goes on for 5 s of robot time unless told otherwise and says so, there are no keyboard
controls, and names that are not there get a "did you mean".
"""

from __future__ import annotations

import contextlib
from io import StringIO
from pathlib import Path
from typing import Any

import pytest
import rclpy
from bag_help import no_package_is_left, write_bag  # noqa: F401
from std_msgs.msg import Int32

from turtle_lesson.ros.bags.bag import moment_text, size_text
from turtle_lesson.ros.cli.run_command import run
from turtle_lesson.ros.runtime.world import World


class Terminal:
    """Types commands; each answer is (exit code, stdout, stderr)."""

    def __init__(self, world: World, folder: Path) -> None:
        self.world = world
        self.folder = folder

    def __call__(self, line: str) -> tuple[int, str, str]:
        out, err = StringIO(), StringIO()
        with contextlib.chdir(self.folder):
            code = run(self.world, line.split(), stdout=out, stderr=err)
        return code, out.getvalue(), err.getvalue()


@pytest.fixture
def terminal(world: World, tmp_path: Path) -> Terminal:
    """A terminal in an empty folder of a world where a talker counts ten times a second."""

    def talker() -> None:
        rclpy.init()
        node = rclpy.create_node("talker")
        publisher = node.create_publisher(Int32, "count", 10)
        node.create_timer(0.1, lambda: publisher.publish(Int32(data=7)))
        rclpy.spin(node)

    world.spawn(talker, name="talker")
    world.sim.settle()
    return Terminal(world, tmp_path)


RECORDED = """\
[INFO] [1800000000.000000000] [rosbag2_recorder]: Listening for topics...
[INFO] [1800000000.000000000] [rosbag2_recorder]: Subscribed to topic '/count'
[INFO] [1800000000.000000000] [rosbag2_recorder]: Recording...
[INFO] [1800000000.000000000] [rosbag2_recorder]: All requested topics are subscribed. Stopping discovery...
[INFO] [1800000001.000000000] [rosbag2_recorder]: Recording stopped
"""

INFO = """
Files:             run_0.mcap
Bag size:          SIZE
Storage id:        mcap
Duration:          0.800000000s
Start:             Jan 15 2027 08:00:00.100000000 (1800000000.100000000)
End:               Jan 15 2027 08:00:00.900000000 (1800000000.900000000)
Messages:          9
Topic information: Topic: /count | Type: std_msgs/msg/Int32 | Count: 9 | Serialization Format: cdr

"""


def test_record_info_play(terminal: Terminal) -> None:
    assert terminal("ros2 bag record /count -o run --for 1") == (0, "", RECORDED)
    code, out, err = terminal("ros2 bag info run")
    size = size_text((terminal.folder / "run" / "run_0.mcap").stat().st_size)
    assert (code, out, err) == (0, INFO.replace("SIZE", size), "")
    begin = terminal.world.now
    code, out, err = terminal("ros2 bag play run -r 0.5 --remap /count:=/again")
    assert (code, out) == (0, "")
    assert err == "[INFO] [1800000001.000000000] [rosbag2_player]: Set rate to 0.5\n"
    assert 1_600_000_000 <= terminal.world.now - begin < 1_601_000_000


def test_recording_ends_by_itself_and_says_so(terminal: Terminal) -> None:
    code, out, err = terminal("ros2 bag record -a -o run -s sqlite3")
    assert (code, out) == (0, "")
    assert "Subscribed to topic '/rosout'" in err
    assert err.splitlines()[-1] == "(stopped after 5 s of robot time; --for SECONDS makes it longer or shorter)"
    _, out, _ = terminal("ros2 bag info run")
    assert "Storage id:        sqlite3" in out
    assert "Topic: /count | Type: std_msgs/msg/Int32 | Count: 49 |" in out
    assert "\n                   Topic: /" in out


def test_without_a_name_it_is_called_after_the_time(terminal: Terminal) -> None:
    terminal("ros2 bag record -a --for 1")
    assert [path.name for path in terminal.folder.iterdir()] == ["rosbag2_2027_01_15-08_00_00"]


def test_by_pattern(terminal: Terminal) -> None:
    assert "Subscribed to topic '/count'" in terminal("ros2 bag record -e c.unt -o a --for 1")[2]
    assert "Subscribed to topic '/count'" not in terminal("ros2 bag record -a -x count -o b --for 1")[2]


def test_topics_as_newer_releases_spell_them(terminal: Terminal) -> None:
    err = terminal("ros2 bag record -o run --topics count /nobody --for 1")[2]
    assert "Subscribed to topic '/count'" in err
    assert "no node published on /nobody while the bag was recorded" in err
    assert "All requested topics" not in err
    assert terminal("ros2 bag info -t run") == (0, "/count\n", "")


def test_who_records_and_who_plays_is_in_the_graph_as_on_a_robot(terminal: Terminal) -> None:
    world = terminal.world
    seen: list[list[str]] = []

    def look() -> None:
        names = [node.full_name for node in world.graph.nodes if not node.hidden]
        seen.append([name for name in names if name != "/talker"])

    world.sim.call_later(500_000_000, look)
    world.sim.call_later(1_500_000_000, look)
    terminal("ros2 bag record /count -o run --for 1")
    terminal("ros2 bag play run")
    look()
    assert seen == [["/rosbag2_recorder"], ["/rosbag2_player"], []]


def test_endless_words_are_answered_in_a_short_line(terminal: Terminal) -> None:
    write_bag(terminal.folder / "bag", 2)
    endless = "x" * 10_000
    for line in (
        f"record -a -o {endless}",
        f"play bag -m {endless}",
        f"play bag --topics {endless}",
        f"info {endless}",
    ):
        code, out, err = terminal(f"ros2 bag {line}")
        assert (code > 0, out) == (True, "")
        assert len(err.splitlines()[-1]) < 350
    assert [path.name for path in terminal.folder.iterdir()] == ["bag"]


def test_what_no_folder_can_be_called_is_refused_in_a_line(terminal: Terminal) -> None:
    for name in ("a\0b", "x" * 300):
        code, _, error = terminal(f"ros2 bag record -a -o {name}")
        assert code == 1 and error.startswith("[ERROR] [ros2bag]: ") and error.count("\n") == 1


def test_nothing_is_overwritten(terminal: Terminal) -> None:
    terminal("ros2 bag record -a -o run --for 1")
    before = (terminal.folder / "run" / "run_0.mcap").read_bytes()
    assert terminal("ros2 bag record -a -o run") == (1, "", "[ERROR] [ros2bag]: Output folder 'run' already exists.\n")
    assert (terminal.folder / "run" / "run_0.mcap").read_bytes() == before


@pytest.mark.parametrize(
    ("line", "error"),
    [
        ("record", "[ERROR] [ros2bag]: Invalid choice: Must specify topic(s), --regex or --all"),
        ("record -a /count", "[ERROR] [ros2bag]: Must specify only one option out of topics, --regex or --all"),
        ("record /count -e c", "[ERROR] [ros2bag]: Must specify only one option out of topics, --regex or --all"),
        (
            "record /count -x c",
            "[ERROR] [ros2bag]: --exclude argument cannot be used when specifying a list of topics explicitly",
        ),
        ("record -e (", "[ERROR] [ros2bag]: '(' is not a regular expression: missing ), unterminated subpattern"),
        ("record /a//b", "Invalid topic name: topic name must not contain repeated '/':"),
        ("info .", "[ERROR] [ros2bag]: '.' is not a bag: there is no .mcap or .db3 file in it"),
        ("play bag --topics /cout", "[ERROR] [ros2bag]: the bag has no topic '/cout'. Did you mean '/count'?"),
        ("play bag -m count", "[ERROR] [ros2bag]: 'count' is not a remapping: write it as /old_topic:=/new_topic"),
    ],
)
def test_mistakes(terminal: Terminal, line: str, error: str) -> None:
    write_bag(terminal.folder / "bag", 2)
    code, out, err = terminal(f"ros2 bag {line}")
    assert (code, out) == (1, "")
    assert error in err
    assert [path.name for path in terminal.folder.iterdir()] == ["bag"]


@pytest.mark.parametrize(
    ("line", "error"),
    [
        ("info bg", "ros2 bag info: error: argument bag_path: Bag path 'bg' does not exist!"),
        ("play bag -r 0", "ros2 bag play: error: argument -r/--rate: invalid positive_float value: '0'"),
        ("play bag -r nan", "argument -r/--rate: invalid positive_float value: 'nan'"),
        ("play bag --start-offset -1", "argument --start-offset: invalid float value: '-1'"),
        (
            "record -a -s zip",
            "ros2 bag record: error: argument -s/--storage: invalid choice: 'zip' (choose from 'mcap', 'sqlite3')",
        ),
        ("play bag -r 1e-30", "It must be a number from 1e-09 to 1e+09"),
        ("play bag --start-offset 1e300", "argument --start-offset: invalid float value: '1e300'"),
        ("play bag --clock", "ros2: error: unrecognized arguments: --clock"),
        ("play bag -p", "ros2: error: unrecognized arguments: -p"),
        ("convert -i bag", "invalid choice: 'convert' (choose from 'info', 'play', 'record')"),
        ("play", "ros2 bag play: error: the following arguments are required: bag_path"),
        ("reord", "Did you mean 'record'?"),
    ],
)
def test_wrong_usage(terminal: Terminal, line: str, error: str) -> None:
    write_bag(terminal.folder / "bag", 2)
    code, out, err = terminal(f"ros2 bag {line}")
    assert (code, out) == (2, "")
    assert error in err
    assert err.startswith("usage: ros2")


def test_a_damaged_bag(terminal: Terminal) -> None:
    write_bag(terminal.folder / "bag", 100)
    file = terminal.folder / "bag" / "bag_0.mcap"
    file.write_bytes(file.read_bytes()[:50_000])
    code, out, err = terminal("ros2 bag info bag")
    assert code == 1
    assert "Topic: /chatter | Type: std_msgs/msg/String | Count: 45 |" in out
    assert err == (
        "[ERROR] [ros2bag]: the bag is damaged: bag_0.mcap: it ends at byte 50000, before its end record. "
        "90 of 200 messages can be read, 110 are lost\n"
    )
    code, out, err = terminal("ros2 bag play bag")
    assert (code, out) == (1, "")
    assert "[rosbag2_player]: the bag is damaged: " in err


def test_play_again_and_again(terminal: Terminal) -> None:
    write_bag(terminal.folder / "bag", 100)
    code, _, err = terminal("ros2 bag play bag -l")
    assert code == 0
    assert err.endswith("(stopped after 5 s of robot time; --for SECONDS makes it longer or shorter)\n")


@pytest.mark.parametrize(
    ("size", "text"), [(0, "0 B"), (1023, "1023 B"), (1024, "1.0 KiB"), (5_000_000, "4.8 MiB"), (1 << 50, "1024.0 TiB")]
)
def test_sizes(size: int, text: str) -> None:
    assert size_text(size) == text


def test_moments() -> None:
    assert moment_text(1_570_799_349_012_000_000) == "Oct 11 2019 13:09:09.012000000 (1570799349.012000000)"
    assert moment_text(0) == "Jan  1 1970 00:00:00.000000000 (0.000000000)"


def test_the_lesson_records(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: Any) -> None:
    from turtle_lesson import start

    monkeypatch.chdir(tmp_path)
    lesson = start()
    with lesson.record("run1", topics=["/turtle1/pose"]) as recording:
        lesson.run(1)
    assert repr(recording) == "<Recording run1: 62 messages, done>"
    assert (tmp_path / "run1" / "metadata.yaml").is_file()
