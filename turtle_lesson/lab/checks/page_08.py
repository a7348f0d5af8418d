"""Page 08: nodes that go on living while they work, and one that asks another."""

from __future__ import annotations

import itertools
import math
from typing import Any

from ..words import number, point
from .assertions import get_parameter, no_answer, no_errors, node, offers, publishes, set_parameter
from .navigation import NAVIGATE, NEAR, ask_for, where
from .probe import Answer, Heard, Probe, remembered
from .registry import Expectation, check
from .results import CannotLook, Seen, hinted
from .streams import rate

WORK, WORK_TYPE = "/work", "std_srvs/srv/Trigger"
BEAT, BEAT_TYPE = "/heartbeat", "std_msgs/msg/Int32"
BELL, BELL_TYPE = "/bell", "std_msgs/msg/Int32"
OVEN, OVEN_TYPE = "/oven", "std_msgs/msg/Bool"
HOME, HOME_TYPE = "/go_home", "std_srvs/srv/Trigger"
MIDDLE, AWAY = (5.5, 5.5), (2.0, 8.0, 0.0)

LEAST, MOST = 1.0, 1.2
"""Robot time, s, that the work takes at least and at most."""

LONGEST = 20.0
"""Robot time, s, within which it should be done."""

BAKING = 0.4
"""Robot time, s, for which the oven is on."""


@check(
    "steady",
    points=3,
    limit=20,
    learnt="Two callbacks run side by side if there are two threads, and each is in a callback group of its own.",
)
def steady() -> list[Expectation]:
    """A baker whose bell rings on time, whatever the oven does."""
    return [
        node("/baker"),
        publishes(BELL, BELL_TYPE, by="/baker"),
        publishes(OVEN, OVEN_TYPE, by="/baker"),
        Expectation(f"the oven is on for {BAKING:g} s, once a second", _bakes),
        rate(BELL, BELL_TYPE, hz=10),
        no_errors(),
    ]


def _bakes(probe: Probe) -> Seen:
    heard = probe.hear(OVEN, OVEN_TYPE, 4.2)
    on = [each.at for each in heard if each.message.data]
    lasted = [after.at - before.at for before, after in itertools.pairwise(heard) if before.message.data]
    again = [after - before for before, after in itertools.pairwise(on)]
    if not lasted or not again:
        step = "Is the baker in the executor, and is its oven's callback still as it was?"
        return Seen(False, f"it was switched on {len(on)} times in 4.2 s", step)
    odd = max(lasted, key=lambda each: abs(each - BAKING)), max(again, key=lambda each: abs(each - 1.0))
    seen = f"on for {number(odd[0])} s, every {number(odd[1])} s"
    step = f"The baking takes {BAKING:g} s, once a second, as before. What else has changed?"
    return Seen(abs(odd[0] - BAKING) <= 0.011 and abs(odd[1] - 1.0) <= 0.011, seen, step)


@check("awake", points=5, limit=40, learnt="A callback that awaits, in a callback group of its own, holds nothing up.")
def awake() -> list[Expectation]:
    """A worker whose heart beats on while it works, and that still answers."""
    return [
        node("/worker"),
        offers(WORK, WORK_TYPE, by="/worker"),
        publishes(BEAT, BEAT_TYPE, by="/worker"),
        rate(BEAT, BEAT_TYPE, hz=10),
        Expectation(f"{WORK} is answered after {LEAST:g} s", _works),
        Expectation(f"{BEAT} goes on meanwhile", _beats),
        Expectation("a parameter call is answered meanwhile", _answers),
        no_errors(),
    ]


_STEP = hinted("What does on_work hold while it works: the thread, or the group of the other callbacks?", 2)


@remembered
def _shift(probe: Probe) -> tuple[float | None, list[Heard], bool]:
    """One request to work: how long until the answer (s), the beats by then, and whether the node answered meanwhile."""
    beats = probe.listen(BEAT, BEAT_TYPE)
    probe.wait(0.3)
    first, began = len(beats), probe.now
    answer = probe.ask_soon(WORK, WORK_TYPE)
    probe.wait(0.2)
    try:
        get_parameter(probe, "/worker", "use_sim_time")
        responsive = answer() is None
    except CannotLook:
        responsive = False
    probe.wait_for(answer, LONGEST)
    done = answer()
    ended = done.answered if done else probe.now
    meanwhile = [beat for beat in beats[first - 1 :] if began - 0.2 <= beat.at <= ended]
    return done.seconds if done else None, meanwhile, responsive


