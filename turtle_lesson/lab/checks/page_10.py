"""Page 10: tests that can fail, and the whole system by its success criteria."""

from __future__ import annotations

import math
from contextlib import suppress
from dataclasses import dataclass, field
from typing import Any

from ..track import WORLD
from ..words import count, number, point
from . import page_04, page_05, page_06
from .drives import NAVIGATE, NAVIGATE_TYPE, NEAR, Drive, drive, where
from .exam import Exam, Heard
from .parts import no_errors, publishes, subscribes
from .registry import Expectation, check
from .rows import CannotLook, Seen
from .streams import judge_rate, relays

PAGE = "10_test_and_validate"

GOALS = ((8.0, 8.0, 1.57), (2.0, 8.0, 3.14), (2.0, 2.0, -1.57), (9.0, 2.0, 0.0), (5.5, 5.5, 0.5))
"""Driven to in turn: all four quarters of the world, and all directions."""

MINUTES = 5.0
CRITERION = "five minutes of work"

VERDICT_TYPE = "std_msgs/msg/Bool"
BATTERY_VERDICT, ALIVE = "/tests/battery", "/tests/alive"


# -- a test of one message -----------------------------------------------------------------------------------------------


@check("battery_test", page=PAGE, points=3, limit=20)
def battery_test() -> list[Expectation]:
    """A test of one message: passes every percentage, and can fail."""
    step = "Compare both ends, 0 <= status.battery <= 100, and return what comes out."
    return [
        subscribes(page_04.STATUS, page_04.STATUS_TYPE, by="/tester"),
        publishes(BATTERY_VERDICT, VERDICT_TYPE, by="/tester"),
        Expectation("0, 50 and 100 % pass", _judged(True, (0.0, 50.0, 100.0), step)),
        Expectation("150 and -1 % fail", _judged(False, (150.0, -1.0), step)),
        Expectation("a battery that is no number fails", _judged(False, (math.nan,), step)),
    ]


def _judged(verdict: bool, charges: tuple[float, ...], step: str) -> Any:
    pairs = [({"battery": each}, _says(verdict), f"{each:g} % → {verdict}") for each in charges]
    return relays(page_04.STATUS, page_04.STATUS_TYPE, BATTERY_VERDICT, VERDICT_TYPE, pairs, step).look


def _says(verdict: bool) -> Any:
    return lambda message: message.data is verdict


# -- a test that goes on -------------------------------------------------------------------------------------------------


@check("watchdog", page=PAGE, points=4, limit=20)
def watchdog() -> list[Expectation]:
    """A watchdog that notices when the status stops coming."""
    return [
        subscribes(page_04.STATUS, page_04.STATUS_TYPE, by="/watchdog"),
        publishes(ALIVE, VERDICT_TYPE, by="/watchdog"),
        Expectation("True while the status comes", _alive),
        Expectation("False after a second of silence", _silent),
        Expectation("True when it comes again", _alive_again),
    ]


def _alive(exam: Exam) -> Seen:
    return _watched(exam)[0]


def _silent(exam: Exam) -> Seen:
    return _watched(exam)[1]


def _alive_again(exam: Exam) -> Seen:
    return _watched(exam)[2]


def _watched(exam: Exam) -> tuple[Seen, Seen, Seen]:
    """What the watchdog says while statuses come for a second, while none does, and while they come again."""
    return exam.once("watched", lambda: _speak_and_hush(exam))


def _speak_and_hush(exam: Exam) -> tuple[Seen, Seen, Seen]:
    others = exam.publishers(page_04.STATUS)
    if others:
        raise CannotLook(f"{others[0][0]} publishes {page_04.STATUS}, so there is no silence: stop it first")
    heard = exam.listen(ALIVE, VERDICT_TYPE)
    first = _speak(exam, heard)
    heard.clear()
    exam.wait(1.0)
    silent = _verdict(heard, False, "Compare the time since the last status with the limit, each time the timer ticks.")
    return first, silent, _speak(exam, heard)


def _speak(exam: Exam, heard: list[Heard]) -> Seen:
    for _ in range(10):
        heard.clear()
        exam.publish(page_04.STATUS, page_04.STATUS_TYPE, battery=50.0)
        exam.wait(0.1)
    exam.wait(0.1)
    return _verdict(heard, True, "In on_status, remember the time: self.get_clock().now().")


def _verdict(heard: list[Heard], wanted: bool, step: str) -> Seen:
    if not heard:
        return Seen(False, f"nothing came on {ALIVE}", "Publish from a timer, so that silence is reported, too.")
    said = heard[-1].message.data
    return Seen(said is wanted, f"it says {said}", step)


