"""Page 05: the obstacle detector; its message first, then what it sees."""

from __future__ import annotations

import cmath
import math
import struct
from collections.abc import Iterable
from typing import Any

from ...turtlesim.obstacles import Circle
from ..recording import WORLD
from ..words import angle, count, number
from .assertions import agrees, learner_function, messages, no_errors, node, publishes, rate, returns, some
from .navigation import where
from .probe import Heard, Probe, interface
from .registry import Expectation, check, expectation
from .results import CannotLook, Seen, hinted

PAGE = "05_obstacle_detector"
SCAN, SCAN_TYPE = "/obstacles", "sensor_msgs/msg/LaserScan"
AHEAD, AHEAD_TYPE = "/nearest_ahead", "std_msgs/msg/Float32"

FAR = 10.0
"""What a beam reads that meets nothing, m."""

CLOSE = 0.05
"""How well a measured distance must agree, m."""


@check(
    PAGE, points=4, limit=20, learnt="A message can be of the right type and contradict itself; yours no longer does."
)
def scan() -> list[Expectation]:
    """A laser scan that is what it says it is."""
    fans = ((-1.0, 1.0, 0.5), (-math.pi, math.pi, math.pi / 2), (-1.5, 0.0, 0.5))
    rounded = ((0.0, 0.3, 0.1), (-0.5, 0.5, 0.001), (-2.0, 2.0, 0.1))
    return [
        node("/obstacle_detector", "ros2 run robot_controller obstacle_detector"),
        publishes(SCAN, SCAN_TYPE, by="/obstacle_detector"),
        rate(SCAN, SCAN_TYPE, hz=5, within=0.020),
        messages(SCAN, SCAN_TYPE, 'frame_id is "base_link"', _frame),
        messages(SCAN, SCAN_TYPE, "it looks from −90° to +90°", _angles),
        messages(SCAN, SCAN_TYPE, "a reading for every beam", _readings),
        messages(SCAN, SCAN_TYPE, "readings from 0 to 10 m", _ranges),
        _counts("other angles, other steps", fans),
        _counts("also where computers round", rounded),
        no_errors(),
    ]


@check(
    PAGE,
    points=4,
    limit=20,
    learnt="The place of a number in a scan says where it was measured, and angles say what matters.",
)
def nearest_ahead() -> list[Expectation]:
    """A node that says how far it is to the nearest thing ahead."""
    ours, wide, coarse = (-90, 90, 1), (-180, 179, 1), (-60, 60, 2)
    return [
        node("/lookout"),
        publishes(AHEAD, AHEAD_TYPE, by="/lookout"),
        _nearest("the task's example", [(ours, {-20: 2.0, -70: 1.0}, 2.0)]),
        _nearest("the nearest of several", [(ours, {-25: 3.0, 0: 2.5, 25: 4.0}, 2.5), (ours, {}, FAR)]),
        _nearest("beams at −29° and +29° count", [(ours, {side * 29: 1.5, side * 35: 1.0}, 1.5) for side in (-1, 1)]),
        _nearest("beams at −31° and +31° do not", [(ours, {side * 31: 1.5}, FAR) for side in (-1, 1)]),
        _nearest("scanners with other angles", [(wide, {28: 1.5, 150: 0.5}, 1.5), (coarse, {-28: 2.5, 32: 1.0}, 2.5)]),
        _says_ahead(),
        _keeps_quiet(),
        no_errors(),
    ]


@check(PAGE, points=5, limit=30, learnt="That is how simulators measure: a ray, a circle, and Pythagoras.")
def ray_cast() -> list[Expectation]:
    """A beam that knows where it meets a circle."""
    pi, root = math.pi, math.sqrt(18)
    beside = [((0, 0, 0.0, (5, 3, 5)), 1.0), ((0, 0, 0.0, (2, -0.6, 1)), 1.2), ((0, 0, pi / 2, (0.8, 3, 1)), 2.4)]
    elsewhere = [((5, 5, 0.0, (8, 5, 0.5)), 2.5), ((2, 8, -pi / 4, (5, 5, 1)), root - 1)]
    just = [((0, 0, 0.0, (3, 0.99, 1)), 3 - 0.141067), ((0, 0, 0.0, (3, -1.01, 1)), FAR)]
    return [
        node("/obstacle_detector"),
        publishes(SCAN, SCAN_TYPE, by="/obstacle_detector"),
        _meets("a circle straight ahead", [((0, 0, 0.0, (3, 0, 1)), 2.0), ((0, 0, pi, (-4, 0, 0.5)), 3.5)], 1),
        _meets("passed at the side", [((0, 0, pi / 2, (3, 0, 1)), FAR), ((0, 0, -0.5, (3, 0, 1)), FAR)], 2),
        _meets("it is behind", [((0, 0, pi, (3, 0, 1)), FAR), ((0, 0, 0.0, (-2, 0.5, 1)), FAR)], 2),
        _meets("beside the middle, on both sides", beside, 3),
        _meets("just met and just missed", just, 2),
        _meets("it starts inside", [((0, 0, 0.0, (0.5, 0, 1)), 0.0), ((0, 0, 2.0, (0.5, 0, 1)), 0.0)], 2),
        _meets("from another place", elsewhere, 1),
        _shows_the_circles(),
        no_errors(),
    ]


