"""The checks: each is met by a finished answer, by nothing less, and none fails itself, whatever the system is like."""

from __future__ import annotations

import shutil
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from turtle_lesson import Lesson, start
from turtle_lesson.lab.checks import probe, registry
from turtle_lesson.lab.checks.registry import Check, Expectation, all_checks
from turtle_lesson.lab.checks.results import POINTER, Advice, CheckResult, Row, Seen
from turtle_lesson.learner.story import FINISHED, PAGES
from turtle_lesson.ros.sim import interrupts

# isort: split
# Importing turtle_lesson made this one importable.
import rclpy
from test_simple_stage import in_our_words

NAMES = [each.name for each in all_checks()]
OF_THE_SYSTEM = [
    "interfaces",
    "navigator",
    "status_monitor",
    "parameters",
    "launch",
]
"""What the finished package meets; other checks call functions that the learner writes."""


def marks(result: CheckResult) -> str:
    return "".join(row.mark for row in result.rows)


def row(result: CheckResult, expected: str) -> Any:
    return next(each for each in result.rows if expected in each.expected)


Make = Callable[[], Any]


def program(lesson: Lesson, make: Make) -> None:
    """Start a program that makes a node and spins it, as a process of its own."""

    def main() -> None:
        rclpy.init()
        rclpy.spin(make())

    lesson._world.spawn(main, name=make.__name__)
    lesson.run(0.2)


@pytest.fixture
def system() -> Iterator[Lesson]:
    """The finished package, launched."""
    lesson = start()
    lesson.launch("robot_controller", "start_system.launch.py", source="world")
    lesson.run(1)
    yield lesson


# -- in general --------------------------------------------------------------------------------------------------------


def test_names_and_points() -> None:
    assert len(NAMES) == len(set(NAMES))
    for each in all_checks():
        assert each.page in PAGES
        assert 1 <= each.points <= 10
        assert each.title
        assert each.limit > 0


@pytest.mark.parametrize("name", NAMES)
def test_no_check_is_met_by_an_empty_world(name: str) -> None:
    result = start(package=None, simulator=False).check(name)
    assert not result.passed
    assert result.earned == 0


@pytest.mark.parametrize("name", NAMES)
def test_no_check_but_the_interfaces_is_met_by_the_simulator_alone(name: str) -> None:
    assert start().check(name).passed == (name == "interfaces")


@pytest.mark.parametrize("name", OF_THE_SYSTEM)
def test_the_finished_package_meets_them_twice(system: Lesson, name: str) -> None:
    first, again = system.check(name), system.check(name)
    assert first.passed, first
    assert again.passed, again
    assert first.earned == first.points


def test_the_simple_stage_meets_what_it_should_and_no_more(tmp_path: Path) -> None:
    met = {}
    for name in [*OF_THE_SYSTEM, "scan"]:
        lesson = start(package=in_our_words(tmp_path / name))
        lesson.launch("robot_controller", "start_system.launch.py")
        lesson.run(1)
        met[name] = lesson.check(name)
    assert [name for name, result in met.items() if result.passed] == ["interfaces"]
    assert row(met["status_monitor"], "follow the turtle").mark == "✗"
    assert row(met["status_monitor"], "battery falls").mark == "✓"
    assert row(met["scan"], "every beam").seen == "180 readings, and the angles ask for 181"
    assert row(met["navigator"], "success is True").mark == "✗"
    assert row(met["parameters"], "publish_rate").seen == "it is not declared"


def test_a_check_leaves_the_system_as_it_was(system: Lesson) -> None:
    node = system._recording.node
    system.place()
    system.run(2)  # the recorder listens to the obstacles by then
    before = (len(list(node.subscriptions)), len(list(node.clients)), len(list(node.publishers)))
    for name in ("parameters", "system", "status_monitor"):
        system.check(name)
    system.run(2)
    assert (len(list(node.subscriptions)), len(list(node.clients)), len(list(node.publishers))) == before
    assert system.obstacles == ()
    assert row(system.check("launch"), "publish_rate = 10").good
    assert row(system.check("launch"), "goal_timeout = 5.0").good


