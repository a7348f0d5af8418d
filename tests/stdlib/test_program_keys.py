"""Programs that read keys: a terminal in raw mode, `select` with a time limit, key libraries; in robot time."""

from __future__ import annotations

import textwrap
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from turtle_lesson import Lesson, start
from turtle_lesson.ros.sim.process import Process
from turtle_lesson.ros.stdlib import terminals

Begin = Callable[..., Process]

TELEOP = """
    import select
    import sys
    import termios
    import tty

    import rclpy
    from geometry_msgs.msg import Twist

    SPEEDS = {"w": (1.0, 0.0), "a": (0.0, 1.0), "s": (0.0, 0.0)}
    before = termios.tcgetattr(sys.stdin)


    def get_key():
        tty.setraw(sys.stdin.fileno())
        ready, _, _ = select.select([sys.stdin], [], [], 0.1)
        key = sys.stdin.read(1) if ready else ""
        termios.tcsetattr(sys.stdin, termios.TCSADRAIN, before)
        return key


    rclpy.init()
    node = rclpy.create_node("drive_by_keys")
    publisher = node.create_publisher(Twist, "/turtle1/cmd_vel", 10)
    forward = turn = 0.0
    while True:
        key = get_key()
        if key == "\\x03":
            break
        if key:
            forward, turn = SPEEDS.get(key, (forward, turn))
            print(repr(key), forward, turn)
        twist = Twist()
        twist.linear.x, twist.angular.z = forward, turn
        publisher.publish(twist)
    print("bye")
"""


@pytest.fixture
def lesson(capsys: Any) -> Lesson:
    lesson = start(simulator=False)
    capsys.readouterr()
    return lesson


@pytest.fixture
def begin(lesson: Lesson, tmp_path: Path) -> Begin:
    """Starts a program and lets it begin."""

    def begin(text: str, name: str = "keys", **details: Any) -> Process:
        path = tmp_path / f"{name}.py"
        path.write_text(textwrap.dedent(text))
        process = lesson._world.spawn(path, name=name, **details)
        lesson._world.sim.settle()
        return process

    return begin


def test_a_teleop_drives_the_turtle_by_keys(capsys: Any, tmp_path: Path) -> None:
    lesson = start()
    path = tmp_path / "teleop.py"
    path.write_text(textwrap.dedent(TELEOP))
    process = lesson._world.spawn(path, name="teleop")
    lesson.run(1)
    lesson.press("w", every=2)
    lesson.press("s", "a", "x", "ctrl+c")
    out, error = capsys.readouterr()
    assert out.splitlines()[-5:] == ["'w' 1.0 0.0", "'s' 0.0 0.0", "'a' 0.0 1.0", "'x' 0.0 1.0", "bye"]
    assert error.startswith("teleop waits for keys. Press them in lesson.teleop()") and error.count("waits") == 1
    assert process.exit_code == 0
    place = lesson._recording.place()
    assert place is not None
    assert place[:2] == pytest.approx((7.5, 5.5), abs=0.2) and place[2] > 0.5


def test_a_program_that_waits_for_a_key_holds_up_nobody_else(lesson: Lesson, begin: Begin, capsys: Any) -> None:
    begin(
        """
        import sys, threading, time, tty
        def look():
            while True:
                print("key", repr(sys.stdin.read(1)), time.monotonic() // 0.1 / 10)
        tty.setcbreak(sys.stdin)
        threading.Thread(target=look, daemon=True).start()
        for _ in range(3):
            time.sleep(1)
            print("tick")
        """
    )
    lesson.run(1.25)
    lesson.press("k", "up", every=0.25)
    lesson.run(2)
    assert capsys.readouterr().out.splitlines() == [
        "tick", "key 'k' 1.2", "key '\\x1b' 1.5", "key '[' 1.5", "key 'A' 1.5", "tick", "tick",
    ]  # fmt: skip


def test_ctrl_c_interrupts_a_terminal_that_has_not_given_that_up(lesson: Lesson, begin: Begin, capsys: Any) -> None:
    process = begin(
        """
        import sys, termios
        settings = termios.tcgetattr(0)
        settings[3] &= ~(termios.ICANON | termios.ECHO)
        termios.tcsetattr(0, termios.TCSANOW, settings)
        try:
            while True:
                print(repr(sys.stdin.read(1)))
        except KeyboardInterrupt:
            print("interrupted")
        """
    )
    lesson.press("q", "enter", "ctrl+c", every=0.1)
    assert capsys.readouterr().out.splitlines() == ["'q'", "'\\n'", "interrupted"]
    assert process.exit_code == 0


