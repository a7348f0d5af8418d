"""Page 11: the package as a robot gets it, a safety stop, and a recorded robot that is played back."""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path

from ...learner.story import FINISHED
from ...learner.workspace import workspace
from ..words import listed, number
from .assertions import gaps_of, no_errors, node, parameter, publishes, rate, returns, subscribes
from .navigation import COMMAND_TYPE, COMMANDS
from .page_04 import STATUS, STATUS_TYPE
from .page_05 import SCAN, SCAN_TYPE
from .page_10 import PROGRAMS, running
from .pages_06_07 import system_is_there
from .probe import Probe, remembered
from .registry import Expectation, check, expectation
from .results import Advice, CannotLook, Seen, hinted

PAGE = "11_to_a_real_robot"

SETTINGS: tuple[tuple[str, str, int | float], ...] = (
    ("navigator", "goal_timeout", 8.0),
    ("status_monitor", "publish_rate", 20),
    ("obstacle_detector", "scan_rate", 10),
)
"""Each program with the setting that it is started with on site."""


@check(PAGE, points=3, limit=30, learnt="A package is built once, and set up where it is started.")
def on_site() -> list[Expectation]:
    """Your exported package is started with the settings of another place, and its files stay as they are."""
    return [
        *system_is_there(),
        Expectation("the programs are those of the exported package", _exported),
        Expectation("they are the same as in your workspace", _unchanged),
        *(parameter(f"/{program}", name, value) for program, name, value in SETTINGS),
        Expectation("with these values from the start", _from_the_start),
        rate(STATUS, STATUS_TYPE, hz=20),
        rate(SCAN, SCAN_TYPE, hz=10, within=0.020),
        no_errors(),
    ]


def _paths(probe: Probe) -> Iterator[tuple[str, Path]]:
    """Each program, with the file that runs. Raises CannotLook where one does not run."""
    return ((program, Path(running(probe, program)[0])) for program in PROGRAMS)


def _exported(probe: Probe) -> Seen:
    elsewhere = {"your workspace": workspace().folder, "the finished package": FINISHED}
    for program, path in _paths(probe):
        for name, folder in elsewhere.items():
            if path.is_relative_to(folder):
                step = "Which install/setup.bash was sourced last in this world?"
                hint = "Run the cell that builds in robot_ws once more, then launch."
                return Seen(False, f"{program} runs from {name}", hinted(step, hint))
    return Seen(True, "they are")


def _unchanged(probe: Probe) -> Seen:
    """Whether each program has the text of the learner's own file, which is in the workspace."""
    for program, path in _paths(probe):
        mine = workspace().nodes / f"{program}_node.py"
        if not mine.is_file():
            raise CannotLook(f"there is no {mine.name} in your workspace")
        if path.read_text(encoding="utf-8").split() != mine.read_text(encoding="utf-8").split():
            step = "Was the package exported and built after the last change? No setting needs a change of a file."
            return Seen(False, f"{program} differs from {mine.name}", step)
    return Seen(True, "they are")


def _from_the_start(probe: Probe) -> Seen:
    for program, name, value in SETTINGS:
        command = running(probe, program)
        given = [word.rpartition(":=") for word in command if ":=" in word]
        values = [text for key, _, text in given if key.rpartition(":")[2] == name]
        if "--params-file" not in command and (not values or float(values[-1]) != value):
            step = hinted("ros2 param set changes a node that runs. What gives a value to the launch file?", 1)
            was = f"{name}:={values[-1]}" if values else f"no {name}"
            return Seen(False, f"{program} was started with {was}", step)
    return Seen(True, "they were given when the programs started")


WANTED, SPEED = "/wanted_vel", 0.5


@check(PAGE, points=4, limit=20, learnt="Safe is what was seen to be free a moment ago, and nothing else.")
def safety_stop() -> list[Expectation]:
    """Commands pass while the way is free; otherwise the turtle is told to stand."""
    two = hinted("Two conditions have to hold, both of them. What does the second one ask for?", 1)
    free = hinted("Which of your conditions is too strict? 0.5 m and 0.5 s are still safe.", 1)
    near = hinted("From which distance on is it safe?", 1)
    odd = hinted("Each comparison with nan is false. Does your function say what is safe?", 2)
    nan, inf = math.nan, math.inf
    safe = ((2.0, 0.1), (0.55, 0.1), (0.5, 0.1), (2.0, 0.4), (2.0, 0.5), (2.0, 0.0), (inf, 0.1))
    return [
        node("/safety_stop"),
        subscribes(WANTED, COMMAND_TYPE, by="/safety_stop"),
        publishes(COMMANDS, COMMAND_TYPE, by="/safety_stop"),
        _says("True while nothing is near, as just seen", True, safe, free),
        _says("False where something is near", False, ((0.3, 0.1), (0.45, 0.1), (0.0, 0.1)), near),
        _says("False for an old reading", False, ((2.0, 3.0), (2.0, 0.6), (inf, 0.6)), two),
        _says("False for nan and for a negative age", False, ((nan, 0.1), (2.0, nan), (2.0, -0.1), (2.0, -3.0)), odd),
        _lets_through("0.55 m are free: the command passes", 0.55, SPEED),
        _lets_through("0.45 m are free: the turtle is stopped", 0.45, 0.0),
        _lets_through("free again: the command passes", 0.55, SPEED),
        _lets_through("no scan for a second: it is stopped", None, 0.0),
        no_errors(),
    ]


