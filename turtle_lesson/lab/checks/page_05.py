"""Page 05: the obstacle detector; its message first, then what it sees."""

from __future__ import annotations

import math
from typing import Any

from ...turtlesim.obstacles import Circle
from ..track import WORLD
from ..words import angle, count, number
from .drives import where
from .exam import Exam, Heard
from .fields import field
from .parts import no_errors, node, publishes
from .registry import Expectation, check
from .rows import CannotLook, Seen
from .streams import messages, rate, some

PAGE = "05_obstacle_detector"
SCAN, SCAN_TYPE = "/obstacles", "sensor_msgs/msg/LaserScan"
RUN = "ros2 run robot_controller obstacle_detector"
RADIUS = 0.3
AHEAD, AHEAD_TYPE = "/nearest_ahead", "std_msgs/msg/Float32"


@check("scan", page=PAGE, points=4, limit=20)
def scan() -> list[Expectation]:
    """A laser scan that is what it says it is."""
    return [
        node("/obstacle_detector", RUN),
        publishes(SCAN, SCAN_TYPE, by="/obstacle_detector"),
        rate(SCAN, SCAN_TYPE, hz=5),
        messages(SCAN, SCAN_TYPE, 'frame_id is "base_link"', _frame),
        messages(SCAN, SCAN_TYPE, "it looks from −90° to +90°", _angles),
        messages(SCAN, SCAN_TYPE, "a reading for every beam", _readings),
        messages(SCAN, SCAN_TYPE, "readings from 0 to 10 m", _ranges),
        no_errors(),
    ]


@check("nearest_ahead", page=PAGE, points=4, limit=20)
def nearest_ahead() -> list[Expectation]:
    """A node that says how far it is to the nearest thing ahead."""
    wide = "Look at all beams from −30° to +30°: beam i points to angle_min + i · angle_increment."
    return [
        node("/lookout"),
        publishes(AHEAD, AHEAD_TYPE, by="/lookout"),
        _says_ahead("an obstacle straight ahead is told", 0.0, wide),
        _says_ahead("one a little to the left, too", 20.0, wide),
        _says_ahead("one a little to the right, too", -20.0, wide),
        _keeps_quiet("one at the side is not", 75.0),
    ]


@check("ray_cast", page=PAGE, points=5, limit=30)
def ray_cast() -> list[Expectation]:
    """A scan that sees what stands around the turtle."""
    return [
        node("/obstacle_detector", RUN),
        publishes(SCAN, SCAN_TYPE, by="/obstacle_detector"),
        sees_an_obstacle(),
        forgets_it_again(),
    ]


# -- the message -------------------------------------------------------------------------------------------------------


def _frame(heard: list[Heard]) -> Seen:
    frame = field(heard[-1].message, "header.frame_id")
    return Seen(frame == "base_link", f'it is "{frame}"', 'scan.header.frame_id = "base_link".')


def _angles(heard: list[Heard]) -> Seen:
    low, high = (float(field(heard[-1].message, name)) for name in ("angle_min", "angle_max"))
    good = abs(low + math.pi / 2) < 0.001 and abs(high - math.pi / 2) < 0.001
    return Seen(good, f"from {angle(low)} to {angle(high)}", "angle_min, angle_max = -math.pi / 2, math.pi / 2.")


def beams(message: Any) -> int:
    """How many readings a scan's angles ask for: both ends have one."""
    width = field(message, "angle_max") - field(message, "angle_min")
    step = field(message, "angle_increment")
    if not (step > 0 and math.isfinite(width / step)):
        raise CannotLook(f"angle_increment is {step:g}")
    return math.floor(width / step + 0.01) + 1  # the angles are 32-bit floats: a hair less than a whole number is one


def _readings(heard: list[Heard]) -> Seen:
    counts = {(len(field(each.message, "ranges")), beams(each.message)) for each in heard}
    there, wanted = max(counts, key=lambda pair: abs(pair[0] - pair[1]))
    seen = f"{count(there, 'reading')}, and the angles ask for {wanted}"
    step = "Both ends have a beam, so there is one beam more than there are steps."
    return Seen(there == wanted, seen, step)


def _ranges(heard: list[Heard]) -> Seen:
    readings = [float(each) for one in heard for each in field(one.message, "ranges")]
    if not readings:
        raise CannotLook("there is no reading")
    bad = [each for each in readings if not (0.0 <= each <= 10.0 + 1e-6 or each == math.inf)]
    if bad:
        return Seen(False, f"{number(bad[0])} m", "Keep readings within range_min and range_max.")
    return Seen(True, f"from {number(min(readings))} to {number(max(readings))} m")


# -- what is ahead -----------------------------------------------------------------------------------------------------


def _says_ahead(expected: str, degrees: float, step: str) -> Expectation:
    """An obstacle that the check puts in this direction is what the node tells, to 5 cm."""

    def look(exam: Exam) -> Seen:
        distance, before, during = _put_ahead(exam, degrees)
        seen = f"{number(during)} m, with its near side at {number(distance)} m; without it {number(before)} m"
        return Seen(abs(during - distance) <= 0.05 < before - distance, seen, step)

    return Expectation(expected, look)


