"""The turtles' world against recordings of the real turtlesim, and its rules told as stories."""

import csv
import itertools
import math
import re
from pathlib import Path
from typing import NamedTuple

import pytest
from hypothesis import given
from hypothesis import strategies as st

from turtle_lesson.turtlesim.turtle import (
    BARE,
    DEFAULT_PEN,
    HEIGHT,
    WIDTH,
    Cells,
    Turtle,
    TurtleError,
    TurtleWorld,
    cell_at,
    draw,
    float32,
)

DATA = Path(__file__).parents[1] / "data" / "turtlesim"
PI_OF_TURTLESIM = 3.14159265
START = (5.544444561004639, 5.544444561004639, 0.0)


class Row(NamedTuple):
    """One recorded pose."""

    phase: str
    x: float
    y: float
    theta: float
    linear: float
    angular: float

    @property
    def moving(self) -> bool:
        return bool(self.linear or self.angular)

    @property
    def place(self) -> tuple[float, float, float]:
        return (self.x, self.y, self.theta)


def recorded(name: str) -> list[Row]:
    with open(DATA / name, newline="", encoding="utf-8") as file:
        lines = list(csv.reader(file))[1:]
    return [Row(line[0] if len(line) == 7 else "", *map(float, line[-5:])) for line in lines]


def pose(turtle: Turtle, digits: str = "{:.9g}") -> tuple[str, ...]:
    """The pose as the wire has it: float32, in as many digits as the recording."""
    values = (turtle.x, turtle.y, turtle.theta, turtle.speed, turtle.angular)
    return tuple(digits.format(float32(value)) for value in values)


def velocity(row: Row) -> tuple[float, float, float]:
    """The command of a row: its pose has only the speed, and the phase's name the direction."""
    if row.phase.startswith("sideways"):
        return (0.0, row.linear, row.angular)
    if row.phase.startswith("backwards"):
        return (-row.linear, 0.0, row.angular)
    # The commands were float64: 0.2, where the float32 of the pose reads 0.200000003.
    return (round(row.linear, 6), 0.0, round(row.angular, 6))


def drives(rows: list[Row]) -> list[tuple[int, int]]:
    """The first and the last moving row of every drive; a new phase begins a new drive."""
    found = []
    for _, group in itertools.groupby(enumerate(rows), key=lambda item: (item[1].moving, item[1].phase)):
        indices = [index for index, row in group if row.moving]
        if indices:
            found.append((indices[0], indices[-1]))
    return found


def ticks_with_a_command(first: int, last: int) -> list[int]:
    """Ticks in which a command took effect, for a drive that lasted from row ``first`` to row ``last``.

    The first is sure, and so is the final one: 63 ticks before the turtle stood. In between one came every
    100 ms.
    """
    final = last - 62
    between = (first + int(number * 6.25) for number in itertools.count())
    return [*itertools.takewhile(lambda tick: tick < final, between), final]


def is_reset(before: Row, row: Row) -> bool:
    """Standing in the middle again, a tick after being elsewhere: somebody called /reset."""
    return not row.moving and row.place != before.place and row.place[:2] == (5.54444456, 5.54444456)


# ---------------------------------------------------------------- the recordings


def test_every_pose_of_the_recorded_phases_is_reproduced_exactly() -> None:
    rows = recorded("turtle_trace.csv")
    commands = {tick: rows[tick] for drive in drives(rows) for tick in ticks_with_a_command(*drive)}
    world, resets = TurtleWorld(), 0
    for tick, row in enumerate(rows):
        if tick and is_reset(rows[tick - 1], row):
            world.reset()
            resets += 1
        if tick in commands:
            world.turtles["turtle1"].command(*velocity(commands[tick]))
        world.tick()
        expected = tuple(f"{value:.9g}" for value in row[1:])
        assert pose(world.turtles["turtle1"]) == expected, f"line {tick + 2}, phase {row.phase}"
    assert (len(rows), len(drives(rows)), resets) == (1499, 8, 4)


def test_the_recorded_commands_lasted_63_ticks_and_came_at_10_hz() -> None:
    lengths = [last - first + 1 for first, last in drives(recorded("turtle_trace.csv"))]
    # A single command: 63 ticks. Those at 10 Hz for 2 s: the last one came 125 ticks, 2.0 s, after the first.
    assert lengths == [63 + 125, 63 + 124, 63 + 62, 63, 63, 63 + 125, 63, 63]


