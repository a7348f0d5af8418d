"""Page 03b: a navigator that answers on arrival."""

from __future__ import annotations

import math

from ..words import number, point
from .assertions import no_answer, no_errors
from .navigation import (
    MIDDLE,
    NEAR,
    Way,
    answered,
    arrived,
    ask_for,
    ask_soon_for,
    come_to_rest,
    driven,
    facing,
    honest_time,
    put,
    refuses,
    steady_commands,
    stopped,
    where,
)
from .page_03 import A_GOAL, TO_THE_LEFT, navigator_is_there
from .probe import Probe, remembered
from .registry import Expectation, check, expectation
from .results import CannotLook, Seen, hinted

NEAR_GOAL = Way("a near goal", MIDDLE, (6.0, 5.5, 0.0))
WAITING = 2.0
"""Robot time, s, within which a goal half a metre ahead is answered."""

NONSENSE = ((20.0, 5.0, 0.0), (5.0, -1.0, 0.0), (math.nan, 5.0, 0.0), (6.0, 6.0, math.inf))
HALFWAY = 0.6
"""Robot time, s, after which a second goal comes."""


@check("on_arrival", points=4, limit=600, learnt="await lets a callback wait, and leaves the node free to steer.")
def on_arrival() -> list[Expectation]:
    """A navigator that answers when the turtle has arrived, and works meanwhile."""
    return [
        *navigator_is_there(),
        answered(A_GOAL),
        arrived(A_GOAL),
        facing(A_GOAL),
        honest_time(A_GOAL),
        steady_commands(A_GOAL),
        stopped(A_GOAL),
        answered(TO_THE_LEFT),
        arrived(TO_THE_LEFT),
        honest_time(TO_THE_LEFT),
        _soon(NEAR_GOAL),
        _answers_meanwhile,
        refuses("what makes no sense, as before", *NONSENSE),
        no_errors(),
    ]


def _soon(way: Way) -> Expectation:
    def look(probe: Probe) -> Seen:
        it = driven(probe, way)
        seen = f"after {number(it.answer.seconds)} s, {number(it.distance())} m from the goal"
        step = "How long does the answer wait once the turtle is there?"
        return Seen(it.answer.seconds <= WAITING and it.distance() <= NEAR, seen, step)

    return Expectation(f"{way.name} is answered within {WAITING:g} s", look)


@expectation("it answers other questions meanwhile")
def _answers_meanwhile(probe: Probe) -> Seen:
    """Another request is answered while a goal is under way."""
    put(probe, (2.0, 2.0, 0.0))
    first = ask_soon_for(probe, (8.0, 8.0, 0.0))
    probe.wait(HALFWAY)
    if first() is not None:
        come_to_rest(probe, 15.0)
        raise CannotLook("a goal 8 m away was answered at once")
    answer = probe.ask("/navigator/list_parameters", "rcl_interfaces/srv/ListParameters", 1.0)
    probe.wait_for(first, 30.0)
    if answer.response is None:
        return no_answer(probe, "its parameters were not told within 1 s")
    return Seen(True, "its parameters were told while it drove")


@check(
    "one_goal",
    points=3,
    limit=600,
    learnt="A callback that pauses may be called again: what it shares has to be guarded.",
)
def one_goal() -> list[Expectation]:
    """A navigator that goes on to its goal, and refuses another one meanwhile."""
    return [
        *navigator_is_there(),
        Expectation("a second goal on the way is refused at once", _refused),
        Expectation("so is a third", _refused_again),
        Expectation("the turtle reaches the first goal", _first_reached),
        Expectation("the first goal is answered: success is True", _first_answered),
        Expectation("after that, a goal is accepted again", _accepted_again),
        refuses("what makes no sense, as before", *NONSENSE),
        no_errors(),
    ]


FIRST, OTHERS = (9.0, 3.0, 0.0), ((3.0, 9.0, 1.57), (2.0, 3.0, 0.0))
GUARD = hinted(
    "How does on_goal notice that another goal is under way, and when is that over?",
    "Open Hint 1, then Hint 2, under the exercise.",
)


class _Crowd:
    """A goal, and two others that come while it is under way."""

    def __init__(self, probe: Probe) -> None:
        put(probe, (3.0, 3.0, 0.0))
        first = ask_soon_for(probe, FIRST)
        probe.wait(HALFWAY)
        if first() is not None:
            raise CannotLook("the first goal, 6 m away, was answered at once")
        self.others = [ask_for(probe, each, 0.5) for each in OTHERS]
        probe.wait_for(first, 15.0)
        self.first = first()
        come_to_rest(probe, 15.0)
        self.end = where(probe)


@remembered
def _crowd(probe: Probe) -> _Crowd:
    return _Crowd(probe)


def _refused(probe: Probe, number_of_it: int = 0) -> Seen:
    answer = _crowd(probe).others[number_of_it]
    if answer.response is None:
        return no_answer(probe, f"no answer to {point(*OTHERS[number_of_it][:2])} within 0.5 s")
    seen = f"success is {answer.response.success} after {number(answer.seconds)} s"
    return Seen(not answer.response.success, seen, GUARD)


def _refused_again(probe: Probe) -> Seen:
    return _refused(probe, 1)


def _first_reached(probe: Probe) -> Seen:
    end = _crowd(probe).end
    away = math.hypot(end.x - FIRST[0], end.y - FIRST[1])
    return Seen(
        away <= NEAR, f"it came to rest at {point(end.x, end.y)}, {number(away)} m from {point(*FIRST[:2])}", GUARD
    )


def _first_answered(probe: Probe) -> Seen:
    first = _crowd(probe).first
    if first is None:
        return no_answer(probe, "no answer within 15 s")
    seen = f"success is {first.response.success}, time_taken {number(first.response.time_taken)} s"
    return Seen(bool(first.response.success), seen, GUARD)


def _accepted_again(probe: Probe) -> Seen:
    _crowd(probe)
    answer = ask_for(probe, (5.0, 5.0, 0.0), 15.0)
    if answer.response is None:
        return no_answer(probe, "no answer within 15 s")
    end = where(probe)
    seen = f"success is {answer.response.success}, with the turtle at {point(end.x, end.y)}"
    return Seen(bool(answer.response.success) and math.hypot(end.x - 5, end.y - 5) <= NEAR, seen, GUARD)
