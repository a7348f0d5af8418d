"""Pages 03 and 03b: the navigator, first driving blind, then by the pose; then it answers on arrival."""

from __future__ import annotations

import math
import re
from typing import Any

from ..words import number, point, turned
from . import navigation as nav
from .assertions import learner_function, no_errors, node, offers, publishes, returns
from .navigation import MIDDLE, NEAR, Goal, Way, ask_for, ask_soon_for, away, come_to_rest, drive, driven, put, where
from .probe import Answer, Probe, remembered
from .registry import Expectation, check, expectation
from .results import CannotLook, Seen, hinted

PAGE, ARRIVAL = "03_navigator", "03b_answer_on_arrival"

START = 5.544
"""Where the blind navigator believes that each drive begins (m), in x and in y."""

STRAIGHT = Way("(7.544, 5.544)", (START, START, 0.0), (START + 2, START, 0.0))
BESIDE = Way("(5.544, 4.544)", (START, START, 0.0), (START, START - 1, 0.0))
BEHIND = Way("(4.544, 6.544)", (START, START, 0.0), (START - 1, START + 1, 0.0))

A_GOAL = Way("a goal", MIDDLE, (4.0, 3.0, 1.57))
NEAR_GOAL = Way("a near goal", MIDDLE, (6.0, 5.5, 0.0))
TO_THE_LEFT = Way("a goal in the west", (8.0, 5.0, 3.05), (5.0, 4.8, -3.05))
TO_THE_RIGHT = Way("another in the west", (8.0, 5.0, -3.05), (5.0, 5.2, 3.05))
CORNERS = (
    Way("the lower left corner", (1.0, 1.0, -2.3), (0.0, 0.0, -2.3)),
    Way("the upper right corner", (10.0, 10.0, 0.8), (11.08, 11.08, 0.8)),
)


def navigator_is_there(start: str = "ros2 run robot_controller navigator") -> list[Expectation]:
    """The node, its service and its commands; `start` is the command that starts it."""
    return [
        node("/navigator", start),
        offers(nav.NAVIGATE, nav.NAVIGATE_TYPE, by="/navigator"),
        publishes(nav.COMMANDS, nav.COMMAND_TYPE, by="/navigator"),
    ]


@check(
    PAGE,
    points=3,
    limit=420,
    learnt="Open loop: distance divided by speed says how long to send a command, and nothing says where it led.",
)
def simple_navigator() -> list[Expectation]:
    """A navigator that drives straight ahead for as long as the way takes, stops, and says how long it took."""
    return [
        *navigator_is_there(),
        _takes(STRAIGHT, 4.0),
        _drives_ahead(STRAIGHT, 2.0),
        nav.steady_commands(STRAIGHT),
        nav.stopped(STRAIGHT),
        _takes(BESIDE, 2.0),
        _takes(BEHIND, 2 * math.sqrt(2)),
        no_errors(),
    ]


@expectation("the goal {way.name} takes {wanted:.2f} s")
def _takes(probe: Probe, way: Way, wanted: float) -> Seen:
    it = drive(probe, way)
    if it.answer.response is None:
        return probe.no_answer(f"no answer in {nav.LONGEST:g} s")
    said, took = float(it.response.time_taken), it.answer.seconds
    seen = f"time_taken is {number(said)} s, and the answer came after {number(took)} s"
    step = "Which distance did your node calculate, from where, and which time follows from it at 0.5 m/s?"
    return Seen(abs(said - wanted) <= 0.15 and abs(took - wanted) <= 0.2, seen, hinted(step, 1))


@expectation("it drives {metres:g} m straight ahead")
def _drives_ahead(probe: Probe, way: Way, metres: float) -> Seen:
    it = drive(probe, way)
    it.moving()
    end = it.end(at_rest=True)
    ahead, beside = end.x - it.begin.x, end.y - it.begin.y
    seen = f"it drove {number(math.hypot(ahead, beside))} m, to {point(end.x, end.y)}"
    step = hinted("How fast does the turtle drive, for how long, and what stops it?", 2)
    return Seen(abs(ahead - metres) <= 0.1 and abs(beside) <= 0.05, seen, step)