def test_a_turtle_that_nobody_commands_stands_still_as_recorded() -> None:
    world = TurtleWorld()
    for row in recorded("turtle_services_trace.csv"):
        world.tick()
        assert pose(world.turtles["turtle1"]) == tuple(f"{value:.9g}" for value in row[1:])


def test_the_drive_of_the_lessons_navigator_is_reproduced_exactly() -> None:
    left_over, *rows = recorded("navigator_goal_5_5_trace.csv")
    assert left_over.place == (11.088889, 0.0, 0.0)
    first = next(index for index, row in enumerate(rows) if row.moving)
    commands = {first + int(number * 6.25) for number in range(len(rows))}
    world = TurtleWorld()
    turtle = world.turtles["turtle1"]
    for tick, row in enumerate(rows):
        if tick in commands:
            turtle.command(0.2)
        world.tick()
        expected = tuple(f"{value:.6f}" for value in row[1:])
        assert pose(turtle, "{:.6f}") == expected, f"line {tick + 3}"
    assert len(rows) - first == 1464


def test_first_tick_turns_before_it_moves() -> None:
    world = TurtleWorld()
    world.turtles["turtle1"].command(1.0, 0.0, 1.0)
    world.tick()
    assert pose(world.turtles["turtle1"]) == ("5.56044245", "5.54470062", "0.0160000008", "1", "1")


# ---------------------------------------------------------------- commands


def drive(world: TurtleWorld, ticks: int) -> Turtle:
    for _ in range(ticks):
        world.tick()
    return world.turtles["turtle1"]


def test_one_command_of_a_metre_a_second_moves_the_turtle_a_little_more_than_a_metre() -> None:
    world = TurtleWorld()
    world.turtles["turtle1"].command(1.0)
    assert drive(world, 63).speed == 1.0
    turtle = drive(world, 1)
    assert (turtle.speed, turtle.at_rest) == (0.0, False)
    assert drive(world, 1).at_rest
    assert turtle.x - START[0] == pytest.approx(1.008)


def test_a_stop_command_stops_at_once_and_a_late_one_changes_nothing() -> None:
    world = TurtleWorld()
    world.turtles["turtle1"].command(1.0)
    drive(world, 10)
    world.turtles["turtle1"].command(0.0)
    turtle = drive(world, 100)
    assert turtle.x - START[0] == pytest.approx(0.16)
    turtle.command(0.0)
    assert drive(world, 100).x - START[0] == pytest.approx(0.16)


def test_of_many_commands_between_two_ticks_the_last_seven_are_carried_out_one_a_tick() -> None:
    world = TurtleWorld()
    for speed in range(1, 11):
        world.turtles["turtle1"].command(float(speed))
    speeds = [drive(world, 1).speed for _ in range(9)]
    assert speeds == [4, 5, 6, 7, 8, 9, 10, 10, 10]


def test_backwards_and_sideways_the_pose_shows_the_length_of_the_velocity() -> None:
    world = TurtleWorld()
    world.turtles["turtle1"].command(-3.0, 4.0)
    turtle = drive(world, 1)
    assert turtle.speed == 5.0
    assert turtle.x < START[0] < turtle.y


def test_sideways_means_to_the_turtles_own_left() -> None:
    world = TurtleWorld()
    turtle = world.turtles["turtle1"]
    turtle.teleport_absolute(5.0, 5.0, math.pi / 2)
    turtle.command(0.0, 1.0)
    drive(world, 1)
    assert (turtle.x, turtle.y) == pytest.approx((5.0 - 0.016, 5.0))


@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf, 1e300])
@pytest.mark.parametrize("position", range(3))
def test_a_command_that_is_no_number_is_refused_and_the_old_one_goes_on(bad: float, position: int) -> None:
    world = TurtleWorld()
    turtle = world.turtles["turtle1"]
    turtle.command(1.0)
    drive(world, 1)
    speeds = [0.0, 0.0, 0.0]
    speeds[position] = bad
    with pytest.raises(TurtleError, match=r"turtle1.*ignores.*finite number"):
        turtle.command(*speeds)
    assert drive(world, 1).speed == 1.0


# ---------------------------------------------------------------- heading and walls


def test_the_heading_wraps_with_the_real_ones_short_pi() -> None:
    world = TurtleWorld()
    turtle = world.turtles["turtle1"]
    turtle.teleport_absolute(5.0, 5.0, math.pi)
    world.tick()
    assert turtle.theta == math.pi - 2 * PI_OF_TURTLESIM


