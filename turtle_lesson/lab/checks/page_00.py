"""Page 00: a first command and a first goal of the reader's own."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ..recording import NANOSECONDS
from ..words import angle, number, point, turned
from .navigation import NEAR, where
from .probe import Probe, remembered
from .registry import Expectation, check
from .results import Advice, Seen, hinted

CORNER = (2.0, 2.0)
UP = math.pi / 2
LITTLE = 0.1
"""What does not matter: radians of a heading, metres of a way."""

REST = 0.5
"""Robot time, s: a turtle that has not moved for so long has come to rest, and what it does then is a new motion."""

FAST = 2 * math.pi
"""rad/s: a command that turns faster than this was probably meant in degrees."""


@check("face_up", points=1, limit=5, learnt="One message on a topic moves a robot; angles are measured in radians.")
def face_up() -> list[Expectation]:
    """The turtle was turned on the spot, a quarter to the left."""
    return [
        Expectation("it turned a quarter to the left, and faces up", _facing_up),
        Expectation("it turned on the spot", _on_the_spot),
    ]


@dataclass(frozen=True)
class Motion:
    """The turtle's motion since it was at rest before the last command: how far it turned (rad, to the left) and drove (m).

    `command` is the turning speed that the last command asked for, rad/s.
    """

    turn: float = 0.0
    way: float = 0.0
    command: float = 0.0


@remembered
def last_motion(probe: Probe) -> Motion:
    """What the turtle did last, from what was recorded of it; so a cell that was run twice is judged by its second run."""
    record = probe.target.recording
    poses, commands = record.poses.array(), record.commands.newest(1)
    if not len(commands):
        return Motion()
    command = float(commands[0]["turn"])
    x, y, theta = (poses[name].astype(float) for name in ("x", "y", "theta"))
    way = np.hypot(np.diff(x), np.diff(y))
    turn = np.angle(np.exp(1j * np.diff(theta)))
    moves = np.flatnonzero((way > 1e-6) | (np.abs(turn) > 1e-6))
    if not len(moves) or poses["stamp"][moves[-1] + 1] < commands[0]["stamp"]:
        return Motion(command=command)
    rests = np.flatnonzero(np.diff(poses["stamp"][moves]) > REST * NANOSECONDS)
    first = moves[rests[-1] + 1] if len(rests) else moves[0]
    return Motion(float(turn[first:].sum()), float(way[first:].sum()), command)


def _facing_up(probe: Probe) -> Seen:
    heading, motion = where(probe).theta, last_motion(probe)
    good = abs(turned(heading - UP)) <= LITTLE or abs(motion.turn - UP) <= LITTLE
    seen = f"its heading is {angle(heading)}; the last command said angular.z = {number(motion.command)} rad/s"
    advice = Advice(
        symptom="That is many times round in one second: ROS measures angles in radians, not in degrees."
        if abs(motion.command) > FAST
        else "",
        direction="A command counts for one second. Which turning speed makes a quarter turn in one second, and to which side?",
        hint="Open the hint under the exercise.",
    )
    return Seen(good, seen, advice)


def _on_the_spot(probe: Probe) -> Seen:
    way = last_motion(probe).way
    advice = "Which field of the command makes it drive? To begin again: ros2 service call /reset std_srvs/srv/Empty"
    return Seen(way <= LITTLE, f"it drove {number(way)} m meanwhile", advice)


@check("corner", points=1, limit=5, learnt="A service is asked by a request, and answers when its work is done.")
def corner() -> list[Expectation]:
    """The turtle was sent to (2, 2)."""
    return [Expectation(f"the turtle within {NEAR:g} m of {point(*CORNER)}", _in_the_corner)]


def _in_the_corner(probe: Probe) -> Seen:
    pose = where(probe)
    away = math.hypot(pose.x - CORNER[0], pose.y - CORNER[1])
    seen = f"it is at {point(pose.x, pose.y)}, {number(away)} m from there"
    advice = hinted("What does the request say, and was it sent with client.call?", "Open the hint under the exercise.")
    return Seen(away <= NEAR, seen, advice)
