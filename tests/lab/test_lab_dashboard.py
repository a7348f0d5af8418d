"""The dashboard in a running world: what its panels say of status, scan, topics, nodes, services and log."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import nbformat
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from turtle_lesson import Lesson, start
from turtle_lesson.lab.status_and_scan import read_beams
from turtle_lesson.lab.widgets import dashboard as module
from turtle_lesson.lab.widgets.dashboard import Dashboard, frequency, in_words, verdict
from turtle_lesson.lab.widgets.live_widget import LiveWidget
from turtle_lesson.ros.cli.shell import run_line

# isort: split
# Importing turtle_lesson made this one importable.
import rclpy
from lab_fakes import scan

SECOND = 1_000_000_000
STATUS_COLUMNS = 6
PAGE = Path(__file__).resolve().parents[2] / "notebooks" / "lab.ipynb"


@pytest.fixture(autouse=True)
def always_due(monkeypatch: pytest.MonkeyPatch) -> None:
    """Every tick brings everything up to date, however fast the test is."""
    monkeypatch.setattr(LiveWidget, "due", lambda *_: True)


@pytest.fixture
def lesson() -> Iterator[Lesson]:
    """A world with the whole system, in which time stands still."""
    lesson = start(seed=0)
    yield lesson
    lesson._world.close()


@pytest.fixture
def dashboard(lesson: Lesson) -> Dashboard:
    """The dashboard of that system five seconds after its launch, which took 0.9 s; not shown anywhere yet."""
    lesson.launch("robot_controller", "start_system.launch.py", source="world")
    lesson.run(5)
    return lesson.dashboard()


def order(dashboard: Dashboard, name: str, **content: Any) -> None:
    """What a browser's window sends."""
    dashboard._order(dashboard, {"do": name, "view": "window", **content}, [])


def look(dashboard: Dashboard) -> None:
    """A window says that it is still there, which brings everything up to date."""
    order(dashboard, "alive")


def status_rows(dashboard: Dashboard) -> np.ndarray:
    """Of each status that is shown its age (s) and its numbers, as the browser computes them."""
    rows = np.frombuffer(dashboard.status + dashboard.status_tip, "<f4").reshape(-1, STATUS_COLUMNS).copy()
    rows[:, 0] = dashboard.now - dashboard.status_from - rows[:, 0]
    return rows[rows[:, 0] <= 30]


def states(rows: list[dict[str, Any]], name: str) -> dict[str, str]:
    return {row[name]: row["state"] for row in rows}


def log_texts(dashboard: Dashboard) -> list[str]:
    return [line[4] for line in [*dashboard.log_old, *dashboard.log_new]]


def heard_by_the_lab(lesson: Lesson) -> set[str]:
    """The topics that the lab's own node subscribes to."""
    node = lesson._recording.node
    return {name for name, _ in node.get_subscriber_names_and_types_by_node("_lab", "/")}


# -- as a whole --------------------------------------------------------------------------------------------------------


def test_its_text_is_exact(dashboard: Dashboard) -> None:
    assert repr(dashboard) == (
        "Dashboard at 5.90 s of robot time: the turtle is at (5.54, 5.54) m facing 0.00 rad (0.0°), battery 94.9 %; "
        "nearest in the scan: 5.54 m, straight ahead; all expected nodes and services are there; no goal sent."
    )


def test_its_text_says_what_is_not_there() -> None:
    lesson = start(simulator=False)
    assert repr(lesson.dashboard()) == (
        "Dashboard at 0.00 s of robot time: no pose heard yet; no scan heard yet; missing: /turtlesim, /navigator, "
        "/status_monitor, /obstacle_detector and /navigate_to; no goal sent."
    )
    assert "no node publishes /robot/status" in lesson.dashboard().status_note.lower()
    assert "no node publishes /obstacles" in lesson.dashboard().scan_words["note"].lower()


def test_its_picture_shows_path_and_status_side_by_side(dashboard: Dashboard) -> None:
    data, metadata = dashboard._repr_mimebundle_()
    assert data["image/png"][:8] == b"\x89PNG\r\n\x1a\n" or isinstance(data["image/png"], str)
    assert metadata["image/png"]["alt"] == data["text/plain"] == dashboard.text()
    assert metadata["image/png"]["width"] > 1000


def test_its_picture_shows_the_flag_of_a_goal_that_was_reached(dashboard: Dashboard) -> None:
    before = dashboard.picture()
    goal = dashboard.desk.send(8.0, 5.544, 0.0)
    goal.state = "reached"
    after = dashboard.picture()
    assert before is not None and after is not None
    red = [((each.pixels()[..., :3] == [213, 94, 0]).all(axis=2)).sum() for each in (before, after)]
    assert red[1] > red[0] + 100