DIFFERENCES = hinted(
    "Which whole turns can be added to that difference, or taken away from it, so that it becomes smaller?",
    "Open Hint 1, then Hint 2, under the exercise.",
)


@check(PAGE, points=3, limit=60, learnt="The difference of two angles is the short way only after it has been wrapped.")
def short_way() -> list[Expectation]:
    """A difference of angles that is always the short way round."""

    def turn(expected: str, *examples: tuple[float, float, float]) -> Expectation:
        cases = [((wanted, heading), turned(right)) for wanted, heading, right in examples]
        return returns("turn_to", cases, expected, DIFFERENCES, within=1e-6)

    seam = math.tau - 6.26
    return [
        turn(
            "an ordinary difference stays as it is",
            (1.0, 0.5, 0.5),
            (0.5, 1.0, -0.5),
            (-1.0, 1.0, -2.0),
            (2.0, 2.0, 0.0),
        ),
        turn("across due west to the left", (-3.13, 3.13, seam), (-2.0, 2.0, -4.0)),
        turn("across due west to the right", (3.13, -3.13, -seam), (2.0, -2.0, 4.0)),
        turn("more than a whole turn", (9.0, -3.0, 12.0), (-9.0, 3.0, -12.0), (0.5, 13.0, -12.5), (20.0, 0.0, 20.0)),
        _half_a_turn(),
        _steers_across("to the left", TO_THE_LEFT),
        _steers_across("to the right", TO_THE_RIGHT),
        no_errors(),
    ]


@expectation("half a turn, either way round")
def _half_a_turn(probe: Probe) -> Seen:
    came = probe.call(learner_function(probe, "turn_to"), math.pi, 0.0)
    if not isinstance(came, float):
        return Seen(False, f"turn_to(3.1416, 0.0) is {came!r}", "Does turn_to end with `return`, in every case?")
    return Seen(abs(abs(came) - math.pi) < 1e-6, f"turn_to(3.1416, 0.0) is {number(came, 4)}", DIFFERENCES)


@expectation("a drive due west, with a turn {where_to}")
def _steers_across(probe: Probe, where_to: str, way: Way) -> Seen:
    """The notebook's `steer`, which calls turn_to, drives the turtle across due west without a pirouette."""
    from turtlesim.msg import Pose

    steer = learner_function(probe, "steer")
    heard = probe.listen(nav.POSE, nav.POSE_TYPE)
    put(probe, way.begin or MIDDLE)
    poses = [where(probe)]
    x, y, theta = way.goal
    while away(poses[-1], way.goal) > NEAR and len(poses) < 60:
        speed, turn = probe.call(steer, poses[-1], Pose(x=x, y=y, theta=theta))
        probe.publish(nav.COMMANDS, nav.COMMAND_TYPE, linear__x=float(speed), angular__z=float(turn))
        probe.wait(0.1)
        poses.append(heard[-1].message)
    probe.publish(nav.COMMANDS, nav.COMMAND_TYPE)
    degrees = math.degrees(nav.turning(poses))
    there = away(poses[-1], way.goal) <= NEAR
    arrived = "arrived" if there else "did not arrive within 6 s"
    return Seen(there and degrees <= 60.0, f"it {arrived}, and turned by {number(degrees, 0)}° on the way", DIFFERENCES)


