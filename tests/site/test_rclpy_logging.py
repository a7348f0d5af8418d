"""Log lines as a real rclpy prints them, at virtual times: 1,800,000,000 s and the robot time."""

from __future__ import annotations

import re
import time
from collections.abc import Callable
from typing import Any

import pytest
import rclpy
from rcl_interfaces.msg import Log
from rclpy.impl.rcutils_logger import RcutilsLogger
from rclpy.logging import LoggingSeverity
from rclpy.node import Node

from turtle_lesson.ros.runtime.world import World

Run = Callable[..., list[Any]]
Capture = pytest.CaptureFixture[str]


def demo_logger() -> RcutilsLogger:
    """The logger of the node /ns/logger_demo, made in the running process."""
    rclpy.init()
    return Node("logger_demo", namespace="ns").get_logger()


def logged(run: Run, capsys: Capture, program: Callable[[RcutilsLogger], object], seconds: float = 10.0) -> list[str]:
    """What a program that is given a node's logger prints on its stderr, without the times and the name."""
    run(lambda found: program(demo_logger()), seconds=seconds)
    text = capsys.readouterr().err
    return re.sub(r" \[\d+\.\d{9}\] \[ns\.logger_demo\]", "", text).splitlines()


def message_of(kind: type[Exception], call: Callable[[], object]) -> str:
    """The text of the exception, of exactly this type, that a call raises."""
    with pytest.raises(kind) as caught:
        call()
    assert caught.type is kind
    return str(caught.value)


# ---------------------------------------------------------------- lines


def test_a_line_has_severity_time_and_name(run: Run, capsys: Capture) -> None:
    def program(found: list[Any]) -> None:
        logger = demo_logger()
        found.append((logger.name, logger.get_effective_level()))
        time.sleep(12.3)
        logger.info("an info line")

    assert run(program, seconds=20) == [("ns.logger_demo", 20)]
    out, err = capsys.readouterr()
    assert (out, err) == ("", "[INFO] [1800000012.300000000] [ns.logger_demo]: an info line\n")


def test_every_severity_has_its_word(run: Run, capsys: Capture) -> None:
    def program(logger: RcutilsLogger) -> None:
        logger.debug("a debug line, not shown")
        logger.info("an info line")
        logger.warning("a warning line")
        logger.warn("warn alias")
        logger.error("an error line")
        logger.fatal("a fatal line")
        logger.log("by number", LoggingSeverity.ERROR)
        logger.log("by number", 20)

    assert logged(run, capsys, program) == [
        "[INFO]: an info line",
        "[WARN]: a warning line",
        "[WARN]: warn alias",
        "[ERROR]: an error line",
        "[FATAL]: a fatal line",
        "[ERROR]: by number",
        "[INFO]: by number",
    ]


def test_the_text_is_printed_as_it_is(run: Run, capsys: Capture) -> None:
    def program(logger: RcutilsLogger) -> None:
        logger.info("two\nlines")
        logger.info("unicode é 😀")
        logger.info("percent %s {x}")

    assert logged(run, capsys, program) == [
        "[INFO]: two",
        "lines",
        "[INFO]: unicode é 😀",
        "[INFO]: percent %s {x}",
    ]


def test_a_cell_of_a_notebook_logs_to_its_ordinary_output(world: World, capsys: Capture) -> None:
    demo_logger().info("from a cell")  # Jupyter would show stderr as if it were an error
    out, err = capsys.readouterr()
    assert (out, err) == ("[INFO] [1800000000.000000000] [ns.logger_demo]: from a cell\n", "")


def test_a_call_tells_whether_it_printed(run: Run, capsys: Capture) -> None:
    def program(found: list[Any]) -> None:
        logger = demo_logger()
        found += [logger.info("shown"), logger.debug("not shown")]

    assert run(program) == [True, False]


# ---------------------------------------------------------------- once, skip_first, throttle


def test_once_and_skip_first_are_counted_for_each_line_of_the_program(run: Run, capsys: Capture) -> None:
    def program(logger: RcutilsLogger) -> None:
        for _ in range(3):
            logger.info("once", once=True)
        for number in range(3):
            logger.info(f"skip {number}", skip_first=True)
        for number in range(3):
            logger.info(f"both {number}", skip_first=True, once=True)
        logger.info("once, elsewhere", once=True)

    assert logged(run, capsys, program) == [
        "[INFO]: once",
        "[INFO]: skip 1",
        "[INFO]: skip 2",
        "[INFO]: both 1",
        "[INFO]: once, elsewhere",
    ]


