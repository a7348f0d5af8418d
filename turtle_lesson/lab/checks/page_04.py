"""Page 04: the status monitor, its battery, and a node that watches the battery."""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass

from ..words import number, turned
from .drives import COMMAND_TYPE, COMMANDS, POSE, POSE_TYPE
from .exam import Exam, Heard
from .fields import field
from .parts import no_errors, node, publishes, subscribes
from .registry import Expectation, check
from .rows import CannotLook, Seen
from .streams import messages, rate, relays, some

PAGE = "04_status_monitor"
STATUS, STATUS_TYPE = "/robot/status", "robot_controller/msg/TurtleStatus"
RUN = "ros2 run robot_controller status_monitor"

DROP = 0.1
"""Percent that one message costs."""

LATE = 0.1
"""How far a status may be behind the pose, m and rad: at 1 m/s that is 0.1 s."""


LOW, LOW_TYPE = "/robot/battery_low", "std_msgs/msg/Bool"
LOW_BELOW = 20.0
"""Percent: below this a battery is low."""


@check("battery", page=PAGE, points=3, limit=120)
def battery() -> list[Expectation]:
    """A status ten times a second, with a battery that runs down."""
    return [
        node("/status_monitor", RUN),
        publishes(STATUS, STATUS_TYPE, by="/status_monitor"),
        rate(STATUS, STATUS_TYPE, hz=10),
        messages(STATUS, STATUS_TYPE, f"battery falls by {DROP:g} a message", _falls, 3.0),
        battery_ends_at_zero(),
        no_errors(),
    ]


@check("status_monitor", page=PAGE, points=5, limit=140)
def status_monitor() -> list[Expectation]:
    """The status monitor tells ten times a second what the turtle really does."""
    return [
        node("/status_monitor", RUN),
        publishes(STATUS, STATUS_TYPE, by="/status_monitor"),
        rate(STATUS, STATUS_TYPE, hz=10),
        pose_follows(),
        velocity_follows(),
        messages(STATUS, STATUS_TYPE, f"battery falls by {DROP:g} a message", _falls, 3.0),
        battery_ends_at_zero(),
        no_errors(),
    ]


@check("battery_watch", page=PAGE, points=3, limit=20)
def battery_watch() -> list[Expectation]:
    """A node that hears the status, and says whether the battery is low."""
    pairs = [
        (
            {"battery": charge},
            lambda message, low=charge < LOW_BELOW: message.data == low,
            f"{charge:g} → {charge < LOW_BELOW}",
        )
        for charge in (100.0, 19.5, 20.0, 0.0)
    ]
    step = f"In on_status publish Bool(data=status.battery < {LOW_BELOW:g}), once for each status."
    return [
        node("/battery_watch"),
        subscribes(STATUS, STATUS_TYPE, by="/battery_watch"),
        publishes(LOW, LOW_TYPE, by="/battery_watch"),
        relays(STATUS, STATUS_TYPE, LOW, LOW_TYPE, pairs, step),
        no_errors(),
    ]


# -- a ride: the turtle is driven, and the status should follow ------------------------------------------------------------


@dataclass
class Ride:
    """What was heard while the turtle drove a piece of a circle (1 m/s, 1.5 rad/s), and in the second after it."""

    began: float
    ended: float
    poses: list[Heard]
    statuses: list[Heard]

    def pairs(self) -> list[tuple[Heard, Heard]]:
        """Each status, with the last pose before it."""
        return [
            (status, pose)
            for status in self.statuses
            if (pose := next((each for each in reversed(self.poses) if each.at <= status.at), None))
        ]


def ride(exam: Exam) -> Ride:
    """Drive the turtle for a second. Raises CannotLook where nothing is heard, or the turtle does not move."""
    return exam.once("ride", lambda: _ride(exam))


