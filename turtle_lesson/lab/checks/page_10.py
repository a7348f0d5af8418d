"""Page 10: tests that can fail, and the whole system by its success criteria."""

from __future__ import annotations

import math
import sys
from contextlib import suppress
from pathlib import Path
from typing import Any

from ...learner.workspace import workspace
from ..recording import WORLD
from ..words import count, listed, number
from . import page_05
from .assertions import judge_rate, learner_function, no_errors, publishes, relays, subscribes
from .navigation import NEAR, Drive, Goal, Way, ask_for, away, drive, missed, where
from .page_04 import STATUS, STATUS_TYPE
from .pages_06_07 import system_is_there
from .probe import Heard, Probe, interface, remembered
from .registry import Expectation, check, expectation
from .results import Advice, CannotLook, Seen, hinted

PAGE = "10_test_and_validate"

VERDICT_TYPE = "std_msgs/msg/Bool"
BATTERY_VERDICT, ALIVE = "/tests/battery", "/tests/alive"


@check(
    PAGE, points=3, limit=20, learnt="A test says yes to what is right, both ends included, and no to everything else."
)
def battery_test() -> list[Expectation]:
    """A test of one message: passes every percentage, and can fail."""
    ends = hinted("Both ends belong to a percentage. What does your comparison make of them?", "Open Hint 1.")
    beyond = hinted("Which values does your function never say False to?", "Open Hint 1.")
    nan = hinted("Each comparison with nan is false. What is left of your test then?", "Open Hint 2.")
    pairs: list[Any] = [
        ({"battery": 50.0}, lambda message: message.data is True, "50 % → True"),
        ({"battery": 150.0}, lambda message: message.data is False, "150 % → False"),
    ]
    return [
        subscribes(STATUS, STATUS_TYPE, by="/tester"),
        publishes(BATTERY_VERDICT, VERDICT_TYPE, by="/tester"),
        _judged("0, 50 and 100 % pass", True, ends, 50.0, 0.0, 100.0),
        _judged("150 and -1 % fail", False, beyond, 150.0, -1.0, 100.5, -0.5),
        _judged("a battery that is no number fails", False, nan, math.nan, math.inf, -math.inf),
        relays(STATUS, STATUS_TYPE, BATTERY_VERDICT, VERDICT_TYPE, pairs),
        no_errors(),
    ]


@expectation("{expected}")
def _judged(probe: Probe, expected: str, verdict: bool, advice: Advice, *charges: float) -> Seen:
    function = learner_function(probe, "battery_ok")
    for charge in charges:
        said = probe.call(function, interface(STATUS_TYPE)(battery=charge))
        if said is not verdict:
            return Seen(False, f"battery_ok returned {said!r} for {charge:g} %", advice)
    return Seen(True, f"battery_ok returned {verdict} for each")


LIMIT = 0.5
"""How old the last status may be, s, for the watchdog to call the robot alive."""
TICK = 0.2
"""How often the watchdog speaks, s."""


@check(PAGE, points=4, limit=30, learnt="A watchdog remembers when it last heard something, so it notices silence.")
def watchdog() -> list[Expectation]:
    """A watchdog that notices when the status stops coming."""
    recent = "What does is_alive compare, and in which unit? A status that came 0.4 s ago is recent enough."
    return [
        subscribes(STATUS, STATUS_TYPE, by="/watchdog"),
        publishes(ALIVE, VERDICT_TYPE, by="/watchdog"),
        Expectation("False before the first status", _before_the_first),
        _says_true("True while a status comes every 0.4 s", hinted(recent, 2)),
        _in_silence(f"True until {LIMIT:g} s after the last one", True),
        _in_silence(f"False from {LIMIT:g} s after the last one on", False),
        _says_true("True when it comes again", "Does every status that comes bring the time up to date?", True),
        no_errors(),
    ]


def _before_the_first(probe: Probe) -> Seen:
    """A new watchdog of the learner's class is asked, since the one in the notebook may have heard something already."""
    running = vars(sys.modules["__main__"]).get("watchdog")
    if not hasattr(running, "is_alive"):
        raise CannotLook("watchdog is not a node with a method is_alive")
    fresh = probe.call(type(running))
    try:
        said = probe.call(fresh.is_alive)
    finally:
        probe.call(fresh.destroy_node)
    advice = hinted("What is heard_at before the first status, and what should is_alive say then?", 2)
    return Seen(said is False, f"a new one says {said!r}", advice)


