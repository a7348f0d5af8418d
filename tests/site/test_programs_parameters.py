"""Parameters, logging, life cycles and clocks, as the tutorials and demos write them."""

from __future__ import annotations

import pytest
from program_terminal import Terminal, having


def first(*programs: str) -> list[str]:
    return [f"first_steps {each}" for each in programs]


WILD = "--params-file install/first_steps/share/first_steps/config/wild.yaml"


def test_a_node_that_reads_its_parameters(terminal: Terminal) -> None:
    assert terminal.run(*first("settings"), seconds=1.1) == [
        "['kd', 'ki', 'kp']",
        "ParameterUninitializedException",
        "1.0 settings: Hello world! 1.0 2.0",
    ]
    assert terminal.say("ros2 param set /settings my_parameter earth", seconds=1) == [
        "Set parameter successful",
        "2.0 settings: Hello earth! 1.0 2.0",
    ]


def test_what_a_node_refuses(terminal: Terminal) -> None:
    terminal.run(*first("settings"))
    failed = "Setting parameter failed: "
    settings = {
        "speed 9.0": "Parameter speed out of range Min: 0.0, Max: 5.0, value: 9.0",
        "speed 1.7": "The parameter value for speed is not close enough to a valid step. Min: 0.0, max: 5.0, value: 1.7, "
        "step: 0.5",
        "pid.kp -- -1.0": "kp must not be negative",
        "my_parameter 3": "Wrong parameter type, expected 'Type.STRING' got 'Type.INTEGER'",
    }
    for arguments, reason in settings.items():
        assert terminal.say(f"ros2 param set /settings {arguments}") == [failed + reason]


def test_a_file_with_wildcards(terminal: Terminal) -> None:
    run = "settings --ros-args {}" + WILD
    printed = terminal.run(*first(run.format(""), run.format("-r __ns:=/somewhere ")), seconds=1.1)
    assert having(printed, "Hello") == [
        "1.0 settings: Hello everybody! 2.5 4.0",
        "1.0 somewhere.settings: Hello everybody! 3.5 4.0",
    ]


def test_a_client_of_another_nodes_parameters(terminal: Terminal) -> None:
    printed = terminal.run(*first("blackboard", "parameter_client"), seconds=1)
    assert printed[:-1] == [
        "set [True, True, True]",
        "listed ['an_int', 'a_bool', 'a_text']",
        "got [10, False, 'Fee Fi Fo Fum']",
        "types [2, 1, 4]",
        "loaded size True 3",
        "loaded colours True ['red', 'green']",
        "loaded depth.of_field True 0.5",
        "deleted True ",
    ]
    assert "a_text" in "".join(terminal.say("ros2 param list /blackboard"))


def test_a_client_without_anybody_to_talk_to(terminal: Terminal) -> None:
    printed = terminal.run(*first("parameter_client"), seconds=4)
    assert printed[-2:] == ["RuntimeError: start the blackboard first", "[ros2run]: Process exited with failure 1"]


def test_a_watcher_of_parameters(terminal: Terminal) -> None:
    terminal.run(*first("settings", "parameter_watch"), seconds=0.5)
    printed = terminal.say(
        "ros2 param set /settings my_parameter earth", "ros2 param set /parameter_watch an_int_param 43", seconds=0.1
    )
    assert [line.partition(" ")[2] for line in having(printed, "watch")] == [
        "parameter_watch: Received an update to parameter: my_parameter: earth",
        "parameter_watch: /settings changed ['my_parameter']",
        "parameter_watch: Received an update to parameter: an_int_param: 43",
    ]


def test_log_lines_once_throttled_and_skipped(terminal: Terminal) -> None:
    printed = terminal.run(*first("log_reader", "log_levels"), seconds=4)
    assert [line for line in printed if line[0].isdigit()] == [
        "1.0 log_levels: info 1",
        "1.0 log_levels: only once",
        "1.0 log_levels: throttled 1",
        "1.0 log_levels.child ERROR: child 1",
        "2.0 log_levels: info 2",
        "2.0 log_levels WARN: not the first 2",
        "2.0 log_levels.child ERROR: child 2",
        "3.0 log_levels: info 3",
        "3.0 log_levels WARN: not the first 3",
        "3.0 log_levels.child ERROR: child 3",
        "3.0 log_levels FATAL: level 20",
        "3.0 log_levels WARN: seen",
    ]
    assert having(printed, "log_levels info", "log_levels fatal")[-2:] == [
        "log_levels info tick info 3",
        "log_levels fatal tick level 20",
    ]


def test_the_level_is_set_from_outside(terminal: Terminal) -> None:
    call = "ros2 service call /log_levels/set_logger_levels rcl_interfaces/srv/SetLoggerLevels "
    terminal.run(*first("log_levels"))
    printed = terminal.say(call + "\"{levels: [{name: 'log_levels', level: 10}]}\"", seconds=1.2)
    assert "1.0 log_levels DEBUG: debug 1" in printed


def test_a_life_cycle_led_by_its_services(terminal: Terminal) -> None:
    assert terminal.run(*first("lifecycle_talker", "lifecycle_caller"), seconds=7) == [
        "0.0 lc_talker: on_configure() is called.",
        "1 True 2 inactive",
        "1.0 lc_talker: Lifecycle publisher is inactive. Messages are not published.",
        "1.3 lc_talker: on_activate() is called.",
        "3 True 3 active",
        "2.0 lc_talker: Lifecycle publisher is active. Publishing: [Lifecycle HelloWorld #1]",
        "2.6 lc_talker: on_deactivate() is called.",
        "4 True 2 inactive",
        "3.0 lc_talker: Lifecycle publisher is inactive. Messages are not published.",
        "3.9 lc_talker: on_cleanup() is called.",
        "2 True 1 unconfigured",
        "5.2 lc_talker: on_shutdown() is called.",
        "5 True 4 finalized",
    ]


@pytest.mark.parametrize(
    ("arguments", "first_tick"), [("", "10.25 250"), (" --ros-args -p use_sim_time:=true", "0.25 250")]
)
def test_sleeping_on_a_clock(terminal: Terminal, arguments: str, first_tick: str) -> None:
    """The clock on /clock runs ten times as slowly."""
    clock = ["clock_maker"] if arguments else []
    printed = terminal.run(*first(*clock, "sleeper" + arguments), seconds=8 if clock else 1)
    using = bool(clock)
    assert printed[:2] == [f"sim time: {using} {using}", f"tick {first_tick}"]
    assert "slept 0.6" in printed and terminal.exit_codes()[-1] == 0