def _ride(exam: Exam) -> Ride:
    poses, statuses = exam.listen(POSE, POSE_TYPE), exam.listen(STATUS, STATUS_TYPE)
    exam.wait(0.3)
    began, first_pose, first_status = exam.now, len(poses), len(statuses)
    for _ in range(10):
        exam.publish(COMMANDS, COMMAND_TYPE, linear__x=1.0, angular__z=1.5)
        exam.wait(0.1)
    exam.publish(COMMANDS, COMMAND_TYPE)
    ended = exam.now
    exam.wait(1.0)
    found = Ride(began, ended, poses[first_pose:], statuses[first_status:])
    xs = [each.message.x for each in found.poses] or [0.0]
    if max(xs) - min(xs) < 0.1:
        raise CannotLook(f"the turtle does not move when {COMMANDS} says so: is the simulator running?")
    return found


def pose_follows() -> Expectation:
    """x, y and theta are those of the turtle, also while it moves."""

    def look(exam: Exam) -> Seen:
        pairs = [(status.message, pose.message) for status, pose in ride(exam).pairs()]
        if not pairs:
            raise CannotLook(f"no message came on {STATUS} while the turtle drove")
        away = max(math.hypot(field(a, "x") - b.x, field(a, "y") - b.y) for a, b in pairs)
        off = max(abs(turned(field(a, "theta") - b.theta)) for a, b in pairs)
        seen = f"at most {number(away)} m and {number(off)} rad behind"
        step = f"Subscribe to {POSE}, keep the newest message, and report its x, y and theta."
        return Seen(away <= LATE and off <= 2 * LATE, seen, step)

    return Expectation("x, y, theta follow the turtle", look)


def velocity_follows() -> Expectation:
    """vel_x and vel_y make the speed that the turtle has, and are zero when it stands."""

    def look(exam: Exam) -> Seen:
        it = ride(exam)
        speeds = [
            (each.at, math.hypot(field(each.message, "vel_x"), field(each.message, "vel_y"))) for each in it.statuses
        ]
        driving = [speed for at, speed in speeds if it.began + 0.3 < at < it.ended]
        standing = [speed for at, speed in speeds if at > it.ended + 0.3]
        if not driving or not standing:
            raise CannotLook(f"too few messages came on {STATUS} while the turtle drove")
        seen = f"{number(driving[-1])} m/s while it drove 1 m/s, {number(standing[-1])} m/s when it stood"
        good = all(abs(speed - 1.0) < 0.1 for speed in driving) and all(speed < 0.05 for speed in standing)
        return Seen(good, seen, "pose.linear_velocity times the cosine and the sine of pose.theta.")

    return Expectation("vel_x, vel_y follow the turtle", look)


# -- the battery -----------------------------------------------------------------------------------------------------------


def _falls(heard: list[Heard]) -> Seen:
    charges = [float(field(each.message, "battery")) for each in heard]
    if len(charges) < 2:
        raise CannotLook("one message shows no change")
    wrong = [
        after - before for before, after in itertools.pairwise(charges) if abs(max(0.0, before - DROP) - after) > 1e-3
    ]
    if wrong:
        return Seen(
            False,
            f"a change of {number(wrong[0], 3)}",
            "Take 0.1 from the battery with each message: max(0.0, battery - 0.1).",
        )
    return Seen(True, f"from {number(charges[0], 1)} to {number(charges[-1], 1)}")


def battery_ends_at_zero() -> Expectation:
    """However long it is waited for, the battery stays from 0 to 100."""

    def look(exam: Exam) -> Seen:
        some(exam, STATUS, STATUS_TYPE, 0.5)
        heard = exam.listen(STATUS, STATUS_TYPE)
        exam.wait_for(lambda: float(field(heard[-1].message, "battery")) < DROP / 2, 102.0)
        exam.wait(1.0)
        charges = [float(field(each.message, "battery")) for each in heard]
        seen = f"from {number(max(charges), 1)} to {number(min(charges), 1)}"
        good = min(charges) >= 0.0 and max(charges) <= 100.0
        return Seen(good and min(charges) < DROP / 2, seen, "max(0.0, …) keeps it from falling below zero.")

    return Expectation("battery ends at 0, never below", look)
