"""Pages 06 and 07: parameters that are really read, a launch file with arguments, and what is done from the command line."""

from __future__ import annotations

import itertools
import math
from typing import Any

from ..recording import WORLD
from ..words import angle, listed, number, point, turned
from .assertions import get_parameter, no_errors, node, parameter, publishes, rate, rate_follows, set_parameter, some
from .navigation import COMMAND_TYPE, COMMANDS, NAVIGATE, POSE, POSE_TYPE, ask_for, away, where
from .page_04 import RUN, STATUS, STATUS_TYPE
from .page_05 import SCAN, SCAN_TYPE
from .pages_03 import navigator_is_there
from .probe import Probe, remembered
from .registry import Expectation, check, expectation
from .results import CannotLook, Seen, hinted

PAGE, COMMAND_LINE = "06_parameters_and_launch", "07_command_line"
MONITOR = "/status_monitor"
LAUNCH = "ros2 launch robot_controller start_system.launch.py"


@check(PAGE, points=5, limit=60, learnt="A parameter that is read where it is used can be set while the node runs.")
def parameters() -> list[Expectation]:
    """A status monitor whose rate follows its parameter."""
    return [
        node(MONITOR, RUN),
        publishes(STATUS, STATUS_TYPE, by=MONITOR),
        parameter(MONITOR, "publish_rate", 10),
        rate(STATUS, STATUS_TYPE, hz=10),
        *(rate_follows(MONITOR, "publish_rate", value, STATUS, STATUS_TYPE) for value in (20, 4, 40)),
        no_errors(),
    ]


def system_is_there() -> list[Expectation]:
    """The three nodes, and what each of them is for."""
    return [
        *navigator_is_there(LAUNCH),
        node(MONITOR, LAUNCH),
        publishes(STATUS, STATUS_TYPE, by=MONITOR),
        node("/obstacle_detector", LAUNCH),
        publishes(SCAN, SCAN_TYPE, by="/obstacle_detector"),
    ]


@check(PAGE, points=5, limit=60, learnt="One command starts a whole system, and its arguments set it up.")
def launch() -> list[Expectation]:
    """One command has started all three nodes, and its arguments become their parameters."""
    return [
        *system_is_there(),
        _only("/navigator", MONITOR, "/obstacle_detector", "/turtlesim"),
        parameter("/navigator", "goal_timeout", 5.0),
        parameter(MONITOR, "publish_rate", 10),
        parameter("/obstacle_detector", "scan_rate", 5),
        rate(STATUS, STATUS_TYPE, hz=10),
        rate(SCAN, SCAN_TYPE, hz=5),
        *(_argument_reaches(*each) for each in ARGUMENTS),
        _gives_up("goal_timeout", 0.5),
        rate_follows("/obstacle_detector", "scan_rate", 10, SCAN, SCAN_TYPE),
        no_errors(),
    ]


ARGUMENTS: tuple[tuple[str, str, int | float], ...] = (
    ("navigator", "goal_timeout", 3.5),
    ("status_monitor", "publish_rate", 25),
    ("obstacle_detector", "scan_rate", 8),
)
"""What a second launch is given: owner, name and value, none of which is a default."""


@expectation("no other node")
def _only(probe: Probe, *wanted: str) -> Seen:
    found = probe.nodes().items()
    extra = [f"{amount} × {name}" if amount > 1 else name for name, amount in found if name not in wanted or amount > 1]
    advice = "Nothing else was asked for: what does the launch file start, and what ran before?"
    return Seen(not extra, f"there is {listed(extra)}, too" if extra else "none", advice)


@expectation("{name}:={value} reaches /{owner}")
def _argument_reaches(probe: Probe, owner: str, name: str, value: int | float) -> Seen:
    found = _launch_again(probe)
    if found[owner] is None:
        raise CannotLook(f"there is no node /{owner}")
    step = f"Where does the launch file declare {name}, and where does it hand the value on?"
    good = type(found[owner]) is type(value) and found[owner] == value
    return Seen(good, f"{name} is {found[owner]!r} then", hinted(step, "Open Hints 1 and 2 under the exercise."))


