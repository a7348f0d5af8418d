"""Page 11: the package as a robot gets it, a safety stop, and a recorded robot that is played back."""

from __future__ import annotations

from typing import Any

from ..words import listed, number
from . import page_04, page_05
from .drives import COMMAND_TYPE, COMMANDS, NAVIGATE, NAVIGATE_TYPE
from .exam import Exam
from .parts import node, offers, parameter, publishes, subscribes
from .registry import Expectation, check
from .rows import CannotLook, Seen
from .streams import rate

PAGE = "11_to_a_real_robot"
LAUNCH = "ros2 launch robot_controller start_system.launch.py NAME:=VALUE … (it starts all three nodes)"
PLAYER = "rosbag2_player"
WANTED = "/wanted_vel"
SPEED = 0.5
BEAMS = 181

# -- what a robot starts -------------------------------------------------------------------------------------------------


@check("on_site", page=PAGE, points=3, limit=20)
def on_site() -> list[Expectation]:
    """The package is started with the settings of another place, and its files stay as they are."""
    return [
        node("/navigator", LAUNCH),
        offers(NAVIGATE, NAVIGATE_TYPE, by="/navigator"),
        publishes(COMMANDS, COMMAND_TYPE, by="/navigator"),
        node("/status_monitor", LAUNCH),
        publishes(page_04.STATUS, page_04.STATUS_TYPE, by="/status_monitor"),
        node("/obstacle_detector", LAUNCH),
        publishes(page_05.SCAN, page_05.SCAN_TYPE, by="/obstacle_detector"),
        parameter("/navigator", "goal_timeout", 8.0),
        parameter("/status_monitor", "publish_rate", 20),
        parameter("/obstacle_detector", "source", "world"),
        rate(page_04.STATUS, page_04.STATUS_TYPE, hz=20),
    ]


# -- a safety stop -------------------------------------------------------------------------------------------------------


@check("safety_stop", page=PAGE, points=4, limit=20)
def safety_stop() -> list[Expectation]:
    """Commands pass while the way is free; otherwise the turtle is told to stand."""
    near = "is_safe should be False for a distance below 0.5 m."
    late = "is_safe should be False for a scan that is older than 0.5 s: a silent sensor is no free way."
    return [
        node("/safety_stop"),
        subscribes(WANTED, COMMAND_TYPE, by="/safety_stop"),
        publishes(COMMANDS, COMMAND_TYPE, by="/safety_stop"),
        _lets_through("10 m are free: the command passes", "free", 10.0, SPEED, "is_safe should be True then."),
        _lets_through("0.3 m are free: the turtle is stopped", "near", 0.3, 0.0, near),
        _lets_through("free again: the command passes", "free again", 10.0, SPEED, "is_safe should be True again."),
        _lets_through("no scan for a second: it is stopped", "silent", None, 0.0, late),
    ]


def _lets_through(expected: str, name: str, distance: float | None, speed: float, step: str) -> Expectation:
    def look(exam: Exam) -> Seen:
        others = exam.publishers(page_05.SCAN)
        if others:
            raise CannotLook(f"{others[0][0]} publishes {page_05.SCAN}, too: stop it first")
        sent = exam.once(name, lambda: _last_speed(exam, distance))
        if sent is None:
            return Seen(False, f"nothing came on {COMMANDS}", "Publish something for each message that comes.")
        return Seen(sent == speed, f"it was sent {number(sent)} m/s", step)

    return Expectation(expected, look)


def _last_speed(exam: Exam, distance: float | None) -> Any:
    """Want to drive for 1.2 s, with scans of this distance (m) or with none; the speed that was sent at last (m/s)."""
    heard = exam.listen(COMMANDS, COMMAND_TYPE)
    heard.clear()
    for tick in range(12):
        if distance is not None and tick % 2 == 0:
            ranges = [distance] * BEAMS
            exam.publish(page_05.SCAN, page_05.SCAN_TYPE, ranges=ranges, range_max=10.0)
            exam.wait(0.02)
        exam.publish(WANTED, COMMAND_TYPE, linear__x=SPEED)
        exam.wait(0.1)
    return heard[-1].message.linear.x if heard else None


# -- a recorded robot ----------------------------------------------------------------------------------------------------


@check("replay", page=PAGE, points=3, limit=15)
def replay() -> list[Expectation]:
    """A bag speaks for a status monitor that does not run."""
    return [
        Expectation("no status monitor runs", _no_monitor),
        Expectation(f"{page_04.STATUS} comes from a bag", _from_a_bag),
        rate(page_04.STATUS, page_04.STATUS_TYPE, hz=10, seconds=2.0),
    ]


def _no_monitor(exam: Exam) -> Seen:
    there = "/status_monitor" in exam.nodes()
    return Seen(not there, "it runs" if there else "none does", "Begin with start(), and launch nothing.")


def _from_a_bag(exam: Exam) -> Seen:
    who = sorted({owner for owner, _ in exam.publishers(page_04.STATUS)})
    good = len(who) == 1 and who[0].rsplit("/", 1)[-1].startswith(PLAYER)
    return Seen(good, listed(who) or "nobody publishes it", "ros2 bag play FOLDER --loop &")