def test_the_same_world_gives_the_same_table() -> None:
    def table() -> str:
        lesson = start(seed=3)
        lesson.launch("robot_controller", "start_system.launch.py")
        return repr(lesson.check("navigator"))

    assert table() == table()


def test_only_errors_are_printed(system: Lesson, capsys: pytest.CaptureFixture[str]) -> None:
    capsys.readouterr()
    system.check("navigator")
    assert capsys.readouterr() == ("", "")


@pytest.mark.parametrize("name", ["statsu_monitor", "Navigator", "", None, 3])
def test_an_unknown_name_is_explained(system: Lesson, name: Any) -> None:
    said = {"statsu_monitor": 'Did you mean "status_monitor"', "Navigator": 'Did you mean "navigator"'}
    with pytest.raises(ValueError, match=said.get(str(name), "There are: |Did you mean")):
        system.check(name)


def test_the_text_is_a_table(system: Lesson) -> None:
    text = repr(system.check("status_monitor"))
    assert text == (
        "✓ status_monitor: 9 of 9 expectations met, 5 of 5 points. The status monitor tells ten times a\n"
        "  second what the turtle really does.\n"
        "  ✓ one node /status_monitor                       it is there\n"
        "  ✓ /status_monitor publishes /robot/status        as robot_controller/msg/TurtleStatus\n"
        "  ✓ /robot/status: a message every 100 ms ± 10 ms  every 100.0 ms (10.0 Hz)\n"
        "  ✓ x, y, theta follow the turtle                  at most 0.01 m off in x, 0.01 m in y, 0.03 rad\n"
        "                                                   (1.5°) in theta\n"
        "  ✓ vel_x follows the turtle                       right in all 37 messages of a circle\n"
        "  ✓ vel_y follows the turtle                       right in all 37 messages of a circle\n"
        "  ✓ both are 0 when the turtle stands              vel_x 0.00 m/s, vel_y 0.00 m/s\n"
        "  ✓ battery falls by 0.1 a message                 from 98.7 to 87.5\n"
        "  ✓ no error meanwhile                             none\n"
        "  Your monitor reports what the sensor says, along the axes that others expect.\n"
        f"  {system.progress().so_far('04_status_monitor')}\n"
        "11.4 s of robot time went by."
    )


def test_in_a_notebook_it_is_html_and_carries_its_figures(system: Lesson) -> None:
    system.check("launch")
    lesson = start()
    result = lesson.check("status_monitor")
    data, metadata = result._repr_mimebundle_()
    assert data["text/plain"] == repr(result)
    assert "not looked at, because" in data["text/html"]
    assert data["text/html"].count("<details>") == repr(result).count("more expectations were not looked at")
    assert 'aria-label="not looked at"' in data["text/html"]
    figures = metadata["turtle_lesson_check"]
    assert (figures["name"], figures["earned"], figures["points"]) == ("status_monitor", 0, 5)
    assert max(map(len, repr(result).splitlines())) <= 100


# -- broken systems ----------------------------------------------------------------------------------------------------


def nothing_else(lesson: Lesson) -> None:
    """Every check can look at this system."""
    for name in NAMES:
        assert not lesson.check(name).passed or name == "interfaces"


def test_a_wrong_type_and_two_of_one_name() -> None:
    def status_monitor() -> Any:
        from std_msgs.msg import String

        node = rclpy.create_node("status_monitor")
        publisher = node.create_publisher(String, "/robot/status", 10)
        node.create_timer(0.1, lambda: publisher.publish(String(data="fine")))
        return node

    lesson = start()
    program(lesson, status_monitor)
    result = lesson.check("status_monitor")
    assert (marks(result)[:2], set(marks(result)[2:-1]), marks(result)[-1]) == ("✓✗", {"–"}, "✓")
    assert row(result, "publishes").seen == "/status_monitor does, as std_msgs/msg/String"
    program(lesson, status_monitor)
    assert row(lesson.check("status_monitor"), "one node").seen == "2 nodes of this name: each message comes 2 times"
    nothing_else(lesson)