@remembered
def _launch_again(probe: Probe) -> dict[str, Any]:
    """The nodes' parameters in a second launch with other arguments, beside the first. Raises CannotLook if it is refused."""
    from ...ros.launching.errors import LaunchError

    package, file = LAUNCH.split()[2:]
    renamed = {name: f"/exam{name}" for name in (STATUS, SCAN, NAVIGATE, COMMANDS)}
    arguments = {name: value for _, name, value in ARGUMENTS}
    try:
        with probe.target.launched(package, file, "exam", renamed, arguments):
            there = probe.nodes()
            return {
                owner: get_parameter(probe, f"/exam/{owner}", name) if f"/exam/{owner}" in there else None
                for owner, name, _ in ARGUMENTS
            }
    except LaunchError as error:
        raise CannotLook(f"the launch file was refused: {' '.join(str(error).split())[:160]}") from None


@expectation("{name} set to {seconds!r}: gives up on a far goal")
def _gives_up(probe: Probe, name: str, seconds: float) -> Seen:
    """A timeout (s) that is really read: a goal that needs longer is answered with success False at that time."""
    set_parameter(probe, "/navigator", name, seconds)
    pose = where(probe)
    x, y = max(itertools.product((1.0, round(WORLD - 1.0, 1)), repeat=2), key=lambda corner: away(pose, corner))
    answer = ask_for(probe, (x, y, 0.0), 25.0)
    if answer.response is None:
        return probe.no_answer("the goal was never answered")
    step = f"At each step: how long has this goal been under way, and how long may it take, according to {name}?"
    # two steps of a navigator at 10 Hz, and a little
    good = not answer.response.success and abs(answer.seconds - seconds) <= 0.25
    return Seen(good, answer.told, hinted(step, 2))


SIDES = {"slow": 5, "fast": 20}
"""The namespaces of the two monitors, and the rate (Hz) of each."""


@check(PAGE, points=4, limit=20, learnt="Namespaces and remapped names let one program run many times.")
def side_by_side() -> list[Expectation]:
    """Two status monitors, each with its own namespace, topic and rate."""
    monitors = {side: f"/{side}{MONITOR}" for side in SIDES}
    return [
        *map(_monitor_is_there, monitors.values()),
        _only(*monitors.values(), "/turtlesim"),
        *(publishes(f"/{side}{STATUS}", STATUS_TYPE, by=name) for side, name in monitors.items()),
        _no_node_publishes(STATUS),
        *(parameter(name, "publish_rate", SIDES[side]) for side, name in monitors.items()),
        *(
            Expectation(
                f"/{side}{STATUS} comes at {hz} Hz", rate(f"/{side}{STATUS}", STATUS_TYPE, hz, 0.1 / hz, 2.0).look
            )
            for side, hz in SIDES.items()
        ),
        no_errors(),
    ]


@expectation("one node {name}")
def _monitor_is_there(probe: Probe, name: str) -> Seen:
    found = probe.nodes()
    monitors = listed([f"{amount} × {each}" for each, amount in found.items() if each.endswith("status_monitor")])
    step = "What does each Node say about its namespace? A launch that failed says why in its output above."
    there = found[name] == 1
    return Seen(there, "it is there" if there else f"there is {monitors or 'no monitor'}", hinted(step, 1))


@expectation("no node publishes {topic}")
def _no_node_publishes(probe: Probe, topic: str) -> Seen:
    owners = [owner for owner, _ in probe.publishers(topic)]
    seen = f"{listed(owners)} {'do' if len(owners) > 1 else 'does'}" if owners else "none does"
    step = f"{topic} is an absolute name, which a namespace does not change. What replaces a name at the start?"
    return Seen(not owners, seen, hinted(step, 2))


TWIN_POSE = "/turtle2/pose"
SOON = 0.5
"""Robot time, s, after which what was typed last has its effect: a program is up, a timer has its new period."""


@check(COMMAND_LINE, points=2, limit=10, learnt="You can change a node while it runs, without its code.")
def tuned() -> list[Expectation]:
    """A parameter that was changed while its node runs."""
    return [
        node(MONITOR, LAUNCH),
        parameter(MONITOR, "publish_rate", 20),
        rate(STATUS, STATUS_TYPE, hz=20, within=0.005, seconds=2.0, after=SOON),
        parameter("/obstacle_detector", "scan_rate", 5),
        no_errors(),
    ]