def test_showing_it_leaves_robot_time_alone(lesson: Lesson, dashboard: Dashboard) -> None:
    before = lesson.now
    order(dashboard, "open")
    order(dashboard, "alive")
    order(dashboard, "close")
    assert lesson.now == before


def test_it_is_the_same_one_wherever_it_is_shown(lesson: Lesson, dashboard: Dashboard) -> None:
    assert lesson.dashboard() is dashboard
    assert lesson.dashboard() is not lesson.goal_pad()


def test_no_two_of_its_scripts_use_the_same_name(dashboard: Dashboard) -> None:
    names = Counter(re.findall(r"^(?:async )?(?:function|const|let|class) (\w+)", dashboard._esm, re.MULTILINE))
    assert [name for name, uses in names.items() if uses > 1] == []


# -- status ------------------------------------------------------------------------------------------------------------


def test_the_status_is_a_row_for_each_message_with_its_age(dashboard: Dashboard) -> None:
    rows = status_rows(dashboard)
    assert len(rows) == 52  # the monitor is up at 0.6 s
    assert rows[:, 0] == pytest.approx(np.arange(5.2, 0.05, -0.1), abs=1e-3)
    x, y, theta, speed, battery = rows[-1, 1:]
    assert [x, y, theta, speed, battery] == pytest.approx([5.544, 5.544, 0.0, 0.0, 94.9], abs=1e-3)


def test_only_the_last_thirty_seconds_are_sent(lesson: Lesson, dashboard: Dashboard) -> None:
    lesson.run(40)
    look(dashboard)
    ages = status_rows(dashboard)[:, 0]
    assert 29.8 < ages[0] <= 30.0
    assert len(ages) == 300


def test_a_hundred_statuses_a_second_are_thinned_and_do_not_flicker(lesson: Lesson) -> None:
    lesson.launch("robot_controller", "start_system.launch.py", publish_rate=100)
    lesson.run(40)
    dashboard = lesson.dashboard()
    first = status_rows(dashboard)[:, 0]
    assert 295 <= len(first) <= 302
    lesson.run(1.0)
    look(dashboard)
    kept = first[first < 28] + 1.0
    later = status_rows(dashboard)[:, 0]
    assert np.abs(kept[:, None] - later[None, :]).min(axis=1).max() < 0.011


def test_a_monitor_that_ends_is_told(lesson: Lesson, dashboard: Dashboard) -> None:
    assert dashboard.status_note == ""
    for handle in lesson._launched.values():
        handle.stop()
    lesson.run(7)
    look(dashboard)
    assert dashboard.status_note == "No status for 7 s."
    assert dashboard.scan_words["note"] == "No scan for 7 s."


def test_a_dashboard_that_is_opened_long_after_the_last_status_says_so(lesson: Lesson) -> None:
    launched = lesson.launch("robot_controller", "start_system.launch.py")
    lesson.run(5)
    launched.stop()
    lesson.run(40)
    dashboard = lesson.dashboard()
    dashboard.tick()
    assert dashboard.status_note == "No status for 40 s."
    assert (dashboard.status, dashboard.status_tip) == (b"", b"")


# -- scan --------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("degrees", "beam", "place"),
    [
        ((-90, 90), 120, "30° to the left"),
        ((-90, 90), 0, "90° to the right"),
        ((-90, 90), 90, "straight ahead"),
        ((-90.3, 90), 90, "straight ahead"),
        ((-180, 0), 0, "straight behind"),
        ((0, 180), 180, "straight behind"),
    ],
)
def test_the_nearest_thing_is_told(degrees: tuple[float, float], beam: int, place: str) -> None:
    ranges = [10.0] * 181
    ranges[beam] = 2.5
    words = in_words(read_beams(scan(ranges, degrees=degrees)))
    assert words == {"beam": beam, "nearest": f"2.50 m, {place}", "count": "1 of 181 beams see something"}


def test_nothing_within_reach_is_told() -> None:
    words = in_words(read_beams(scan([10.0] * 181)))
    assert (words["beam"], words["nearest"]) == (-1, "nothing within 10.0 m")


# -- rates -------------------------------------------------------------------------------------------------------------


def regular(hertz: float, seconds: float = 5.0) -> np.ndarray:
    return np.arange(0, seconds * SECOND, SECOND / hertz).astype(np.int64)


@given(st.floats(0.5, 200.0))
def test_a_regular_topic_is_measured_right(hertz: float) -> None:
    stamps = regular(hertz, 20.0)
    assert frequency(stamps, int(stamps[-1]) + 1000) == pytest.approx(hertz, rel=1e-3)


