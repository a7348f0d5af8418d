"""Page 04: the status monitor, its battery, and a node that watches the battery."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable

from ..words import angle, count, number, turned
from .assertions import no_errors, node, publishes, rate, some, subscribes
from .navigation import POSE, circle
from .probe import Heard, Probe, remembered
from .registry import Expectation, check, expectation
from .results import CannotLook, Seen, hinted

PAGE = "04_status_monitor"
STATUS, STATUS_TYPE = "/robot/status", "robot_controller/msg/TurtleStatus"
RUN = "ros2 run robot_controller status_monitor"

DROP = 0.1
"""Percent that one message costs."""

LATE = 0.1
"""How far a status may be off the newest pose: m, and m/s. At the speed of the ride it may be 0.1 s old and more."""

LOW, LOW_TYPE = "/robot/battery_low", "std_msgs/msg/Bool"


def status_comes(start: str = "") -> list[Expectation]:
    """The monitor, which `start` starts, and ten statuses a second."""
    return [
        node("/status_monitor", start),
        publishes(STATUS, STATUS_TYPE, by="/status_monitor"),
        rate(STATUS, STATUS_TYPE, hz=10),
    ]


@check(PAGE, points=3, limit=125, learnt="A timer's callback publishes the state, then brings it up to date.")
def battery() -> list[Expectation]:
    """A status ten times a second, with a battery that runs down."""
    return [*status_comes(), _starts_full(), _falls(_until_it_is_empty, 1), _ends_at_zero(), no_errors()]


@check(PAGE, points=5, limit=25, learnt="Your monitor reports what the sensor says, along the axes that others expect.")
def status_monitor() -> list[Expectation]:
    """The status monitor tells ten times a second what the turtle really does."""
    return [
        *status_comes(RUN),
        _pose_follows(),
        _velocity_follows("x", "y", math.cos),
        _velocity_follows("y", "x", math.sin),
        _stands(),
        _falls(_a_while),
        no_errors(),
    ]


@check(PAGE, points=3, limit=20, learnt="A node can turn one stream into another that is easier to use.")
def battery_watch() -> list[Expectation]:
    """A node that hears the status, and says whether the battery is low."""
    return [
        node("/battery_watch"),
        subscribes(STATUS, STATUS_TYPE, by="/battery_watch"),
        publishes(LOW, LOW_TYPE, by="/battery_watch"),
        _says_low("False from 20 % on", 100.0, 50.0, 20.5, 20.0),
        _says_low("True below 20 %", 19.5, 10.0, 0.0),
        _says_low("False again when the battery is full again", 15.0, 100.0),
        _silent_without_status(),
        no_errors(),
    ]


SPEED = 0.5
"""The turtle is driven so fast, m/s, in a whole circle, 0.6 m wide."""

Pair = tuple[Heard, Heard]
"""A status, and the pose before it."""


@remembered
def ride(probe: Probe) -> tuple[list[Pair], list[Pair], list[Heard]]:
    """Drive the turtle in a circle: all pairs, those during the drive, and the statuses after the turtle had stopped."""
    began, ended, pairs = circle(probe, STATUS, STATUS_TYPE, SPEED, 1.6, 4.0, before=0.3, after=1.0)
    driving = [(status, pose) for status, pose in pairs if began + 0.3 < status.at < ended]
    at_rest = [status for status, _ in pairs if status.at > ended + 0.3]
    if not (driving and at_rest):
        raise CannotLook(f"{STATUS} did not come all the time")
    return pairs, driving, at_rest


@expectation("x, y, theta follow the turtle")
def _pose_follows(probe: Probe) -> Seen:
    pairs = [(status.message, pose.message) for status, pose in ride(probe)[0]]
    x, y = (max(abs(getattr(a, name) - getattr(b, name)) for a, b in pairs) for name in ("x", "y"))
    off = max(abs(turned(a.theta - b.theta)) for a, b in pairs)
    seen = f"at most {number(x)} m off in x, {number(y)} m in y, {angle(off)} in theta"
    advice = f"Keep what the newest message on {POSE} says, all three fields of it."
    return Seen(max(x, y) <= LATE and off <= 2 * LATE, seen, advice)


@expectation("vel_{axis} follows the turtle")
def _velocity_follows(probe: Probe, axis: str, other: str, part: Callable[[float], float]) -> Seen:
    """vel_x or vel_y is the speed along that axis of the map, all around a circle; `part` is the cosine or the sine."""
    told = [
        (float(getattr(status.message, f"vel_{axis}")), pose.message.linear_velocity * part(pose.message.theta), pose)
        for status, pose in ride(probe)[1]
    ]
    # what is no number is infinitely far off
    off, said, right, pose = max(
        ((abs(said - right) if math.isfinite(said) else math.inf, said, right, pose) for said, right, pose in told),
        key=lambda each: each[0],
    )
    if off <= LATE:
        return Seen(True, f"right in all {count(len(told), 'message')} of a circle")
    speeds = f"{number(said)} m/s where {number(right)} m/s is right"
    advice = f"How much of the speed goes along {axis}, and how much along {other}? Try 0, π/2 and π in your head."
    return Seen(False, f"{speeds}: {number(SPEED)} m/s at {angle(pose.message.theta)}", hinted(advice, 2))


@expectation("both are 0 when the turtle stands")
def _stands(probe: Probe) -> Seen:
    _, _, at_rest = ride(probe)
    x, y = (float(getattr(at_rest[-1].message, name)) for name in ("vel_x", "vel_y"))
    seen = f"vel_x {number(x)} m/s, vel_y {number(y)} m/s"
    return Seen(abs(x) < 0.05 and abs(y) < 0.05, seen, "Use the speed that the pose tells, not a number of your own.")


def _charges(heard: list[Heard]) -> list[float]:
    return [float(each.message.battery) for each in heard]


@expectation("battery starts at 100 %")
def _starts_full(probe: Probe) -> Seen:
    """The first message that is heard has as much charge as it can have by then."""
    some(probe, STATUS, STATUS_TYPE, 0.5)
    first = probe.listen(STATUS, STATUS_TYPE)[0]
    [charge] = _charges([first])
    by_then = max(0.0, 100.0 - 10 * DROP * (first.at + 0.2))
    seen = f"{number(charge, 1)} % after {number(first.at, 1)} s"
    advice = "The first status says 100: publish first, take away afterwards."
    return Seen(by_then - 1e-3 <= charge <= 100.0 + 1e-3, seen, advice)


@expectation(f"battery falls by {DROP:g} a message")
def _falls(probe: Probe, heard: Callable[[Probe], list[Heard]], hint: int | str = "") -> Seen:
    """Each message has 0.1 less than the one before, or 0; `hint` is the number of one under the exercise."""
    charges = _charges(heard(probe))
    for before, after in itertools.pairwise(charges):
        if not abs(max(0.0, before - DROP) - after) <= 1e-3:
            step = "Once for each message that is published, the battery becomes 0.1 less than it was, but not less than 0."
            return Seen(False, f"{number(before)} %, and in the next message {number(after)} %", hinted(step, hint))
    return Seen(True, f"from {number(charges[0], 1)} to {number(charges[-1], 1)}")


def _a_while(probe: Probe) -> list[Heard]:
    """What was heard of the status until now, 3 s of it at least."""
    some(probe, STATUS, STATUS_TYPE, 3.0)
    return probe.listen(STATUS, STATUS_TYPE)


@remembered
def _until_it_is_empty(probe: Probe) -> list[Heard]:
    """What is heard of the status until the battery has been empty for a second."""
    some(probe, STATUS, STATUS_TYPE, 0.5)
    heard = probe.listen(STATUS, STATUS_TYPE)
    probe.wait_for(lambda: _charges(heard[-1:])[0] < DROP / 2, 102.0)
    probe.wait(1.0)
    return heard


@expectation("battery ends at 0, never below")
def _ends_at_zero(probe: Probe) -> Seen:
    charges = _charges(_until_it_is_empty(probe))
    low, high, last = min(charges), max(charges), charges[-1]
    seen = f"from {number(high, 1)} to {number(low, 1)}, at the end {number(last, 1)}"
    advice = "What should 0.0 minus 0.1 become?" if low < 0 else "It should run down to 0.0, and stay there."
    return Seen(low >= 0.0 and high <= 100.0 and last < DROP / 2, seen, hinted(advice, 2))


@expectation("{expected}")
def _says_low(probe: Probe, expected: str, *charges: float) -> Seen:
    """Each status with one of these charges is answered by one Bool, and by the right one."""
    answers = _answers(probe)
    for charge in charges:
        answers.clear()
        probe.publish(STATUS, STATUS_TYPE, battery=charge)
        probe.wait_for(lambda: answers, 1.0)
        probe.wait(0.05)
        said = [each.message.data for each in answers]
        if not said:
            probe.raise_error()
            hint = hinted("on_status must publish, whatever the charge is.", "Open Hint 2.")
            return Seen(False, f"{charge:g} %: nothing came within 1 s", hint)
        if len(said) > 1:
            step = "One status in, one Bool out: is there a second publish?"
            return Seen(False, f"{charge:g} %: {count(len(said), 'message')} came instead of one", step)
        if said[0] is not (charge < 20.0):
            hint = hinted("Try the three examples in your head: 100, 20 and 19.5.", "Open Hint 2.")
            return Seen(False, f"{charge:g} %: it said {said[0]}", hint)
    return Seen(True, ", ".join(f"{charge:g} → {charge < 20.0}" for charge in charges))


@expectation("without a status it says nothing")
def _silent_without_status(probe: Probe) -> Seen:
    _answers(probe)
    heard = probe.hear(LOW, LOW_TYPE, 1.0)
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