@check(COMMAND_LINE, points=2, limit=10, learnt="Any service can be found out about, and called, by hand.")
def second_turtle() -> list[Expectation]:
    """A service of the simulator was called: there are two turtles."""
    return [_twin_is_there(), _twin_in_place(2.0, 9.0), _twin_faces_up(), no_errors()]


@expectation(f"{TWIN_POSE} is published")
def _twin_is_there(probe: Probe) -> Seen:
    there = bool(probe.publishers(TWIN_POSE))
    others = [topic for topic in probe.topics() if topic.endswith("/pose") and topic != POSE]
    seen = "it is" if there else f"there is {others[0]}" if others else "there is one turtle"
    return Seen(there, seen, "Which field of the request says what the turtle is called?")


@expectation("turtle2 at ({x:.2f}, {y:.2f})")
def _twin_in_place(probe: Probe, x: float, y: float) -> Seen:
    pose = some(probe, TWIN_POSE, POSE_TYPE, 0.1)[-1].message
    advice = "x and y are fields of the request. (/kill takes a turtle away again.)"
    return Seen(away(pose, (x, y)) < 0.05, f"it is at {point(pose.x, pose.y)}", advice)


@expectation("turtle2 faces up")
def _twin_faces_up(probe: Probe) -> Seen:
    pose = some(probe, TWIN_POSE, POSE_TYPE, 0.1)[-1].message
    advice = "theta is an angle in radians: how many are 90°? (/kill takes a turtle away again.)"
    return Seen(abs(turned(pose.theta - 1.57)) < 0.02, f"it faces {angle(pose.theta)}", advice)


@check(COMMAND_LINE, points=3, limit=15, learnt="A speed ahead and a turn, sent again and again, make a circle.")
def circle() -> list[Expectation]:
    """Commands from a terminal drive the turtle round and round."""
    return [_ten_a_second(), _goes_round(), _has_radius(2.0), no_errors()]


@expectation(f"{COMMANDS}: ten messages a second")
def _ten_a_second(probe: Probe) -> Seen:
    """A command that was started twice sends twice as many; that is no mistake in it."""
    probe.wait(SOON)
    amount = len([owner for owner, _ in probe.publishers(COMMANDS) if owner != "/navigator"])
    if not amount:
        advice = "A command that is to go on while the check looks ends with &."
        return Seen(False, "no command in a terminal publishes", advice)
    heard = len(some(probe, COMMANDS, COMMAND_TYPE, 2.0)) / 2.0 / amount
    advice = "ros2 topic pub -h names the option for the rate."
    return Seen(abs(heard - 10.0) <= 0.5, f"{number(heard, 1)} a second", advice)


@remembered
def _motion(probe: Probe) -> tuple[float, float]:
    """The turtle's speed ahead (m/s) and its turn (rad/s); each the smallest in two seconds."""
    commands = [each.message for each in some(probe, COMMANDS, COMMAND_TYPE, 0.5)]
    poses = [each.message for each in some(probe, POSE, POSE_TYPE, 2.0)]
    ahead = math.copysign(min(each.linear_velocity for each in poses), commands[-1].linear.x)
    turn = min((each.angular_velocity for each in poses), key=abs)
    return ahead, turn


@expectation("the turtle drives ahead and turns left")
def _goes_round(probe: Probe) -> Seen:
    ahead, turn = _motion(probe)
    advice = hinted("A circle is both at once, in one message: a speed ahead and a turn. Which sign is left?", 1)
    return Seen(ahead > 0.05 and turn > 0.05, f"{number(ahead)} m/s and {number(turn)} rad/s", advice)


@expectation("the circle's radius is {metres:g} m")
def _has_radius(probe: Probe, metres: float) -> Seen:
    ahead, turn = _motion(probe)
    if abs(turn) < 1e-3 or abs(ahead) < 1e-3:
        raise CannotLook("the turtle drives no circle")
    radius = abs(ahead / turn)
    advice = hinted("How far does it drive while it turns by one radian?", 2)
    return Seen(abs(radius - metres) <= 0.1, f"it is {number(radius)} m", advice)
