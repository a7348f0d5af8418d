"""Page 12: runs that can fail, an interval for a rate of success, and a navigator on a slow network."""

from __future__ import annotations

import inspect
import io
import math
import random
import sys
from collections.abc import Sequence
from contextlib import nullcontext, redirect_stdout
from dataclasses import dataclass
from random import Random
from typing import Any

from ...learner.workspace import workspace
from ..words import count, number
from .assertions import learner_function, no_errors, node
from .navigation import MIDDLE, POSE, POSE_TYPE, Way, drive, is_moving, missed, put
from .page_10 import running
from .probe import Probe
from .registry import Expectation, check, expectation
from .results import ENDLESS, CannotLook, Seen, hinted

PAGE = "12_a_thousand_runs"

# -- a run that can fail -------------------------------------------------------------------------------------------------

LATE = 2.0
"""How long a trip may take, s."""
QUICK_SEEDS, LATE_SEEDS = (12, 9), (3, 2)
"""Seeds with goals that the lesson's navigator reaches well within that time, or well after it."""
DELAY = 0.02
"""The latency (s) with which one of the trips is made."""
SOON = 0.5
"""A `goal_timeout`, s, with which the robot gives up on a trip that needs more."""
ALL_OF_THE_TURTLE = "/turtle1/*"


@dataclass(frozen=True)
class Trip:
    """One call of the learner's function: what it returned or raised, and how long the turtle moved (s)."""

    seed: int
    returned: Any
    raised: Exception | None
    moved: float

    def __str__(self) -> str:
        what = (
            f"it returned {self.returned!r:.40}" if self.raised is None else f"it raised {type(self.raised).__name__}"
        )
        return f"seed {self.seed}, {number(self.moved, 1)} s: {what}"


@check(PAGE, points=3, limit=120, learnt="A run has failed if its function raises an error, so say what must be true.")
def punctual() -> list[Expectation]:
    """A trip that fails if the robot gave up, or came late."""
    return [
        Expectation("a quick trip returns its seconds", _returns_seconds),
        Expectation(f"a trip of more than {LATE:g} s fails", _fails_late),
        Expectation(f"a robot that gives up after {SOON:g} s fails", _fails_when_it_gives_up),
        Expectation("a quick trip with a latency is driven with it", _with_latency),
    ]


def make_trip(probe: Probe, seed: int, **options: float) -> Trip:
    """Call the learner's function with the chance of this seed, on a turtle that stands in the middle."""
    function = learner_function(probe, "punctual")
    lesson = vars(sys.modules["__main__"])["lesson"]
    put(probe, MIDDLE)
    poses = probe.listen(POSE, POSE_TYPE)
    before = len(poses)
    returned, raised = None, None
    random.seed(seed)  # as in each run of an experiment
    with redirect_stdout(io.StringIO()), probe.target.ending_programs():
        try:
            returned = function(lesson, **options)  # not by probe.call: like a cell, it runs the world itself
        except (*ENDLESS, NameError, TypeError, AttributeError):  # a mistake, and no trip that failed
            raise
        except Exception as error:
            raised = error
    times = [each.at for each in poses[before:] if is_moving(each.message)]
    return Trip(seed, returned, raised, times[-1] - times[0] if times else 0.0)


def _one(trip: Trip, late: bool) -> Trip:
    """A trip of which it is beyond doubt whether it came late. Raises CannotLook where it is not."""
    if not trip.moved:
        raise CannotLook(f"the turtle did not move ({trip})")
    if (trip.moved < LATE - 0.15) is late or abs(trip.moved - LATE) < 0.15:
        raise CannotLook(f"with this package the goal of seed {trip.seed} takes {number(trip.moved, 1)} s")
    return trip