@expectation("{expected}")
def _says_true(probe: Probe, expected: str, advice: str | Advice, after_silence: bool = False) -> Seen:
    """While a status comes every 0.4 s the robot is alive: each time, or in the end where it did not come before."""
    if after_silence:
        _hush(probe)
    heard = _verdicts(probe)
    _status(probe)
    probe.wait(0.01)
    heard.clear()
    for _ in range(4):
        _status(probe, 0.39)
        probe.wait(0.01)
    if not heard:
        return _nothing_came(probe)
    said = [each.message.data for each in heard]
    wrong = [each for each in said[-1 if after_silence else 0 :] if each is not True]
    return Seen(not wrong, f"it says {wrong[0] if wrong else True}", advice)


@expectation("{expected}")
def _in_silence(probe: Probe, expected: str, alive: bool) -> Seen:
    verdicts = [(age, said) for age, said in _hush(probe) if (age < LIMIT) is alive]
    if not verdicts:
        return _nothing_came(probe)
    wrong = [each for each in verdicts if each[1] is not alive]
    age, said = (wrong or verdicts)[-1 if alive else 0]
    step = "How long ago did the last status come, by the clock, each time that the timer ticks?"
    return Seen(not wrong, f"{number(age)} s after it: {said}", hinted(step, 2))


def _nothing_came(probe: Probe) -> Seen:
    probe.raise_error()
    return Seen(False, f"nothing came on {ALIVE}", "Publish from the timer, so that silence is reported, too.")


def _verdicts(probe: Probe) -> list[Heard]:
    """What the watchdog says. Raises CannotLook where a status comes that is not the check's own."""
    if others := probe.publishers(STATUS):
        raise CannotLook(f"{others[0][0]} publishes {STATUS}, so there is no silence: stop it first")
    return probe.listen(ALIVE, VERDICT_TYPE)


def _status(probe: Probe, pause: float = 0.0) -> None:
    """One status, after a pause (s)."""
    probe.wait(pause)
    probe.publish(STATUS, STATUS_TYPE, battery=50.0)


@remembered
def _hush(probe: Probe) -> list[tuple[float, Any]]:
    """What it says in two silences, each time with how long it is after the last status (s).

    The last status comes so long before a tick that there are verdicts shortly before and after the limit.
    """
    heard, found = _verdicts(probe), list[tuple[float, Any]]()
    for before_a_tick in (0.06, 0.14):
        heard.clear()
        if not probe.wait_for(lambda: heard, 1.0):
            return found
        _status(probe, heard[-1].at + 3 * TICK - before_a_tick - probe.now)
        last = probe.now
        heard.clear()
        probe.wait(1.2)
        found += [(each.at - last, each.message.data) for each in heard]
    return sorted(found, key=lambda each: each[0])


MINUTES = 5.0
GOALS = ((8.0, 8.0, 1.57), (2.0, 8.0, 3.14), (2.0, 2.0, -1.57), (9.0, 2.0, 0.0), (5.5, 5.5, 0.5))
"""Driven to in turn: all four quarters of the world, and all directions."""

PROGRAMS = ("navigator", "status_monitor", "obstacle_detector")


@check(PAGE, points=10, limit=420, learnt="Your own system keeps its specification, and you can show it.")
def system() -> list[Expectation]:
    """Your whole system meets its specification, for five minutes."""
    return [
        *system_is_there(),
        Expectation("all three programs are from your own package", _from_workspace),
        Expectation(f"every goal reached within {NEAR:g} m, for {MINUTES:g} minutes", _reached),
        Expectation("time_taken within 0.1 s of the moving time", _honest),
        Expectation("a near goal is answered within 2 s", _near_goal),
        _rated("status every 100 ms ± 10 ms all the time", STATUS),
        _rated("a scan every 200 ms ± 20 ms all the time", page_05.SCAN),
        page_05.sees_three(),
        no_errors(),
    ]