@given(st.floats(-1e6, 1e6), st.floats(-1e4, 1e4))
def test_the_heading_always_stays_within_half_a_turn(theta: float, angular: float) -> None:
    world = TurtleWorld()
    turtle = world.turtles["turtle1"]
    turtle.teleport_absolute(5.0, 5.0, theta)
    turtle.command(0.0, 0.0, angular)
    for _ in range(3):
        world.tick()
        assert -PI_OF_TURTLESIM - 1e-9 <= turtle.theta <= PI_OF_TURTLESIM + 1e-9


def test_a_wall_holds_the_turtle_and_reports_the_place_with_y_from_the_top() -> None:
    world = TurtleWorld()
    far = world.spawn(50.0, 50.0, 0.0, "far")
    ((name, (x, flipped_y)),) = world.tick().items()
    assert (name, f"x={x:f}, y={flipped_y:f}") == ("far", "x=50.000000, y=-38.911110")
    assert (far.x, far.y) == (WIDTH, HEIGHT)
    assert world.tick() == {}


def test_the_turtle_slides_along_a_wall_and_every_tick_of_pushing_is_a_hit() -> None:
    world = TurtleWorld()
    turtle = world.turtles["turtle1"]
    turtle.teleport_absolute(11.0, 5.0, math.pi / 4)
    turtle.command(1.0)
    hits = [len(world.tick()) for _ in range(70)]
    assert (hits.count(1), hits[:7], hits[63:]) == (56, [0] * 7, [0] * 7)
    assert turtle.x == WIDTH
    assert turtle.y == pytest.approx(5.0 + 63 * 0.016 * math.sin(math.pi / 4))


@given(st.lists(st.tuples(*[st.floats(-1e38, 1e38)] * 3), max_size=8), st.tuples(*[st.floats(-1e38, 1e38)] * 3))
def test_whatever_is_commanded_the_turtle_stays_inside(
    commands: list[tuple[float, float, float]], teleport: tuple[float, float, float]
) -> None:
    world = TurtleWorld()
    turtle = world.turtles["turtle1"]
    turtle.teleport_absolute(*teleport)
    for command in commands:
        turtle.command(*command)
        world.tick()
        assert 0 <= turtle.x <= WIDTH and 0 <= turtle.y <= HEIGHT
        assert math.isfinite(turtle.theta) and math.isfinite(float32(turtle.speed))


# ---------------------------------------------------------------- spawn, kill, reset, teleport


def test_names_are_given_in_turn_and_taken_ones_are_skipped() -> None:
    world = TurtleWorld()
    world.spawn(2.0, 2.0, 0.0, "turtle2")
    assert [world.spawn(3.0, 3.0, 0.0).name, world.spawn(3.0, 3.0, 0.0).name] == ["turtle3", "turtle4"]
    world.kill("turtle3")
    assert world.spawn(3.0, 3.0, 0.0).name == "turtle5"
    assert list(world.turtles) == ["turtle1", "turtle2", "turtle4", "turtle5"]


def test_a_taken_name_and_an_unknown_one_are_refused_in_the_real_ones_words() -> None:
    world = TurtleWorld()
    with pytest.raises(TurtleError, match=re.escape("A turtle named [turtle1] already exists")):
        world.spawn(1.0, 1.0, 0.0, "turtle1")
    with pytest.raises(TurtleError, match=re.escape("Tried to kill turtle [nobody], which does not exist")):
        world.kill("nobody")
    assert list(world.turtles) == ["turtle1"]


@pytest.mark.parametrize("bad", ["bad name", "2fast", "Schildkröte", "a//b", "-"])
def test_a_name_that_ends_the_real_program_is_refused(bad: str) -> None:
    with pytest.raises(TurtleError, match=re.escape(f"cannot be named [{bad}]")):
        TurtleWorld().spawn(1.0, 1.0, 0.0, bad)


@given(st.text(max_size=12))
def test_any_name_is_taken_or_refused_never_half_done(name: str) -> None:
    world = TurtleWorld()
    try:
        turtle = world.spawn(1.0, 1.0, 0.0, name)
    except TurtleError as error:
        assert list(world.turtles) == ["turtle1"] and f"[{name}]" in str(error)
    else:
        assert world.turtles[turtle.name] is turtle