@check(
    PAGE,
    points=6,
    limit=600,
    learnt="Closed loop: a node that looks ten times a second needs no plan, and a good service refuses what makes no sense.",
)
def navigator() -> list[Expectation]:
    """A navigator that steers by the pose until it is there, and refuses goals that make no sense."""
    nan, inf = math.nan, math.inf
    return [
        *navigator_is_there(),
        nav.answered(A_GOAL),
        nav.arrived(A_GOAL, at_rest=True),
        nav.facing(A_GOAL, at_rest=True),
        nav.steady_commands(A_GOAL),
        nav.stopped(A_GOAL),
        _logged(A_GOAL),
        nav.turns_little(TO_THE_LEFT, 90.0),
        nav.turns_little(TO_THE_RIGHT, 90.0),
        nav.refuses("x outside the world", (20.0, 5.0, 0.0), (-1.0, 5.0, 0.0), (11.2, 5.0, 0.0), (-0.1, 5.0, 0.0)),
        nav.refuses("y outside the world", (5.0, 20.0, 0.0), (5.0, -1.0, 0.0), (5.0, 11.2, 0.0), (5.0, -0.1, 0.0)),
        nav.refuses("x and y that are no finite numbers", (nan, 5.0, 0.0), (5.0, nan, 0.0), (inf, 5.0, 0.0)),
        nav.refuses("theta that is no finite number", (5.0, 6.0, nan), (5.0, 6.0, inf), (5.0, 6.0, -inf)),
        nav.accepts("goals at the very edge", *CORNERS),
        nav.accepts("any heading", *(Way(f"heading {each:g}", MIDDLE, (6.5, 5.5, each)) for each in (0.0, 7.0, -7.0))),
        _keeps_its_goal(),
        no_errors(),
    ]


@expectation("the goal (4, 3) is logged")
def _logged(probe: Probe, way: Way) -> Seen:
    driven(probe, way)
    lines = [text for _, name, text in probe.log if name == "navigator"]
    x, y = (rf"(?<![\d.]){each:g}(\.0+)?(?!\.?\d)" for each in way.goal[:2])
    found = [text for text in lines if re.search(x, text) and re.search(y, text)]
    step = "Which line of on_goal writes to the log, and is it reached for a goal that is accepted?"
    return Seen(bool(found), f"“{found[0]}”" if found else "no line of its log has 4 and 3 in it", step)


@expectation("refused on its way to (9, 3), it still gets there")
def _keeps_its_goal(probe: Probe) -> Seen:
    put(probe, (3.0, 3.0, 0.0))
    first = ask_soon_for(probe, (9.0, 3.0, 0.0))
    probe.wait(0.5)
    refused = ask_for(probe, (20.0, 5.0, 0.0), 1.0).response
    if refused is None or refused.success:
        raise CannotLook("the goal (20, 5, 0) was not refused on the way")
    probe.wait_for(lambda: first() and nav.at_rest(probe.listen(nav.POSE, nav.POSE_TYPE)), 20.0)
    end = where(probe)
    step = hinted("Is self.goal changed before the goal has been judged?", 1)
    return Seen(away(end, (9.0, 3.0)) <= NEAR, f"the turtle went to {point(end.x, end.y)}", step)


NONSENSE = ((20.0, 5.0, 0.0), (5.0, -1.0, 0.0), (math.nan, 5.0, 0.0), (6.0, 6.0, math.inf))
HALFWAY = 0.6
"""Robot time, s, after which a second goal comes."""


@check(ARRIVAL, points=4, limit=600, learnt="await lets a callback wait, and leaves the node free to steer.")
def on_arrival() -> list[Expectation]:
    """A navigator that answers when the turtle has arrived, and works meanwhile."""
    return [
        *navigator_is_there(),
        nav.answered(A_GOAL),
        nav.arrived(A_GOAL),
        nav.facing(A_GOAL),
        nav.honest_time(A_GOAL),
        nav.steady_commands(A_GOAL),
        nav.stopped(A_GOAL),
        nav.answered(TO_THE_LEFT),
        nav.arrived(TO_THE_LEFT),
        nav.honest_time(TO_THE_LEFT),
        _soon(NEAR_GOAL),
        _answers_meanwhile(),
        nav.refuses("what makes no sense, as before", *NONSENSE),
        no_errors(),
    ]


@expectation("{way.name} is answered within 2 s")
def _soon(probe: Probe, way: Way) -> Seen:
    it = driven(probe, way)
    seen = f"after {number(it.answer.seconds)} s, {number(it.distance())} m from the goal"
    step = "How long does the answer wait once the turtle is there?"
    return Seen(it.answer.seconds <= 2.0 and it.distance() <= NEAR, seen, step)