def _returns_seconds(probe: Probe) -> Seen:
    trip = _one(make_trip(probe, QUICK_SEEDS[0]), late=False)
    said = trip.returned.get("seconds") if isinstance(trip.returned, dict) else None
    right = isinstance(said, int | float) and abs(said - trip.moved) < 0.3
    step = 'A good trip returns what trip returns: a dict with "seconds". Which of your conditions is false for it?'
    return Seen(trip.raised is None and right, str(trip), hinted(step, 1))


def _fails_late(probe: Probe) -> Seen:
    step = hinted("What does your function do with it.seconds before it returns them?", 2)
    for seed in LATE_SEEDS:
        trip = _one(make_trip(probe, seed), late=True)
        if trip.raised is None:
            return Seen(False, str(trip), step)
    return Seen(True, str(trip))


def _fails_when_it_gives_up(probe: Probe) -> Seen:
    trip = make_trip(probe, LATE_SEEDS[1], goal_timeout=SOON)
    words = str(trip) if trip.raised is None else f"after {SOON:g} s: it raised {type(trip.raised).__name__}"
    return Seen(trip.raised is not None, words, hinted("What does the answer say of a robot that gave up?", 2))


def _with_latency(probe: Probe) -> Seen:
    with probe.target.network(ALL_OF_THE_TURTLE, latency=0.0):
        trip = make_trip(probe, QUICK_SEEDS[1], latency=DELAY)
        rules = vars(sys.modules["__main__"])["lesson"].network()
    if trip.raised is not None:
        return Seen(False, str(trip), hinted("Which of your conditions is false for a quick trip?", 1))
    was = rules[ALL_OF_THE_TURTLE].latency / 1e9 if ALL_OF_THE_TURTLE in rules else 0.0
    words = f"latency={DELAY:g} made it {was:g} s"
    return Seen(abs(was - DELAY) < 1e-9, words, "Hand the latency on to go, as trip does.")


# -- an interval -----------------------------------------------------------------------------------------------------------

Z = 1.96


def wilson(good: int, runs: int) -> tuple[float, float]:
    """The two ends of Wilson's 95 % interval."""
    share, spread = good / runs, Z * Z / runs
    half = Z * math.sqrt(share * (1 - share) / runs + spread / (4 * runs))
    return (share + spread / 2 - half) / (1 + spread), (share + spread / 2 + half) / (1 + spread)


@check(
    PAGE,
    points=3,
    limit=10,
    learnt="A rate without an interval says nothing: the number of runs decides how sure it is.",
)
def interval() -> list[Expectation]:
    """The interval in which a rate of success lies."""
    brackets = hinted("Compare your brackets with the formula's: what belongs under the root, and what in front?", 2)
    return [
        _ends("36 of 40 is 0.769 to 0.960", [(36, 40)], brackets),
        _ends("ends for other numbers of runs", [(7, 12), (150, 160), (3, 1000)], brackets),
        _ends("ends for no failure at all", [(20, 20), (1000, 1000)], hinted("Put p = 1 into the formula.", 1)),
        _ends("ends for no success at all", [(0, 20)], hinted("Put p = 0 into the formula.", 1)),
        _ends("ends for numbers that are drawn anew", [], brackets),
        Expectation("it holds the true rate 95 times in 100", _keeps_its_promise),
    ]


@expectation("{expected}")
def _ends(probe: Probe, expected: str, examples: Sequence[tuple[int, int]], advice: Any) -> Seen:
    function = learner_function(probe, "interval")
    if not examples:
        chance = Random(_source(function))
        amounts = [chance.randint(5, 500) for _ in range(20)]
        examples = [(chance.randint(0, runs), runs) for runs in amounts]
    said = ""
    for good, runs in examples:
        low, high = _two_numbers(probe.call(function, good, runs))
        said = f"interval({good}, {runs}) is {number(low, 3)} to {number(high, 3)}"
        wanted = wilson(good, runs)
        if not (abs(low - wanted[0]) < 0.001 and abs(high - wanted[1]) < 0.001):
            return Seen(False, f"{said}, not {number(wanted[0], 3)} to {number(wanted[1], 3)}", advice)
    return Seen(True, said if len(examples) < 20 else f"{count(len(examples), 'interval')}, all right")