@pytest.mark.parametrize("place", [(math.nan, 1.0, 0.0), (1.0, math.inf, 0.0), (1.0, 1.0, -math.inf)])
def test_no_turtle_is_spawned_or_put_where_there_is_no_place(place: tuple[float, float, float]) -> None:
    world = TurtleWorld()
    with pytest.raises(TurtleError, match="finite"):
        world.spawn(*place)
    with pytest.raises(TurtleError, match="finite"):
        world.turtles["turtle1"].teleport_absolute(*place)
    world.tick()
    assert world.turtles["turtle1"].x == START[0] and len(world.turtles) == 1


def test_reset_leaves_one_fresh_turtle_and_a_bare_canvas() -> None:
    world = TurtleWorld()
    world.turtles["turtle1"].command(1.0)
    world.spawn(1.0, 1.0, 0.0)
    drive(world, 5)
    fresh = world.reset()
    world.tick()
    assert list(world.turtles) == ["turtle1"]
    assert (fresh.x, fresh.y, fresh.theta, fresh.colour) == (*START, BARE)
    assert world.spawn(1.0, 1.0, 0.0).name == "turtle2"


def test_a_teleport_takes_effect_at_the_next_tick_relative_ones_turn_first() -> None:
    world = TurtleWorld()
    turtle = world.turtles["turtle1"]
    turtle.teleport_absolute(2.0, 3.0, 0.0)
    turtle.teleport_relative(1.0, math.pi / 2)
    assert turtle.x == START[0]
    world.tick()
    assert (turtle.x, turtle.y, turtle.theta) == pytest.approx((2.0, 4.0, math.pi / 2))


def test_a_teleport_does_not_stop_a_driving_turtle() -> None:
    world = TurtleWorld()
    turtle = world.turtles["turtle1"]
    turtle.command(1.0)
    drive(world, 1)
    turtle.teleport_absolute(1.0, 1.0, 0.0)
    drive(world, 62)
    assert turtle.x == pytest.approx(1.0 + 62 * 0.016)


# ---------------------------------------------------------------- what the colour sensor sees


def test_a_driving_turtle_sees_its_own_trail_from_the_second_tick_on() -> None:
    world = TurtleWorld()
    world.turtles["turtle1"].command(0.2)
    colours = [drive(world, 1).colour for _ in range(70)]
    assert colours == [BARE] + [DEFAULT_PEN] * 69
    world.cells.clear()
    assert drive(world, 1).colour == BARE


def test_a_lifted_pen_leaves_no_trail_and_another_colour_is_seen_by_others() -> None:
    world = TurtleWorld()
    turtle = world.turtles["turtle1"]
    turtle.set_pen((1, 2, 3), off=True)
    turtle.command(1.0)
    assert drive(world, 70).colour == BARE
    turtle.set_pen((255, 0, 0))
    turtle.command(1.0)
    x, y = turtle.x + 0.5, turtle.y
    drive(world, 70)
    other = world.spawn(x, y, 0.0)
    world.tick()
    assert other.colour == (255, 0, 0)


def test_a_teleported_turtle_sees_the_line_it_drew_or_with_its_pen_up_the_place_it_came_to() -> None:
    world = TurtleWorld()
    turtle = world.turtles["turtle1"]
    turtle.set_pen((9, 9, 9))
    turtle.teleport_absolute(2.0, 2.0, 0.0)
    assert drive(world, 1).colour == (9, 9, 9)
    assert world.cells[cell_at((START[0] + 2.0) / 2, HEIGHT - (START[1] + 2.0) / 2)] == (9, 9, 9)
    turtle.set_pen((0, 0, 0), off=True)
    turtle.teleport_absolute(9.0, 2.0, 0.0)
    assert drive(world, 1).colour == BARE


def test_a_fast_line_has_no_gaps() -> None:
    cells: Cells = {}
    draw(cells, (1.0, 1.0), (9.0, 4.0), (1, 1, 1))
    assert all(cell_at(1.0 + 8 * part / 500, 1.0 + 3 * part / 500) in cells for part in (0, 100, 250, 499, 500))
    assert cell_at(5.0, 3.5) not in cells


@pytest.mark.parametrize("far", [(1e38, 5.0), (-1e38, -1e38), (5.0, 1e9), (40.0, 5.0)])
def test_a_line_to_a_far_place_ends_at_the_edge_of_the_picture(far: tuple[float, float]) -> None:
    cells: Cells = {}
    draw(cells, (5.0, 5.0), far, (1, 1, 1))
    assert cell_at(5.0, 5.0) in cells
    assert 60 < len(cells) < 200