@expectation("it answers other questions meanwhile")
def _answers_meanwhile(probe: Probe) -> Seen:
    put(probe, (2.0, 2.0, 0.0))
    first = ask_soon_for(probe, (8.0, 8.0, 0.0))
    probe.wait(HALFWAY)
    if first() is not None:
        come_to_rest(probe, 15.0)
        raise CannotLook("a goal 8 m away was answered at once")
    answer = probe.ask("/navigator/list_parameters", "rcl_interfaces/srv/ListParameters", 1.0)
    probe.wait_for(first, 30.0)
    if answer.response is None:
        return probe.no_answer("its parameters were not told within 1 s")
    return Seen(True, "its parameters were told while it drove")


@check(
    ARRIVAL, points=3, limit=600, learnt="A callback that pauses may be called again: what it shares has to be guarded."
)
def one_goal() -> list[Expectation]:
    """A navigator that goes on to its goal, and refuses another one meanwhile."""
    return [
        *navigator_is_there(),
        Expectation("a second goal on the way is refused at once", lambda probe: _refused(probe, 0)),
        Expectation("so is a third", lambda probe: _refused(probe, 1)),
        Expectation("the turtle reaches the first goal", _first_reached),
        Expectation("the first goal is answered: success is True", _first_answered),
        Expectation("after that, a goal is accepted again", _accepted_again),
        nav.refuses("what makes no sense, as before", *NONSENSE),
        no_errors(),
    ]


FIRST: Goal = (9.0, 3.0, 0.0)
OTHERS: tuple[Goal, ...] = ((3.0, 9.0, 1.57), (2.0, 3.0, 0.0))
GUARD = hinted(
    "How does on_goal notice that another goal is under way, and when is that over?",
    "Open Hint 1, then Hint 2, under the exercise.",
)


@remembered
def _crowd(probe: Probe) -> tuple[Answer | None, list[Answer], Any]:
    """Ask for a goal, and for two others while it is under way: the answers, and where the turtle came to rest."""
    put(probe, (3.0, 3.0, 0.0))
    first = ask_soon_for(probe, FIRST)
    probe.wait(HALFWAY)
    if first() is not None:
        raise CannotLook("the first goal, 6 m away, was answered at once")
    others = [ask_for(probe, each, 0.5) for each in OTHERS]
    probe.wait_for(first, 15.0)
    answer = first()
    come_to_rest(probe, 15.0)
    return answer, others, where(probe)


def _refused(probe: Probe, index: int) -> Seen:
    _, others, _ = _crowd(probe)
    if others[index].response is None:
        return probe.no_answer(f"no answer to {point(*OTHERS[index][:2])} within 0.5 s")
    return Seen(not others[index].response.success, others[index].told, GUARD)


def _first_reached(probe: Probe) -> Seen:
    _, _, end = _crowd(probe)
    seen = f"it came to rest at {point(end.x, end.y)}, {number(away(end, FIRST))} m from {point(*FIRST[:2])}"
    return Seen(away(end, FIRST) <= NEAR, seen, GUARD)


def _first_answered(probe: Probe) -> Seen:
    first, _, _ = _crowd(probe)
    if first is None:
        return probe.no_answer("no answer within 15 s")
    seen = f"success is {first.response.success}, time_taken {number(first.response.time_taken)} s"
    return Seen(bool(first.response.success), seen, GUARD)


def _accepted_again(probe: Probe) -> Seen:
    _crowd(probe)
    answer = ask_for(probe, (5.0, 5.0, 0.0), 15.0)
    if answer.response is None:
        return probe.no_answer("no answer within 15 s")
    end = where(probe)
    seen = f"success is {answer.response.success}, with the turtle at {point(end.x, end.y)}"
    return Seen(bool(answer.response.success) and away(end, (5.0, 5.0)) <= NEAR, seen, GUARD)
