"""The obstacle detector's ray cast, on its own: no ROS, no clock."""

import math
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from node_files import load_node

detector = load_node("obstacle_detector_node")
Marker, Obstacles = detector.Marker, detector.Obstacles

WORLD, FAR = detector.WORLD_SIZE, detector.RANGE_MAX
MIDDLE = WORLD / 2
RIGHT, AHEAD, LEFT = 0, 90, 180


def circle(x, y, radius):
    return (x, y, radius)


def box(x, y, length, width, angle=0.0):
    return (x, y, length / 2, width / 2, math.cos(angle), math.sin(angle))


def world(*things):
    """Obstacles from circles (three numbers) and boxes (six)."""
    circles = np.array([thing for thing in things if len(thing) == 3]).reshape(-1, 3)
    boxes = np.array([thing for thing in things if len(thing) == 6]).reshape(-1, 6)
    return Obstacles(circles, boxes)


def cast(x, y, heading, *things):
    return detector.cast_rays(x, y, heading, world(*things))


def clearance(x, y, obstacles):
    """Return how far points are from the nearest surface; negative inside an obstacle or beyond a wall."""
    nearest = np.minimum(np.minimum(x, WORLD - x), np.minimum(y, WORLD - y))
    for cx, cy, radius in obstacles.circles:
        nearest = np.minimum(nearest, np.hypot(x - cx, y - cy) - radius)
    for cx, cy, half_x, half_y, cos, sin in obstacles.boxes:
        beyond_x = np.abs((x - cx) * cos + (y - cy) * sin) - half_x
        beyond_y = np.abs((y - cy) * cos - (x - cx) * sin) - half_y
        outside = np.hypot(np.maximum(beyond_x, 0.0), np.maximum(beyond_y, 0.0))
        nearest = np.minimum(nearest, outside + np.minimum(np.maximum(beyond_x, beyond_y), 0.0))
    return nearest


coordinates = st.floats(0.0, WORLD)
sizes = st.floats(0.05, 3.0)
angles = st.floats(-math.pi, math.pi)
circles = st.builds(circle, coordinates, coordinates, sizes)
boxes = st.builds(box, coordinates, coordinates, sizes, sizes, angles)


@given(x=coordinates, y=coordinates, heading=angles, things=st.lists(circles | boxes, max_size=8))
@example(x=5.0, y=5.0, heading=0.0, things=[box(8.0, 5.0, 2.0, 2.0), circle(5.0, 9.0, 1.0)])  # along the axes
@example(x=5.0, y=5.0, heading=math.pi / 2, things=[box(8.0, 8.0, 1.0, 1.0, math.pi / 4)])
@example(x=0.0, y=0.0, heading=math.pi / 4, things=[])
def test_every_beam_runs_free_and_ends_at_a_surface(x, y, heading, things):
    obstacles = world(*things)
    readings = detector.cast_rays(x, y, heading, obstacles).astype(float)
    assert readings.shape == (181,) and (readings >= 0.0).all() and (readings <= FAR).all()
    if clearance(x, y, obstacles) < -1e-6:
        assert not readings.any()
        return
    angles = heading + np.radians(np.arange(-90, 91))
    part = np.linspace(0.0, 1.0, 150)[:, None]
    way_x, way_y = x + part * readings * np.cos(angles), y + part * readings * np.sin(angles)
    free = clearance(way_x, way_y, obstacles)
    assert (free > -1e-5).all(), "a beam runs through something"
    assert (free[-1][readings < FAR] < 1e-5).all(), "a beam ends in empty space"


def test_in_the_empty_world_it_sees_the_walls():
    readings = cast(MIDDLE, MIDDLE, 0.0)
    assert readings[[RIGHT, AHEAD, LEFT]] == pytest.approx([MIDDLE] * 3)
    assert readings[[45, 135]] == pytest.approx([MIDDLE * math.sqrt(2)] * 2)
    assert readings.dtype == np.float32


def test_readings_run_from_right_to_left():
    readings = cast(3.0, 1.0, 0.0)
    assert readings[RIGHT] == pytest.approx(1.0)  # the lower wall is on the right of a turtle that looks east
    assert readings[AHEAD] == pytest.approx(WORLD - 3.0)
    assert readings[LEFT] == pytest.approx(10.0)  # the upper wall, 10.09 m away, is out of reach


def test_what_is_out_of_reach_reads_exactly_the_largest_range():
    assert cast(0.5, MIDDLE, 0.0)[AHEAD] == FAR


def test_at_a_wall_beams_into_it_read_zero_and_others_do_not():
    readings = cast(11.08888912200927734375, MIDDLE, 0.0)  # the wall as float32 is a hair beyond it
    assert not readings[1:180].any()
    assert (cast(11.08888912200927734375, MIDDLE, math.pi)[1:180] > 5.0).all()


