"""Scans in words and as a picture."""

import math

import pytest
from lab_fakes import recording, scan, see

from turtle_lesson.lab.status_and_scan import plot_scan, reach_of, read_beams


def ranges(**seen):
    """181 beams that see nothing, but for beams such as b30=0.5 (at +30°) or m90=2.0 (at -90°)."""
    beams = [10.0] * 181
    for name, distance in seen.items():
        beams[90 + int(name[1:]) * (1 if name[0] == "b" else -1)] = distance
    return beams


def test_a_few_things_around():
    heard = see(recording(), scan(ranges(b30=0.5, b31=0.6, m90=2.0, b0=3.25)), scans=5)
    assert repr(plot_scan(heard)) == (
        "Scan on /obstacles at 1.00 s of robot time: 181 beams from -1.57 rad (-90.0°) to 1.57 rad (90.0°), "
        "positive to the left, for ranges from 0.00 m to 10.00 m. 4 beams of 181 see something. "
        "The nearest is 0.50 m at 0.52 rad (30.0°). Nearest by side: right 2.00 m at -1.57 rad (-90.0°); "
        "ahead 0.50 m at 0.52 rad (30.0°); left 0.60 m at 0.54 rad (31.0°). "
        "So far: 5 messages, one every 200.0 ms on average (5.0 Hz), "
        "the shortest interval 200.0 ms and the longest 200.0 ms."
    )


def test_nothing_in_reach():
    text = plot_scan(see(recording(), scan(ranges()))).text
    assert "No beam of 181 sees something. So far: 1 message." in text


def test_walls_all_around():
    assert "All of them see something." in plot_scan(see(recording(), scan([3.0] * 181))).text


def test_the_lessons_180_readings_contradict_its_angles():
    text = plot_scan(see(recording(), scan([10.0] * 180))).text
    assert "But its angle_min, angle_max and angle_increment ask for 181 readings: the message" in text


@pytest.mark.parametrize("step", [0.0174, math.pi / 180, 0.017453292519943295])
def test_float32_angles_ask_for_181_readings(step):
    import numpy as np

    message = scan([10.0] * 181)
    message.angle_min, message.angle_max = float(np.float32(-math.pi / 2)), float(np.float32(math.pi / 2))
    message.angle_increment = float(np.float32(step))
    assert read_beams(message).asked == 181


def test_of_two_equally_near_things_the_one_ahead_counts():
    beams = read_beams(scan(ranges(b80=0.5, m3=0.5, b7=0.5)))
    assert beams.nearest() == 87


def test_readings_that_are_none_are_discarded():
    beams = read_beams(scan([math.nan, math.inf, -1.0, 11.0, 10.0, 0.5], degrees=(-2.5, 2.5)))
    assert beams.sees.tolist() == [False] * 5 + [True]


def test_a_sensor_that_looks_all_around_has_a_side_behind():
    message = scan([1.0 if beam == 0 else 10.0 for beam in range(360)], degrees=(-180, 179))
    picture = plot_scan(see(recording(), message))
    assert "Nearest by side: behind 1.00 m at -3.14 rad (-180.0°)." in picture.text
    assert picture.png()


@pytest.mark.parametrize("message", [scan([]), scan([1.0], degrees=(0, 0), step=0), scan([math.nan] * 181)])
def test_odd_scans_are_drawn_without_fuss(message):
    assert plot_scan(see(recording(), message)).png()


@pytest.mark.parametrize("most", [math.inf, math.nan, 0.0, 1e9])
def test_a_useless_maximum_does_not_set_the_scale(most):
    message = scan([2.0] * 181)
    message.range_max = most
    beams = read_beams(message)
    assert reach_of(beams) == pytest.approx(2.4 if beams.sees.any() else 1.0)
    assert plot_scan(see(recording(), message)).png()


def test_rings_are_at_round_distances():
    (axes,) = plot_scan(see(recording(), scan([5.0] * 181))).figure.axes
    assert [each.get_text() for each in axes.texts if each.get_text().endswith(" m")] == [
        "2 m",
        "4 m",
        "6 m",
        "8 m",
        "10 m",
    ]


def test_nothing_heard_yet():
    assert plot_scan(recording()).text.startswith("No scan yet. No message has come on /obstacles yet.")


@pytest.mark.parametrize("nearest", [0.3, 0.5, 2.0])
def test_the_turtle_hides_no_hit(nearest):
    (axes,) = plot_scan(see(recording(), scan([nearest] * 181))).figure.axes
    _, *turtle = axes.patches  # the first is the space that the beams found free
    metres = axes.transData.inverted()
    corners = [metres.transform_path(each.get_transform().transform_path(each.get_path())).vertices for each in turtle]
    assert 0.1 < max(math.hypot(*corner) for part in corners for corner in part) < nearest
