"""`ros2 topic`, against recordings of the real one."""

from __future__ import annotations

import io
import re

import command_system as system
import pytest
import rclpy
from command_cases import cases, check, shape, type_in
from command_interfaces import interfaces  # noqa: F401

from turtle_lesson.ros.cli.run_command import parse, run
from turtle_lesson.ros.runtime.world import World, current_world

pytestmark = pytest.mark.usefixtures("interfaces")

STOPPED = "(stopped after {} s of robot time; --for SECONDS makes it longer or shorter)\n"


@pytest.fixture
def lesson(world: World) -> World:
    """A world in which the lesson's three nodes run."""
    system.start(world, *system.LESSON)
    return world


# ---------------------------------------------------------------- what the real one prints


def test_list_info_find_and_type(lesson: World) -> None:
    check(lesson, "topic_list.txt")


def test_a_type_that_does_not_exist_is_found_nowhere_and_said(lesson: World) -> None:
    for name in ("geometry_msgs/Twist", "geometry_msgs/msg/Twst"):
        answer = type_in(lesson, f"ros2 topic find {name}")
        expected = f"There is no type '{name}'\nDid you mean 'geometry_msgs/msg/Twist'?\n"
        assert (answer.stdout, answer.stderr, answer.code) == ("", expected, 0)


@pytest.mark.parametrize("name", ["topic_echo.txt", "topic_rates.txt"])
def test_listening(lesson: World, name: str) -> None:
    check(lesson, name, figures=False)


def test_publishing(lesson: World) -> None:
    check(lesson, "topic_pub.txt")


def test_every_kind_of_message(world: World) -> None:
    system.start(world, system.publish_formats)
    check(world, "topic_formats.txt")


# ---------------------------------------------------------------- echo


def test_echo_of_a_long_array_is_cut_off_after_128(lesson: World) -> None:
    text = type_in(lesson, "ros2 topic echo --once /obstacles").stdout
    assert text.count("\n- ") == 129
    assert "\n- '...'\nintensities: []\n---\n" in text
    assert type_in(lesson, "ros2 topic echo --once -f /obstacles").stdout.count("\n- ") == 180
    assert "\nranges:\n- 10.0\n- 0.5\n- '...'\n" in type_in(lesson, "ros2 topic echo --once -l 2 /obstacles").stdout


def test_echo_without_texts_or_arrays(lesson: World) -> None:
    text = type_in(lesson, "ros2 topic echo --once --no-str --no-arr /obstacles").stdout
    assert "  frame_id: '<string length: <9>>'\n" in text
    assert "\nranges: '<sequence type: float, length: 180>'\n" in text
    assert "<string length: <9>>,-1.57" in type_in(lesson, "ros2 topic echo --once --no-str --csv /obstacles").stdout


def test_echo_prints_arrays_of_messages_and_fixed_arrays_by_their_type(world: World) -> None:
    system.start(world, system.publish_formats)
    text = type_in(world, "ros2 topic echo --once --no-arr /f/posearray").stdout
    assert "poses: '<sequence type: geometry_msgs/msg/Pose, length: 2>'" in text
    assert "<array type: double[9]>" in type_in(world, "ros2 topic echo --once --no-arr /f/imu").stdout


def test_a_field_as_csv_is_a_line_without_separator(lesson: World) -> None:
    text = type_in(lesson, "ros2 topic echo /robot/status --csv --field battery --for 1").stdout
    assert len(text.split()) == 10 and all(float(line) < 90 for line in text.split())
    assert type_in(lesson, "ros2 topic echo --once --csv --field header /obstacles").stdout.endswith(",base_link\n")


def test_an_index_is_no_field(lesson: World) -> None:
    answer = type_in(lesson, "ros2 topic echo --once --field ranges.3 /obstacles")
    assert answer.stderr == "Invalid field 'ranges.3': 'array.array' object has no attribute '3'\n"


@pytest.mark.parametrize(
    ("words", "error"),
    [
        ("hz -w 0 /a", "argument --window/-w: value must be a positive integer"),
        ("hz -w x /a", "argument --window/-w: value must be a positive integer"),
        ("bw -w -1 /a", "argument --window/-w: value must be a positive integer"),
        ("pub -r 0 /a std_msgs/msg/Empty", "argument -r/--rate: invalid positive_float value: '0'"),
        ("pub -r fast /a std_msgs/msg/Empty", "argument -r/--rate: invalid positive_float value: 'fast'"),
        ("echo --qos-depth x /a", "argument --qos-depth: invalid int value: 'x'"),
    ],
)
def test_numbers_that_make_no_sense_are_refused_in_the_real_words(world: World, words: str, error: str) -> None:
    answer = type_in(world, f"ros2 topic {words}")
    assert answer.code == 2
    assert f"ros2 topic {words.partition(' ')[0]}: error: {error}" in answer.stderr.splitlines()