def _frame(heard: list[Heard]) -> Seen:
    frame = heard[-1].message.header.frame_id
    advice = "The header of a message says in which frame its numbers hold."
    return Seen(frame == "base_link", f'it is "{frame}"', advice)


def _angles(heard: list[Heard]) -> Seen:
    low, high = (float(getattr(heard[-1].message, name)) for name in ("angle_min", "angle_max"))
    good = abs(low + math.pi / 2) < 0.001 and abs(high - math.pi / 2) < 0.001
    return Seen(good, f"from {angle(low)} to {angle(high)}", "Angles are in radians: 90° is half of π.")


def _beams(message: Any) -> int:
    """How many readings a scan's angles ask for: both ends have one."""
    width = message.angle_max - message.angle_min
    step = message.angle_increment
    if not (step > 0 and math.isfinite(width / step)):
        raise CannotLook(f"angle_increment is {step:g}")
    return math.floor(width / step + 0.01) + 1  # the angles are 32-bit floats: a hair less than a whole number is one


def _readings(heard: list[Heard]) -> Seen:
    counts = {(len(each.message.ranges), _beams(each.message)) for each in heard}
    there, wanted = max(counts, key=lambda pair: abs(pair[0] - pair[1]))
    seen = f"{count(there, 'reading')}, and the angles ask for {wanted}"
    return Seen(there == wanted, seen, "Both ends have a beam, so there is one beam more than there are steps.")


def _ranges(heard: list[Heard]) -> Seen:
    readings = [float(each) for one in heard for each in one.message.ranges]
    if not readings:
        raise CannotLook("there is no reading")
    bad = [each for each in readings if not (0.0 <= each <= 10.0 + 1e-6 or each == math.inf)]
    if bad:
        return Seen(False, f"{number(bad[0])} m", "Keep readings within range_min and range_max.")
    return Seen(True, f"from {number(min(readings))} to {number(max(readings))} m")


@expectation("how_many: {expected}")
def _counts(probe: Probe, expected: str, fans: Iterable[tuple[float, float, float]]) -> Seen:
    """how_many gives the beams from one angle to another in such steps, also with the 32-bit angles of a message."""
    how_many = learner_function(probe, "how_many", "obstacle_detector_node.py")
    said = []
    for low, high, step in fans:
        exact = (low, high, step)
        for angles in (exact, struct.unpack("3f", struct.pack("3f", *exact))):
            fan = interface(SCAN_TYPE)()
            fan.angle_min, fan.angle_max, fan.angle_increment = angles
            came, wanted = probe.call(how_many, fan), round((high - low) / step) + 1
            words = f"from {low:.4g} to {high:.4g} in steps of {step:.4g}: {came!r}"
            if type(came) is not int or came != wanted:
                advice = "Count on your fingers for a small fan. A number of readings is a whole number."
                hint = "Open Hint 3." if came == wanted - 1 else "Open Hint 1 and Hint 2."
                return Seen(False, f"{words}, not {wanted}", hinted(advice, hint))
        said.append(words)
    return Seen(True, "; ".join(said))


Fan = tuple[int, int, int]
"""First and last angle and step of a scanner, in degrees."""


@expectation("{expected}")
def _nearest(probe: Probe, expected: str, examples: Iterable[tuple[Fan, dict[int, float], float]]) -> Seen:
    """nearest_ahead gives the smallest reading ahead; each example: a scanner, its near readings by their angle, the answer."""
    function = learner_function(probe, "nearest_ahead")
    words = ""
    for fan, near, wanted in examples:
        came = probe.call(function, _scan(fan, near))
        things = " and ".join(f"{reading:g} m at {at}°" for at, reading in near.items()) or "nothing near"
        others = "" if fan == (-90, 90, 1) else f" (beams from {fan[0]}° to {fan[1]}°, each {fan[2]}°)"
        words = f"{things}{others}: {came!r}"
        if not agrees(came, wanted, 1e-6):
            step = "At which angle does each of these beams point, and is that at most 30° to a side?"
            return Seen(False, f"{words}, not {wanted:g}", hinted(step, "Open Hint 2 and Hint 3 under the exercise."))
    return Seen(True, words)


def _scan(fan: Fan, near: dict[int, float]) -> Any:
    """A scan in which all beams read 10 m, but for these."""
    low, high, step = fan
    made = interface(SCAN_TYPE)()
    made.angle_min, made.angle_max, made.angle_increment = (math.radians(each) for each in fan)
    made.range_max = FAR
    made.ranges = [near.get(degree, FAR) for degree in range(low, high + 1, step)]
    return made