def _source(function: Any) -> str:
    try:
        return inspect.getsource(function)
    except (OSError, TypeError):
        return ""


def _two_numbers(returned: Any) -> tuple[float, float]:
    try:
        low, high = (float(each) for each in returned)
    except (TypeError, ValueError):
        raise TypeError(f"interval should return two numbers, low and high; it returned {returned!r:.60}") from None
    return low, high


def _keeps_its_promise(probe: Probe) -> Seen:
    """Experiments are made up: 40 runs each of a robot that is known to succeed 9 times in 10."""
    function, chance, rate, runs, experiments = learner_function(probe, "interval"), Random(12), 0.9, 40, 1000
    came = [sum(chance.random() < rate for _ in range(runs)) for _ in range(experiments)]
    ends = {good: _two_numbers(probe.call(function, good, runs)) for good in set(came)}
    held = sum(ends[good][0] <= rate <= ends[good][1] for good in came)
    width = number(sum(ends[good][1] - ends[good][0] for good in came) / experiments)
    words = f"{held} of {experiments} held the rate, {width} wide on average"
    step = hinted("A wide interval is always right, a narrow one rarely. 95 % is the promise.", 1)
    return Seen(0.92 * experiments <= held <= 0.98 * experiments, words, step)


# -- a navigator on a slow network -----------------------------------------------------------------------------------------

SLOW = 0.1
"""The latency, s, of all that is said to and by the turtle."""
SLOW_GOALS, FAST_GOALS = 12, 6
IN_TIME = 5.3
"""How long the answer to a goal may take, s: the timeout of the launch file, and some ways."""


@check(PAGE, points=5, limit=260, learnt="What was only tried once in a kind world was not tried.")
def robust() -> list[Expectation]:
    """A navigator that reaches its goals although each message needs 100 ms."""
    return [
        node("/navigator"),
        Expectation("it is your own package's", _is_own),
        _reaches(f"{SLOW_GOALS} new goals at 100 ms, each within 5 s", SLOW, SLOW_GOALS),
        _reaches(f"{FAST_GOALS} new goals without latency, too", 0.0, FAST_GOALS),
        no_errors(),
    ]


def _is_own(probe: Probe) -> Seen:
    program = running(probe, "navigator")[0]
    mine = str(workspace().folder / "install")
    seen = "it is" if program.startswith(mine) else "it came from elsewhere"
    return Seen(seen == "it is", seen, 'Run the cell with start(seed=0, package="mine") again.')


def drawn_goals(amount: int, latency: float) -> list[Way]:
    """Goals that nobody has seen: they are drawn from the text of the learner's navigator, so a new one has new goals."""
    file = workspace().nodes / "navigator_node.py"
    text = file.read_text(encoding="utf-8") if file.is_file() else ""
    uniform = Random(f"{latency} {text}").uniform
    return [
        Way(f"goal {made} at {latency:g} s", MIDDLE, (uniform(1, 10), uniform(1, 10), uniform(-3, 3)))
        for made in range(amount)
    ]


@expectation("{expected}")
def _reaches(probe: Probe, expected: str, latency: float, amount: int) -> Seen:
    advice = hinted("Which gains work at this latency? An experiment with latency=0.1 tells.", 1)
    if not latency:
        advice = hinted("A robot that is too careful comes late. Sweep the gain without latency, too.", 2)
    slowest = 0.0
    with probe.target.network(ALL_OF_THE_TURTLE, latency=latency) if latency else nullcontext():
        for made, way in enumerate(drawn_goals(amount, latency)):
            it = drive(probe, way)
            if wrong := missed(it, at_rest=True, in_time=IN_TIME):
                return Seen(False, f"{made} were reached, then {wrong}", advice)
            slowest = max(slowest, it.answer.seconds)
    return Seen(True, f"all of them, the slowest after {number(slowest, 1)} s")
