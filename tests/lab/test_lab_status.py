"""Statuses in words and as a picture."""

import math

import pytest
from lab_fakes import START, recording, report

from turtle_lesson.lab.status_and_scan import plot_status, spread


def test_a_steady_stream():
    assert repr(plot_status(report(recording()))) == (
        "Status on /robot/status from 0.10 s to 2.10 s of robot time: 21 messages, "
        "one every 100.0 ms on average (10.0 Hz), the shortest interval 100.0 ms and the longest 100.0 ms. "
        "Position from (5.00, 5.00) m to (7.00, 5.00) m; "
        "heading from 0.00 rad (0.0°) to 0.00 rad (0.0°); speed at most 1.00 m/s, 1.00 m/s at the end "
        "(1.00 along x and 0.00 along y); battery from 100.0 % to 98.0 %."
    )


def test_the_monitor_that_reports_zero_for_ever_is_seen_as_such():
    heard = recording()
    for number in range(3):
        heard.statuses.append(START + number * 100_000_000, -0.0, 0.0, -0.0, -0.0, 0.0, 100.0)
    text = plot_status(heard).text
    assert "Position from (0.00, 0.00) m to (0.00, 0.00) m" in text and "-0" not in text


def test_one_message_has_no_interval():
    picture = plot_status(report(recording(), messages=1))
    assert "from 0.10 s to 0.10 s of robot time: 1 message. Position" in picture.text
    assert picture.png()


def test_a_status_without_a_battery_is_drawn_without_one():
    heard = recording()
    for number in range(3):
        heard.statuses.append(START + number * 100_000_000, 1.0, 1.0, 0.0, 0.0, 0.0, math.nan)
    picture = plot_status(heard)
    assert picture.text.endswith("0.00 m/s at the end (0.00 along x and 0.00 along y).")
    assert picture.png()


def test_nothing_heard_yet():
    assert "No status yet. No message has come on /robot/status yet." in plot_status(recording()).text


def test_labels_at_the_same_height_are_moved_apart():
    assert spread([0.0, 0.0, 0.0], 1.0) == [-1.0, 0.0, 1.0]
    assert spread([5.0, 1.0], 1.0) == [5.0, 1.0]
    assert spread([math.nan, 3.0], 1.0) == pytest.approx([0.0, 3.0])