def test_echo_raw_prints_the_bytes(lesson: World) -> None:
    text = type_in(lesson, "ros2 topic echo --once --raw /robot/status").stdout
    assert text.startswith("b'\\x00\\x01\\x00\\x00\\x00") and text.endswith("'\n---\n")


def test_a_filter_lets_only_some_messages_through(lesson: World) -> None:
    text = type_in(lesson, "ros2 topic echo /robot/status --field battery --filter 'm < 89' --for 1").stdout
    values = [float(line) for line in text.splitlines() if line != "---"]
    assert values and all(value < 89 for value in values)
    answer = type_in(lesson, "ros2 topic echo /robot/status --filter 'm.batery < 89'")
    assert answer.code == 1 and "'TurtleStatus' object has no attribute 'batery'" in answer.stderr
    answer = type_in(lesson, "ros2 topic echo /robot/status --filter 'exit(0)'")
    assert answer.code == 1 and answer.stderr == "The filter expression 'exit(0)' failed: SystemExit: 0\n"
    answer = type_in(lesson, "ros2 topic echo /robot/status --filter 'm.battery <'")
    assert answer.code == 1 and answer.stderr.startswith("Invalid filter expression 'm.battery <': ")


def test_echo_goes_on_for_five_seconds_unless_told_otherwise(lesson: World) -> None:
    answer = type_in(lesson, "ros2 topic echo /robot/status --csv")
    assert answer.stdout.count("\n") == 50
    assert answer.stderr == STOPPED.format(5)
    assert answer.seconds == pytest.approx(5.1)
    answer = type_in(lesson, "ros2 topic echo /robot/status --csv --for 0.75")
    assert answer.stdout.count("\n") in (7, 8)
    assert (answer.stderr, answer.code) == (STOPPED.format(0.75), 2)


def test_echo_of_a_topic_with_two_types_says_so(world: World) -> None:
    def confused() -> None:
        from std_msgs.msg import Int32

        rclpy.init(args=[])
        node = rclpy.create_node("confused")
        node.create_publisher(Int32, "chatter", 10)
        rclpy.spin(node)

    system.start(world, system.talker, confused)
    answer = type_in(world, "ros2 topic echo /chatter")
    types = "[std_msgs/msg/Int32, std_msgs/msg/String]"
    assert answer.stderr == f"Cannot echo topic '/chatter', as it contains more than one type: {types}\n"


def test_echo_sees_earlier_messages_of_a_publisher_that_keeps_them(world: World) -> None:
    def map_server() -> None:
        from rclpy.qos import DurabilityPolicy, QoSProfile
        from std_msgs.msg import String

        rclpy.init(args=[])
        node = rclpy.create_node("map_server")
        profile = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        node.create_publisher(String, "map", profile).publish(String(data="here"))
        rclpy.spin(node)

    system.start(world, map_server, seconds=3.0)
    assert type_in(world, "ros2 topic echo --once /map").stdout == "data: here\n---\n"


def test_a_subscription_that_asks_for_too_much_hears_nothing_and_is_told_why(world: World) -> None:
    system.start(world, system.talker)
    answer = type_in(world, "ros2 topic echo --once /chatter --qos-durability transient_local")
    warning, reason, hint = answer.stderr.splitlines()
    assert re.fullmatch(
        r"\[WARN\] \[\d+\.\d{9}\] \[_ros2cli_\d+\]: New publisher discovered on topic '/chatter', .*", warning
    )
    assert warning.endswith(
        "incompatible QoS. No messages will be received from it. Last incompatible policy: DURABILITY"
    )
    assert "do not offer the quality of service that was requested" in reason and "topic info -v /chatter" in hint
    assert (answer.stdout, answer.code) == ("", 1)
    for option in ("", " --qos-reliability best_effort", " std_msgs/msg/String"):
        answer = type_in(world, f"ros2 topic echo --once /chatter{option}")
        assert re.fullmatch(r"data: 'Hello World: \d+'\n---\n", answer.stdout) and answer.code == 0


def test_publishers_that_differ_are_all_heard(world: World) -> None:
    def hasty() -> None:
        from rclpy.qos import qos_profile_sensor_data
        from std_msgs.msg import String

        rclpy.init(args=[])
        node = rclpy.create_node("hasty")
        node.create_publisher(String, "chatter", qos_profile_sensor_data)
        rclpy.spin(node)

    system.start(world, system.talker, hasty)
    assert type_in(world, "ros2 topic echo --once /chatter").stdout.startswith(
        "Some, but not all, publishers are offering QoSReliabilityPolicy.RELIABLE. Falling back to "
        "QoSReliabilityPolicy.BEST_EFFORT as it will connect to all publishers\ndata: "
    )


