"""The navigator's control law, driving a little model of the turtle: no ROS, no clock.

The model moves as turtlesim does, heading first, in steps of 16 ms, between the same walls. It gets a command
ten times a second, and each takes effect after a delay.
"""

import math
from dataclasses import dataclass, field
from types import SimpleNamespace

import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from node_files import load_node

navigator = load_node("navigator_node")
Limits, Phase = navigator.Limits, navigator.Phase

WORLD = navigator.WORLD_SIZE
MIDDLE = WORLD / 2
STEP = 0.016
USUAL = Limits(*(default for name, default, *_ in navigator.PARAMETERS if name in Limits._fields))
DELAYS = (0.0, 0.016, 0.03, 0.05, 0.1)


@dataclass
class Turtle:
    """A turtle that does what it is told, a little late."""

    x: float
    y: float
    theta: float
    delay: float = 0.0
    time: float = 0.0
    wall_hits: int = 0
    _coming: list = field(default_factory=list)
    _command: tuple[float, float] = (0.0, 0.0)

    def obey(self, command):
        self._coming.append((self.time + self.delay, command[:2]))

    def live(self, until):
        while self.time < until - 1e-9:
            while self._coming and self._coming[0][0] <= self.time + 1e-9:
                self._command = self._coming.pop(0)[1]
            self._step()

    def _step(self):
        linear, angular = self._command
        self.theta = math.remainder(self.theta + angular * STEP, math.tau)
        x, y = self.x + linear * math.cos(self.theta) * STEP, self.y + linear * math.sin(self.theta) * STEP
        self.x, self.y = min(max(x, 0.0), WORLD), min(max(y, 0.0), WORLD)
        self.wall_hits += (x, y) != (self.x, self.y)
        self.time += STEP


def place(x, y, theta=0.0):
    return SimpleNamespace(x=x, y=y, theta=theta)


def drive(turtle, goal, limits=USUAL, longest=60.0):
    """Steer as the node does: until the law says THERE and the turtle, at rest, is within the tolerances.

    Returns the commands that moved it.
    """
    commands, turning = [], 0.0
    while turtle.time < longest:
        command = navigator.steer(turtle, goal, limits, turning)
        turning = command.angular
        turtle.obey(command)
        turtle.live(turtle.time + navigator.STEERING_PERIOD)
        if command.phase is not Phase.THERE:
            commands.append(command)
        elif navigator.reached(turtle, goal, limits):
            return commands
    raise AssertionError(f"not there after {longest} s: {turtle} on the way to {goal}")


def longest_time(turtle, goal, limits):
    """A generous bound: the way and two half turns at full speed, and 2 s for each of three gentle ends."""
    distance, _ = navigator.errors(turtle, goal)
    return 1.1 * distance / limits.linear_speed + math.tau / limits.angular_speed + 6.0


coordinates = st.floats(0.0, WORLD)
headings = st.floats(-math.pi, math.pi)
places = st.builds(place, coordinates, coordinates, headings)


@given(start=places, goal=places, delay=st.sampled_from(DELAYS))
@example(start=place(MIDDLE, MIDDLE, math.pi), goal=place(1.0, MIDDLE, math.pi), delay=0.016)  # due west
@example(start=place(MIDDLE, MIDDLE, -math.pi), goal=place(1.0, MIDDLE, -math.pi), delay=0.016)
@example(start=place(MIDDLE, MIDDLE, 3.0), goal=place(1.0, MIDDLE - 0.5, -3.0), delay=0.016)
@example(start=place(MIDDLE, MIDDLE, 0.0), goal=place(1.0, MIDDLE, 0.0), delay=0.016)  # straight behind
@example(start=place(0.0, 0.0, math.pi), goal=place(WORLD, WORLD, math.pi), delay=0.1)  # corner to corner
@example(start=place(1.0, 1.0, 0.0), goal=place(1.0, 7.0, 2.0), delay=0.1)  # once swung to and fro for ever
@example(start=place(MIDDLE, WORLD, 0.0), goal=place(MIDDLE + 0.3, WORLD, 0.0), delay=0.0)  # along a wall
def test_every_goal_is_reached_from_everywhere_in_bounded_time(start, goal, delay):
    turtle = Turtle(start.x, start.y, start.theta, delay)
    commands = drive(turtle, goal, longest=longest_time(start, goal, USUAL))
    distance, turn = navigator.errors(turtle, goal)
    assert distance <= USUAL.goal_tolerance and abs(turn) <= USUAL.heading_tolerance
    for command in commands:
        assert 0.0 <= command.linear <= USUAL.linear_speed
        assert abs(command.angular) <= USUAL.angular_speed


@given(start=places, goal=places, delay=st.sampled_from(DELAYS[:3]))
def test_it_ends_within_five_centimetres_and_four_degrees(start, goal, delay):
    turtle = Turtle(start.x, start.y, start.theta, delay)
    drive(turtle, goal)
    distance, turn = navigator.errors(turtle, goal)
    assert distance <= 0.05 and abs(turn) <= math.radians(4)