def test_ctrl_c_also_interrupts_a_program_that_reads_no_key_now(lesson: Lesson, begin: Begin) -> None:
    process = begin("import sys, time, tty\ntty.setcbreak(sys.stdin)\ntime.sleep(10)")
    lesson.press("ctrl+c")
    assert process.exit_code == -2


@pytest.mark.parametrize(
    "look",
    [
        "fcntl.fcntl(0, fcntl.F_SETFL, fcntl.fcntl(0, fcntl.F_GETFL) | os.O_NONBLOCK)",
        "set_no_least()",
    ],
)
def test_looking_for_keys_without_waiting(lesson: Lesson, begin: Begin, capsys: Any, look: str) -> None:
    begin(
        f"""
        import fcntl, os, sys, termios, time, tty
        def set_no_least():
            settings = termios.tcgetattr(sys.stdin)
            settings[6][termios.VMIN] = 0
            termios.tcsetattr(sys.stdin, termios.TCSADRAIN, settings)
        tty.setraw(sys.stdin)
        {look}
        while True:
            key = sys.stdin.read(1)
            if key:
                print(key, time.monotonic() // 0.1 / 10)
        """
    )
    lesson.press("a", "b", every=0.3)
    assert capsys.readouterr().out.splitlines() == ["a 0.0", "b 0.3"]


def test_a_file_descriptor_gives_keys_too(lesson: Lesson, begin: Begin, capsys: Any) -> None:
    begin("import os, sys, tty\ntty.setraw(sys.stdin)\nprint(os.read(sys.stdin.fileno(), 3), os.read(0, 3))")
    lesson.press("left", "space")
    assert capsys.readouterr().out.splitlines() == ["b'\\x1b[D' b' '"]


def test_select_waits_for_a_whole_line_where_no_mode_was_changed(lesson: Lesson, begin: Begin, capsys: Any) -> None:
    begin(
        """
        import select, sys, time
        while not select.select([sys.stdin], [], [], 0.5)[0]:
            print("on", time.monotonic() // 0.1 / 10)
        print("stop", repr(sys.stdin.readline()))
        """
    )
    lesson.run(0.75)
    lesson.press("x", "enter", every=0.1)
    lesson.run(1)
    assert capsys.readouterr().out.splitlines() == ["on 0.5", "stop 'x\\n'"]


def test_of_two_programs_the_newer_one_gets_the_keys(lesson: Lesson, begin: Begin, capsys: Any) -> None:
    reader = "import sys, tty\ntty.setcbreak(sys.stdin)\nwhile True: print(sys.argv[0], sys.stdin.read(1))"
    begin(reader, "one", argv=["one"])
    newer = begin(reader, "two", argv=["two"])
    lesson.press("a")
    newer.kill()
    lesson.press("b")
    assert capsys.readouterr().out.splitlines() == ["two a", "one b"]