def test_rosout_and_parameter_events_can_be_read(world: World) -> None:
    system.start(world, system.talker, seconds=0.6)
    lines = type_in(world, "ros2 topic echo --once /rosout").stdout.splitlines()
    assert lines[0] == "stamp:" and lines[3:6] == ["level: 20", "name: talker", "msg: 'Publishing: \"Hello World: 0\"'"]
    assert lines[6].startswith("file: ") and lines[7] == "function: talk" and lines[-1] == "---"
    keys = [line.split(":")[0] for line in lines]
    assert keys == ["stamp", "  sec", "  nanosec", "level", "name", "msg", "file", "function", "line", "---"]


def test_parameter_events_as_recorded(world: World) -> None:
    """What is heard first is the node of `ros2 param set` itself, which has a parameter as every node has."""
    verb, arguments = parse(["topic", "echo", "--once", "/parameter_events", "--for", "2"])
    out = io.StringIO()
    system.start(world, system.param_demo)
    world.spawn(lambda: verb.main(arguments), name="ros2", stdout=out)
    world.sim.run_until(world.now + 1_000_000_000)
    type_in(world, "ros2 param set /param_demo speed 0.9")
    [recorded] = cases("parameter_events.txt")
    assert shape(out.getvalue().splitlines(), figures=True) == shape(recorded.stdout, figures=True)


# ---------------------------------------------------------------- hz, bw, delay


def test_hz_is_exact_on_a_virtual_clock(lesson: World) -> None:
    answer = type_in(lesson, "ros2 topic hz /obstacles --for 2.5")
    lines = answer.stdout.splitlines()
    assert lines[0] == "average rate: 5.000"
    assert re.fullmatch(r"\tmin: 0\.200s max: 0\.200s std dev: 0\.00000s window: \d", lines[1])


def test_hz_waits_for_a_topic_that_appears_later(world: World) -> None:
    def late() -> None:
        import time

        time.sleep(2.0)
        system.talker()

    system.start(world, late)
    answer = type_in(world, "ros2 topic hz /chatter")
    assert answer.stdout.startswith(
        "WARNING: topic [/chatter] does not appear to be published yet\naverage rate: 2.000\n"
    )


def test_delay_says_when_nothing_new_has_come(world: World) -> None:
    def stops() -> None:
        from sensor_msgs.msg import LaserScan

        rclpy.init(args=[])
        node = rclpy.create_node("stops")
        publisher = node.create_publisher(LaserScan, "scan", 10)

        def publish() -> None:
            if node.get_clock().now() - begun < rclpy.duration.Duration(seconds=2):
                message = LaserScan()
                message.header.stamp = node.get_clock().now().to_msg()
                publisher.publish(message)

        begun = node.get_clock().now()
        node.create_timer(0.1, publish)
        rclpy.spin(node)

    system.start(world, stops)
    lines = type_in(world, "ros2 topic delay /scan --for 4.5").stdout.splitlines()
    assert lines[-2:] == ["no new messages"] * 2
    assert lines[0].startswith("average delay: 0.00")


def test_the_old_way_to_ask_for_lost_messages_is_warned_of(lesson: World) -> None:
    answer = type_in(lesson, "ros2 topic echo --once /robot/status --lost-messages")
    assert answer.stderr == "WARNING: '--lost-messages' is deprecated; lost messages are reported by default\n"
    assert answer.code == 0


# ---------------------------------------------------------------- pub


def test_an_endless_pub_publishes_at_its_rate_for_a_stretch(lesson: World) -> None:
    answer = type_in(lesson, "ros2 topic pub /x std_msgs/msg/Int32 '{data: 3}' -r 2 -p 4 --for 4.9")
    assert answer.stdout == "".join(
        ["publisher: beginning loop\n"] + [f"publishing #{count}: std_msgs.msg.Int32(data=3)\n\n" for count in (4, 8)]
    )
    assert (answer.stderr, answer.code) == (STOPPED.format(4.9), 2)


