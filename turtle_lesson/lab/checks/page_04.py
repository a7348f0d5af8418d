"""Page 04: the status monitor, its battery, and a node that watches the battery."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable
from dataclasses import dataclass

from ..words import angle, count, number, turned
from .assertions import no_errors, node, publishes, subscribes
from .graph_view import field
from .navigation import COMMAND_TYPE, COMMANDS, POSE, POSE_TYPE
from .probe import Heard, Probe, remembered
from .registry import Expectation, check, expectation
from .results import CannotLook, Seen, hinted
from .streams import rate, some

STATUS, STATUS_TYPE = "/robot/status", "robot_controller/msg/TurtleStatus"
RUN = "ros2 run robot_controller status_monitor"

DROP = 0.1
"""Percent that one message costs."""

SPEED, TURN = 0.5, 1.6
"""The turtle is driven so fast, m/s and rad/s: a whole circle, 0.6 m wide, in the time below."""
CIRCLE = 4.0
"""How long that takes, s."""

LATE = 0.1
"""How far a status may be off the newest pose: m, and m/s. At this speed it may be 0.1 s old and more."""

LOW, LOW_TYPE = "/robot/battery_low", "std_msgs/msg/Bool"
LOW_BELOW = 20.0
"""Percent: below this a battery is low."""


@check("battery", points=3, limit=125, learnt="A timer's callback publishes the state, then brings it up to date.")
def battery() -> list[Expectation]:
    """A status ten times a second, with a battery that runs down."""
    return [
        node("/status_monitor"),
        publishes(STATUS, STATUS_TYPE, by="/status_monitor"),
        rate(STATUS, STATUS_TYPE, hz=10),
        battery_starts_full,
        battery_falls(until_it_is_empty, 1),
        battery_ends_at_zero,
        no_errors(),
    ]


@check(
    "status_monitor",
    points=5,
    limit=25,
    learnt="Your monitor reports what the sensor says, along the axes that others expect.",
)
def status_monitor() -> list[Expectation]:
    """The status monitor tells ten times a second what the turtle really does."""
    return [
        node("/status_monitor", RUN),
        publishes(STATUS, STATUS_TYPE, by="/status_monitor"),
        rate(STATUS, STATUS_TYPE, hz=10),
        pose_follows,
        velocity_follows("x", math.cos),
        velocity_follows("y", math.sin),
        no_velocity_at_rest,
        battery_falls(a_while),
        no_errors(),
    ]


@check("battery_watch", points=3, limit=20, learnt="A node can turn one stream into another that is easier to use.")
def battery_watch() -> list[Expectation]:
    """A node that hears the status, and says whether the battery is low."""
    return [
        node("/battery_watch"),
        subscribes(STATUS, STATUS_TYPE, by="/battery_watch"),
        publishes(LOW, LOW_TYPE, by="/battery_watch"),
        says_low("False from 20 % on", (100.0, 50.0, 20.5, 20.0)),
        says_low("True below 20 %", (19.5, 10.0, 0.0)),
        says_low("False again when the battery is full again", (15.0, 100.0)),
        silent_without_status,
        no_errors(),
    ]


# -- a ride: the turtle is driven, and the status should follow ------------------------------------------------------------


@dataclass
class Ride:
    """What was heard while the turtle drove a circle, and in the second after it."""

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


@remembered
def ride(probe: Probe) -> Ride:
    """Drive the turtle in a circle. Raises CannotLook where nothing is heard, or the turtle does not move."""
    poses, statuses = probe.listen(POSE, POSE_TYPE), probe.listen(STATUS, STATUS_TYPE)
    probe.wait(0.3)
    began, first_pose, first_status = probe.now, len(poses), len(statuses)
    for _ in range(round(10 * CIRCLE)):
        probe.publish(COMMANDS, COMMAND_TYPE, linear__x=SPEED, angular__z=TURN)
        probe.wait(0.1)
    probe.publish(COMMANDS, COMMAND_TYPE)
    ended = probe.now
    probe.wait(1.0)
    found = Ride(began, ended, poses[first_pose:], statuses[first_status:])
    xs = [each.message.x for each in found.poses] or [0.0]
    if max(xs) - min(xs) < 0.1:
        raise CannotLook(f"the turtle does not move when {COMMANDS} says so: is the simulator running?")
    if not found.pairs():
        raise CannotLook(f"no message came on {STATUS} while the turtle drove")
    return found


@expectation("x, y, theta follow the turtle")
def pose_follows(probe: Probe) -> Seen:
    """x, y and theta are those of the turtle, also while it moves."""
    pairs = [(status.message, pose.message) for status, pose in ride(probe).pairs()]
    away = {name: max(abs(field(a, name) - field(b, name)) for a, b in pairs) for name in ("x", "y")}
    off = max(abs(turned(field(a, "theta") - b.theta)) for a, b in pairs)
    seen = f"at most {number(away['x'])} m off in x, {number(away['y'])} m in y, {angle(off)} in theta"
    advice = f"Keep what the newest message on {POSE} says, all three fields of it."
    return Seen(max(away.values()) <= LATE and off <= 2 * LATE, seen, advice)


def velocity_follows(axis: str, part: Callable[[float], float]) -> Expectation:
    """vel_x or vel_y is the speed along that axis of the map, all around a circle; `part` is the cosine or the sine."""

    def look(probe: Probe) -> Seen:
        it = ride(probe)
        driving = [(status, pose.message) for status, pose in it.pairs() if it.began + 0.3 < status.at < it.ended]
        if not driving:
            raise CannotLook(f"no message came on {STATUS} while the turtle drove")
        told = [
            (float(field(status.message, f"vel_{axis}")), pose.linear_velocity * part(pose.theta), pose.theta)
            for status, pose in driving
        ]
        said, right, heading = max(told, key=lambda each: _off(each[0], each[1]))
        good = _off(said, right) <= LATE
        seen = f"{number(said)} m/s where {number(right)} m/s is right: {number(SPEED)} m/s at {angle(heading)}"
        if good:
            seen = f"right in all {count(len(told), 'message')} of a circle"
        other = "y" if axis == "x" else "x"
        advice = hinted(
            f"How much of the speed goes along {axis}, and how much along {other}? Try 0, π/2 and π in your head.", 2
        )
        return Seen(good, seen, advice)

    return Expectation(f"vel_{axis} follows the turtle", look)


def _off(said: float, wanted: float) -> float:
    """How far a value is off; one that is no number is infinitely far off."""
    return abs(said - wanted) if math.isfinite(said) else math.inf


@expectation("both are 0 when the turtle stands")
def no_velocity_at_rest(probe: Probe) -> Seen:
    """Both components are 0 again when the turtle stands."""
    it = ride(probe)
    at_rest = [each.message for each in it.statuses if each.at > it.ended + 0.3]
    if not at_rest:
        raise CannotLook(f"no message came on {STATUS} when the turtle stood")
    velocity = [float(field(at_rest[-1], name)) for name in ("vel_x", "vel_y")]
    seen = f"vel_x {number(velocity[0])} m/s, vel_y {number(velocity[1])} m/s"
    advice = "Use the speed that the pose tells, not a number of your own."
    return Seen(all(abs(each) < 0.05 for each in velocity), seen, advice)


# -- the battery -----------------------------------------------------------------------------------------------------------


@expectation("battery starts at 100 %")
def battery_starts_full(probe: Probe) -> Seen:
    """The first message that is heard has as much charge as it can have by then."""
    some(probe, STATUS, STATUS_TYPE, 0.5)
    first = probe.listen(STATUS, STATUS_TYPE)[0]
    charge = float(field(first.message, "battery"))
    by_then = max(0.0, 100.0 - 10 * DROP * (first.at + 0.2))
    seen = f"{number(charge, 1)} % after {number(first.at, 1)} s"
    advice = "The first status says 100: publish first, take away afterwards."
    return Seen(by_then - 1e-3 <= charge <= 100.0 + 1e-3, seen, advice)


def battery_falls(heard: Callable[[Probe], list[Heard]], hint: int | str = "") -> Expectation:
    """Each message has 0.1 less than the one before, or 0; `hint` is the number of one under the exercise."""

    def look(probe: Probe) -> Seen:
        charges = [float(field(each.message, "battery")) for each in heard(probe)]
        if len(charges) < 2:
            raise CannotLook("one message shows no change")
        wrong = [
            (before, after)
            for before, after in itertools.pairwise(charges)
            if not abs(max(0.0, before - DROP) - after) <= 1e-3
        ]
        if not wrong:
            return Seen(True, f"from {number(charges[0], 1)} to {number(charges[-1], 1)}")
        before, after = wrong[0]
        advice = hinted(
            "Once for each message that is published, the battery becomes 0.1 less than it was, but not less than 0.",
            hint,
        )
        return Seen(False, f"{number(before)} %, and in the next message {number(after)} %", advice)

    return Expectation(f"battery falls by {DROP:g} a message", look)


def a_while(probe: Probe) -> list[Heard]:
    """What was heard of the status until now, 3 s of it at least."""
    some(probe, STATUS, STATUS_TYPE, 3.0)
    return probe.listen(STATUS, STATUS_TYPE)


@remembered
def until_it_is_empty(probe: Probe) -> list[Heard]:
    """What is heard of the status until the battery has been empty for a second."""
    some(probe, STATUS, STATUS_TYPE, 0.5)
    heard = probe.listen(STATUS, STATUS_TYPE)
    probe.wait_for(lambda: float(field(heard[-1].message, "battery")) < DROP / 2, 102.0)
    probe.wait(1.0)
    return heard


@expectation("battery ends at 0, never below")
def battery_ends_at_zero(probe: Probe) -> Seen:
    """However much time passes, the battery stays from 0 to 100, and at the end it is 0."""
    charges = [float(field(each.message, "battery")) for each in until_it_is_empty(probe)]
    seen = f"from {number(max(charges), 1)} to {number(min(charges), 1)}, at the end {number(charges[-1], 1)}"
    good = min(charges) >= 0.0 and max(charges) <= 100.0 and charges[-1] < DROP / 2
    below = min(charges) < 0
    advice = "What should 0.0 minus 0.1 become?" if below else "It should run down to 0.0, and stay there."
    return Seen(good, seen, hinted(advice, 2))


# -- the watch -------------------------------------------------------------------------------------------------------------


def says_low(expected: str, charges: tuple[float, ...]) -> Expectation:
    """Each status with one of these charges is answered by one Bool, and by the right one."""

    def look(probe: Probe) -> Seen:
        answers = _answers(probe)
        for charge in charges:
            before = len(answers)
            probe.publish(STATUS, STATUS_TYPE, battery=charge)
            probe.wait_for(lambda before=before: len(answers) > before, 1.0)  # type: ignore[misc]
            probe.wait(0.05)
            said = [each.message.data for each in answers[before:]]
            if not said:
                probe.raise_error()
                hint = hinted("on_status must publish, whatever the charge is.", "Open Hint 2.")
                return Seen(False, f"{charge:g} %: nothing came within 1 s", hint)
            if len(said) > 1:
                step = "One status in, one Bool out: is there a second publish?"
                return Seen(False, f"{charge:g} %: {count(len(said), 'message')} came instead of one", step)
            if said[0] is not (charge < LOW_BELOW):
                hint = hinted(f"Try the three examples in your head: 100, {LOW_BELOW:g} and 19.5.", "Open Hint 2.")
                return Seen(False, f"{charge:g} %: it said {said[0]}", hint)
        return Seen(True, ", ".join(f"{charge:g} → {charge < LOW_BELOW}" for charge in charges))

    return Expectation(expected, look)


@expectation("without a status it says nothing")
def silent_without_status(probe: Probe) -> Seen:
    """Nothing is published while no status comes."""
    answers = _answers(probe)
    before = len(answers)
    probe.wait(1.0)
    heard = answers[before:]
    advice = "Publish in on_status and nowhere else; no timer is needed."
    return Seen(not heard, f"{count(len(heard), 'message')} in 1 s", advice)


def _answers(probe: Probe) -> list[Heard]:
    """What the watch says from now on. Raises CannotLook where it cannot be asked."""
    others = probe.publishers(STATUS)
    if others:
        raise CannotLook(f"{others[0][0]} publishes {STATUS}: stop it first")
    if not probe.subscriptions(STATUS):
        raise CannotLook(f"no node listens to {STATUS}")
    return probe.listen(LOW, LOW_TYPE)
