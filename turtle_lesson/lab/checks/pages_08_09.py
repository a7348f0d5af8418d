"""Pages 08 and 09: nodes that go on living while they work, one that asks another, and a broken system that is mended."""

from __future__ import annotations

from typing import Any

from ..troubles.cases import current_expectations, expectations_of
from ..words import number, point
from .assertions import gaps_of, get_parameter, no_errors, node, offers, publishes, rate, set_parameter
from .navigation import NAVIGATE, NEAR, ask_for, away, where
from .probe import Answer, Heard, Probe, remembered
from .registry import Expectation, check, expectation
from .results import CannotLook, Seen, hinted

PAGE, LAB = "08_executors", "09_debugging_lab"
WORK, HOME, REQUEST_TYPE = "/work", "/go_home", "std_srvs/srv/Trigger"
BEAT, BELL, NUMBER_TYPE = "/heartbeat", "/bell", "std_msgs/msg/Int32"
OVEN, OVEN_TYPE = "/oven", "std_msgs/msg/Bool"
LEAST, MOST = 1.0, 1.2
"""Robot time, s, that the work takes at least and at most."""

LONGEST = 20.0
"""Robot time, s, within which it should be done."""


@check(
    PAGE,
    points=3,
    limit=20,
    learnt="Two callbacks run side by side if there are two threads, and each is in a callback group of its own.",
)
def steady() -> list[Expectation]:
    """A baker whose bell rings on time, whatever the oven does."""
    return [
        node("/baker"),
        publishes(BELL, NUMBER_TYPE, by="/baker"),
        publishes(OVEN, OVEN_TYPE, by="/baker"),
        _bakes(0.4),
        rate(BELL, NUMBER_TYPE, hz=10),
        no_errors(),
    ]


@expectation("the oven is on for {baking:g} s, once a second")
def _bakes(probe: Probe, baking: float) -> Seen:
    heard = probe.hear(OVEN, OVEN_TYPE, 4.2)
    on = [each.at for each in heard if each.message.data]
    gaps = zip(heard, gaps_of(each.at for each in heard), strict=False)
    lasted = [gap for before, gap in gaps if before.message.data]
    if not lasted or len(on) < 2:
        step = "Is the baker in the executor, and is its oven's callback still as it was?"
        return Seen(False, f"it was switched on {len(on)} times in 4.2 s", step)
    odd = max(lasted, key=lambda each: abs(each - baking))
    every = max(gaps_of(on), key=lambda each: abs(each - 1.0))
    step = f"The baking takes {baking:g} s, once a second, as before. What else has changed?"
    good = abs(odd - baking) <= 0.011 and abs(every - 1.0) <= 0.011
    return Seen(good, f"on for {number(odd)} s, every {number(every)} s", step)


@check(PAGE, points=5, limit=40, learnt="A callback that awaits, in a callback group of its own, holds nothing up.")
def awake() -> list[Expectation]:
    """A worker whose heart beats on while it works, and that still answers."""
    return [
        node("/worker"),
        offers(WORK, REQUEST_TYPE, by="/worker"),
        publishes(BEAT, NUMBER_TYPE, by="/worker"),
        rate(BEAT, NUMBER_TYPE, hz=10),
        Expectation(f"{WORK} is answered after {LEAST:g} s", _works),
        Expectation(f"{BEAT} goes on meanwhile", _beats),
        Expectation("a parameter call is answered meanwhile", _answers),
        no_errors(),
    ]


HELD = hinted("What does on_work hold while it works: the thread, or the group of the other callbacks?", 2)


@remembered
def _shift(probe: Probe) -> tuple[float | None, list[Heard], bool]:
    """One request to work: how long until the answer (s), the beats by then, and whether the node answered meanwhile."""
    beats = probe.listen(BEAT, NUMBER_TYPE)
    probe.wait(0.3)
    first, began = len(beats), probe.now
    answer = probe.ask_soon(WORK, REQUEST_TYPE)
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
    seen = probe.no_answer(f"no answer in {LONGEST:g} s")
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
    silent = max(gaps_of(each.at for each in beats), default=LONGEST)
    return Seen(silent <= 0.15, f"the longest pause was {number(silent)} s", HELD)