# -- the whole system ----------------------------------------------------------------------------------------------------


@check("system", page=PAGE, points=10, limit=420)
def system() -> list[Expectation]:
    """The whole system meets its specification, for five minutes."""
    return [
        *page_06.system_is_there(),
        Expectation(f"every goal reached within {NEAR:g} m, for {MINUTES:g} minutes", _reached),
        Expectation("time_taken within 0.1 s of the moving time", _honest),
        Expectation("a near goal is answered within 2 s", _near_goal),
        Expectation("status every 100 ms ± 10 ms all the time", _statuses),
        Expectation("a scan every 200 ms ± 20 ms all the time", _scans),
        page_05.sees_three(),
        no_errors(),
    ]


@dataclass
class Shift:
    """Five minutes of work, goal after goal."""

    drives: list[Drive] = field(default_factory=list)
    statuses: list[Heard] = field(default_factory=list)
    scans: list[Heard] = field(default_factory=list)


def shift(exam: Exam) -> Shift:
    """Do it once. Raises CannotLook where there is no navigator to ask."""
    return exam.once("shift", lambda: _work(exam))


def _work(exam: Exam) -> Shift:
    done = Shift()
    for topic, kind, heard in (
        (page_04.STATUS, page_04.STATUS_TYPE, "statuses"),
        (page_05.SCAN, page_05.SCAN_TYPE, "scans"),
    ):
        with suppress(CannotLook):
            setattr(done, heard, exam.listen(topic, kind))
    end = exam.now + 60 * MINUTES
    while exam.now < end:
        goal = GOALS[len(done.drives) % len(GOALS)]
        done.drives.append(drive(exam, f"drive {len(done.drives)}", lambda pose, goal=goal: goal))
        if done.drives[-1].answer.response is None:
            break
    return done


def _reached(exam: Exam) -> Seen:
    drives = shift(exam).drives
    step = "Drive to that goal alone, and look at lesson.plot_path(goal=…) and at the navigator's log."
    for it in drives:
        goal = point(*it.goal[:2])
        if it.answer.response is None:
            return Seen(False, f"goal {goal} was never answered", step)
        if not it.response.success or it.distance() > NEAR:
            seen = f"goal {goal}: success is {it.response.success}, {number(it.distance())} m away"
            return Seen(False, seen, step)
    far = max(it.distance() for it in drives)
    return Seen(True, f"{count(len(drives), 'goal')}, all of them, at most {number(far)} m off")


def _honest(exam: Exam) -> Seen:
    worst = 0.0
    for it in shift(exam).drives:
        begin, end = it.moving()
        worst = max(worst, abs(it.response.time_taken - (end - begin)))
    step = "Take the time from the first command to the one that stops the turtle, on the robot's own clock."
    return Seen(worst <= 0.1, f"at most {number(worst)} s off", step)


def _near_goal(exam: Exam) -> Seen:
    x, y, theta = _just_ahead(where(exam))
    answer = exam.ask(NAVIGATE, NAVIGATE_TYPE, 30.0, x=x, y=y, theta=theta)
    if answer.response is None:
        return Seen(False, "no answer in 30 s", "Ask for that goal alone, and read the navigator's log.")
    end = where(exam)
    away = math.hypot(x - end.x, y - end.y)
    seen = f"0.5 m: success is {answer.response.success} after {number(answer.seconds)} s"
    good = bool(answer.response.success) and answer.seconds <= 2.0 and away <= NEAR
    return Seen(good, seen, "Is the speed high enough, and does it go on waiting when it is there?")


def _just_ahead(pose: Any) -> tuple[float, float, float]:
    """A place half a metre ahead, or as little to the side as the walls leave room for; and the heading there."""
    for turn in (0.0, 0.8, -0.8, 1.6, -1.6, 2.4, -2.4):
        theta = pose.theta + turn
        x, y = pose.x + 0.5 * math.cos(theta), pose.y + 0.5 * math.sin(theta)
        if 0 < x < WORLD and 0 < y < WORLD:
            return x, y, theta
    raise CannotLook("the turtle stands in a corner")


def _statuses(exam: Exam) -> Seen:
    return judge_rate(_all(shift(exam).statuses, page_04.STATUS), 10, 0.010)


def _scans(exam: Exam) -> Seen:
    return judge_rate(_all(shift(exam).scans, page_05.SCAN), 5, 0.020)


def _all(heard: list[Heard], topic: str) -> list[Heard]:
    if not heard:
        raise CannotLook(f"nothing was heard on {topic}")
    return heard
