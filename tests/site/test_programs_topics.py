"""Publishers, subscribers, services, clients, timers, guard conditions: as the tutorials write them, run with `ros2 run`."""

from __future__ import annotations

import pytest
from program_terminal import Terminal, having


def first(*programs: str) -> list[str]:
    return [f"first_steps {each}" for each in programs]


@pytest.mark.parametrize("talker", ["talk_old_school", "talk_local_function", "talk_member_function"])
def test_every_way_to_write_a_publisher(terminal: Terminal, talker: str) -> None:
    begin = 0 if talker == "talk_old_school" else 1
    printed = terminal.run(*first(talker), seconds=1.2)
    times = [f"{number / 2:.1f}" for number in range(begin, 3)]
    assert printed == [f'{time} {talker}: Publishing: "Hello: {number}"' for number, time in enumerate(times)]


def test_a_program_is_started_by_its_path_too(terminal: Terminal) -> None:
    printed = terminal.say("install/first_steps/lib/first_steps/talk_member_function &", seconds=0.6)
    assert having(printed, "Hello") == ['0.5 talk_member_function: Publishing: "Hello: 0"']
    missing = terminal.say("install/first_steps/lib/first_steps/talk")
    assert "talk: No such file or directory" in missing[0] and terminal.codes == [127]


@pytest.mark.parametrize("listener", ["hear_old_school", "hear_lambda", "hear_member_function"])
def test_every_way_to_write_a_subscriber(terminal: Terminal, listener: str) -> None:
    printed = terminal.run(*first(listener, "talk_member_function"), seconds=1.2)
    assert having(printed, "heard") == [
        f'0.5 {listener}: I heard: "Hello: 0"',
        f'1.0 {listener}: I heard: "Hello: 1"',
    ]


def test_how_programs_take_ctrl_c(terminal: Terminal) -> None:
    terminal.run(*first("talk_member_function", "hear_member_function", "hear_lambda"), seconds=0.1)
    printed = terminal.interrupt()
    assert printed[:2] == ["interrupted", "bye"]
    assert [line for line in printed if "lib" not in line] == [
        "interrupted",
        "bye",
        "Traceback (most recent call last):",
        "    rclpy.spin(node)",
        "KeyboardInterrupt",
        "[ros2run]: Interrupt",
    ]
    assert terminal.exit_codes() == [0, 0, -2]


def test_messages_as_bytes(terminal: Terminal) -> None:
    printed = terminal.run(*first("hear_bytes", "talk_member_function"), seconds=0.6)
    assert having(printed, "hear_bytes") == [
        "0.5 hear_bytes: 17 bytes, bytes: 0001000009000000 Hello: 0",
        "0.5 hear_bytes: again Hello: 0",
    ]


def test_a_publisher_of_any_type(terminal: Terminal) -> None:
    printed = terminal.run("""first_steps talk_any_type geometry_msgs/Vector3 '{"x": 3}'""", seconds=1.1)
    assert printed == ["publisher: beginning loop", *["publishing geometry_msgs.msg.Vector3(x=3.0, y=0.0, z=0.0)"] * 2]
    assert terminal.interrupt() == ["publisher stopped cleanly"]
    assert terminal.exit_codes() == [0]


def test_a_client_that_waits_for_its_service(terminal: Terminal) -> None:
    assert terminal.run(*first("add_client 2 3"), seconds=1.5) == [
        "1.0 add_client: service not available, waiting again..."
    ]
    assert terminal.run(*first("add_server"), seconds=1) == [
        "1.5 add_server: Incoming request",
        "a: 2 b: 3",
        "1.5 add_client: Result of add_two_ints: for 2 + 3 = 5",
    ]


def test_a_client_that_calls_while_a_thread_spins(terminal: Terminal) -> None:
    printed = terminal.run(*first("add_server", "add_client_in_thread 4 5"), seconds=1)
    assert "0.0 add_client_in_thread: sum: 9" in printed
    assert "joined" in printed and terminal.exit_codes() == [None, 0]


def test_clients_that_do_something_else_while_a_slow_server_thinks(terminal: Terminal) -> None:
    printed = terminal.run(*first("add_server_slow", "add_client_polling", "add_client_in_callback"), seconds=3)
    assert printed == [
        "0.4 add_client_polling: still here",
        "0.8 add_client_polling: still here",
        "1.0 add_client_polling: 41 + 1 = 42",
        "2.0 add_client_in_callback: Result: for 41 + 1 = 42",  # it had to wait for its turn
    ]


def test_a_guard_condition(terminal: Terminal) -> None:
    assert terminal.run(*first("ring_bell"), seconds=2) == [
        "before: False",
        "0.5 ring_bell: the bell was rung",
        "after: True",
    ]


def test_timers_are_cancelled_reset_and_changed(terminal: Terminal) -> None:
    """A new period counts from the tick after the one in which it is set: that tick's time stands already."""
    assert terminal.run(*first("count_down"), seconds=5) == [
        "0.3 once, canceled: True",
        "0.5 tick 1",
        "1.0 3",
        "1.0 tick 2",
        "1.5 tick 3",
        "2.0 2",
        "3.0 1",
        "3.0 restart",
        "3.3 once, canceled: True",
        "3.5 tick 4",
        "4.0 0",
        "4.0 Quitting: Done",
    ]


def test_waiting_for_one_message(terminal: Terminal) -> None:
    printed = terminal.run(*first("wait_once", "talk_member_function"), seconds=2)
    assert [line for line in printed if "Publishing" not in line] == [
        "silence False None",
        "topic True std_msgs.msg.String(data='Hello: 1')",
        "seconds 11.0",
    ]


def test_pictures_that_belong_together(terminal: Terminal) -> None:
    assert terminal.run(*first("stereo"), seconds=1.7) == [
        "0.5 stereo: exactly 0 0",
        "0.5 stereo: about 0 0 0 of []",
        "1.0 stereo: about 1 1 1 of ['0']",
        "1.5 stereo: exactly 2 2",
        "1.5 stereo: about 2 2 2 of ['0', '1']",
    ]


def test_a_single_file_is_run_by_python(terminal: Terminal) -> None:
    """Its modules are those beside it, and its arguments its own."""
    files = terminal.folder / "src/first_steps/first_steps"
    assert terminal.say(f"python3 {files / 'ring_bell.py'}", seconds=2)[-1] == "after: True"
    assert terminal.say(f"cd {files}", "python3 talk_any_type.py geometry_msgs/Vector3") == [
        "publisher: beginning loop",
        "publishing geometry_msgs.msg.Vector3(x=0.0, y=0.0, z=0.0)",
    ]
    assert terminal.interrupt() == ["publisher stopped cleanly"]