def test_a_topic_is_measured_since_its_last_pause() -> None:
    stamps = np.concatenate([regular(10, 1.0), regular(10, 1.0) + 3 * SECOND])
    assert frequency(stamps, 4 * SECOND, pause=1.0) == pytest.approx(10.0)


def test_a_topic_pauses_and_then_is_silent() -> None:
    stamps = regular(10, 1.0)
    end = int(stamps[-1])
    assert frequency(stamps, end + SECOND // 10, pause=1.0) == pytest.approx(10.0)
    assert frequency(stamps, end + 2 * SECOND, pause=1.0) == 0.0


def test_one_message_is_no_rate_yet() -> None:
    assert verdict(frequency(np.array([SECOND]), SECOND + 1), 10.0) == "just begun"
    assert verdict(frequency(np.array([], np.int64), SECOND), 10.0) == "silent"


def test_verdicts() -> None:
    told = [verdict(hertz, 10.0) for hertz in (10.0, 8.6, 11.4, 8.0, 20.0, 0.0)]
    assert told == ["as expected"] * 3 + ["too slow", "too fast", "silent"]


def test_the_expected_topics_come_first_with_their_rates(lesson: Lesson, dashboard: Dashboard) -> None:
    order(dashboard, "open")
    lesson.run(1)
    look(dashboard)
    assert [(row["topic"], row["hertz"], row["state"]) for row in dashboard.rates] == [
        ("/turtle1/pose", 62.5, "as expected"),
        ("/robot/status", 10.0, "as expected"),
        ("/obstacles", 5.0, "as expected"),
        ("/turtle1/cmd_vel", 0.0, "at rest"),
        ("/turtle1/color_sensor", 62.5, "heard"),
    ]


def test_commands_are_expected_while_the_turtle_drives(lesson: Lesson, dashboard: Dashboard) -> None:
    order(dashboard, "goal", x=9.0, y=9.0, theta=0.0)
    lesson.run(1.5)
    look(dashboard)
    assert states(dashboard.rates, "topic")["/turtle1/cmd_vel"] == "as expected"
    lesson.run(10)
    look(dashboard)
    assert states(dashboard.rates, "topic")["/turtle1/cmd_vel"] == "at rest"


def test_two_monitors_are_too_fast_and_a_name_twice(lesson: Lesson, dashboard: Dashboard) -> None:
    lesson.launch("robot_controller", "start_system.launch.py", publish_rate=10)
    lesson.run(6)
    look(dashboard)
    assert states(dashboard.rates, "topic")["/robot/status"] == "too fast"
    assert states(dashboard.lights, "name")["/status_monitor"] == "several"
    assert "2 nodes of this name" in {light["words"] for light in dashboard.lights}


def test_a_slow_monitor_is_told(lesson: Lesson) -> None:
    lesson.launch("robot_controller", "start_system.launch.py", publish_rate=5)
    lesson.run(6)
    dashboard = lesson.dashboard()
    assert states(dashboard.rates, "topic")["/robot/status"] == "too slow"


def test_a_topic_that_the_recorder_hears_is_heard_only_once(lesson: Lesson, dashboard: Dashboard) -> None:
    before = heard_by_the_lab(lesson)
    order(dashboard, "open")
    look(dashboard)
    assert heard_by_the_lab(lesson) - before == {"/turtle1/color_sensor", "/rosout"}
    node = lesson._recording.node
    assert [end.node_name for end in node.get_subscriptions_info_by_topic("/robot/status")] == ["_lab"]
    order(dashboard, "close")
    assert heard_by_the_lab(lesson) == before


def test_topics_come_and_go_with_their_publishers(lesson: Lesson, dashboard: Dashboard) -> None:
    from std_msgs.msg import String

    order(dashboard, "open")
    rclpy.init()
    node = rclpy.create_node("mine")
    publisher = node.create_publisher(String, "/mine", 10)
    node.create_timer(0.5, lambda: publisher.publish(String(data="hello")))
    look(dashboard)
    rclpy.spin_once(node, timeout_sec=0.6)
    for _ in range(6):
        rclpy.spin_once(node, timeout_sec=0.6)
    look(dashboard)
    row = next(row for row in dashboard.rates if row["topic"] == "/mine")
    assert (row["hertz"], row["state"], row["expected"]) == (2.0, "heard", 0.0)
    assert states(dashboard.lights, "name")["/mine"] == "extra"
    node.destroy_node()
    look(dashboard)
    assert "/mine" not in states(dashboard.rates, "topic")


def test_at_the_very_beginning_nothing_is_late(lesson: Lesson) -> None:
    for program in ("navigator", "status_monitor", "obstacle_detector"):
        run_line(lesson._world, f"ros2 run robot_controller {program}")  # is up at once
    dashboard = lesson.dashboard()
    assert {row["state"] for row in dashboard.rates} == {"just begun", "at rest"}
    wait = "No message has come on /robot/status yet: messages come while robot time passes."
    assert dashboard.status_note == wait


# -- lights ------------------------------------------------------------------------------------------------------------


def test_lights_tell_what_is_there_and_what_is_missing(lesson: Lesson) -> None:
    dashboard = lesson.dashboard()
    assert states(dashboard.lights, "name") == {
        "/turtlesim": "present",
        "/navigator": "missing",
        "/status_monitor": "missing",
        "/obstacle_detector": "missing",
        "/navigate_to": "missing",
    }
    lesson.launch("robot_controller", "start_system.launch.py")
    lesson.run(0.1)
    look(dashboard)
    assert set(states(dashboard.lights, "name").values()) == {"present"}
    service = next(light for light in dashboard.lights if light["kind"] == "service")
    assert service["words"] == "from /navigator"


def test_a_service_that_is_only_asked_for_is_missing(lesson: Lesson) -> None:
    dashboard = lesson.dashboard()
    order(dashboard, "goal", x=1.0, y=1.0, theta=0.0)
    look(dashboard)
    assert states(dashboard.lights, "name")["/navigate_to"] == "missing"


# -- log ---------------------------------------------------------------------------------------------------------------


def test_the_log_begins_with_what_was_said_before(lesson: Lesson, dashboard: Dashboard) -> None:
    order(dashboard, "open")
    assert log_texts(dashboard) == []  # nothing arrives while robot time stands still
    lesson.run(0.1)
    look(dashboard)
    texts = log_texts(dashboard)
    assert texts[0] == "Starting turtlesim with node name /turtlesim"
    assert "Navigator ready for goals on /navigate_to" in texts
    times = [line[1] for line in dashboard.log_new]
    assert times == sorted(times)


def test_lines_have_a_number_a_time_a_level_and_a_name(lesson: Lesson, dashboard: Dashboard) -> None:
    order(dashboard, "open")
    order(dashboard, "goal", x=20.0, y=1.0, theta=0.0)
    lesson.run(1)
    look(dashboard)
    number, seconds, level, name, text = dashboard.log_new[-1]
    assert (level, name) == ("WARN", "navigator")
    assert number == len(dashboard.log_new)
    assert seconds == pytest.approx(5.9, abs=0.01)
    assert "refused" in text


def test_a_log_that_was_closed_goes_on_without_a_line_twice(lesson: Lesson, dashboard: Dashboard) -> None:
    order(dashboard, "open")
    lesson.run(0.1)
    look(dashboard)
    before = log_texts(dashboard)
    order(dashboard, "close")
    order(dashboard, "goal", x=20.0, y=1.0, theta=0.0)  # is refused while nobody looks
    lesson.run(0.1)
    order(dashboard, "open")
    lesson.run(0.1)
    look(dashboard)
    after = log_texts(dashboard)
    assert after[: len(before)] == before
    assert len(after) == len(before) + 1


def test_the_log_keeps_the_newest_lines_and_sends_few_again(dashboard: Dashboard) -> None:
    for number in range(1200):
        dashboard._log_waiting[:] = [(number * SECOND, "INFO", "chatter", f"line {number}")]
        dashboard._add_lines()
        assert len(dashboard.log_new) <= module.BLOCK
    texts = log_texts(dashboard)
    assert module.KEPT <= len(texts) <= module.KEPT + module.BLOCK
    assert texts[-1] == "line 1199"


def test_the_level_is_the_same_in_all_windows(dashboard: Dashboard) -> None:
    order(dashboard, "log_least", level="WARN")
    assert dashboard.log_least == "WARN"
    order(dashboard, "log_least", level="LOUD")
    assert dashboard.log_least == "WARN"
    assert dashboard.words == "There is no level 'LOUD'; there are DEBUG, INFO, WARN, ERROR, FATAL."


# -- the page ----------------------------------------------------------------------------------------------------------


def test_the_page_stores_a_picture_and_no_widget() -> None:
    page = nbformat.read(PAGE, as_version=4)
    assert "widgets" not in page.metadata
    outputs = [output for cell in page.cells for output in cell.get("outputs", [])]
    assert [sorted(output.data) for output in outputs] == [["image/png", "text/plain"]]