def test_a_callback_that_raises(capsys: pytest.CaptureFixture[str]) -> None:
    def status_monitor() -> Any:
        from robot_controller.msg import TurtleStatus

        node = rclpy.create_node("status_monitor")
        publisher = node.create_publisher(TurtleStatus, "/robot/status", 10)
        sent: list[int] = []

        def publish() -> None:
            publisher.publish(TurtleStatus(battery=100.0))
            sent.append(1)
            if len(sent) > 20:
                raise ValueError("no more")

        node.create_timer(0.1, publish)
        return node

    lesson = start()
    program(lesson, status_monitor)
    result = lesson.check("status_monitor")
    assert result.rows[0] == row(result, "no error"), "the error comes first"
    assert row(result, "no error").seen == "ValueError: no more"
    assert row(result, "no error").trace.endswith('in publish: raise ValueError("no more")')
    assert "ValueError: no more" in capsys.readouterr().out
    nothing_else(lesson)


def test_a_service_that_never_answers() -> None:
    def navigator() -> Any:
        from geometry_msgs.msg import Twist
        from robot_controller.srv import NavigateTo

        node = rclpy.create_node("navigator")
        node.create_publisher(Twist, "/turtle1/cmd_vel", 10)

        def never(request: Any, response: Any) -> Any:
            while True:
                time.sleep(0.5)

        node.create_service(NavigateTo, "/navigate_to", never)
        return node

    lesson = start()
    program(lesson, navigator)
    result = lesson.check("navigator")
    assert "in 90 s; never has not returned: it is in line" in row(result, "success is True").seen
    assert row(result, "ten commands a second").seen == "not looked at, because the turtle never moved"
    assert "does not answer" in row(lesson.check("launch"), "parameter goal_timeout").seen
    nothing_else(lesson)


def test_a_service_that_answers_nonsense() -> None:
    def navigator() -> Any:
        from robot_controller.srv import NavigateTo

        node = rclpy.create_node("navigator")
        node.create_service(NavigateTo, "/navigate_to", lambda request, response: None)
        return node

    lesson = start()
    program(lesson, navigator)
    nothing_else(lesson)


def test_an_interface_package_with_other_fields(tmp_path: Path) -> None:
    package = tmp_path / "robot_controller"
    shutil.copytree(FINISHED, package)
    (package / "msg" / "TurtleStatus.msg").write_text("string x\nfloat32 speed\n")
    (package / "srv" / "NavigateTo.srv").write_text("float64 x\n---\nbool ok\n")

    def status_monitor() -> Any:
        from robot_controller.msg import TurtleStatus

        node = rclpy.create_node("status_monitor")
        publisher = node.create_publisher(TurtleStatus, "/robot/status", 10)
        node.create_timer(0.1, lambda: publisher.publish(TurtleStatus(x="far", speed=1.0)))
        return node

    def navigator() -> Any:
        from robot_controller.srv import NavigateTo

        node = rclpy.create_node("navigator")
        node.create_service(NavigateTo, "/navigate_to", lambda request, response: response)
        return node

    lesson = start(package=package)
    program(lesson, status_monitor)
    program(lesson, navigator)
    result = lesson.check("status_monitor")
    assert "object has no attribute 'battery'" in row(result, "battery falls").seen
    assert row(result, "follow the turtle").mark in "✗–"
    assert "string x, float32 speed" in row(lesson.check("interfaces"), "TurtleStatus").seen
    assert "object has no attribute 'y'" in row(lesson.check("navigator"), "success is True").seen
    for name in NAMES:
        assert not lesson.check(name).passed