def test_throttling_goes_by_virtual_time(run: Run, capsys: Capture) -> None:
    def program(found: list[Any]) -> None:
        logger = demo_logger()
        for _ in range(12):
            logger.info("throttled", throttle_duration_sec=0.5)
            time.sleep(0.1)

    run(program)
    assert capsys.readouterr().err.splitlines() == [
        "[INFO] [1800000000.000000000] [ns.logger_demo]: throttled",
        "[INFO] [1800000000.500000000] [ns.logger_demo]: throttled",
        "[INFO] [1800000001.000000000] [ns.logger_demo]: throttled",
    ]


def test_options_are_checked(world: World) -> None:
    logger = demo_logger()
    text = message_of(TypeError, lambda: logger.info("x", throtle_duration_sec=1.0))
    assert text.startswith('parameter "throtle_duration_sec" is not one of the recognized logging options')
    assert text.endswith("did you mean 'throttle_duration_sec'?")
    text = message_of(TypeError, lambda: logger.info("x", throttle_duration_sec="1"))
    assert text.startswith("throttle_duration_sec is a number of seconds, and") and text.endswith("_sec': '1'}")


def test_one_line_of_a_program_keeps_to_its_severity_and_options(run: Run, capsys: Capture) -> None:
    def program(found: list[Any]) -> None:
        logger = demo_logger()
        for options in ({"severity": 20}, {"severity": 30}, {"severity": 20, "name": "other"}):
            attempt(found, lambda options=options: logger.log("moving", **options))
        for filters in ({"once": True}, {"skip_first": True}):
            attempt(found, lambda filters=filters: logger.info("filtered", **filters))
        for seconds in (0.5, 1.0):
            attempt(found, lambda seconds=seconds: logger.info("slow", throttle_duration_sec=seconds))

    def attempt(found: list[Any], call: Callable[[], object]) -> None:
        try:
            call()
        except ValueError as error:
            found.append(str(error))

    assert run(program) == ["Logger severity, name and filters cannot be changed between calls."] * 4
    assert [line.rpartition(": ")[2] for line in capsys.readouterr().err.splitlines()] == [
        "moving",
        "filtered",
        "slow",
    ]


def test_what_is_held_back_by_its_level_counts_for_no_filter(run: Run, capsys: Capture) -> None:
    def program(logger: RcutilsLogger) -> None:
        for level in (30, 10, 10):
            logger.set_level(level)
            logger.info("the first that is printed", once=True)
            logger.info("the second that might be", skip_first=True)

    assert logged(run, capsys, program) == ["[INFO]: the first that is printed", "[INFO]: the second that might be"]


def test_a_throttled_line_that_skips_its_first_call_waits_for_the_next_turn(run: Run, capsys: Capture) -> None:
    def program(logger: RcutilsLogger) -> None:
        for number in range(10):
            logger.info(f"call {number}", throttle_duration_sec=0.25, skip_first=True)
            time.sleep(0.1)

    assert logged(run, capsys, program) == ["[INFO]: call 3", "[INFO]: call 6", "[INFO]: call 9"]


def test_each_logger_counts_for_itself_and_a_node_has_one(run: Run, capsys: Capture) -> None:
    def program(found: list[Any]) -> None:
        rclpy.init()
        node = Node("n")
        for _ in range(3):
            node.get_logger().info("of the node", once=True)
            rclpy.logging.get_logger("free").info("made anew", once=True)
            node.get_logger().get_child("sub").info("a new child", once=True)

    run(program)
    lines = [line.rpartition(": ")[2] for line in capsys.readouterr().err.splitlines()]
    assert [lines.count(text) for text in ("of the node", "made anew", "a new child")] == [1, 3, 3]


def test_lines_of_one_name_in_two_places_are_throttled_apart(run: Run, capsys: Capture) -> None:
    def program(logger: RcutilsLogger) -> None:
        def complain() -> None:
            logger.error("from one place", throttle_duration_sec=10.0)

        for _ in range(3):
            complain()
            logger.error("from another", throttle_duration_sec=10.0)

    assert logged(run, capsys, program) == ["[ERROR]: from one place", "[ERROR]: from another"]


# ---------------------------------------------------------------- levels and names