def _works(probe: Probe) -> Seen:
    seconds, _, _ = _shift(probe)
    if seconds is None:
        return _unanswered(probe)
    step = "The work takes one second, as before: it is done when the pause is over."
    return Seen(LEAST - 0.01 <= seconds <= MOST, f"after {number(seconds)} s", step)


def _unanswered(probe: Probe) -> Seen:
    """No answer came: the learner's error, the callback that has not returned, or else what may hold it up."""
    seen = no_answer(probe, f"no answer in {LONGEST:g} s")
    step = "What does the callback await, and is the callback group free in which it would come? Does it return the response?"
    return seen._replace(advice=hinted(step, 2))


def _meanwhile(probe: Probe) -> tuple[list[Heard], bool]:
    """The beats while it worked, and whether it answered. Raises CannotLook where the work took next to no time."""
    seconds, beats, responsive = _shift(probe)
    if seconds is not None and seconds < LEAST - 0.01:
        raise CannotLook("the work is over at once")
    return beats, responsive


def _beats(probe: Probe) -> Seen:
    beats, _ = _meanwhile(probe)
    gaps = [after.at - before.at for before, after in itertools.pairwise(beats)]
    silent = max(gaps, default=LONGEST)
    return Seen(silent <= 0.15, f"the longest pause was {number(silent)} s", _STEP)


def _answers(probe: Probe) -> Seen:
    _, responsive = _meanwhile(probe)
    return Seen(responsive, "it was" if responsive else "only when the work was done", _STEP)


@check(
    "go_home",
    points=5,
    limit=120,
    learnt="A callback may ask another node and await the answer, if the client is not in the callback's own group.",
)
def go_home() -> list[Expectation]:
    """A service that asks another service, and does not hang."""
    return [
        node("/concierge"),
        offers(HOME, HOME_TYPE, by="/concierge"),
        Expectation(f"{HOME} is answered with success", _answers_from_home),
        Expectation("the turtle is in the middle by then", _is_home),
        Expectation("if the navigator gives up, so says the answer", _passes_on_no),
        no_errors(),
    ]


@remembered
def _trip(probe: Probe) -> tuple[Answer, Any]:
    """The turtle is driven away, then sent home: the answer, and its pose when that came."""
    if not probe.servers(HOME):
        raise CannotLook(f"no node offers {HOME}{probe.like(HOME, probe.services())}")
    _drive_away(probe)
    answer = probe.ask(HOME, HOME_TYPE, LONGEST)
    return answer, where(probe)


def _drive_away(probe: Probe) -> None:
    away = ask_for(probe, AWAY, LONGEST)
    if away.response is None or not away.response.success:
        raise CannotLook("the navigator did not drive the turtle away from home first: is it running?")


def _answers_from_home(probe: Probe) -> Seen:
    answer, _ = _trip(probe)
    if answer.response is None:
        return _unanswered(probe)
    seen = f"success is {answer.response.success} after {number(answer.seconds)} s"
    return Seen(answer.response.success is True, seen, f"What has {NAVIGATE} answered, and what becomes of it?")


def _passes_on_no(probe: Probe) -> Seen:
    """The navigator is given too little time for the way home."""
    answer, _ = _trip(probe)
    if answer.response is None:
        raise CannotLook(f"{HOME} is not answered")
    if get_parameter(probe, "/navigator", "goal_timeout") is None:
        return Seen(True, "not tried: the navigator has no goal_timeout")
    _drive_away(probe)
    if reason := set_parameter(probe, "/navigator", "goal_timeout", 0.1):
        raise CannotLook(f"the navigator refused a goal_timeout of 0.1 s: {reason}")
    answer = probe.ask(HOME, HOME_TYPE, LONGEST)
    if answer.response is None:
        return _unanswered(probe)
    seen = f"success is {answer.response.success}"
    return Seen(answer.response.success is False, seen, f"What has {NAVIGATE} answered, and what becomes of it?")


def _is_home(probe: Probe) -> Seen:
    _, pose = _trip(probe)
    away = math.dist((pose.x, pose.y), MIDDLE)
    step = "Which goal was asked for, and does the answer wait until the turtle is there?"
    return Seen(away <= NEAR, f"it is at {point(pose.x, pose.y)}", step)