def running(probe: Probe, program: str) -> list[str]:
    """The words of the command that runs a program of this name. Raises CannotLook where none does."""
    found = [words for words in probe.target.commands if Path(words[0]).name == program]
    if not found:
        raise CannotLook(f"no program {program} runs")
    return found[-1]


def _from_workspace(probe: Probe) -> Seen:
    mine = workspace().folder / "install"
    others = [name for name in PROGRAMS if not Path(running(probe, name)[0]).is_relative_to(mine)]
    step = 'Which package does this world know? lesson = start(seed=0, package="mine") knows yours.'
    return Seen(not others, f"{listed(others)} came from elsewhere" if others else "they are", step)


RATES = {STATUS: (STATUS_TYPE, 10, 0.010), page_05.SCAN: (page_05.SCAN_TYPE, 5, 0.020)}
"""What comes all the time: its type and rate (Hz), and how much later or sooner (s) a message may come."""


@remembered
def shift(probe: Probe) -> tuple[list[Drive], dict[str, Seen]]:
    """Five minutes of work, goal after goal: all drives, and of each topic of RATES whether it came at its rate meanwhile.

    It is cut short after a goal that was missed, and where messages come at a wrong rate after a round of goals.
    """
    probe.wait(1.0)  # an interval may still be of the rate that a parameter had before
    heard: dict[str, list[Heard]] = {topic: [] for topic in RATES}
    for topic, (type_name, *_) in RATES.items():
        with suppress(CannotLook):
            heard[topic] = probe.listen(topic, type_name)
    drives, end = list[Drive](), probe.now + 60 * MINUTES
    while True:
        made = len(drives)
        drives.append(drive(probe, Way(f"drive {made}", None, GOALS[made % len(GOALS)])))
        pace = {topic: judge_rate(heard[topic], *RATES[topic][1:]) for topic in RATES}
        uneven = len(drives) % len(GOALS) == 0 and not all(seen.good for seen in pace.values())
        if probe.now >= end or missed(drives[-1]) or uneven:
            return drives, pace


def _reached(probe: Probe) -> Seen:
    drives, pace = shift(probe)
    step = hinted("Drive to that goal alone: what does the navigator's log say, and how long may a goal take?", 1)
    if wrong := next(filter(None, map(missed, drives)), ""):
        return Seen(False, f"goal {wrong}", step)
    if not all(seen.good for seen in pace.values()):
        raise CannotLook("messages came too rarely or too often meanwhile")
    far = max(it.distance() for it in drives)
    return Seen(True, f"{count(len(drives), 'goal')}, all of them, at most {number(far)} m off")


def _honest(probe: Probe) -> Seen:
    worst = 0.0
    for it in shift(probe)[0]:
        begin, end = it.moving()
        worst = max(worst, abs(it.response.time_taken - (end - begin)))
    step = (
        "Which two moments lie between the first command and the one that stops the turtle, on the robot's own clock?"
    )
    return Seen(worst <= 0.1, f"at most {number(worst)} s off", step)


def _near_goal(probe: Probe) -> Seen:
    goal = _just_ahead(where(probe))
    answer = ask_for(probe, goal, 30.0)
    if answer.response is None:
        return Seen(False, "no answer in 30 s", "Ask for that goal alone, and read the navigator's log.")
    good = bool(answer.response.success) and answer.seconds <= 2.0 and away(where(probe), goal) <= NEAR
    return Seen(good, f"0.5 m: {answer.told}", "Is the speed high enough, and does it go on waiting when it is there?")


def _just_ahead(pose: Any) -> Goal:
    """A place half a metre ahead, or as little to the side as the walls leave room for; and the heading there."""
    for turn in (0.0, 0.8, -0.8, 1.6, -1.6, 2.4, -2.4):
        theta = pose.theta + turn
        x, y = pose.x + 0.5 * math.cos(theta), pose.y + 0.5 * math.sin(theta)
        if 0 < x < WORLD and 0 < y < WORLD:
            return x, y, theta
    raise CannotLook("the turtle stands in a corner")


@expectation("{expected}")
def _rated(probe: Probe, expected: str, topic: str) -> Seen:
    return shift(probe)[1][topic]