def test_a_package_that_is_not_built() -> None:
    lesson = start(package=None)
    result = lesson.check("interfaces")
    assert marks(result) == "✗✗✗"
    assert "No module named 'robot_controller'" in result.rows[0].seen
    assert "no file msg/TurtleStatus.msg in the package" in result.rows[0].advice.direction


def test_messages_that_are_no_numbers() -> None:
    def broken() -> Any:
        from robot_controller.msg import TurtleStatus
        from sensor_msgs.msg import LaserScan

        node = rclpy.create_node("status_monitor")
        statuses = node.create_publisher(TurtleStatus, "/robot/status", 10)
        scans = node.create_publisher(LaserScan, "/obstacles", 10)
        nan = float("nan")

        def publish() -> None:
            statuses.publish(TurtleStatus(x=nan, theta=nan, battery=nan))
            scans.publish(LaserScan(angle_increment=nan, ranges=[nan]))

        node.create_timer(0.1, publish)
        return node

    lesson = start()
    program(lesson, broken)
    nothing_else(lesson)


def test_a_timer_without_end_is_stopped(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(probe, "WORK", 0.1)
    monkeypatch.setattr(probe, "SLACK", 0.1)

    def counter() -> Any:
        from std_msgs.msg import Int32

        node = rclpy.create_node("counter")
        publisher = node.create_publisher(Int32, "/count", 10)
        node.create_timer(0.000005, lambda: publisher.publish(Int32()))
        return node

    lesson = start()
    program(lesson, counter)
    result = lesson.check("counter")
    assert result.rows[0].mark == "■"
    assert "is a timer's period tiny" in result.rows[0].seen
    assert repr(result).startswith("■ counter: stopped; ")


def test_a_callback_that_computes_for_ever_is_stopped_and_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(interrupts, "patience", 0.3)

    def counter() -> Any:
        node = rclpy.create_node("counter")

        def on_timer() -> None:
            while True:
                pass

        node.create_timer(0.5, on_timer)
        return node

    lesson = start()
    program(lesson, counter)
    result = lesson.check("counter")
    assert marks(result).startswith("■")
    assert "on_timer has not returned: stopped in line" in result.rows[0].seen
    lesson = start()
    rclpy.init()
    kept = counter()
    result = lesson.check("counter")
    assert "on_timer has not returned: stopped in line" in result.rows[0].seen
    assert {each.seen for each in result.rows if each.mark == "–"} >= {"not looked at, because your code was stopped"}
    kept.destroy_node()


def test_a_callback_in_a_cell_that_sleeps_again_and_again_is_stopped_too() -> None:
    lesson = start()
    rclpy.init()
    node = rclpy.create_node("counter")

    def on_timer() -> None:
        while True:
            time.sleep(0.5)

    node.create_timer(0.5, on_timer)
    result = lesson.check("counter")
    assert "on_timer has not returned: stopped in line" in result.rows[0].seen
    assert "(`time.sleep(0.5)`)" in result.rows[0].seen
    assert marks(result).count("■") == 1


@pytest.mark.parametrize("in_a_cell", [True, False])
def test_a_loop_that_only_looks_at_the_clock_is_stopped_and_named(
    monkeypatch: pytest.MonkeyPatch, in_a_cell: bool
) -> None:
    """Time passes in it, a microsecond a look."""
    monkeypatch.setattr(probe, "WORK", 0.3)

    def counter() -> Any:
        from std_msgs.msg import Int32

        node = rclpy.create_node("counter")
        node.create_publisher(Int32, "/count", 10)

        def on_timer() -> None:
            end = time.time() + 3600
            while time.time() < end:
                pass

        node.create_timer(0.5, on_timer)
        return node

    lesson = start()
    if in_a_cell:
        rclpy.init()
        kept = counter()
        result = lesson.check("counter")
        kept.destroy_node()
    else:
        program(lesson, counter)
        result = lesson.check("counter")
    assert "on_timer has not returned: stopped in line" in result.rows[0].seen
    lesson.run(1)  # and nothing is limited any more


def test_a_callback_that_waits_for_ever_is_named_with_its_line() -> None:
    def adder() -> Any:
        from example_interfaces.srv import AddTwoInts

        node = rclpy.create_node("adder")

        def on_request(request: Any, response: Any) -> Any:
            while True:
                time.sleep(0.5)

        node.create_service(AddTwoInts, "/add_two_ints", on_request)
        return node

    lesson = start()
    program(lesson, adder)
    result = lesson.check("adder")
    assert "on_request has not returned: it is in line" in row(result, "2 + 3").seen
    assert "(`time.sleep(0.5)`)" in row(result, "2 + 3").seen


def test_advice_comes_in_three_steps_and_begins_anew_when_the_check_is_passed(monkeypatch: pytest.MonkeyPatch) -> None:
    advice: list[str | Advice] = [Advice("the symptom", "the direction", "the hint")]
    good: list[bool] = []

    def make() -> list[Expectation]:
        return [Expectation("it is well", lambda probe: Seen(bool(good), "what was seen", advice[0]))]

    mine = Check("mine", "A check of this test's own.", PAGES[0], 1, 5.0, make, "What was learnt.")
    monkeypatch.setitem(registry._checks, "mine", mine)
    lesson = start()

    def said() -> list[bool]:
        text = repr(lesson.check("mine"))
        return [each in text for each in ("the symptom", "the direction", "the hint", POINTER, "What was learnt.")]

    assert said() == [True, False, False, False, False]
    assert said() == [False, True, False, False, False]
    assert said() == [False, True, True, False, False]
    advice[0] = "the direction"
    assert said() == [False, True, False, True, False]
    good.append(True)
    assert said() == [False, False, False, False, True]
    good.clear()
    assert said() == [False, False, False, False, False], "the count begins anew; a plain text is no symptom"


def test_rows_that_were_not_looked_at_for_one_reason_are_folded() -> None:
    def row_of(name: str, reason: str) -> Row:
        return Row("–", name, f"not looked at, because {reason}")

    rows = (Row("✓", "a", "b"), row_of("c", "x"), row_of("d", "y"), row_of("e", "x"), row_of("f", "x"))
    result = CheckResult("mine", "Title.", PAGES[0], 1, rows, 0.0)
    assert "– 3 more expectations were not looked at, because x" in repr(result)
    assert "– d  not looked at, because y" in repr(result)
    assert result._repr_html_().count("<details>") == 1
    assert all(f"<li>{name}</li>" in result._repr_html_() for name in "cef")
    assert len(result.figures()["rows"]) == 5, "whoever collects points gets them all"


def test_a_world_that_has_ended() -> None:
    old = start()
    start()
    result = old.check("counter")
    assert result.rows[0].seen == "it was closed by a later start()"
    assert set(marks(result)[1:]) == {"–"}


def test_a_node_in_a_cell_lives_while_a_check_looks() -> None:
    from std_msgs.msg import Int32

    lesson = start()
    rclpy.init()
    node = rclpy.create_node("counter")
    publisher = node.create_publisher(Int32, "/count", 10)
    numbers: Any = iter(range(1, 1000))
    node.create_timer(0.5, lambda: publisher.publish(Int32(data=next(numbers))))
    assert lesson.check("counter").passed
    lesson.run(2.7)  # in which nobody spins the node: its timer is late once, and that is not its fault
    assert lesson.check("counter").passed
    numbers = iter("abc")
    result = lesson.check("counter")
    assert row(result, "no error").mark == "✗"
    assert "must be of type 'int'" in row(result, "no error").seen


def test_a_callback_in_a_cell_that_waits_for_ever_is_named() -> None:
    from std_srvs.srv import Trigger

    lesson = start()
    rclpy.init()
    node = rclpy.create_node("counter")
    client = node.create_client(Trigger, "/nobody")
    node.create_timer(0.5, lambda: client.call(Trigger.Request()))
    result = lesson.check("counter")
    assert "NeverWakes: this call of /nobody can never be answered" in row(result, "no error").seen
