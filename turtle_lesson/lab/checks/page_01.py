"""Page 01: a publisher at a rate, a subscriber that answers on another topic, and a timer that reports the newest message."""

from __future__ import annotations

from ..words import number
from .drives import COMMAND_TYPE, COMMANDS, POSE, POSE_TYPE
from .exam import Exam, Heard
from .fields import field
from .parts import no_errors, node, publishes, subscribes
from .registry import Expectation, check
from .rows import CannotLook, Seen
from .streams import rate, relays, steps

PAGE = "01_publish_and_subscribe"
NUMBER = "std_msgs/msg/Int32"
REPORT, REPORT_TYPE = "/report", "std_msgs/msg/Float32"

NEWS = 0.1
"""How far a report may be behind the turtle, m: at 1 m/s that is 0.1 s."""


@check("counter", page=PAGE, points=3, limit=15)
def counter() -> list[Expectation]:
    """A node that counts aloud, twice a second."""
    return [
        node("/counter"),
        publishes("/count", NUMBER, by="/counter"),
        rate("/count", NUMBER, hz=2, seconds=4.0),
        steps("/count", NUMBER, "data", 1),
        no_errors(),
    ]


@check("doubler", page=PAGE, points=3, limit=15)
def doubler() -> list[Expectation]:
    """A node that hears a number and says twice as much."""
    pairs = [
        ({"data": given}, lambda message, given=given: message.data == 2 * given, f"{given} → {2 * given}")
        for given in (21, -500, 0, 123456)
    ]
    step = "In the callback make a new message, set its data to 2 * message.data, and publish it."
    return [
        node("/doubler"),
        subscribes("/count", NUMBER, by="/doubler"),
        publishes("/doubled", NUMBER, by="/doubler"),
        relays("/count", NUMBER, "/doubled", NUMBER, pairs, step),
        no_errors(),
    ]


@check("reporter", page=PAGE, points=4, limit=20)
def reporter() -> list[Expectation]:
    """A node that hears every pose of the turtle, and once a second reports the newest x."""
    return [
        node("/reporter"),
        subscribes(POSE, POSE_TYPE, by="/reporter"),
        publishes(REPORT, REPORT_TYPE, by="/reporter"),
        rate(REPORT, REPORT_TYPE, hz=1, seconds=4.0),
        Expectation("it tells the newest x, also while it changes", _is_news),
        no_errors(),
    ]


def _is_news(exam: Exam) -> Seen:
    """Drive the turtle for three seconds, to where there is room, and compare each report with the pose before it."""
    poses, reports = exam.listen(POSE, POSE_TYPE), exam.listen(REPORT, REPORT_TYPE)
    exam.wait(0.1)
    if not poses:
        raise CannotLook(f"no pose comes on {POSE}")
    first_pose, first_report = len(poses) - 1, len(reports)
    for _ in range(30):
        exam.publish(COMMANDS, COMMAND_TYPE, linear__x=1.0, angular__z=1.0)
        exam.wait(0.1)
    exam.publish(COMMANDS, COMMAND_TYPE)
    exam.wait(0.1)
    xs = [each.message.x for each in poses[first_pose:]]
    if max(xs) - min(xs) < 0.1:
        raise CannotLook(f"the turtle does not move when {COMMANDS} says so")
    pairs = [(float(field(each.message, "data")), _last_before(each, poses)) for each in reports[first_report:]]
    if not pairs:
        raise CannotLook(f"no message came on {REPORT} while the turtle drove")
    wrong = [(said, true) for said, true in pairs if abs(said - true) > NEWS]
    said, true = wrong[0] if wrong else pairs[-1]
    seen = f"it said {number(said)} when x was {number(true)}"
    step = "Keep the newest: self.x = pose.x where the poses come in; publish self.x in the timer's callback."
    return Seen(not wrong, seen, step)


def _last_before(report: Heard, poses: list[Heard]) -> float:
    return next(float(each.message.x) for each in reversed(poses) if each.at <= report.at)
