"""Obstacles: what is accepted, what they say, and their way into a ROS message."""

import dataclasses
import math

import numpy as np
import pytest

from turtle_lesson.turtlesim.obstacles import COLOUR, WORLDS, Box, Circle, Obstacle, to_marker_array
from turtle_lesson.turtlesim.turtle import HEIGHT, WIDTH

# isort: split
# Importing turtle_lesson made the message packages importable.
from builtin_interfaces.msg import Time
from visualization_msgs.msg import Marker

MIDDLE = (WIDTH / 2, HEIGHT / 2)


def distance_to(obstacle: Obstacle, x: float, y: float) -> float:
    """Distance from a point to the obstacle's edge, in metres; below zero or zero inside."""
    if isinstance(obstacle, Circle):
        return math.hypot(x - obstacle.x, y - obstacle.y) - obstacle.radius
    cos, sin = math.cos(-obstacle.angle), math.sin(-obstacle.angle)
    dx, dy = x - obstacle.x, y - obstacle.y
    along, across = abs(cos * dx - sin * dy), abs(sin * dx + cos * dy)
    return math.hypot(max(along - obstacle.width / 2, 0), max(across - obstacle.height / 2, 0))


def stamp(sec: int = 12, nanosec: int = 34) -> Time:
    return Time(sec=sec, nanosec=nanosec)


# ---------------------------------------------------------------- making one


def test_any_kind_of_number_is_taken_and_kept_as_float() -> None:
    assert Circle(3, 4, 1) == Circle(3.0, 4.0, 1.0)
    box = Box(np.float32(1.5), 2, np.int64(3), 1)  # type: ignore[arg-type]
    assert all(type(value) is float for value in dataclasses.astuple(box))
    assert box.angle == 0.0


def test_obstacles_can_be_collected_in_a_set_and_not_changed() -> None:
    circle = Circle(1, 2, 3)
    assert len({circle, Circle(1.0, 2.0, 3.0)}) == 1
    with pytest.raises(dataclasses.FrozenInstanceError):
        circle.x = 5.0  # type: ignore[misc]


@pytest.mark.parametrize("radius", [0, -1.0, math.nan, math.inf, -math.inf])
def test_a_radius_that_is_not_above_zero_is_refused_with_an_example(radius: float) -> None:
    with pytest.raises(
        ValueError, match=r"Circle: radius must be a number above zero, in metres, not .*; try Circle\("
    ):
        Circle(1.0, 2.0, radius)


@pytest.mark.parametrize(("field", "value"), [("x", math.nan), ("y", math.inf), ("angle", math.nan)])
def test_a_place_or_an_angle_that_is_no_number_is_refused(field: str, value: float) -> None:
    numbers = {"x": 1.0, "y": 1.0, "width": 1.0, "height": 1.0, field: value}
    with pytest.raises(ValueError, match=f"Box: {field} must be a finite number"):
        Box(**numbers)


def test_an_angle_is_asked_for_in_radians() -> None:
    with pytest.raises(TypeError, match="Box: angle must be a finite number, in radians, not '30°'"):
        Box(1, 1, 1, 1, "30°")  # type: ignore[arg-type]


@pytest.mark.parametrize("value", [None, "1", True, (1.0,), 1j])
def test_what_is_no_number_at_all_is_a_type_error(value: object) -> None:
    with pytest.raises(TypeError, match="Circle: x must be a finite number"):
        Circle(value, 1.0, 1.0)  # type: ignore[arg-type]


# ---------------------------------------------------------------- what they say


def test_the_text_form_has_places_sizes_and_both_units_of_the_angle() -> None:
    assert [str(each) for each in (Circle(3, 4, 0.5), Box(1, 2, 2, 0.25), Box(1, 2, 2, 0.25, math.pi / 6))] == [
        "circle at (3.00, 4.00), radius 0.50 m",
        "box at (1.00, 2.00), 2.00 m by 0.25 m",
        "box at (1.00, 2.00), 2.00 m by 0.25 m, turned by 0.52 rad (30°)",
    ]


# ---------------------------------------------------------------- the example worlds


@pytest.mark.parametrize("name", WORLDS)
def test_every_example_world_leaves_the_start_free_and_the_rest_has_three_to_see(name: str) -> None:
    obstacles = WORLDS[name]
    distances = [distance_to(each, *MIDDLE) for each in obstacles]
    assert all(1.0 < distance < 10.0 for distance in distances)
    assert len(obstacles) >= 3 or name == "empty"
    assert all(0 < each.x < WIDTH and 0 < each.y < HEIGHT for each in obstacles)


# ---------------------------------------------------------------- as a message


def test_the_message_wipes_first_and_then_shows_each_obstacle_standing_on_the_floor() -> None:
    wipe, pillar, wall = to_marker_array([Circle(3, 4, 0.5), Box(1, 2, 2, 0.25, math.pi / 2)], stamp()).markers
    assert wipe.action == Marker.DELETEALL
    assert [each.header.frame_id for each in (wipe, pillar, wall)] == ["world"] * 3
    assert [each.header.stamp for each in (wipe, pillar, wall)] == [stamp()] * 3
    assert [(each.ns, each.id, each.action) for each in (pillar, wall)] == [
        ("obstacles", 0, Marker.ADD),
        ("obstacles", 1, Marker.ADD),
    ]
    assert (pillar.type, wall.type) == (Marker.CYLINDER, Marker.CUBE)
    assert (pillar.scale.x, pillar.scale.y, wall.scale.x, wall.scale.y) == (1.0, 1.0, 2.0, 0.25)
    assert (pillar.pose.position.z, pillar.scale.z) == (0.25, 0.5)
    assert (pillar.pose.orientation.w, wall.pose.orientation.z) == (1.0, pytest.approx(math.sqrt(0.5)))
    assert (wall.color.r, wall.color.g, wall.color.b, wall.color.a) == pytest.approx(COLOUR)


def test_no_obstacles_are_a_message_too() -> None:
    assert len(to_marker_array((), stamp()).markers) == 1