@expectation("an obstacle straight ahead is told")
def _says_ahead(probe: Probe) -> Seen:
    before, during = _put_at(probe, 0.0)
    seen = f"{number(during)} m, with its near side at {number(AWAY)} m; without it {number(before)} m"
    step = "Does the node say what nearest_ahead returns for each scan?"
    return Seen(abs(during - AWAY) <= CLOSE < before - AWAY, seen, step)


@expectation("one at the side is not")
def _keeps_quiet(probe: Probe) -> Seen:
    before, during = _put_at(probe, 75.0)
    seen = f"{number(during)} m, although one is {number(AWAY)} m away at the side; without it {number(before)} m"
    return Seen(abs(during - before) <= CLOSE, seen, "Leave out the beams that point more than 30° to a side.")


AWAY, RADIUS = 0.8, 0.3
"""How far the near side of the obstacle is that the check puts there, and how large that is (m)."""


def _put_at(probe: Probe, degrees: float) -> tuple[float, float]:
    """Put an obstacle in a direction. What was told before and with it (m)."""
    obstacle = _circle(where(probe), math.radians(degrees), AWAY + RADIUS, RADIUS)
    if not all(RADIUS * 2 < each < WORLD - RADIUS * 2 for each in (obstacle.x, obstacle.y)):
        raise CannotLook("the turtle stands too near to a wall: turn it to the middle first")

    def told() -> float:
        probe.wait(0.4)
        return float(some(probe, AHEAD, AHEAD_TYPE, 0.5)[-1].message.data)

    before = told()
    with probe.obstacles(obstacle):
        return before, told()


def _circle(pose: Any, turn: float, distance: float, radius: float) -> Circle:
    """A circle in a direction, as seen from a pose, and at a distance (m)."""
    bearing = pose.theta + turn
    return Circle(pose.x + distance * math.cos(bearing), pose.y + distance * math.sin(bearing), radius)


def _meets(expected: str, examples: Iterable[tuple[tuple[Any, ...], float]], hint: int) -> Expectation:
    """ray_circle gives these distances, m."""
    advice = hinted("Draw the beam and the circle on paper: where is the middle, seen along the beam?", hint)
    return returns("ray_circle", examples, expected, advice, within=1e-3)


@expectation("the scan shows the circles of the world")
def _shows_the_circles(probe: Probe) -> Seen:
    """Each beam of the newest scan ends at the nearest circle of the world, or reads 10 m."""
    circles = [each for each in probe.target.board.obstacles if isinstance(each, Circle)]
    if not circles:
        raise CannotLook("there is no circle in the world: run the cell that places them")
    pose = where(probe)
    probe.wait(0.25)
    message = some(probe, SCAN, SCAN_TYPE, 0.3)[-1].message
    if len(message.ranges) != _beams(message):
        raise CannotLook("the scan has not one reading for each beam")
    low, step = message.angle_min, message.angle_increment
    bearings = [low + i * step for i in range(len(message.ranges))]
    off, at, came = max(
        (abs(reading - _distance(pose, at, circles)), at, reading)
        for at, reading in zip(bearings, message.ranges, strict=True)
    )
    if off <= CLOSE:
        return Seen(True, f"{count(sum(each < FAR for each in message.ranges), 'beam')} see one")
    wanted = _distance(pose, at, circles)
    advice = "Are the circles of the node those of the world, and is ray_circle right?"
    return Seen(False, f"{number(came)} m at {angle(at)}, not {number(wanted)} m", advice)


def _distance(pose: Any, bearing: float, circles: Iterable[Circle]) -> float:
    """How far it is from a pose to the nearest circle in a direction, m."""
    met = [FAR]
    for each in circles:
        ahead = complex(each.x - pose.x, each.y - pose.y) * cmath.rect(1.0, -(pose.theta + bearing))
        if abs(ahead) <= each.radius:
            return 0.0
        if ahead.real > 0 and abs(ahead.imag) < each.radius:
            met.append(ahead.real - math.sqrt(each.radius**2 - ahead.imag**2))
    return min(met)


@expectation("goes on with three obstacles in sight")
def sees_three(probe: Probe) -> Seen:
    """With three pillars in the world, the scans go on and show three things or more."""
    pose = where(probe)
    with probe.obstacles(*(_circle(pose, turn, 1.0, 0.2) for turn in (-0.9, 0.0, 0.9))):
        probe.wait(0.5)
        heard = some(probe, SCAN, SCAN_TYPE, 2.0)
    near = [sum(each < 1.5 for each in one.message.ranges) for one in heard]
    seen = f"{count(len(heard), 'scan')} in 2 s, up to {count(max(near), 'near reading')} in one"
    return Seen(len(heard) >= 9 and max(near) >= 3, seen, "Does the detector still run?")