def test_a_child_logger_and_one_without_a_node(run: Run, capsys: Capture) -> None:
    def program(found: list[Any]) -> None:
        demo_logger().get_child("sub").info("child logger")
        rclpy.logging.get_logger("free").info("named logger")

    run(program)
    assert capsys.readouterr().err.splitlines() == [
        "[INFO] [1800000000.000000000] [ns.logger_demo.sub]: child logger",
        "[INFO] [1800000000.000000000] [free]: named logger",
    ]


def test_a_level_counts_for_the_logger_and_those_below_it(run: Run, capsys: Capture) -> None:
    def program(found: list[Any]) -> None:
        logger = demo_logger()
        logger.set_level(LoggingSeverity.DEBUG)
        logger.debug("debug now shown")
        child = logger.get_child("sub")
        child.debug("there, too")
        child.set_level(LoggingSeverity.ERROR)
        found += [child.warning("no more"), child.get_effective_level(), logger.get_effective_level()]
        found.append(rclpy.logging.get_logger("free").get_effective_level())

    assert run(program) == [False, LoggingSeverity.ERROR, LoggingSeverity.DEBUG, LoggingSeverity.INFO]
    assert [line.rpartition("]: ")[2] for line in capsys.readouterr().err.splitlines()] == [
        "debug now shown",
        "there, too",
    ]


def test_levels_from_the_command_line(world: World) -> None:
    def level_of(name: str, *arguments: str) -> LoggingSeverity:
        context = rclpy.Context()
        rclpy.init(args=["prog", "--ros-args", *arguments], context=context)
        level = Node(name, context=context).get_logger().get_effective_level()
        rclpy.shutdown(context=context)
        return level

    assert level_of("n1") == LoggingSeverity.INFO
    assert level_of("n1", "--log-level", "n1:=warn") == LoggingSeverity.WARN
    assert level_of("n2", "--log-level", "debug") == LoggingSeverity.DEBUG


def test_a_level_that_is_none_is_refused(world: World) -> None:
    logger = demo_logger()
    with pytest.raises(ValueError) as caught:
        logger.set_level("DEBUG")
    assert str(caught.value) == "'DEBUG' is not a valid LoggingSeverity"
    arguments = ["prog", "--ros-args", "--log-level", "loud"]
    with pytest.raises(rclpy.exceptions.RCLError) as refused:
        rclpy.init(args=arguments, context=rclpy.Context())
    assert str(refused.value) == (
        "failed to initialize rcl: Couldn't parse log level: '--log-level loud'. "
        "Error: Argument does not use a valid severity level, such as DEBUG, INFO, WARN or ERROR"
    )


def test_each_process_has_its_own_levels(run: Run, capsys: Capture) -> None:
    def loud(found: list[Any]) -> None:
        demo_logger().set_level(LoggingSeverity.DEBUG)

    def quiet(found: list[Any]) -> None:
        found.append(demo_logger().debug("not shown"))

    assert run(loud, quiet) == [False]