def _answers(probe: Probe) -> Seen:
    _, responsive = _meanwhile(probe)
    return Seen(responsive, "it was" if responsive else "only when the work was done", HELD)


@check(
    PAGE,
    points=5,
    limit=120,
    learnt="A callback may ask another node and await the answer, if the client is not in the callback's own group.",
)
def go_home() -> list[Expectation]:
    """A service that asks another service, and does not hang."""
    return [
        node("/concierge"),
        offers(HOME, REQUEST_TYPE, by="/concierge"),
        Expectation(f"{HOME} is answered with success", _answers_from_home),
        Expectation("the turtle is in the middle by then", _is_home),
        Expectation("if the navigator gives up, so says the answer", _passes_on_no),
        no_errors(),
    ]


PASSED_ON = f"What has {NAVIGATE} answered, and what becomes of it?"


@remembered
def _trip(probe: Probe) -> tuple[Answer, Any]:
    """The turtle is driven away, then sent home: the answer, and its pose when that came."""
    if not probe.servers(HOME):
        raise CannotLook(f"no node offers {HOME}{probe.like(HOME, probe.services())}")
    return _sent_home(probe), where(probe)


def _sent_home(probe: Probe, patience: float | None = None) -> Answer:
    """Drive the turtle away and send it home: the answer. `patience` is the navigator's new goal_timeout (s), if any."""
    there = ask_for(probe, (2.0, 8.0, 0.0), LONGEST)
    if there.response is None or not there.response.success:
        raise CannotLook("the navigator did not drive the turtle away from home first: is it running?")
    if patience:
        set_parameter(probe, "/navigator", "goal_timeout", patience)
    return probe.ask(HOME, REQUEST_TYPE, LONGEST)


def _answers_from_home(probe: Probe) -> Seen:
    answer, _ = _trip(probe)
    if answer.response is None:
        return _unanswered(probe)
    return Seen(answer.response.success is True, answer.told, PASSED_ON)


def _is_home(probe: Probe) -> Seen:
    _, pose = _trip(probe)
    step = "Which goal was asked for, and does the answer wait until the turtle is there?"
    return Seen(away(pose, (5.5, 5.5)) <= NEAR, f"it is at {point(pose.x, pose.y)}", step)


def _passes_on_no(probe: Probe) -> Seen:
    """The navigator is given too little time for the way home."""
    answer, _ = _trip(probe)
    if answer.response is None:
        raise CannotLook(f"{HOME} is not answered")
    if get_parameter(probe, "/navigator", "goal_timeout") is None:
        return Seen(True, "not tried: the navigator has no goal_timeout")
    answer = _sent_home(probe, 0.1)
    if answer.response is None:
        return _unanswered(probe)
    return Seen(answer.response.success is False, f"success is {answer.response.success}", PASSED_ON)


# -- the debugging lab ---------------------------------------------------------------------------------------------------

CASE = 600
"""Robot time, s, that the check of a case may take."""


@check(LAB, points=1, limit=CASE)
def trouble() -> list[Expectation]:
    """A system that works again as specified."""
    return current_expectations()


@check(LAB, points=3, limit=CASE, learnt="A topic has a publisher, a name and a rate, and a command for each of them.")
def topic_case() -> list[Expectation]:
    """A dashboard that gets ten messages a second."""
    return expectations_of(9, "topic silent")


@check(
    LAB, points=3, limit=CASE, learnt="A call needs a node, a service of the same name, and a callback that is called."
)
def service_case() -> list[Expectation]:
    """A navigator that answers its calls."""
    return expectations_of(9, "service times out")


@check(LAB, points=3, limit=CASE, learnt="A message type is named in CMakeLists.txt, built and sourced, in this order.")
def message_case() -> list[Expectation]:
    """A message type that programs can use."""
    return expectations_of(12, "message not found")


@check(
    LAB,
    points=3,
    limit=CASE,
    learnt="A command can be followed from the node that sends it to the robot that obeys it.",
)
def turtle_case() -> list[Expectation]:
    """A turtle that gets where it is sent."""
    return expectations_of(1, "turtle stands still")
