"""Pages 00 to 02: a first command and goal; nodes that publish and subscribe; services, and a package with types of its own."""

from __future__ import annotations

import math
from collections import Counter
from typing import TYPE_CHECKING

import numpy as np

from ...learner.workspace import workspace
from ..recording import NANOSECONDS
from ..words import angle, count, number, point, turned
from .assertions import answers, no_errors, node, offers, publishes, rate, relays, some, subscribes
from .navigation import NAVIGATE_TYPE, NEAR, POSE, POSE_TYPE, away, circle, where
from .probe import Probe, interface, remembered
from .registry import Expectation, check
from .results import Advice, CannotLook, Seen, hinted

if TYPE_CHECKING:
    from robot_controller.srv import NavigateTo

WELCOME, TOPICS, SERVICES = "00_welcome", "01_publish_and_subscribe", "02_services_and_interfaces"

# -- 00: a first command, a first goal ------------------------------------------------------------------------------------

UP = math.pi / 2
LITTLE = 0.1
"""What does not matter: radians of a heading, metres of a way."""

CORNER = (2.0, 2.0)


@check(WELCOME, points=1, limit=5, learnt="One message on a topic moves a robot; angles are measured in radians.")
def face_up() -> list[Expectation]:
    """The turtle was turned on the spot, a quarter to the left."""
    return [
        Expectation("it turned a quarter to the left, and faces up", _facing_up),
        Expectation("it turned on the spot", _on_the_spot),
    ]


@remembered
def last_motion(probe: Probe) -> tuple[float, float, float]:
    """What the turtle did since it was at rest before the last command: how far it turned (rad, to the left) and drove (m), and
    the turning speed that the command asked for (rad/s). So a cell that was run twice is judged by its second run."""
    record = probe.target.recording
    poses, commands = record.poses.array(), record.commands.newest(1)
    if not len(commands):
        return 0.0, 0.0, 0.0
    command = float(commands[0]["turn"])
    x, y, theta = (poses[name].astype(float) for name in ("x", "y", "theta"))
    way = np.hypot(np.diff(x), np.diff(y))
    turn = np.angle(np.exp(1j * np.diff(theta)))
    moves = np.flatnonzero((way > 1e-6) | (np.abs(turn) > 1e-6))
    if not len(moves) or poses["stamp"][moves[-1] + 1] < commands[0]["stamp"]:
        return 0.0, 0.0, command
    # what has not moved for half a second has come to rest, and what it does then is a new motion
    rests = np.flatnonzero(np.diff(poses["stamp"][moves]) > 0.5 * NANOSECONDS)
    first = moves[rests[-1] + 1] if len(rests) else moves[0]
    return float(turn[first:].sum()), float(way[first:].sum()), command


def _facing_up(probe: Probe) -> Seen:
    heading, (turn, _, command) = where(probe).theta, last_motion(probe)
    good = abs(turned(heading - UP)) <= LITTLE or abs(turn - UP) <= LITTLE
    seen = f"its heading is {angle(heading)}; the last command said angular.z = {number(command)} rad/s"
    degrees = "That is many times round in one second: ROS measures angles in radians, not in degrees."
    advice = Advice(
        symptom=degrees if abs(command) > 2 * math.pi else "",
        direction="A command counts for one second. Which turning speed makes a quarter turn in one second, and to which side?",
        hint="Open the hint under the exercise.",
    )
    return Seen(good, seen, advice)


def _on_the_spot(probe: Probe) -> Seen:
    _, way, _ = last_motion(probe)
    advice = "Which field of the command makes it drive? To begin again: ros2 service call /reset std_srvs/srv/Empty"
    return Seen(way <= LITTLE, f"it drove {number(way)} m meanwhile", advice)


@check(WELCOME, points=1, limit=5, learnt="A service is asked by a request, and answers when its work is done.")
def corner() -> list[Expectation]:
    """The turtle was sent to (2, 2)."""
    return [Expectation(f"the turtle within {NEAR:g} m of {point(*CORNER)}", _in_the_corner)]