def _keeps_quiet(expected: str, degrees: float) -> Expectation:
    """An obstacle that the check puts in this direction changes nothing."""

    def look(exam: Exam) -> Seen:
        distance, before, during = _put_ahead(exam, degrees)
        seen = (
            f"{number(during)} m, although one is {number(distance)} m away at the side; without it {number(before)} m"
        )
        return Seen(abs(during - before) <= 0.05, seen, "Leave out the beams that point further aside than 30°.")

    return Expectation(expected, look)


def _put_ahead(exam: Exam, degrees: float) -> tuple[float, float, float]:
    """Put an obstacle in a direction. The distance of its near side, and what was told before and with it (m)."""
    pose = where(exam)
    turn, distance = pose.theta + math.radians(degrees), 0.8
    x, y = (start + way(turn) * (distance + RADIUS) for start, way in ((pose.x, math.cos), (pose.y, math.sin)))
    if not all(RADIUS * 2 < each < WORLD - RADIUS * 2 for each in (x, y)):
        raise CannotLook("the turtle stands too near to a wall: turn it to the middle first")
    before = _told(exam)
    with exam.obstacles(Circle(x, y, RADIUS)):
        during = _told(exam)
    return distance, before, during


def _told(exam: Exam) -> float:
    """What the node tells after a moment, m."""
    exam.wait(0.4)
    return float(field(some(exam, AHEAD, AHEAD_TYPE, 0.5)[-1].message, "data"))


# -- what it sees ------------------------------------------------------------------------------------------------------


def sees_an_obstacle() -> Expectation:
    """An obstacle that the check puts beside the turtle is where the scan says, to 5 cm."""

    def look(exam: Exam) -> Seen:
        bearing, distance, before, during, _ = _surprise(exam)
        seen = f"{number(during)} m at {angle(bearing)}; without it {number(before)} m"
        step = "For each beam: from the turtle's pose, along theta + its angle, to the nearest thing it meets."
        return Seen(abs(during - distance) <= 0.05 < before - distance, seen, step)

    return Expectation("an obstacle put there is measured", look)


def forgets_it_again() -> Expectation:
    """When the obstacle is taken away, the scan says so."""

    def look(exam: Exam) -> Seen:
        _, distance, before, _, after = _surprise(exam)
        seen = f"{number(after)} m again, as before" if abs(after - before) < 0.01 else f"{number(after)} m"
        step = "Every message on /world/obstacles replaces what was there before."
        return Seen(after > distance + 0.05 and abs(after - before) <= 0.05, seen, step)

    return Expectation("taken away, it is gone", look)


def _surprise(exam: Exam) -> tuple[float, float, float, float, float]:
    """Put an obstacle beside the turtle and take it away. Its bearing (rad) and distance, and the reading
    before, with and after it (m)."""
    return exam.once("surprise", lambda: _put_and_take(exam))


def _put_and_take(exam: Exam) -> tuple[float, float, float, float, float]:
    pose = where(exam)
    bearing, distance = _free_direction(pose)
    x, y = (way(pose.theta + bearing) * (distance + RADIUS) for way in (math.cos, math.sin))
    before = _reading(exam, bearing)
    with exam.obstacles(Circle(pose.x + x, pose.y + y, RADIUS)):
        during = _reading(exam, bearing)
    return bearing, distance, before, during, _reading(exam, bearing)


def _free_direction(pose: Any) -> tuple[float, float]:
    """Where an obstacle can stand within the world: bearing (rad), and distance of its near side (m)."""
    for distance in (1.2, 0.6):
        for degrees in (40, -40, 0, 75, -75):
            turn = pose.theta + math.radians(degrees)
            places = (pose.x + distance * math.cos(turn), pose.y + distance * math.sin(turn))
            if all(RADIUS * 2 < each < WORLD - RADIUS * 2 for each in places):
                return math.radians(degrees), distance
    raise CannotLook("the turtle stands with its nose to a wall: turn it to the middle first")


def _reading(exam: Exam, bearing: float) -> float:
    """What the newest scan says in a direction, m."""
    exam.wait(0.4)
    message = some(exam, SCAN, SCAN_TYPE, 0.5)[-1].message
    index = round((bearing - field(message, "angle_min")) / field(message, "angle_increment")) if beams(message) else 0
    ranges = field(message, "ranges")
    if not 0 <= index < len(ranges):
        raise CannotLook(f"the scan has no beam at {angle(bearing)}")
    return float(ranges[index])


def sees_three() -> Expectation:
    """With three pillars in the world, the scans go on and show three things or more."""

    def look(exam: Exam) -> Seen:
        pose = where(exam)
        around = (Circle(pose.x + 1.0 * math.cos(pose.theta + turn), pose.y + 1.0 * math.sin(pose.theta + turn), 0.2)
                  for turn in (-0.9, 0.0, 0.9))  # fmt: skip
        with exam.obstacles(*around):
            exam.wait(0.5)
            heard = some(exam, SCAN, SCAN_TYPE, 2.0)
        near = [sum(each < 1.5 for each in field(one.message, "ranges")) for one in heard]
        seen = f"{count(len(heard), 'scan')} in 2 s, {min(near)} near readings in the emptiest"
        return Seen(len(heard) >= 9 and min(near) >= 3, seen, "Does the detector still run?")

    return Expectation("goes on with three obstacles in sight", look)