def test_lines_have_colours_where_the_environment_asks_for_them(
    run: Run, capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    def program(found: list[Any]) -> None:
        logger = demo_logger()
        logger.set_level(LoggingSeverity.DEBUG)
        logger.debug("text")
        logger.info("text")
        logger.warning("text")
        logger.error("text")
        logger.fatal("text")

    monkeypatch.setenv("RCUTILS_COLORIZED_OUTPUT", "1")
    run(program)
    printed = capsys.readouterr().err.splitlines()
    assert [line.partition("[")[2].partition("m")[0] for line in printed] == ["32", "0", "33", "31", "31"]
    assert all(line.startswith("\033[") and line.endswith(" text\033[0m") for line in printed)


# ---------------------------------------------------------------- mistakes


def test_no_message_is_printed_as_c_does_it(world: World, capsys: Capture) -> None:
    demo_logger().info(None)  # type: ignore[arg-type]
    assert capsys.readouterr().out.endswith(": (null)\n")


def test_a_message_must_be_one_text(world: World) -> None:
    logger = demo_logger()
    assert message_of(TypeError, lambda: logger.info(5)) == (
        "a log message must be a str, got 5: write str(…) or an f-string"
    )
    assert message_of(TypeError, lambda: logger.info("a %d", 5)) == (
        "RcutilsLogger.info() takes 2 positional arguments but 3 were given"
    )
    assert message_of(ValueError, lambda: logger.get_child("")) == "Child logger name must not be empty."
    assert message_of(ValueError, lambda: rclpy.logging.get_logger("")) == "Logger name must not be empty."


# ---------------------------------------------------------------- /rosout


def test_what_a_node_logs_is_published_too(run: Run, capsys: Capture) -> None:
    def listen(found: list[Any]) -> None:
        rclpy.init()
        node = rclpy.create_node("ear")
        node.create_subscription(Log, "/rosout", found.append, 10)
        rclpy.spin(node)

    def talk(found: list[Any]) -> None:
        rclpy.init()
        node = Node("talker", namespace="ns")
        quiet = Node("quiet", enable_rosout=False)
        time.sleep(1.5)
        node.get_logger().warning("battery low")
        node.get_logger().debug("not printed, not published")
        quiet.get_logger().info("printed only")

    (log,) = run(listen, talk)
    assert (log.level, log.name, log.msg, log.function) == (30, "ns.talker", "battery low", "talk")
    assert (log.stamp.sec, log.stamp.nanosec) == (1_800_000_001, 500_000_000)
    assert log.file.endswith("test_rclpy_logging.py")
    assert log.line > 0
    assert len(capsys.readouterr().err.splitlines()) == 2


def test_two_nodes_of_one_name_share_a_publisher_and_lose_it_together(run: Run, capsys: Capture) -> None:
    def listen(found: list[Any]) -> None:
        rclpy.init()
        node = rclpy.create_node("ear")
        node.create_subscription(Log, "/rosout", lambda log: found.append(log.msg), 10)
        rclpy.spin(node)

    def twins(found: list[Any]) -> None:
        rclpy.init()
        first, second = Node("twin"), Node("twin")
        first.get_logger().info("first")
        second.get_logger().info("second")
        second.destroy_node()
        time.sleep(0.1)
        first.get_logger().info("printed only")

    assert run(listen, twins) == ["first", "second"]
    lines = capsys.readouterr().err.splitlines()
    assert "Publisher already registered for provided node name." in lines[0]
    assert len(lines) == 4


# ---------------------------------------------------------------- throttling by a clock, formats, services


def test_throttling_may_go_by_a_clock_of_ones_own(run: Run, capsys: Capture) -> None:
    from rclpy.clock import ROSClock
    from rclpy.time import Time

    def program(found: list[Any]) -> None:
        logger, clock = demo_logger(), ROSClock()
        clock._set_ros_time_is_active(True)
        logger.info("never throttled", throttle_duration_sec=0.0, throttle_time_source_type=clock)
        for second in (1.0, 1.4, 1.5, 1.9, 2.1):
            clock.set_ros_time_override(Time(seconds=second))
            time.sleep(10.0)
            logger.info(f"at {second}", throttle_duration_sec=0.5, throttle_time_source_type=clock)

    run(program, seconds=100.0)
    assert [line.rpartition(": ")[2] for line in capsys.readouterr().err.splitlines()] == [
        "never throttled",
        "at 1.0",
        "at 1.5",
        "at 2.1",
    ]


@pytest.mark.parametrize(
    ("options", "kind", "text"),
    [
        (
            {"speed": 1},
            TypeError,
            'parameter "speed" is not one of the recognized logging options "[\'throttle_duration_sec\', '
            "'throttle_time_source_type', 'skip_first', 'once']\"",
        ),
        (
            {"throttle_time_source_type": object},
            TypeError,
            "throttle_duration_sec is a number of seconds, and throttle_time_source_type a clock such as node.get_clock(), "
            "got {'throttle_time_source_type': <class 'object'>}",
        ),
        (
            {"throttle_time_source_type": "RCUTILS_STEADY_TIME", "throttle_duration_sec": 1.0},
            TypeError,
            "throttle_duration_sec is a number of seconds, and throttle_time_source_type a clock such as node.get_clock(), "
            "got {'throttle_time_source_type': 'RCUTILS_STEADY_TIME', 'throttle_duration_sec': 1.0}",
        ),
    ],
)
def test_options_that_do_not_go_together(
    world: World, options: dict[str, Any], kind: type[Exception], text: str
) -> None:
    assert message_of(kind, lambda: demo_logger().info("x", **options)) == text


def test_the_environment_may_ask_for_another_format(run: Run, capsys: Capture, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(
        "RCUTILS_CONSOLE_OUTPUT_FORMAT",
        "{severity}|{name}|{message}|{function_name}|{short_file_name}|{time_as_nanoseconds}|{date_time_with_ms}|{odd}|{{x}",
    )

    def program(found: list[Any]) -> None:
        rclpy.init(args=[])
        rclpy.logging.get_logger("a.b").warning("hello {name}")

    run(program)
    assert capsys.readouterr().err == (
        "WARN|a.b|hello {name}|program|test_rclpy_logging.py|1800000000000000000|2027-01-15 08:00:00.000|{odd}|{{x}\n"
    )


def test_levels_are_read_and_forgotten(world: World) -> None:
    logging = rclpy.logging
    logging.set_logger_level("a", logging.LoggingSeverity.ERROR)
    logging.set_logger_level("", 10)
    assert logging.get_logger_level("a") == 40
    assert logging.get_logger_level("a.b") == logging.LoggingSeverity.UNSET
    assert logging.get_logger_effective_level("a.b") == 40
    assert logging.get_logger_effective_level("other") == logging.LoggingSeverity.DEBUG
    assert logging.get_logger("a").get_child("b").is_enabled_for(40)
    logging.clear_config()
    assert logging.get_logger_effective_level("a.b") == logging.LoggingSeverity.INFO
    assert logging.get_logger_level("") == logging.LoggingSeverity.INFO
    assert logging.get_logging_severity_from_string("Warn") == 30


def test_where_a_robot_would_keep_its_log_files(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ROS_HOME", "/ros")
    assert str(rclpy.logging.get_logging_directory()) == "/ros/log"
    monkeypatch.setenv("ROS_LOG_DIR", "/logs")
    assert str(rclpy.logging.get_logging_directory()) == "/logs"


def test_levels_are_asked_for_and_set_by_services(world: World) -> None:
    from rcl_interfaces.msg import LoggerLevel
    from rcl_interfaces.srv import GetLoggerLevels, SetLoggerLevels

    def program() -> None:
        rclpy.init(args=[])
        rclpy.spin(Node("demo", namespace="ns", enable_logger_service=True))

    world.spawn(program, name="demo")
    rclpy.init(args=[])
    node = rclpy.create_node("asker")
    world.sim.run_until(100_000_000)
    setter = node.create_client(SetLoggerLevels, "/ns/demo/set_logger_levels")
    wishes = [LoggerLevel(name="ns.demo", level=10), LoggerLevel(name="x", level=15)]
    results = setter.call(SetLoggerLevels.Request(levels=wishes)).results
    assert [(each.successful, each.reason) for each in results] == [
        (True, ""),
        (False, "Failed reason: Invalid logger level."),
    ]
    getter = node.create_client(GetLoggerLevels, "/ns/demo/get_logger_levels")
    levels = getter.call(GetLoggerLevels.Request(names=["ns.demo", "y"])).levels
    assert [(each.name, each.level) for each in levels] == [("ns.demo", 10), ("y", 0)]


def test_a_level_set_by_service_counts_for_children_until_they_have_their_own(world: World, capsys: Capture) -> None:
    from rcl_interfaces.msg import LoggerLevel
    from rcl_interfaces.srv import SetLoggerLevels

    def program() -> None:
        rclpy.init(args=[])
        node = Node("demo", enable_logger_service=True)
        child = node.get_logger().get_child("arm")
        grandchild = child.get_child("hand")

        def work() -> None:
            node.get_logger().debug("node")
            child.debug("arm")
            grandchild.debug("hand")

        node.create_timer(1.0, work)
        rclpy.spin(node)

    world.spawn(program, name="demo")
    rclpy.init(args=[])
    node = rclpy.create_node("asker")
    world.sim.run_until(100_000_000)
    client = node.create_client(SetLoggerLevels, "/demo/set_logger_levels")

    def printed_with(name: str, level: int) -> list[str]:
        client.call(SetLoggerLevels.Request(levels=[LoggerLevel(name=name, level=level)]))
        capsys.readouterr()
        world.sim.run_until(world.now + 1_000_000_000)
        return [line.rpartition(": ")[2] for line in capsys.readouterr().err.splitlines()]

    assert printed_with("other", 10) == []
    assert printed_with("demo", 10) == ["node", "arm", "hand"]
    assert printed_with("demo.arm", 40) == ["node"]
    assert printed_with("demo.arm.hand", 10) == ["node", "hand"]
    assert printed_with("demo.arm", 0) == ["node", "arm", "hand"]  # UNSET: that of the node again
    assert printed_with("demo", 20) == ["hand"]