def _in_the_corner(probe: Probe) -> Seen:
    pose = where(probe)
    off = away(pose, CORNER)
    seen = f"it is at {point(pose.x, pose.y)}, {number(off)} m from there"
    advice = hinted("What does the request say, and was it sent with client.call?", "Open the hint under the exercise.")
    return Seen(off <= NEAR, seen, advice)


# -- 01: publish and subscribe --------------------------------------------------------------------------------------------

NUMBER = "std_msgs/msg/Int32"
COUNT, DOUBLED = "/count", "/doubled"
REPORT, REPORT_TYPE = "/report", "std_msgs/msg/Float32"


@check(TOPICS, points=3, limit=15, learnt="A publisher and a timer make a steady stream of messages.")
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
    if len(heard) < 6:  # so many show how a node counts
        some(probe, COUNT, NUMBER, 3.0)
    sent = probe.target.published(COUNT, "/counter")
    if not sent:
        raise CannotLook(f"/counter sent nothing on {COUNT}")
    first = sent - len(heard) + 1
    said = [each.message.data for each in heard]
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


@check(TOPICS, points=3, limit=15, learnt="A node can listen and speak: its callback publishes the answer.")
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
            often = count(said[2 * each], "time") if said[2 * each] else "never"
            return Seen(False, f"{each} was answered {often}", direction)
    return Seen(True, "1001, 1002 and 1003 were, once each")