def test_a_program_on_windows(lesson: Lesson, begin: Begin, capsys: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    from turtle_lesson.ros.stdlib.program import on_import

    windows = terminals.make_msvcrt()
    monkeypatch.setitem(on_import, "msvcrt", lambda: windows)
    begin(
        """
        import msvcrt, time
        while not msvcrt.kbhit():
            pass
        print(msvcrt.getch().decode(), repr(msvcrt.getwch()))
        """
    )
    lesson.press("a", "enter")
    assert capsys.readouterr().out.splitlines() == ["a '\\r'"]


def test_keys_that_nobody_reads_and_names_that_are_none(lesson: Lesson) -> None:
    with pytest.raises(RuntimeError, match="no running program reads keys, so 'w' was not pressed"):
        lesson.press("w")
    with pytest.raises(ValueError, match=r"got 'wwd': several keys are several arguments"):
        lesson.press("wwd")


def test_a_pipe_is_no_terminal(lesson: Lesson, begin: Begin, capsys: Any) -> None:
    import io

    begin("import sys, termios\nprint(sys.stdin.isatty())\ntermios.tcgetattr(sys.stdin)", stdin=io.StringIO("a"))
    out, error = capsys.readouterr()
    assert out == "False\n"
    assert "termios.error: (25, 'Inappropriate ioctl for device')" in error


# -- key libraries -------------------------------------------------------------------------------------------------------


def test_a_listener_of_pynput_hears_keys_go_down_and_up(lesson: Lesson, begin: Begin, capsys: Any) -> None:
    process = begin(
        """
        import time
        from pynput import keyboard
        from pynput.keyboard import Key, KeyCode

        def on_press(key):
            try:
                print("down", key.char, time.monotonic() // 0.1 / 10)
            except AttributeError:
                print("down", key, key == Key.up)

        def on_release(key):
            print("up", key, key == KeyCode.from_char("w"))
            if key == Key.esc:
                return False

        with keyboard.Listener(on_press=on_press, on_release=on_release) as listener:
            listener.join()
        print("the end", listener.running)
        """
    )
    lesson.press("w", "up", "esc", every=0.3)
    assert capsys.readouterr().out.splitlines() == [
        "down w 0.0", "up 'w' True", "down Key.up True", "up Key.up False", "down Key.esc False", "up Key.esc False",
        "the end False",
    ]  # fmt: skip
    assert process.exit_code == 0


def test_a_listener_beside_a_node_that_spins(lesson: Lesson, begin: Begin, capsys: Any) -> None:
    begin(
        """
        import pynput.keyboard as keyboard
        import rclpy

        rclpy.init()
        node = rclpy.create_node("teleop")
        node.speed = 0.0
        def on_press(key):
            node.speed += {keyboard.Key.up: 0.5, keyboard.Key.down: -0.5}.get(key, 0.0)
        listener = keyboard.Listener(on_press=on_press)
        listener.start()
        node.create_timer(1.0, lambda: print(node.speed))
        rclpy.spin(node)
        """
    )
    lesson.press("up", "up", "down", "ctrl+c", every=0.8)
    assert capsys.readouterr().out.splitlines() == ["1.0", "0.5", "0.5"]


def test_all_listeners_hear_and_what_pynput_lacks_is_said(lesson: Lesson, begin: Begin, capsys: Any) -> None:
    listener = """
        import sys
        from pynput.keyboard import Listener
        with Listener(on_press=lambda key: print(sys.argv[0], key)) as listener:
            listener.join()
    """
    for name in ("one", "two"):
        begin(listener, name, argv=[name])
    lesson.press("a")
    assert capsys.readouterr().out.splitlines() == ["one 'a'", "two 'a'"]
    begin("from pynput import mouse", "three")
    assert "mouse is not available here: of pynput a program has keyboard.Listener" in capsys.readouterr().err


def test_curses_reads_keys_and_prints_the_lines_that_change(lesson: Lesson, begin: Begin, capsys: Any) -> None:
    process = begin(
        """
        import curses, time

        def main(screen):
            curses.curs_set(0)
            screen.nodelay(True)
            speed = 0
            while True:
                key = screen.getch()
                if key == curses.KEY_UP:
                    speed += 1
                elif key == ord("q"):
                    break
                elif key == -1:
                    time.sleep(0.05)
                screen.clear()
                screen.addstr(0, 0, "arrows drive, q ends\\nspeed ")
                screen.addstr(f"{speed}", 0)
                screen.refresh()
            return speed

        print("speed was", curses.wrapper(main))
        """
    )
    lesson.run(0.2)
    lesson.press("up", "up", "x", "q")
    assert capsys.readouterr().out.splitlines() == [
        "arrows drive, q ends", "speed 0", "speed 1", "speed 2", "speed was 2",
    ]  # fmt: skip
    assert process.exit_code == 0


def test_curses_waits_for_keys_in_robot_time(lesson: Lesson, begin: Begin, capsys: Any) -> None:
    begin(
        """
        import curses, time
        screen = curses.initscr()
        curses.noecho(); curses.cbreak(); screen.keypad(True); screen.timeout(500)
        print(screen.getch(), time.monotonic() // 0.1 / 10)
        screen.timeout(-1)
        print(screen.getch() == curses.KEY_LEFT, screen.getch())
        screen.nodelay(1)
        print(screen.getch())
        curses.nocbreak(); curses.echo(); curses.endwin()
        time.sleep(1)
        print(input("name? "))
        """
    )
    lesson.run(1)
    lesson.press("left", "enter", every=0.1)
    lesson.run(1, input=["Ada"])
    assert capsys.readouterr().out.splitlines() == ["-1 0.5", "True 10", "-1", "name? Ada", "Ada"]


@pytest.mark.parametrize(
    "use, said",
    [
        ("curses.start_color()", "AttributeError: curses.start_color is not available here: of curses a program has"),
        (
            "curses.initscr().getkey()",
            "AttributeError: curses.window.getkey is not available here: of curses a program",
        ),
        ("curses.initscr().addstr(24, 0, 'below')", "curses.error: addwstr() returned ERR"),
        ("curses.initscr().addstr(0, 0, 1.5)", "TypeError: expect bytes or str, got float"),
    ],
)
def test_what_curses_cannot_do_is_said(lesson: Lesson, begin: Begin, capsys: Any, use: str, said: str) -> None:
    begin(f"import curses\n{use}")
    assert said in capsys.readouterr().err


def test_curses_needs_a_terminal(lesson: Lesson, begin: Begin, capsys: Any) -> None:
    import io

    begin("import curses\ncurses.wrapper(print)", stdin=io.StringIO("a"))
    assert "curses.error: curses needs a terminal, and the input of this program is a" in capsys.readouterr().err