def test_a_pillar_ahead_hides_the_wall_and_only_the_beams_that_meet_it():
    readings = cast(MIDDLE, MIDDLE, 0.0, circle(MIDDLE + 3.0, MIDDLE, 0.5))
    assert readings[AHEAD] == pytest.approx(2.5)
    half_width = math.degrees(math.asin(0.5 / 3.0))  # 9.6°
    assert (readings[81:100] < 3.0).all() and half_width == pytest.approx(9.6, abs=0.01)
    assert readings[80] > 5.0 and readings[100] > 5.0


def test_it_turns_with_the_turtle():
    pillar = circle(MIDDLE, MIDDLE + 3.0, 0.5)
    assert cast(MIDDLE, MIDDLE, 0.0, pillar)[LEFT] == pytest.approx(2.5)
    assert cast(MIDDLE, MIDDLE, math.pi / 2, pillar)[AHEAD] == pytest.approx(2.5)
    assert cast(MIDDLE, MIDDLE, math.pi, pillar)[RIGHT] == pytest.approx(2.5)
    assert (cast(MIDDLE, MIDDLE, -math.pi / 2, pillar) > 5.0).all()  # it is behind now


def test_a_box_is_met_at_its_side_and_turned_at_its_corner():
    assert cast(5.0, 5.0, 0.0, box(8.0, 5.0, 2.0, 4.0))[AHEAD] == pytest.approx(2.0)
    turned = cast(5.0, 5.0, 0.0, box(8.0, 5.0, 1.0, 1.0, math.pi / 4))
    assert turned[AHEAD] == pytest.approx(3.0 - math.sqrt(0.5))


def test_the_nearer_of_two_counts_whatever_their_order_and_kind():
    near, behind_it = box(7.0, 5.0, 0.5, 0.5), circle(9.0, 5.0, 1.0)
    assert cast(5.0, 5.0, 0.0, near, behind_it)[AHEAD] == pytest.approx(1.75)
    assert cast(5.0, 5.0, 0.0, behind_it, near)[AHEAD] == pytest.approx(1.75)


@pytest.mark.parametrize("thing", [circle(5.0, 5.0, 1.0), box(5.0, 5.0, 1.0, 1.0, 0.3)])
def test_inside_an_obstacle_every_beam_reads_zero(thing):
    assert not cast(5.2, 5.1, 1.0, thing, circle(9.0, 9.0, 0.5)).any()


def marker(kind=Marker.CYLINDER, ns="", id=0, action=Marker.ADD, x=1.0, length=1.0, width=1.0, z=0.0, w=1.0):
    position, orientation = SimpleNamespace(x=x, y=2.0), SimpleNamespace(z=z, w=w)
    pose = SimpleNamespace(position=position, orientation=orientation)
    scale = SimpleNamespace(x=length, y=width)
    return SimpleNamespace(type=kind, ns=ns, id=id, action=action, pose=pose, scale=scale)


def show(*messages):
    shown = {}
    for markers in messages:
        obstacles = detector.show(shown, SimpleNamespace(markers=markers))
    return obstacles


def test_markers_become_circles_and_boxes():
    turned = marker(Marker.CUBE, id=1, length=4.0, width=2.0, z=math.sin(0.25), w=math.cos(0.25))
    obstacles = show([marker(length=0.8), turned])
    assert obstacles.circles.tolist() == [[1.0, 2.0, 0.4]]
    assert obstacles.boxes[0] == pytest.approx([1.0, 2.0, 2.0, 1.0, math.cos(0.5), math.sin(0.5)])


def test_a_quaternion_of_zeros_or_of_another_length_is_taken_as_a_viewer_takes_it():
    zeros = show([marker(Marker.CUBE, z=0.0, w=0.0)])
    assert zeros.boxes[0, 4:].tolist() == [1.0, 0.0]
    longer = show([marker(Marker.CUBE, z=2.0, w=2.0)])
    assert longer.boxes[0, 4:] == pytest.approx([0.0, 1.0])


def test_markers_are_added_moved_deleted_and_all_deleted():
    first, second = marker(id=1, x=1.0), marker(id=2, x=2.0)
    assert len(show([first], [second]).circles) == 2
    assert show([first, second], [marker(id=1, x=7.0)]).circles[:, 0].tolist() == [7.0, 2.0]
    assert show([first, second], [marker(id=1, action=Marker.DELETE)]).circles[:, 0].tolist() == [2.0]
    assert show([first, second], [marker(id=9, action=Marker.DELETE)]).circles[:, 0].tolist() == [1.0, 2.0]
    assert show([first], [marker(action=Marker.DELETEALL), second]).circles[:, 0].tolist() == [2.0]
    assert show([first], [marker(action=Marker.DELETEALL)]).circles.shape == detector.NOTHING.circles.shape


def test_same_number_in_another_namespace_is_another_marker():
    assert len(show([marker(ns="a"), marker(ns="b")]).circles) == 2


def test_markers_of_other_kinds_are_no_obstacles():
    obstacles = show([marker(kind=9)])  # text
    assert len(obstacles.circles) == len(obstacles.boxes) == 0