@check(
    TOPICS,
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
    """Drive the turtle once round a circle, so that x rises and falls, and compare each report with the pose before it."""
    _, _, heard = circle(probe, REPORT, REPORT_TYPE, 1.0, 1.0, 6.3, before=0.1, after=0.1)
    pairs = [(float(said.message.data), float(pose.message.x)) for said, pose in heard]
    wrong = [(said, true) for said, true in pairs if not abs(said - true) <= 0.1]
    said, true = wrong[0] if wrong else pairs[-1]
    seen = f"it said {number(said)} when x was {number(true)}"
    advice = hinted(
        "Which callback hears the pose, and where does it keep x until the timer's callback needs it?",
        "Hint 1 under the exercise names the two callbacks.",
    )
    return Seen(not wrong, seen, advice)


# -- 02: services and interfaces ------------------------------------------------------------------------------------------

ADD = "example_interfaces/srv/AddTwoInts"

STATUS = dict.fromkeys(("x", "y", "theta", "vel_x", "vel_y", "battery"), "float")
GOAL = dict.fromkeys(("x", "y", "theta"), "float")
RESULT = {"success": "boolean", "time_taken": "float"}
"""Fields and types of the lesson's interfaces, as ROS names them: float32 is "float", bool "boolean"."""


@check(SERVICES, points=3, limit=15, learnt="A service answers each request by a callback that returns a response.")
def adder() -> list[Expectation]:
    """A service that adds."""
    return [
        node("/adder"),
        offers("/add_two_ints", ADD, by="/adder"),
        *(_adds(a, b) for a, b in ((2, 3), (-40, 7), (7, -40), (3_000_000_000, 1))),
        no_errors(),
    ]


def _adds(a: int, b: int) -> Expectation:
    return answers(
        "/add_two_ints",
        ADD,
        {"a": a, "b": b},
        lambda response: response.sum == a + b,
        f"{a} + {b if b >= 0 else f'({b})'} is {a + b}".replace("-", "−"),
        hinted("Which fields does the request have, and which one the response?", 2),
    )


@check(SERVICES, points=4, limit=5, learnt="Named, built and sourced: then a type of your own can be used.")
def interfaces() -> list[Expectation]:
    """The package robot_controller is built and sourced, with its message and its service."""
    return [
        _has_fields("robot_controller/msg/TurtleStatus", STATUS),
        _has_fields(NAVIGATE_TYPE, GOAL, "request"),
        _has_fields(NAVIGATE_TYPE, RESULT, "response"),
    ]


def _has_fields(type_name: str, fields: dict[str, str], part: str = "") -> Expectation:
    """An interface that can be imported and has exactly these fields, in this order."""

    def look(probe: Probe) -> Seen:
        try:
            kind = interface(type_name)
            found = dict((getattr(kind, part.capitalize()) if part else kind).get_fields_and_field_types())
        except CannotLook as reason:
            return Seen(False, str(reason), hinted(_cause(type_name), 2))
        good = list(found.items()) == list(fields.items())
        direction = f"The fields are {_in_words(fields)}, in this order. Does the file say so, and was it built since?"
        return Seen(good, "it has" if good else f"it has {_in_words(found)}", direction)

    what = type_name.split("/")[-1] + (f" ({part})" if part else "")
    return Expectation(f"{what}: {' '.join(fields)}", look)


def _cause(type_name: str) -> str:
    """Which of the three causes keeps a type of the learner's package from being found."""
    package, kind, name = type_name.split("/")
    mine, file = workspace(), f"{kind}/{name}.{kind}"
    cmake = mine.package / "CMakeLists.txt"
    if not (mine.package / file).is_file():
        return f"There is no file {file} in the package. What is it called, and where is it?"
    if not cmake.is_file() or file not in cmake.read_text(encoding="utf-8", errors="replace"):
        return f"CMakeLists.txt does not name {file}."
    if not (mine.folder / "install" / package / "share" / package / file).is_file():
        return f"CMakeLists.txt names {file}, but it was not built. What does colcon build say?"
    return f"{file} was built. Was the workspace sourced since then?"


def _in_words(fields: dict[str, str]) -> str:
    typed = {"float": "float32", "double": "float64", "boolean": "bool"}
    return ", ".join(f"{typed.get(kind, kind)} {name}" for name, kind in fields.items()) or "no field"


MIDDLE, SPEED = 5.544445, 0.2
"""Where the turtle starts, m: the middle of its world; and how fast the lesson's navigator drives, m/s."""


@check(
    SERVICES, points=4, limit=20, learnt="A service refuses what makes no sense, at once and in a field of its answer."
)
def estimator() -> list[Expectation]:
    """A service that says how long the way to a goal takes."""
    return [
        node("/estimator"),
        offers("/estimate", NAVIGATE_TYPE, by="/estimator"),
        _estimates("3 m ahead take 15 s", MIDDLE + 3.0, MIDDLE, 15.0),
        _estimates("5 m aslant take 25 s", MIDDLE - 3.0, MIDDLE - 4.0, 25.0),
        _estimates("where it stands: 0 s", MIDDLE, MIDDLE, 0.0),
        _estimates("(0, 5.54), on the left edge, takes 27.7 s", 0.0, MIDDLE, MIDDLE / SPEED),
        _estimates("(5.54, 0), on the lower edge, takes 27.7 s", MIDDLE, 0.0, MIDDLE / SPEED),
        _estimates("(11.05, 11.05), in the corner, takes 38.9 s", 11.05, 11.05, 2**0.5 * (11.05 - MIDDLE) / SPEED),
        *(
            _estimates(f"({x:g}, {y:g}) is outside: success is False, time_taken 0".replace("-", "−"), x, y)
            for x, y in ((-0.5, 5.0), (11.5, 5.0), (5.0, -0.5), (5.0, 11.5))
        ),
        no_errors(),
    ]


def _estimates(words: str, x: float, y: float, seconds: float | None = None) -> Expectation:
    """The service says how long the way to a goal takes, or refuses a goal for which no time is given here."""

    def right(response: NavigateTo.Response) -> bool:
        if seconds is None:
            return not response.success and response.time_taken == 0.0
        return response.success and abs(response.time_taken - seconds) < 0.05

    step = "How long is the straight way from the middle, and which goals are in the world?"
    advice = hinted(step, "Open the hints under the exercise.")
    if seconds is None:
        advice = hinted("A goal is inside if both x and y are from 0 to 11.09.", 2)
    return answers("/estimate", NAVIGATE_TYPE, {"x": x, "y": y}, right, words, advice)
