"""Page 01: a publisher at a rate, a subscriber that answers on another topic, and a timer that reports the newest message."""

from __future__ import annotations

from collections import Counter

from ..words import count, number
from .assertions import no_errors, node, publishes, subscribes
from .graph_view import field
from .navigation import COMMAND_TYPE, COMMANDS, POSE, POSE_TYPE
from .probe import Heard, Probe
from .registry import Expectation, check
from .results import CannotLook, Seen, hinted
from .streams import rate, relays, some

NUMBER = "std_msgs/msg/Int32"
COUNT, DOUBLED = "/count", "/doubled"
REPORT, REPORT_TYPE = "/report", "std_msgs/msg/Float32"

ENOUGH = 6
"""Numbers that show how a node counts."""

NEWS = 0.1
"""How far a report may be behind the turtle, m: at 1 m/s that is 0.1 s."""

ROUND = 6.3
"""Robot time, s, in which the turtle drives once round a circle, so that x rises and falls."""


@check("counter", points=3, limit=15, learnt="A publisher and a timer make a steady stream of messages.")
def counter() -> list[Expectation]:
    """A node that counts aloud, twice a second."""
    return [
        node("/counter"),
        publishes(COUNT, NUMBER, by="/counter"),
        rate(COUNT, NUMBER, hz=2, seconds=4.0),
        Expectation("it counts 1, 2, 3, 4 and so on", _counts),
        no_errors(),
    ]


def _counts(probe: Probe) -> Seen:
    """Each number that came since the check began, compared with how many the node has sent by then."""
    heard = probe.listen(COUNT, NUMBER)
    if len(heard) < ENOUGH:
        some(probe, COUNT, NUMBER, 3.0)
    sent = probe.target.published(COUNT, "/counter")
    if not sent:
        raise CannotLook(f"/counter sent nothing on {COUNT}")
    first = sent - len(heard) + 1
    said = [field(each.message, "data") for each in heard]
    wrong = next(((place, each) for place, each in enumerate(said, first) if each != place), None)
    if wrong is None:
        return Seen(True, f"from {said[0]} to {said[-1]} while the check listened")
    place, each = wrong
    advice = hinted(
        "Follow the number by hand: what is it before the first message, and what happens to it for each one?",
        "Hint 2 under the exercise says where the number is kept.",
    )
    if place == 1 or said == list(range(said[0], said[0] + len(said))):
        return Seen(False, f"it began with {each - place + 1}, not with 1", advice)
    return Seen(False, f"message number {place} was {each}", advice)


@check("doubler", points=3, limit=15, learnt="A node can listen and speak: its callback publishes the answer.")
def doubler() -> list[Expectation]:
    """A node that hears a number and says twice as much."""
    pairs = [
        ({"data": given}, lambda message, given=given: message.data == 2 * given, f"{given} → {2 * given}")
        for given in (21, -500, 0, 123456)
    ]
    advice = hinted(
        "Who calls the callback, with which message, and what does the message hold that it publishes?",
        "Hint 2 under the exercise shows what the callback does.",
    )
    return [
        node("/doubler"),
        subscribes(COUNT, NUMBER, by="/doubler"),
        publishes(DOUBLED, NUMBER, by="/doubler"),
        relays(COUNT, NUMBER, DOUBLED, NUMBER, pairs, advice),
        Expectation("one answer to each number, even to three at once", _answers_each),
        no_errors(),
    ]


def _answers_each(probe: Probe) -> Seen:
    if not probe.subscriptions(COUNT):
        raise CannotLook(f"no node listens to {COUNT}")
    answers = probe.listen(DOUBLED, NUMBER)
    before, given = len(answers), (1001, 1002, 1003)
    for each in given:
        probe.publish(COUNT, NUMBER, data=each)
    probe.wait(1.5)
    said = Counter(each.message.data for each in answers[before:])
    direction = "The callback is called once for each message: publish there, once."
    for each in given:
        if said[2 * each] != 1:
            return Seen(
                False, f"{each} was answered {count(said[2 * each], 'time') if said[2 * each] else 'never'}", direction
            )
    return Seen(True, "1001, 1002 and 1003 were, once each")


@check(
    "reporter",
    points=4,
    limit=25,
    learnt="One callback keeps the newest message, and a timer uses it: two rates, one node.",
)
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


def _is_news(probe: Probe) -> Seen:
    """Drive the turtle once round a circle, and compare each report with the pose before it."""
    poses, reports = probe.listen(POSE, POSE_TYPE), probe.listen(REPORT, REPORT_TYPE)
    probe.wait(0.1)
    if not poses:
        raise CannotLook(f"no pose comes on {POSE}")
    first_pose, first_report = len(poses) - 1, len(reports)
    end = probe.now + ROUND
    while probe.now < end:
        probe.publish(COMMANDS, COMMAND_TYPE, linear__x=1.0, angular__z=1.0)
        probe.wait(0.1)
    probe.publish(COMMANDS, COMMAND_TYPE)
    probe.wait(0.1)
    xs = [each.message.x for each in poses[first_pose:]]
    if max(xs) - min(xs) < 0.1:
        raise CannotLook(f"the turtle does not move when {COMMANDS} says so")
    pairs = [(float(field(each.message, "data")), _last_before(each, poses)) for each in reports[first_report:]]
    if not pairs:
        raise CannotLook(f"no message came on {REPORT} while the turtle drove")
    wrong = [(said, true) for said, true in pairs if not abs(said - true) <= NEWS]
    said, true = wrong[0] if wrong else pairs[-1]
    seen = f"it said {number(said)} when x was {number(true)}"
    advice = hinted(
        "Which callback hears the pose, and where does it keep x until the timer's callback needs it?",
        "Hint 1 under the exercise names the two callbacks.",
    )
    return Seen(not wrong, seen, advice)


def _last_before(report: Heard, poses: list[Heard]) -> float:
    return next(float(each.message.x) for each in reversed(poses) if each.at <= report.at)