def _says(expected: str, safe: bool, readings: tuple[tuple[float, float], ...], advice: Advice) -> Expectation:
    """is_safe says this of readings: how far it is, m, and how old that is, s."""
    return returns("is_safe", [(each, safe) for each in readings], f"is_safe: {expected}", advice)


@expectation("{expected}")
def _lets_through(probe: Probe, expected: str, distance: float | None, speed: float) -> Seen:
    """Wanted to drive for 1.2 s, with scans of this distance (m) or with none: the speed that is sent at last (m/s)."""
    if others := probe.publishers(SCAN):
        raise CannotLook(f"{others[0][0]} publishes {SCAN}, too: stop it first")
    heard = probe.listen(COMMANDS, COMMAND_TYPE)
    heard.clear()
    for tick in range(12):
        if distance is not None and tick % 2 == 0:
            probe.publish(SCAN, SCAN_TYPE, ranges=[distance] * 181, range_max=10.0)
            probe.wait(0.02)
        probe.publish(WANTED, COMMAND_TYPE, linear__x=SPEED)
        probe.wait(0.1)
    if not heard:
        probe.raise_error()
        return Seen(False, f"nothing came on {COMMANDS}", "Publish something for each message that comes.")
    sent = heard[-1].message.linear.x
    step = "What does is_safe say for this distance, and for the age that the scan has then?"
    return Seen(sent == speed, f"it was sent {number(sent)} m/s", step)


LONG = 6.0
"""Robot time, s, for which the bag is heard: the page's bag is shorter."""


@check(PAGE, points=3, limit=30, learnt="A recording can take the place of a part that is not there.")
def replay() -> list[Expectation]:
    """A bag speaks for a status monitor that does not run."""
    return [
        Expectation("no status monitor runs", _no_monitor),
        Expectation(f"{STATUS} comes from a bag", _from_a_bag),
        Expectation("nothing else is played", _nothing_else),
        Expectation("ten messages a second, while the bag is played once", _at_its_pace),
        Expectation(f"it goes on and on: messages in each of {LONG:g} s", _again_and_again),
        no_errors(),
    ]


def _no_monitor(probe: Probe) -> Seen:
    there = "/status_monitor" in probe.nodes()
    return Seen(not there, "it runs" if there else "none does", "Begin with start(), and launch nothing.")


def _is_player(end: tuple[str, str]) -> bool:
    return end[0].rpartition("/")[2].startswith("rosbag2_player")


def _from_a_bag(probe: Probe) -> Seen:
    probe.wait_for(lambda: probe.publishers(STATUS), 1.0)  # what runs in the background has just been started
    ends = probe.publishers(STATUS)
    owners = [owner for owner, _ in ends]
    step = hinted("Does the player still run when the cell is done, and does it play this topic?", 2)
    return Seen(len(ends) == 1 and _is_player(ends[0]), listed(owners) or "no node publishes it", step)


def _nothing_else(probe: Probe) -> Seen:
    own = {"/rosout", "/parameter_events", "/clock"}
    topics = [each for each in probe.topics() if each not in own and any(map(_is_player, probe.publishers(each)))]
    if not topics:
        raise CannotLook("no bag is played")
    others = [topic for topic in topics if topic != STATUS]
    step = hinted("A bag is played with all its topics, unless some are chosen.", 1)
    return Seen(not others, f"{listed(others)}, too" if others else "nothing else is", step)


@remembered
def _times(probe: Probe) -> list[float]:
    """When messages came, in s since it began to listen."""
    began = probe.now
    return [each.at - began for each in probe.hear(STATUS, STATUS_TYPE, LONG)]


def _at_its_pace(probe: Probe) -> Seen:
    """The median gap decides, since one gap differs where the bag begins again."""
    gaps = sorted(gaps_of(_times(probe)))
    if not gaps:
        return Seen(False, "none came", "Does the player still run when the cell is done?")
    middle = gaps[len(gaps) // 2]
    seen = f"every {number(1000 * middle, 0)} ms ({number(1 / middle, 1) if middle else 'infinite'} Hz)"
    step = "A bag is played at the rate at which it was recorded, unless told otherwise."
    return Seen(abs(middle - 0.1) <= 0.010, seen, step)


def _again_and_again(probe: Probe) -> Seen:
    times = _times(probe)
    seconds = {math.floor(each) for each in times}
    missing = [second for second in range(int(LONG)) if second not in seconds]
    step = hinted("What does the player do when the bag is at its end?", 1)
    seen = f"none after {number(times[-1] if times else 0.0, 1)} s" if missing else "they come"
    return Seen(not missing, seen, step)