@given(
    start=places,
    goal=places,
    linear=st.floats(0.1, 10.0),
    angular=st.floats(0.3, 10.0),
    near=st.floats(0.02, 2.0),
    turned=st.floats(0.02, math.pi),
)
def test_other_speeds_and_tolerances_work_as_well(start, goal, linear, angular, near, turned):
    limits = Limits(linear, angular, near, turned)
    turtle = Turtle(start.x, start.y, start.theta, delay=0.016)
    drive(turtle, goal, limits, longest=longest_time(start, goal, limits))
    assert navigator.reached(turtle, goal, limits)


inside = st.floats(1.0, WORLD - 1.0)
inner_places = st.builds(place, inside, inside, headings)


@given(start=inner_places, goal=inner_places, delay=st.sampled_from(DELAYS))
def test_a_way_a_metre_inside_the_walls_never_touches_them(start, goal, delay):
    turtle = Turtle(start.x, start.y, start.theta, delay)
    drive(turtle, goal)
    assert turtle.wall_hits == 0


def test_it_turns_then_drives_then_turns_to_the_heading():
    turtle = Turtle(MIDDLE, MIDDLE, 0.0)
    phases = [command.phase for command in drive(turtle, place(MIDDLE, 9.0, 0.0))]
    assert list(dict.fromkeys(phases)) == [Phase.TURN, Phase.DRIVE, Phase.ALIGN]
    assert phases == sorted(phases, key=list(Phase).index)


def test_a_goal_at_its_own_place_needs_no_command():
    assert drive(Turtle(3.0, 4.0, 1.0), place(3.0, 4.0, 1.0)) == []


def test_a_goal_at_its_own_place_with_another_heading_is_turned_to_on_the_spot():
    turtle = Turtle(3.0, 4.0, 1.0)
    commands = drive(turtle, place(3.0, 4.0, -2.5))
    assert {command.phase for command in commands} == {Phase.ALIGN}
    assert (turtle.x, turtle.y) == (3.0, 4.0)


def test_a_turtle_that_is_carried_away_while_aligning_drives_again():
    goal = place(5.0, 5.0, 1.0)
    assert navigator.steer(place(5.0, 5.0, 0.0), goal, USUAL).phase is Phase.ALIGN
    assert navigator.steer(place(4.0, 5.0, 0.0), goal, USUAL).phase is Phase.DRIVE


def test_across_due_west_it_turns_the_short_way():
    goal = place(0.0, 4.9, 0.0)  # its bearing is -3.12: 0.06 rad on, not 6.2 back
    command = navigator.steer(place(5.0, 5.0, 3.1), goal, USUAL)
    assert command.phase is Phase.DRIVE and 0.0 < command.angular < 0.5


@pytest.mark.parametrize(
    ("angle", "wrapped"), [(0.0, 0.0), (4.0, 4.0 - math.tau), (-4.0, math.tau - 4.0), (20 * math.pi + 1, 1.0)]
)
def test_wrap_keeps_the_direction(angle, wrapped):
    assert navigator.wrap(angle) == pytest.approx(wrapped, abs=1e-12)


def test_the_nearest_goal_takes_less_than_two_seconds():
    turtle = Turtle(MIDDLE, MIDDLE, 0.0, delay=0.016)
    drive(turtle, place(MIDDLE + 1.0, MIDDLE, 0.0))
    assert turtle.time < 2.0


WALL_AS_FLOAT32 = 11.08888912200927734375


@pytest.mark.parametrize("x", [0.0, 5.0, WORLD, WALL_AS_FLOAT32])
def test_goals_up_to_the_walls_are_accepted(x):
    assert navigator.refusal(place(x, WORLD - x if x < WORLD else 0.0, 100.0)) is None


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf])
@pytest.mark.parametrize("name", ["x", "y", "theta"])
def test_a_goal_that_is_no_number_is_refused(name, value):
    goal = place(5.0, 5.0, 0.0)
    setattr(goal, name, value)
    assert f"{name}={value}" in navigator.refusal(goal)
    assert "finite" in navigator.refusal(goal)


@pytest.mark.parametrize(("x", "y"), [(-0.01, 5.0), (5.0, -1.0), (11.1, 5.0), (5.0, 1e30)])
def test_a_goal_outside_the_world_is_refused_with_its_bounds(x, y):
    assert "outside the world: x and y must be from 0 to 11.09" in navigator.refusal(place(x, y))


def test_the_nearest_reading_ignores_what_is_not_valid():
    scan = SimpleNamespace(range_min=0.1, range_max=10.0, ranges=[math.nan, 0.0, math.inf, 7.0, 0.5, 12.0])
    assert navigator.nearest(scan, within=20.0) == 0.5
    assert navigator.nearest(scan, within=0.5) is None
    scan.ranges = [math.nan, 12.0]
    assert navigator.nearest(scan, within=20.0) is None