def test_what_is_published_arrives(world: World) -> None:
    heard = []

    def listener() -> None:
        from geometry_msgs.msg import Twist

        rclpy.init(args=[])
        node = rclpy.create_node("listener")
        node.create_subscription(Twist, "cmd_vel", lambda message: heard.append(message.linear.x), 10)
        rclpy.spin(node)

    system.start(world, listener)
    answer = type_in(world, "ros2 topic pub --times 3 --rate 10 /cmd_vel geometry_msgs/Twist '{linear: {x: 0.5}}'")
    assert (heard, answer.code, answer.seconds) == ([0.5] * 3, 0, pytest.approx(0.4))
    type_in(world, "ros2 topic pub -1 cmd_vel geometry_msgs/msg/Twist '{linear: {x: 2}}'")
    assert heard[3:] == [2.0]
    answer = type_in(world, "ros2 topic pub -1 /cmd_vel std_msgs/msg/String '{data: hi}'")
    assert answer.stderr.endswith("of /cmd_vel is of type geometry_msgs/msg/Twist, not std_msgs/msg/String\n")
    answer = type_in(world, "ros2 topic pub -1 /cmd_vel geometry_msgs/Twist --qos-reliability best_effort")
    assert "requests another quality of service" in answer.stderr.splitlines()[-2]
    answer = type_in(world, "ros2 topic pub -1 /cmdvel geometry_msgs/Twist")
    assert answer.stderr.endswith("no node subscribes to /cmdvel\nDid you mean '/cmd_vel'?\n")


# ---------------------------------------------------------------- nonsense


@pytest.mark.parametrize(
    "values",
    [
        "&a [" * 200,
        "[" * 9_000,
        "{a: &a [x, x], b: &b [*a, *a], c: &c [*b, *b], d: &d [*c, *c], e: [" + "*d, " * 20 + "*d]}",
        "x" * 200_000,
        "\x00\x01\x02",
        "{data: 2020-99-99}",
        "!!python/object:os.system {}",
        "{? [1]: 2}",
        "data: " + "9" * 9_000,
        "&a {data: *a}",
        "{1: 2}",
        "- -",
        "'",
        "@",
        "{data: !!binary '*'}",
        "",
    ],
)
def test_yaml_that_is_none_or_a_trap_is_answered_in_a_line(values: str, world: World) -> None:
    error = io.StringIO()
    words = ["ros2", "topic", "pub", "-1", "-w", "0", "/n", "std_msgs/msg/Int32", values]
    assert run(world, words, stdout=io.StringIO(), stderr=error) == 1
    text = error.getvalue()
    assert 1 <= text.count("\n") <= 2 and len(text) < 1_000
    assert "Traceback" not in text


# ---------------------------------------------------------------- beside turtlesim, and usage


def test_beside_turtlesim() -> None:
    from turtle_lesson import start

    start(seed=0, package=None)
    world = current_world()
    try:
        world.sim.run_until(world.now + 1_000_000_000)
        check(world, "turtlesim.txt")
        hz = type_in(world, "ros2 topic hz /turtle1/pose --for 4.5")
    finally:
        world.close()
    # recorded: about 62.5 a second, told of after 64, 127 and 190 messages
    assert re.findall(r"average rate: ([\d.]+)\n.* window: (\d+)\n", hz.stdout)[:3] == [
        ("62.500", "64"),
        ("62.500", "127"),
        ("62.500", "190"),
    ]


def test_usage(world: World) -> None:
    check(world, "topic_usage.txt")
    answer = type_in(world, "ros2 topic pub --help")
    for words in ("[-1 | -t TIMES]", "[--keep-alive N]", "topic_name message_type [values]", "--for SECONDS"):
        assert words in answer.stdout
    assert type_in(world, "ros2 topic echo /x -l -3").code == 2
    for rate in ("0", "-1", "1e9", "nan", "inf", "fast"):
        answer = type_in(world, f"ros2 topic pub /x std_msgs/String -r {rate}")
        assert answer.code == 2 and "argument -r/--rate: " in answer.stderr
    for option in ("--spin-time inf", "--spin-time -1", "--for 0", "--qos-depth x"):
        assert type_in(world, f"ros2 topic echo /x {option}").code == 2


def test_the_simulations_own_ears_are_not_counted(world: World) -> None:
    def _lab() -> None:
        from std_msgs.msg import String

        rclpy.init(args=[])
        node = rclpy.create_node("_lab")
        for name in ("chatter", "nothing_yet"):
            node.create_subscription(String, name, print, 10)
        rclpy.spin(node)

    system.start(world, _lab, system.talker)
    assert type_in(world, "ros2 topic list").stdout == "/chatter\n/parameter_events\n/rosout\n"
    assert "/nothing_yet" in type_in(world, "ros2 topic list --include-hidden-topics").stdout
    assert type_in(world, "ros2 topic info /chatter").stdout.endswith("Subscription count: 0\n")
    assert (
        " * /parameter_events [rcl_interfaces/msg/ParameterEvent] 2 publishers\n"
        in type_in(world, "ros2 topic list -v").stdout
    )
    answer = type_in(world, "ros2 topic pub -1 /chatter std_msgs/String")
    assert "no node subscribes to /chatter" in answer.stderr
